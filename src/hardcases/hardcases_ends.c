/* Hard cases of HC156 and later: surfaces, tables and heights at the limits of their range, and light without a
   direction. */
#include "base/error.h"
#include "field/scheme_list.h"
#include "base/exactmath.h"
#include "document/blend.h"
#include "field/field.h"
#include "field/ops.h"
#include "hardcases/hardcases_later.h"
#include "hardcases/hardcases_look.h"
#include "scene/scene.h"
#include "base/vec.h"

#include <float.h>
#include <string.h>

/* ---- surfaces ---- */

/* A shallow dish; `how` selects the coincident control points: two at a corner along u, along v, three at the
   corner, two within an edge, two in the middle, four there. */
static WrShape coincident(int how)
{
    static const int pairs[6][3][2] = { { { 1, 0 } },           { { 4, 0 } },
                                        { { 1, 0 }, { 4, 0 } }, { { 2, 1 } },
                                        { { 6, 5 } },           { { 6, 5 }, { 9, 5 }, { 10, 5 } } };
    WrShape shape = wr_hard_shape(WR_SURFACE_bezier);
    for (int k = 0; k < 16; k++) {
        const double x = k % 4 / 3.0, y = k / 4 / 3.0;
        shape.value[3 * k] = x;
        shape.value[3 * k + 1] = y;
        shape.value[3 * k + 2] = 0.37 * (x * x + y * y);
    }
    for (int p = 0; p < 3; p++) {
        const int to = pairs[how][p][0], from = pairs[how][p][1];
        if (to != from) memcpy(shape.value + 3 * to, shape.value + 3 * from, 3 * sizeof(double));
    }
    return shape;
}

/* Along the diagonal n is continuous at the corner, in float and in double (the edges beside it have normals of
   their own); everywhere it has length 1 after perturbation. */
bool wr_hard_hc156(WrHardGauge *g, WrError *err)
{
    static const double near[] = { 0, 1e-30, 1e-7, 1e-5 };
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int how = 0; how < 6 && good; how++) {
        const WrShape shape = coincident(how);
        WrSurfacePoint beside;
        wr_surface_at(&shape, 0, 1e-4, 1e-4, &beside);
        for (int k = 0; k < 16; k++) {
            const double u = near[k % 4], v = near[k / 4];
            WrSurfacePoint at;
            wr_surface_at(&shape, 0, u, v, &at);
            const bool middle = k % 4 == k / 4;
            if (middle)
                wr_hard_holds(g, WR_HARD_DOUBLE, v3_angle_rad(at.n_unit, beside.n_unit) < 2e-3);
            wr_hard_holds(g, WR_HARD_DOUBLE, fabs(v3_len(at.n_unit) - 1.0) < 1e-14);
            for (int set = 0; set < g->all; set++) {
                const WrSurfacePointf atf =
                    wr_hard_point(g, set, &shape, 1.0, 0, (float)u, (float)v);
                if (middle)
                    wr_hard_holds(g, WR_HARD_FLOAT,
                                  v3_angle_rad(wr_hard_vec(atf.n_unit), beside.n_unit) < 2e-3);
                for (int mode = 0; mode < WR_BUMP_COUNT; mode++) {
                    const WrVec3 perturbed = wr_hard_perturbed_f(
                        g, set, (WrBumpMode)mode, &atf, (WrHardSlope){ 0.1, 2, -3 }, false);
                    wr_hard_holds(g, WR_HARD_FLOAT, fabs(v3_len(perturbed) - 1.0) < 1e-6);
                }
            }
        }
        WrScene *scene = wr_scene_new();
        scene->shape = shape;
        good = wr_hard_tame(g, field, scene, err);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* The hole closes to a point where Pu vanishes: beside it n points away from the tube's centre line, and
   perturbed normals have length 1 for any table. */
bool wr_hard_hc160(WrHardGauge *g, WrError *err)
{
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int i = 0; i < 40 && good; i++) {
        WrShape torus = wr_hard_shape(WR_SURFACE_torus);
        torus.value[0] = torus.value[1] = wr_hard_between(g, 0.2, 0.8);
        for (int k = -24; k <= 24; k++) {
            const double v = 0.5 + (k < 0 ? -ldexp(1.0, k) : k > 0 ? ldexp(1.0, -k) : 0.0) / 4;
            const float u = wr_hard_float(g), single = (float)v;
            const WrHardSlope slope = { 0, wr_hard_between(g, -4, 4), wr_hard_between(g, -4, 4) };
            double s, c, sp, cp;
            wr_sincos_turns((double)u, &s, &c);
            wr_sincos_turns((double)single, &sp, &cp);
            const WrVec3 want = { cp * c, cp * s, sp };
            for (int mode = 0; mode < WR_BUMP_COUNT; mode++) {
                WrSurfacePoint at;
                wr_surface_at(&torus, 0, (double)u, (double)single, &at);
                wr_hard_off(g, WR_HARD_DOUBLE, v3_angle_rad(at.n_unit, want));
                wr_hard_off(g, WR_HARD_DOUBLE,
                            fabs(v3_len(wr_hard_perturbed((WrBumpMode)mode, &at, slope)) - 1.0));
                for (int set = 0; set < g->all; set++) {
                    const WrSurfacePointf atf = wr_hard_point(g, set, &torus, 1.0, 0, u, single);
                    const WrVec3 perturbed =
                        wr_hard_perturbed_f(g, set, (WrBumpMode)mode, &atf, slope, false);
                    wr_hard_off(g, WR_HARD_FLOAT, v3_angle_rad(wr_hard_vec(atf.n_unit), want));
                    wr_hard_off(g, WR_HARD_FLOAT, fabs(v3_len(perturbed) - 1.0));
                }
            }
        }
        if (i > 3) continue;
        WrScene *scene = wr_scene_new();
        scene->shape = torus;
        WrHardGauge quiet = *g; /* counts violations; here deviations are measured */
        good = wr_hard_tame(&quiet, field, scene, err);
        wr_hard_off(g, WR_HARD_FLOAT, good && quiet.worst[0] == g->worst[0] ? 0.0 : 1.0);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* Kernel results n and n' there: NaN light counts as none, so pictures would hide it. */
static void thin_point(WrHardGauge *g, int set, const WrScene *scene, WrHardSlope slope)
{
    const double unit = scalbn(1.0, -ilogb(wr_shape_radius(&scene->shape)));
    const WrSurfacePointf at =
        wr_hard_point(g, set, &scene->shape, unit, 0, wr_hard_float(g), wr_hard_float(g));
    const WrVec3 perturbed = wr_hard_perturbed_f(g, set, scene->bump, &at, slope, false);
    wr_hard_holds(g, WR_HARD_FLOAT, fabs(v3_len(wr_hard_vec(at.n_unit)) - 1.0) < 1e-5);
    wr_hard_holds(g, WR_HARD_FLOAT, fabs(v3_len(perturbed) - 1.0) < 1e-5);
}

/* Sides of 1e-30 beside others of 1: almost no area, and unbounded slopes per unit of length. */
bool wr_hard_hc161(WrHardGauge *g, WrError *err)
{
    static const struct {
        WrSurfaceKind kind;
        int side;
    } thin[] = { { WR_SURFACE_plane, 0 },    { WR_SURFACE_plane, 1 },  { WR_SURFACE_cylinder, 0 },
                 { WR_SURFACE_cylinder, 1 }, { WR_SURFACE_cone, 0 },   { WR_SURFACE_cone, 1 },
                 { WR_SURFACE_torus, 1 },    { WR_SURFACE_ribbon, 3 }, { WR_SURFACE_sphere, 0 } };
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < 9 * (WR_BUMP_COUNT - 1) && good; k++) {
        const int which = k % 9;
        WrScene *scene = wr_scene_new();
        scene->shape = wr_hard_shape(thin[which].kind);
        scene->shape.value[thin[which].side] = WR_LENGTH_MIN;
        scene->bump = (WrBumpMode)(WR_BUMP_BLINN + k / 9);
        scene->height = 0.1;
        good = wr_shape_check(&scene->shape, err) && wr_hard_tame(g, field, scene, err);
        for (int i = 0; i < 20 && good; i++) {
            WrSurfacePoint at;
            const WrHardSlope slope = { 0.1, wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1) };
            wr_surface_at(&scene->shape, 0, wr_hard_random(g), wr_hard_random(g), &at);
            const WrVec3 perturbed = wr_hard_perturbed(scene->bump, &at, slope);
            wr_hard_holds(g, WR_HARD_DOUBLE, fabs(v3_len(at.n_unit) - 1.0) < 1e-14);
            wr_hard_holds(g, WR_HARD_DOUBLE, fabs(v3_len(perturbed) - 1.0) < 1e-14);
            for (int set = 0; set < g->all; set++) thin_point(g, set, scene, slope);
        }
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* ---- tables ---- */

/* The table repeated to `across` and `down` times as many columns and rows: F is the same function. */
static WrField *repeated(const WrField *field, int across, int down)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    WrField *out =
        wr_field_new(w * across, h * down, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
    for (int j = 0; j < h * down; j++)
        for (int i = 0; i < w * across; i++)
            wr_field_set(out, i, j, wr_field_get(field, i % w, j % h));
    return out;
}

/* Tables of one row, one column and one texel, as pictures: equal to those of the table repeated to eight. */
bool wr_hard_hc157(WrHardGauge *g, WrError *err)
{
    static const int sizes[][2] = { { 1, 24 }, { 24, 1 }, { 1, 1 } };
    static const WrSurfaceKind kinds[] = { WR_SURFACE_sphere, WR_SURFACE_plane, WR_SURFACE_bent };
    bool good = true;
    for (int k = 0; k < 3 * WR_SCHEME_COUNT && good; k++) {
        const int w = sizes[k % 3][0], h = sizes[k % 3][1];
        WrField *thin = wr_hard_rough(g, w, h, WR_WRAP_PERIODIC);
        WrField *wide = repeated(thin, w == 1 ? 8 : 1, h == 1 ? 8 : 1);
        WrScene *scene = wr_scene_new();
        scene->shape = wr_hard_shape(kinds[k / 3 % 3]);
        scene->scheme = (WrScheme)(k / 3);
        scene->height = 0.05;
        WrFrameRequest request = { .field = thin, .scene = scene, .width = 40, .height = 40 };
        WrReference thin_truth = { 0 }, wide_truth = { 0 };
        good = wr_hard_refer(g, &request, 1, &thin_truth, err);
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrHardShot a = { .renderer = NULL }, b = { .renderer = NULL };
            request.field = thin;
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &a, err);
            request.field = wide;
            good = good && wr_hard_shoot_by(g, &request, (WrHardWay)way, &b, err);
            if (good) wr_hard_holds(g, wr_hard_precision(way), wr_hard_differ(&a, &b, 2e-4) == 0);
            wr_hard_put_away(&a);
            wr_hard_put_away(&b);
        }
        good = good && wr_hard_refer(g, &request, 1, &wide_truth, err);
        for (int i = 0; i < 4 * 40 * 40 && good; i++)
            wr_hard_holds(g, WR_HARD_DOUBLE, fabs(thin_truth.rgba[i] - wide_truth.rgba[i]) < 1e-9);
        wr_reference_fini(&thin_truth);
        wr_reference_fini(&wide_truth);
        wr_scene_free(scene);
        wr_field_free(thin);
        wr_field_free(wide);
    }
    return good;
}

/* A layer added and an almost equal one subtracted: the result is the difference of two stored heights, which is
   exact at any level; in either order, above any layers. */
bool wr_hard_hc162(WrHardGauge *g, WrError *err)
{
    (void)err;
    enum { COUNT = 512 };
    static const float levels[] = { 1, 1e3f, 1e6f, 1e30f, 3e38f };
    for (int k = 0; k < 5; k++) {
        float up[COUNT], down[COUNT], below[COUNT];
        for (int i = 0; i < COUNT; i++) {
            up[i] = levels[k] * (0.75f + 0.25f * wr_hard_float(g));
            down[i] = up[i] * (1.0f + 0x1p-20f * wr_hard_float(g));
            below[i] = 0.0f;
        }
        const WrBlendTile first = { .heights = up, .cover_level = 1, .mask_level = 1 };
        const WrBlendTile second = { .heights = down, .cover_level = 1, .mask_level = 1 };
        const bool added_first = k % 2 == 0;
        wr_blend_tile(added_first ? WR_BLEND_ADD : WR_BLEND_SUBTRACT, 1, 0,
                      added_first ? &first : &second, COUNT, below);
        wr_blend_tile(added_first ? WR_BLEND_SUBTRACT : WR_BLEND_ADD, 1, 0,
                      added_first ? &second : &first, COUNT, below);
        for (int i = 0; i < COUNT; i++)
            wr_hard_holds(g, WR_HARD_FLOAT, (double)below[i] == (double)up[i] - (double)down[i]);
    }
    return true;
}

/* Every operation on tables at both limits of float: heights stay finite, and a flat table of the largest height
   is unchanged by operations that do not affect flat areas. */
bool wr_hard_hc165(WrHardGauge *g, WrError *err)
{
    enum { WIDE = 80, HIGH = 70 }; /* crop limits itself to 64 */
    static const float ends[] = { FLT_MAX, -FLT_MAX, 1e-45f, -1e-45f, 0x1p-126f, -0.0f, 1e37f };
    bool good = true;
    for (int k = 0; k < wr_op_count * 3 && good; k++) {
        const WrOpInfo *op = &wr_ops[k / 3];
        const WrWrap wrap = k % 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC;
        WrField *field = wr_field_new(WIDE, HIGH, wrap, wrap, 0.0f, err);
        good = field != NULL;
        for (int i = 0; i < WIDE * HIGH && good; i++)
            wr_field_set(field, i % WIDE, i / WIDE, ends[(int)(7 * wr_hard_random(g))]);
        WrField *out = good ? wr_op_run(op, field, NULL, NULL, err) : NULL;
        good = out != NULL;
        for (int j = 0; good && j < wr_field_height(out); j++)
            for (int i = 0; i < wr_field_width(out); i++)
                wr_hard_holds(g, WR_HARD_FLOAT, isfinite(wr_field_get(out, i, j)));
        wr_field_free(out);
        wr_field_free(field);
    }
    return good;
}

/* +0 and -0 in one table: the picture of a flat table, to the bit. */
bool wr_hard_hc173(WrHardGauge *g, WrError *err)
{
    WrField *mixed = wr_field_new(24, 24, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, err);
    WrField *plain = wr_field_new(24, 24, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, err);
    bool good = mixed && plain;
    for (int i = 0; i < 24 * 24 && good; i++)
        wr_field_set(mixed, i % 24, i / 24, wr_hard_random(g) < 0.5 ? -0.0f : 0.0f);
    for (int k = 0; k < WR_SCHEME_COUNT * (WR_BUMP_COUNT - 1) && good; k++) {
        WrScene *scene = wr_scene_new();
        WrFrameRequest request = { .scene = scene, .width = 32, .height = 32, .full = true };
        scene->shape = wr_hard_shape(k % 2 ? WR_SURFACE_sphere : WR_SURFACE_torus);
        scene->scheme = (WrScheme)(k % WR_SCHEME_COUNT);
        scene->bump = (WrBumpMode)(WR_BUMP_BLINN + k / WR_SCHEME_COUNT);
        scene->height = k % 3 ? 1 : -1e30;
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrHardShot a = { .renderer = NULL }, b = { .renderer = NULL };
            request.field = mixed;
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &a, err);
            request.field = plain;
            good = good && wr_hard_shoot_by(g, &request, (WrHardWay)way, &b, err);
            if (good) wr_hard_holds(g, wr_hard_precision(way), wr_hard_differ(&a, &b, 0.0) == 0);
            wr_hard_put_away(&a);
            wr_hard_put_away(&b);
        }
        wr_scene_free(scene);
    }
    wr_field_free(mixed);
    wr_field_free(plain);
    return good;
}

/* Kernel fetches from it, scaled to float's maximum, are finite: an infinite slope has no direction. */
static bool look_stays_finite(WrHardGauge *g, const WrField *field, const WrScene *scene,
                              WrError *err)
{
    WrHardLook look;
    if (!wr_hard_look_init(g, &look, field, scene->scheme, 1, 1, err)) return false;
    look.look.scale_f = look.look.scale_u = (float)fmin(fabs(scene->height), (double)FLT_MAX);
    look.look.scale_v = -look.look.scale_u;
    for (int i = 0; i < 20 * g->all; i++) {
        const WrHardSlope s =
            wr_hard_look_at(g, i % g->all, &look, wr_hard_float(g), wr_hard_float(g));
        wr_hard_holds(g, WR_HARD_FLOAT, isfinite(s.f) && isfinite(s.fu) && isfinite(s.fv));
    }
    wr_hard_look_fini(&look);
    return true;
}

/* Heights of 1e30 in a table, with a height of 1e30 in the scene. */
bool wr_hard_hc175(WrHardGauge *g, WrError *err)
{
    static const double heights[] = { 1e30, -1e300, 1e-300 };
    WrField *field = wr_hard_waves(24, 24);
    for (int i = 0; i < 24 * 24; i++)
        wr_field_set(field, i % 24, i / 24, 1e30f * wr_field_get(field, i % 24, i / 24));
    bool good = true;
    for (int k = 0; k < WR_SCHEME_COUNT * (WR_BUMP_COUNT - 1) * 3 && good; k++) {
        WrScene *scene = wr_scene_new();
        scene->shape = wr_hard_shape((WrSurfaceKind)(k % WR_SURFACE_COUNT));
        scene->scheme = (WrScheme)(k % WR_SCHEME_COUNT);
        scene->bump = (WrBumpMode)(WR_BUMP_BLINN + k / WR_SCHEME_COUNT % (WR_BUMP_COUNT - 1));
        scene->height = heights[k / WR_SCHEME_COUNT / (WR_BUMP_COUNT - 1)];
        good = look_stays_finite(g, field, scene, err) && wr_hard_tame(g, field, scene, err);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* ---- light ---- */

/* Kernels with the lamp, and the eye, exactly at the lit point. */
static void touching(WrHardGauge *g)
{
    for (int k = 0; k < 40; k++) {
        const float hair = k % 4 ? ldexpf(1.0f, -20 * (k % 4) - k) : 0.0f;
        const float p[3] = { wr_hard_float(g), wr_hard_float(g), wr_hard_float(g) };
        const WrKernLight lamp = { .point = true,
                                   .where = { p[0], p[1], p[2] + hair },
                                   .rgb = { 1, 1, 1 } };
        const WrRays rays = { .perspective = true, .eye = { p[0], p[1], p[2] + hair } };
        for (int set = 0; set < g->all; set++) {
            WrStrip *s = g->strip;
            s->count = 1;
            s->px[0] = p[0], s->py[0] = p[1], s->pz[0] = p[2];
            s->bx[0] = s->by[0] = 0.0f, s->bz[0] = 1.0f;
            g->kernels[set]->view(&rays, s);
            g->kernels[set]->begin(0.0f, s);
            g->kernels[set]->light(&lamp, s);
            g->kernels[set]->diffuse(&lamp, 1.0f, s);
            g->kernels[set]->specular(&lamp, 1.0f, 20.0f, k % 2, s);
            wr_hard_holds(g, WR_HARD_FLOAT, s->dr[0] >= 0.0f && s->dr[0] <= 1.00001f);
            wr_hard_holds(g, WR_HARD_FLOAT, s->sr[0] >= 0.0f && s->sr[0] <= 1.00001f);
            wr_hard_holds(g, WR_HARD_FLOAT, isfinite(s->lx[0]) && isfinite(s->vz[0]));
        }
        const WrKernLightd wide = { .point = true,
                                    .where = { (double)p[0], (double)p[1],
                                               (double)p[2] + (double)hair },
                                    .rgb = { 1, 1, 1 } };
        for (int set = 0; set < 2; set++) {
            WrStripd *s = g->wide_strip;
            s->count = 1;
            s->px[0] = (double)p[0], s->py[0] = (double)p[1], s->pz[0] = (double)p[2];
            s->bx[0] = s->by[0] = 0.0, s->bz[0] = 1.0;
            g->wide[set]->begin(0.0, s);
            g->wide[set]->light(&wide, s);
            g->wide[set]->diffuse(&wide, 1.0, s);
            wr_hard_holds(g, WR_HARD_DOUBLE, s->dr[0] >= 0.0 && s->dr[0] <= 1.00001);
            wr_hard_holds(g, WR_HARD_DOUBLE, isfinite(s->lx[0]) && isfinite(s->lz[0]));
        }
    }
}

/* A lamp at a point of the surface, and one inside: the direction is undefined there, but every value is finite
   and within the light's range. */
bool wr_hard_hc159(WrHardGauge *g, WrError *err)
{
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    touching(g);
    for (int k = 0; k < 2 * WR_SURFACE_COUNT && good; k++) {
        WrScene *scene = wr_scene_new();
        WrSurfacePoint at;
        scene->shape = wr_hard_shape((WrSurfaceKind)(k / 2));
        scene->posed = scene->lights_given = true;
        scene->height = k % 2 ? 0.0 : 0.05;
        wr_surface_at(&scene->shape, 0, 0.5, 0.5, &at);
        const WrVec3 where = v3_sub(at.p, wr_shape_centre(&scene->shape));
        const double radius = wr_shape_radius(&scene->shape);
        scene->lights[0] = (WrLight){
            .kind = WR_LIGHT_POINT, .where = where, .colour = { 1, 1, 1 }, .strength = 1
        };
        scene->material = (WrMaterial){
            .diffuse = 1, .specular = 1, .shininess = 20, .colour = { 1, 1, 1 }, .gate = k % 2
        };
        /* straight towards it, so that the middle sample is at the lamp */
        scene->camera = (WrCamera){ .orthographic = true,
                                    .eye = v3_mad(where, at.n_unit, 3 * radius),
                                    .target = where,
                                    .up = { 0.3, 0.2, 0.9 },
                                    .size = k % 4 < 2 ? radius : 0.1 * radius };
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = 41, .height = 41
        };
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrHardShot shot = { .renderer = NULL };
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &shot, err);
            for (int i = 0; i < 41 * 41 * 4 && good; i++)
                wr_hard_holds(g, wr_hard_precision(way),
                              shot.frame.rgba[i] >= 0.0f && shot.frame.rgba[i] <= 2.00001f);
            wr_hard_put_away(&shot);
        }
        WrReference reference = { 0 };
        good = good && wr_hard_refer(g, &request, 1, &reference, err);
        for (int i = 0; i < 41 * 41 * 4 && good; i++)
            wr_hard_holds(g, WR_HARD_DOUBLE,
                          reference.rgba[i] >= 0.0 && reference.rgba[i] <= 2.00001);
        wr_reference_fini(&reference);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}
