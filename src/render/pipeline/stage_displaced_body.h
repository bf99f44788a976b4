/* stage_displaced_body.h - surface frame of displaced surfaces, at hits on facets or on the relief. Part of
   pipeline_body.h. */

/* The base's frame at u and v; P stays at the hit on the facet or the relief. */
static void base_strip(const WrTileJob *job, int face, Strip *strip, Watch *watch)
{
    const size_t size = (size_t)strip->count * sizeof(REAL);
    memcpy(strip->bx, strip->px, size);
    memcpy(strip->by, strip->py, size);
    memcpy(strip->bz, strip->pz, size);
    KERNELS_OF(job)->geometry[job->view->shape_d.kind](&VIEWED(job->view, shape), face, strip);
    if (runs(job, WR_EFFECT_PARALLAX)) keep_lift(strip);
    memcpy(strip->px, strip->bx, size);
    memcpy(strip->py, strip->by, size);
    memcpy(strip->pz, strip->bz, size);
    if (job->dice) did(watch, WR_EFFECT_DISPLACED);
    watch_lap(watch, WR_STAGE_GEOMETRY);
}

/* Cosine between n' and a facet of a mesh's relief below which the facet's side says nothing: facets of about a pixel
   may be tilted by their error, and those at creases are. */
#define TILTED (REAL)0.3

/* Turns n' of a displaced surface to the visible side of the facet, whichever side of the base that is. */
static void face_viewer(const WrTileJob *job, const Rays *rays, Strip *strip)
{
    const REAL *at = rays->perspective ? rays->eye : rays->toward;
    const REAL move = rays->perspective ? (REAL)1 : (REAL)0;
    for (int i = 0; i < strip->count; i++) {
        REAL n[3];
        facet_of(&job->triangle_look, strip->triangle[i], n);
        const VEC view = { at[0] - move * strip->px[i], at[1] - move * strip->py[i],
                           at[2] - move * strip->pz[i] };
        const VEC facet = { n[0], n[1], n[2] };
        const VEC bumped = { strip->bx[i], strip->by[i], strip->bz[i] };
        const REAL along = v_dot(facet, bumped);
        const REAL least = TILTED * length_of(facet) * length_of(bumped);
        const bool tilted = job->dice->base && along < least && -along < least;
        const REAL side = tilted ? v_dot(bumped, view) : v_dot(facet, view) * along;
        const REAL sign = side < (REAL)0 ? (REAL)-1 : (REAL)1;
        strip->bx[i] *= sign;
        strip->by[i] *= sign;
        strip->bz[i] *= sign;
    }
}
