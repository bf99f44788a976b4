#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/vec.h"
#include "field/field.h"
#include "field/scheme_list.h"
#include "hardcases/hardcases_frames.h"
#include "hardcases/hardcases_internal.h"
#include "hardcases/hardcases_later.h"
#include "scene/scene.h"

#include <float.h>
#include <string.h>

/* ---- hardcases focal ---- */

/* Hard case of exact normals at focal distances, where a tangent of the raised surface vanishes. */

/* The heights at which the tangents of P + F n become parallel, det(I - F S) = 0: n_u = a Pu + b Pv and n_v = c
   Pu + d Pv, and F = -1 / w for each eigenvalue w of (a b; c d) that is not almost 0. On the sphere and on the
   capsule's caps the two are equal, and the root would lose half its digits; elsewhere such points are skipped,
   and so are points so flat that their focal distance is ten sizes, whose root has too few digits. */
static int focal_heights(const WrShape *shape, const WrSurfacePoint *at, double f[2])
{
    f[0] = -shape->value[0];
    if (shape->kind == WR_SURFACE_sphere) return 1;
    if (shape->kind == WR_SURFACE_capsule && v3_len(at->n_v) > 0) return 1;
    const double uu = v3_dot(at->pu, at->pu), uv = v3_dot(at->pu, at->pv);
    const double vv = v3_dot(at->pv, at->pv), det = uu * vv - uv * uv;
    const double nu[2] = { v3_dot(at->n_u, at->pu), v3_dot(at->n_u, at->pv) };
    const double nv[2] = { v3_dot(at->n_v, at->pu), v3_dot(at->n_v, at->pv) };
    const double a = (vv * nu[0] - uv * nu[1]) / det, b = (uu * nu[1] - uv * nu[0]) / det;
    const double c = (vv * nv[0] - uv * nv[1]) / det, d = (uu * nv[1] - uv * nv[0]) / det;
    const double half = (a + d) / 2, root = sqrt(fmax(0.0, half * half - (a * d - b * c)));
    int count = 0;
    if (root < 1e-3 * fabs(half)) return 0;
    for (int k = -1; k <= 1; k += 2) {
        const double w = half + k * root;
        const bool bent = fabs(w) > 0.05 * (fabs(a) + fabs(d)) && fabs(w) > 1e-12;
        if (bent && fabs(w) * wr_shape_radius(shape) > 0.1) f[count++] = -1.0 / w;
    }
    return count;
}

/* At a focal height: n without a slope, as on the sphere with one; else the result of the formulas for the
   remaining tangent and the slope. */
static void check_focal(WrHardMeasurement *g, const WrSurfacePoint *at, WrHardSlope slope)
{
    const bool level = slope.fu == 0.0 && slope.fv == 0.0;
    const WrVec3 want = wr_hard_bumped_normal(WR_BUMP_EXACT, at, slope);
    const WrSurfacePointf single = wr_hard_narrow(at);
    const WrVec3 n_f = wr_hard_vec(single.n_unit);
    if (level) wr_hard_holds(g, WR_HARD_DOUBLE, wr_hard_same(want, at->n_unit));
    wr_hard_holds(g, WR_HARD_DOUBLE, fabs(v3_len(want) - 1.0) < 1e-14);
    for (int set = 0; set < 2; set++) {
        const WrVec3 got = wr_hard_bumped_normal_wide(g, set, WR_BUMP_EXACT, at, slope);
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      level ? wr_hard_same(got, at->n_unit) : v3_angle_rad(got, want) < 1e-9);
    }
    const bool still = wr_hard_same(want, at->n_unit);
    for (int set = 0; set < g->all; set++) {
        const WrVec3 got = wr_hard_bumped_normal_f(g, set, WR_BUMP_EXACT, &single, slope, false);
        wr_hard_holds(g, WR_HARD_FLOAT,
                      still ? wr_hard_same(got, n_f) : v3_angle_rad(got, want) < 1e-4);
    }
}

/* Multiplies all lengths by `grow`: sizes with random mantissas. */
static WrShape grown(WrShape shape, double grow)
{
    int at = 0;
    const WrSurfaceInfo *info = wr_surfaces[shape.kind];
    for (int p = 0; p < WR_SURFACE_PARAMS && info->params[p].name; p++)
        for (int k = 0; k < info->params[p].components; k++, at++)
            if (info->params[p].length) shape.value[at] *= grow;
    return shape;
}

/* A surface that is focal everywhere at one height looks as it does without heights. */
static bool focal_pictures(WrHardMeasurement *g, WrError *err)
{
    static const WrSurfaceKind kinds[] = { WR_SURFACE_torus, WR_SURFACE_sphere,
                                           WR_SURFACE_cylinder };
    WrField *full = wr_field_new(16, 16, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 1.0f, err);
    bool good = full != NULL;
    for (int k = 0; k < 6 && good; k++) {
        WrScene *scene = wr_scene_new();
        const WrFrameRequest request = { .field = full, .scene = scene, .width = 48, .height = 48 };
        scene->shape = wr_hard_shape(kinds[k / 2]);
        const int radius = kinds[k / 2] == WR_SURFACE_torus ? 1 : 0;
        scene->shape.value[radius] = k % 2 ? 0.4 : wr_hard_between(g, 0.2, 0.5);
        scene->bump = WR_BUMP_EXACT;
        scene->scheme = WR_SCHEME_BSPLINE;
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrHardShot level = { .renderer = NULL }, focal = { .renderer = NULL };
            scene->height = 0.0;
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &level, err);
            scene->height = -scene->shape.value[radius];
            good = good && wr_hard_shoot_by(g, &request, (WrHardWay)way, &focal, err);
            if (good)
                wr_hard_holds(g, way == WR_HARD_WIDE ? WR_HARD_DOUBLE : WR_HARD_FLOAT,
                              wr_hard_differ(&level, &focal, 1e-5) == 0);
            wr_hard_put_away(&level);
            wr_hard_put_away(&focal);
        }
        wr_scene_free(scene);
    }
    wr_field_free(full);
    return good;
}

/* True if the lines of u and v are not lines of curvature. */
static bool sheared(WrSurfaceKind kind)
{
    return kind == WR_SURFACE_bezier || kind == WR_SURFACE_bent ||
           kind == WR_SURFACE_superellipsoid || kind == WR_SURFACE_formula;
}

static bool hc12(WrHardMeasurement *g, WrError *err)
{
    for (int i = 0; i < 100 * WR_SURFACE_COUNT; i++) {
        const WrSurfaceKind kind = (WrSurfaceKind)(i % WR_SURFACE_COUNT);
        const WrShape shape = grown(wr_hard_shape(kind), wr_hard_between(g, 0.3, 1.6));
        const double slope = wr_hard_between(g, 0.3, 1.0) * wr_shape_radius(&shape);
        double f[2];
        WrSurfacePoint at;
        wr_surface_at(&shape, 0, wr_hard_between(g, 0.1, 0.9), wr_hard_between(g, 0.1, 0.9), &at);
        for (int k = focal_heights(&shape, &at, f) - 1; k >= 0; k--) {
            check_focal(g, &at, (WrHardSlope){ f[k], 0, 0 });
            if (sheared(kind)) continue; /* both tangents move */
            check_focal(g, &at, (WrHardSlope){ f[k], slope, i % 2 ? slope : -slope });
        }
    }
    return focal_pictures(g, err);
}

static const WrHardCase rows_focal[] = {
    { .id = "HC12",
      .subject = WR_HARD_GEOMETRY,
      .what = "exact normals where F carries the surface to its focal point",
      .holds =
          "n, though float reaches that point to rounding only; with a slope the result of the "
          "remaining tangent; pictures as without heights",
      .unit = "violations",
      .bound = { 0, 0 },
      .measure = hc12,
      .scene = "table 64x64\nfill 1\nsurface torus r=0.4\nbump mode=exact scheme=bspline "
               "height=-0.4" },
};
WR_HARD_LIST(focal, rows_focal);

/* ---- hardcases sight ---- */

/* Hard cases of visibility: near planes, insides, shared edges, tiny patches; and of rotation. */

static WrScene *scene_of(WrSurfaceKind kind)
{
    WrScene *scene = wr_scene_new();
    scene->shape = wr_hard_shape(kind);
    scene->posed = true;
    scene->height = 0.02;
    scene->replicate_u = 3;
    scene->replicate_v = 2;
    return scene;
}

/* A point of the scene's surface, in the world, and its frame; the scene is not rotated. */
typedef struct Stand {
    WrVec3 p, n, along; /* n and along are unit */
    double radius;
} Stand;

static Stand stand_on(const WrScene *scene, double u, double v)
{
    WrSurfacePoint at;
    wr_surface_at(&scene->shape, 0, u, v, &at);
    return (Stand){ v3_sub(at.p, wr_shape_centre(&scene->shape)), at.n_unit,
                    v3_unit(at.pu, at.n_unit), wr_shape_radius(&scene->shape) };
}

/* Number of pixels whose coverage or red differ from the reference's by more than `off`. */
static int apart(const WrHardShot *shot, const WrReference *reference, double off)
{
    int differ = 0;
    for (int i = 0; i < reference->width * reference->height; i++) {
        const float *p = shot->frame.rgba + 4 * (size_t)i;
        const double *q = reference->rgba + 4 * (size_t)i;
        differ += !(fabs((double)p[0] - q[0]) <= off && fabs((double)p[3] - q[3]) <= off);
    }
    return differ;
}

/* The plane as a curved patch that happens to be flat: drawn by mesh and Newton's method. */
static void curve(WrScene *scene)
{
    scene->shape = wr_hard_shape(WR_SURFACE_bent);
    scene->shape.value[2] = scene->shape.value[3] = scene->shape.value[4] = 0.0;
}

static double mean_coverage(const WrFrame *frame)
{
    const int count = frame->width * frame->height;
    double sum = 0.0;
    for (int i = 0; i < count; i++) sum += (double)frame->rgba[4 * i + 3];
    return sum / count;
}

/* An eye inside the patch's extent. Share of pixels in which closed form and mesh differ. */
static bool closed_against_mesh(WrHardMeasurement *g, WrError *err)
{
    enum { W = 120, H = 100 };
    WrField *field = wr_hard_waves(32, 32);
    WrScene *scene = scene_of(WR_SURFACE_plane);
    WrHardShot shots[2] = { { .renderer = NULL }, { .renderer = NULL } };
    WrReference references[2] = { { 0 }, { 0 } };
    scene->camera = (WrCamera){
        .eye = { 0, 0, 0.05 }, .target = { 0, 1, 0 }, .up = { 0, 0, 1 }, .fov_deg = 90
    };
    bool good = true;
    for (int k = 0; k < 2 && good; k++) {
        if (k == 1) curve(scene);
        WrFrameRequest request = { .field = field, .scene = scene, .width = W, .height = H };
        good = wr_hard_shoot(g, &request, &shots[k], err) &&
               wr_hard_refer(g, &request, 1, &references[k], err);
    }
    if (good) {
        int differ = 0, differ_double = 0;
        for (int i = 0; i < W * H; i++)
            differ += !(fabsf(shots[0].frame.rgba[4 * i] - shots[1].frame.rgba[4 * i]) <= 2e-3f);
        for (int i = 0; i < W * H; i++)
            differ_double += !(fabs(references[0].rgba[4 * i] - references[1].rgba[4 * i]) <= 2e-3);
        wr_hard_record_error(g, WR_HARD_FLOAT, (double)differ / (W * H));
        wr_hard_record_error(g, WR_HARD_DOUBLE, (double)differ_double / (W * H));
        wr_hard_record_error(g, WR_HARD_FLOAT, shots[0].frame.covered > 2000 ? 0.0 : 1.0);
    }
    for (int k = 0; k < 2; k++) {
        wr_hard_put_away(&shots[k]);
        wr_reference_fini(&references[k]);
    }
    wr_field_free(field);
    wr_scene_free(scene);
    return good;
}

/* From a point a twentieth of a radius above every surface, along it: parts are beside and behind the eye. Share
   of pixels in which pictures differ from the reference. */
static bool among_surfaces(WrHardMeasurement *g, WrError *err)
{
    enum { SIZE = 72 };
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < 2 * WR_SURFACE_COUNT && good; k++) {
        WrScene *scene = scene_of((WrSurfaceKind)(k / 2));
        const Stand at = stand_on(scene, 0.4 + 0.2 * wr_hard_random(g), 0.55);
        scene->height = 0.005;
        scene->camera = (WrCamera){ .eye = v3_mad(at.p, at.n, 0.05 * at.radius),
                                    .target = v3_add(at.p, v3_scale(at.along, at.radius)),
                                    .up = at.n,
                                    .fov_deg = k % 2 ? 60 : 110 };
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = SIZE, .height = SIZE
        };
        WrReference reference = { 0 };
        good = wr_hard_refer(g, &request, 1, &reference, err);
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrHardShot shot = { .renderer = NULL };
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &shot, err);
            if (!good) break;
            const double part = (double)apart(&shot, &reference, 0.02) / (SIZE * SIZE);
            wr_hard_record_error(g, way == WR_HARD_WIDE ? WR_HARD_DOUBLE : WR_HARD_FLOAT, part);
            wr_hard_record_error(g, WR_HARD_FLOAT, shot.frame.covered > 200 ? 0.0 : 1.0);
            wr_hard_put_away(&shot);
        }
        wr_reference_fini(&reference);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

static bool hc82(WrHardMeasurement *g, WrError *err)
{
    return closed_against_mesh(g, err) && among_surfaces(g, err);
}

/* The middle column of flat ground, seen along it from just above: all of its lower half is ground. */
static bool lower_half(const float *alpha, int width, int height)
{
    bool all = true;
    for (int y = height / 2 + 1; y < height; y++)
        all = all && alpha[4 * (y * width + width / 2)] == 1.0f;
    return all;
}

/* Eyes on every surface, looking along it, and slightly above: corners at and behind depth 0. */
static bool hc83(WrHardMeasurement *g, WrError *err)
{
    static const double heights[] = { 0, 1e-300, 1e-30, 1e-9, 1e-3 };
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < 5 * (WR_SURFACE_COUNT + 1) && good; k++) {
        const int kind = k / 5;
        WrScene *scene = scene_of(kind < WR_SURFACE_COUNT ? (WrSurfaceKind)kind : WR_SURFACE_plane);
        if (kind == WR_SURFACE_COUNT) curve(scene);
        const Stand at = stand_on(scene, 0.5, 0.5);
        const WrVec3 eye = v3_mad(at.p, at.n, heights[k % 5]);
        scene->camera =
            (WrCamera){ .eye = eye, .target = v3_add(eye, at.along), .up = at.n, .fov_deg = 100 };
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = 40, .height = 40
        };
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrHardShot shot = { .renderer = NULL };
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &shot, err);
            const WrHardPrecision p = way == WR_HARD_WIDE ? WR_HARD_DOUBLE : WR_HARD_FLOAT;
            if (good) wr_hard_holds(g, p, wr_hard_wild(&shot) == 0);
            const bool level = kind == WR_SURFACE_plane || kind == WR_SURFACE_COUNT;
            if (good && level && heights[k % 5] >= 1e-9)
                wr_hard_holds(g, p, lower_half(shot.frame.rgba + 3, 40, 40));
            wr_hard_put_away(&shot);
        }
        WrReference reference = { 0 };
        good = good && wr_hard_refer(g, &request, 1, &reference, err);
        if (good) wr_hard_holds(g, WR_HARD_DOUBLE, wr_hard_wild_reference(&reference) == 0);
        wr_reference_fini(&reference);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* A lamp beside the eye: the inside is lit as in the reference, in all pixels except those where one ulp moves
   the bump. */
static bool hc84(WrHardMeasurement *g, WrError *err)
{
    enum { SIZE = 48, FEW = SIZE * SIZE / 50 };
    static const WrSurfaceKind bodies[] = { WR_SURFACE_sphere, WR_SURFACE_cube, WR_SURFACE_torus };
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < 3 && good; k++) {
        WrScene *scene = scene_of(bodies[k]);
        const double x = bodies[k] == WR_SURFACE_torus ? 1 : 0; /* inside its tube */
        scene->height = 0.002; /* the reference uses another scheme */
        scene->lights_given = true;
        scene->lights[0] = (WrLight){
            .kind = WR_LIGHT_POINT, .where = { x, 0, 0.12 }, .colour = { 1, 1, 1 }, .strength = 1
        };
        scene->material.ambient = 0.0;
        scene->camera = (WrCamera){
            .eye = { x, 0, 0.1 }, .target = { x + 0.2, 1, 0.15 }, .up = { 0, 0, 1 }, .fov_deg = 80
        };
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = SIZE, .height = SIZE
        };
        WrReference reference = { 0 };
        good = wr_hard_refer(g, &request, 1, &reference, err);
        double light = 0.0;
        for (int i = 0; i < SIZE * SIZE && good; i++) {
            light += reference.rgba[4 * i];
            wr_hard_holds(g, WR_HARD_DOUBLE, reference.rgba[4 * i + 3] == 1.0);
        }
        if (good) wr_hard_holds(g, WR_HARD_DOUBLE, light > 0.3 * SIZE * SIZE);
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            const WrHardPrecision p = way == WR_HARD_WIDE ? WR_HARD_DOUBLE : WR_HARD_FLOAT;
            WrHardShot shot = { .renderer = NULL };
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &shot, err);
            if (good) wr_hard_holds(g, p, shot.frame.covered == SIZE * SIZE);
            if (good) wr_hard_holds(g, p, apart(&shot, &reference, 0.02) <= FEW);
            wr_hard_put_away(&shot);
        }
        wr_reference_fini(&reference);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* Straight at a point through a window of a tenth of a radius, or at a bent patch larger than the picture; or
   from behind, where triangles have reversed orientation. */
static WrScene *filling(WrHardMeasurement *g, int k, bool behind)
{
    const bool patch = k >= WR_SURFACE_COUNT;
    WrScene *scene = scene_of(patch ? WR_SURFACE_bent : (WrSurfaceKind)k);
    if (patch) {
        scene->shape.value[2] = scene->shape.value[3] = 0.0;
        scene->shape.value[4] = 0.3;
        scene->camera =
            (WrCamera){ .eye = { 0, 0, behind ? -1.2 : 1.2 }, .up = { 0, 1, 0 }, .fov_deg = 20 };
        if (k > WR_SURFACE_COUNT) wr_hard_ground(g, scene);
        return scene;
    }
    const double across = k == WR_SURFACE_torus ? 0.06 : 0.56; /* for a torus the outer side */
    const Stand at = stand_on(scene, wr_hard_between(g, 0.4, 0.6), across);
    const double side = behind ? -3 : 3;
    scene->camera = (WrCamera){ .orthographic = true,
                                .eye = v3_mad(at.p, at.n, side * at.radius),
                                .target = at.p,
                                .up = { 0.31, 0.2, 0.9 },
                                .size = at.radius / 10 };
    return scene;
}

/* Every pixel is covered, equally for any number of threads. */
static bool hc85(WrHardMeasurement *g, WrError *err)
{
    WrField *field = wr_hard_waves(32, 32);
    WrPool *pool = wr_pool_new(3), *own = g->pool;
    bool good = true;
    for (int k = 0; k < 4 * (WR_SURFACE_COUNT + 4) && good; k++) {
        const int size = 53 + 22 * (k % 2);
        WrScene *scene = filling(g, k / 4, k / 2 % 2);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = size, .height = size
        };
        WrHardShot one = { .renderer = NULL }, three = { .renderer = NULL };
        WrHardShot fast = { .renderer = NULL };
        WrReference reference = { 0 };
        g->pool = NULL;
        good = wr_hard_shoot(g, &request, &one, err);
        g->pool = pool;
        good = good && wr_hard_shoot(g, &request, &three, err) &&
               wr_hard_shoot_by(g, &request, WR_HARD_FAST, &fast, err) &&
               wr_hard_refer(g, &request, 1, &reference, err);
        for (int i = 0; i < size * size && good; i++) {
            const float *a = one.frame.rgba + 4 * (size_t)i, *b = three.frame.rgba + 4 * (size_t)i;
            wr_hard_holds(g, WR_HARD_FLOAT, a[3] == 1.0f && a[0] == b[0] && a[3] == b[3]);
            wr_hard_holds(g, WR_HARD_FLOAT, fast.frame.rgba[4 * i + 3] == 1.0f);
            wr_hard_holds(g, WR_HARD_DOUBLE, reference.rgba[4 * i + 3] == 1.0);
        }
        wr_reference_fini(&reference);
        wr_hard_put_away(&one);
        wr_hard_put_away(&three);
        wr_hard_put_away(&fast);
        wr_scene_free(scene);
    }
    g->pool = own;
    wr_pool_free(pool);
    wr_field_free(field);
    return good;
}

/* Coverage of the view by the reference, in a picture of 256 x 256. */
static bool large_coverage(WrHardMeasurement *g, const WrFrameRequest *request, double *out,
                           WrError *err)
{
    enum { SIZE = 256 };
    WrFrameRequest large = *request;
    WrReference reference = { 0 };
    large.width = large.height = SIZE;
    const bool good = wr_hard_refer(g, &large, 1, &reference, err);
    *out = 0.0;
    for (int i = 0; i < SIZE * SIZE && good; i++) *out += reference.rgba[4 * i + 3] / (SIZE * SIZE);
    wr_reference_fini(&reference);
    return good;
}

/* Pixels of 2 x 2 units around objects of 1 to 3: coverage compared with that of a picture of many small pixels,
   and with the area if that is known; one row of samples more or less on each side is 6 percent. */
static bool hc86(WrHardMeasurement *g, WrError *err)
{
    const double sphere = wr_hard_shape(WR_SURFACE_sphere).value[0];
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < WR_SURFACE_COUNT && good; k++) {
        WrScene *scene = scene_of((WrSurfaceKind)k);
        scene->rotate_deg = (WrVec3){ k == WR_SURFACE_cylinder ? 70 : 0, 0, 0 };
        scene->camera =
            (WrCamera){ .orthographic = true, .eye = { 0, 0, 9 }, .up = { 0, 1, 0 }, .size = 8 };
        scene->dials.aa = WR_AA_SUPERSAMPLE;
        scene->dials.samples = 64;
        const WrFrameRequest request = { .field = field, .scene = scene, .width = 4, .height = 4 };
        double want = 0.0;
        WrHardShot shot = { .renderer = NULL };
        WrReference reference = { 0 };
        good = large_coverage(g, &request, &want, err) && wr_hard_shoot(g, &request, &shot, err) &&
               wr_hard_refer(g, &request, 64, &reference, err);
        if (good) {
            double sum = 0.0;
            for (int i = 0; i < 16; i++) sum += reference.rgba[4 * i + 3] / 16.0;
            if (k == WR_SURFACE_sphere) want = WR_PI * sphere * sphere / 64.0;
            if (k == WR_SURFACE_plane) want = 1.0 / 64.0;
            wr_hard_near(g, WR_HARD_FLOAT, mean_coverage(&shot.frame) / want, 1.0);
            wr_hard_near(g, WR_HARD_DOUBLE, sum / want, 1.0);
        }
        wr_hard_put_away(&shot);
        wr_reference_fini(&reference);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* ---- rotation ---- */

/* 0.01 rad per frame at 60 Hz, the last ticks of a day, compared with the same rotation reduced in whole
   degrees: tick t is t 0.01 rad; 36000 ticks of 0.01 degree are a full turn. */
static bool hc87(WrHardMeasurement *g, WrError *err)
{
    WrScene *scene = wr_scene_new();
    scene->posed = true;
    bool good = true;
    for (int64_t tick = 60 * 86400 - 999; tick <= 60 * 86400 && good; tick++) {
        WrPlacement day, here;
        good = wr_scene_place(scene, (double)tick * 0.01, 1, &day, err) &&
               wr_scene_place(scene, (double)(tick % 36000) * 0.01, 1, &here, err);
        if (!good) break;
        const double *a = day.rotation, *b = here.rotation;
        wr_hard_record_error(g, WR_HARD_DOUBLE,
                             fabs(atan2(a[2] * b[0] - a[0] * b[2], a[0] * b[0] + a[2] * b[2])));
    }
    wr_scene_free(scene);
    return good;
}

static bool hc88(WrHardMeasurement *g, WrError *err)
{
    WrScene *scene = wr_scene_new();
    bool good = true;
    scene->posed = true;
    for (int i = 0; i < 1000 && good; i++) {
        WrPlacement p;
        scene->rotate_deg = (WrVec3){ wr_hard_between(g, -1e6, 1e6), wr_hard_between(g, -400, 400),
                                      wr_hard_between(g, -400, 400) };
        good = wr_scene_place(scene, wr_hard_between(g, -1e9, 1e9), 1.5, &p, err);
        if (!good) break;
        const double *r = p.rotation;
        const WrVec3 rows[3] = { { r[0], r[1], r[2] }, { r[3], r[4], r[5] }, { r[6], r[7], r[8] } };
        wr_hard_near(g, WR_HARD_DOUBLE, v3_dot(rows[0], v3_cross(rows[1], rows[2])), 1.0);
        for (int k = 0; k < 3; k++) {
            wr_hard_near(g, WR_HARD_DOUBLE, v3_dot(rows[k], rows[k]), 1.0);
            wr_hard_near(g, WR_HARD_DOUBLE, v3_dot(rows[k], rows[(k + 1) % 3]), 0.0);
        }
    }
    wr_scene_free(scene);
    return good;
}

#define ROW(number, situation, rule, u, in_float, in_double, script)                               \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_RENDER, .what = situation, .holds = rule,           \
        .unit = u, .bound = { in_float, in_double }, .measure = hc##number, .scene = script        \
    }
#define WAVES "table 64x64\nformula fourier terms=3,0,0.5;0,5,0.25,90,0\n"
static const WrHardCase seen[] = {
    ROW(82, "surfaces that extend behind the eye",
        "the mesh agrees with the closed form, and pictures with the reference", "of pixels", 0.02,
        0.02,
        WAVES "surface bent c=0,0,0\nrotate 0,0,0\nbump height=0.02\n"
              "camera perspective eye=0,0,0.05 target=0,1,0 up=0,0,1 fov=90"),
    ROW(83, "an eye on every surface and in its plane",
        "a picture without a NaN; a billionth above the ground it is still seen", "violations", 0,
        0,
        WAVES "surface plane\nrotate 0,0,0\nbump height=0.02\n"
              "camera perspective eye=0.5,-0.5,0.001 target=-0.5,0.5,0.001 up=0,0,1 fov=100"),
    ROW(84, "an eye inside sphere, cube and torus", "the inside is seen in every pixel, and lit",
        "violations", 0, 0,
        WAVES "surface sphere\nrotate 0,0,0\nbump height=0.1\nlight point at=0.2,-0.4,0.3\n"
              "camera perspective eye=0,0,0.1 target=0.2,1,0.15 up=0,0,1 fov=80"),
    ROW(85, "edges that triangles share, on every surface",
        "no background shows through, and pixels are the same for any number of threads",
        "violations", 0, 0,
        WAVES "surface bent c=0,0,0.3\nrotate 0,0,0\nbump height=0.02\n"
              "camera perspective eye=0,0,1.2 target=0,0,0 up=0,1,0 fov=20"),
    ROW(86, "an object smaller than a pixel", "under supersampling its coverage is its area",
        "relative", 0.1, 0.1,
        WAVES "surface sphere\ncamera orthographic eye=0,0,9 target=0,0,0 up=0,1,0 size=60\n"
              "dials aa=supersample samples=16"),
};
WR_HARD_LIST(sight, seen);

static const WrHardCase turned[] = {
    ROW(87, "a day of rotation at 60 Hz", "the angle is that of the tick's number", "rad", NAN,
        1e-9, NULL),
    ROW(88, "any number of turns", "the rotation's determinant is 1 and its rows are orthonormal",
        "relative", NAN, 1e-6, NULL),
};
WR_HARD_LIST(turn, turned);

/* ---- Hard cases of meshes: shared functions, and (u,v) with zero, almost zero or mirrored area ---- */

/* ---- shared functions ---- */

WrTriangles *wr_hard_mesh_triangles_new(const WrHardMesh *mesh, WrError *err)
{
    float points[WR_HARD_CORNERS][3], normals[WR_HARD_CORNERS][3], uv[WR_HARD_CORNERS][2];
    for (int i = 0; i < mesh->corners; i++) {
        memcpy(points[i], mesh->corner[i].p, sizeof points[i]);
        memcpy(normals[i], mesh->corner[i].n, sizeof normals[i]);
        uv[i][0] = mesh->corner[i].u, uv[i][1] = mesh->corner[i].v;
    }
    const WrTrianglesSource source = { .points = (const float(*)[3])points,
                                       .normals = (const float(*)[3])normals,
                                       .uv = (const float(*)[2])uv,
                                       .corners = mesh->face,
                                       .point_count = mesh->corners,
                                       .triangle_count = mesh->faces };
    return wr_triangles_new(&source, err);
}

WrScene *wr_hard_above(WrTriangles *triangles, double height)
{
    WrScene *scene = wr_scene_new();
    scene->shape = wr_hard_shape(WR_SURFACE_mesh);
    wr_scene_set_triangles(scene, triangles, "case", NULL);
    /* keeps the origin in place */
    memset(scene->shape.value + WR_MESH_CENTRE, 0, 3 * sizeof(double));
    scene->posed = true;
    scene->height = height;
    scene->lights_given = true;
    scene->lights[0] = (WrLight){
        .kind = WR_LIGHT_DIRECTIONAL, .where = { 0.3, 0.2, 1 }, .colour = { 1, 1, 1 }, .strength = 1
    };
    scene->camera = (WrCamera){
        .orthographic = true, .eye = { 0, 0, 5 }, .up = { 0, 1, 0 }, .fov_deg = 30, .size = 2.2
    };
    return scene;
}

bool wr_hard_check_mesh_finite(WrHardMeasurement *g, const WrHardMesh *mesh, WrError *err)
{
    WrTriangles *triangles = wr_hard_mesh_triangles_new(mesh, err);
    if (!triangles) return false;
    WrScene *scene = wr_hard_above(triangles, 0.1);
    WrField *field = wr_hard_waves(24, 20);
    const bool good = wr_hard_tame(g, field, scene, err);
    wr_field_free(field);
    wr_scene_free(scene);
    return good;
}

bool wr_hard_mikk_frames(const WrHardMesh *mesh, WrTangent *out, WrError *err)
{
    WrTriangle faces[WR_HARD_FACES];
    memcpy(faces, mesh->face, (size_t)mesh->faces * sizeof *faces);
    return wr_tangents_mikk(mesh->corner, faces, mesh->faces, out, err);
}

void wr_hard_units(WrHardMeasurement *g, const WrHardMesh *mesh, const WrTangent *frames)
{
    for (int32_t i = 0; i < 3 * mesh->faces; i++) {
        const float *n = mesh->corner[mesh->face[i / 3][i % 3]].n;
        const WrVec3 up = { (double)n[0], (double)n[1], (double)n[2] };
        const WrTangent *at = &frames[i];
        const bool lost = at->sign == -1 && at->t.x == 1;
        wr_hard_holds(g, WR_HARD_DOUBLE, fabs(v3_len(at->t) - 1) < 1e-9);
        wr_hard_holds(g, WR_HARD_DOUBLE, lost || fabs(v3_dot(at->t, up)) < 1e-6);
        const WrVec3 b = v3_scale(v3_cross(up, at->t), at->sign);
        wr_hard_holds(g, WR_HARD_DOUBLE, v3_len(v3_sub(b, at->b)) < 1e-6);
    }
}

/* ---- meshes ---- */

/* Width and height of a triangle of the pairs: not 1, with which a missing division would be invisible. */
#define ACROSS 0.875
#define UP 0.75

/* Two triangles on both sides of x = 0, with those texture coordinates. */
static WrHardMesh pair(const float uv[4][2])
{
    WrHardMesh mesh = { { { { -ACROSS, 0, 0 }, { 0, 0, 1 }, 0, 0 },
                          { { 0, 0, 0 }, { 0, 0, 1 }, 0, 0 },
                          { { 0, UP, 0 }, { 0, 0, 1 }, 0, 0 },
                          { { ACROSS, 0, 0 }, { 0, 0, 1 }, 0, 0 } },
                        { { 0, 1, 2 }, { 1, 3, 2 } },
                        4,
                        2 };
    for (int i = 0; i < 4; i++) mesh.corner[i].u = uv[i][0], mesh.corner[i].v = uv[i][1];
    return mesh;
}

static void report(WrHardMeasurement *g, const WrHardMesh *mesh, int32_t collinear,
                   int32_t mirrored)
{
    WrTriangles *made = wr_hard_mesh_triangles_new(mesh, NULL);
    const bool good =
        made && made->report.collinear == collinear && made->report.mirrored == mirrored;
    wr_hard_holds(g, WR_HARD_DOUBLE, good);
    wr_triangles_free(made);
}

/* Solves the tangent of the left or the right triangle directly. */
static bool solve(const WrHardMesh *mesh, int face, WrVec3 *t, double *det)
{
    WrVec3 p[3], b;
    double uv[3][2];
    for (int k = 0; k < 3; k++) {
        const WrTriangleCorner *c = &mesh->corner[mesh->face[face][k]];
        p[k] = (WrVec3){ (double)c->p[0], (double)c->p[1], (double)c->p[2] };
        uv[k][0] = (double)c->u, uv[k][1] = (double)c->v;
    }
    return wr_tangent_lecture(p, (const double(*)[2])uv, t, &b, det);
}

/* ---- slopes ---- */

/* u and v over the plane z = 0, one map for x < 0 and one for the rest. */
typedef struct Map {
    double u[3], v[3]; /* coefficients of 1, x / ACROSS and y / UP */
} Map;

enum { SIDE = 44 }; /* pixels of a picture 2.2 units high and wide */

static double at_pixel(int i)
{
    return (i + 0.5) * (2.2 / SIDE) - 1.1;
}

static double of_map(const double map[3], double x, double y)
{
    return map[0] + map[1] * x / ACROSS + map[2] * y / UP;
}

/* unit(n - Fu grad u - Fv grad v) for n = (0, 0, 1). */
static WrVec3 by_map(const WrField *field, const WrScene *scene, const Map *map, double x, double y)
{
    const double u = of_map(map->u, x, y), v = of_map(map->v, x, y);
    WrHardSlope s = wr_hard_sample(field, scene->scheme, u - floor(u), v - floor(v));
    s.fu *= scene->height, s.fv *= scene->height;
    const WrVec3 n = { -(s.fu * map->u[1] + s.fv * map->v[1]) / ACROSS,
                       -(s.fu * map->u[2] + s.fv * map->v[2]) / UP, 1 };
    return v3_unit(n, (WrVec3){ 0, 0, 1 });
}

/* Pictures of a flat mesh in the plane z = 0 within -1..1, under a table of waves `height` high, compared with n
   - grad F computed from the maps of u and v: float by the pictures' normals, double by the reference's. *bent:
   the largest slope found. */
static bool measure_bend(WrHardMeasurement *g, const WrHardMesh *mesh, const Map map[2],
                         double height, double *bent, WrError *err)
{
    WrTriangles *triangles = wr_hard_mesh_triangles_new(mesh, err);
    if (!triangles) return false;
    WrScene *scene = wr_hard_above(triangles, height);
    WrField *field = wr_hard_waves(48, 40);
    scene->scheme = WR_SCHEME_BSPLINE;
    scene->replicate_u = scene->replicate_v = 1;
    float *normals = wr_alloc((size_t)SIDE * SIDE, 3 * sizeof *normals);
    const WrFrameRequest request = {
        .field = field, .scene = scene, .width = SIDE, .height = SIDE, .normals = normals
    };
    bool good = true;
    *bent = 0;
    for (int way = 0; way < WR_HARD_WAYS && good; way++) {
        WrHardShot shot = { .renderer = NULL };
        good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &shot, err);
        for (int i = 0; i < SIDE * SIDE && good; i++) {
            const double x = at_pixel(i % SIDE), y = -at_pixel(i / SIDE);
            if (shot.frame.rgba[4 * i + 3] != 1 || fabs(x) < 0.02) continue;
            const WrVec3 want = by_map(field, scene, &map[x >= 0], x, y);
            const float *n = normals + 3 * (size_t)i;
            wr_hard_record_error(
                g, WR_HARD_FLOAT,
                v3_angle_rad((WrVec3){ (double)n[0], (double)n[1], (double)n[2] }, want));
            *bent = fmax(*bent, hypot(want.x, want.y) / want.z);
        }
        wr_hard_put_away(&shot);
    }
    for (int k = 0; k < 60 && good; k++) {
        const double x = wr_hard_between(g, 0, SIDE), y = wr_hard_between(g, 0, SIDE);
        WrProbe probe;
        good = wr_reference_probe(field, scene, SIDE, SIDE, 0, x, y, &probe, err);
        if (!good || !probe.hit) continue;
        const WrVec3 want =
            by_map(field, scene, &map[probe.at.p.x >= 0], probe.at.p.x, probe.at.p.y);
        wr_hard_record_error(g, WR_HARD_DOUBLE, v3_angle_rad(probe.perturbed, want));
    }
    wr_free(normals);
    wr_field_free(field);
    wr_scene_free(scene);
    return good;
}

/* Checks that the pair bends as the maps require, within those bounds, and at least by `least` at its steepest. */
static bool bends_within(WrHardMeasurement *g, const WrHardMesh *mesh, const Map map[2],
                         double height, double least, double in_float, double in_double,
                         WrError *err)
{
    WrHardMeasurement apart = *g;
    double bent;
    for (int p = 0; p < WR_HARD_PRECISIONS; p++)
        apart.worst[p] = 0, apart.nudge[p] = 0, apart.checks[p] = 0;
    const bool good = measure_bend(&apart, mesh, map, height, &bent, err);
    wr_hard_holds(g, WR_HARD_FLOAT, apart.worst[WR_HARD_FLOAT] <= in_float);
    wr_hard_holds(g, WR_HARD_DOUBLE, apart.worst[WR_HARD_DOUBLE] <= in_double);
    wr_hard_holds(g, WR_HARD_DOUBLE, good && apart.checks[WR_HARD_FLOAT] > 500 && bent >= least);
    g->random = apart.random;
    return good;
}

/* ---- zero area ---- */

bool wr_hard_hc28(WrHardMeasurement *g, WrError *err)
{
    static const float one[4][2] = {
        { 0.3f, 0.7f }, { 0.3f, 0.7f }, { 0.3f, 0.7f }, { 0.3f, 0.7f }
    };
    static const Map flat[2] = { { { 0.3, 0, 0 }, { 0.7, 0, 0 } },
                                 { { 0.3, 0, 0 }, { 0.7, 0, 0 } } };
    static const float line[4][2] = { { 1, 0.5f }, { 0, 0 }, { 0, 0 }, { 1, 0.5f } };
    const WrHardMesh still = pair(one), thin = pair(line);
    WrTangent frames[3 * WR_HARD_FACES];
    WrVec3 t;
    double det;
    wr_hard_holds(g, WR_HARD_DOUBLE, !solve(&still, 0, &t, &det) && !solve(&thin, 1, &t, &det));
    report(g, &still, 2, 0);
    report(g, &thin, 2, 0);
    if (!wr_hard_mikk_frames(&still, frames, err)) return false;
    wr_hard_units(g, &still, frames);
    if (!wr_hard_mikk_frames(&thin, frames, err)) return false;
    wr_hard_units(g, &thin, frames);
    return bends_within(g, &still, flat, 0.1, 0, 1e-6, 1e-12, err) &&
           wr_hard_check_mesh_finite(g, &thin, err);
}

/* Along u = |x| the table still bends normals; across it nothing changes. */
bool wr_hard_hc127(WrHardMeasurement *g, WrError *err)
{
    static const float line[4][2] = { { 1, 0 }, { 0, 0 }, { 0, 0 }, { 1, 0 } };
    static const Map map[2] = { { { 0, -1, 0 }, { 0 } }, { { 0, 1, 0 }, { 0 } } };
    const WrHardMesh thin = pair(line);
    return bends_within(g, &thin, map, 0.1, 0.3, 1e-5, 1e-12, err);
}

/* With the triangle and without it: the picture has the same bits. */
bool wr_hard_hc29(WrHardMeasurement *g, WrError *err)
{
    static const float uv[4][2] = { { 1, 0 }, { 0, 0 }, { 0, 1 }, { 1, 0 } };
    const WrHardMesh whole = pair(uv);
    static const float at[3][3] = { { 0.25f, 0.25f, 0 }, { 0.25f, 0.25f, 0 }, { 0.5f, 0.25f, 0 } };
    static const float along[3][3] = { { 0, 0, 0 }, { 0.5f, 0, 0 }, { 0.75f, 0, 0 } };
    WrField *field = wr_hard_waves(24, 20);
    bool good = true;
    for (int k = 0; k < 3 && good; k++) {
        WrHardMesh more = whole;
        for (int i = 0; i < 3; i++) {
            WrTriangleCorner *c = &more.corner[4 + i];
            *c = (WrTriangleCorner){ .n = { 0, 0, 1 }, .u = 0.1f * (float)i, .v = 0.3f };
            memcpy(c->p, k == 0 ? at[0] : k == 1 ? at[i] : along[i], sizeof c->p);
            more.face[2][i] = 4 + i;
        }
        more.corners = 7, more.faces = 3;
        WrTriangles *with = wr_hard_mesh_triangles_new(&more, err),
                    *without = wr_hard_mesh_triangles_new(&whole, err);
        good = with && without;
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      good && with->report.no_area == 1 && with->triangle_count == 2);
        WrScene *a = good ? wr_hard_above(with, 0.1) : NULL;
        WrScene *b = good ? wr_hard_above(without, 0.1) : NULL;
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrFrameRequest request = { .field = field, .scene = a, .width = 40, .height = 40 };
            WrHardShot first = { .renderer = NULL }, second = { .renderer = NULL };
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &first, err);
            request.scene = b;
            good = good && wr_hard_shoot_by(g, &request, (WrHardWay)way, &second, err);
            if (good) wr_hard_holds(g, WR_HARD_FLOAT, wr_hard_differ(&first, &second, 0) == 0);
            wr_hard_put_away(&first);
            wr_hard_put_away(&second);
        }
        wr_scene_free(a);
        wr_scene_free(b);
    }
    wr_field_free(field);
    return good;
}

/* ---- almost zero area ---- */

/* u = k x, v = k y with 1e-15: det is 1e-30 of either sign, and a proportionally higher table produces the same
   bend. */
bool wr_hard_hc30(WrHardMeasurement *g, WrError *err)
{
    const double k = (double)1e-15f;
    bool good = true;
    for (int side = -1; side <= 1 && good; side += 2) {
        const float s = 1e-15f * (float)side;
        const float uv[4][2] = { { -s, 0 }, { 0, 0 }, { 0, 1e-15f }, { s, 0 } };
        const Map map[2] = { { { 0, k * side, 0 }, { 0, 0, k } },
                             { { 0, k * side, 0 }, { 0, 0, k } } };
        const WrHardMesh mesh = pair(uv);
        WrTangent frames[3 * WR_HARD_FACES];
        WrVec3 t;
        double det;
        const bool solved = solve(&mesh, 0, &t, &det);
        wr_hard_holds(g, WR_HARD_DOUBLE, solved && (det > 0 ? 1 : -1) == side);
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      solved && fabs(v3_unit(t, t).x - side) < 1e-12 && isfinite(v3_len(t)));
        good = wr_hard_mikk_frames(&mesh, frames, err);
        if (!good) break;
        wr_hard_units(g, &mesh, frames);
        for (int i = 0; i < 6; i++)
            wr_hard_holds(g, WR_HARD_DOUBLE, frames[i].sign == side && frames[i].t.x * side > 0);
        report(g, &mesh, 0, side < 0 ? 2 : 0);
        good = bends_within(g, &mesh, map, 0.02 / k, 0.05, 1e-5, 1e-10, err);
    }
    return good;
}

/* As hc30, but so nearly along a line that det is rounding error: no frame, which is reported; u and v bend as
   required. */
bool wr_hard_hc126(WrHardMeasurement *g, WrError *err)
{
    static const float slip[] = { 0, -0.0f, 0x1p-24f, -0x1p-24f };
    bool good = true;
    for (int k = 0; k < 4 && good; k++) {
        const float uv[4][2] = { { 1, 1 }, { 0, 0 }, { 0.5f, 0.5f + slip[k] }, { 1, 1 } };
        const double rise = 0.5 + (double)uv[2][1] - 0.5;
        const Map map[2] = { { { 0, -1, 0.5 }, { 0, -1, rise } },
                             { { 0, 1, 0.5 }, { 0, 1, rise } } };
        const WrHardMesh mesh = pair(uv);
        WrTangent frames[3 * WR_HARD_FACES];
        WrVec3 t;
        double det;
        wr_hard_holds(g, WR_HARD_DOUBLE, !solve(&mesh, 0, &t, &det) && !solve(&mesh, 1, &t, &det));
        report(g, &mesh, 2, 0);
        good = wr_hard_mikk_frames(&mesh, frames, err);
        if (good) wr_hard_units(g, &mesh, frames);
        good = good && bends_within(g, &mesh, map, 0.02, 0.05, 1e-5, 1e-6, err);
    }
    return good;
}

/* ---- mirrored ---- */

/* u = |x|, v = y: each corner that both share has two frames, of either handedness. */
bool wr_hard_hc31(WrHardMeasurement *g, WrError *err)
{
    static const float uv[4][2] = { { 1, 0 }, { 0, 0 }, { 0, 1 }, { 1, 0 } };
    const WrHardMesh mesh = pair(uv);
    WrTangent mikk[3 * WR_HARD_FACES], mean[3 * WR_HARD_FACES];
    WrTriangle faces[2];
    memcpy(faces, mesh.face, sizeof faces);
    if (!wr_hard_mikk_frames(&mesh, mikk, err)) return false;
    if (!wr_tangents_average(mesh.corner, faces, 2, mean, err)) return false;
    wr_hard_units(g, &mesh, mikk);
    for (int i = 0; i < 6; i++) {
        const double side = i < 3 ? -1 : 1;
        wr_hard_holds(g, WR_HARD_DOUBLE, mikk[i].sign == side && fabs(mikk[i].t.x - side) < 1e-12);
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      mean[i].sign == side && fabs(mean[i].t.x - ACROSS * side) < 1e-12);
    }
    report(g, &mesh, 0, 1);
    return wr_hard_check_mesh_finite(g, &mesh, err);
}

/* Bumps are raised on both sides: n' by the map, whose gradient does not depend on handedness. */
bool wr_hard_hc128(WrHardMeasurement *g, WrError *err)
{
    static const float uv[4][2] = { { 1, 0 }, { 0, 0 }, { 0, 1 }, { 1, 0 } };
    static const Map map[2] = { { { 0, -1, 0 }, { 0, 0, 1 } }, { { 0, 1, 0 }, { 0, 0, 1 } } };
    const WrHardMesh mesh = pair(uv);
    return bends_within(g, &mesh, map, 0.1, 0.3, 1e-5, 1e-12, err);
}

/* ---- hardcases far ---- */

/* Hard cases of HC156 and later: eyes inside, far away and close by, light from behind, seams. */

bool wr_hard_tame(WrHardMeasurement *g, const WrField *field, const WrScene *scene, WrError *err)
{
    const WrFrameRequest request = { .field = field, .scene = scene, .width = 40, .height = 40 };
    bool good = true;
    for (int way = 0; way < WR_HARD_WAYS && good; way++) {
        WrHardShot shot = { .renderer = NULL };
        good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &shot, err);
        if (good) wr_hard_holds(g, wr_hard_precision(way), wr_hard_wild(&shot) == 0);
        wr_hard_put_away(&shot);
    }
    WrReference reference = { 0 };
    good = good && wr_hard_refer(g, &request, 1, &reference, err);
    if (good) wr_hard_holds(g, WR_HARD_DOUBLE, wr_hard_wild_reference(&reference) == 0);
    wr_reference_fini(&reference);
    return good;
}

/* Share of pixels in which pictures of each arithmetic differ from the reference by more than `off`. */
static bool against_reference(WrHardMeasurement *g, const WrFrameRequest *request, int samples,
                              double off, WrError *err)
{
    const int count = request->width * request->height;
    WrReference reference = { 0 };
    bool good = wr_hard_refer(g, request, samples, &reference, err);
    for (int way = 0; way < WR_HARD_WAYS && good; way++) {
        WrHardShot shot = { .renderer = NULL };
        int differ = 0;
        good = wr_hard_shoot_by(g, request, (WrHardWay)way, &shot, err);
        for (int i = 0; i < count && good; i++) {
            const float *p = shot.frame.rgba + 4 * (size_t)i;
            const double *q = reference.rgba + 4 * (size_t)i;
            differ += !(fabs((double)p[0] - q[0]) <= off && fabs((double)p[3] - q[3]) <= off);
        }
        if (good) wr_hard_record_error(g, wr_hard_precision(way), (double)differ / count);
        wr_hard_put_away(&shot);
    }
    wr_reference_fini(&reference);
    return good;
}

static WrScene *scene_of_far(WrSurfaceKind kind)
{
    WrScene *scene = wr_scene_new();
    scene->shape = wr_hard_shape(kind);
    scene->posed = true;
    scene->height = 0.002; /* the reference uses another scheme */
    return scene;
}

static void give_light(WrScene *scene, WrLightKind kind, WrVec3 where)
{
    scene->lights_given = true;
    scene->lights[0] =
        (WrLight){ .kind = kind, .where = where, .colour = { 1, 1, 1 }, .strength = 1 };
}

/* ---- eyes ---- */

bool wr_hard_hc158(WrHardMeasurement *g, WrError *err)
{
    static const struct {
        WrSurfaceKind kind;
        WrVec3 eye;
    } inside[] = {
        { WR_SURFACE_sphere, { 0, 0, 0 } },   { WR_SURFACE_sphere, { 0.9999, 0, 0 } },
        { WR_SURFACE_cube, { 0, 0, 0 } },     { WR_SURFACE_cube, { 0.1, 0.2, 0.499 } },
        { WR_SURFACE_cylinder, { 0, 0, 0 } }, { WR_SURFACE_cylinder, { 0, 0.65, 0.1 } },
        { WR_SURFACE_cone, { 0, 0, -0.2 } },  { WR_SURFACE_cone, { 0, 0, 0.7 } },
        { WR_SURFACE_torus, { 1, 0, 0 } },    { WR_SURFACE_torus, { 1.39, 0, 0 } },
    };
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < 10 && good; k++) {
        WrScene *scene = scene_of_far(inside[k].kind);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = 48, .height = 48
        };
        const WrVec3 eye = inside[k].eye;
        give_light(scene, WR_LIGHT_POINT, v3_add(eye, (WrVec3){ -0.01, 0.02, 0.015 }));
        scene->camera = (WrCamera){ .eye = eye,
                                    .target = v3_add(eye, (WrVec3){ -1, 0.3, 0.2 }),
                                    .up = { 0, 0, 1 },
                                    .fov_deg = 70 };
        good = against_reference(g, &request, 1, 0.02, err);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

bool wr_hard_hc164(WrHardMeasurement *g, WrError *err)
{
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < 1 && good; k++) {
        WrScene *scene = scene_of_far(WR_SURFACE_ribbon);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = 32, .height = 32
        };
        scene->shape.value[4] = k ? -60 : 60;
        scene->height = 0.002;
        scene->material.specular = 0.0;
        scene->dials.aa = WR_AA_SUPERSAMPLE;
        scene->dials.samples = 8;
        give_light(scene, WR_LIGHT_DIRECTIONAL, (WrVec3){ 0.3, 0.4, 0.8 });
        scene->camera =
            (WrCamera){ .orthographic = true, .eye = { 0, 0, 5 }, .up = { 0, 1, 0 }, .size = 2.6 };
        good = against_reference(g, &request, 8, 0.05, err);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* Orthographic from above, and a perspective view from near: each ray hits the cone. */
bool wr_hard_hc167(WrHardMeasurement *g, WrError *err)
{
    enum { SIZE = 41 };
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < 12 && good; k++) {
        const double grow = k % 2 ? wr_hard_between(g, 1e3, 1e6) : wr_hard_between(g, 1e-6, 1);
        const double window = pow(10, -1 - k / 2) * grow;
        WrScene *scene = scene_of_far(WR_SURFACE_cone);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = SIZE, .height = SIZE
        };
        for (int p = 0; p < 2; p++) scene->shape.value[p] *= grow;
        scene->height = 1e-3 * grow;
        scene->camera = (WrCamera){
            .orthographic = true, .eye = { 0, 0, 5 * grow }, .up = { 0, 1, 0 }, .size = window
        };
        WrReference reference = { 0 };
        good = wr_hard_refer(g, &request, 1, &reference, err);
        for (int i = 0; i < SIZE * SIZE && good; i++)
            wr_hard_holds(g, WR_HARD_DOUBLE, reference.rgba[4 * i + 3] == 1.0);
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrHardShot shot = { .renderer = NULL };
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &shot, err);
            if (good) wr_hard_holds(g, wr_hard_precision(way), shot.frame.covered == SIZE * SIZE);
            wr_hard_put_away(&shot);
        }
        wr_reference_fini(&reference);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* The middle column looks down by 45 degrees at its middle and by `far` at the ground's end: below that every
   pixel shows ground, in every arithmetic. */
static bool down_to_the_feet(WrHardMeasurement *g, const WrFrameRequest *request, double far,
                             WrError *err)
{
    const int size = request->height;
    WrReference reference = { 0 };
    bool good = wr_hard_refer(g, request, 1, &reference, err);
    for (int way = 0; way < WR_HARD_WAYS && good; way++) {
        WrHardShot shot = { .renderer = NULL };
        good = wr_hard_shoot_by(g, request, (WrHardWay)way, &shot, err);
        for (int y = 0; y < size && good; y++) {
            const double tangent = (1 - 2 * (y + 0.5) / size) * tan(60 * WR_RAD_PER_DEG);
            const size_t at = 4 * ((size_t)y * (size_t)size + (size_t)size / 2) + 3;
            if (WR_RAD_PER_DEG * 45 - atan(tangent) < far + 0.02) continue;
            if (!(shot.frame.rgba[at] == 1.0f))
                wr_hard_record_error(g, wr_hard_precision(way), 1.0);
            if (!(reference.rgba[at] == 1.0)) wr_hard_record_error(g, WR_HARD_DOUBLE, 1.0);
        }
        wr_hard_put_away(&shot);
    }
    wr_reference_fini(&reference);
    return good;
}

/* The plane in closed form, and as a bent patch by mesh: flat, so that only its position matters. */
bool wr_hard_hc168(WrHardMeasurement *g, WrError *err)
{
    static const double sides[] = { 3, 2e5, 1.7e7 };
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < 6 && good; k++) {
        const double side = sides[k / 2];
        WrScene *scene = scene_of_far(k % 2 ? WR_SURFACE_bent : WR_SURFACE_plane);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = 60, .height = 60
        };
        scene->shape.value[0] = scene->shape.value[1] = side;
        if (k % 2) scene->shape.value[2] = scene->shape.value[3] = scene->shape.value[4] = 0.0;
        scene->height = scene->material.specular = 0.0;
        give_light(scene, WR_LIGHT_DIRECTIONAL, (WrVec3){ 0.2, 0.3, 0.7 });
        scene->camera = (WrCamera){
            .eye = { 0, 0, 0.5 }, .target = { 0, 0.5, 0 }, .up = { 0, 0, 1 }, .fov_deg = 120
        };
        good = against_reference(g, &request, 1, 0.02, err) &&
               down_to_the_feet(g, &request, atan(0.5 / (0.5 * side)), err);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* An infinite plane: from above and below, looking up, along it and away from it, on it, and from so far that
   its sides are smaller than a pixel. The formula for the area of a far pixel is infinite. */
bool wr_hard_hc179(WrHardMeasurement *g, WrError *err)
{
    static const struct {
        double eye, up; /* the eye's height; the upward component of the view */
    } sights[] = { { 0.5, -0.1 },  { 0.5, 0 },    { -0.7, 0.2 }, { -0.7, -0.3 }, { 1e-6, 0 },
                   { -1e-9, 0.1 }, { 40, -0.02 }, { 1e6, -0.5 }, { 1e9, -1.5 },  { 0, 0 } };
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < 10 && good; k++) {
        WrScene *scene = scene_of_far(WR_SURFACE_plane);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = 40, .height = 40
        };
        const WrVec3 eye = { wr_hard_between(g, -3, 3), wr_hard_between(g, -3, 3), sights[k].eye };
        scene->shape.value[2] = 1;
        scene->camera = (WrCamera){ .eye = eye,
                                    .target = v3_add(eye, (WrVec3){ 0.2, 1, sights[k].up }),
                                    .up = { 0, 0, 1 },
                                    .fov_deg = 60 };
        give_light(scene, WR_LIGHT_DIRECTIONAL, (WrVec3){ 0.2, 0.3, 0.7 });
        good = wr_hard_tame(g, field, scene, err);
        scene->height = scene->material.specular = 0.0;
        if (sights[k].eye != 0) good = good && against_reference(g, &request, 1, 0.02, err);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* Below 0.01 degrees, compared with the equivalent window at the object. */
bool wr_hard_hc170(WrHardMeasurement *g, WrError *err)
{
    enum { SIZE = 72 };
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < WR_SURFACE_COUNT && good; k++) {
        WrScene *scene = scene_of_far((WrSurfaceKind)k);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = SIZE, .height = SIZE
        };
        const double window = 2.4 * wr_shape_radius(&scene->shape);
        const double away = window / (2.0 * tan(0.005 * WR_RAD_PER_DEG));
        scene->rotate_deg = (WrVec3){ -50, 10, 0 };
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrHardShot far = { .renderer = NULL }, flat = { .renderer = NULL };
            scene->camera = (WrCamera){ .eye = { 0, 0, away }, .up = { 0, 1, 0 }, .fov_deg = 0.01 };
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &far, err);
            scene->camera = (WrCamera){
                .orthographic = true, .eye = { 0, 0, 9 }, .up = { 0, 1, 0 }, .size = window
            };
            good = good && wr_hard_shoot_by(g, &request, (WrHardWay)way, &flat, err);
            if (good)
                wr_hard_record_error(g, wr_hard_precision(way),
                                     (double)wr_hard_differ(&far, &flat, 0.002) /
                                         (4 * SIZE * SIZE));
            if (good)
                wr_hard_record_error(g, wr_hard_precision(way),
                                     flat.frame.covered > 300 ? 0.0 : 1.0);
            wr_hard_put_away(&far);
            wr_hard_put_away(&flat);
        }
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* Odd sizes put a pixel's centre on the corner towards the eye, and columns on edges. */
bool wr_hard_hc171(WrHardMeasurement *g, WrError *err)
{
    static const WrVec3 eyes[] = { { 3, 3, 3 }, { 3, 3, 0 }, { 0, -3, 3 }, { 3, 0, 0 } };
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < 12 && good; k++) {
        const int size = 21 + 2 * (k / 4) * 17;
        WrScene *scene = scene_of_far(WR_SURFACE_cube);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = size, .height = size
        };
        /* inside the outline for any side: the sphere inscribed in the cube */
        scene->camera =
            (WrCamera){ .orthographic = true, .eye = eyes[k % 4], .up = { 0, 0, 1 }, .size = 0.69 };
        WrReference reference = { 0 };
        good = wr_hard_refer(g, &request, 1, &reference, err);
        for (int i = 0; i < size * size && good; i++)
            wr_hard_holds(g, WR_HARD_DOUBLE, reference.rgba[4 * i + 3] == 1.0);
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrHardShot shot = { .renderer = NULL };
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &shot, err);
            if (good) wr_hard_holds(g, wr_hard_precision(way), shot.frame.covered == size * size);
            wr_hard_put_away(&shot);
        }
        wr_reference_fini(&reference);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* right, up and forward: unit length, orthogonal, right-handed. */
bool wr_hard_hc172(WrHardMeasurement *g, WrError *err)
{
    WrScene *scene = scene_of_far(WR_SURFACE_torus);
    bool good = true;
    for (int k = 0; k < 300 && good; k++) {
        const WrVec3 view = { wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1),
                              k % 3 ? wr_hard_between(g, -1, 1) : 0.0 };
        const WrVec3 aside = { wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1), 0.3 };
        const double tilt = k % 4 ? pow(10, -k % 17) : 0.0;
        WrPlacement place;
        scene->camera =
            (WrCamera){ .eye = v3_scale(view, 7.0),
                        .up = v3_mad(v3_scale(view, k % 2 ? -1.0 : 1.0), aside, k % 5 ? tilt : 0),
                        .fov_deg = 30 };
        if (k % 20 == 0) scene->camera.up = (WrVec3){ 0, 0, 0 };
        good = wr_scene_place(scene, 0, 1, &place, err);
        if (!good) break;
        const WrVec3 axes[3] = { place.right, place.up, v3_neg(place.forward) };
        for (int a = 0; a < 3; a++) {
            wr_hard_near(g, WR_HARD_DOUBLE, v3_dot(axes[a], axes[a]), 1.0);
            wr_hard_near(g, WR_HARD_DOUBLE, v3_dot(axes[a], axes[(a + 1) % 3]), 0.0);
        }
        wr_hard_near(g, WR_HARD_DOUBLE, v3_dot(axes[2], v3_cross(axes[0], axes[1])), 1.0);
    }
    wr_scene_free(scene);
    return good;
}

/* ---- light from behind ---- */

/* v and l almost opposite: the rounding error of h is ulp / |l + v|; a power s makes s (n'.h) of it, or its
   square root of s near 1. */
bool wr_hard_hc166(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    for (int k = 0; k < 4000; k++) {
        const double tilt = pow(10, -9 * wr_hard_random(g)), s = k % 3 ? 20 : 1000;
        const double around = 2.0 * WR_PI * wr_hard_random(g);
        const WrVec3 v = v3_unit((WrVec3){ cos(around), sin(around), wr_hard_between(g, 0, 0.5) },
                                 (WrVec3){ 0, 0, 1 });
        const WrVec3 n = { 0, 0, 1 };
        const WrVec3 aside = v3_unit(v3_cross(v, (WrVec3){ 0.1, 0.2, 1 }), n);
        /* h at random around n, as wide as the lobe */
        const WrVec3 h_way = v3_mad(n, aside, 3.0 * wr_hard_random(g) / sqrt(s));
        const WrVec3 l = v3_unit(v3_mad(v3_neg(v), h_way, tilt), n);
        for (int set = 0; set < g->all; set++) {
            WrStrip *strip = g->strip;
            const WrVec3f lf = v3f_from(l), vf = v3f_from(v);
            const WrKernLight lamp = { .where = { lf.x, lf.y, lf.z }, .rgb = { 1, 1, 1 } };
            strip->count = 1;
            strip->bx[0] = strip->by[0] = 0.0f, strip->bz[0] = 1.0f;
            strip->vx[0] = vf.x, strip->vy[0] = vf.y, strip->vz[0] = vf.z;
            strip->px[0] = strip->py[0] = strip->pz[0] = 0.0f;
            g->kernels[set]->begin(0.0f, strip);
            g->kernels[set]->light(&lamp, strip);
            g->kernels[set]->specular(&lamp, 1.0f, (float)s, false, strip);
            const WrVec3 h = v3_add(wr_hard_vec(lf), wr_hard_vec(vf));
            const double len = v3_len(h), got = (double)strip->sr[0];
            const double c = len > 1e-12 ? fmax(0.0, h.z / len) : 0.0;
            wr_hard_record_error(g, WR_HARD_FLOAT, got >= 0.0 && got <= 1.0 ? 0.0 : 2.0);
            wr_hard_record_error(g, WR_HARD_FLOAT,
                                 fabs(got - pow(c, s)) /
                                     (s * (double)FLT_EPSILON / fmax(len, 1e-12)));
        }
        WrStripd *strip = g->wide_strip;
        const WrKernLightd lamp = { .where = { l.x, l.y, l.z }, .rgb = { 1, 1, 1 } };
        strip->count = 1;
        strip->bx[0] = strip->by[0] = 0.0, strip->bz[0] = 1.0;
        strip->vx[0] = v.x, strip->vy[0] = v.y, strip->vz[0] = v.z;
        strip->px[0] = strip->py[0] = strip->pz[0] = 0.0;
        g->wide[1]->begin(0.0, strip);
        g->wide[1]->light(&lamp, strip);
        g->wide[1]->specular(&lamp, 1.0, s, false, strip);
        const WrVec3 h = v3_add(l, v);
        const double len = v3_len(h), c = fmax(0.0, h.z / len);
        wr_hard_record_error(g, WR_HARD_DOUBLE,
                             fabs(strip->sr[0] - pow(c, s)) / (s * DBL_EPSILON / len));
    }
    return true;
}

/* ---- seams and filters ---- */

/* The kernels' closed forms for rays that hit y = +-0: u is 0 where x > 0 and a half where x < 0. */
bool wr_hard_hc169(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const float nothing[] = { 0.0f, -0.0f, 1e-45f, -1e-45f, 1e-20f, -1e-20f, 1e-9f, -1e-9f };
    static const WrSurfaceKind kinds[] = { WR_SURFACE_sphere, WR_SURFACE_cylinder,
                                           WR_SURFACE_cone };
    for (int k = 0; k < 3 * 8 * 2; k++) {
        const WrShape shape = wr_hard_shape(kinds[k % 3]);
        const bool behind = k / 24;
        WrShapef single;
        wr_shape_scaled(&shape, 1.0, &single);
        /* from x = +-9 towards the middle, a tenth of a unit below it */
        const float side = behind ? -1.0f : 1.0f, y = nothing[k / 3 % 8];
        const WrRays rays = { .q0 = { 0, y, -0.1f }, .d0 = { -side, 0, 0 }, .s_min = -9.0f };
        const WrRaysd wide = { .q0 = { 0, (double)y, -0.1 },
                               .d0 = { (double)-side, 0, 0 },
                               .s_min = -9.0 };
        for (int set = 0; set < g->all; set++) {
            const WrKernels *kernels = g->kernels[set];
            const WrRound *body = &kernels->round[wr_surfaces[kinds[k % 3]]->inversion];
            const int hits = body->hit(&rays, &single, 0, 0, 1, g->strip);
            body->params(&single, g->strip);
            const double u = (double)g->strip->u[0], want = behind ? 0.5 : 0.0;
            const double off = fabs(u - want), round = fmin(off, 1.0 - off);
            wr_hard_holds(g, WR_HARD_FLOAT, hits == 1 && u >= 0.0 && u < 1.0 && round < 1e-6);
        }
        const WrRoundd *body = &g->wide[1]->round[wr_surfaces[kinds[k % 3]]->inversion];
        const int hits = body->hit(&wide, &shape, 0, 0, 1, g->wide_strip);
        body->params(&shape, g->wide_strip);
        const double u = g->wide_strip->u[0], off = fabs(u - (behind ? 0.5 : 0.0));
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      hits == 1 && u >= 0.0 && u < 1.0 && fmin(off, 1.0 - off) < 1e-6);
    }
    return true;
}

/* A table rolled by half on a body turned by half: the former seam is now at its back. Filters that used the
   step of u across the seam as a footprint would blur it. */
bool wr_hard_hc174(WrHardMeasurement *g, WrError *err)
{
    static const WrSurfaceKind kinds[] = { WR_SURFACE_cylinder, WR_SURFACE_torus,
                                           WR_SURFACE_sphere };
    WrField *field = wr_hard_waves(64, 64), *rolled = wr_hard_rolled(field, 32, 0);
    bool good = true;
    for (int k = 0; k < 3 * 4 && good; k++) {
        WrScene *scene = scene_of_far(kinds[k / 4]);
        WrFrameRequest request = { .field = field, .scene = scene, .width = 64, .height = 64 };
        WrHardShot seam = { .renderer = NULL }, back = { .renderer = NULL };
        scene->dials.aa = WR_AA_MOMENTS;
        scene->dials.moments = k % 2 ? WR_MOMENTS_LEAN : WR_MOMENTS_TOKSVIG;
        scene->dials.footprint = k / 2 % 2 ? WR_FOOTPRINT_ANISOTROPIC : WR_FOOTPRINT_ISOTROPIC;
        scene->camera =
            (WrCamera){ .orthographic = true, .eye = { 5, 0, 0.4 }, .up = { 0, 0, 1 }, .size = 3 };
        give_light(scene, WR_LIGHT_DIRECTIONAL, (WrVec3){ 1, 0.3, 0.5 });
        good = wr_hard_shoot(g, &request, &seam, err);
        request.field = rolled;
        scene->rotate_deg = (WrVec3){ 0, 0, 180 };
        good = good && wr_hard_shoot(g, &request, &back, err);
        for (int i = 0; i < 4 * 64 * 64 && good; i++) /* outlines may differ in a pixel */
            if (i % 4 < 3 && seam.frame.rgba[i / 4 * 4 + 3] == back.frame.rgba[i / 4 * 4 + 3])
                wr_hard_near(g, WR_HARD_FLOAT, (double)seam.frame.rgba[i],
                             (double)back.frame.rgba[i]);
        wr_hard_put_away(&seam);
        wr_hard_put_away(&back);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    wr_field_free(rolled);
    return good;
}

/* Compared with the picture without heights, without highlights: the highlight is spread, as it should be. */
bool wr_hard_hc163(WrHardMeasurement *g, WrError *err)
{
    static const double repeats[] = { 1e6, 1e6 / 3.0, 12345.678, -1e6 };
    WrField *field = wr_hard_waves(64, 64);
    bool good = true;
    for (int k = 0; k < 8 && good; k++) {
        WrScene *scene = scene_of_far(k % 2 ? WR_SURFACE_bent : WR_SURFACE_plane);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = 48, .height = 48
        };
        WrHardShot level = { .renderer = NULL }, bumpy = { .renderer = NULL };
        scene->replicate_u = repeats[k / 2];
        scene->replicate_v = repeats[3 - k / 2];
        scene->material.specular = 0.0;
        scene->dials.aa = WR_AA_MOMENTS;
        scene->height = 0.0;
        good = wr_hard_shoot(g, &request, &level, err);
        scene->height = 0.01 / fabs(fmax(scene->replicate_u, scene->replicate_v));
        good = good && wr_hard_shoot(g, &request, &bumpy, err);
        for (int i = 0; i < 4 * 48 * 48 && good; i++)
            wr_hard_near(g, WR_HARD_FLOAT, (double)bumpy.frame.rgba[i],
                         (double)level.frame.rgba[i]);
        wr_hard_put_away(&level);
        wr_hard_put_away(&bumpy);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}
