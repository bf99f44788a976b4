/* Hard cases of visibility: near planes, insides, shared edges, tiny patches; and of rotation. */
#include "hardcases/hardcases_internal.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/pool.h"
#include "field/field.h"
#include "scene/scene.h"
#include "base/vec.h"

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
static bool closed_against_mesh(WrHardGauge *g, WrError *err)
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
        wr_hard_off(g, WR_HARD_FLOAT, (double)differ / (W * H));
        wr_hard_off(g, WR_HARD_DOUBLE, (double)differ_double / (W * H));
        wr_hard_off(g, WR_HARD_FLOAT, shots[0].frame.covered > 2000 ? 0.0 : 1.0);
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
static bool among_surfaces(WrHardGauge *g, WrError *err)
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
            wr_hard_off(g, way == WR_HARD_WIDE ? WR_HARD_DOUBLE : WR_HARD_FLOAT, part);
            wr_hard_off(g, WR_HARD_FLOAT, shot.frame.covered > 200 ? 0.0 : 1.0);
            wr_hard_put_away(&shot);
        }
        wr_reference_fini(&reference);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

static bool hc82(WrHardGauge *g, WrError *err)
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
static bool hc83(WrHardGauge *g, WrError *err)
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
static bool hc84(WrHardGauge *g, WrError *err)
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
static WrScene *filling(WrHardGauge *g, int k, bool behind)
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
static bool hc85(WrHardGauge *g, WrError *err)
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
static bool large_coverage(WrHardGauge *g, const WrFrameRequest *request, double *out, WrError *err)
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
static bool hc86(WrHardGauge *g, WrError *err)
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
static bool hc87(WrHardGauge *g, WrError *err)
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
        wr_hard_off(g, WR_HARD_DOUBLE,
                    fabs(atan2(a[2] * b[0] - a[0] * b[2], a[0] * b[0] + a[2] * b[2])));
    }
    wr_scene_free(scene);
    return good;
}

static bool hc88(WrHardGauge *g, WrError *err)
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
    ROW(82, "surfaces that reach behind the eye",
        "the mesh gives what the closed form gives, and pictures what the reference gives",
        "of pixels", 0.02, 0.02,
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
        "no background shows through, and any number of threads gives the same pixels",
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
    ROW(87, "a day of turning at 60 Hz", "the angle is that of the tick's number", "rad", NAN, 1e-9,
        NULL),
    ROW(88, "any number of turns", "the rotation's determinant is 1 and its rows are orthonormal",
        "relative", NAN, 1e-6, NULL),
};
WR_HARD_LIST(turn, turned);
