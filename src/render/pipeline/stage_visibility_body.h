/* stage_visibility_body.h - coverage of a mesh and (u,v) of its samples: by depth buffer and Newton's method, or
   from the uv cache (uv_cache.h). Part of pipeline_body.h. */

/* ---- curved surfaces ---- */

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

/* ---- triangles ---- */

/* Visibility of mesh triangles and the hit points on them. Part of pipeline_body.h. */

/* True if the corners' frames rotate a normal map. */
static bool turns_map(const WrTileJob *job)
{
    const WrNormalFrame frame = job->plan->map_frame;
    return frame == WR_FRAME_MIKK || frame == WR_FRAME_LECTURE;
}

/* Number of faces of a displaced surface; a strip's samples lie on one face. */
static int faces_of(const WrTileJob *job)
{
    return job->dice ? job->dice->faces : 1;
}

static bool on_face(const WrTileJob *job, int face, REAL triangle)
{
    const WrDice *dice = job->dice;
    if (!dice || dice->faces == 1) return true;
    return (int32_t)triangle < dice->end[face] &&
           (face == 0 || (int32_t)triangle >= dice->end[face - 1]);
}

/* P, n and everything else the plan needs, at the rays' hits on the triangles whose numbers are in u. */
static void meet(const WrTileJob *job, const Rays *rays, bool mapped, Strip *strip, Watch *watch)
{
    watch_lap(watch, WR_STAGE_VISIBILITY);
    if (strip->count == 0) return;
    const bool smooth = runs(job, WR_EFFECT_SMOOTH);
    const bool sloped =
        runs(job, WR_EFFECT_TANGENTS) || runs(job, WR_EFFECT_TINT) || job->plan->facets_filtered;
    for (int i = 0; i < strip->count &&
                    (job->dice || turns_map(job) || is_weighted(job) || runs(job, WR_EFFECT_CAST));
         i++)
        strip->triangle[i] = (int)strip->u[i];
    KERNELS_OF(job)->meet(rays, &job->triangle_look, smooth, mapped || sloped, sloped, strip);
    if (runs(job, WR_EFFECT_PARAMETERS)) did(watch, WR_EFFECT_PARAMETERS);
    if (runs(job, WR_EFFECT_TANGENTS)) did(watch, WR_EFFECT_TANGENTS);
    if (smooth) did(watch, WR_EFFECT_SMOOTH);
    watch_lap(watch, WR_STAGE_GEOMETRY);
}

/* The samples of the scatter that the mesh covers. */
static void meet_places(const WrTileJob *job, const Rays *rays, const WrDepthTile *tile,
                        const WrScatter *places, bool mapped, WrTileScratch *scratch, Watch *watch)
{
    Strip *strip = STRIP_OF(scratch);
    int count = 0;
    for (int i = 0; i < places->count; i++) {
        const int cell = places->cell[i];
        if (tile->close[cell] == -FLT_MAX) continue;
        if (!on_face(job, scratch->face, (REAL)tile->u[cell])) continue;
        strip->index[count] = i;
        strip->x[count] = (REAL)places->x[i];
        strip->y[count] = (REAL)places->y[i];
        strip->u[count++] = (REAL)tile->u[cell];
    }
    strip->count = count;
    meet(job, rays, mapped, strip, watch);
}

static void keep_face(const WrTileJob *job, int face, Strip *strip)
{
    int count = 0;
    if (faces_of(job) == 1) return;
    for (int i = 0; i < strip->count; i++) {
        if (!on_face(job, face, strip->u[i])) continue;
        strip->index[count] = strip->index[i];
        strip->x[count] = strip->x[i];
        strip->y[count] = strip->y[i];
        strip->u[count++] = strip->u[i];
    }
    strip->count = count;
}

/* The samples of row y that the mesh covers. */
static void meet_row(const WrTileJob *job, const Rays *rays, const WrDepthTile *tile, int y,
                     WrTileScratch *scratch, Watch *watch)
{
    Strip *strip = STRIP_OF(scratch);
    const size_t at = (size_t)y * (size_t)tile->w;
    KERNELS_OF(job)->covered(tile->close + at, tile->u + at, tile->v + at, (REAL)tile->x,
                             (REAL)(tile->y + y), tile->w, strip);
    keep_face(job, scratch->face, strip);
    meet(job, rays, runs(job, WR_EFFECT_PARAMETERS), strip, watch);
}
