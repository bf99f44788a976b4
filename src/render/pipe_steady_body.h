/* pipe_steady_body.h - samples whose n' and P are known from the last picture: light alone (steady.h). A part of
   pipe_body.h. */

/* Does light look at where the samples lie? */
static bool wants_points(const WrTileJob *job, const Rays *rays)
{
    bool any = rays->perspective;
    for (int i = 0; i < job->view->light_count; i++) any |= VIEWED(job->view, lights)[i].point;
    return any;
}

static void copy_block(const float *from, int count, int numbers, int to, Strip *strip)
{
    REAL *const into[] = { strip->bx, strip->by, strip->bz, strip->px, strip->py, strip->pz };
    for (int k = 0; k < numbers; k++) {
        const float *restrict block = from + k * WR_STEADY_BLOCK;
        REAL *restrict out = into[k] + to;
#pragma omp simd
        for (int i = 0; i < count; i++) out[i] = (REAL)block[i];
    }
}

/* The numbers of `count` places from x, y on, all of them there, to the strip's end. */
static void recall_run(const WrSteady *steady, bool points, int x, int y, int count, Strip *strip)
{
    for (int left = count, most; left > 0; left -= most, x += most) {
        most = WR_STEADY_BLOCK - x % WR_STEADY_BLOCK;
        most = most < left ? most : left;
        copy_block(wr_steady_at(steady, x, y), most, points ? 6 : 3, strip->count, strip);
        strip->count += most;
    }
}

/* What the row's part shows: runs of places that are there. */
static void recall_row_of(const WrTileJob *job, const Rays *rays, const WrDepthTile *tile, int y,
                          Strip *strip)
{
    const WrSteady *steady = job->steady;
    const unsigned char *there = steady->there + wr_tile_place(job, tile->x, tile->y + y);
    const unsigned char *end = there + tile->w, *from = there;
    const bool points = wants_points(job, rays);
    strip->count = 0;
    while (from < end && (from = memchr(from, 1, (size_t)(end - from)))) {
        const unsigned char *gap = memchr(from, 0, (size_t)(end - from));
        const int x = (int)(from - there), count = (int)((gap ? gap : end) - from);
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
        if (!job->steady->there[wr_tile_place(job, x, y)]) continue;
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
    light_strip(job, rays, sink, strip, watch);
    scratch->spared[0] += strip->count;
    store(job, sink, strip, scratch);
    watch_lap(watch, WR_STAGE_STORE);
    scratch->shaded += strip->count;
}
