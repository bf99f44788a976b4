/* Hard cases of points and normals: poles, tips, collapsed edges, extreme lengths. */
#include "hardcases/hardcases_internal.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "field/field.h"
#include "scene/scene.h"
#include "base/vec.h"

#include <float.h>
#include <string.h>

static const WrVec3 zero = { 0, 0, 0 };

/* The angle between n in float and the expected one, for each kernel set. */
static void angle_f(WrHardGauge *g, const WrShape *shape, float u, float v, WrVec3 want)
{
    for (int k = 0; k < g->sets; k++) {
        WrSurfacePointf at = wr_hard_point(g, k, shape, 1.0, 0, u, v);
        wr_hard_off(g, WR_HARD_FLOAT, v3_angle_rad(wr_hard_vec(at.n_unit), want));
    }
}

static void angle_d(WrHardGauge *g, const WrShape *shape, double u, double v, WrVec3 want)
{
    WrSurfacePoint at;
    wr_surface_at(shape, 0, u, v, &at);
    wr_hard_off(g, WR_HARD_DOUBLE, v3_angle_rad(at.n_unit, want));
}

static bool hc01(WrHardGauge *g, WrError *err)
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
static bool hc02(WrHardGauge *g, WrError *err)
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
            wr_hard_off(g, WR_HARD_DOUBLE,
                        v3_angle_rad(wr_hard_perturbed(WR_BUMP_BLINN, &at, slope), ideal));
            for (int set = 0; set < g->sets && k <= 24; set++) {
                WrSurfacePointf atf = wr_hard_point(g, set, &sphere, 1.0, 0, (float)u, (float)v);
                WrVec3 perturbed = wr_hard_perturbed_f(g, set, WR_BUMP_BLINN, &atf, slope, false);
                wr_hard_off(g, WR_HARD_FLOAT, v3_angle_rad(perturbed, ideal));
            }
        }
    return true;
}

static bool hc03(WrHardGauge *g, WrError *err)
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
            WrVec3 perturbed = wr_hard_perturbed((WrBumpMode)mode, &at, slope);
            wr_hard_off(g, WR_HARD_DOUBLE, fabs(v3_len(perturbed) - 1.0));
            for (int set = 0; set < g->sets; set++) {
                WrSurfacePointf atf = wr_hard_point(g, set, &sphere, 1.0, 0, u, (float)v);
                perturbed = wr_hard_perturbed_f(g, set, (WrBumpMode)mode, &atf, slope, false);
                wr_hard_off(g, WR_HARD_FLOAT, fabs(v3_len(perturbed) - 1.0));
            }
        }
    return true;
}

static bool hc04(WrHardGauge *g, WrError *err)
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

static bool hc05(WrHardGauge *g, WrError *err)
{
    (void)err;
    const WrShape dishes[2] = { wr_hard_patch(dish_low), wr_hard_patch(dish_high) };
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
static bool degenerate(WrHardGauge *g, const WrShape *shape, WrError *err)
{
    const WrHardSlope slope = { 0.3, 2, -1 };
    for (int k = 0; k < 81; k++) {
        const double u = k % 9 / 8.0, v = k / 9 / 8.0;
        WrSurfacePoint at;
        wr_surface_at(shape, 0, u, v, &at);
        wr_hard_holds(g, WR_HARD_DOUBLE, wr_hard_same(at.n_unit, (WrVec3){ 0, 0, 1 }));
        for (int mode = 0; mode < WR_BUMP_COUNT; mode++) {
            WrVec3 perturbed = wr_hard_perturbed((WrBumpMode)mode, &at, slope);
            wr_hard_holds(g, WR_HARD_DOUBLE, fabs(v3_len(perturbed) - 1.0) < 1e-14);
            for (int set = 0; set < g->sets; set++) {
                WrSurfacePointf atf = wr_hard_point(g, set, shape, 1.0, 0, (float)u, (float)v);
                perturbed = wr_hard_perturbed_f(g, set, (WrBumpMode)mode, &atf, slope, false);
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

static bool hc06(WrHardGauge *g, WrError *err)
{
    const WrShape shape = wr_hard_patch(same_point);
    return degenerate(g, &shape, err);
}

/* Points on a line of any direction, with rounded coordinates: Pu x Pv is rounding error. */
static WrShape line_shape(WrHardGauge *g)
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

static bool hc07(WrHardGauge *g, WrError *err)
{
    const WrShape shape = wr_hard_patch(line_point);
    bool good = degenerate(g, &shape, err);
    for (int k = 0; k < 4 && good; k++) {
        const WrShape line = line_shape(g);
        good = degenerate(g, &line, err);
    }
    return good;
}

/* The normal of a tube points away from the tube's centre line, for any two radii. */
static bool hc08(WrHardGauge *g, WrError *err)
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
static bool same_pictures(WrHardGauge *g, WrError *err)
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
            wr_hard_off(g, WR_HARD_FLOAT, worst < 5e-3 ? 0.0 : 1.0);
            wr_hard_put_away(&shot);
        }
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* invariant: the same n' at any scale; blinn: the same if the heights grow proportionally. */
static bool hc09(WrHardGauge *g, WrError *err)
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
            const WrVec3 want = wr_hard_perturbed(mode, &at, (WrHardSlope){ 0, fu, fv });
            const WrVec3 got =
                wr_hard_perturbed(mode, &far, (WrHardSlope){ 0, grow * fu, grow * fv });
            wr_hard_off(g, WR_HARD_DOUBLE, v3_angle_rad(got, want));
            for (int set = 0; set < g->sets; set++) {
                WrSurfacePointf atf = wr_hard_point(g, set, &big, unit, 0, u, v);
                const double s = m ? 1.0 : grow * unit;
                WrVec3 perturbed = wr_hard_perturbed_f(g, set, mode, &atf,
                                                       (WrHardSlope){ 0, s * fu, s * fv }, false);
                wr_hard_off(g, WR_HARD_FLOAT, v3_angle_rad(perturbed, want));
            }
        }
    }
    return same_pictures(g, err);
}

/* Cosine of the angle between n and a tangent, in ulps of the precision. */
static void upright(WrHardGauge *g, WrHardPrecision p, WrVec3 n, WrVec3 tangent, double ulp)
{
    wr_hard_off(g, p, fabs(v3_dot(n, tangent)) / v3_len(tangent) / ulp);
}

static bool hc10(WrHardGauge *g, WrError *err)
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
            at = wr_hard_widen(&atf);
            upright(g, WR_HARD_FLOAT, at.n_unit, at.pu, 0x1p-23);
            upright(g, WR_HARD_FLOAT, at.n_unit, at.pv, 0x1p-23);
        }
    }
    return true;
}

/* A patch whose tangents are nearly parallel: sixteen points i a + j (a + e b), a and b at random, e from 1e-6
   to 1e-3, of any size, rounded to float; both precisions use this rounded patch. */
static WrShape nearly_shape(WrHardGauge *g, double size)
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
static void leans(WrHardGauge *g, WrHardPrecision p, const WrSurfacePoint *at, double ulp)
{
    const WrVec3 normal = true_cross(at->pu, at->pv);
    const double sine = v3_len(normal) / v3_len(at->pu) / v3_len(at->pv);
    if (!(sine > 16.0 * ulp)) return; /* in this precision the patch is a line */
    wr_hard_off(g, p, v3_angle_rad(at->n_unit, normal) * sine / ulp);
}

static bool hc11(WrHardGauge *g, WrError *err)
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
            at = wr_hard_widen(&atf);
            leans(g, WR_HARD_FLOAT, &at, 0x1p-23);
        }
    }
    return true;
}

#define GEOMETRY(number, situation, rule, u, in_float, in_double, script)                          \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_GEOMETRY, .what = situation, .holds = rule,         \
        .unit = u, .bound = { in_float, in_double }, .measure = hc##number, .scene = script        \
    }
static const WrHardCase rows[] = {
    GEOMETRY(01, "the sphere's poles", "n is the axis itself, pointing outward", "rad", 1e-6, 1e-6,
             "table 64x64\ngrid cells=8x8 width=2\nsurface sphere\nrotate 15,0,0\nbump height=0.3"),
    GEOMETRY(02, "on the way to a pole, F of one value there",
             "n' is that of the surface gradient down to the last place", "rad", 1e-7, 1e-14,
             "analytic fourier terms=1,1,0.3,0,-90\nsurface sphere\nrotate 15,0,0\nbump height=1"),
    GEOMETRY(03, "a pole under a table that has no one value there", "n' is of length 1 and finite",
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
             "the normal is the defined one and no picture of it holds a NaN", "violations", 0, 0,
             "table 64x64\ngrid cells=8x8 width=2\nsurface bezier "
             "points=0,0,0;0,0,0;0,0,0;0,0,0;0,0,0;0,0,0;0,0,0;"
             "0,0,0;0,0,0;0,0,0;0,0,0;0,0,0;0,0,0;0,0,0;0,0,0;0,0,0"),
    GEOMETRY(07, "a patch that is a straight line",
             "the normal is the defined one and no picture of it holds a NaN", "violations", 0, 0,
             "table 64x64\ngrid cells=8x8 width=2\nsurface bezier "
             "points=0,0,0;1,1,0;2,2,0;3,3,0;1,1,0;2,2,0;3,3,0;"
             "4,4,0;2,2,0;3,3,0;4,4,0;5,5,0;3,3,0;4,4,0;5,5,0;6,6,0"),
    GEOMETRY(08, "tori without a tube, without a hole, and through themselves",
             "n points away from the tube's centre line", "rad", 1e-6, 1e-14,
             "table 64x64\nnoise perlin cells=6\nsurface torus R=0.25 r=0.75\nbump height=0.3"),
    GEOMETRY(09, "objects 1e20 times as large and as small",
             "the scale-invariant n' stays; so does the paper's if heights grow alike", "rad", 1e-6,
             1e-13,
             "table 64x64\nnoise perlin cells=6\nsurface torus R=1e20 r=3e19\nbump height=2e19"),
    GEOMETRY(10, "Pu 1e10 times as long as Pv", "n stands upright on both", "last places", 4, 4,
             "table 64x64\ngrid cells=8x8 width=2\nsurface plane a=1 b=1e-10\nbump height=1e-12"),
    GEOMETRY(11, "Pu and Pv a thousandth to a millionth of a radian apart",
             "n is off by no more than rounding over the sine of their angle", "last places / sine",
             1, 1, NULL),
};
WR_HARD_LIST(surface, rows);
