/* pipe_mesh_body.h - which samples a mesh covers, and where on the surface: by the depth buffer and Newton's method, or as
   a resting view noted it (sight.h). A part of pipe_body.h. */

/* Part of a tangent that the last step may change it by. What fast arithmetic rounds is near that by itself: it may be more
   there, and normals turn by 1/32768 at most. */
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
/* In vectors written by hand. False: the stages do it. */
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

/* Make the parameters of what the mesh covers exact. */
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

/* The same of samples whose (u,v) were noted. */
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

/* Where a tile's cell is noted. */
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

/* The samples of the scatter that the mesh covers. */
static void locate_mesh(const WrTileJob *job, const Rays *rays, const WrDepthTile *tile,
                        const WrScatter *places, Strip *strip, Watch *watch)
{
    int count = 0;
    for (int i = 0; i < places->count; i++) {
        int cell = places->cell[i];
        if (job->sight) job->sight->u[note_at(job, tile, cell)] = WR_SIGHT_NONE;
        if (tile->close[cell] == -FLT_MAX) continue;
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

/* The same of what was noted. */
static void recall_mesh(const WrTileJob *job, const Rays *rays, const WrDepthTile *tile,
                        const WrScatter *places, Strip *strip, Watch *watch)
{
    int count = 0;
    for (int i = 0; i < places->count; i++) {
        const size_t at = note_at(job, tile, places->cell[i]);
        const float u = job->sight->u[at];
        if (u == WR_SIGHT_NONE) continue;
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

/* The same for the whole row y. */
static void locate_row(const WrTileJob *job, const Rays *rays, const WrDepthTile *tile, int y,
                       Strip *strip, Watch *watch)
{
    const size_t at = (size_t)y * (size_t)tile->w;
    const size_t noted = job->sight ? wr_tile_place(job, tile->x, tile->y + y) : 0;
    KERNELS_OF(job)->covered(tile->close + at, tile->u + at, tile->v + at, (REAL)tile->x,
                             (REAL)(tile->y + y), tile->w, strip);
    polish(job, rays, strip, watch);
    if (!job->sight) return;
    for (int x = 0; x < tile->w; x++) job->sight->u[noted + (size_t)x] = WR_SIGHT_NONE;
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
