#include "render/reference/reference.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"
#include "render/frame/frame.h"
#include "render/reference/reference_relief.h"
#include "render/reference/reference_shade.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "shade/bump.h"
#include "system/clock.h"

#include <math.h>
#include <string.h>

/* ---- probe ---- */

/* Pixel inspector: all quantities of the formulas at one point of a picture, by the scene's own scheme and bump
   mode, in double. */

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

/* The longer side of the footprint: level l halves the table l times. */
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
    if (is_raised(looker)) mode = WR_BUMP_EXACT;
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

static void height_by_scheme(const Looker *looker, const WrReferenceHit *hit, double *f, double *fu,
                             double *fv)
{
    const WrScene *scene = looker->stage.scene;
    const WrTriangles *mesh = scene->triangles;
    if (mesh && mesh->weights)
        wr_scene_weighted_height(scene, looker->field, mesh, hit->triangle, hit->share[0],
                                 hit->share[1], f, fu, fv);
    else wr_scene_height(scene, looker->field, hit->u, hit->v, f, fu, fv);
}

/* The probe uses the scene's own approximations (scheme, mode), and shows the exact normal beside them. */
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
        wr_reference_surface_point(view, &hit, at);
        height_by_scheme(&looker, &hit, &probe.f, &probe.fu, &probe.fv);
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

/* Fetch by the scene's scheme; bspline-fit from coefficients in double, computed once.
   57 x 57 texels a coefficient would be summed for every pixel otherwise. */
static void look_up(const Looker *looker, const WrReferenceHit *hit, double *f, double *fu,
                    double *fv)
{
    if (looker->stage.table.c) wr_reference_height_at(&looker->stage, hit, f, fu, fv);
    else height_by_scheme(looker, hit, f, fu, fv);
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
    if (is_raised(looker)) wr_reference_height_at(&looker->stage, hit, &f, &fu, &fv);
    const WrSurfacePoint there = seen_at(looker, base, f, fu, fv), *at = &there;
    footprint(looker, at, ray, s, &looker->per_x, pixel);
    footprint(looker, at, ray, s, &looker->per_y, pixel + 2);
    return (float)level_of(pixel);
}

/* NAN marks pixels without the object. */
static void map_row(int y, int worker, void *ctx)
{
    (void)worker;
    const MapJob *job = ctx;
    const Looker *looker = &job->looker;
    const WrReferenceView *view = &looker->stage.view;
    float *out = job->out + (size_t)y * (size_t)job->width;
    if (wr_cancel_requested(job->cancel)) return;
    for (int x = 0; x < job->width; x++) {
        const WrReferenceRay ray = wr_reference_view_ray(view, x + 0.5, y + 0.5);
        WrReferenceHit hit;
        out[x] = NAN;
        if (!hit_surface(looker, &ray, &hit)) continue;
        WrSurfacePoint at;
        wr_reference_surface_point(view, &hit, &at);
        if (job->map == WR_MAP_LEVEL) {
            out[x] = level_at(looker, &at, &hit, &ray);
            continue;
        }
        double f, fu, fv;
        look_up(looker, &hit, &f, &fu, &fv);
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
    if (good && wr_cancel_requested(cancel)) return wr_fail(err, "cancelled");
    return good;
}

#define SIZE_MAX_PIXELS 4096
#define SAMPLES_MAX 64

/* The visible objects; each sample shows the nearest. */
typedef struct Set {
    WrReferenceStage stage[WR_OBJECTS_MAX];
    WrScene *part[WR_OBJECTS_MAX]; /* own */
    WrReferenceCaster casters[WR_OBJECTS_MAX];
    int count;
} Set;

/* One picture of k x k samples a pixel. */
typedef struct Pass {
    const Set *set;
    const WrReferenceRequest *request;
    int k;
    double *rgba;   /* owned */
    double *normal; /* [height][width][3], or NULL: already computed */
    int64_t *lost;  /* [height] */
} Pass;

/* Change of a row from one picture to the next. */
typedef struct Change {
    double squares, most;
    int64_t covered;
} Change;

static bool wanted(const WrReferenceRequest *request, int x, int y)
{
    if (!request->only) return true;
    const int across = (request->width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK;
    return request->only[y / WR_FRAME_BLOCK * across + x / WR_FRAME_BLOCK] != 0;
}

/* Sum of `count` values, added in pairs; they are overwritten. */
static double pair_sum(double *values, int count)
{
    for (; count > 1; count = (count + 1) / 2) {
        for (int i = 0; i < count / 2; i++) values[i] = values[2 * i] + values[2 * i + 1];
        if (count % 2) values[count / 2] = values[count - 1];
    }
    return count > 0 ? values[0] : 0;
}

/* With k >= 4 a sample uses one of k shares of the lamps' and surroundings' points. Row j is shifted by step
   j, with an odd step near 0.38 k, so that neighbouring samples use distant shares; each share is used k
   times. */
static const WrReferenceShare all = { 0, 1 };

/* For light from all directions each of a pixel's k x k samples uses 1/k of them, by a lattice in which each
   part occurs k times, evenly spread. */
static WrReferenceShare share_of(int k, int i, int j)
{
    const int step = (int)(0.382 * k) | 1;
    return k < 4 ? all : (WrReferenceShare){ (i + step * j) % k, k };
}

static bool sample_set(const Set *set, double x, double y, WrReferenceShare share,
                       WrReferenceSample *out)
{
    bool any = false;
    for (int i = 0; i < set->count; i++) {
        WrReferenceSample sample;
        if (!wr_reference_sample(&set->stage[i], x, y, share, &sample)) continue;
        if (any && !(sample.depth < out->depth)) continue;
        any = true;
        *out = sample;
    }
    return any;
}

/* Mean of k x k intensities, premultiplied; adds the samples whose inversion did not converge to *lost.
   Pairwise sums, first in rows, then over rows: equal samples have an exact mean for k = 2^m (HC92). */
static void sample_pixel(const Pass *pass, int x, int y, double rgba[4], int64_t *lost)
{
    const int k = pass->k;
    double sums[3][SAMPLES_MAX], row[3][SAMPLES_MAX];
    double hits = 0;
    for (int j = 0; j < k; j++) {
        for (int i = 0; i < k; i++) {
            WrReferenceSample sample = { .rgb = { 0, 0, 0 } };
            if (sample_set(pass->set, x + (i + 0.5) / k, y + (j + 0.5) / k, share_of(k, i, j),
                           &sample)) {
                hits += sample.cover;
                *lost += sample.lost;
            }
            for (int c = 0; c < 3; c++) row[c][i] = sample.rgb[c];
        }
        for (int c = 0; c < 3; c++) sums[c][j] = pair_sum(row[c], k);
    }
    for (int c = 0; c < 3; c++) rgba[c] = pair_sum(sums[c], k) / (k * k);
    rgba[3] = hits / (k * k);
}

static void render_row(int y, int worker, void *ctx)
{
    (void)worker;
    const Pass *pass = ctx;
    const WrReferenceRequest *request = pass->request;
    const size_t row = (size_t)y * (size_t)request->width;
    for (int x = 0; x < request->width; x++) {
        if (wr_cancel_requested(request->cancel)) return;
        if (!wanted(request, x, y)) continue;
        sample_pixel(pass, x, y, pass->rgba + 4 * (row + (size_t)x), &pass->lost[y]);
        WrReferenceSample centre;
        if (!pass->normal || !sample_set(pass->set, x + 0.5, y + 0.5, all, &centre)) continue;
        double *n = pass->normal + 3 * (row + (size_t)x);
        n[0] = centre.normal.x, n[1] = centre.normal.y, n[2] = centre.normal.z;
    }
}

static Change compare_row(const double *a, const double *b, int width)
{
    Change change = { 0 };
    for (int x = 0; x < width; x++, a += 4, b += 4) {
        if (a[3] == 0 && b[3] == 0) continue;
        change.covered++;
        for (int c = 0; c < 3; c++) {
            const double d = fabs(a[c] - b[c]);
            change.squares += d * d;
            change.most = d > change.most ? d : change.most;
        }
    }
    return change;
}

/* RMS and largest difference of two pictures over the pixels that either covers. */
static void compare(const WrReferenceRequest *request, const double *a, const double *b,
                    WrReference *out)
{
    double *squares = wr_alloc((size_t)request->height, sizeof *squares);
    int64_t covered = 0;
    out->last_max = 0;
    for (int y = 0; y < request->height; y++) {
        const size_t row = 4 * (size_t)y * (size_t)request->width;
        const Change change = compare_row(a + row, b + row, request->width);
        squares[y] = change.squares;
        covered += change.covered;
        out->last_max = fmax(out->last_max, change.most);
    }
    const double sum = pair_sum(squares, request->height);
    out->last_rms = covered > 0 ? sqrt(sum / (3 * (double)covered)) : 0;
    wr_free(squares);
}

static bool check(const WrReferenceRequest *request, WrError *err)
{
    if (request->width < 1 || request->height < 1 || request->width > SIZE_MAX_PIXELS ||
        request->height > SIZE_MAX_PIXELS)
        return wr_fail(err, "reference picture %dx%d: each side must be 1..%d", request->width,
                       request->height, SIZE_MAX_PIXELS);
    const int first = request->first, most = request->most;
    if (first < 0 || first > SAMPLES_MAX || (first & (first - 1)) != 0)
        return wr_fail(err, "reference: %d initial samples a side: must be 1, 2, 4 .. %d", first,
                       SAMPLES_MAX);
    if (most < 0 || most > SAMPLES_MAX || (most > 0 && most < first))
        return wr_fail(err, "reference: %d samples a side at most: must be %d..%d", most,
                       first > 0 ? first : 1, SAMPLES_MAX);
    if (!(request->change_rms >= 0))
        return wr_fail(err, "reference: change %g: must be 0 or above", request->change_rms);
    return true;
}

/* Renders one picture at k into `rgba`, which is cleared first. */
static bool render_pass(const Set *set, const WrReferenceRequest *request, int k, WrPool *pool,
                        WrReference *out, double *rgba, WrError *err)
{
    Pass pass = { set, request, k, rgba, out->normal, NULL };
    if (out->samples > 0) pass.normal = NULL; /* the first picture has computed the normals */
    memset(rgba, 0, 4 * (size_t)request->width * (size_t)request->height * sizeof *rgba);
    pass.lost = wr_alloc((size_t)request->height, sizeof *pass.lost);
    wr_pool_run(pool, request->height, render_row, &pass);
    out->lost = 0;
    for (int y = 0; y < request->height; y++) out->lost += pass.lost[y];
    wr_free(pass.lost);
    if (wr_cancel_requested(request->cancel)) return wr_fail(err, "cancelled");
    out->samples = k;
    return true;
}

/* Largest k if the caller sets no limit: a ray needs ten times as long with displacement or parallax. */
static int most_of(const WrReferenceRequest *request)
{
    bool displaced = false;
    for (int i = 0; i < wr_scene_object_count(request->scene); i++)
        displaced = displaced || wr_reference_displaced(wr_scene_object(request->scene, i)) ||
                    wr_reference_has_parallax(wr_scene_object(request->scene, i));
    const int own = displaced ? 16 : 32;
    return request->most > 0 ? request->most : request->first > own ? 64 : own;
}

/* Doubles k until the picture no longer changes or the limit is reached.
   The change from k to 2k is the measure of convergence: for errors ~ k^-p with p >= 1 it is at least the error of the
   finer picture. */
static bool refine(const Set *set, const WrReferenceRequest *request, WrPool *pool,
                   WrReference *out, WrError *err)
{
    const int most = most_of(request);
    int k = request->first > 0 ? request->first : 4;
    while (k > most) k /= 2;
    const size_t pixels = (size_t)request->width * (size_t)request->height;
    double *finer = NULL;
    if (2 * k <= most) {
        finer = wr_try_alloc(pixels, 4 * sizeof *finer, "the reference's picture", err);
        if (!finer) return false;
    }
    bool good = render_pass(set, request, k, pool, out, out->rgba, err);
    while (good && !out->converged && 2 * out->samples <= most) {
        good = render_pass(set, request, 2 * out->samples, pool, out, finer, err);
        if (!good) break;
        compare(request, out->rgba, finer, out);
        double *coarse = out->rgba;
        out->rgba = finer, finer = coarse;
        out->converged = out->last_rms < request->change_rms;
    }
    if (out->last_rms == 0) out->converged = true; /* after a last doubling; not if it is NAN */
    wr_free(finer);
    return good;
}

/* Each object is rendered alone with the camera of the whole scene; sample_set compares depths. */
static bool make_set(Set *set, const WrReferenceRequest *request, WrPool *pool, WrError *err)
{
    const WrScene *scene = request->scene;
    bool good = true;
    for (int i = 0; i < wr_scene_object_count(scene) && good; i++) {
        if (!wr_scene_shows(scene, i, (double)request->width / request->height)) continue;
        const WrField *own = request->fields ? request->fields[i] : NULL;
        WrScene *part = wr_scene_object_alone(scene, i, (double)request->width / request->height);
        set->part[set->count] = part;
        good = wr_reference_stage_init(&set->stage[set->count++], own ? own : request->field, part,
                                       request->turn_deg, request->width, request->height, true,
                                       pool, err) &&
               wr_reference_stage_raise(&set->stage[set->count - 1], own ? own : request->field,
                                        pool, err);
    }
    for (int i = 0; i < set->count && good; i++) {
        wr_reference_caster(&set->casters[i], &set->stage[i]);
        set->stage[i].casters = set->casters, set->stage[i].caster_count = set->count;
    }
    return good;
}

static void free_set(Set *set)
{
    for (int i = 0; i < set->count; i++) {
        wr_reference_stage_fini(&set->stage[i]);
        wr_scene_free(set->part[i]);
    }
    wr_free(set);
}

bool wr_reference_render(const WrReferenceRequest *request, WrPool *pool, WrReference *out,
                         WrError *err)
{
    const double started = wr_clock_seconds();
    if (!check(request, err)) return false;
    WrReference made = {
        .width = request->width, .height = request->height, .last_rms = NAN, .last_max = NAN
    };
    const size_t pixels = (size_t)request->width * (size_t)request->height;
    Set *set = wr_alloc(1, sizeof *set);
    made.rgba = wr_try_alloc(pixels, 4 * sizeof *made.rgba, "the reference's picture", err);
    if (made.rgba)
        made.normal = wr_try_alloc(pixels, 3 * sizeof *made.normal, "the reference's normals", err);
    bool good =
        made.normal && make_set(set, request, pool, err) && refine(set, request, pool, &made, err);
    free_set(set);
    if (!good) {
        wr_reference_fini(&made);
        return false;
    }
    made.seconds = wr_clock_seconds() - started;
    wr_reference_fini(out);
    *out = made;
    return true;
}

void wr_reference_fini(WrReference *reference)
{
    wr_free(reference->rgba);
    wr_free(reference->normal);
    *reference = (WrReference){ 0 };
}
