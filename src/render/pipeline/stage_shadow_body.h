/* stage_shadow_body.h - self-shadowing of the relief: a lamp is visible if it stands above the table's
   horizon in its direction (render/kernels/kern_horizon_body.h). Part of pipeline_body.h. */

/* ---- self-shadowing by the horizon ---- */

static WR_T(WrKernHorizon) horizon_of(const WrTileJob *job)
{
    const WrHorizon *h = job->horizon;
    return (WR_T(WrKernHorizon)){ .slope = h->slope,
                                  .open = job->opening->open,
                                  .width = h->width,
                                  .height = h->height,
                                  .directions = h->directions,
                                  .ru = (REAL)job->look_double.ru,
                                  .rv = (REAL)job->look_double.rv,
                                  .relief = (REAL)job->relief_height,
                                  .steepest = (REAL)h->steepest };
}

/* Reads the lamp's cached visibility. False: it is unknown for some sample. */
static bool recall_seen(const WrTileJob *job, const float *known, const Strip *s,
                        REAL share[WR_SPAN], WrSeen *seen)
{
    int whole = 0, not = 0, decided = 0;
    for (int i = 0; i < s->count; i++) {
        share[i] = (REAL)known[share_place(job, s, i)];
        decided += share[i] >= (REAL)0;
        whole += !(share[i] < (REAL)1);
        not += !(share[i] > (REAL)0);
    }
    *seen = whole == s->count ? WR_SEEN_WHOLE : not == s->count ? WR_SEEN_NOT : WR_SEEN_PART;
    return decided == s->count;
}

/* Visibility of a lamp at the strip's samples. */
static WrSeen seen_of(const WrTileJob *job, const WR_T(WrKernLight) * light, const Strip *s,
                      REAL share[WR_SPAN], Watch *watch)
{
    const WR_T(WrKernHorizon) horizon = horizon_of(job);
    float *known = job->lamps ? job->lamps[light - VIEWED(job->view, lights)].relief : NULL;
    WrSeen seen;
    if (known && recall_seen(job, known, s, share, &seen)) return seen;
    did(watch, WR_EFFECT_SHADOW);
    seen = KERNELS_OF(job)->shadow(light, &horizon, s, share);
    for (int i = 0; i < s->count && known; i++) known[share_place(job, s, i)] = (float)share[i];
    return seen;
}

/* Light sums before a lamp is added. */
typedef struct Sums {
    REAL of[6][WR_SPAN];
} Sums;

static void keep_sums(const Strip *s, Sums *sums)
{
    const REAL *const from[6] = { s->dr, s->dg, s->db, s->sr, s->sg, s->sb };
    for (int k = 0; k < 6; k++) memcpy(sums->of[k], from[k], (size_t)s->count * sizeof(REAL));
}

/* Multiplies the lamp's light, already added to the strip, by its visibility. */
static void shadow_strip(const WrTileJob *job, const WR_T(WrKernLight) * light, const Sums *before,
                         Strip *s, Watch *watch)
{
    REAL *const to[6] = { s->dr, s->dg, s->db, s->sr, s->sg, s->sb };
    REAL share[WR_SPAN];
    const bool any = seen_of(job, light, s, share, watch) != WR_SEEN_WHOLE;
    for (int k = 0; k < 6 && any; k++) KERNELS_OF(job)->veil(share, before->of[k], s->count, to[k]);
    watch_lap(watch, WR_STAGE_SHADOW);
}

/* ---- shadows of objects ---- */

/* Shadows that objects throw on each other and on themselves (shadow_rays.h). Part of
   pipeline_body.h. */

/* The facet's normal times twice its area. */
static void facet_of(const WrTriangleLook *look, int32_t triangle, REAL n[3])
{
    const int32_t *corner = look->triangles + 3 * (size_t)triangle;
    const float *a = look->corners + 8 * (size_t)corner[0];
    const float *b = look->corners + 8 * (size_t)corner[1];
    const float *c = look->corners + 8 * (size_t)corner[2];
    REAL e[3], f[3];
    for (int k = 0; k < 3; k++) e[k] = (REAL)(b[k] - a[k]), f[k] = (REAL)(c[k] - a[k]);
    n[0] = e[1] * f[2] - e[2] * f[1];
    n[1] = e[2] * f[0] - e[0] * f[2];
    n[2] = e[0] * f[1] - e[1] * f[0];
}

/* The normal of the facet or of the surface, on the visible side, in world proportions of the object. */
static WrVec3 seen_normal(const WrTileJob *job, const Strip *s, int i, WrVec3 p)
{
    const WrView *view = job->view;
    const WrRaysd *rays = &view->lit.rays_d;
    WrVec3 n = { (double)s->nx[i], (double)s->ny[i], (double)s->nz[i] };
    if (job->dice) n = (WrVec3){ (double)s->bx[i], (double)s->by[i], (double)s->bz[i] };
    const WrTriangles *mesh = job->scene->triangles; /* NULL: the square without a file */
    if (met_whole(job) && !(mesh && mesh->patches)) {
        REAL facet[3];
        facet_of(&job->triangle_look, s->triangle[i], facet);
        n = (WrVec3){ (double)facet[0], (double)facet[1], (double)facet[2] };
    }
    const WrVec3 cofactor = { view->cofactor[0], view->cofactor[1], view->cofactor[2] };
    const WrVec3 at = rays->perspective
                          ? (WrVec3){ rays->eye[0] - p.x, rays->eye[1] - p.y, rays->eye[2] - p.z }
                          : (WrVec3){ rays->toward[0], rays->toward[1], rays->toward[2] };
    if (view->stretched) n = v3_times(n, cofactor);
    n = v3_unit(n, v3_unit(at, n));
    return v3_dot(n, at) < 0 ? v3_neg(n) : n;
}

/* Origin of the shadow rays. For a displaced surface: P + F n, not the view's facet. With parallax: the point on
   the base, which is the shadow caster. */
static WrVec3 start_of(const WrTileJob *job, int face, const Strip *s, int i)
{
    const WrVec3 n = { (double)s->nx[i], (double)s->ny[i], (double)s->nz[i] };
    const WrVec3 p = { (double)s->px[i], (double)s->py[i], (double)s->pz[i] };
    if (runs(job, WR_EFFECT_PARALLAX)) return v3_mad(p, n, -(double)s->f[i]);
    if (!job->dice || job->dice->base) return p;
    WrSurfacePoint at;
    wr_surface_at(&job->view->shape_d, face, (double)s->u[i], (double)s->v[i], &at);
    return v3_mad(at.p, at.n_unit, (double)s->f[i]);
}

/* Visibility of the lamp at sample i past objects: 0..1. */
static REAL cast_share(const WrTileJob *job, const WrKernLightd *lamp, const Strip *s, int i,
                       int face)
{
    const WrVec3 where = { lamp->where[0], lamp->where[1], lamp->where[2] };
    const WrVec3 p = start_of(job, face, s, i);
    const WrVec3 way = v3_sub(where, p);
    const double away = lamp->point ? v3_len(way) * job->cast_unit : INFINITY;
    const WrVec3 l = lamp->point ? v3_unit(way, (WrVec3){ 0, 0, 1 }) : where;
    return (REAL)wr_shadow_rays_share(job->cast, job->cast_count, v3_scale(p, job->cast_unit),
                                      seen_normal(job, s, i, p), l, away, lamp->radius);
}

/* Multiplies the lamp's light, already added to the strip, by its visibility past objects. */
static void cast_strip(const WrTileJob *job, const WR_T(WrKernLight) * light, const Sums *before,
                       Strip *s, Watch *watch)
{
    const ptrdiff_t at = light - VIEWED(job->view, lights);
    const WrKernLightd *lamp = &job->view->lights_d[at];
    float *known = job->lamps ? job->lamps[at].cast : NULL;
    REAL *const to[6] = { s->dr, s->dg, s->db, s->sr, s->sg, s->sb };
    bool asked = !job->relight; /* else only cached values are used */
    for (int i = 0; i < s->count && lamp->shadow; i++) {
        bool adds = false;
        for (int k = 0; k < 6; k++) adds |= to[k][i] != before->of[k][i];
        if (!adds) continue;
        float *kept = known ? &known[share_place(job, s, i)] : NULL;
        const bool stored = kept && *kept >= 0;
        const REAL share = stored ? (REAL)*kept : cast_share(job, lamp, s, i, watch->scratch->face);
        if (kept) *kept = (float)share;
        asked |= !stored;
        for (int k = 0; k < 6 && share < 1; k++)
            to[k][i] = before->of[k][i] + share * (to[k][i] - before->of[k][i]);
    }
    if (asked) did(watch, WR_EFFECT_CAST);
    watch_lap(watch, WR_STAGE_CAST);
}

/* ---- ambient occlusion ---- */

/* Ambient occlusion of ambient and environment light
   (render/textures/ambient_occlusion.h). Part of pipeline_body.h. */

static void open_share(const WrTileJob *job, const Strip *s, REAL share[WR_SPAN])
{
    const WR_T(WrKernHorizon) horizon = horizon_of(job);
    KERNELS_OF(job)->open(&horizon, s, share);
}

/* Multiplies the light added to the first sums since `before` by the unoccluded share of the sky; before NULL:
   all of it. */
static void open_strip(const WrTileJob *job, const Sums *before, REAL *const to[3], Strip *s,
                       Watch *watch)
{
    REAL share[WR_SPAN];
    if (!runs(job, WR_EFFECT_OCCLUSION)) return;
    open_share(job, s, share);
    for (int k = 0; k < 3; k++)
        KERNELS_OF(job)->veil(share, before ? before->of[k] : NULL, s->count, to[k]);
    did(watch, WR_EFFECT_OCCLUSION);
    watch_lap(watch, WR_STAGE_OCCLUSION);
}
