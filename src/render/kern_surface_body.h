/* kern_surface_body.h - points, frames and Newton's method of every surface. A part of kern_body.h. */

/* Into 0..1: round a closed parameter, stop at the edge of an open one. */
static inline float settle(float t, float closed)
{
    float turn = t - floorf(t);
    turn = turn < 1.0f ? turn : 0.0f;
    return closed * turn + (1.0f - closed) * clamp01(t); /* closed is 0 or 1 */
}

static inline float limit(float x, float reach)
{
    x = x < reach ? x : reach;
    return x > -reach ? x : -reach;
}

/* Squared distance of p from the ray. */
static inline float miss2(WrVec3f p, WrVec3f q, WrVec3f d)
{
    WrVec3f w = v3f_sub(p, q);
    WrVec3f r = v3f_mad(w, d, -v3f_dot(w, d) / v3f_dot(d, d));
    return v3f_dot(r, r);
}

/* Newton on w(u,v,s) = P - q - s d: with N = Pu x Pv, du = -(w . (Pv x d)) / (d . N) and
   dv = -(w . (d x Pu)) / (d . N). Quadratic where d . N is not small; at silhouettes the step is
   limited and, if it does not bring P nearer to the ray, not taken. */
typedef struct Param2 {
    float u, v;
} Param2;

/* One sample of each kernel is a function of its own: a WrSurfacePointf declared inside a simd loop
   would be kept in memory for all lanes, and the loop would not vectorise. */
#define SURFACE_KERNELS(name)                                                                      \
    static inline WrVec3f point_##name(const WrShapef *shape, float u, float v)                    \
    {                                                                                              \
        WrSurfacePointf at;                                                                        \
        name##_at_f(shape, 0, u, v, &at);                                                          \
        return at.p;                                                                               \
    }                                                                                              \
    FLAT static void kern_points_##name(const WrShapef *shape, int count, const float *u,          \
                                        const float *v, float *x, float *y, float *z)              \
    {                                                                                              \
        SIMD for (int i = 0; i < count; i++)                                                       \
        {                                                                                          \
            WrVec3f p = point_##name(shape, u[i], v[i]);                                           \
            x[i] = p.x, y[i] = p.y, z[i] = p.z;                                                    \
        }                                                                                          \
    }                                                                                              \
    static inline void frame_##name(const WrShapef *shape, int face, WrStrip *strip, int i)        \
    {                                                                                              \
        WrSurfacePointf at;                                                                        \
        name##_at_f(shape, face, strip->u[i], strip->v[i], &at);                                   \
        STORE3(strip, p, i, at.p);                                                                 \
        STORE3(strip, pu, i, at.pu);                                                               \
        STORE3(strip, pv, i, at.pv);                                                               \
        STORE3(strip, n, i, at.n_unit);                                                            \
        strip->n_len[i] = at.n_len;                                                                \
    }                                                                                              \
    FLAT static void kern_geometry_##name(const WrShapef *shape, int face, WrStrip *strip)         \
    {                                                                                              \
        const int count = strip->count;                                                            \
        SIMD for (int i = 0; i < count; i++)                                                       \
        {                                                                                          \
            frame_##name(shape, face, strip, i);                                                   \
        }                                                                                          \
    }                                                                                              \
    static inline void turn_##name(const WrShapef *shape, int face, WrStrip *strip, int i)         \
    {                                                                                              \
        WrSurfacePointf at;                                                                        \
        name##_at_f(shape, face, strip->u[i], strip->v[i], &at);                                   \
        STORE3(strip, nu, i, at.n_u);                                                              \
        STORE3(strip, nv, i, at.n_v);                                                              \
    }                                                                                              \
    FLAT static void kern_curvature_##name(const WrShapef *shape, int face, WrStrip *strip)        \
    {                                                                                              \
        const int count = strip->count;                                                            \
        SIMD for (int i = 0; i < count; i++)                                                       \
        {                                                                                          \
            turn_##name(shape, face, strip, i);                                                    \
        }                                                                                          \
    }                                                                                              \
    POLISH(name)

/* Newton on w(u,v,s) = P - q - s d: with N = Pu x Pv, du = -(w . (Pv x d)) / (d . N) and
   dv = -(w . (d x Pu)) / (d . N). Quadratic where d . N is not small; at silhouettes the step is
   limited and, if it does not bring P nearer to the ray, not taken. */
#define POLISH(name)                                                                               \
    static inline Param2 newton_##name(const WrShapef *shape, WrVec3f q, WrVec3f d, Param2 at,     \
                                       Param2 reach, Param2 closed)                                \
    {                                                                                              \
        WrSurfacePointf here;                                                                      \
        name##_at_f(shape, 0, at.u, at.v, &here);                                                  \
        WrVec3f w = v3f_sub(here.p, q), n = v3f_cross(here.pu, here.pv);                           \
        float dn = v3f_dot(d, n), inv = 1.0f / (dn != 0.0f ? dn : 1.0f);                           \
        float du = limit(-v3f_dot(w, v3f_cross(here.pv, d)) * inv, reach.u);                       \
        float dv = limit(-v3f_dot(w, v3f_cross(d, here.pu)) * inv, reach.v);                       \
        float u = settle(at.u + du, closed.u), v = settle(at.v + dv, closed.v);                    \
        float before = miss2(here.p, q, d), after = miss2(point_##name(shape, u, v), q, d);        \
        bool better = dn != 0.0f && after <= before;                                               \
        return (Param2){ better ? u : at.u, better ? v : at.v };                                   \
    }                                                                                              \
    FLAT static void kern_polish_##name(const WrRays *rays, const WrShapef *shape, float gx,       \
                                        float gy, float reach_u, float reach_v, bool closed_u,     \
                                        bool closed_v, int steps, WrStrip *strip)                  \
    {                                                                                              \
        const Row row = row_at(rays, gy);                                                          \
        const Param2 reach = { reach_u, reach_v };                                                 \
        const Param2 closed = { closed_u ? 1.0f : 0.0f, closed_v ? 1.0f : 0.0f };                  \
        const int count = strip->count;                                                            \
        for (int step = 0; step < steps; step++) {                                                 \
            SIMD for (int i = 0; i < count; i++)                                                   \
            {                                                                                      \
                float g = gx + (float)strip->index[i];                                             \
                WrVec3f q = affine(row.q, rays->qx, g), d = affine(row.d, rays->dx, g);            \
                Param2 at = { strip->u[i], strip->v[i] };                                          \
                at = newton_##name(shape, q, d, at, reach, closed);                                \
                strip->u[i] = at.u;                                                                \
                strip->v[i] = at.v;                                                                \
            }                                                                                      \
        }                                                                                          \
    }

#define WR_X(name) SURFACE_KERNELS(name)
#include "surface/surface_list.h"
