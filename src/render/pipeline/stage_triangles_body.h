/* stage_triangles_body.h - visibility of mesh triangles and the hit points on them. Part of pipeline_body.h. */

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
    for (int i = 0; i < strip->count && (job->dice || turns_map(job) || runs(job, WR_EFFECT_CAST));
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
