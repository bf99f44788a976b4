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

#ifdef HAS_WIDE
WrNewton wr_pipe_newton(const WrTileJob *job)
{
    return newton_of(job);
}

/* Solves with hand-written SIMD. False: the stages do the work. */
static bool solved_wide(const WrTileJob *job, const Rays *rays, const WrNewton *how, bool resumes,
                        Strip *strip)
{
    if (job->wide_newton) job->wide->newton(&job->sheet, rays, how, resumes, strip);
    return job->wide_newton;
}
#else
static bool solved_wide(const WrTileJob *job, const Rays *rays, const WR_T(WrNewton) * how,
                        bool resumes, const Strip *strip)
{
    (void)job, (void)rays, (void)how, (void)resumes, (void)strip;
    return false;
}
#endif

/* Refines the parameters of covered samples by Newton's method. */
static void polish(const WrTileJob *job, const Rays *rays, Strip *strip, Watch *watch)
{
    watch_lap(watch, WR_STAGE_VISIBILITY);
    if (strip->count == 0 || !job->newton) return;
    const WR_T(WrNewton) how = newton_of(job);
    if (!solved_wide(job, rays, &how, false, strip))
        KERNELS_OF(job)->polish[job->view->shape_d.kind](rays, &VIEWED(job->view, shape), &how,
                                                         strip);
    did(watch, WR_EFFECT_NEWTON);
    watch_lap(watch, WR_STAGE_NEWTON);
}

/* Refines samples whose (u,v) come from the uv cache. */
static void resume(const WrTileJob *job, const Rays *rays, Strip *strip, Watch *watch)
{
    watch_lap(watch, WR_STAGE_VISIBILITY);
    if (strip->count == 0) return;
    const WR_T(WrNewton) how = newton_of(job);
    if (!solved_wide(job, rays, &how, true, strip))
        KERNELS_OF(job)->resume[job->view->shape_d.kind](rays, &VIEWED(job->view, shape), &how,
                                                         strip);
    watch_lap(watch, WR_STAGE_NEWTON);
}

#ifdef HAS_WIDE
/* Appends samples that are interpolated from sparse hits: a run of a row, from (x, y) of the grid on. */
static void add_tied(const WrTileJob *job, const WrDepthTile *tile, int x, int y, int count,
                     int index, Strip *strip)
{
    int *restrict to = strip->index + strip->count;
    wr_sparse_hits_row(tile->knots, job->wide, x, y, count, strip->count, strip);
#pragma omp simd
    for (int i = 0; i < count; i++) to[i] = index + i;
    strip->count += count;
}

static bool met_tied(Strip *strip, Watch *watch)
{
    if (strip->count > 0) did(watch, WR_EFFECT_NEWTON); /* of sparse hits */
    watch_lap(watch, WR_STAGE_VISIBILITY);
    return strip->count > 0;
}

/* Interpolated samples of row y of the tile; false: there are none. */
static bool tied_row(const WrTileJob *job, const WrDepthTile *tile, int y, Strip *strip,
                     Watch *watch)
{
    const int gy = tile->y + y, end = tile->x + tile->w;
    strip->count = 0;
    for (int x = tile->x, to; x < end && tile->knots; x = to) {
        const bool sheet = wr_sparse_hits_at(tile->knots, x, gy) == WR_SPARSE_HITS_SHEET;
        for (to = x - x % WR_KNOT + WR_KNOT; to < end; to += WR_KNOT)
            if ((wr_sparse_hits_at(tile->knots, to, gy) == WR_SPARSE_HITS_SHEET) != sheet) break;
        to = to < end ? to : end;
        if (sheet) add_tied(job, tile, x, gy, to - x, x - tile->x, strip);
    }
    return met_tied(strip, watch);
}

/* Interpolated samples of the scatter; false: there are none. */
static bool tied_places(const WrTileJob *job, const WrDepthTile *tile, const WrScatter *places,
                        Strip *strip, Watch *watch)
{
    strip->count = 0;
    for (int i = 0, to; i < places->count && tile->knots; i = to) {
        const int cell = places->cell[i], x = tile->x + cell % tile->w;
        const int gy = tile->y + cell / tile->w, left = tile->w - cell % tile->w;
        const bool sheet = wr_sparse_hits_at(tile->knots, x, gy) == WR_SPARSE_HITS_SHEET;
        for (to = i + 1; to < places->count && to < i + left; to++) {
            const int on = x + to - i;
            if (places->cell[to] != cell + to - i) break;
            if ((wr_sparse_hits_at(tile->knots, on, gy) == WR_SPARSE_HITS_SHEET) != sheet) break;
        }
        if (sheet) add_tied(job, tile, x, gy, to - i, i, strip);
    }
    return met_tied(strip, watch);
}
#else
static bool tied_row(const WrTileJob *job, const WrDepthTile *tile, int y, const Strip *strip,
                     const Watch *watch)
{
    (void)job, (void)tile, (void)y, (void)strip, (void)watch;
    return false;
}

static bool tied_places(const WrTileJob *job, const WrDepthTile *tile, const WrScatter *places,
                        const Strip *strip, const Watch *watch)
{
    (void)job, (void)tile, (void)places, (void)strip, (void)watch;
    return false;
}
#endif

/* Index of a tile's cell in the uv cache. */
static size_t note_at(const WrTileJob *job, const WrDepthTile *tile, int cell)
{
    return wr_tile_place(job, tile->x + cell % tile->w, tile->y + cell / tile->w);
}

static void note(const WrTileJob *job, size_t at, const Strip *strip, int i)
{
    const float u = (float)strip->rx[i];
    job->sight->u[at] = strip->wx[i] > (REAL)0 ? u : -u;
    job->sight->v[at] = (float)strip->ry[i];
}

/* True if sparse hits cover the whole tile. */
static bool is_told(const WrDepthTile *tile)
{
    return tile->knots && !tile->untold;
}

/* The samples of the scatter that the mesh covers. */
static void locate_mesh(const WrTileJob *job, const Rays *rays, const WrDepthTile *tile,
                        const WrScatter *places, Strip *strip, Watch *watch)
{
    int count = 0;
    for (int i = 0; i < places->count; i++) {
        int cell = places->cell[i];
        if (job->sight) job->sight->u[note_at(job, tile, cell)] = WR_UV_CACHE_NONE;
        if (is_told(tile) || tile->close[cell] == -FLT_MAX) continue;
        strip->index[count] = i;
        strip->x[count] = (REAL)places->x[i];
        strip->y[count] = (REAL)places->y[i];
        strip->u[count] = (REAL)tile->u[cell];
        strip->v[count++] = (REAL)tile->v[cell];
    }
    strip->count = count;
    polish(job, rays, strip, watch);
    for (int i = 0; i < count && job->sight; i++)
        note(job, note_at(job, tile, places->cell[strip->index[i]]), strip, i);
}

/* The samples of the scatter that the uv cache holds. */
static void recall_mesh(const WrTileJob *job, const Rays *rays, const WrDepthTile *tile,
                        const WrScatter *places, Strip *strip, Watch *watch)
{
    int count = 0;
    for (int i = 0; i < places->count; i++) {
        const size_t at = note_at(job, tile, places->cell[i]);
        const float u = job->sight->u[at];
        if (u == WR_UV_CACHE_NONE) continue;
        strip->index[count] = i;
        strip->x[count] = (REAL)places->x[i];
        strip->y[count] = (REAL)places->y[i];
        strip->u[count] = (REAL)fabsf(u);
        strip->wx[count] = signbit(u) ? (REAL)0 : (REAL)1;
        strip->v[count++] = (REAL)job->sight->v[at];
    }
    strip->count = count;
    resume(job, rays, strip, watch);
}

/* The samples of row y that the mesh covers. */
static void locate_row(const WrTileJob *job, const Rays *rays, const WrDepthTile *tile, int y,
                       Strip *strip, Watch *watch)
{
    const size_t at = (size_t)y * (size_t)tile->w;
    const size_t noted = job->sight ? wr_tile_place(job, tile->x, tile->y + y) : 0;
    strip->count = 0;
    if (!is_told(tile))
        KERNELS_OF(job)->covered(tile->close + at, tile->u + at, tile->v + at, (REAL)tile->x,
                                 (REAL)(tile->y + y), tile->w, strip);
    polish(job, rays, strip, watch);
    if (!job->sight) return;
    for (int x = 0; x < tile->w; x++) job->sight->u[noted + (size_t)x] = WR_UV_CACHE_NONE;
    for (int i = 0; i < strip->count; i++) note(job, noted + (size_t)strip->index[i], strip, i);
}

static void recall_row(const WrTileJob *job, const Rays *rays, const WrDepthTile *tile, int y,
                       Strip *strip, Watch *watch)
{
    const size_t noted = wr_tile_place(job, tile->x, tile->y + y);
    KERNELS_OF(job)->recall(job->sight->u + noted, job->sight->v + noted, (REAL)tile->x,
                            (REAL)(tile->y + y), tile->w, strip);
    resume(job, rays, strip, watch);
}
