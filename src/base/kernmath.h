/* kernmath.h - single-precision transcendental functions for loops over spans.

   They are free of branches and library calls, so that compilers vectorise them, and use only + - * /
   sqrt and integer operations, so that every processor returns the same bits (the build forbids
   contraction). Polynomials: interpolation at Chebyshev nodes, checked in tests/base/test_base.c. */
#pragma once
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

static inline float wr_bits_float(int32_t bits)
{
    union {
        int32_t i;
        float f;
    } u = { bits };
    return u.f;
}

static inline int32_t wr_float_bits(float value)
{
    union {
        float f;
        int32_t i;
    } u = { value };
    return u.i;
}

/* Tests the bits: a compiler that assumes finite numbers cannot remove this test. */
static inline bool wr_is_finite_f(float x)
{
    return (wr_float_bits(x) & INT32_MAX) < 0x7f800000;
}

/* A power of two that scales m, finite and not negative, below 4, and any m > 0 to at least 2^-22. */
static inline float wr_scale_down_f(float m)
{
    const int32_t power = wr_float_bits(m) & 0x7f800000,
                  most = 0x7e800000; /* 2^126: its reciprocal is normal */
    return wr_bits_float(0x7f000000 - (power < most ? power : most));
}

/* The nearest IEEE binary16, ties to even; at most 65504, which infinities and NaN become too. */
static inline float wr_round_half(float x)
{
    const int32_t bits = wr_float_bits(x), sign = bits & INT32_MIN, all = bits & INT32_MAX;
    const int32_t most = 0x477fe000, size = all < most ? all : most; /* 65504 */
    const int32_t near = (size + 0xfff + (size >> 13 & 1)) & ~0x1fff;
    /* Below 2^-14 the spacing is 2^-24, the last bit of 1/2. */
    const int32_t low = wr_float_bits((wr_bits_float(size) + 0.5f) - 0.5f);
    return wr_bits_float(sign | (size < 0x38800000 ? low : near));
}

/* sin and cos of 2 pi u, u in turns, |u| < 2^21. Absolute error under 1.2e-7; exactly 0, 1 or -1 at
   whole, half and quarter turns. */
static inline void wr_sincos_turns_f(float u, float *sine, float *cosine)
{
    float r = u - floorf(u + 0.5f);
    float q = floorf(4.0f * r + 0.5f);
    float x = r - 0.25f * q, z = x * x; /* |x| <= 1/8 turn, exact */
    float s = x * (6.28318548f +
                   z * (-41.3417015f + z * (81.6052017f + z * (-76.6978683f + z * 41.4728317f))));
    float c = 1.0f + z * (-19.7392082f + z * (64.9393158f + z * (-85.4428482f + z * 59.2201691f)));
    int32_t quarter = (int32_t)q;
    float a = (quarter & 1) ? c : s, b = (quarter & 1) ? s : c;
    *sine = (quarter & 2) ? -a : a;
    *cosine = ((quarter + 1) & 2) ? -b : b;
}

/* The angle of (x, y) in turns, 0 <= result < 1; 0 at the origin. Error under 1e-7 of a turn,
   relative near 0. */
static inline float wr_atan2_turns_f(float y, float x)
{
    float ax = fabsf(x), ay = fabsf(y);
    float small = ax < ay ? ax : ay, large = ax < ay ? ay : ax;
    float steep = small > 0.41421356f * large ? 1.0f : 0.0f; /* angle above 1/16 turn */
    float num = steep != 0.0f ? small - large : small;
    float den = steep != 0.0f ? small + large : large;
    /* The smallest normal number replaces 0: a conditional would mask the division, which is slow. */
    float t = num / (den > 1.17549435e-38f ? den : 1.17549435e-38f), z = t * t;
    float a = t * (0.159154937f +
                   z * (-0.0530516058f +
                        z * (0.031828098f +
                             z * (-0.0226629209f + z * (0.0168224052f + z * -0.00959116314f)))));
    a = steep != 0.0f ? 0.125f + a : a;
    a = ay > ax ? 0.25f - a : a;
    a = x < 0.0f ? 0.5f - a : a;
    a = y < 0.0f ? 1.0f - a : a;
    return a < 1.0f ? a : 0.0f;
}

/* The angle of (x, y) in radians, -pi < result <= pi. */
static inline float wr_atan2_f(float y, float x)
{
    const float turns = wr_atan2_turns_f(y, x);
    return (turns > 0.5f ? turns - 1.0f : turns) * 6.28318548f;
}

/* log2 of a positive normal number x, given `below` = 1 - x. Near 1 the result depends on `below`; x
   alone would limit it to 6e-8 absolute. Relative error under 1.5e-7 of the true log2(1 - below) for x
   from 0.71 to 1.41. */
static inline float wr_log2_below_f(float x, float below)
{
    int32_t bits = wr_float_bits(x);
    int32_t e = (bits - 0x3f3504f3) >> 23; /* mantissa reduced to sqrt(1/2) .. sqrt(2) */
    float f = wr_bits_float(bits - (int32_t)((uint32_t)e << 23)) - 1.0f;
    f = e == 0 ? -below : f;
    float p = 1.44269502f +
              f * (-0.721347332f +
                   f * (0.480898529f +
                        f * (-0.360696554f +
                             f * (0.288552552f +
                                  f * (-0.239608124f +
                                       f * (0.204857647f +
                                            f * (-0.191388384f +
                                                 f * (0.184760332f + f * -0.107497893f))))))));
    return (float)e + f * p;
}

/* log2 of a positive normal number; relative error under 1.5e-7, also near 1. */
static inline float wr_log2_f(float x)
{
    return wr_log2_below_f(x, 1.0f - x);
}

/* 2^x, clamped to x in -126 .. 127; relative error under 1e-7. */
static inline float wr_exp2_f(float x)
{
    x = x < -126.0f ? -126.0f : x;
    x = x > 127.0f ? 127.0f : x;
    float n = (float)((int32_t)(x + 126.5f) - 126), f = x - n; /* the nearest integer */
    float p =
        1.0f + f * (0.693147182f +
                    f * (0.240226507f +
                         f * (0.0555032715f +
                              f * (0.00961805694f + f * (0.0013400428f + f * 0.000154614449f)))));
    return wr_bits_float(wr_float_bits(p) + (int32_t)((uint32_t)(int32_t)n << 23));
}

/* x^s for 0 <= x <= 1 and s >= 0, with 1 - x as `below`: pow(0,0) = 1, pow(0,s) = 0, result 0..1 (HC89,
   HC90). Values below 2^-100 become 0: they are invisible, and their products must not become denormal,
   which is slow. */
static inline float wr_pow_below_f(float x, float below, float s)
{
    below = below > 0.0f ? below : 0.0f;
    x = x > 1.0f ? 1.0f : x;
    float tiny = x > 1.2e-38f ? x : 1.2e-38f;
    float e = s * wr_log2_below_f(tiny, below);
    float p = wr_exp2_f(e);
    p = e < -100.0f ? 0.0f : p;
    p = x > 1.2e-38f ? p : 0.0f;
    return s > 0.0f ? p : 1.0f;
}

static inline float wr_pow01_f(float x, float s)
{
    return wr_pow_below_f(x, 1.0f - x, s);
}
