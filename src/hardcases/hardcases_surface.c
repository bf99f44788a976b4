/* Hard cases of points and normals: poles, tips, collapsed edges, extreme lengths. */
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/text.h"
#include "base/vec.h"
#include "field/field.h"
#include "field/scheme_list.h"
#include "hardcases/hardcases_frames.h"
#include "hardcases/hardcases_internal.h"
#include "render/reference/reference_intersect.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "shade/bump.h"
#include "surface/data.h"
#include "surface/patches.h"
#include "surface/terrain.h"

#include <float.h>
#include <string.h>

bool wr_hard_hc33(WrHardMeasurement *gauge, WrError *err);
bool wr_hard_hc34(WrHardMeasurement *gauge, WrError *err);
bool wr_hard_hc153(WrHardMeasurement *gauge, WrError *err);
bool wr_hard_hc154(WrHardMeasurement *gauge, WrError *err);

/* ---- hardcases forms ---- */

/* Hard cases of surfaces defined by exponents and by text: superellipsoids, profiles, formulas. */

/* n at (u, v) of each kernel set and of the formula, compared with the expected one. */
static void angles(WrHardMeasurement *g, const WrShape *shape, double u, double v, WrVec3 want)
{
    WrSurfacePoint at;
    wr_surface_at(shape, 0, u, v, &at);
    wr_hard_record_error(g, WR_HARD_DOUBLE, v3_angle_rad(at.n_unit, want));
    for (int k = 0; k < g->sets; k++) {
        WrSurfacePointf atf = wr_hard_point(g, k, shape, 1.0, 0, (float)u, (float)v);
        wr_hard_record_error(g, WR_HARD_FLOAT, v3_angle_rad(wr_hard_vec(atf.n_unit), want));
    }
}

static bool hc143(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    WrShape shape = wr_hard_shape(WR_SURFACE_superellipsoid);
    const double forms[4] = { 0.1, 1, 1.9, 3.9 };
    for (int k = 0; k < 16; k++) {
        const double e1 = forms[k % 4], e2 = forms[k / 4];
        shape.value[3] = e1, shape.value[4] = e2;
        /* The pole, from any direction except along a cusp; the arm along x; the side of the arm along x. */
        for (int pole = 0; pole < 2; pole++)
            if (e1 < 2) angles(g, &shape, 0.125, pole, (WrVec3){ 0, 0, pole ? 1 : -1 });
        if (e1 < 2 && e2 < 2) angles(g, &shape, 0, 0.5, (WrVec3){ 1, 0, 0 });
        if (e1 < 2 && e2 > 2) angles(g, &shape, 0, 0.5, (WrVec3){ 0, 1, 0 });
        if (e1 > 2 && e2 < 2) angles(g, &shape, 0, 0.5, (WrVec3){ 0, 0, 1 });
    }
    return true;
}

static WrSurfaceData *made(WrSurfaceKind kind, const char *one, WrError *err)
{
    const char *const text[WR_SURFACE_TEXTS] = { one };
    return wr_surface_data_make(kind, text, err);
}

static bool hc144(WrHardMeasurement *g, WrError *err)
{
    static const char *const wrong[3] = { "1,0;0,0.5;1,1", "1,0;0.01,0.5;0.01,1.5;1,2",
                                          "1,0;1,0;0,0.5;0,0.5;1,1" };
    WrSurfaceData *egg = made(WR_SURFACE_revolution, "0,-1.125;0.8125,-0.75;0,0.875", err);
    if (!egg) return false;
    WrShape shape = wr_hard_shape(WR_SURFACE_revolution);
    wr_shape_borrow_data(&shape, egg);
    for (int i = 0; i < 32; i++)
        angles(g, &shape, i / 16.0 / 2, i % 2, (WrVec3){ 0, 0, i % 2 ? 1 : -1 });
    wr_surface_data_free(egg);
    for (int k = 0; k < 3; k++) {
        WrError why = { "" };
        WrSurfaceData *data = made(WR_SURFACE_revolution, wrong[k], &why);
        wr_hard_near(g, WR_HARD_DOUBLE, data == NULL && strstr(why.text, "axis at v = 0."), 1);
        wr_surface_data_free(data);
    }
    return true;
}

/* The expression is refused, and the message names the column. */
static void refused(WrHardMeasurement *g, const char *expression, const char *column)
{
    WrError why = { "" };
    WrSurfaceData *data = made(WR_SURFACE_formula, expression, &why);
    wr_hard_holds(g, WR_HARD_DOUBLE, data == NULL && strstr(why.text, column));
    wr_surface_data_free(data);
}

static bool hc149(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    refused(g, "1+sqrt(u)", "column 3");
    refused(g, "2*atan2(u-0.5,v-0.5)", "column 3");
    refused(g, "1/(u-0.5)", "column 2");
    refused(g, "log(u)", "column 1");
    refused(g, "u+(v-0.5)^1.5", "column 10");
    WrSurfaceData *data = made(WR_SURFACE_formula, "0^0+(u-0.5)^0", NULL);
    wr_hard_holds(g, WR_HARD_DOUBLE, data != NULL);
    if (!data) return true;
    WrShape shape = wr_hard_shape(WR_SURFACE_formula);
    WrSurfacePoint at;
    wr_shape_borrow_data(&shape, data);
    wr_surface_at(&shape, 0, 0.5, 0.25, &at);
    wr_hard_holds(g, WR_HARD_DOUBLE, at.p.x == 2 && at.pu.x == 0 && at.puu.x == 0);
    wr_surface_data_free(data);
    return true;
}

static bool hc150(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const char *const open[5] = { "(", "-", "sin(", "2^", "1+(" };
    for (int k = 0; k < 5; k++)
        for (int length = 100; length <= 100000; length *= 10) {
            WrText text = { 0 };
            for (int i = 0; i < length; i++) wr_text_add(&text, open[k]);
            wr_text_add(&text, "u");
            refused(g, wr_text_get(&text), "");
            wr_text_fini(&text);
        }
    refused(g, "1e308*10*u", "column");
    refused(g, "exp(exp(exp(10*u)))", "too large");
    return true;
}

#define GEOMETRY(number, situation, rule, u, in_float, in_double, script)                          \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_GEOMETRY, .what = situation, .holds = rule,         \
        .unit = u, .bound = { in_float, in_double }, .measure = hc##number, .scene = script        \
    }
static const WrHardCase rows[] = {
    GEOMETRY(143, "superellipsoids with exponents of 0.1 to 3.9 at their axes and poles",
             "n is the limit: the axis, or square to the arm of a cusp", "rad", 1e-6, 1e-14,
             "table 64x64\ngrid cells=8x8 width=2\nsurface superellipsoid e1=3.9 e2=3.9\nbump "
             "height=0.1"),
    GEOMETRY(144, "a profile that ends on the axis, and some that touch it before",
             "the poles have one normal; contact is refused with its v", "rad", 1e-6, 1e-14,
             "table 64x64\ngrid cells=8x8 width=2\nsurface revolution "
             "profile=0,-1.125;0.8125,-0.75;0,0.875\nrotate 15,0,0\nbump height=0.1"),
    GEOMETRY(149, "formulas without a value or a slope somewhere",
             "they are refused with their column, and 0^0 is 1", "violations", NAN, 0, NULL),
    GEOMETRY(150, "formulas of 100000 parentheses, and numbers beyond all bounds",
             "they are refused, and the stack stays as deep as it may", "violations", NAN, 0, NULL),
};
WR_HARD_LIST(forms, rows);

/* ---- hardcases patches ---- */

/* Hard cases of sets of bicubic patches: tables across rotated and mirrored edges, and missing patches. */

enum { SIDE = 5 };

/* Patches over rough heights. The caller frees them. */
static float (*rough_points(WrHardMeasurement *g, int side, double height))[48]
{
    float heights[SIDE * SIDE * 4], (*points)[48];
    int columns, rows_patches;
    for (int i = 0; i < SIDE * SIDE * 4; i++) heights[i] = wr_hard_float(g);
    const WrTerrain terrain = { NULL, heights, 2 * SIDE, 2 * SIDE, 1, 1, height, side };
    return wr_terrain_points(&terrain, &points, &columns, &rows_patches, NULL) ? points : NULL;
}

void wr_hard_ground(WrHardMeasurement *g, WrScene *scene)
{
    float(*points)[48] = rough_points(g, SIDE, 0.1);
    const double turn = wr_hard_between(g, 0, 6);
    wr_shape_default(WR_SURFACE_patches, &scene->shape);
    wr_scene_set_triangles(
        scene, wr_patches_new((const float(*)[48])points, SIDE * SIDE, WR_PATCH_SPLIT, NULL), NULL,
        NULL);
    scene->camera.up = (WrVec3){ cos(turn), sin(turn), 0 };
    wr_free(points);
}

/* ---- HC151 ---- */

/* Changes u and v: rotated by a quarter, or mirrored. */
static void change_points(float points[48], bool mirror)
{
    float old[48];
    memcpy(old, points, sizeof old);
    for (int k = 0; k < 16; k++) {
        const int i = k % 4, j = k / 4, from = mirror ? 4 * j + 3 - i : 4 * (3 - i) + j;
        memcpy(points + 3 * k, old + 3 * from, 3 * sizeof *old);
    }
}

/* F, and its gradient on the patch, at the patch's u and v. */
static double on_patch(const WrPatches *set, int32_t i, const double uv[2], const WrField *field,
                       WrVec3 *place, WrVec3 *gradient)
{
    const WrPatch *patch = &set->patch[i];
    const float *c = patch->chart;
    WrShape shape = wr_hard_shape(WR_SURFACE_bezier);
    WrSurfacePoint at;
    double u, v;
    for (int k = 0; k < 48; k++) shape.value[k] = (double)patch->point[k];
    wr_surface_at(&shape, 0, uv[0], uv[1], &at);
    wr_patch_chart(set, patch, uv[0], uv[1], &u, &v);
    const WrHardSlope slope = wr_hard_sample(field, WR_SCHEME_BSPLINE, u, v);
    const double fs = slope.fu * set->scale_u, ft = slope.fv * set->scale_v;
    const WrVec3 gu = v3_scale(v3_cross(at.pv, at.n_unit), 1 / at.n_len);
    const WrVec3 gv = v3_scale(v3_cross(at.n_unit, at.pu), 1 / at.n_len);
    *place = at.p;
    *gradient = v3_add(v3_scale(gu, fs * (double)c[1] + ft * (double)c[4]),
                       v3_scale(gv, fs * (double)c[2] + ft * (double)c[5]));
    return slope.f;
}

/* The common edges of a square's four patches: points with equal positions. */
static void compare_edges(WrHardMeasurement *g, const WrPatches *set, const WrField *field)
{
    int met = 0;
    for (int32_t a = 0; a < 16; a++)
        for (int32_t b = a + 1; b < 16; b++)
            for (int k = 0; k < 9 && a / 4 != b / 4; k++)
                for (int way = 0; way < 2; way++) {
                    const double t = 0.0625 + k * 0.109375, s = way ? 1 - t : t;
                    const double at[2] = { a % 4 < 2 ? t : a % 4 - 2, a % 4 < 2 ? a % 4 : t };
                    const double to[2] = { b % 4 < 2 ? s : b % 4 - 2, b % 4 < 2 ? b % 4 : s };
                    WrVec3 p, q, slope, other;
                    const double f = on_patch(set, a / 4, at, field, &p, &slope);
                    const double h = on_patch(set, b / 4, to, field, &q, &other);
                    if (!(v3_len(v3_sub(p, q)) < 1e-9)) continue;
                    met++;
                    wr_hard_record_error(g, WR_HARD_DOUBLE,
                                         f == h ? v3_len(v3_sub(slope, other)) / (1 + v3_len(slope))
                                                : 1);
                }
    wr_hard_holds(g, WR_HARD_DOUBLE, met >= 4 * 9);
}

static bool hc151(WrHardMeasurement *g, WrError *err)
{
    WrField *field = wr_hard_random_table(g, 16, 16, WR_WRAP_PERIODIC);
    bool good = true;
    for (int round = 0; round < 24 && good; round++) {
        float(*points)[48] = rough_points(g, 2, 0.3);
        for (int i = 0; i < 4; i++) {
            for (int k = (int)(4 * wr_hard_random(g)); k > 0; k--) change_points(points[i], false);
            if (wr_hard_random(g) < 0.5) change_points(points[i], true);
        }
        const WrPatchTable table = round % 2 ? WR_PATCH_SPLIT : WR_PATCH_JOINED;
        WrTriangles *made = wr_patches_new((const float(*)[48])points, 4, table, err);
        good = made != NULL;
        if (good) compare_edges(g, made->patches, field);
        wr_triangles_free(made);
        wr_free(points);
    }
    wr_field_free(field);
    return good;
}

/* ---- HC152 ---- */

/* Smooth terrain of 5 x 5 patches; a control point beside an edge is moved; a patch is missing; a single one
   with one edge shrunk to a point. */
static bool hc152(WrHardMeasurement *g, WrError *err)
{
    bool good = true;
    for (int k = 0; k < 4 && good; k++) {
        float(*points)[48] = rough_points(g, SIDE, 0.1);
        int32_t count = SIDE * SIDE;
        if (k == 1) points[12][3 * 5 + 2] += 0.01f; /* beside v = 0 of the middle one */
        if (k == 2) memmove(points + 12, points + 13, 12 * sizeof *points), count--;
        for (int i = 1; i < 4 && k == 3; i++)
            memcpy(points[0] + 3 * i, points[0], 3 * sizeof **points);
        if (k == 3) count = 1;
        WrTriangles *made = wr_patches_new((const float(*)[48])points, count, WR_PATCH_EACH, err);
        good = made != NULL;
        if (!good) break;
        const WrPatchesReport *report = &made->patches->report;
        wr_hard_holds(g, WR_HARD_DOUBLE, (report->creased > 0) == (k == 1));
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      k != 1 || (report->crease_of[0] <= 12 && report->crease_of[1] <= 17));
        wr_hard_holds(g, WR_HARD_DOUBLE, report->loops == (k == 2 ? 2 : 1));
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      report->open == (k == 3 ? 3 : 4 * SIDE + (k == 2 ? 4 : 0)));
        wr_hard_holds(g, WR_HARD_DOUBLE, report->collapsed == (k == 3 ? 1 : 0));
        wr_triangles_free(made);
        wr_free(points);
    }
    return good;
}

static const WrHardCase rows_patches[] = {
    { .id = "HC151",
      .subject = WR_HARD_GEOMETRY,
      .what = "patches whose neighbours are turned by quarters, and mirrored",
      .holds = "F has the same bits on both sides of a common edge, and its gradient is the same",
      .unit = "of the slope",
      .bound = { NAN, 1e-6 },
      .measure = hc151 },
    { .id = "HC152",
      .subject = WR_HARD_GEOMETRY,
      .what = "a control point that slipped, a hole, an edge that is a point",
      .holds = "crease, loops and collapsed edge are reported",
      .unit = "violations",
      .bound = { NAN, 0 },
      .measure = hc152 },
};
WR_HARD_LIST(patches, rows_patches);

/* ---- Hard cases of objects in a scene: stretched, mirrored, flat, far away ---- */

#define SIDE_STRETCH 48 /* pixels */
#define VIEW 2.4
#define WHOLE 0.9 /* of the distance to the outline, squared: the tested area */

/* An ellipsoid of those sizes, seen along its z axis. */
static WrScene *ball_of(WrVec3 sizes)
{
    WrScene *scene = wr_scene_new();
    WrShape shape;
    wr_shape_default(WR_SURFACE_sphere, &shape);
    shape.value[0] = 1;
    wr_scene_set_shape(scene, &shape);
    scene->sizes = sizes;
    scene->size = fmax(fabs(sizes.x), fmax(fabs(sizes.y), fabs(sizes.z)));
    scene->posed = true;
    scene->height = 0;
    scene->camera = (WrCamera){
        .orthographic = true, .eye = { 0, 0, 1000 }, .up = { 0, 1, 0 }, .fov_deg = 35, .size = VIEW
    };
    return scene;
}

static double half_axis(double size, double largest)
{
    return fmax(fabs(size), WR_THINNEST * largest);
}

/* n of the ellipsoid x^2/a^2 + y^2/b^2 + z^2/c^2 = 1 at a pixel's centre, facing the viewer; false near its
   outline. */
static bool ellipsoid(const WrScene *scene, int i, WrVec3 *n)
{
    const double a = half_axis(scene->sizes.x, scene->size);
    const double b = half_axis(scene->sizes.y, scene->size);
    const double c = half_axis(scene->sizes.z, scene->size);
    const double x = ((i % SIDE_STRETCH + 0.5) / SIDE_STRETCH - 0.5) * VIEW / a;
    const double y = (0.5 - (i / SIDE_STRETCH + 0.5) / SIDE_STRETCH) * VIEW / b,
                 left = 1 - x * x - y * y;
    if (left < 1 - WHOLE) return false;
    *n = v3_unit((WrVec3){ x / a, y / b, sqrt(left) / c }, (WrVec3){ 0, 0, 1 });
    return true;
}

static void look(WrHardMeasurement *g, WrHardPrecision precision, const WrScene *scene,
                 const float *normals, double bound)
{
    for (int i = 0; i < SIDE_STRETCH * SIDE_STRETCH; i++) {
        const WrVec3 got = { normals[3 * i], normals[3 * i + 1], normals[3 * i + 2] };
        WrVec3 want;
        if (ellipsoid(scene, i, &want))
            wr_hard_holds(g, precision, v3_len(got) > 0.5 && v3_angle_rad(got, want) < bound);
    }
}

/* In every arithmetic, and by the reference. */
static bool try_ball(WrHardMeasurement *g, WrVec3 sizes, WrError *err)
{
    WrScene *scene = ball_of(sizes);
    WrField *field = wr_hard_waves(16, 16);
    float normals[3 * SIDE_STRETCH * SIDE_STRETCH];
    const WrFrameRequest request = { .field = field,
                                     .scene = scene,
                                     .width = SIDE_STRETCH,
                                     .height = SIDE_STRETCH,
                                     .normals = normals };
    bool good = true;
    for (int way = 0; way < WR_HARD_WAYS && good; way++) {
        WrHardShot shot;
        const WrHardPrecision precision = way == WR_HARD_WIDE ? WR_HARD_DOUBLE : WR_HARD_FLOAT;
        memset(normals, 0, sizeof normals);
        good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &shot, err);
        if (!good) break;
        look(g, precision, scene, normals, 2e-3);
        wr_hard_holds(g, precision, wr_hard_wild(&shot) == 0);
        wr_hard_put_away(&shot);
    }
    WrReference reference = { 0 };
    good = good && wr_hard_refer(g, &request, 1, &reference, err);
    for (int i = 0; i < 3 * SIDE_STRETCH * SIDE_STRETCH && good; i++)
        normals[i] = (float)reference.normal[i];
    if (good) look(g, WR_HARD_DOUBLE, scene, normals, 1e-5);
    wr_reference_fini(&reference);
    wr_field_free(field);
    wr_scene_free(scene);
    return good;
}

static bool try_balls(WrHardMeasurement *g, const WrVec3 *sizes, int count, WrError *err)
{
    bool good = true;
    for (int i = 0; i < count && good; i++) good = try_ball(g, sizes[i], err);
    return good;
}

bool wr_hard_hc33(WrHardMeasurement *g, WrError *err)
{
    static const WrVec3 sizes[] = { { 1, 1, 100 }, { 100, 1, 1 }, { 0.8, 0.008, 0.8 } };
    return try_balls(g, sizes, 3, err);
}

bool wr_hard_hc34(WrHardMeasurement *g, WrError *err)
{
    static const WrVec3 sizes[] = { { -1, 1, 1 }, { 0.7, -1, 0.9 }, { 1, 1, -1 }, { -1, -1, -1 } };
    return try_balls(g, sizes, 4, err);
}

bool wr_hard_hc153(WrHardMeasurement *g, WrError *err)
{
    static const WrVec3 sizes[] = { { 1, 1, -100 }, { 1, 1, 0 }, { 1, 1, -0.0 },
                                    { 0, 1, 1 },    { 0, 1, 0 }, { -1, 0, -0.5 } };
    return try_balls(g, sizes, 6, err);
}

/* ---- far away ---- */

/* A sphere and a box, 1 apart, and the eye, all moved by `far`. */
static WrScene *pair_at(double far)
{
    WrScene *first = ball_of((WrVec3){ 0 });
    first->size = 0.4;
    first->at = (WrVec3){ far - 0.5, far, 0 };
    WrScene *scene = wr_scene_add_object(first, false);
    WrShape shape;
    wr_scene_free(first);
    wr_shape_default(WR_SURFACE_cube, &shape);
    wr_scene_set_shape(scene, &shape);
    scene->size = 0.5;
    scene->at = (WrVec3){ far + 0.5, far, 0 };
    scene->height = 0;
    scene->camera = (WrCamera){ .eye = { far + 0.7, far + 0.9, 4 },
                                .target = { far, far, 0 },
                                .up = { 0, 1, 0 },
                                .fov_deg = 35 };
    return scene;
}

bool wr_hard_hc154(WrHardMeasurement *g, WrError *err)
{
    enum { WIDE = 200 }; /* the outlines are about 500 pixels: moved by 2^-8 of one, 2 change */
    WrField *field = wr_hard_waves(16, 16);
    WrScene *near = pair_at(0), *far = pair_at(1e7);
    bool good = true;
    for (int way = 0; way < WR_HARD_WAYS && good; way++) {
        WrHardShot a, b;
        const WrHardPrecision precision = way == WR_HARD_WIDE ? WR_HARD_DOUBLE : WR_HARD_FLOAT;
        WrFrameRequest request = { .field = field, .scene = near, .width = WIDE, .height = WIDE };
        good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &a, err);
        if (!good) break;
        request.scene = far;
        good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &b, err);
        if (good) {
            int object = -1, face;
            double u, v;
            wr_hard_holds(g, precision, wr_hard_differ(&a, &b, 0.01) <= 16);
            wr_hard_holds(g, precision,
                          wr_renderer_pick_object(b.renderer, 60, 110, &object, &u, &v, &face) &&
                              object == 0);
            wr_hard_put_away(&b);
        }
        wr_hard_put_away(&a);
    }
    wr_field_free(field);
    wr_scene_free(near);
    wr_scene_free(far);
    return good;
}

static const WrHardCase rows_stretch[] = {
    { .id = "HC153",
      .subject = WR_HARD_GEOMETRY,
      .what = "an object mirrored and stretched a hundredfold, or flat",
      .holds = "n stays on its side: by the cofactors, with the determinant's sign, + at 0",
      .unit = "violations",
      .bound = { 0, 0 },
      .measure = wr_hard_hc153,
      .scene = "table 64x64\nformula fourier terms=3,0,0.5;0,5,0.25,90,0\nsurface sphere R=0.7\n"
               "bump height=0.03\nobject set size=1,0.6,0" },
    { .id = "HC154",
      .subject = WR_HARD_RENDER,
      .what = "two objects 1 apart, ten million from the middle",
      .holds = "they are drawn and picked as at the origin",
      .unit = "violations",
      .bound = { 0, 0 },
      .measure = wr_hard_hc154,
      .scene = "table 16x16\nsurface sphere R=0.4\nobject set at=9999999.5,1e7,0\n"
               "object add box at=10000000.5,1e7,0 size=0.5\nsurface cube\n"
               "camera perspective eye=10000001,10000001,4 target=1e7,1e7,0" },
};
WR_HARD_LIST(stretch, rows_stretch);

/* ---- hardcases mesh ---- */

/* Hard cases of tangent frames: triangles with texture coordinates, sheared tangents, scaled objects. */

/* n - grad F, grad F = [(G Fu - F1 Fv) Pu + (E Fv - F1 Fu) Pv] / (E G - F1^2): independent of the frame's angle. */
static WrVec3 by_gradient(const WrSurfacePoint *at, double fu, double fv)
{
    const double e = v3_dot(at->pu, at->pu), g = v3_dot(at->pv, at->pv);
    const double f1 = v3_dot(at->pu, at->pv), det = e * g - f1 * f1;
    const WrVec3 slope = v3_add(v3_scale(at->pu, (g * fu - f1 * fv) / det),
                                v3_scale(at->pv, (e * fv - f1 * fu) / det));
    const WrVec3 n = v3_unit(v3_cross(at->pu, at->pv), at->n_unit);
    return v3_sub(n, slope);
}

static bool hc32(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const double degrees[] = { 90, 80, 60, 45, 20 };
    for (int i = 0; i < 200; i++) {
        const double turn = degrees[i % 5] * (acos(-1.0) / 180.0);
        const double fu = wr_hard_between(g, -1, 1), fv = wr_hard_between(g, -1, 1);
        WrSurfacePoint at = { .pu = { 1, 0, 0 },
                              .pv = { cos(turn), sin(turn), 0 },
                              .n_unit = { 0, 0, 1 } };
        at.n = v3_cross(at.pu, at.pv);
        at.n_len = v3_len(at.n);
        const WrVec3 want = by_gradient(&at, fu, fv);
        const WrSurfacePointf single = wr_hard_narrow(&at);
        const WrHardSlope slope = { 0, fu, fv };
        wr_hard_record_error(g, WR_HARD_DOUBLE,
                             v3_angle_rad(wr_hard_bumped_normal(WR_BUMP_BLINN, &at, slope), want));
        for (int set = 0; set < g->sets; set++)
            wr_hard_record_error(
                g, WR_HARD_FLOAT,
                v3_angle_rad(wr_hard_bumped_normal_f(g, set, WR_BUMP_BLINN, &single, slope, false),
                             want));
    }
    return true;
}

/* Only in double if the checks concern frames and a mesh's report, which are not computed in float. */
#define FRAME(number, situation, rule)                                                             \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_GEOMETRY, .what = situation, .holds = rule,         \
        .unit = "violations", .bound = { NAN, 0 }, .measure = wr_hard_hc##number                   \
    }
#define MESH(number, situation, rule)                                                              \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_GEOMETRY, .what = situation, .holds = rule,         \
        .unit = "violations", .bound = { 0, 0 }, .measure = wr_hard_hc##number                     \
    }
static const WrHardCase rows_mesh[] = {
    MESH(28, "a triangle whose texture coordinates span no area",
         "an orthonormal frame from n alone, and it is reported"),
    MESH(29, "a triangle without area", "it is skipped"),
    MESH(30, "texture coordinates that span 1e-30, of either sign",
         "tangents of length 1 or the frame from n; handedness follows the sign"),
    FRAME(31, "a vertex shared by mirrored texture coordinates",
          "its frame is split by handedness; no NaN"),
    { .id = "HC32",
      .subject = WR_HARD_GEOMETRY,
      .what = "tangents at 20 to 90 degrees",
      .holds = "n' is that of the surface gradient, which needs no frame",
      .unit = "rad",
      .bound = { 1e-6, 1e-14 },
      .measure = hc32,
      .scene = "table 64x64\nformula fourier terms=3,0,0.5;0,5,0.25,90,0\nsurface bent c=1,0.5,0\n"
               "bump height=0.03" },
    MESH(33, "an object stretched a hundredfold along one axis",
         "normals go by the inverse transpose and stay upright on tangents"),
    MESH(34, "an object mirrored along its axes", "n still points outward"),
};
WR_HARD_LIST(mesh, rows_mesh);

static const WrHardCase later[] = {
    MESH(126, "texture coordinates whose area is rounding, of either sign",
         "no frame, which is reported; n' is computed from the gradient"),
    MESH(127, "texture coordinates along a line, and a table that changes along it",
         "n' is n less Fu grad u"),
    MESH(128, "two triangles that mirror each other at an edge", "bumps are up on both"),
    FRAME(129, "texture coordinates one unit of the last place apart at a shared corner",
          "two corners with two frames, which is reported"),
    FRAME(130, "two triangles folded onto each other, tangents opposite",
          "each keeps its own unit tangents; no NaN"),
    FRAME(131, "a triangle whose corners coincide, next to a good one",
          "it copies its neighbour's frame; alone it has (1,0,0)"),
    FRAME(132, "five triangles at one edge", "the frames' groups end, every frame is one"),
    { .id = "HC133",
      .subject = WR_HARD_GEOMETRY,
      .what = "needles ten million times as long as wide",
      .holds = "n is the cross product, to rounding",
      .unit = "rad",
      .bound = { 1e-6, 1e-14 },
      .measure = wr_hard_hc133 },
    MESH(134, "a million rays through the vertex of a fan", "none misses it"),
    MESH(135, "edges that triangles share, at a thousand turns", "each sample is of one of them"),
    FRAME(136, "normals of 0 and of no number at vertices",
          "the mean of the faces about it, or the face's own; counted"),
};
WR_HARD_LIST(fans, later);

/* ---- Hard cases of meshes: shared corners, folds, tangles, needles, fans ---- */

/* A corner whose (u,v) are x and y. */
static void take(double x, double y, double z, double nx, double ny, double nz,
                 WrTriangleCorner *to)
{
    *to = (WrTriangleCorner){
        { (float)x, (float)y, (float)z }, { (float)nx, (float)ny, (float)nz }, (float)x, (float)y
    };
}

/* ---- tangent frames ---- */

/* The square's diagonal, whose (u,v) differ by one ulp on its two sides: two corners and two frames, as the mesh
   reports; with equal (u,v) they are one. */
bool wr_hard_hc129(WrHardMeasurement *g, WrError *err)
{
    for (int apart = 0; apart <= 2; apart++) {
        WrHardMesh mesh = { .face = { { 0, 1, 2 }, { 4, 2, 3 } }, .corners = 5, .faces = 2 };
        for (int i = 0; i < 5; i++)
            take(i % 4 == 1 || i == 2, i == 2 || i == 3, 0, 0, 0, 1, &mesh.corner[i]);
        mesh.corner[3].v = 0.5f;
        for (int k = 0; k < 5; k++) mesh.corner[k].u += 1, mesh.corner[k].v += 1;
        for (int k = 0; k < apart; k++) mesh.corner[4].u = nextafterf(mesh.corner[4].u, 9);
        WrTangent frames[3 * WR_HARD_FACES];
        if (!wr_hard_mikk_frames(&mesh, frames, err)) return false;
        wr_hard_units(g, &mesh, frames);
        const double turned = v3_angle_rad(frames[0].t, frames[3].t);
        wr_hard_holds(g, WR_HARD_DOUBLE, apart ? turned > 0.5 : turned == 0);
        WrTriangles *made = wr_hard_mesh_triangles_new(&mesh, err);
        if (!made) return false;
        wr_hard_holds(g, WR_HARD_DOUBLE, made->report.near_uv == (apart > 0));
        wr_hard_holds(g, WR_HARD_DOUBLE, made->corner_count == 4 + (apart > 0));
        wr_triangles_free(made);
        if (!wr_hard_check_mesh_finite(g, &mesh, err)) return false;
    }
    return true;
}

/* Two triangles folded onto each other, with opposite tangents and equal handedness: their sum is 0. */
bool wr_hard_hc130(WrHardMeasurement *g, WrError *err)
{
    WrHardMesh fold = { .face = { { 0, 1, 2 }, { 1, 0, 3 } }, .corners = 4, .faces = 2 };
    static const double x[4] = { 0, 0, -1, -1 }, y[4] = { 0, 1, 0, 0 };
    for (int i = 0; i < 4; i++) take(x[i], y[i], 0, 0, 0, 1, &fold.corner[i]);
    fold.corner[3].u = 1;
    WrTangent frames[3 * WR_HARD_FACES];
    if (!wr_hard_mikk_frames(&fold, frames, err)) return false;
    wr_hard_units(g, &fold, frames);
    wr_hard_holds(g, WR_HARD_DOUBLE, frames[2].t.x == 1 && frames[2].sign == 1);
    wr_hard_holds(g, WR_HARD_DOUBLE, frames[5].t.x == -1 && frames[5].sign == 1);
    return wr_hard_check_mesh_finite(g, &fold, err);
}

/* A triangle with two coincident corners copies the frame of its neighbour's corners; a single degenerate one
   has (1,0,0). */
bool wr_hard_hc131(WrHardMeasurement *g, WrError *err)
{
    WrHardMesh mesh = { .face = { { 0, 1, 2 }, { 0, 0, 1 }, { 3, 3, 3 } },
                        .corners = 4,
                        .faces = 3 };
    static const double x[4] = { 0, 1, 0, 0.5 }, y[4] = { 0, 0, 1, 0.9 };
    for (int i = 0; i < 4; i++) {
        take(x[i], y[i], 0, 0, 0, 1, &mesh.corner[i]);
        mesh.corner[i].u = (float)-y[i], mesh.corner[i].v = (float)x[i];
    }
    WrTangent frames[3 * WR_HARD_FACES];
    if (!wr_hard_mikk_frames(&mesh, frames, err)) return false;
    wr_hard_units(g, &mesh, frames);
    for (int k = 0; k < 3; k++) {
        const WrTangent *from = &frames[k / 2]; /* corners 0, 0 and 1 of the first triangle */
        wr_hard_holds(g, WR_HARD_DOUBLE, memcmp(&frames[3 + k], from, sizeof *from) == 0);
        wr_hard_holds(g, WR_HARD_DOUBLE, frames[6 + k].t.x == 1);
    }
    return wr_hard_check_mesh_finite(g, &mesh, err);
}

/* Three and more triangles at one edge, with corners chosen at random from few: grouping terminates, and frames
   are valid. */
bool wr_hard_hc132(WrHardMeasurement *g, WrError *err)
{
    for (int round = 0; round < 400; round++) {
        WrHardMesh mesh = { .corners = WR_HARD_CORNERS, .faces = WR_HARD_FACES };
        WrTriangle faces[WR_HARD_FACES];
        for (int i = 0; i < WR_HARD_CORNERS; i++) {
            WrTriangleCorner *c = &mesh.corner[i];
            const WrVec3 n =
                v3_unit((WrVec3){ wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1), 0.3 },
                        (WrVec3){ 0, 0, 1 });
            take(floor(wr_hard_between(g, -1, 2)), floor(wr_hard_between(g, -1, 2)),
                 floor(wr_hard_between(g, 0, 2)), n.x, n.y, n.z, c);
            c->u = (float)floor(wr_hard_between(g, 0, 3)) / 2;
            c->v = (float)floor(wr_hard_between(g, 0, 3)) / 2;
        }
        for (int i = 0; i < WR_HARD_FACES; i++)
            for (int k = 0; k < 3; k++)
                mesh.face[i][k] = k < 2 && i < 5 ? (k + i) % 2 /* five at one edge */
                                                 : (int32_t)wr_hard_between(g, 0, WR_HARD_CORNERS);
        memcpy(faces, mesh.face, sizeof faces);
        WrTangent frames[3 * WR_HARD_FACES], mean[3 * WR_HARD_FACES];
        if (!wr_hard_mikk_frames(&mesh, frames, err) ||
            !wr_tangents_average(mesh.corner, faces, mesh.faces, mean, err))
            return false;
        wr_hard_units(g, &mesh, frames);
        for (int i = 0; i < 3 * WR_HARD_FACES; i++)
            wr_hard_holds(g, WR_HARD_DOUBLE, isfinite(v3_len(mean[i].t) + v3_len(mean[i].b)));
        WrTriangles *made = wr_hard_mesh_triangles_new(&mesh, NULL); /* all may have no area */
        wr_triangles_free(made);
        if (made && round < 6 && !wr_hard_check_mesh_finite(g, &mesh, err)) return false;
    }
    return true;
}

/* ---- normals ---- */

/* Normals of needles that are a ten-millionth as wide as long, compared with the cross product at their corner
   without rounding: in float the corners' own, in double the gradient's. */
bool wr_hard_hc133(WrHardMeasurement *g, WrError *err)
{
    for (int round = 0; round < 300; round++) {
        WrHardMesh mesh = { .face = { { 0, 1, 2 } }, .corners = 3, .faces = 1 };
        const WrVec3 along = v3_unit((WrVec3){ wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1),
                                               wr_hard_between(g, 0.1, 1) },
                                     (WrVec3){ 0, 0, 1 });
        /* the short edge's floats begin at 0, so that it has full precision */
        const WrVec3 wide = { wr_hard_between(g, 1e-8, 1e-7), wr_hard_between(g, -1e-7, -1e-8),
                              wr_hard_between(g, -1e-7, 1e-7) };
        take(0, 0, 0, 0, 0, 0, &mesh.corner[0]);
        take(along.x, along.y, along.z, 0, 0, 0, &mesh.corner[1 + round % 2]);
        take(wide.x, wide.y, wide.z, 0, 0, 0, &mesh.corner[2 - round % 2]);
        WrVec3 p[3];
        long double e[2][3], n[3];
        const double uv[3][2] = { { 0, 0 }, { 1, 0 }, { 0, 1 } };
        for (int k = 0; k < 3; k++)
            p[k] = (WrVec3){ (double)mesh.corner[k].p[0], (double)mesh.corner[k].p[1],
                             (double)mesh.corner[k].p[2] };
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 2; i++) /* exact, as are the products */
                e[i][k] = (long double)mesh.corner[i + 1].p[k] - (long double)mesh.corner[0].p[k];
        for (int k = 0; k < 3; k++) {
            const int a = (k + 1) % 3, b = (k + 2) % 3;
            n[k] = e[0][a] * e[1][b] - e[0][b] * e[1][a];
        }
        const WrVec3 want =
            v3_unit((WrVec3){ (double)n[0], (double)n[1], (double)n[2] }, (WrVec3){ 0, 0, 0 });
        WrVec3 normal, gu, gv;
        const bool good = wr_triangle_gradients(p, uv, &normal, &gu, &gv);
        wr_hard_record_error(g, WR_HARD_DOUBLE, good ? v3_angle_rad(normal, want) : INFINITY);
        WrTriangles *made = wr_hard_mesh_triangles_new(&mesh, err);
        if (!made) return false;
        const float *got = made->corners[0].n;
        wr_hard_record_error(
            g, WR_HARD_FLOAT,
            v3_angle_rad((WrVec3){ (double)got[0], (double)got[1], (double)got[2] }, want));
        wr_triangles_free(made);
    }
    return true;
}

/* A zero or NaN normal is replaced by the mean of its faces', or by its face's if those are opposite. */
bool wr_hard_hc136(WrHardMeasurement *g, WrError *err)
{
    static const double bad[4] = { 0, (double)NAN, (double)INFINITY, -0.0 };
    for (int k = 0; k < 8; k++) {
        WrHardMesh mesh = { .face = { { 0, 1, 2 }, { 0, 2, 3 } }, .corners = 4, .faces = 2 };
        static const double x[4] = { -1, 1, 1, -1 }, y[4] = { -1, -1, 1, 1 };
        for (int i = 0; i < 4; i++) take(x[i], y[i], 0.25, 0, 0, 3, &mesh.corner[i]);
        mesh.corner[2].n[k % 3] = (float)bad[k % 4];
        if (bad[k % 4] == 0) memset(mesh.corner[2].n, 0, sizeof mesh.corner[2].n);
        const bool opposite = k >= 4;
        if (opposite) mesh.face[1][0] = 0, mesh.face[1][1] = 2, mesh.face[1][2] = 1;
        WrTriangles *made = wr_hard_mesh_triangles_new(&mesh, err);
        if (!made) return false;
        wr_hard_holds(g, WR_HARD_DOUBLE, made->report.bad_normal == 1);
        wr_hard_holds(g, WR_HARD_DOUBLE, made->report.face_normal == (opposite ? 2 : 0));
        for (int i = 0; i < made->corner_count; i++) {
            const float *n = made->corners[i].n;
            wr_hard_holds(g, WR_HARD_DOUBLE, n[0] == 0 && n[1] == 0 && fabsf(n[2]) == 1);
        }
        wr_triangles_free(made);
        if (!wr_hard_check_mesh_finite(g, &mesh, err)) return false;
    }
    return true;
}

/* ---- shared vertices and edges ---- */

/* A fan of `count` triangles around (x, y, 0), from number `from`, every `step`-th. */
static WrTriangles *fan(int count, int from, int step, double x, double y, WrError *err)
{
    float(*points)[3] = wr_alloc((size_t)count + 1, sizeof *points);
    int32_t(*corners)[3] = wr_alloc((size_t)count, sizeof *corners);
    int32_t made = 0;
    points[0][0] = (float)x, points[0][1] = (float)y;
    for (int i = 0; i < count; i++) {
        const double turn = 2 * acos(-1.0) * i / count;
        points[i + 1][0] = (float)(2 * cos(turn));
        points[i + 1][1] = (float)(2 * sin(turn));
        if (i % step != from) continue;
        corners[made][1] = i + 1;
        corners[made++][2] = (i + 1) % count + 1;
    }
    const WrTrianglesSource source = { .points = (const float(*)[3])points,
                                       .corners = (const int32_t(*)[3])corners,
                                       .point_count = count + 1,
                                       .triangle_count = made };
    WrTriangles *out = wr_triangles_new(&source, err);
    wr_free(points);
    wr_free(corners);
    return out;
}

/* Rays exactly through the centre vertex of a fan: in double by the reference's tree, in float by pictures with
   a sample at it (pictures of an odd size have one). */
bool wr_hard_hc134(WrHardMeasurement *g, WrError *err)
{
    enum { RAYS = 1000000, FANS = 10 };
    WrField *field = wr_hard_waves(8, 8);
    bool good = true;
    for (int k = 0; k < FANS && good; k++) {
        const float x = (float)wr_hard_between(g, -0.5, 0.5),
                    y = (float)wr_hard_between(g, -0.5, 0.5);
        WrTriangles *triangles = fan(3 + 5 * k, 0, 1, (double)x, (double)y, err);
        WrReferenceMesh mesh = { 0 };
        if (!triangles || !wr_reference_mesh_init(&mesh, wr_triangles_share(triangles), err)) {
            wr_triangles_free(triangles);
            good = false;
            break;
        }
        int lost = 0;
        for (int i = 0; i < RAYS / FANS; i++) {
            const WrVec3 eye = { wr_hard_between(g, -3, 3), wr_hard_between(g, -3, 3),
                                 wr_hard_between(g, 1, 4) };
            const WrReferenceRay ray = { .q = eye,
                                         .d = v3_sub((WrVec3){ (double)x, (double)y, 0 }, eye) };
            WrReferenceHit hit = { .s = INFINITY };
            lost += !wr_reference_mesh_hit(&mesh, false, &ray, &hit);
        }
        wr_hard_record_error(g, WR_HARD_DOUBLE, lost);
        wr_reference_mesh_fini(&mesh);
        WrScene *scene = wr_hard_above(triangles, 0);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = 33, .height = 33
        };
        scene->camera.eye = (WrVec3){ (double)x, (double)y, 5 };
        scene->camera.target = (WrVec3){ (double)x, (double)y, 0 };
        scene->camera.size = 0.5;
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrHardShot shot = { .renderer = NULL };
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &shot, err);
            for (int i = 0; i < 33 * 33 && good; i++)
                wr_hard_holds(g, WR_HARD_FLOAT, shot.frame.rgba[4 * i + 3] == 1);
            wr_hard_put_away(&shot);
        }
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* Two fans with alternating triangles: at every angle each sample belongs to exactly one of them. */
bool wr_hard_hc135(WrHardMeasurement *g, WrError *err)
{
    enum { TURNS = 1000, ACROSS = 24 };
    WrField *field = wr_hard_waves(8, 8);
    bool good = true;
    for (int k = 0; k < TURNS && good; k++) {
        const int count = 4 + 2 * (k % 9);
        unsigned char owners[ACROSS * ACROSS] = { 0 };
        for (int half = 0; half < 2 && good; half++) {
            WrTriangles *triangles = fan(count, half, 2, 0, 0, err);
            if (!triangles) {
                good = false;
                break;
            }
            WrScene *scene = wr_hard_above(triangles, 0);
            scene->rotate_deg = (WrVec3){ 0, 0, k % 8 == 0 ? 90.0 * (k / 8) : 2.628 * k };
            scene->camera.size = 1;
            const WrFrameRequest request = {
                .field = field, .scene = scene, .width = ACROSS, .height = ACROSS
            };
            WrHardShot shot = { .renderer = NULL };
            const WrHardWay way = k % 4 ? WR_HARD_EXACT : WR_HARD_WIDE;
            good = wr_hard_shoot_by(g, &request, way, &shot, err);
            for (int i = 0; i < ACROSS * ACROSS && good; i++)
                owners[i] += (unsigned char)(shot.frame.rgba[4 * i + 3] == 1);
            wr_hard_put_away(&shot);
            wr_scene_free(scene);
        }
        for (int i = 0; i < ACROSS * ACROSS && good; i++)
            wr_hard_holds(g, k % 4 ? WR_HARD_FLOAT : WR_HARD_DOUBLE, owners[i] == 1);
    }
    wr_field_free(field);
    return good;
}

static const WrVec3 zero = { 0, 0, 0 };

/* The angle between n in float and the expected one, for each kernel set. */
static void angle_f(WrHardMeasurement *g, const WrShape *shape, float u, float v, WrVec3 want)
{
    for (int k = 0; k < g->sets; k++) {
        WrSurfacePointf at = wr_hard_point(g, k, shape, 1.0, 0, u, v);
        wr_hard_record_error(g, WR_HARD_FLOAT, v3_angle_rad(wr_hard_vec(at.n_unit), want));
    }
}

static void angle_d(WrHardMeasurement *g, const WrShape *shape, double u, double v, WrVec3 want)
{
    WrSurfacePoint at;
    wr_surface_at(shape, 0, u, v, &at);
    wr_hard_record_error(g, WR_HARD_DOUBLE, v3_angle_rad(at.n_unit, want));
}

static bool hc01(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    const WrShape sphere = wr_hard_shape(WR_SURFACE_sphere);
    for (int i = 0; i <= 32; i++)
        for (int pole = 0; pole < 2; pole++) {
            const WrVec3 want = { 0, 0, pole ? 1 : -1 };
            angle_f(g, &sphere, (float)i / 32, (float)pole, want);
            angle_d(g, &sphere, i / 32.0, pole, want);
        }
    return true;
}

/* F = 0.1 x / R has one value at the pole; its surface gradient at n is 0.1 (e_x - n_x n), R = 1. */
static bool hc02(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    const WrShape sphere = wr_hard_shape(WR_SURFACE_sphere);
    for (int k = 1; k <= 52; k++)
        for (int i = 0; i < 8; i++) {
            const double u = i / 8.0, v = 1.0 - ldexp(1.0, -k);
            double s, c, sl, cl;
            WrSurfacePoint at;
            wr_sincos_turns(u, &s, &c);
            wr_sincos_turns(0.5 * v - 0.25, &sl, &cl);
            wr_surface_at(&sphere, 0, u, v, &at);
            const WrHardSlope slope = { 0.1 * c * cl, -0.2 * WR_PI * s * cl,
                                        -0.1 * WR_PI * c * sl };
            const WrVec3 n = { c * cl, s * cl, sl };
            const WrVec3 ideal =
                v3_unit(v3_sub(n, v3_sub((WrVec3){ 0.1, 0, 0 }, v3_scale(n, 0.1 * n.x))), zero);
            wr_hard_record_error(
                g, WR_HARD_DOUBLE,
                v3_angle_rad(wr_hard_bumped_normal(WR_BUMP_BLINN, &at, slope), ideal));
            for (int set = 0; set < g->sets && k <= 24; set++) {
                WrSurfacePointf atf = wr_hard_point(g, set, &sphere, 1.0, 0, (float)u, (float)v);
                WrVec3 perturbed =
                    wr_hard_bumped_normal_f(g, set, WR_BUMP_BLINN, &atf, slope, false);
                wr_hard_record_error(g, WR_HARD_FLOAT, v3_angle_rad(perturbed, ideal));
            }
        }
    return true;
}

static bool hc03(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    const WrShape sphere = wr_hard_shape(WR_SURFACE_sphere);
    for (int k = 1; k <= 53; k++)
        for (int mode = 0; mode < WR_BUMP_COUNT; mode++) {
            const double v = k == 53 ? 1.0 : 1.0 - ldexp(1.0, -k);
            const float u = wr_hard_float(g);
            const WrHardSlope slope = { wr_hard_between(g, -1, 1), wr_hard_between(g, -40, 40),
                                        wr_hard_between(g, -40, 40) };
            WrSurfacePoint at;
            wr_surface_at(&sphere, 0, (double)u, v, &at);
            WrVec3 perturbed = wr_hard_bumped_normal((WrBumpMode)mode, &at, slope);
            wr_hard_record_error(g, WR_HARD_DOUBLE, fabs(v3_len(perturbed) - 1.0));
            for (int set = 0; set < g->sets; set++) {
                WrSurfacePointf atf = wr_hard_point(g, set, &sphere, 1.0, 0, u, (float)v);
                perturbed = wr_hard_bumped_normal_f(g, set, (WrBumpMode)mode, &atf, slope, false);
                wr_hard_record_error(g, WR_HARD_FLOAT, fabs(v3_len(perturbed) - 1.0));
            }
        }
    return true;
}

static bool hc04(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    const WrShape cone = wr_hard_shape(WR_SURFACE_cone);
    const double R = cone.value[0], H = cone.value[1], side = sqrt(R * R + H * H);
    for (int i = 0; i < 64; i++) {
        const float u = (float)i / 64;
        double s, c;
        wr_sincos_turns((double)u, &s, &c);
        const WrVec3 want = { H * c / side, H * s / side, R / side };
        angle_f(g, &cone, u, 1.0f, want);
        angle_d(g, &cone, (double)u, 1.0, want);
    }
    return true;
}

/* ---- Bezier patches ---- */

/* A dish over a quarter of a disc: one index goes round, the other away from the centre, which is one point. */
static WrVec3 dish_low(int i, int j)
{
    static const double round[4][2] = { { 1, 0 }, { 1, 0.5 }, { 0.5, 1 }, { 0, 1 } };
    static const double away[4] = { 0, 0.375, 0.75, 1 }, high[4] = { 0.5, 0.375, 0.125, 0 };
    return (WrVec3){ round[i][0] * away[j], round[i][1] * away[j], high[j] };
}
static WrVec3 dish_high(int i, int j)
{
    return dish_low(i, 3 - j);
}

static bool hc05(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    const WrShape dishes[2] = { wr_hard_bicubic_patch(dish_low), wr_hard_bicubic_patch(dish_high) };
    for (int edge = 0; edge < 2; edge++)
        for (int i = 0; i <= 32; i++) {
            const double u = i / 32.0, sign = edge ? -1.0 : 1.0;
            WrSurfacePoint at;
            wr_surface_at(&dishes[edge], 0, u, edge, &at);
            const WrVec3 rule = v3_unit(v3_scale(v3_cross(at.puv, at.pv), sign), zero);
            angle_d(g, &dishes[edge], u, edge, rule);
            angle_f(g, &dishes[edge], (float)u, (float)edge, rule);
            /* and one ulp beside the edge the normal is nearly the same */
            angle_d(g, &dishes[edge], u, edge ? 1.0 - 0x1p-53 : 1e-300, rule);
            angle_f(g, &dishes[edge], (float)u, edge ? 1.0f - 0x1p-24f : 1e-30f, rule);
        }
    return true;
}

static WrVec3 same_point(int i, int j)
{
    (void)i, (void)j;
    return (WrVec3){ 0.125, 0.75, -0.25 };
}
static WrVec3 line_point(int i, int j)
{
    return v3_scale((WrVec3){ 0.25, -0.125, 0.75 }, i * 0.3125 + j * 0.1875 + 0.0625 * i * j);
}

/* No normal exists: the result is the defined one everywhere, bumps keep its length 1, and a picture of the
   patch contains no NaN. */
static bool degenerate(WrHardMeasurement *g, const WrShape *shape, WrError *err)
{
    const WrHardSlope slope = { 0.3, 2, -1 };
    for (int k = 0; k < 81; k++) {
        const double u = k % 9 / 8.0, v = k / 9 / 8.0;
        WrSurfacePoint at;
        wr_surface_at(shape, 0, u, v, &at);
        wr_hard_holds(g, WR_HARD_DOUBLE, wr_hard_same(at.n_unit, (WrVec3){ 0, 0, 1 }));
        for (int mode = 0; mode < WR_BUMP_COUNT; mode++) {
            WrVec3 perturbed = wr_hard_bumped_normal((WrBumpMode)mode, &at, slope);
            wr_hard_holds(g, WR_HARD_DOUBLE, fabs(v3_len(perturbed) - 1.0) < 1e-14);
            for (int set = 0; set < g->sets; set++) {
                WrSurfacePointf atf = wr_hard_point(g, set, shape, 1.0, 0, (float)u, (float)v);
                perturbed = wr_hard_bumped_normal_f(g, set, (WrBumpMode)mode, &atf, slope, false);
                wr_hard_holds(g, WR_HARD_FLOAT, fabs(v3_len(perturbed) - 1.0) < 1e-6);
            }
        }
    }
    WrScene *scene = wr_scene_new();
    WrField *field = wr_hard_waves(32, 32);
    WrFrameRequest request = { .field = field, .scene = scene, .width = 40, .height = 40 };
    WrHardShot shot;
    scene->shape = *shape;
    const bool good = wr_hard_shoot(g, &request, &shot, err);
    if (good) {
        wr_hard_holds(g, WR_HARD_FLOAT, wr_hard_wild(&shot) == 0);
        wr_hard_put_away(&shot);
    }
    wr_field_free(field);
    wr_scene_free(scene);
    return good;
}

static bool hc06(WrHardMeasurement *g, WrError *err)
{
    const WrShape shape = wr_hard_bicubic_patch(same_point);
    return degenerate(g, &shape, err);
}

/* Points on a line of any direction, with rounded coordinates: Pu x Pv is rounding error. */
static WrShape line_shape(WrHardMeasurement *g)
{
    WrShape shape = wr_hard_shape(WR_SURFACE_bezier);
    WrVec3 p[2];
    for (int k = 0; k < 2; k++)
        p[k] = (WrVec3){ wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1),
                         wr_hard_between(g, -1, 1) };
    for (int k = 0; k < 16; k++) {
        const WrVec3 at = v3_mad(p[0], p[1], 0.3 * (k % 4) + 0.7 * (k / 4));
        memcpy(shape.value + 3 * (size_t)k, &at, sizeof at);
    }
    return shape;
}

static bool hc07(WrHardMeasurement *g, WrError *err)
{
    const WrShape shape = wr_hard_bicubic_patch(line_point);
    bool good = degenerate(g, &shape, err);
    for (int k = 0; k < 4 && good; k++) {
        const WrShape line = line_shape(g);
        good = degenerate(g, &line, err);
    }
    return good;
}

/* The normal of a tube points away from the tube's centre line, for any two radii. */
static bool hc08(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const double sizes[][2] = { { 1, 0 }, { 0.5, 0.5 }, { 0.25, 0.75 }, { 0, 1 } };
    for (int i = 0; i < 4; i++) {
        WrShape torus = wr_hard_shape(WR_SURFACE_torus);
        torus.value[0] = sizes[i][0];
        torus.value[1] = sizes[i][1];
        for (int k = 0; k <= 17 * 17; k++) {
            const float u = (float)(k % 17) / 16, v = (float)(k / 17) / 16;
            double s, c, sp, cp;
            wr_sincos_turns((double)u, &s, &c);
            wr_sincos_turns((double)v, &sp, &cp);
            const WrVec3 want = { cp * c, cp * s, sp };
            angle_f(g, &torus, u, v, want);
            angle_d(g, &torus, (double)u, (double)v, want);
        }
    }
    return true;
}

/* Pictures of tori of many sizes with proportional heights: all equal, except for the last digits of visibility.
   A different picture counts as a deviation of 1. */
static bool same_pictures(WrHardMeasurement *g, WrError *err)
{
    enum { SIZE = 48 };
    static const double scales[] = { 1, 3, 0.7, 1e-6, 1e6, 1e-20, 1e20 };
    static float first[4 * SIZE * SIZE];
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < 7 && good; k++) {
        WrScene *scene = wr_scene_new();
        WrFrameRequest request = { .field = field, .scene = scene, .width = SIZE, .height = SIZE };
        WrHardShot shot;
        double worst = 0.0;
        scene->shape = wr_hard_shape(WR_SURFACE_torus);
        for (int p = 0; p < 2; p++) scene->shape.value[p] *= scales[k];
        scene->bump = WR_BUMP_INVARIANT;
        scene->height = 0.02;
        good = wr_hard_shoot(g, &request, &shot, err);
        for (int i = 0; i < 4 * SIZE * SIZE && good; i++) {
            if (k == 0) first[i] = shot.frame.rgba[i];
            const double off = fabs((double)shot.frame.rgba[i] - (double)first[i]);
            if (!(off <= worst)) worst = off;
        }
        if (good) {
            wr_hard_record_error(g, WR_HARD_FLOAT, worst < 5e-3 ? 0.0 : 1.0);
            wr_hard_put_away(&shot);
        }
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* invariant: the same n' at any scale; blinn: the same if the heights grow proportionally. */
static bool hc09(WrHardMeasurement *g, WrError *err)
{
    static const double scales[] = { 1e-20, 1e-6, 1e6, 1e20 };
    for (int i = 0; i < 400; i++) {
        WrShape torus = wr_hard_shape(WR_SURFACE_torus), big = torus;
        const double k = scales[i % 4];
        const float u = wr_hard_float(g), v = wr_hard_float(g);
        const double fu = wr_hard_between(g, -2, 2), fv = wr_hard_between(g, -2, 2);
        for (int p = 0; p < 2; p++) big.value[p] *= k;
        /* as in the renderer: lengths scaled near 1 by a power of two, and heights with them */
        const double unit = scalbn(1.0, -ilogb(wr_shape_radius(&big)));
        WrSurfacePoint at, far;
        wr_surface_at(&torus, 0, (double)u, (double)v, &at);
        wr_surface_at(&big, 0, (double)u, (double)v, &far);
        for (int m = 0; m < 2; m++) {
            const WrBumpMode mode = m ? WR_BUMP_INVARIANT : WR_BUMP_BLINN;
            const double grow = m ? 1.0 : k;
            const WrVec3 want = wr_hard_bumped_normal(mode, &at, (WrHardSlope){ 0, fu, fv });
            const WrVec3 got =
                wr_hard_bumped_normal(mode, &far, (WrHardSlope){ 0, grow * fu, grow * fv });
            wr_hard_record_error(g, WR_HARD_DOUBLE, v3_angle_rad(got, want));
            for (int set = 0; set < g->sets; set++) {
                WrSurfacePointf atf = wr_hard_point(g, set, &big, unit, 0, u, v);
                const double s = m ? 1.0 : grow * unit;
                WrVec3 perturbed = wr_hard_bumped_normal_f(
                    g, set, mode, &atf, (WrHardSlope){ 0, s * fu, s * fv }, false);
                wr_hard_record_error(g, WR_HARD_FLOAT, v3_angle_rad(perturbed, want));
            }
        }
    }
    return same_pictures(g, err);
}

/* Cosine of the angle between n and a tangent, in ulps of the precision. */
static void upright(WrHardMeasurement *g, WrHardPrecision p, WrVec3 n, WrVec3 tangent, double ulp)
{
    wr_hard_record_error(g, p, fabs(v3_dot(n, tangent)) / v3_len(tangent) / ulp);
}

static bool hc10(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const double sides[] = { 1e10, 0.75, 0.25, -0.5, 0.75 }; /* a, b, c */
    WrShape shape = wr_hard_shape(WR_SURFACE_bent);
    for (int k = 0; k < 5; k++) shape.value[k] = sides[k];
    for (int i = 0; i < 300; i++) {
        const float u = wr_hard_float(g), v = wr_hard_float(g);
        WrSurfacePoint at;
        wr_surface_at(&shape, 0, (double)u, (double)v, &at);
        upright(g, WR_HARD_DOUBLE, at.n_unit, at.pu, 0x1p-52);
        upright(g, WR_HARD_DOUBLE, at.n_unit, at.pv, 0x1p-52);
        for (int set = 0; set < g->sets; set++) {
            WrSurfacePointf atf = wr_hard_point(g, set, &shape, 0x1p-33, 0, u, v);
            at = wr_hard_point_to_double(&atf);
            upright(g, WR_HARD_FLOAT, at.n_unit, at.pu, 0x1p-23);
            upright(g, WR_HARD_FLOAT, at.n_unit, at.pv, 0x1p-23);
        }
    }
    return true;
}

/* A patch whose tangents are nearly parallel: sixteen points i a + j (a + e b), a and b at random, e from 1e-6
   to 1e-3, of any size, rounded to float; both precisions use this rounded patch. */
static WrShape nearly_shape(WrHardMeasurement *g, double size)
{
    WrShape shape = wr_hard_shape(WR_SURFACE_bezier);
    const double apart = pow(10, wr_hard_between(g, -6, -3));
    WrVec3 a[2];
    for (int k = 0; k < 2; k++)
        a[k] = (WrVec3){ wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1),
                         wr_hard_between(g, -1, 1) };
    for (int k = 0; k < 16; k++) {
        const WrVec3 p = v3_add(v3_scale(a[0], k % 4 + k / 4), v3_scale(a[1], apart * (k / 4)));
        const double at[3] = { p.x, p.y, p.z };
        for (int c = 0; c < 3; c++) shape.value[3 * k + c] = (double)(float)(size * at[c]);
    }
    return shape;
}

/* The tangents' own cross product in 64 bits. */
static WrVec3 true_cross(WrVec3 a, WrVec3 b)
{
    const long double ax = a.x, ay = a.y, az = a.z, bx = b.x, by = b.y, bz = b.z;
    return (WrVec3){ (double)(ay * bz - az * by), (double)(az * bx - ax * bz),
                     (double)(ax * by - ay * bx) };
}

/* Angle between n and that, in ulps divided by the sine; the tangents are as computed. */
static void leans(WrHardMeasurement *g, WrHardPrecision p, const WrSurfacePoint *at, double ulp)
{
    const WrVec3 normal = true_cross(at->pu, at->pv);
    const double sine = v3_len(normal) / v3_len(at->pu) / v3_len(at->pv);
    if (!(sine > 16.0 * ulp)) return; /* in this precision the patch is a line */
    wr_hard_record_error(g, p, v3_angle_rad(at->n_unit, normal) * sine / ulp);
}

static bool hc11(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const double sizes[] = { 1, 1.0 / 3.0, 1e-6, 1e6 };
    for (int i = 0; i < 400; i++) {
        const WrShape shape = nearly_shape(g, sizes[i % 4]);
        const double unit = scalbn(1.0, -ilogb(wr_shape_radius(&shape)));
        const float u = i % 3 ? wr_hard_float(g) : (float)(i % 2);
        const float v = i % 3 ? wr_hard_float(g) : (float)(i / 2 % 2);
        WrSurfacePoint at;
        wr_surface_at(&shape, 0, (double)u, (double)v, &at);
        leans(g, WR_HARD_DOUBLE, &at, 0x1p-52);
        for (int set = 0; set < g->all; set++) {
            const WrSurfacePointf atf = wr_hard_point(g, set, &shape, unit, 0, u, v);
            at = wr_hard_point_to_double(&atf);
            leans(g, WR_HARD_FLOAT, &at, 0x1p-23);
        }
    }
    return true;
}

static const WrHardCase rows_surface[] = {
    GEOMETRY(01, "the sphere's poles", "n is the axis itself, pointing outward", "rad", 1e-6, 1e-6,
             "table 64x64\ngrid cells=8x8 width=2\nsurface sphere\nrotate 15,0,0\nbump height=0.3"),
    GEOMETRY(02, "approaching a pole where F has one value",
             "n' follows the surface gradient down to the last place", "rad", 1e-7, 1e-14,
             "analytic fourier terms=1,1,0.3,0,-90\nsurface sphere\nrotate 15,0,0\nbump height=1"),
    GEOMETRY(03, "a pole where the table has several values", "n' has length 1 and is finite",
             "relative", 1e-6, 1e-14,
             "table 64x64\nnoise perlin cells=8\nsurface sphere\nrotate 15,0,0\nbump height=0.1"),
    GEOMETRY(04, "the cone's tip", "each u has the normal of its own generator", "rad", 1e-6, 1e-14,
             "table 64x64\ngrid cells=8x8 width=2\nsurface cone\nrotate -40,0,0\nbump height=0.3"),
    GEOMETRY(
        05, "an edge of a patch that is one point",
        "n follows the mixed derivative, with its sign at either end, and is continuous", "rad",
        2e-6, 1e-14,
        "table 64x64\nnoise perlin cells=6\nsurface bezier points=0,0,0.5;0,0,0.5;0,0,0.5;0,0,0.5;"
        "0.375,0,0.375;0.375,0.1875,0.375;0.1875,0.375,0.375;0,0.375,0.375;"
        "0.75,0,0.125;0.75,0.375,0.125;0.375,0.75,0.125;0,0.75,0.125;1,0,0;1,0.5,0;"
        "0.5,1,0;0,1,0\nbump height=0.15"),
    GEOMETRY(06, "a patch whose sixteen points are equal",
             "the normal is the defined one and no picture contains a NaN", "violations", 0, 0,
             "table 64x64\ngrid cells=8x8 width=2\nsurface bezier "
             "points=0,0,0;0,0,0;0,0,0;0,0,0;0,0,0;0,0,0;0,0,0;"
             "0,0,0;0,0,0;0,0,0;0,0,0;0,0,0;0,0,0;0,0,0;0,0,0;0,0,0"),
    GEOMETRY(07, "a patch that is a straight line",
             "the normal is the defined one and no picture contains a NaN", "violations", 0, 0,
             "table 64x64\ngrid cells=8x8 width=2\nsurface bezier "
             "points=0,0,0;1,1,0;2,2,0;3,3,0;1,1,0;2,2,0;3,3,0;"
             "4,4,0;2,2,0;3,3,0;4,4,0;5,5,0;3,3,0;4,4,0;5,5,0;6,6,0"),
    GEOMETRY(08, "tori without a tube, without a hole, and through themselves",
             "n points away from the tube's centre line", "rad", 1e-6, 1e-14,
             "table 64x64\nnoise perlin cells=6\nsurface torus R=0.25 r=0.75\nbump height=0.3"),
    GEOMETRY(09, "objects 1e20 times as large and as small",
             "the scale-invariant n' does not change; nor does the paper's if heights scale too",
             "rad", 1e-6, 1e-13,
             "table 64x64\nnoise perlin cells=6\nsurface torus R=1e20 r=3e19\nbump height=2e19"),
    GEOMETRY(10, "Pu 1e10 times as long as Pv", "n is orthogonal to both", "last places", 4, 4,
             "table 64x64\ngrid cells=8x8 width=2\nsurface plane a=1 b=1e-10\nbump height=1e-12"),
    GEOMETRY(11, "Pu and Pv a thousandth to a millionth of a radian apart",
             "the error of n is at most rounding over the sine of their angle",
             "last places / sine", 1, 1, NULL),
};
WR_HARD_LIST(surface, rows_surface);
