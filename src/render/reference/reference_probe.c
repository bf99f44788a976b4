/* Pixel inspector: all quantities of the formulas at one point of a picture, by the scene's own scheme and bump
   mode, in double. */
#include "render/reference/reference.h"

#include "base/error.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"
#include "render/reference/reference_shadow_rays.h"
#include "render/reference/reference_parallax.h"
#include "scene/scene.h"
#include "shade/bump.h"

#include <math.h>

#define FOOTPRINT_MAX 1e9 /* texels per pixel: limit, because outlines and poles have none */
#define PICTURE_MAX 16384

/* A scene's picture, prepared for probes. */
typedef struct Looker {
    WrReferenceStage stage;
    const WrField *field;
    double texels_u, texels_v; /* texels per unit of the patch's u, v */
    WrReferenceRay per_x, per_y;
} Looker;

static bool looker_init(Looker *looker, const WrField *field, const WrScene *scene, int width,
                        int height, double turn_deg, bool table, WrPool *pool, WrError *err)
{
    if (width < 1 || height < 1 || width > PICTURE_MAX || height > PICTURE_MAX)
        return wr_fail(err, "picture size %dx%d: each side must be 1..%d", width, height,
                       PICTURE_MAX);
    *looker = (Looker){ .field = field };
    /* Rays intersect a displaced surface, or a relief, as in the reference, which uses the spline of the table. */
    const bool displaced = wr_reference_displaced(scene) || wr_reference_has_parallax(scene);
    if (!wr_reference_stage_init(&looker->stage, field, scene, turn_deg, width, height,
                                 table || displaced, pool, err) ||
        !wr_reference_stage_raise(&looker->stage, field, pool, err))
        return false;
    looker->texels_u = scene->replicate_u * (field ? wr_field_width(field) : 1);
    looker->texels_v = -scene->replicate_v * (field ? wr_field_height(field) : 1);
    wr_reference_view_spread(&looker->stage.view, &looker->per_x, &looker->per_y);
    return true;
}

static double within_reach(double x)
{
    return x > FOOTPRINT_MAX ? FOOTPRINT_MAX : x >= -FOOTPRINT_MAX ? x : -FOOTPRINT_MAX;
}

/* Motion of the point under the ray over the table, texels, when the ray moves by (w.q, w.d): to first order P +
   Pu du + Pv dv stays on it, Pu du + Pv dv - d ds = w.q + s w.d. Along the outline and where a tangent vanishes
   it is FOOTPRINT_MAX with the sign, 0 if there is no motion. */
static void footprint(const Looker *looker, const WrSurfacePoint *at, const WrReferenceRay *ray,
                      double s, const WrReferenceRay *w, double out[2])
{
    const WrVec3 move = v3_mad(w->q, w->d, s);
    const WrVec3 a = v3_cross(at->pv, ray->d), b = v3_cross(ray->d, at->pu);
    const double det = v3_dot(at->pu, a);
    const double across = looker->texels_u * v3_dot(move, a);
    const double down = looker->texels_v * v3_dot(move, b);
    out[0] = across == 0 ? 0 : within_reach(across / det);
    out[1] = down == 0 ? 0 : within_reach(down / det);
}

static bool is_raised(const Looker *looker)
{
    return looker->stage.raised.count > 0;
}

static bool hit_surface(const Looker *looker, const WrReferenceRay *ray, WrReferenceHit *hit)
{
    const WrReferenceStage *stage = &looker->stage;
    WrSurfacePoint at;
    double side;
    if (is_raised(looker)) return wr_reference_raised_hit(&stage->raised, ray, hit);
    if (stage->parallax) return wr_reference_parallax(stage, ray, hit, &at, &side);
    return wr_reference_view_hit(&stage->view, ray, hit);
}

/* The visible surface to first order: of a displaced one P + F n, and its derivatives by u and v. */
static WrSurfacePoint seen_at(const Looker *looker, const WrSurfacePoint *at, double f, double fu,
                              double fv)
{
    WrSurfacePoint out = *at;
    if (!is_raised(looker)) return out;
    out.p = v3_mad(at->p, at->n_unit, f);
    out.pu = v3_mad(v3_mad(at->pu, at->n_unit, fu), at->n_u, f);
    out.pv = v3_mad(v3_mad(at->pv, at->n_unit, fv), at->n_v, f);
    return out;
}

static double level_of(const double footprint[4])
{
    const double x = hypot(footprint[0], footprint[1]), y = hypot(footprint[2], footprint[3]);
    const double longer = x > y ? x : y;
    return longer > 1 ? log2(longer) : 0;
}

/* Triangles are flat: the exact formula's terms in F and its Pu x Pv, which is along n only for a patch, do not
   apply to them. */
static WrBumpMode mode_of(const Looker *looker, WrBumpMode mode)
{
    if (is_raised(looker)) return WR_BUMP_EXACT;
    return looker->stage.view.info->held && mode == WR_BUMP_EXACT ? WR_BUMP_BLINN : mode;
}

static double dropped_deg(const Looker *looker, const WrSurfacePoint *at, double f, double fu,
                          double fv, WrVec3 *perturbed_exact)
{
    *perturbed_exact = wr_reference_normal(mode_of(looker, WR_BUMP_EXACT), at, f, fu, fv);
    return wr_bump_tilt_deg(*perturbed_exact, wr_reference_normal(WR_BUMP_BLINN, at, f, fu, fv));
}

static int samples_of(const WrDials *dials)
{
    return dials->aa == WR_AA_SUPERSAMPLE || dials->aa == WR_AA_ADAPTIVE ? dials->samples : 1;
}

bool wr_reference_probe(const WrField *field, const WrScene *scene, int width, int height,
                        double turn_deg, double x, double y, WrProbe *out, WrError *err)
{
    Looker looker = { 0 };
    if (!looker_init(&looker, field, scene, width, height, turn_deg, false, NULL, err)) {
        wr_reference_stage_fini(&looker.stage);
        return false;
    }
    const WrReferenceView *view = &looker.stage.view;
    const WrReferenceRay ray = wr_reference_view_ray(view, x, y);
    WrReferenceHit hit;
    WrProbe probe = { .hit = hit_surface(&looker, &ray, &hit) };
    if (probe.hit) {
        WrSurfacePoint *at = &probe.at;
        probe.u = hit.u, probe.v = hit.v, probe.face = hit.face;
        wr_reference_view_at(view, &hit, at);
        wr_scene_height(scene, field, hit.u, hit.v, &probe.f, &probe.fu, &probe.fv);
        wr_reference_add_map(&looker.stage, &hit, at, &probe.fu, &probe.fv);
        probe.d = wr_bump_d(at->n_unit, at->pu, at->pv, probe.fu, probe.fv);
        probe.a = wr_bump_axis(at->pu, at->pv, probe.fu, probe.fv);
        probe.perturbed =
            wr_reference_normal(mode_of(&looker, scene->bump), at, probe.f, probe.fu, probe.fv);
        probe.tilt_deg = wr_bump_tilt_deg(at->n_unit, probe.perturbed);
        probe.dropped_deg =
            dropped_deg(&looker, at, probe.f, probe.fu, probe.fv, &probe.perturbed_exact);
        const WrSurfacePoint there = seen_at(&looker, at, probe.f, probe.fu, probe.fv);
        footprint(&looker, &there, &ray, hit.s, &looker.per_x, probe.footprint);
        footprint(&looker, &there, &ray, hit.s, &looker.per_y, probe.footprint + 2);
        probe.level = level_of(probe.footprint);
        probe.samples = samples_of(&scene->dials);
        WrReferenceCaster own;
        wr_reference_caster(&own, &looker.stage);
        looker.stage.casters = &own, looker.stage.caster_count = 1;
        const bool back = v3_dot(probe.perturbed, ray.d) > 0;
        const double side = is_raised(&looker) ? (back ? -1 : 1) : wr_reference_side(view, at);
        const WrVec3 seen = v3_scale(probe.perturbed, side);
        wr_reference_light(&looker.stage, &there, &hit, wr_reference_normal_stretched(view, seen),
                           (WrReferenceShare){ 0, 1 }, probe.rgb);
    }
    wr_reference_stage_fini(&looker.stage);
    *out = probe;
    return true;
}

typedef struct MapJob {
    Looker looker;
    WrProbeMap map;
    int width;
    const volatile int *cancel;
    float *out;
} MapJob;

/* Fetch by the scene's scheme; bspline-fit from coefficients in double, computed once. */
static void look_up(const Looker *looker, double u, double v, double *f, double *fu, double *fv)
{
    if (looker->stage.table.c) wr_reference_height(&looker->stage, u, v, f, fu, fv);
    else wr_scene_height(looker->stage.scene, looker->field, u, v, f, fu, fv);
}

/* Code of a unit vector's coordinate. */
static int code_of(double c)
{
    return (int)rint(127.5 + 127.5 * c);
}

static float quantity(const MapJob *job, const WrSurfacePoint *at, double f, double fu, double fv)
{
    WrVec3 exact;
    if (job->map == WR_MAP_DROPPED) return (float)dropped_deg(&job->looker, at, f, fu, fv, &exact);
    if (job->map == WR_MAP_HEIGHT) return (float)f;
    const WrBumpMode mode = mode_of(&job->looker, job->looker.stage.scene->bump);
    const WrVec3 n = wr_reference_normal(mode, at, f, fu, fv);
    if (job->map == WR_MAP_NORMAL)
        return (float)(65536 * code_of(n.x) + 256 * code_of(n.y) + code_of(n.z));
    return (float)wr_bump_tilt_deg(at->n_unit, n);
}

static float level_at(const Looker *looker, const WrSurfacePoint *base, const WrReferenceHit *hit,
                      const WrReferenceRay *ray)
{
    double pixel[4], f = 0, fu = 0, fv = 0;
    const double s = hit->s;
    if (is_raised(looker)) wr_reference_height(&looker->stage, hit->u, hit->v, &f, &fu, &fv);
    const WrSurfacePoint there = seen_at(looker, base, f, fu, fv), *at = &there;
    footprint(looker, at, ray, s, &looker->per_x, pixel);
    footprint(looker, at, ray, s, &looker->per_y, pixel + 2);
    return (float)level_of(pixel);
}

static void map_row(int y, int worker, void *ctx)
{
    (void)worker;
    const MapJob *job = ctx;
    const Looker *looker = &job->looker;
    const WrReferenceView *view = &looker->stage.view;
    float *out = job->out + (size_t)y * (size_t)job->width;
    if (wr_cancel_asked(job->cancel)) return;
    for (int x = 0; x < job->width; x++) {
        const WrReferenceRay ray = wr_reference_view_ray(view, x + 0.5, y + 0.5);
        WrReferenceHit hit;
        out[x] = NAN;
        if (!hit_surface(looker, &ray, &hit)) continue;
        WrSurfacePoint at;
        wr_reference_view_at(view, &hit, &at);
        if (job->map == WR_MAP_LEVEL) {
            out[x] = level_at(looker, &at, &hit, &ray);
            continue;
        }
        double f, fu, fv;
        look_up(looker, hit.u, hit.v, &f, &fu, &fv);
        wr_reference_add_map(&looker->stage, &hit, &at, &fu, &fv);
        out[x] = quantity(job, &at, f, fu, fv);
    }
}

bool wr_reference_map(const WrField *field, const WrScene *scene, int width, int height,
                      double turn_deg, WrProbeMap map, WrPool *pool, const volatile int *cancel,
                      float *out, WrError *err)
{
    MapJob job = { .map = map, .width = width, .cancel = cancel, .out = out };
    /* A single fetch by the scheme would compute that texel's coefficients each time. */
    const bool table = wr_schemes[scene->scheme].taps == WR_TAPS_FITTED && map != WR_MAP_LEVEL;
    bool good = looker_init(&job.looker, field, scene, width, height, turn_deg, table, pool, err);
    if (good) wr_pool_run(pool, height, map_row, &job);
    wr_reference_stage_fini(&job.looker.stage);
    if (good && wr_cancel_asked(cancel)) return wr_fail(err, "cancelled");
    return good;
}
