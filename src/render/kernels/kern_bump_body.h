/* kern_bump_body.h - the paper's bump formulas over strips. Part of kern_body.h. */

/* Viewer's side: +1 on the side that n points to, -1 behind, where dents and bumps are exchanged, as in the
   paper. */
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

/* Scale factor of slopes above STEEP, and of N with them. */
ALWAYS REAL eased(REAL steepest)
{
    REAL k = steepest > STEEP ? STEEP * r_scale_down(steepest) : K_(1);
    return r_is_finite(steepest) ? k : K_(0);
}

/* The slopes of a sample, and the scale of slopes and N. */
typedef struct Slopes {
    REAL fu, fv, k;
    bool level;
} Slopes;

ALWAYS Slopes slopes_of(const STRIP *strip, int i)
{
    REAL fu = strip->fu[i], fv = strip->fv[i];
    REAL k = eased(larger(r_abs(fu), r_abs(fv)));
    return (Slopes){ fu * k, fv * k, k, fu == 0.0f && fv == 0.0f };
}

/* D = n x (Fu Pv - Fv Pu) */
ALWAYS VEC bend_by(VEC pu, VEC pv, VEC n, Slopes at)
{
    return v_cross(n, v_sub(v_scale(pv, at.fu), v_scale(pu, at.fv)));
}

ALWAYS VEC bend_of(const STRIP *strip, int i, VEC n, Slopes at)
{
    return bend_by(LOAD3(strip, pu, i), LOAD3(strip, pv, i), n, at);
}

/* ---- n' of one sample, for each formula ---- */

ALWAYS VEC bump_none(const STRIP *strip, int i, VEC n)
{
    (void)strip, (void)i;
    return n;
}

/* N' = N + D */
ALWAYS VEC bump_blinn(const STRIP *strip, int i, VEC n)
{
    Slopes at = slopes_of(strip, i);
    VEC bent = unit_or(v_mad(bend_of(strip, i, n, at), n, strip->n_len[i] * at.k), n);
    return choose(at.level, n, bent);
}

/* N" = N + a D |N|/|D|: along n + a D/|D| */
ALWAYS VEC bump_invariant(const STRIP *strip, int i, VEC n)
{
    const VEC zero = { 0, 0, 0 };
    Slopes at = slopes_of(strip, i);
    VEC way = unit_or(bend_of(strip, i, n, at), zero);
    bool steeper_u = r_abs(at.fu) > r_abs(at.fv);
    REAL big = steeper_u ? r_abs(at.fu) : r_abs(at.fv);
    REAL ratio = (steeper_u ? at.fv : at.fu) / (big > 0.0f ? big : 1.0f);
    REAL a = big * r_sqrt(1.0f + ratio * ratio);
    return choose(at.level, n, unit_or(v_mad(v_scale(n, at.k), way, a), n));
}

/* `a`, or 0 if it is only the rounding error of cancelled terms of that size. */
ALWAYS VEC above_rounding(VEC a, REAL size)
{
    const VEC zero = { 0, 0, 0 };
    return choose(longest(a) < ROUNDED * size, zero, a);
}

/* N' = Pu' x Pv', Pu' = Pu + Fu n + F n_u, Pv' = Pv + Fv n + F n_v; parts along n and in the plane are kept
   apart so that steep slopes do not absorb the tangents. Where F moves the surface to a focal point, a tangent
   consists of rounding errors and has no direction (HC12). */
ALWAYS VEC bump_exact(const STRIP *strip, int i, VEC n)
{
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
    VEC flat = above_rounding(v_cross(tu, tv), moved ? size_u * size_v : 0.0f);
    VEC tip = v_cross(n, v_sub(v_scale(tv, fu), v_scale(tu, fv)));
    tip = above_rounding(tip, larger(r_abs(fu) * size_v, r_abs(fv) * size_u));
    return choose(level, n, unit_or(v_add(flat, tip), n));
}

/* ---- strips, on the viewer's side ---- */

typedef VEC Bump(const STRIP *strip, int i, VEC n);

ALWAYS void bump_strip(Bump *const bump, const RAYS *rays, STRIP *strip)
{
    const Viewer viewer = viewer_of(rays);
    const int count = WHOLE(strip->count);
    SIMD for (int i = 0; i < count; i++)
    {
        VEC bent = bump(strip, i, LOAD3(strip, n, i));
        bent = v_scale(bent, side_of(viewer, strip, i));
        STORE3(strip, b, i, bent);
    }
}

#define BUMP(name)                                                                                 \
    FLAT static void kern_bump_##name(const RAYS *rays, STRIP *strip)                              \
    {                                                                                              \
        bump_strip(bump_##name, rays, strip);                                                      \
    }
BUMP(none)
BUMP(blinn)
BUMP(invariant)
BUMP(exact)

#ifdef WR_KERN_FAST
/* Blinn's n' of a sphere from n and the slopes alone. Pu is 2 pi R cl along east, Pv pi R along north: N' times
   cl / (pi R) needs no quotient. At the poles themselves: n. */
ALWAYS VEC bend_sphere(REAL R, VEC n, Slopes at)
{
    REAL cl2 = n.x * n.x + n.y * n.y, m = K_(2) * K_(WR_PI) * R * cl2 * at.k;
    REAL q = K_(2) * at.fv * r_sqrt(cl2), qz = m + q * n.z;
    return (VEC){ qz * n.x + at.fu * n.y, qz * n.y - at.fu * n.x, m * n.z - q * cl2 };
}

/* In two loops, like the light (kern_light_body.h). */
FLAT static void kern_bend_sphere(const RAYS *rays, const SHAPE *shape, STRIP *strip)
{
    const Viewer viewer = viewer_of(rays);
    const REAL R = shape->value[0];
    const int count = WHOLE(strip->count);
    SIMD for (int i = 0; i < count; i++)
    {
        VEC bent = bend_sphere(R, LOAD3(strip, n, i), slopes_of(strip, i));
        STORE3(strip, b, i, bent);
    }
    SIMD for (int i = 0; i < count; i++)
    {
        VEC bent = unit_or(LOAD3(strip, b, i), LOAD3(strip, n, i));
        bent = v_scale(bent, side_of(viewer, strip, i));
        STORE3(strip, b, i, bent);
    }
}
#endif
