/* kern_ray_hit_body.h - closed-form ray intersection. Part of kern_body.h. Each kernel has two forms: for
   neighbours in a row, whose rays differ by one addition, and for arbitrary samples (spread). */

/* The ray of sample i of the strip: of neighbours from (gx, gy) on, or at any position. */
typedef struct Ray {
    VEC q, d;
} Ray;

/* gx + i is exact for integers below 2^24; q and d are affine in (x, y) (view.c). */
ALWAYS Ray ray_of(const RAYS *rays, const STRIP *strip, int i, REAL gx, REAL gy, const bool spread)
{
    REAL x = spread ? strip->x[i] : gx + (REAL)i, y = spread ? strip->y[i] : gy;
    return (Ray){ RAY_Q(rays, y, x), RAY_D(rays, y, x) };
}

/* |q + s d| = R. With m = q.d / d.d the foot of the perpendicular is f = q - m d, and s = -m -+ sqrt((R^2 - f.f)
   / d.d): no difference of large squares. s is stored relative to the foot. Two short loops: a processor
   reorders only a limited number of operations, and the two roots wait for the values before them. */
ALWAYS int hit_sphere(const RAYS *rays, const SHAPE *shape, REAL gx, REAL gy, int count,
                      const bool spread, STRIP *strip)
{
    const REAL r = shape->value[0], r2 = r * r, s_min = rays->s_min;
    REAL foot[WR_SPAN], part[WR_SPAN]; /* m; (R^2 - f.f) / d.d */
    const int whole = WHOLE(count);
    SIMD for (int i = 0; i < whole; i++)
    {
        Ray ray = ray_of(rays, strip, i, gx, gy, spread);
        VEC q = ray.q, d = ray.d;
        REAL dd = v_dot(d, d), m = v_dot(q, d) / dd;
        VEC f = v_mad(q, d, -m);
        REAL left = r2 - v_dot(f, f);
        foot[i] = m;
        part[i] = left / dd;
        STORE3(strip, p, i, f);
    }
    SIMD for (int i = 0; i < whole; i++)
    {
        VEC d = ray_of(rays, strip, i, gx, gy, spread).d, f = LOAD3(strip, p, i);
        REAL m = foot[i], half = r_sqrt(part[i] > 0.0f ? part[i] : 0.0f);
        REAL near = -half - m > s_min ? -half : half;
        strip->s[i] = part[i] >= 0.0f && near - m > s_min ? near : MISS;
        VEC p = v_mad(f, d, near);
        STORE3(strip, p, i, p);
    }
    return compact_points(count, spread, strip);
}

/* x^2 + y^2 = R^2, |z| <= H/2, open at both ends: the nearer root if it lies on the tube, else the other. */
ALWAYS int hit_cylinder(const RAYS *rays, const SHAPE *shape, REAL gx, REAL gy, int count,
                        const bool spread, STRIP *strip)
{
    const REAL r = shape->value[0], r2 = r * r, top = 0.5f * shape->value[1];
    const REAL s_min = rays->s_min;
    SIMD for (int i = 0; i < count; i++)
    {
        Ray ray = ray_of(rays, strip, i, gx, gy, spread);
        VEC q = ray.q, d = ray.d;
        REAL dd = d.x * d.x + d.y * d.y;
        REAL inv = 1.0f / (dd > 1e-30f ? dd : 1.0f), m = (q.x * d.x + q.y * d.y) * inv;
        REAL fx = q.x - m * d.x, fy = q.y - m * d.y;
        REAL left = r2 - (fx * fx + fy * fy);
        REAL half = r_sqrt((left > 0.0f ? left : 0.0f) * inv);
        REAL s0 = -m - half, s1 = -m + half;
        REAL z0 = r_abs(q.z + s0 * d.z), z1 = r_abs(q.z + s1 * d.z);
        REAL second = z1 <= top && s1 > s_min ? s1 : MISS;
        REAL s = z0 <= top && s0 > s_min ? s0 : second;
        strip->s[i] = left >= 0.0f && dd > 1e-30f ? s : MISS;
        VEC p = v_mad(q, d, s);
        STORE3(strip, p, i, p);
    }
    return compact_points(count, spread, strip);
}

/* A ray relative to the cone's tip: x^2 + y^2 = k^2 w^2, k = R/H, w the depth below the tip. `foot` is its point
   nearest the tip and m = -s there: roots are relative to it, so that nothing cancels however close to the tip
   rays pass (no w^2 is subtracted from a w^2). */
typedef struct TipRay {
    VEC foot; /* from the tip; z up */
    REAL m;
} TipRay;

ALWAYS TipRay ray_of_tip(VEC q, VEC d, REAL top)
{
    VEC from = { q.x, q.y, q.z - top };
    REAL m = v_dot(from, d) / v_dot(d, d);
    return (TipRay){ v_mad(from, d, -m), m };
}

/* a s^2 + 2 b s + c = 0, roots in the stable form t / a and c / t with t = -(b +- root); root^2 = b^2 - a c = (x
   k dz - k z dx)^2 + (y k dz - k z dy)^2 - (x dy - y dx)^2, the same value without the products that cancel. */
ALWAYS int hit_cone(const RAYS *rays, const SHAPE *shape, REAL gx, REAL gy, int count,
                    const bool spread, STRIP *strip)
{
    const REAL h = shape->value[1], k = shape->value[0] / h, k2 = k * k, top = K_(0.5) * h;
    const REAL s_min = rays->s_min;
    SIMD for (int i = 0; i < count; i++)
    {
        Ray ray = ray_of(rays, strip, i, gx, gy, spread);
        VEC q = ray.q, d = ray.d;
        TipRay tip = ray_of_tip(q, d, top);
        VEC f = tip.foot;
        REAL a = d.x * d.x + d.y * d.y - k2 * (d.z * d.z);
        REAL b = f.x * d.x + f.y * d.y - k2 * (f.z * d.z);
        REAL c = f.x * f.x + f.y * f.y - k2 * (f.z * f.z);
        REAL ex = k * (f.x * d.z - f.z * d.x), ey = k * (f.y * d.z - f.z * d.y);
        REAL ez = f.x * d.y - f.y * d.x;
        REAL disc = ex * ex + ey * ey - ez * ez;
        REAL root = r_sqrt(disc > 0.0f ? disc : 0.0f);
        REAL t = b > 0.0f ? -b - root : -b + root;
        REAL sa = a != 0.0f ? t / a : MISS, sc = t != 0.0f ? c / t : 0.0f;
        REAL s0 = sa < sc ? sa : sc, s1 = sa < sc ? sc : sa;
        REAL z0 = f.z + s0 * d.z, z1 = f.z + s1 * d.z;
        REAL second = z1 <= 0.0f && z1 >= -h && s1 - tip.m > s_min ? s1 : MISS;
        REAL s = z0 <= 0.0f && z0 >= -h && s0 - tip.m > s_min ? s0 : second;
        strip->s[i] = disc >= 0.0f ? s : MISS;
        VEC p = v_mad(f, d, s);
        STORE3(strip, p, i, p);
    }
    return compact_points(count, spread, strip);
}

/* ---- round surfaces: u, v and the frame from the hit point, each only on request. Points are relative to the
   centre, on the cone to its tip. P and n come from one kernel in every combination, so that their bits are
   equal. ---- */

/* v = 1/2 + latitude / pi: the arc tangent of z / rho in turns, of -1/4 .. 1/4, and not an arc sine of z / R,
   which loses half its digits at the poles. */
static inline REAL v_of_sphere(const SHAPE *shape, VEC p)
{
    (void)shape;
    REAL a = r_atan2_turns(p.z, r_sqrt(p.x * p.x + p.y * p.y));
    a = a > K_(0.5) ? a - K_(1) : a;
    return K_(0.5) + K_(2) * a;
}

static inline REAL v_of_cylinder(const SHAPE *shape, VEC p)
{
    return K_(0.5) + p.z / shape->value[1];
}

static inline REAL v_of_cone(const SHAPE *shape, VEC p)
{
    return K_(1) + p.z / shape->value[1];
}

/* Functions of a surface that compute its frame, or its v, from a point.
   Passed as constants to inlined functions, so that no call remains in the loop. */
typedef void FrameFrom(const SHAPE *shape, VEC p, POINT *at);
typedef REAL VOf(const SHAPE *shape, VEC p);

/* u is the longitude in turns, 0 .. 1, from +x towards +y. */
ALWAYS void params_strip(VOf *const v_of, const SHAPE *shape, STRIP *strip)
{
    const int count = WHOLE(strip->count);
    SIMD for (int i = 0; i < count; i++)
    {
        VEC p = LOAD3(strip, p, i);
        strip->u[i] = r_atan2_turns(p.y, p.x);
        strip->v[i] = clamp01(v_of(shape, p));
    }
}

ALWAYS void put_tangents(FrameFrom *const from, const SHAPE *shape, STRIP *strip, int i)
{
    POINT at;
    from(shape, LOAD3(strip, p, i), &at);
    STORE3(strip, pu, i, at.pu);
    STORE3(strip, pv, i, at.pv);
    strip->n_len[i] = at.n_len;
}

ALWAYS void tangents_strip(FrameFrom *const from, const SHAPE *shape, STRIP *strip)
{
    const int count = WHOLE(strip->count);
    SIMD for (int i = 0; i < count; i++)
    {
        put_tangents(from, shape, strip, i);
    }
}

/* P is replaced by the surface's own point along n, without the intersection's rounding. */
ALWAYS void put_normal(FrameFrom *const from, const SHAPE *shape, STRIP *strip, int i)
{
    POINT at;
    from(shape, LOAD3(strip, p, i), &at);
    STORE3(strip, p, i, at.p);
    STORE3(strip, n, i, at.n_unit);
}

ALWAYS void normals_strip(FrameFrom *const from, const SHAPE *shape, STRIP *strip)
{
    const int count = WHOLE(strip->count);
    SIMD for (int i = 0; i < count; i++)
    {
        put_normal(from, shape, strip, i);
    }
}

/* Each round surface's kernels. */
#define ROUND_KERNELS(name)                                                                        \
    FLAT static void kern_params_##name(const SHAPE *shape, STRIP *strip)                          \
    {                                                                                              \
        params_strip(v_of_##name, shape, strip);                                                   \
    }                                                                                              \
    FLAT static void kern_tangents_##name(const SHAPE *shape, STRIP *strip)                        \
    {                                                                                              \
        tangents_strip(FN(name##_from), shape, strip);                                             \
    }                                                                                              \
    FLAT static void kern_normals_##name(const SHAPE *shape, STRIP *strip)                         \
    {                                                                                              \
        normals_strip(FN(name##_from), shape, strip);                                              \
    }
ROUND_KERNELS(sphere)
ROUND_KERNELS(cylinder)
ROUND_KERNELS(cone)

/* s = (o - q).n / d.n. eu and ev are the dual basis of the edges, so (u, v) are two products. Hits a little
   beyond a shared edge count, so that no ray passes between two faces, and are clamped back to 0..1. */
ALWAYS int hit_quad(const RAYS *rays, const QUAD *quad, REAL gx, REAL gy, int count,
                    const bool spread, STRIP *strip)
{
    const VEC o = { quad->origin[0], quad->origin[1], quad->origin[2] };
    const VEC n = { quad->normal[0], quad->normal[1], quad->normal[2] };
    const VEC eu = { quad->eu[0], quad->eu[1], quad->eu[2] };
    const VEC ev = { quad->ev[0], quad->ev[1], quad->ev[2] };
    const REAL s_min = rays->s_min;
    const REAL u0 = quad->u0, u1 = quad->u1, v0 = quad->v0, v1 = quad->v1;
    const REAL least = quad->least, most = quad->most;
    SIMD for (int i = 0; i < count; i++)
    {
        Ray ray = ray_of(rays, strip, i, gx, gy, spread);
        VEC q = ray.q, d = ray.d;
        REAL dn = v_dot(d, n);
        REAL s = v_dot(v_sub(o, q), n) / dn; /* no valid hit if dn is 0 */
        VEC p = v_sub(v_mad(q, d, s), o);
        REAL u = v_dot(p, eu), v = v_dot(p, ev);
        bool in = (u >= u0) & (u <= u1) & (v >= v0) & (v <= v1);
        bool met = (s > s_min) & (s < MISS) & (dn != 0.0f);
        strip->u[i] = u > least ? (u < most ? u : most) : least;
        strip->v[i] = v > least ? (v < most ? v : most) : least;
        strip->s[i] = (in & met) ? s : MISS;
    }
    REAL *const move[] = { strip->u, strip->v, strip->x, strip->y };
    return compact(count, strip, move, spread ? 4 : 2);
}

/* Two kernels of each: `false` lets ray_of fold into one addition per sample. */
#define HITS(name, type, arg)                                                                      \
    FLAT static int kern_hit_##name(const RAYS *rays, const type *arg, REAL gx, REAL gy,           \
                                    int count, STRIP *strip)                                       \
    {                                                                                              \
        return hit_##name(rays, arg, gx, gy, count, false, strip);                                 \
    }                                                                                              \
    FLAT static int kern_hit_##name##_at(const RAYS *rays, const type *arg, int count,             \
                                         STRIP *strip)                                             \
    {                                                                                              \
        return hit_##name(rays, arg, K_(0), K_(0), count, true, strip);                            \
    }
HITS(sphere, SHAPE, shape)
HITS(cylinder, SHAPE, shape)
HITS(cone, SHAPE, shape)
HITS(quad, QUAD, quad)

#define ROUND(name)                                                                                \
    {                                                                                              \
        kern_hit_##name, kern_hit_##name##_at, kern_params_##name, kern_tangents_##name,           \
            kern_normals_##name                                                                    \
    }

/* ---- rasterised triangles ---- */

/* Mesh visibility: samples covered by a triangle, and covered samples of a row. Part of
   kern_body.h. */

#ifndef WR_KERN_DOUBLE

_Static_assert(LANES <= WR_WALK_PAD, "what is written past the end");

/* The three edge values of a triangle at the first of LANES samples. */
typedef struct Edges {
    int32_t a, b, c;
} Edges;

/* Their differences from the first of LANES samples to the others. */
typedef struct EdgeSteps {
    int32_t a[LANES], b[LANES], c[LANES];
} EdgeSteps;

/* l1, l2 are barycentric coordinates; attributes are base + l1 d1 + l2 d2, with 1 / w interpolated linearly
   and u / w divided by it under perspective. */
ALWAYS float on_plane(WrPlane plane, float l1, float l2)
{
    return plane.base + l1 * plane.d1 + l2 * plane.d2;
}

/* Covers LANES samples, of which the first `count` may be written.
   Covered if E_k >= 0 for all three edges: no sign bit in a | b | c. Integers, so that neighbouring triangles
   agree on their common edge to the sample. `close` grows towards the eye. */
ALWAYS void cover_lanes(const WrWalk *walk, Edges first, const EdgeSteps *steps, int count,
                        const bool perspective, float *restrict close, float *restrict u,
                        float *restrict v)
{
    const WrPlane near_by = walk->close, u_by = walk->u, v_by = walk->v;
    const float inv = walk->inv;
    SIMD for (int i = 0; i < LANES; i++)
    {
        const int32_t a = first.a + steps->a[i], b = first.b + steps->b[i],
                      c = first.c + steps->c[i];
        const float l1 = (float)b * inv, l2 = (float)c * inv, near = on_plane(near_by, l1, l2);
        const float w = perspective ? 1.0f / near : 1.0f;
        const float new_u = on_plane(u_by, l1, l2) * w, new_v = on_plane(v_by, l1, l2) * w;
        const bool nearer = ((a | b | c) >= 0) & (i < count) & (near > close[i]);
        close[i] = nearer ? near : close[i];
        u[i] = nearer ? new_u : u[i];
        v[i] = nearer ? new_v : v[i];
    }
}

/* True if one edge excludes all LANES samples.
   An edge value is affine along the row: negative at both ends, it is negative at all lanes. */
ALWAYS bool edges_miss(Edges first, const EdgeSteps *steps)
{
    const int last = LANES - 1;
    return ((first.a & (first.a + steps->a[last])) | (first.b & (first.b + steps->b[last])) |
            (first.c & (first.c + steps->c[last]))) < 0;
}

/* Edge values are not advanced past the last block of a row, where they could overflow. */
ALWAYS void cover(const WrWalk *walk, const bool perspective, float *close, float *u, float *v)
{
    const Edges step = { walk->step_x[0], walk->step_x[1], walk->step_x[2] };
    EdgeSteps steps;
    SIMD for (int i = 0; i < LANES; i++)
    {
        steps.a[i] = i * step.a;
        steps.b[i] = i * step.b;
        steps.c[i] = i * step.c;
    }
    Edges row = { walk->at[0], walk->at[1], walk->at[2] };
    for (int y = walk->y0; y < walk->y1; y++) {
        const size_t at = (size_t)y * (size_t)walk->pitch;
        Edges first = row;
        for (int x = walk->x0; x < walk->x1; x += LANES) {
            const size_t cell = at + (size_t)x;
            if (!edges_miss(first, &steps))
                cover_lanes(walk, first, &steps, walk->x1 - x, perspective, close + cell, u + cell,
                            v + cell);
            if (x + LANES >= walk->x1) break;
            first.a += LANES * step.a, first.b += LANES * step.b, first.c += LANES * step.c;
        }
        row.a += walk->step_y[0], row.b += walk->step_y[1], row.c += walk->step_y[2];
    }
}

FLAT static void kern_cover(const WrWalk *walk, float *close, float *u, float *v)
{
    if (walk->perspective) cover(walk, true, close, u, v);
    else cover(walk, false, close, u, v);
}
#endif

/* Stores the grid positions of a row's hits from (gx, gy) on; returns `hits`. */
ALWAYS int put_places(REAL gx, REAL gy, int hits, STRIP *strip)
{
    SIMD for (int i = 0; i < hits; i++)
    {
        strip->x[i] = gx + (REAL)strip->index[i];
        strip->y[i] = gy;
    }
    return hits;
}

/* Covered samples of a row from (gx, gy) on.
   -FLT_MAX is the cleared depth. */
FLAT static int kern_covered(const float *close, const float *u, const float *v, REAL gx, REAL gy,
                             int count, STRIP *strip)
{
    SIMD for (int i = 0; i < count; i++)
    {
        strip->s[i] = close[i] > -FLT_MAX ? K_(0) : K_(MISS);
        strip->u[i] = (REAL)u[i];
        strip->v[i] = (REAL)v[i];
    }
    REAL *const move[] = { strip->u, strip->v };
    const int hits = compact(count, strip, move, 2);
    return put_places(gx, gy, hits, strip);
}

/* Samples of a row from (gx, gy) on that are in the uv cache. */
FLAT static int kern_recall(const float *u, const float *v, REAL gx, REAL gy, int count,
                            STRIP *strip)
{
    SIMD for (int i = 0; i < count; i++)
    {
        const float at = wr_bits_float(wr_float_bits(u[i]) & INT32_MAX);
        strip->s[i] = at <= 1.0f ? K_(0) : K_(MISS);
        strip->u[i] = (REAL)at;
        strip->v[i] = (REAL)v[i];
        strip->wx[i] = wr_float_bits(u[i]) < 0 ? K_(0) : K_(1);
    }
    REAL *const move[] = { strip->u, strip->v, strip->wx };
    const int hits = compact(count, strip, move, 3);
    return put_places(gx, gy, hits, strip);
}
