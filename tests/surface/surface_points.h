/* surface_points.h - shared helpers of the surface tests: the formulas in both precisions, and members of a
   point by index. */
#pragma once
#include "surface/precision.h"
#include "surface/surface.h"

/* The same formulas in single precision. */
#define WR_FORMULA_FLOAT
#include "surface/precision.h"
#define WR_SURFACE_FORMULAS
#include "surface/surface_list.h"
#undef WR_SURFACE_FORMULAS

typedef void (*FloatAt)(const WrShapef *, int, float, float, WrSurfacePointf *);
static const FloatAt float_at[WR_SURFACE_COUNT] = {
#define WR_X(name) [WR_SURFACE_##name] = name##_at_f,
#include "surface/surface_list.h"
};

/* Members of a point by index, in either precision: P Pu Pv Puu Puv Pvv N n n_u n_v. */
enum { P, PU, PV, PUU, PUV, PVV, N, UNIT, NU, NV, MEMBERS };
static const char *const member_names[MEMBERS] = { "P",   "Pu", "Pv", "Puu", "Puv",
                                                   "Pvv", "N",  "n",  "n_u", "n_v" };
static inline WrVec3 member(const WrSurfacePoint *o, int which)
{
    return (&o->p)[which];
}
static inline WrVec3 member_f(const WrSurfacePointf *o, int which)
{
    WrVec3f a = (&o->p)[which];
    return (WrVec3){ (double)a.x, (double)a.y, (double)a.z };
}

/* Evaluate the same numbers in both precisions; u and v are exact in float. */
static inline void both(const WrShape *shape, int face, float u, float v, WrSurfacePoint *o,
                        WrSurfacePointf *of)
{
    WrShapef single;
    WrShape rounded = *shape;
    wr_shape_scaled(shape, 1, &single);
    for (int i = 0; i < WR_SURFACE_VALUES; i++) rounded.value[i] = (double)single.value[i];
    wr_surface_at(&rounded, face, (double)u, (double)v, o);
    float_at[shape->kind](&single, face, u, v, of);
}

static inline bool all_finite(const WrSurfacePoint *o)
{
    bool good = isfinite(o->n_len);
    for (int m = 0; m < MEMBERS; m++) {
        WrVec3 a = member(o, m);
        good = good && isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
    }
    return good && fabs(v3_len(o->n_unit) - 1) < 1e-14;
}

static inline bool all_finite_f(const WrSurfacePointf *o)
{
    bool good = isfinite(o->n_len);
    for (int m = 0; m < MEMBERS; m++) {
        WrVec3 a = member_f(o, m);
        good = good && isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
    }
    return good && fabs(v3_len(member_f(o, UNIT)) - 1) < 1e-6;
}

/* Edges, corners and the centre, in both precisions. */
static inline void assert_finite_everywhere(const WrShape *shape, bool single)
{
    static const float steps[] = { 0, 1e-30f, 0x1p-20f, 0.25f, 0.5f, 0.7f, 1 - 0x1p-24f, 1 };
    for (int face = 0; face < wr_surfaces[shape->kind]->faces; face++) {
        for (int k = 0; k < 64; k++) {
            WrSurfacePoint o;
            WrSurfacePointf of;
            both(shape, face, steps[k % 8], steps[k / 8], &o, &of);
            bool good = all_finite(&o) && (!single || all_finite_f(&of));
            if (!good)
                fail_msg("%s at %g,%g", wr_surfaces[shape->kind]->name, (double)steps[k % 8],
                         (double)steps[k / 8]);
        }
    }
}

/* Derivative pairs: along v, base member, derivative member. */
enum { DERIVATIVES = 8 };
static const int derivatives[DERIVATIVES][3] = { { 0, P, PU },    { 1, P, PV },   { 0, PU, PUU },
                                                 { 1, PU, PUV },  { 1, PV, PVV }, { 0, PV, PUV },
                                                 { 0, UNIT, NU }, { 1, UNIT, NV } };

/* Difference between derivative r of the point `o` at (u, v) and fourth-order finite differences with step h. */
static inline double derivative_off(const WrShape *shape, const WrSurfacePoint *o, int r, double u,
                                    double v, double h)
{
    const int *rule = derivatives[r];
    WrSurfacePoint a[4];
    for (int i = 0; i < 4; i++) {
        const double by = h * (const double[]){ 1, -1, 2, -2 }[i];
        wr_surface_at(shape, 0, rule[0] ? u : u + by, rule[0] ? v + by : v, &a[i]);
    }
    const WrVec3 one = v3_sub(member(&a[0], rule[1]), member(&a[1], rule[1]));
    const WrVec3 two = v3_sub(member(&a[2], rule[1]), member(&a[3], rule[1]));
    const WrVec3 got = v3_scale(v3_sub(v3_scale(one, 8), two), 1 / (12 * h));
    return v3_len(v3_sub(got, member(o, rule[2])));
}

/* Check each derivative of a point to `within`, relative to 10 plus its own size. */
static inline void expect_derivatives(const WrShape *shape, double u, double v, double h,
                                      double within, const char *what)
{
    WrSurfacePoint o;
    wr_surface_at(shape, 0, u, v, &o);
    for (int r = 0; r < DERIVATIVES; r++) {
        const double off = derivative_off(shape, &o, r, u, v, h);
        const double told = v3_len(member(&o, derivatives[r][2]));
        if (off > within * (10 + told))
            fail_msg("%s at %g,%g: %s of %s: off by %g of %g", what, u, v,
                     member_names[derivatives[r][2]], member_names[derivatives[r][1]], off, told);
    }
}
