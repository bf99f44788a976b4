/* kern_bump_body.h - the paper's formulas over strips. A part of kern_body.h. */

/* +1 on the side that n points to, -1 behind: there dents and bumps change places, as the paper says. */
typedef struct Viewer {
    WrVec3f at;
    float near; /* 1: at is a position; 0: a direction */
} Viewer;

static inline Viewer viewer_of(const WrRays *rays)
{
    const float *at = rays->perspective ? rays->eye : rays->toward;
    return (Viewer){ { at[0], at[1], at[2] }, rays->perspective ? 1.0f : 0.0f };
}

static inline float side_of(Viewer viewer, const WrStrip *strip, int i)
{
    WrVec3f w = v3f_mad(viewer.at, LOAD3(strip, p, i), -viewer.near);
    return v3f_dot(LOAD3(strip, n, i), w) < 0.0f ? -1.0f : 1.0f;
}

#define BUMP_BEGIN(name)                                                                           \
    FLAT static void kern_bump_##name(const WrRays *rays, WrStrip *strip)                          \
    {                                                                                              \
        const Viewer viewer = viewer_of(rays);                                                     \
        const int count = strip->count;                                                            \
        SIMD for (int i = 0; i < count; i++)                                                       \
        {                                                                                          \
            WrVec3f n = LOAD3(strip, n, i), r;

#define BUMP_END                                                                                   \
    r = v3f_scale(r, side_of(viewer, strip, i));                                                   \
    STORE3(strip, b, i, r);                                                                        \
    }                                                                                              \
    }

#define LOAD_SLOPES                                                                                \
    WrVec3f pu = LOAD3(strip, pu, i), pv = LOAD3(strip, pv, i);                                    \
    float fu = strip->fu[i], fv = strip->fv[i];                                                    \
    bool level = fu == 0.0f && fv == 0.0f;                                                         \
    float steepest = fabsf(fu) > fabsf(fv) ? fabsf(fu) : fabsf(fv);                                \
    float k = steepest > STEEP ? STEEP / steepest : 1.0f;                                          \
    fu *= k;                                                                                       \
    fv *= k

#define CHOOSE(condition, a, b)                                                                    \
    ((WrVec3f){ (condition) ? (a).x : (b).x, (condition) ? (a).y : (b).y,                          \
                (condition) ? (a).z : (b).z })

BUMP_BEGIN(none)
r = n;
BUMP_END

/* N' = N + D, D = n x (Fu Pv - Fv Pu) */
BUMP_BEGIN(blinn)
LOAD_SLOPES;
WrVec3f d = v3f_cross(n, v3f_sub(v3f_scale(pv, fu), v3f_scale(pu, fv)));
WrVec3f bent = unit_or(v3f_mad(d, n, strip->n_len[i] * k), n);
r = CHOOSE(level, n, bent);
BUMP_END

/* N" = N + a D |N|/|D|: along n + a D/|D| */
BUMP_BEGIN(invariant)
LOAD_SLOPES;
WrVec3f zero = { 0, 0, 0 };
WrVec3f d = v3f_cross(n, v3f_sub(v3f_scale(pv, fu), v3f_scale(pu, fv)));
WrVec3f way = unit_or(d, zero);
float big = fabsf(fu) > fabsf(fv) ? fabsf(fu) : fabsf(fv);
float ratio = (fabsf(fu) > fabsf(fv) ? fv : fu) / (big > 0.0f ? big : 1.0f);
float a = big * sqrtf(1.0f + ratio * ratio);
WrVec3f bent = unit_or(v3f_mad(v3f_scale(n, k), way, a), n);
r = CHOOSE(level, n, bent);
BUMP_END

/* N' = Pu' x Pv', Pu' = Pu + Fu n + F n_u, Pv' = Pv + Fv n + F n_v; parts along n and in the plane are
   kept apart so that steep slopes do not swallow the tangents. */
BUMP_BEGIN(exact)
WrVec3f pu = LOAD3(strip, pu, i), pv = LOAD3(strip, pv, i);
float f = strip->f[i], fu = strip->fu[i], fv = strip->fv[i];
bool level = fu == 0.0f && fv == 0.0f && f == 0.0f;
WrVec3f tu = v3f_mad(pu, LOAD3(strip, nu, i), f), tv = v3f_mad(pv, LOAD3(strip, nv, i), f);
float size = max3(fabsf(tu.x), fabsf(tu.y), fabsf(tu.z));
float size_v = max3(fabsf(tv.x), fabsf(tv.y), fabsf(tv.z));
size = size > size_v ? size : size_v;
size = size > fabsf(fu) ? size : fabsf(fu);
size = size > fabsf(fv) ? size : fabsf(fv);
float k = size > STEEP ? STEEP / size : 1.0f;
tu = v3f_scale(tu, k);
tv = v3f_scale(tv, k);
fu *= k;
fv *= k;
WrVec3f flat = v3f_cross(tu, tv);
WrVec3f tip = v3f_cross(n, v3f_sub(v3f_scale(tv, fu), v3f_scale(tu, fv)));
WrVec3f bent = unit_or(v3f_add(flat, tip), n);
r = CHOOSE(level, n, bent);
BUMP_END
