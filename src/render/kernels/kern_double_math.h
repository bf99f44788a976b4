/* kern_double_math.h - transcendental functions in double for span loops.
   Private to the renderer. Branch-free, without library calls, built from + - * / and integer operations only,
   so that compilers vectorise them and every processor produces the same bits (the build forbids contraction).
   Arguments and meaning are those of base/kernmath.h. Series are Taylor's, except the arctangent's, which
   interpolates at Chebyshev nodes. */
#pragma once
#include "base/kernmath.h"

static inline double wr_bits_double(int64_t bits)
{
    union {
        int64_t i;
        double d;
    } u = { bits };
    return u.d;
}

static inline int64_t wr_double_bits(double value)
{
    union {
        double d;
        int64_t i;
    } u = { value };
    return u.i;
}

static inline bool wr_is_finite_r(double x)
{
    return (wr_double_bits(x) & INT64_MAX) < 0x7ff0000000000000;
}

static inline double wr_scale_down_r(double m)
{
    const int64_t power = wr_double_bits(m) & 0x7ff0000000000000, most = 0x7fd0000000000000;
    return wr_bits_double(0x7fe0000000000000 - (power < most ? power : most));
}

/* sin and cos of 2 pi u, u in turns, |u| < 2^30. Absolute error under 3e-16; exactly 0, 1 or -1 at whole,
   half and quarter turns. */
static inline void wr_sincos_turns_r(double u, double *sine, double *cosine)
{
    double r = u - floor(u + 0.5);
    double q = floor(4.0 * r + 0.5);
    double x = r - 0.25 * q, z = x * x; /* |x| <= 1/8 turn, exact */
    double s = -0.7181223017785006 + z * 0.10422916220813984;
    s = -15.09464257682299 + z * (3.819952584848282 + z * s);
    s = -76.70585975306139 + z * (42.058693944897655 + z * s);
    s = x * (6.283185307179586 + z * (-41.34170224039976 + z * (81.60524927607506 + z * s)));
    double c = 0.28200596845579123 + z * -0.03638284114254567;
    c = 7.903536371318469 + z * (-1.714390711088672 + z * c);
    c = 60.24464137187666 + z * (-26.4262567833744 + z * c);
    c = 64.9393940226683 + z * (-85.45681720669373 + z * c);
    c = 1.0 + z * (-19.739208802178716 + z * c);
    int32_t quarter = (int32_t)q;
    double a = (quarter & 1) ? c : s, b = (quarter & 1) ? s : c;
    *sine = (quarter & 2) ? -a : a;
    *cosine = ((quarter + 1) & 2) ? -b : b;
}

/* The angle of (x, y) in turns, 0 <= result < 1; 0 at the origin. Error under 2e-16 of a turn. */
static inline double wr_atan2_turns_r(double y, double x)
{
    double ax = fabs(x), ay = fabs(y);
    double small = ax < ay ? ax : ay, large = ax < ay ? ay : ax;
    double steep = small > 0.41421356237309503 * large ? 1.0 : 0.0;
    double num = steep != 0.0 ? small - large : small;
    double den = steep != 0.0 ? small + large : large;
    double t = num / (den > 0.0 ? den : 1.0), z = t * t;
    double p = -0.0053084005124697225 + z * 0.002399935132438367;
    p = -0.008303028862787809 + z * (0.007158828643931354 + z * p);
    p = -0.010609585760970845 + z * (0.009353180570301435 + z * p);
    p = -0.014468629518645564 + z * (0.012242644959034358 + z * p);
    p = -0.022736420441073282 + z * (0.017683882523887844 + z * p);
    p = -0.05305164769729843 + z * (0.0318309886183742 + z * p);
    double a = t * (0.15915494309189535 + z * p);
    a = steep != 0.0 ? 0.125 + a : a;
    a = ay > ax ? 0.25 - a : a;
    a = x < 0.0 ? 0.5 - a : a;
    a = y < 0.0 ? 1.0 - a : a;
    return a < 1.0 ? a : 0.0;
}

/* The angle of (x, y) in radians, -pi < result <= pi. */
static inline double wr_atan2_r(double y, double x)
{
    const double turns = wr_atan2_turns_r(y, x);
    return (turns > 0.5 ? turns - 1.0 : turns) * 6.283185307179586;
}

/* log2 of a positive normal number, whose 1 - x is `below` (wr_log2_below_f): 2 atanh((m - 1) / (m + 1)) / ln 2
   of its mantissa m in sqrt(1/2) .. sqrt(2). Relative error under 4e-16, also near 1. */
static inline double wr_log2_below_r(double x, double below)
{
    int64_t bits = wr_double_bits(x);
    int64_t e = (bits - 0x3fe6a09e667f3bcd) >> 52;
    double m = wr_bits_double(bits - (int64_t)((uint64_t)e << 52));
    double above = e == 0 ? -below : m - 1.0, f = above / (above + 2.0), z = f * f;
    double p = 0.1373995277037108 + z * 0.12545174268599682;
    p = 0.16972882833987804 + z * (0.15186263588304877 + z * p);
    p = 0.22195308321368667 + z * (0.19235933878519512 + z * p);
    p = 0.3205988979753252 + z * (0.2623081892525388 + z * p);
    p = 0.5770780163555853 + z * (0.4121985831111324 + z * p);
    p = 2.8853900817779268 + z * (0.9617966939259756 + z * p);
    return (double)(int32_t)e + f * p;
}

/* 2^x, clamped to x in -1022 .. 1023; relative error under 3e-16. */
static inline double wr_exp2_double(double x)
{
    x = x < -1022.0 ? -1022.0 : x;
    x = x > 1023.0 ? 1023.0 : x;
    double n = floor(x + 0.5), f = x - n;
    double p = 1.3691488853904128e-12 + f * 6.778726354822545e-14;
    p = 4.4455382718708116e-10 + f * (2.5678435993488206e-11 + f * p);
    p = 1.01780860092397e-07 + f * (7.054911620801123e-09 + f * p);
    p = 1.5252733804059841e-05 + f * (1.321548679014431e-06 + f * p);
    p = 0.0013333558146428443 + f * (0.0001540353039338161 + f * p);
    p = 0.05550410866482158 + f * (0.009618129107628477 + f * p);
    p = 1.0 + f * (0.6931471805599453 + f * (0.24022650695910072 + f * p));
    return wr_bits_double(wr_double_bits(p) + (int64_t)((uint64_t)(int64_t)(int32_t)n << 52));
}

/* x^s for 0 <= x <= 1 and s >= 0, as wr_pow_below_f. Values below 2^-1022 become 0. */
static inline double wr_pow_below_r(double x, double below, double s)
{
    below = below > 0.0 ? below : 0.0;
    x = x > 1.0 ? 1.0 : x;
    double tiny = x > 2.3e-308 ? x : 2.3e-308;
    double e = s * wr_log2_below_r(tiny, below);
    double p = wr_exp2_double(e);
    p = e < -1022.0 ? 0.0 : p;
    p = x > 2.3e-308 ? p : 0.0;
    return s > 0.0 ? p : 1.0;
}
