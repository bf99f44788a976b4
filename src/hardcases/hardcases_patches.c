/* Hard cases of sets of bicubic patches: tables across rotated and mirrored edges, and missing patches. */
#include "hardcases/hardcases_internal.h"
#include "field/scheme_list.h"

#include "base/error.h"
#include "base/memory.h"
#include "field/field.h"
#include "scene/scene.h"
#include "surface/patches.h"
#include "surface/terrain.h"

#include <string.h>

enum { SIDE = 5 };

/* Patches over rough heights. The caller frees them. */
static float (*rough_points(WrHardGauge *g, int side, double height))[48]
{
    float heights[SIDE * SIDE * 4], (*points)[48];
    int columns, rows;
    for (int i = 0; i < SIDE * SIDE * 4; i++) heights[i] = wr_hard_float(g);
    const WrTerrain terrain = { NULL, heights, 2 * SIDE, 2 * SIDE, 1, 1, height, side };
    return wr_terrain_points(&terrain, &points, &columns, &rows, NULL) ? points : NULL;
}

void wr_hard_ground(WrHardGauge *g, WrScene *scene)
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
static void compare_edges(WrHardGauge *g, const WrPatches *set, const WrField *field)
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
                    wr_hard_off(g, WR_HARD_DOUBLE,
                                f == h ? v3_len(v3_sub(slope, other)) / (1 + v3_len(slope)) : 1);
                }
    wr_hard_holds(g, WR_HARD_DOUBLE, met >= 4 * 9);
}

static bool hc151(WrHardGauge *g, WrError *err)
{
    WrField *field = wr_hard_rough(g, 16, 16, WR_WRAP_PERIODIC);
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
static bool hc152(WrHardGauge *g, WrError *err)
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
        const WrPatchesTold *told = &made->patches->told;
        wr_hard_holds(g, WR_HARD_DOUBLE, (told->creased > 0) == (k == 1));
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      k != 1 || (told->crease_of[0] <= 12 && told->crease_of[1] <= 17));
        wr_hard_holds(g, WR_HARD_DOUBLE, told->loops == (k == 2 ? 2 : 1));
        wr_hard_holds(g, WR_HARD_DOUBLE, told->open == (k == 3 ? 3 : 4 * SIDE + (k == 2 ? 4 : 0)));
        wr_hard_holds(g, WR_HARD_DOUBLE, told->collapsed == (k == 3 ? 1 : 0));
        wr_triangles_free(made);
        wr_free(points);
    }
    return good;
}

static const WrHardCase rows[] = {
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
      .holds = "crease, loops and collapsed edge are told",
      .unit = "violations",
      .bound = { NAN, 0 },
      .measure = hc152 },
};
WR_HARD_LIST(patches, rows);
