/* stage_depth_body.h - depth test of a strip against other objects. Part of pipeline_body.h. */

static void keep_reals(REAL *x, const int *kept, int count)
{
    for (int i = 0; i < count; i++) x[i] = x[kept[i]];
}

/* Compacts a strip to the kept samples: their indices, positions and surface frames. */
static void keep_samples(const int *kept, int count, Strip *strip)
{
    REAL *const all[] = { strip->s,   strip->u,   strip->v,   strip->px,    strip->py,  strip->pz,
                          strip->pux, strip->puy, strip->puz, strip->pvx,   strip->pvy, strip->pvz,
                          strip->nx,  strip->ny,  strip->nz,  strip->n_len, strip->x,   strip->y };
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) keep_reals(all[k], kept, count);
    for (int i = 0; i < count; i++) {
        strip->index[i] = strip->index[kept[i]];
        strip->triangle[i] = strip->triangle[kept[i]];
    }
    strip->count = count;
}

/* Removes samples behind the stored depth before anything is computed for them (E53); the depth of the others is
   stored. */
static void keep_near(const WrTileJob *job, const WrSink *sink, Strip *strip, Watch *watch)
{
    const WrView *view = job->view;
    const float x = (float)view->deep[0], y = (float)view->deep[1], z = (float)view->deep[2];
    const float from = (float)view->deep_from;
    int kept[WR_SPAN], count = 0;
    for (int i = 0; i < strip->count; i++) {
        const float deep =
            x * (float)strip->px[i] + y * (float)strip->py[i] + z * (float)strip->pz[i];
        WrNearest *nearest = &sink->nearest[strip->index[i]];
        const WrNearest own = { from + deep, job->object };
        const bool first = own.depth == nearest->depth && own.object < nearest->object;
        if (!(own.depth < nearest->depth || first)) continue;
        *nearest = own;
        kept[count++] = i;
    }
    did(watch, WR_EFFECT_BETWEEN);
    if (count < strip->count) keep_samples(kept, count, strip);
    watch_lap(watch, WR_STAGE_BETWEEN);
}
