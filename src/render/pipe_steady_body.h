/* pipe_steady_body.h - samples whose n', P, u and v are known from the last picture: light alone (steady.h). A part of
   pipe_body.h. */

/* Does light, or what it goes by, look at where the samples lie? */
static bool wants_points(const WrTileJob *job, const Rays *rays)
{
    bool any = rays->perspective || runs(job, WR_EFFECT_GRAIN) || runs(job, WR_EFFECT_VARIED);
    for (int i = 0; i < job->view->light_count; i++) any |= VIEWED(job->view, lights)[i].point;
    return any;
}

/* `numbers` of each of `count` samples that stand beside each other in a block. */
static void copy_block(const float *from, int count, REAL *const *into, int numbers, int to)
{
    for (int k = 0; k < numbers; k++) {
        const float *restrict block = from + k * WR_STEADY_BLOCK;
        REAL *restrict out = into[k] + to;
#pragma omp simd
        for (int i = 0; i < count; i++) out[i] = (REAL)block[i];
    }
}

/* The numbers of `count` places from x, y on, all of them the object's, to the strip's end. */
static void recall_run(const WrSteady *steady, bool points, int x, int y, int count, Strip *strip)
{
    REAL *const turned[] = { strip->bx, strip->by, strip->bz, strip->px, strip->py, strip->pz };
    REAL *const places[] = { strip->u, strip->v };
    for (int left = count, most; left > 0; left -= most, x += most) {
        const float *from = wr_steady_at(steady, x, y);
        most = WR_STEADY_BLOCK - x % WR_STEADY_BLOCK;
        most = most < left ? most : left;
        copy_block(from, most, turned, points ? 6 : 3, strip->count);
        if (steady->each == 8)
            copy_block(from + 6 * WR_STEADY_BLOCK, most, places, 2, strip->count);
        strip->count += most;
    }
}

/* Where a run of `mark` ends that begins at `from`. */
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

/* What the row's part shows of the object: runs of places that are its. */
static void recall_row_of(const WrTileJob *job, const Rays *rays, const WrDepthTile *tile, int y,
                          Strip *strip)
{
    const WrSteady *steady = job->steady;
    const unsigned char *owner = steady->owner + wr_tile_place(job, tile->x, tile->y + y);
    const unsigned char *end = owner + tile->w, *from = owner;
    const unsigned char mark = (unsigned char)(job->object + 1);
    const bool points = wants_points(job, rays);
    strip->count = 0;
    while (from < end && (from = memchr(from, mark, (size_t)(end - from)))) {
        const int x = (int)(from - owner), count = (int)(run_end(from, end, mark) - from);
        int *index = strip->index + strip->count;
#pragma omp simd
        for (int i = 0; i < count; i++) index[i] = x + i;
        recall_run(steady, points, tile->x + x, tile->y + y, count, strip);
        from += count;
    }
}

/* The same of places anywhere in the tile. */
static void recall_places(const WrTileJob *job, const WrDepthTile *tile, const WrScatter *places,
                          Strip *strip)
{
    strip->count = 0;
    for (int i = 0; i < places->count; i++) {
        const int x = tile->x + places->cell[i] % tile->w, y = tile->y + places->cell[i] / tile->w;
        if (job->steady->owner[wr_tile_place(job, x, y)] != job->object + 1) continue;
        strip->index[strip->count] = i;
        recall_run(job->steady, true, x, y, 1, strip);
    }
}

/* Their light, into the picture. */
static void light_known(const WrTileJob *job, const Rays *rays, const WrSink *sink,
                        WrTileScratch *scratch, Watch *watch)
{
    Strip *strip = STRIP_OF(scratch);
    watch_lap(watch, WR_STAGE_GEOMETRY);
    if (strip->count == 0) return;
    note_view(job, rays, scratch);
    scratch->spared[light_strip(job, rays, sink, strip, watch)] += strip->count;
    store(job, sink, strip, scratch);
    watch_lap(watch, WR_STAGE_STORE);
    scratch->shaded += strip->count;
}
