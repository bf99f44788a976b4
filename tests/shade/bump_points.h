/* bump_points.h - shared helpers of the tests of the normal formulas. */
#pragma once
#include "base/exactmath.h"
#include "shade/bump.h"
#include "surface/surface.h"

#include <float.h>

static const WrVec3 none = { 0, 0, 0 };

static inline double between(TestRandom *random, double low, double high)
{
    return low + (high - low) * test_random(random);
}

static inline double distance(WrVec3 a, WrVec3 b)
{
    return v3_len(v3_sub(a, b));
}

static inline WrShape shape_of(WrSurfaceKind kind)
{
    WrShape shape;
    wr_shape_default(kind, &shape);
    return shape;
}

static inline WrVec3 normal(WrBumpMode mode, const WrSurfacePoint *o, double f, double fu,
                            double fv)
{
    return wr_bump_normal(mode, o->n, o->n_unit, o->pu, o->pv, o->n_u, o->n_v, f, fu, fv);
}

static inline WrVec3 unit_normal(WrBumpMode mode, const WrSurfacePoint *o, double f, double fu,
                                 double fv)
{
    return wr_bump_unit_normal(mode, o->n, o->n_unit, o->pu, o->pv, o->n_u, o->n_v, f, fu, fv);
}

static const WrSurfaceKind curved[] = { WR_SURFACE_bent,     WR_SURFACE_bezier, WR_SURFACE_sphere,
                                        WR_SURFACE_cylinder, WR_SURFACE_cone,   WR_SURFACE_torus,
                                        WR_SURFACE_ribbon };
enum { CURVED = sizeof curved / sizeof *curved };

/* A random regular point of a random curved surface, and slopes. */
typedef struct Sample {
    WrShape shape;
    WrSurfacePoint o;
    double u, v, f, fu, fv;
} Sample;
static inline Sample random_sample(TestRandom *random)
{
    Sample s;
    s.shape = shape_of(curved[test_random_u64(random) % CURVED]);
    s.u = between(random, 0.1, 0.9);
    s.v = between(random, 0.1, 0.9);
    wr_surface_at(&s.shape, 0, s.u, s.v, &s.o);
    s.f = between(random, -0.1, 0.1);
    s.fu = between(random, -2, 2);
    s.fv = between(random, -2, 2);
    return s;
}
