/* Hard cases of the bump formulas: beyond focal distances, extreme slopes, zero vectors. */
#include "hardcases/hardcases_internal.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "shade/bump.h"

#include <float.h>
#include <string.h>

static const WrVec3 zero = { 0, 0, 0 };

/* A regular point of a curved surface, in both precisions: the kernel's own numbers, converted to double. */
typedef struct Sample {
    WrSurfacePointf single;
    WrSurfacePoint at; /* n in double from the same tangents */
} Sample;

static Sample sample_of(WrHardGauge *g, int i)
{
    static const WrSurfaceKind kinds[] = { WR_SURFACE_bent,   WR_SURFACE_bezier,
                                           WR_SURFACE_sphere, WR_SURFACE_cylinder,
                                           WR_SURFACE_torus,  WR_SURFACE_ribbon };
    const WrShape shape = wr_hard_shape(kinds[i % 6]);
    const double u = wr_hard_between(g, 0.1, 0.9), v = wr_hard_between(g, 0.1, 0.9);
    Sample s;
    wr_surface_at(&shape, 0, u, v, &s.at);
    s.single = wr_hard_narrow(&s.at);
    return s;
}

static Sample plane_point(void)
{
    const WrShape plane = wr_hard_shape(WR_SURFACE_plane);
    Sample s;
    wr_surface_at(&plane, 0, 0.25, 0.75, &s.at);
    s.single = wr_hard_narrow(&s.at);
    return s;
}

static void angles(WrHardGauge *g, const Sample *s, WrBumpMode mode, WrHardSlope slope, WrVec3 want)
{
    wr_hard_off(g, WR_HARD_DOUBLE, v3_angle_rad(wr_hard_perturbed(mode, &s->at, slope), want));
    for (int set = 0; set < g->sets; set++)
        wr_hard_off(
            g, WR_HARD_FLOAT,
            v3_angle_rad(wr_hard_perturbed_f(g, set, mode, &s->single, slope, false), want));
}

static bool hc13(WrHardGauge *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 64; i++) {
        const bool ball = i % 2;
        const WrShape shape = wr_hard_shape(ball ? WR_SURFACE_sphere : WR_SURFACE_cylinder);
        const float u = wr_hard_float(g), v = 0.25f + 0.5f * wr_hard_float(g);
        Sample s;
        wr_surface_at(&shape, 0, (double)u, (double)v, &s.at);
        s.single = wr_hard_narrow(&s.at);
        const WrVec3 want = ball ? s.at.n_unit : v3_neg(s.at.n_unit);
        angles(g, &s, WR_BUMP_EXACT, (WrHardSlope){ -1.5 - 0.25 * i, 0, 0 }, want);
    }
    return true;
}

static bool hc14(WrHardGauge *g, WrError *err)
{
    (void)err;
    const Sample s = plane_point();
    const WrHardSlope slope = { 1e30, 0, 0 };
    for (int mode = 0; mode < WR_BUMP_COUNT; mode++) {
        WrVec3 perturbed = wr_hard_perturbed((WrBumpMode)mode, &s.at, slope);
        wr_hard_holds(g, WR_HARD_DOUBLE, wr_hard_same(perturbed, s.at.n_unit));
        for (int set = 0; set < g->sets; set++) {
            perturbed = wr_hard_perturbed_f(g, set, (WrBumpMode)mode, &s.single, slope, false);
            wr_hard_holds(g, WR_HARD_FLOAT, wr_hard_same(perturbed, s.at.n_unit));
        }
    }
    return true;
}

/* On any surface, slopes of any direction up to the precision's largest number: N' consists of D only. The
   tangents are those of the float point; in double they are up to 1e30 long, so that D overflows for all slopes. */
static void check_steep(WrHardGauge *g, int i)
{
    static const double most[] = { 1e30, 1e38, (double)FLT_MAX };
    const WrBumpMode mode = (WrBumpMode)(WR_BUMP_BLINN + i % 3);
    const double a = wr_hard_between(g, -1, 1), b = wr_hard_between(g, -1, 1);
    const double size = most[i / 3 % 3];
    Sample s = sample_of(g, i);
    s.single.n_u = s.single.n_v = (WrVec3f){ 0, 0, 0 }; /* F = 0 */
    s.at = wr_hard_widen(&s.single);
    s.at.n_u = s.at.n_v = zero;
    const WrVec3 d = wr_bump_d(s.at.n_unit, s.at.pu, s.at.pv, a, b);
    for (int set = 0; set < g->sets; set++) {
        const WrHardSlope slope = { 0, size * a, size * b };
        const WrVec3 perturbed = wr_hard_perturbed_f(g, set, mode, &s.single, slope, false);
        wr_hard_off(g, WR_HARD_FLOAT, v3_angle_rad(perturbed, d));
    }
    s.at.pu = v3_scale(s.at.pu, 1e30), s.at.pv = v3_scale(s.at.pv, 1e30);
    s.at.n = v3_scale(s.at.n, 1e60), s.at.n_len *= 1e60;
    const WrHardSlope slope = { 0, DBL_MAX * a, DBL_MAX * b };
    wr_hard_off(g, WR_HARD_DOUBLE, v3_angle_rad(wr_hard_perturbed(mode, &s.at, slope), d));
}

/* On the unit plane the downhill direction is -(Fu, Fv). */
static bool hc15(WrHardGauge *g, WrError *err)
{
    (void)err;
    static const double steep[] = { 1e30, 1e38, 3e38, 1e154, DBL_MAX };
    const Sample s = plane_point();
    const WrVec3 down = v3_unit((WrVec3){ -1, 0.5, 0 }, zero);
    for (int i = 0; i < 5; i++)
        for (int mode = WR_BUMP_BLINN; mode < WR_BUMP_COUNT; mode++) {
            const WrHardSlope slope = { 0.1, steep[i], -steep[i] / 2 };
            WrVec3 perturbed = wr_hard_perturbed((WrBumpMode)mode, &s.at, slope);
            wr_hard_off(g, WR_HARD_DOUBLE, v3_angle_rad(perturbed, down));
            for (int set = 0; set < g->sets && i < 3; set++) {
                perturbed = wr_hard_perturbed_f(g, set, (WrBumpMode)mode, &s.single, slope, false);
                wr_hard_off(g, WR_HARD_FLOAT, v3_angle_rad(perturbed, down));
            }
        }
    for (int i = 0; i < 600; i++) check_steep(g, i);
    return true;
}

/* The largest difference of a component, in ulps of numbers near 1. */
static double places(WrVec3 a, WrVec3 b, double ulp)
{
    const WrVec3 d = v3_sub(a, b);
    return fmax(fmax(fabs(d.x), fabs(d.y)), fabs(d.z)) / ulp;
}

static bool hc16(WrHardGauge *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 120; i++) {
        const Sample s = sample_of(g, i);
        for (int mode = WR_BUMP_BLINN; mode < WR_BUMP_COUNT; mode++) {
            const WrHardSlope slope = { 0, 1e-30, -1e-30 };
            WrVec3 perturbed = wr_hard_perturbed((WrBumpMode)mode, &s.at, slope);
            wr_hard_off(g, WR_HARD_DOUBLE, places(perturbed, s.at.n_unit, 0x1p-52));
            for (int set = 0; set < g->sets; set++) {
                perturbed = wr_hard_perturbed_f(g, set, (WrBumpMode)mode, &s.single, slope, false);
                wr_hard_off(g, WR_HARD_FLOAT,
                            places(perturbed, wr_hard_vec(s.single.n_unit), 0x1p-23));
            }
        }
    }
    return true;
}

static bool hc17(WrHardGauge *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 120; i++) {
        const Sample s = sample_of(g, i);
        for (int mode = 0; mode < WR_BUMP_COUNT; mode++) {
            const double none = i % 2 ? -0.0 : 0.0, f = mode == WR_BUMP_EXACT ? 0.0 : 0.25;
            const WrHardSlope slope = { f, none, 0 };
            const WrVec3 perturbed = wr_hard_perturbed((WrBumpMode)mode, &s.at, slope);
            const WrVec3 n = wr_bump_normal((WrBumpMode)mode, s.at.n, s.at.n_unit, s.at.pu, s.at.pv,
                                            s.at.n_u, s.at.n_v, f, none, 0);
            wr_hard_holds(g, WR_HARD_DOUBLE,
                          memcmp(&perturbed, &s.at.n_unit, sizeof perturbed) == 0);
            wr_hard_holds(g, WR_HARD_DOUBLE, memcmp(&n, &s.at.n, sizeof n) == 0);
            for (int set = 0; set < g->sets; set++) {
                WrVec3 got = wr_hard_perturbed_f(g, set, (WrBumpMode)mode, &s.single, slope, false);
                wr_hard_holds(g, WR_HARD_FLOAT, wr_hard_same(got, wr_hard_vec(s.single.n_unit)));
            }
        }
    }
    return true;
}

/* tan(theta') / a - 1, on the unit plane: n' = (-Fu, -Fv, 1) up to length. */
static bool hc18(WrHardGauge *g, WrError *err)
{
    (void)err;
    static const double slopes[] = { 1e-25, 1e-12, 1e-170, 1e-300 };
    const Sample s = plane_point();
    for (int i = 0; i < 4; i++) {
        const double a = slopes[i];
        const WrHardSlope slope = { 0, 0.6 * a, 0.8 * a };
        WrVec3 perturbed = wr_hard_perturbed(WR_BUMP_INVARIANT, &s.at, slope);
        wr_hard_off(g, WR_HARD_DOUBLE,
                    fabs(hypot(perturbed.x / a, perturbed.y / a) / perturbed.z - 1.0));
        for (int set = 0; set < g->sets && i < 2; set++) {
            perturbed = wr_hard_perturbed_f(g, set, WR_BUMP_INVARIANT, &s.single, slope, false);
            wr_hard_off(g, WR_HARD_FLOAT,
                        fabs(hypot(perturbed.x / a, perturbed.y / a) / perturbed.z - 1.0));
        }
    }
    return true;
}

static double tangent(WrVec3 a, WrVec3 b)
{
    return v3_len(v3_cross(a, b)) / v3_dot(a, b);
}

/* In float up to the last number before the pole. */
static bool hc19(WrHardGauge *g, WrError *err)
{
    (void)err;
    static const double slopes[][2] = { { 0.5, 0 }, { 0, 0.5 }, { 0.3, -0.4 } };
    for (int i = 0; i < 3; i++)
        for (int k = 4; k <= 54; k++)
            for (int j = 0; j < 16; j++) {
                const WrShape shape = wr_hard_shape(j % 2 ? WR_SURFACE_cone : WR_SURFACE_sphere);
                const double v = k == 54 ? 1.0 : 1.0 - ldexp(1.0, -k), u = j / 16.0;
                const WrHardSlope slope = { 0, slopes[i][0], slopes[i][1] };
                const double a = hypot(slope.fu, slope.fv);
                WrSurfacePoint at;
                wr_surface_at(&shape, 0, u, v, &at);
                WrVec3 perturbed = wr_hard_perturbed(WR_BUMP_INVARIANT, &at, slope);
                wr_hard_off(g, WR_HARD_DOUBLE, fabs(tangent(at.n_unit, perturbed) / a - 1.0));
                for (int set = 0; set < g->sets && k <= 24; set++) {
                    WrSurfacePointf atf = wr_hard_point(g, set, &shape, 1.0, 0, (float)u, (float)v);
                    perturbed = wr_hard_perturbed_f(g, set, WR_BUMP_INVARIANT, &atf, slope, false);
                    wr_hard_off(g, WR_HARD_FLOAT,
                                fabs(tangent(wr_hard_vec(atf.n_unit), perturbed) / a - 1.0));
                }
            }
    return true;
}

/* Equal directions have the angle 0, in whatever precision they were computed; small angles are preserved. */
static bool hc20(WrHardGauge *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 200; i++) {
        const Sample s = sample_of(g, i);
        const WrVec3 single = wr_hard_vec(s.single.n_unit);
        wr_hard_off(g, WR_HARD_DOUBLE, v3_angle_rad(s.at.n_unit, s.at.n_unit));
        wr_hard_off(g, WR_HARD_FLOAT, v3_angle_rad(single, single));
        const double little = ldexp(1.0, -1 - i % 60);
        const WrVec3 a = { 0, 0, 1 }, b = { sin(little), 0, cos(little) };
        wr_hard_near(g, WR_HARD_DOUBLE, v3_angle_rad(a, b), little);
    }
    return true;
}

/* Kernels: without tangents, and with infinite ones, the result is n; tangents at right angles of length 1e-40
   to 1e37, slope 1: the formulas' result. */
static void kernels_make_unit(WrHardGauge *g)
{
    static const double sizes[] = { 0, 1e-40, 1e-30, 1e-20, 1, 1e10, INFINITY };
    const WrVec3 z = { 0, 0, 1 }, halfway = { -1, 0, 1 }, across = { -1, 0, 0 };
    for (int i = 0; i < 7 * (WR_BUMP_COUNT - 1); i++) {
        const float t = (float)sizes[i % 7];
        const WrBumpMode mode = (WrBumpMode)(WR_BUMP_BLINN + i / 7);
        const WrSurfacePointf at = {
            .pu = { t, 0, 0 }, .pv = { 0, t, 0 }, .n_unit = { 0, 0, 1 }, .n_len = t
        };
        /* |N| is set to t, so that D has it too; exact computes it from the tangents: t^2 instead of t */
        const double flat = (double)t * (double)t;
        const bool none = !(t > 0.0f && isfinite(t));
        WrVec3 want = none ? z : halfway;
        if (mode == WR_BUMP_EXACT && !none) want = (WrVec3){ -1, 0, flat > 1e-12 ? (double)t : 0 };
        if (mode == WR_BUMP_EXACT && !none && flat <= 1e-12) want = across;
        /* fast arithmetic estimates reciprocals, which denormal numbers do not have */
        const int sets = t > 0.0f && t < FLT_MIN ? g->sets : g->all;
        for (int set = 0; set < sets; set++) {
            WrVec3 perturbed =
                wr_hard_perturbed_f(g, set, mode, &at, (WrHardSlope){ 0, 1, 0 }, false);
            wr_hard_holds(g, WR_HARD_FLOAT, fabs(v3_len(perturbed) - 1.0) < 1e-6);
            wr_hard_holds(g, WR_HARD_FLOAT, v3_angle_rad(perturbed, want) < 1e-4);
        }
    }
}

/* Normalisation by the formulas: tangents of any size and of different lengths, compared with the vector's
   direction. */
static void formulas_make_unit(WrHardGauge *g, WrVec3 n)
{
    for (int i = 0; i < 600; i++) {
        const WrVec3 a = { wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1),
                           wr_hard_between(g, -1, 1) };
        const WrVec3 far = v3_scale(a, ldexp(1.0, i - 300));
        wr_hard_holds(g, WR_HARD_DOUBLE, v3_angle_rad(wr_bump_unit(far, n), a) < 1e-15 * 4);
    }
}

static bool hc21(WrHardGauge *g, WrError *err)
{
    (void)err;
    static const WrVec3 useless[] = {
        { 0, 0, 0 }, { INFINITY, 0, 0 }, { NAN, 1, 2 }, { 0, -INFINITY, NAN }
    };
    const WrVec3 n = { 0.6, 0, 0.8 };
    for (int i = 0; i < 4; i++)
        wr_hard_holds(g, WR_HARD_DOUBLE, wr_hard_same(wr_bump_unit(useless[i], n), n));
    const WrVec3 tiny = wr_bump_unit((WrVec3){ 3e-310, 0, -4e-310 }, n);
    wr_hard_holds(g, WR_HARD_DOUBLE, v3_angle_rad(tiny, (WrVec3){ 0.6, 0, -0.8 }) < 1e-12);
    const WrVec3 huge = wr_bump_unit((WrVec3){ DBL_MAX, DBL_MAX, 0 }, n);
    wr_hard_holds(g, WR_HARD_DOUBLE, v3_angle_rad(huge, (WrVec3){ 1, 1, 0 }) < 1e-15);
    formulas_make_unit(g, n);
    kernels_make_unit(g);
    return true;
}

static bool hc22(WrHardGauge *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 300; i++) {
        const Sample s = sample_of(g, i);
        const double fu = (double)(2.0f * wr_hard_float(g) - 1.0f);
        const double fv = (double)(2.0f * wr_hard_float(g) - 1.0f);
        const WrVec3 d = wr_bump_d(s.at.n_unit, s.at.pu, s.at.pv, fu, fv);
        const WrVec3 swapped = wr_bump_normal(WR_BUMP_BLINN, v3_neg(s.at.n), v3_neg(s.at.n_unit),
                                              s.at.pv, s.at.pu, zero, zero, 0, fv, fu);
        wr_hard_off(g, WR_HARD_DOUBLE, v3_len(v3_sub(swapped, v3_sub(d, s.at.n))));
        WrSurfacePointf turned = s.single;
        turned.pu = s.single.pv;
        turned.pv = s.single.pu;
        turned.n_unit = v3f_neg(s.single.n_unit);
        const WrSurfacePoint wide = wr_hard_widen(&s.single);
        const WrVec3 n = v3_scale(wide.n_unit, wide.n_len);
        const WrVec3 want =
            v3_unit(v3_sub(wr_bump_d(wide.n_unit, wide.pu, wide.pv, fu, fv), n), zero);
        for (int set = 0; set < g->sets; set++) {
            WrVec3 got = wr_hard_perturbed_f(g, set, WR_BUMP_BLINN, &turned,
                                             (WrHardSlope){ 0, fv, fu }, false);
            wr_hard_off(g, WR_HARD_FLOAT, v3_angle_rad(got, want));
        }
    }
    return true;
}

static WrVec3 displaced(const WrShape *shape, double u, double v, double *f, double *fu, double *fv)
{
    double s, c, sv, cv;
    WrSurfacePoint at;
    wr_surface_at(shape, 0, u, v, &at);
    wr_sincos_turns(3.0 * u, &s, &c);
    wr_sincos_turns(2.0 * v, &sv, &cv);
    const double f_here = 0.03 * s * cv;
    if (f) {
        *f = f_here;
        *fu = 0.18 * WR_PI * c * cv;
        *fv = -0.12 * WR_PI * s * sv;
    }
    return v3_mad(at.p, at.n_unit, f_here);
}

/* The reference is the displaced surface's own cross product, by central differences of order four: steps of
   1e-3 have an error of (2 pi 3 1e-3)^4 / 30 = 4e-9 of a slope, and 1e-13 of rounding. */
static bool hc23(WrHardGauge *g, WrError *err)
{
    (void)err;
    static const WrSurfaceKind kinds[] = { WR_SURFACE_sphere, WR_SURFACE_torus, WR_SURFACE_cylinder,
                                           WR_SURFACE_bent };
    for (int i = 0; i < 200; i++) {
        const WrShape shape = wr_hard_shape(kinds[i % 4]);
        const double u = wr_hard_between(g, 0.1, 0.9), v = wr_hard_between(g, 0.2, 0.8), h = 1e-3;
        double f, fu, fv;
        WrVec3 slope[2];
        for (int axis = 0; axis < 2; axis++) {
            const double du = axis ? 0 : h, dv = axis ? h : 0;
            WrVec3 near = v3_sub(displaced(&shape, u + du, v + dv, NULL, NULL, NULL),
                                 displaced(&shape, u - du, v - dv, NULL, NULL, NULL));
            WrVec3 far = v3_sub(displaced(&shape, u + 2 * du, v + 2 * dv, NULL, NULL, NULL),
                                displaced(&shape, u - 2 * du, v - 2 * dv, NULL, NULL, NULL));
            slope[axis] = v3_sub(v3_scale(near, 8.0), far);
        }
        const WrVec3 front = v3_unit(v3_cross(slope[0], slope[1]), zero);
        displaced(&shape, u, v, &f, &fu, &fv);
        Sample s;
        wr_surface_at(&shape, 0, u, v, &s.at);
        s.single = wr_hard_narrow(&s.at);
        const WrHardSlope here = { f, fu, fv };
        angles(g, &s, WR_BUMP_EXACT, here, front);
        for (int set = 0; set < g->sets; set++) {
            WrVec3 back = wr_hard_perturbed_f(g, set, WR_BUMP_EXACT, &s.single, here, true);
            wr_hard_off(g, WR_HARD_FLOAT, v3_angle_rad(back, v3_neg(front)));
        }
    }
    return true;
}

#define BUMP(number, situation, rule, u, in_float, in_double, script)                              \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_GEOMETRY, .what = situation, .holds = rule,         \
        .unit = u, .bound = { in_float, in_double }, .measure = hc##number, .scene = script        \
    }
#define WAVES "table 64x64\nformula fourier terms=3,0,0.5;0,5,0.25,90,0\n"
static const WrHardCase rows[] = {
    BUMP(13, "exact normals beyond the focal distance",
         "n turns over with the sign of the determinant: not on the sphere, but on the cylinder",
         "rad", 2e-6, 1e-13,
         "table 64x64\nfill 1\nsurface cylinder\nbump mode=exact scheme=bspline height=-1.5"),
    BUMP(14, "a height of 1e30 without a slope, on a plane", "n to the bit in every mode",
         "violations", 0, 0, "table 64x64\nfill 1\nsurface plane\nbump mode=exact height=1e30"),
    BUMP(15, "slopes whose square overflows", "n' points straight downhill", "rad", 1e-6, 1e-14,
         "table 64x64\nformula fourier terms=3,0,1e18;0,5,5e17,90,0\nsurface plane\nbump "
         "height=1e19"),
    BUMP(16, "slopes whose square underflows", "n' is n", "last places", 1, 1,
         WAVES "surface torus\nbump height=1e-31"),
    BUMP(17, "no slope at all", "N' is N to the bit in every mode", "violations", 0, 0,
         "table 64x64\nfill 0.5\nsurface torus\nbump mode=invariant"),
    BUMP(18, "scale-invariant normals of slopes whose square underflows",
         "the tangent of the tilt is still the slope", "relative", 1e-6, 1e-14,
         WAVES "surface plane\nbump mode=invariant height=1e-25"),
    BUMP(19, "scale-invariant normals at poles and tips",
         "the tangent of the tilt is the slope on every approach", "relative", 4e-6, 1e-12,
         WAVES "surface sphere\nrotate 15,0,0\nbump mode=invariant height=0.1"),
    BUMP(20, "the angle between equal normals", "0, and small angles are kept", "rad", 0, 1e-15,
         NULL),
    BUMP(21, "a normal of length 0, denormal, infinite or NaN made unit",
         "a unit vector, and n where there is no direction", "violations", 0, 0, NULL),
    BUMP(22, "u and v exchanged", "N' is -N + D: dents become bumps", "rad", 1e-6, 0,
         WAVES "surface bent\nbump height=0.03"),
    BUMP(23, "the exact normal from the front and from behind",
         "that of the displaced surface, turned towards the eye", "rad", 2e-6, 1e-6,
         WAVES "surface bent\nrotate 0,180,0\nbump mode=exact scheme=bspline height=0.03"),
};
WR_HARD_LIST(bump, rows);
