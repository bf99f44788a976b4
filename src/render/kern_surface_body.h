/* kern_surface_body.h - points, frames and Newton's method of every surface. A part of kern_body.h. */

/* Into 0..1: round a closed parameter, stop at the edge of an open one. */
static inline REAL settle(REAL t, REAL closed)
{
    REAL turn = t - r_floor(t);
    turn = turn < 1.0f ? turn : 0.0f;
    return closed * turn + (1.0f - closed) * clamp01(t); /* closed is 0 or 1 */
}

static inline REAL limit(REAL x, REAL reach)
{
    x = x < reach ? x : reach;
    return x > -reach ? x : -reach;
}

/* Squared distance of p from the ray. */
static inline REAL miss2(VEC p, VEC q, VEC d)
{
    VEC w = v_sub(p, q);
    VEC r = v_mad(w, d, -v_dot(w, d) / v_dot(d, d));
    return v_dot(r, r);
}

typedef struct Param2 {
    REAL u, v;
} Param2;

static inline bool all_stand(int count, const REAL *moves)
{
    REAL any = K_(0);
    for (int i = 0; i < count; i++) any = moves[i] > any ? moves[i] : any;
    return !(any > K_(0));
}

/* A surface's formula: fills all of *at. Kernels of all surfaces are one text, into which each surface's own is inlined.
   One sample of each is a function: a POINT declared inside a simd loop would be kept in memory for all lanes, and the
   loop would not vectorise. */
typedef void Formula(const SHAPE *shape, int face, REAL u, REAL v, POINT *at);

ALWAYS VEC point_at(Formula *const formula, const SHAPE *shape, REAL u, REAL v)
{
    POINT at;
    formula(shape, 0, u, v, &at);
    return at.p;
}

ALWAYS void points_strip(Formula *const formula, const SHAPE *shape, int count, const REAL *u,
                         const REAL *v, REAL *x, REAL *y, REAL *z)
{
    SIMD for (int i = 0; i < count; i++)
    {
        VEC p = point_at(formula, shape, u[i], v[i]);
        x[i] = p.x, y[i] = p.y, z[i] = p.z;
    }
}

ALWAYS void put_frame(Formula *const formula, const SHAPE *shape, int face, STRIP *strip, int i)
{
    POINT at;
    formula(shape, face, strip->u[i], strip->v[i], &at);
    STORE3(strip, p, i, at.p);
    STORE3(strip, pu, i, at.pu);
    STORE3(strip, pv, i, at.pv);
    STORE3(strip, n, i, at.n_unit);
    strip->n_len[i] = at.n_len;
}

ALWAYS void geometry_strip(Formula *const formula, const SHAPE *shape, int face, STRIP *strip)
{
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        put_frame(formula, shape, face, strip, i);
    }
}

ALWAYS void put_turn(Formula *const formula, const SHAPE *shape, int face, STRIP *strip, int i)
{
    POINT at;
    formula(shape, face, strip->u[i], strip->v[i], &at);
    STORE3(strip, nu, i, at.n_u);
    STORE3(strip, nv, i, at.n_v);
}

ALWAYS void curvature_strip(Formula *const formula, const SHAPE *shape, int face, STRIP *strip)
{
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        put_turn(formula, shape, face, strip, i);
    }
}

/* Newton on w(u,v,s) = P - q - s d: with N = Pu x Pv, du = -(w . (Pv x d)) / (d . N) and
   dv = -(w . (d x Pu)) / (d . N). Quadratic where d . N is not small; at silhouettes the step is
   limited and, if it does not bring P nearer to the ray, not taken. */
ALWAYS Param2 newton_step(VEC p, VEC pu, VEC pv, Ray ray, Param2 at, Param2 reach, Param2 closed)
{
    VEC w = v_sub(p, ray.q), n = v_cross(pu, pv);
    REAL dn = v_dot(ray.d, n), inv = 1.0f / (dn != 0.0f ? dn : 1.0f);
    REAL du = limit(-v_dot(w, v_cross(pv, ray.d)) * inv, reach.u);
    REAL dv = limit(-v_dot(w, v_cross(ray.d, pu)) * inv, reach.v);
    return (Param2){ settle(at.u + (dn != 0.0f ? du : K_(0)), closed.u),
                     settle(at.v + (dn != 0.0f ? dv : K_(0)), closed.v) };
}

#define KEEP3(strip, name, i, taken, vec)                                                          \
    STORE3(strip, name, i, choose(taken, vec, LOAD3(strip, name, i)))

/* P, Pu, Pv: what a step looks at. */
ALWAYS void put_tangent_plane(Formula *const formula, const SHAPE *shape, STRIP *strip, int i)
{
    POINT at;
    formula(shape, 0, strip->u[i], strip->v[i], &at);
    STORE3(strip, p, i, at.p);
    STORE3(strip, pu, i, at.pu);
    STORE3(strip, pv, i, at.pv);
}

/* One step of sample i, whose P, Pu, Pv stand in the strip, as it does afterwards; how far it moved. */
ALWAYS Param2 polish_sample(Formula *const formula, const SHAPE *shape, Ray ray, Param2 reach,
                            Param2 closed, STRIP *strip, int i)
{
    VEC p = LOAD3(strip, p, i), pu = LOAD3(strip, pu, i), pv = LOAD3(strip, pv, i);
    Param2 at = { strip->u[i], strip->v[i] };
    Param2 to = newton_step(p, pu, pv, ray, at, reach, closed);
    POINT there;
    formula(shape, 0, to.u, to.v, &there);
    bool taken = (miss2(there.p, ray.q, ray.d) <= miss2(p, ray.q, ray.d)) & (strip->s[i] > K_(0));
    KEEP3(strip, p, i, taken, there.p);
    KEEP3(strip, pu, i, taken, there.pu);
    KEEP3(strip, pv, i, taken, there.pv);
    strip->u[i] = taken ? to.u : at.u;
    strip->v[i] = taken ? to.v : at.v;
    REAL du = r_abs(to.u - at.u), dv = r_abs(to.v - at.v);
    du = du > K_(0.5) ? K_(1) - du : du; /* across the seam */
    dv = dv > K_(0.5) ? K_(1) - dv : dv;
    return (Param2){ taken ? du : K_(0), taken ? dv : K_(0) };
}

/* A step evaluates the surface once: at its end, which is the next one's start. */
ALWAYS void polish_strip(Formula *const formula, const RAYS *rays, const SHAPE *shape,
                         const NEWTON *how, STRIP *strip)
{
    const Param2 reach = { how->reach_u, how->reach_v };
    const Param2 closed = { how->closed_u ? K_(1) : K_(0), how->closed_v ? K_(1) : K_(0) };
    const REAL enough_u = how->enough_u, enough_v = how->enough_v;
    const int count = strip->count;
    const bool watched = (enough_u > K_(0)) | (enough_v > K_(0));
    SIMD for (int i = 0; i < count; i++)
    {
        strip->s[i] = K_(1); /* while the sample moves */
        put_tangent_plane(formula, shape, strip, i);
    }
    for (int step = 0; step < how->steps; step++) {
        SIMD for (int i = 0; i < count; i++)
        {
            Ray ray = ray_of(rays, strip, i, K_(0), K_(0), true);
            Param2 moved = polish_sample(formula, shape, ray, reach, closed, strip, i);
            bool on = (moved.u > enough_u) | (moved.v > enough_v);
            strip->s[i] = on ? strip->s[i] : K_(0);
        }
        if (watched && all_stand(count, strip->s)) break;
    }
}

/* Each surface's kernels. */
#define SURFACE_KERNELS(name)                                                                      \
    FLAT static void kern_points_##name(const SHAPE *shape, int count, const REAL *u,              \
                                        const REAL *v, REAL *x, REAL *y, REAL *z)                  \
    {                                                                                              \
        points_strip(FN(name##_at), shape, count, u, v, x, y, z);                                  \
    }                                                                                              \
    FLAT static void kern_geometry_##name(const SHAPE *shape, int face, STRIP *strip)              \
    {                                                                                              \
        geometry_strip(FN(name##_at), shape, face, strip);                                         \
    }                                                                                              \
    FLAT static void kern_curvature_##name(const SHAPE *shape, int face, STRIP *strip)             \
    {                                                                                              \
        curvature_strip(FN(name##_at), shape, face, strip);                                        \
    }                                                                                              \
    FLAT static void kern_polish_##name(const RAYS *rays, const SHAPE *shape, const NEWTON *how,   \
                                        STRIP *strip)                                              \
    {                                                                                              \
        polish_strip(FN(name##_at), rays, shape, how, strip);                                      \
    }

#define WR_X(name) SURFACE_KERNELS(name)
#include "surface/surface_list.h"
