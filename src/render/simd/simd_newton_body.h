/* simd_newton_body.h - SIMD Newton's method on surfaces that rays intersect by way of a mesh
   (kern_surface_body.h): one vector of samples from start value to result. Part of simd_v3.c and simd_v4.c.
   Formulas and decisions are those of the stages; P, Pu, Pv stay in registers from step to step. */

/* P, Pu, Pv at a point. */
typedef struct WidePlane {
    WideVec p, pu, pv;
} WidePlane;

/* ---- surfaces ---- */

/* A cubic and its slope at t, by synthetic division. */
typedef struct WideCubic {
    Wide at, slope;
} WideCubic;

ALWAYS WideCubic cubic_of(Wide a0, Wide a1, Wide a2, Wide a3, Wide t)
{
    const Wide b2 = a2 + t * a3, b1 = a1 + t * b2, c2 = b2 + t * a3;
    return (WideCubic){ a0 + t * b1, b1 + t * c2 };
}

/* One coordinate of a patch: 28 products. */
ALWAYS void patch_axis(const float a[16], Wide s, Wide t, Wide *p, Wide *pu, Wide *pv)
{
    WideCubic row[4];
    for (int j = 0; j < 4; j++)
        row[j] = cubic_of(w_all(a[4 * j]), w_all(a[4 * j + 1]), w_all(a[4 * j + 2]),
                          w_all(a[4 * j + 3]), s);
    const WideCubic across = cubic_of(row[0].at, row[1].at, row[2].at, row[3].at, t);
    *p = across.at, *pv = across.slope;
    *pu = row[0].slope + t * (row[1].slope + t * (row[2].slope + t * row[3].slope));
}

ALWAYS WidePlane patch_plane(const WrWideSheet *sheet, Wide u, Wide v)
{
    const Wide s = u - w_all(0.5f), t = v - w_all(0.5f);
    WidePlane at;
    patch_axis(sheet->patch[0], s, t, &at.p.x, &at.pu.x, &at.pv.x);
    patch_axis(sheet->patch[1], s, t, &at.p.y, &at.pu.y, &at.pv.y);
    patch_axis(sheet->patch[2], s, t, &at.p.z, &at.pu.z, &at.pv.z);
    return at;
}

typedef struct WideTurn {
    Wide sine, cosine;
} WideTurn;

/* Sine and cosine of 2 pi u, 0 <= u <= 1, as wr_sincos_turns_f. */
ALWAYS WideTurn turn_of(Wide u)
{
    const Wide q = w_nearest(w_all(4.0f) * u), x = u - w_all(0.25f) * q, z = x * x;
    const Wide s =
        x * (w_all(6.28318548f) +
             z * (w_all(-41.3417015f) +
                  z * (w_all(81.6052017f) + z * (w_all(-76.6978683f) + z * w_all(41.4728317f)))));
    const Wide c =
        w_all(1.0f) +
        z * (w_all(-19.7392082f) +
             z * (w_all(64.9393158f) + z * (w_all(-85.4428482f) + z * w_all(59.2201691f))));
    const Wide off = w_abs(q - w_all(2.0f)), zero = w_all(0.0f);
    const WideMask odd = w_both(w_less(w_all(0.5f), off), w_less(off, w_all(1.5f)));
    const Wide a = w_pick(odd, c, s), b = w_pick(odd, s, c);
    const WideMask low = w_both(w_less(w_all(1.5f), q), w_less(q, w_all(3.5f)));
    const WideMask left = w_both(w_less(w_all(0.5f), q), w_less(q, w_all(2.5f)));
    return (WideTurn){ w_pick(low, zero - a, a), w_pick(left, zero - b, b) };
}

ALWAYS WidePlane torus_plane(const WrWideSheet *sheet, Wide u, Wide v)
{
    const WideTurn along = turn_of(u), round = turn_of(v);
    const Wide a = w_all(6.28318531f), r = w_all(sheet->tube);
    const Wide w = w_all(sheet->ring) + r * round.cosine, aw = a * w, ar = a * r;
    const Wide down = w_all(0.0f) - ar * round.sine;
    return (WidePlane){ { w * along.cosine, w * along.sine, r * round.sine },
                        { w_all(0.0f) - aw * along.sine, aw * along.cosine, w_all(0.0f) },
                        { down * along.cosine, down * along.sine, ar * round.cosine } };
}

typedef WidePlane WideFormula(const WrWideSheet *sheet, Wide u, Wide v);

/* ---- steps ---- */

/* Reduces to 0..1: wraps a closed parameter, clamps an open one. */
ALWAYS Wide w_settle(Wide t, bool closed)
{
    const Wide zero = w_all(0.0f), one = w_all(1.0f);
    if (!closed) return w_min(w_max(t, zero), one);
    const Wide turn = t - w_floor(t);
    return w_kept(w_less(turn, one), w_max(turn, zero));
}

ALWAYS Wide w_longest(WideVec a)
{
    return w_max(w_max(w_abs(a.x), w_abs(a.y)), w_abs(a.z));
}

ALWAYS Wide w_limit(Wide a, Wide most)
{
    return w_max(w_min(a, most), w_all(0.0f) - most);
}

/* Parameters shared by all samples. */
typedef struct WideHow {
    WideVec q0, qx, d0, dx, qy, dy;
    Wide reach_u, reach_v, enough_u, enough_v, uu, uv, vv, last;
    bool closed_u, closed_v;
} WideHow;

ALWAYS WideHow how_of(const WrRays *rays, const WrNewton *how)
{
    return (WideHow){ w_alike(rays->q0),    w_alike(rays->qx),   w_alike(rays->d0),
                      w_alike(rays->dx),    w_alike(rays->qy),   w_alike(rays->dy),
                      w_all(how->reach_u),  w_all(how->reach_v), w_all(how->enough_u),
                      w_all(how->enough_v), w_all(how->uu),      w_all(how->uv),
                      w_all(how->vv),       w_all(how->last),    how->closed_u,
                      how->closed_v };
}

/* State of the samples: u, v and the point there; `near`: squared distance from the ray, times |d|^2. */
typedef struct WideWay {
    Wide u, v, near;
    WidePlane at;
    WideVec c; /* (P - q) x d */
} WideWay;

/* The next step: its end, and its length. */
typedef struct WideStep {
    Wide u, v, du, dv;
} WideStep;

ALWAYS WideStep step_from(const WideWay *way, WideVec d, const WideHow *how)
{
    const Wide zero = w_all(0.0f);
    const Wide dn = w_dot(d, w_cross(way->at.pu, way->at.pv));
    const Wide inv = w_kept(w_less(zero, w_abs(dn)), w_reciprocal(dn));
    const Wide by_u = w_limit(w_dot(way->at.pv, way->c) * inv, how->reach_u);
    const Wide by_v = w_limit(zero - w_dot(way->at.pu, way->c) * inv, how->reach_v);
    const Wide u = w_settle(way->u + by_u, how->closed_u);
    const Wide v = w_settle(way->v + by_v, how->closed_v);
    WideStep step = { u, v, by_u, by_v };
    if (!how->closed_u) step.du = u - way->u;
    if (!how->closed_v) step.dv = v - way->v;
    return step;
}

/* Lanes in which the step hardly changes the tangents. */
ALWAYS WideMask stands_still(const WideWay *way, const WideStep *step, const WideHow *how)
{
    const Wide du = w_abs(step->du), dv = w_abs(step->dv);
    const Wide a = how->uu * du + how->uv * dv, b = how->uv * du + how->vv * dv;
    return w_both(w_less(a, how->last * w_longest(way->at.pu)),
                  w_less(b, how->last * w_longest(way->at.pv)));
}

/* Lanes with a <= most; NaN counts as inside. */
ALWAYS WideMask is_near(Wide a, Wide most)
{
    return w_but(w_mask(w_first_bits(WIDE)), w_less(most, w_min(a, w_all(FLT_MAX))));
}

/* Accepts the end of a step in lanes where it is not farther from the ray. */
ALWAYS WideMask arrive_wide(WideMask moves, const WideWay *end, WideWay *way)
{
    const WideMask taken = w_both(moves, is_near(end->near, way->near));
    way->u = w_pick(taken, end->u, way->u), way->v = w_pick(taken, end->v, way->v);
    way->near = w_pick(taken, end->near, way->near);
    way->c = w_pick3(taken, end->c, way->c);
    way->at.p = w_pick3(taken, end->at.p, way->at.p);
    way->at.pu = w_pick3(taken, end->at.pu, way->at.pu);
    way->at.pv = w_pick3(taken, end->at.pv, way->at.pv);
    return taken;
}

/* A last step: P follows it along the tangents. */
ALWAYS void land_wide(WideMask last, const WideStep *by, WideVec q, WideVec d, WideWay *way)
{
    const WideVec end = w_mad(w_mad(way->at.p, way->at.pu, by->du), way->at.pv, by->dv);
    const WideVec c = w_cross(w_sub(end, q), d);
    const WideMask taken = w_both(last, is_near(w_dot(c, c), way->near));
    way->u = w_pick(taken, by->u, way->u), way->v = w_pick(taken, by->v, way->v);
    way->at.p = w_pick3(taken, end, way->at.p);
}

/* Lanes whose step is so short that it is the last. */
ALWAYS WideMask is_short(const WideStep *by, const WideHow *how)
{
    const WideMask far =
        w_either(w_less(how->enough_u, w_abs(by->du)), w_less(how->enough_v, w_abs(by->dv)));
    return w_but(w_mask(w_first_bits(WIDE)), far);
}

ALWAYS void put_way(const WideWay *way, WrStrip *strip, int i)
{
    w_store(strip->u + i, way->u), w_store(strip->v + i, way->v);
    W_STORE3(strip, p, i, way->at.p);
    W_STORE3(strip, pu, i, way->at.pu);
    W_STORE3(strip, pv, i, way->at.pv);
}

/* Solves a vector from its start values; the lanes `moves` are samples. resumes: wx indicates the lanes that
   take a last step; no others move. */
ALWAYS void solve_vector(WideFormula *const formula, const WrWideSheet *sheet, const WideHow *how,
                         int steps, bool resumes, WideMask moves, WrStrip *strip, int i)
{
    const Wide x = w_load(strip->x + i), y = w_load(strip->y + i), zero = w_all(0.0f);
    const WideVec q = w_mad(w_mad(how->q0, how->qy, y), how->qx, x);
    const WideVec d = w_mad(w_mad(how->d0, how->dy, y), how->dx, x);
    const WideMask known = w_less(zero, w_load(strip->wx + i));
    Wide u = w_load(strip->u + i), v = w_load(strip->v + i), left = zero, short_one = zero;
    Wide rx = u, ry = v;
    WideWay way = { .near = w_all(FLT_MAX) };
    for (int step = 0;; step++) {
        WideWay end = { .u = u, .v = v, .at = formula(sheet, u, v) };
        end.c = w_cross(w_sub(end.at.p, q), d);
        end.near = w_dot(end.c, end.c);
        if (step == 0) way = end;
        else {
            const WideMask taken = arrive_wide(moves, &end, &way);
            rx = w_pick(taken, u, rx), ry = w_pick(taken, v, ry);
            moves = w_but(taken, w_less(zero, short_one));
        }
        if (step == steps || !w_any(moves)) break;
        const WideStep by = step_from(&way, d, how);
        const WideMask last = resumes ? known : w_both(moves, stands_still(&way, &by, how));
        land_wide(last, &by, q, d, &way);
        left = w_pick(last, w_all(1.0f), left);
        moves = w_but(moves, last);
        if (resumes || !w_any(moves)) break;
        short_one = w_kept(is_short(&by, how), w_all(1.0f));
        u = by.u, v = by.v;
    }
    put_way(&way, strip, i);
    w_store(strip->rx + i, rx), w_store(strip->ry + i, ry), w_store(strip->wx + i, left);
}

/* Separate functions, for `polish` and `resume` alike: the same bits (kern_surface_body.h). */
#define SOLVE_STRIP(name)                                                                          \
    static __attribute__((noinline, noclone)) void solve_##name(                                   \
        const WrWideSheet *sheet, const WideHow *how, int steps, bool resumes, WrStrip *strip)     \
    {                                                                                              \
        for (int i = 0; i < strip->count; i += WIDE)                                               \
            solve_vector(name##_plane, sheet, how, steps, resumes,                                 \
                         w_mask(w_first_bits(strip->count - i)), strip, i);                        \
    }
SOLVE_STRIP(patch)
SOLVE_STRIP(torus)

static void wide_newton(const WrWideSheet *sheet, const WrRays *rays, const WrNewton *newton,
                        bool resumes, WrStrip *strip)
{
    const WideHow how = how_of(rays, newton);
    if (sheet->kind == WR_SURFACE_torus) solve_torus(sheet, &how, newton->steps, resumes, strip);
    else solve_patch(sheet, &how, newton->steps, resumes, strip);
}
