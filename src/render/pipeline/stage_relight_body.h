/* stage_relight_body.h - relighting of cached samples: only shading runs (relight_cache.h). Part of
   pipeline_body.h. */

/* True if light, or one of its inputs, depends on the samples' positions. */
static bool wants_points(const WrTileJob *job, const Rays *rays)
{
    bool any = rays->perspective || runs(job, WR_EFFECT_GRAIN) || runs(job, WR_EFFECT_VARIED) ||
               job->recalls & WR_RELIGHT_BIT(WR_RELIGHT_NORMALS);
    for (int i = 0; i < job->view->light_count; i++) any |= VIEWED(job->view, lights)[i].point;
    return any;
}

/* Mapping from a cache block to a strip's arrays. */
typedef struct Recall {
    REAL *to[WR_RELIGHT_EACH];
    int from[WR_RELIGHT_EACH]; /* index among a sample's numbers */
    int count;
    int triangle; /* index of the number that holds the triangle; or -1 */
} Recall;

static Recall recall_of(const WrRelight *relight, unsigned groups, Strip *strip)
{
    Recall how = { .triangle = -1 };
    for (int g = 0, from = 0; g < WR_RELIGHT_GROUPS; g++) {
        REAL *to[6];
        if (!(relight->groups & WR_RELIGHT_BIT(g))) continue;
        const int numbers = numbers_of(strip, (WrRelightGroup)g, to);
        for (int k = 0; k < numbers; k++, from++) {
            if (!(groups & WR_RELIGHT_BIT(g))) continue;
            how.to[how.count] = to[k];
            how.from[how.count++] = from;
        }
        if (g != WR_RELIGHT_TRIANGLE) continue;
        if (groups & WR_RELIGHT_BIT(g)) how.triangle = from; /* otherwise it was not stored */
        from++;
    }
    return how;
}

/* Copies all samples of a block. */
static void copy_block(const float *restrict from, REAL *restrict to)
{
#pragma omp simd
    for (int i = 0; i < WR_RELIGHT_BLOCK; i++) to[i] = (REAL)from[i];
}

/* Copies some samples of a block. */
static void copy_some(const float *restrict from, int count, REAL *restrict to)
{
    for (int i = 0; i < count; i++) to[i] = (REAL)from[i];
}

/* Appends samples of one block to the strip, starting with the first one given. */
static void recall_block(const Recall *how, const float *from, int count, Strip *strip)
{
    for (int k = 0; k < how->count; k++) {
        const float *own = from + how->from[k] * WR_RELIGHT_BLOCK;
        if (count == WR_RELIGHT_BLOCK) copy_block(own, how->to[k] + strip->count);
        else copy_some(own, count, how->to[k] + strip->count);
    }
    for (int i = 0; i < count && how->triangle >= 0; i++)
        strip->triangle[strip->count + i] = (int)from[how->triangle * WR_RELIGHT_BLOCK + i];
    strip->count += count;
}

/* Appends `count` samples from x, y on, all of this object, to the strip. */
static void recall_run(const WrRelight *relight, const Recall *how, int x, int y, int count,
                       Strip *strip)
{
    for (int left = count, most; left > 0; left -= most, x += most) {
        most = WR_RELIGHT_BLOCK - x % WR_RELIGHT_BLOCK;
        most = most < left ? most : left;
        recall_block(how, relight->numbers + wr_relight_at(relight, x, y), most, strip);
    }
}

/* The groups that the strip loads. */
static unsigned recalled(const WrTileJob *job, const Rays *rays)
{
    const unsigned points = WR_RELIGHT_BIT(WR_RELIGHT_POINTS);
    return wants_points(job, rays) ? job->recalls : job->recalls & ~points;
}

/* End of the run of `mark` that begins at `from`. */
static const unsigned char *run_end(const unsigned char *from, const unsigned char *end,
                                    unsigned char mark)
{
    uint64_t eight;
    const uint64_t all = 0x0101010101010101U * (uint64_t)mark;
    for (; end - from >= (ptrdiff_t)sizeof eight; from += sizeof eight) {
        memcpy(&eight, from, sizeof eight);
        if (eight != all) break;
    }
    while (from < end && *from == mark) from++;
    return from;
}

/* Appends the object's samples of a row: runs of positions that it owns. */
static void recall_row_of(const WrTileJob *job, const Rays *rays, const WrDepthTile *tile, int y,
                          Strip *strip)
{
    const WrRelight *relight = job->relight;
    const unsigned char *owner = relight->owner + wr_relight_place(relight, tile->x, tile->y + y);
    const unsigned char *end = owner + tile->w, *from = owner;
    const unsigned char mark = (unsigned char)(job->object + 1);
    const Recall how = recall_of(relight, recalled(job, rays), strip);
    strip->count = 0;
    while (from < end && (from = memchr(from, mark, (size_t)(end - from)))) {
        const int x = (int)(from - owner), count = (int)(run_end(from, end, mark) - from);
        int *index = strip->index + strip->count;
        REAL *at_x = strip->x + strip->count, *at_y = strip->y + strip->count;
#pragma omp simd
        for (int i = 0; i < count; i++) {
            index[i] = x + i;
            at_x[i] = (REAL)(tile->x + x + i);
            at_y[i] = (REAL)(tile->y + y);
        }
        recall_run(relight, &how, tile->x + x, tile->y + y, count, strip);
        from += count;
    }
}

/* Appends the object's samples among arbitrary positions of the tile. */
static void recall_places(const WrTileJob *job, const WrScatter *places, Strip *strip)
{
    const Recall how = recall_of(job->relight, job->recalls, strip);
    strip->count = 0;
    for (int i = 0; i < places->count; i++) {
        const int x = (int)(places->x[i] + 0.5), y = (int)(places->y[i] + 0.5);
        const size_t at = wr_relight_place(job->relight, x, y);
        if (job->relight->owner[at] != job->object + 1) continue;
        strip->index[strip->count] = i;
        strip->x[strip->count] = (REAL)places->x[i];
        strip->y[strip->count] = (REAL)places->y[i];
        recall_run(job->relight, &how, x, y, 1, strip);
    }
}

/* True if no sample has a spread of slopes. */
static bool are_gathered(const Strip *strip)
{
    bool any = false;
    for (int i = 0; i < strip->count; i++)
        any |= (strip->see[i] != 0) | (strip->sef[i] != 0) | (strip->sff[i] != 0);
    return !any;
}

/* Lights the samples and stores the result in the picture. */
static void light_known(const WrTileJob *job, const Rays *rays, const WrSink *sink,
                        WrTileScratch *scratch, Watch *watch)
{
    Strip *strip = STRIP_OF(scratch);
    watch_lap(watch, WR_STAGE_GEOMETRY);
    if (strip->count == 0) return;
    note_view(job, rays, scratch);
    if (runs(job, WR_EFFECT_SPREAD)) strip->gathered = are_gathered(strip);
    scratch->spared[light_strip(job, rays, sink, strip, watch)] += strip->count;
    keep_half3(job, strip->cr, strip->cg, strip->cb, strip->count, watch);
    store(job, sink, strip, scratch);
    watch_lap(watch, WR_STAGE_STORE);
    scratch->shaded += strip->count;
}
