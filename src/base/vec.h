/* vec.h - three-component vectors in double (WrVec3, v3_) and float (WrVec3f, v3f_).

   The generic names v_add, v_cross, ... select by the type of the first vector, so that a formula is
   written once and compiled in both precisions. */
#pragma once
#include <float.h>
#include <math.h>
#include <stdbool.h>

typedef struct WrVec3 {
    double x, y, z;
} WrVec3;
typedef struct WrVec3f {
    float x, y, z;
} WrVec3f;

#define WR_VEC_FUNCTIONS(V, R, p)                                                                  \
    static inline V p##_add(V a, V b)                                                              \
    {                                                                                              \
        return (V){ a.x + b.x, a.y + b.y, a.z + b.z };                                             \
    }                                                                                              \
    static inline V p##_sub(V a, V b)                                                              \
    {                                                                                              \
        return (V){ a.x - b.x, a.y - b.y, a.z - b.z };                                             \
    }                                                                                              \
    static inline V p##_neg(V a)                                                                   \
    {                                                                                              \
        return (V){ -a.x, -a.y, -a.z };                                                            \
    }                                                                                              \
    static inline V p##_scale(V a, R s)                                                            \
    {                                                                                              \
        return (V){ a.x * s, a.y * s, a.z * s };                                                   \
    }                                                                                              \
    static inline V p##_mad(V a, V b, R s) /* a + b s */                                           \
    {                                                                                              \
        return (V){ a.x + b.x * s, a.y + b.y * s, a.z + b.z * s };                                 \
    }                                                                                              \
    static inline R p##_dot(V a, V b)                                                              \
    {                                                                                              \
        return a.x * b.x + a.y * b.y + a.z * b.z;                                                  \
    }                                                                                              \
    static inline V p##_cross(V a, V b)                                                            \
    {                                                                                              \
        return (V){ a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };         \
    }
WR_VEC_FUNCTIONS(WrVec3, double, v3)
WR_VEC_FUNCTIONS(WrVec3f, float, v3f)
#undef WR_VEC_FUNCTIONS

#define v_add(a, b) _Generic((a), WrVec3 : v3_add, WrVec3f : v3f_add)(a, b)
#define v_sub(a, b) _Generic((a), WrVec3 : v3_sub, WrVec3f : v3f_sub)(a, b)
#define v_neg(a) _Generic((a), WrVec3 : v3_neg, WrVec3f : v3f_neg)(a)
#define v_scale(a, s) _Generic((a), WrVec3 : v3_scale, WrVec3f : v3f_scale)(a, s)
#define v_mad(a, b, s) _Generic((a), WrVec3 : v3_mad, WrVec3f : v3f_mad)(a, b, s)
#define v_dot(a, b) _Generic((a), WrVec3 : v3_dot, WrVec3f : v3f_dot)(a, b)
#define v_cross(a, b) _Generic((a), WrVec3 : v3_cross, WrVec3f : v3f_cross)(a, b)

/* True if squares of numbers of this size are far from overflow and underflow. Then scaling is not
   needed; scaling by a power of two would not change any bit. */
static inline bool v3_is_tame(double largest)
{
    return largest > 0x1p-200 && largest < 0x1p200;
}

/* |a| without overflow or underflow: exact scaling by a power of two first. Non-finite input yields a
   non-finite result. */
static inline double v3_len(WrVec3 a)
{
    double m = fabs(a.x);
    if (fabs(a.y) > m) m = fabs(a.y);
    if (fabs(a.z) > m) m = fabs(a.z);
    if (v3_is_tame(m)) return sqrt(v3_dot(a, a));
    if (!(m > 0.0) || !(m <= 1.79e308)) return m; /* 0, infinite, NaN */
    int e = ilogb(m);
    WrVec3 b = { scalbn(a.x, -e), scalbn(a.y, -e), scalbn(a.z, -e) };
    return scalbn(sqrt(v3_dot(b, b)), e);
}

static inline WrVec3 v3_load(const float p[3])
{
    return (WrVec3){ (double)p[0], (double)p[1], (double)p[2] };
}

/* a / |a|, or `fallback` where a is zero or not finite. Safe at any scale, denormals included. */
static inline WrVec3 v3_unit(WrVec3 a, WrVec3 fallback)
{
    double m = fabs(a.x);
    if (fabs(a.y) > m) m = fabs(a.y);
    if (fabs(a.z) > m) m = fabs(a.z);
    if (!(m > 0.0)) return fallback;
    if (!(fabs(a.x) <= DBL_MAX && fabs(a.y) <= DBL_MAX && fabs(a.z) <= DBL_MAX)) return fallback;
    WrVec3 b = a;
    if (!v3_is_tame(m)) {
        int e = ilogb(m);
        b = (WrVec3){ scalbn(a.x, -e), scalbn(a.y, -e), scalbn(a.z, -e) };
    }
    /* Divided, not multiplied by a reciprocal: sqrt(x x) is |x|, so that a vector along an axis becomes
     * exactly 1. */
    double len = sqrt(v3_dot(b, b));
    return (WrVec3){ b.x / len, b.y / len, b.z / len };
}

/* The angle between a and b in radians, 0..pi; atan2(|a x b|, a.b) keeps small angles (HC20). */
static inline double v3_angle_rad(WrVec3 a, WrVec3 b)
{
    return atan2(v3_len(v3_cross(a, b)), v3_dot(a, b));
}

static inline WrVec3f v3f_from(WrVec3 a)
{
    return (WrVec3f){ (float)a.x, (float)a.y, (float)a.z };
}

/* Component-wise product. */
static inline WrVec3 v3_times(WrVec3 a, WrVec3 b)
{
    return (WrVec3){ a.x * b.x, a.y * b.y, a.z * b.z };
}
