/* kern_bump_body.h - the paper's formulas over strips. A part of kern_body.h. */

/* +1 on the side that n points to, -1 behind: there dents and bumps change places, as the paper says. */
typedef struct Viewer {
    VEC at;
    REAL near; /* 1: at is a position; 0: a direction */
} Viewer;

static inline Viewer viewer_of(const RAYS *rays)
{
    const REAL *at = rays->perspective ? rays->eye : rays->toward;
    return (Viewer){ { at[0], at[1], at[2] }, rays->perspective ? 1.0f : 0.0f };
}

static inline REAL side_of(Viewer viewer, const STRIP *strip, int i)
{
    VEC w = v_mad(viewer.at, LOAD3(strip, p, i), -viewer.near);
    return v_dot(LOAD3(strip, n, i), w) < 0.0f ? -1.0f : 1.0f;
}

/* What slopes beyond STEEP, and N with them, are multiplied by. */
ALWAYS REAL eased(REAL steepest)
{
    return steepest > STEEP ? STEEP * r_scale_down(steepest) : K_(1);
}

#define BUMP_BEGIN(name)                                                                           \
    FLAT static void kern_bump_##name(const RAYS *rays, STRIP *strip)                              \
    {                                                                                              \
        const Viewer viewer = viewer_of(rays);                                                     \
        const int count = strip->count;                                                            \
        SIMD for (int i = 0; i < count; i++)                                                       \
        {                                                                                          \
            VEC n = LOAD3(strip, n, i), r;

#define BUMP_END                                                                                   \
    r = v_scale(r, side_of(viewer, strip, i));                                                     \
    STORE3(strip, b, i, r);                                                                        \
    }                                                                                              \
    }

#define LOAD_SLOPES                                                                                \
    VEC pu = LOAD3(strip, pu, i), pv = LOAD3(strip, pv, i);                                        \
    REAL fu = strip->fu[i], fv = strip->fv[i];                                                     \
    bool level = fu == 0.0f && fv == 0.0f;                                                         \
    REAL steepest = r_abs(fu) > r_abs(fv) ? r_abs(fu) : r_abs(fv);                                 \
    REAL k = eased(steepest);                                                                      \
    fu *= k;                                                                                       \
    fv *= k

#define CHOOSE(condition, a, b)                                                                    \
    ((VEC){ (condition) ? (a).x : (b).x, (condition) ? (a).y : (b).y, (condition) ? (a).z : (b).z })

BUMP_BEGIN(none)
r = n;
BUMP_END

/* N' = N + D, D = n x (Fu Pv - Fv Pu) */
BUMP_BEGIN(blinn)
LOAD_SLOPES;
VEC d = v_cross(n, v_sub(v_scale(pv, fu), v_scale(pu, fv)));
VEC bent = unit_or(v_mad(d, n, strip->n_len[i] * k), n);
r = CHOOSE(level, n, bent);
BUMP_END

/* N" = N + a D |N|/|D|: along n + a D/|D| */
BUMP_BEGIN(invariant)
LOAD_SLOPES;
VEC zero = { 0, 0, 0 };
VEC d = v_cross(n, v_sub(v_scale(pv, fu), v_scale(pu, fv)));
VEC way = unit_or(d, zero);
REAL big = r_abs(fu) > r_abs(fv) ? r_abs(fu) : r_abs(fv);
REAL ratio = (r_abs(fu) > r_abs(fv) ? fv : fu) / (big > 0.0f ? big : 1.0f);
REAL a = big * r_sqrt(1.0f + ratio * ratio);
VEC bent = unit_or(v_mad(v_scale(n, k), way, a), n);
r = CHOOSE(level, n, bent);
BUMP_END

/* `a`, or 0 where it is nothing but what rounding left of terms of that size that cancel. */
ALWAYS VEC above_rounding(VEC a, REAL size)
{
    const VEC zero = { 0, 0, 0 };
    return CHOOSE(longest(a) < ROUNDED * size, zero, a);
}

/* N' = Pu' x Pv', Pu' = Pu + Fu n + F n_u, Pv' = Pv + Fv n + F n_v; parts along n and in the plane are
   kept apart so that steep slopes do not swallow the tangents. Where F carries the surface to a focal point
   a tangent comes out as rounding: what is left of it is no direction (HC12). */
BUMP_BEGIN(exact)
VEC pu = LOAD3(strip, pu, i), pv = LOAD3(strip, pv, i);
REAL f = strip->f[i], fu = strip->fu[i], fv = strip->fv[i];
bool level = fu == 0.0f && fv == 0.0f && f == 0.0f;
VEC fnu = v_scale(LOAD3(strip, nu, i), f), fnv = v_scale(LOAD3(strip, nv, i), f);
VEC tu = v_add(pu, fnu), tv = v_add(pv, fnv);
REAL turn_u = longest(fnu), turn_v = longest(fnv);
REAL size_u = larger(longest(pu), turn_u), size_v = larger(longest(pv), turn_v);
REAL size = larger(larger(size_u, size_v), larger(r_abs(fu), r_abs(fv)));
REAL k = eased(size);
tu = v_scale(tu, k);
tv = v_scale(tv, k);
fu *= k;
fv *= k;
size_u *= k;
size_v *= k;
bool moved = turn_u > 0.0f || turn_v > 0.0f;
VEC flat = above_rounding(v_cross(tu, tv), moved ? size_u *size_v : 0.0f);
VEC tip = v_cross(n, v_sub(v_scale(tv, fu), v_scale(tu, fv)));
tip = above_rounding(tip, larger(r_abs(fu) * size_v, r_abs(fv) * size_u));
VEC bent = unit_or(v_add(flat, tip), n);
r = CHOOSE(level, n, bent);
BUMP_END
