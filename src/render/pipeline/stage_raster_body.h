/* stage_raster_body.h - coverage of a mesh and (u,v) of its samples: by depth buffer and Newton's method, or
   from the uv cache (uv_cache.h). Part of pipeline_body.h. */

/* Largest relative change of a tangent by the last step. Fast arithmetic rounds by about that much anyway, so
   its limit is larger, and normals turn by 1/32768 at most. */
static double turn_of(const WrTileJob *job)
{
    return KERNELS_OF(job)->exact ? TURN : 8 * TURN;
}

static WR_T(WrNewton) newton_of(const WrTileJob *job)
{
    WR_T(WrNewton) how = job->mesh->newton;
    if (job->plan->newton < 0) how.steps += MORE_STEPS;
    how.last = wr_tile_exact(job) ? 0.0f : (float)turn_of(job);
    return how;
}

/* Refines the parameters of covered samples by Newton's method. */
static void polish(const WrTileJob *job, const Rays *rays, Strip *strip, Watch *watch)
{
    watch_lap(watch, WR_STAGE_VISIBILITY);
    if (strip->count == 0 || !job->newton) return;
    const WR_T(WrNewton) how = newton_of(job);
    KERNELS_OF(job)->polish[job->view->shape_d.kind](rays, &VIEWED(job->view, shape), &how, strip);
    did(watch, WR_EFFECT_NEWTON);
    watch_lap(watch, WR_STAGE_NEWTON);
}

/* Refines samples whose (u,v) come from the uv cache. */
static void resume(const WrTileJob *job, const Rays *rays, Strip *strip, Watch *watch)
{
    watch_lap(watch, WR_STAGE_VISIBILITY);
    if (strip->count == 0) return;
    const WR_T(WrNewton) how = newton_of(job);
    KERNELS_OF(job)->resume[job->view->shape_d.kind](rays, &VIEWED(job->view, shape), &how, strip);
    watch_lap(watch, WR_STAGE_NEWTON);
}

/* Index of a tile's cell in the uv cache. */
static size_t note_at(const WrTileJob *job, const WrDepthTile *tile, int cell)
{
    return wr_tile_place(job, tile->x + cell % tile->w, tile->y + cell / tile->w);
}

static void note(const WrTileJob *job, size_t at, const Strip *strip, int i)
{
    const float u = (float)strip->rx[i];
    job->uv_cache->u[at] = strip->wx[i] > (REAL)0 ? u : -u;
    job->uv_cache->v[at] = (float)strip->ry[i];
}

/* The samples of the scatter that the mesh covers. */
static void locate_mesh(const WrTileJob *job, const Rays *rays, const WrDepthTile *tile,
                        const WrScatter *places, Strip *strip, Watch *watch)
{
    int count = 0;
    for (int i = 0; i < places->count; i++) {
        int cell = places->cell[i];
        if (job->uv_cache) job->uv_cache->u[note_at(job, tile, cell)] = WR_UV_CACHE_NONE;
        if (tile->close[cell] == -FLT_MAX) continue;
        strip->index[count] = i;
        strip->x[count] = (REAL)places->x[i];
        strip->y[count] = (REAL)places->y[i];
        strip->u[count] = (REAL)tile->u[cell];
        strip->v[count++] = (REAL)tile->v[cell];
    }
    strip->count = count;
    polish(job, rays, strip, watch);
    for (int i = 0; i < count && job->uv_cache; i++)
        note(job, note_at(job, tile, places->cell[strip->index[i]]), strip, i);
}

/* The samples of the scatter that the uv cache holds. */
static void recall_mesh(const WrTileJob *job, const Rays *rays, const WrDepthTile *tile,
                        const WrScatter *places, Strip *strip, Watch *watch)
{
    int count = 0;
    for (int i = 0; i < places->count; i++) {
        const size_t at = note_at(job, tile, places->cell[i]);
        const float u = job->uv_cache->u[at];
        if (u == WR_UV_CACHE_NONE) continue;
        strip->index[count] = i;
        strip->x[count] = (REAL)places->x[i];
        strip->y[count] = (REAL)places->y[i];
        strip->u[count] = (REAL)fabsf(u);
        strip->wx[count] = signbit(u) ? (REAL)0 : (REAL)1;
        strip->v[count++] = (REAL)job->uv_cache->v[at];
    }
    strip->count = count;
    resume(job, rays, strip, watch);
}

/* The samples of row y that the mesh covers. */
static void locate_row(const WrTileJob *job, const Rays *rays, const WrDepthTile *tile, int y,
                       Strip *strip, Watch *watch)
{
    const size_t at = (size_t)y * (size_t)tile->w;
    const size_t noted = job->uv_cache ? wr_tile_place(job, tile->x, tile->y + y) : 0;
    strip->count = 0;
    KERNELS_OF(job)->covered(tile->close + at, tile->u + at, tile->v + at, (REAL)tile->x,
                             (REAL)(tile->y + y), tile->w, strip);
    polish(job, rays, strip, watch);
    if (!job->uv_cache) return;
    for (int x = 0; x < tile->w; x++) job->uv_cache->u[noted + (size_t)x] = WR_UV_CACHE_NONE;
    for (int i = 0; i < strip->count; i++) note(job, noted + (size_t)strip->index[i], strip, i);
}

static void recall_row(const WrTileJob *job, const Rays *rays, const WrDepthTile *tile, int y,
                       Strip *strip, Watch *watch)
{
    const size_t noted = wr_tile_place(job, tile->x, tile->y + y);
    KERNELS_OF(job)->recall(job->uv_cache->u + noted, job->uv_cache->v + noted, (REAL)tile->x,
                            (REAL)(tile->y + y), tile->w, strip);
    resume(job, rays, strip, watch);
}
