/* kern_surface_body.h - points, frames and Newton's method of every surface. Part of kern_body.h. */

/* Reduces to 0..1: wraps a closed parameter, clamps an open one. closed is 0 or 1.
   An open parameter stays within its surface, so a step across a border ends on it. turn * closed < 1: the
   period's end is its beginning. */
ALWAYS REAL settle(REAL t, REAL closed)
{
    REAL turn = t - closed * r_floor(t);
    turn = clamp01(turn);
    return turn * closed < K_(1) ? turn : K_(0);
}

static inline REAL limit(REAL x, REAL reach)
{
    x = x < reach ? x : reach;
    return x > -reach ? x : -reach;
}

typedef struct Param2 {
    REAL u, v;
} Param2;

/* 1 for a periodic parameter, else 0. */
typedef struct Closed {
    REAL u, v;
} Closed;

/* A surface's formula: fills all of *at. Kernels of all surfaces are one text, into which each surface's own
   formula is inlined. The work on one sample is a function: a POINT declared inside a simd loop would be kept in
   memory for all lanes, and the loop would not vectorise. */
typedef void Formula(const SHAPE *shape, int face, REAL u, REAL v, POINT *at);

ALWAYS VEC point_at(Formula *const formula, const SHAPE *shape, REAL u, REAL v)
{
    POINT at;
    formula(shape, 0, u, v, &at);
    return at.p;
}

/* Separate rows for u, v, x, y, z: mesh vertices are evaluated in runs by the same formula as samples, so they
   lie on the same surface to the bit. */
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

/* P, Pu, Pv, n, |N| at (u, v) of each sample, after the inversion. */
ALWAYS void geometry_strip(Formula *const formula, const SHAPE *shape, int face, STRIP *strip)
{
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        put_frame(formula, shape, face, strip, i);
    }
}

/* n_u and n_v, for the exact normal only. */
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

/* w x d, w = p - q: |w x d| / |d| is the distance of p from the ray. */
ALWAYS VEC off_ray(VEC p, Ray ray)
{
    return v_cross(v_sub(p, ray.q), ray.d);
}

/* Newton on w(u,v,s) = P - q - s d: with N = Pu x Pv and c = w x d, du = (Pv . c) / (d . N) and dv = -(Pu . c) /
   (d . N). Convergence is quadratic where d . N is not small; at silhouettes the step is limited and, if it does
   not move P nearer to the ray, discarded. */
ALWAYS Param2 newton_step(VEC c, VEC pu, VEC pv, VEC d, Param2 reach)
{
    REAL dn = v_dot(d, v_cross(pu, pv));
    REAL inv = dn != 0.0f ? 1.0f / (dn != 0.0f ? dn : 1.0f) : 0.0f;
    return (Param2){ limit(v_dot(pv, c) * inv, reach.u), limit(-v_dot(pu, c) * inv, reach.v) };
}

/* A masked store as a selection: lanes that do not move keep their bits. */
#define KEEP3(strip, name, i, taken, vec)                                                          \
    STORE3(strip, name, i, choose(taken, vec, LOAD3(strip, name, i)))

/* Source of a patch's evaluation: its formula, or prepared points. */
typedef struct Patch {
    const SHAPE *shape;
    const FN(BezierPlane) * ready;
} Patch;

/* Evaluates a step's end tu, tv: P, Pu, Pv, and for a formula n and |N|, into rows that later stages overwrite:
   b, l, v, d and n_dot_l. */
ALWAYS void put_there(Formula *const formula, const Patch *patch, const bool late, STRIP *strip,
                      int i)
{
    POINT at;
    if (late) FN(bezier_plane)(patch->ready, strip->tu[i], strip->tv[i], &at);
    else formula(patch->shape, 0, strip->tu[i], strip->tv[i], &at);
    STORE3(strip, b, i, at.p);
    STORE3(strip, l, i, at.pu);
    STORE3(strip, v, i, at.pv);
    if (late) return;
    strip->dr[i] = at.n_unit.x, strip->dg[i] = at.n_unit.y, strip->db[i] = at.n_unit.z;
    strip->n_dot_l[i] = at.n_len;
}

/* Termination of Newton's method.
   The remaining error after a step of length h is of order |Puu| h^2: `enough` is in parameters, `last`
   relative to the tangents. */
typedef struct Enough {
    REAL u, v;             /* a step shorter than these is the last */
    REAL uu, uv, vv, last; /* as in WrNewton */
} Enough;

/* True if a step hardly changes the tangents. By Taylor: |Pu| by at most |Puu| |du| + |Puv| |dv|. No squares:
   after a good start value they would be denormal numbers. */
ALWAYS bool turns_nothing(VEC pu, VEC pv, Enough enough, REAL du, REAL dv)
{
    REAL a = enough.uu * r_abs(du) + enough.uv * r_abs(dv);
    REAL b = enough.uv * r_abs(du) + enough.vv * r_abs(dv);
    REAL most_a = enough.last * longest(pu), most_b = enough.last * longest(pv);
    return (a < most_a) & (b < most_b);
}

/* The step of sample i from the P, Pu, Pv in the strip: its end in tu, tv, its length in ta, tb, and the start's
   distance from the ray in fv. f: 0: does not move; 1: a last step; 2: the surface is evaluated at its end. */
ALWAYS void aim_step(Ray ray, Param2 reach, Closed closed, Enough enough, STRIP *strip, int i)
{
    VEC p = LOAD3(strip, p, i), pu = LOAD3(strip, pu, i), pv = LOAD3(strip, pv, i);
    VEC c = off_ray(p, ray);
    REAL u = strip->u[i], v = strip->v[i];
    Param2 by = newton_step(c, pu, pv, ray.d, reach);
    Param2 to = { settle(u + by.u, closed.u), settle(v + by.v, closed.v) };
    REAL du = closed.u * by.u + (K_(1) - closed.u) * (to.u - u);
    REAL dv = closed.v * by.v + (K_(1) - closed.v) * (to.v - v);
    REAL how = turns_nothing(pu, pv, enough, du, dv) ? K_(1) : K_(2);
    strip->tu[i] = to.u;
    strip->tv[i] = to.v;
    strip->ta[i] = du;
    strip->tb[i] = dv;
    strip->fv[i] = v_dot(c, c);
    strip->f[i] = strip->s[i] > K_(0) ? how : K_(0);
}

/* Accepts the end of a step into u, v if it is not farther from the ray. Returns whether it did.
   (w x d)^2 without division by d.d: both sides have the same ray. A step that increases the distance is the
   sign of a silhouette or of a fold. */
ALWAYS bool go(Ray ray, VEC end, bool moves, STRIP *strip, int i)
{
    VEC c = off_ray(end, ray);
    bool taken = (v_dot(c, c) <= strip->fv[i]) & moves;
    strip->u[i] = taken ? strip->tu[i] : strip->u[i];
    strip->v[i] = taken ? strip->tv[i] : strip->v[i];
    return taken;
}

/* A last step: P follows it along the tangents.
   The surface is not evaluated again: the error is of second order in a step that turns the tangents by less
   than `last`. */
ALWAYS void land(Ray ray, STRIP *strip, int i)
{
    VEC p = LOAD3(strip, p, i), pu = LOAD3(strip, pu, i), pv = LOAD3(strip, pv, i);
    VEC end = v_mad(v_mad(p, pu, strip->ta[i]), pv, strip->tb[i]);
    bool taken = go(ray, end, strip->f[i] == K_(1), strip, i);
    KEEP3(strip, p, i, taken, end);
}

/* Any other step, after the surface was evaluated at its end. s: 1 while the sample moves.
   rx, ry: (u, v) of the last evaluation, whose tangents are in the strip. */
ALWAYS void arrive(Ray ray, Enough enough, STRIP *strip, int i)
{
    VEC p = LOAD3(strip, b, i);
    bool taken = go(ray, p, strip->f[i] > K_(1), strip, i);
    bool short_one = (r_abs(strip->ta[i]) <= enough.u) & (r_abs(strip->tb[i]) <= enough.v);
    VEC n = { strip->dr[i], strip->dg[i], strip->db[i] };
    KEEP3(strip, p, i, taken, p);
    KEEP3(strip, pu, i, taken, LOAD3(strip, l, i));
    KEEP3(strip, pv, i, taken, LOAD3(strip, v, i));
    KEEP3(strip, n, i, taken, n);
    strip->n_len[i] = taken ? strip->n_dot_l[i] : strip->n_len[i];
    strip->rx[i] = taken ? strip->u[i] : strip->rx[i];
    strip->ry[i] = taken ? strip->v[i] : strip->ry[i];
    strip->s[i] = (taken & !short_one) ? K_(1) : K_(0);
}

/* True if some sample is to take a step of that kind. */
static bool any_aims(const STRIP *strip, REAL kind)
{
    const int count = strip->count;
    int any = 0;
    SIMD_SUM(any) for (int i = 0; i < count; i++)
    {
        any += strip->f[i] == kind ? 1 : 0;
    }
    return any > 0;
}

/* ---- strips. Functions, not inlined: the code shared by `polish` and `resume` has the same bits in both
   however it is contracted. It works on whole vectors, for the same reason. ---- */

#define EACH(i, strip)                                                                             \
    for (int at_##i = 0; at_##i < strip->count; at_##i += LANES)                                   \
    SIMD for (int i = at_##i; i < at_##i + LANES; i++)

#define APART __attribute__((noinline))

/* Sets tu, tv to the first point of evaluation. */
APART FLAT static void begin_strip(STRIP *strip)
{
    EACH(i, strip)
    {
        VEC n = { strip->dr[i], strip->dg[i], strip->db[i] };
        STORE3(strip, p, i, LOAD3(strip, b, i));
        STORE3(strip, pu, i, LOAD3(strip, l, i));
        STORE3(strip, pv, i, LOAD3(strip, v, i));
        STORE3(strip, n, i, n);
        strip->n_len[i] = strip->n_dot_l[i];
        strip->rx[i] = strip->u[i];
        strip->ry[i] = strip->v[i];
        strip->s[i] = K_(1);
    }
}

APART FLAT static void aim_strip(const RAYS *rays, const NEWTON *how, STRIP *strip)
{
    const Param2 reach = { how->reach_u, how->reach_v };
    const Closed closed = { how->closed_u ? K_(1) : K_(0), how->closed_v ? K_(1) : K_(0) };
    const Enough enough = { how->enough_u, how->enough_v, how->uu, how->uv, how->vv, how->last };
    EACH(i, strip)
    {
        aim_step(ray_of(rays, strip, i, K_(0), K_(0), true), reach, closed, enough, strip, i);
    }
}

APART FLAT static void land_strip(const RAYS *rays, STRIP *strip)
{
    EACH(i, strip)
    {
        land(ray_of(rays, strip, i, K_(0), K_(0), true), strip, i);
    }
}

APART FLAT static void arrive_strip(const RAYS *rays, const NEWTON *how, STRIP *strip)
{
    const Enough enough = { .u = how->enough_u, .v = how->enough_v };
    EACH(i, strip)
    {
        arrive(ray_of(rays, strip, i, K_(0), K_(0), true), enough, strip, i);
    }
}

/* Evaluates a surface at tu, tv of a strip's samples from <= i < to, in whole vectors. */
typedef void Evaluate(const SHAPE *shape, int from, int to, STRIP *strip);

/* Repeats the last sample up to a whole number of vectors.
   With the last sample, not with zeros: surplus lanes then do the same steps and never delay the loop. */
static void fill_lanes(STRIP *strip)
{
    const int count = strip->count, last = count - 1;
    for (int i = count; i % LANES != 0; i++) {
        strip->u[i] = strip->u[last], strip->v[i] = strip->v[last];
        strip->x[i] = strip->x[last], strip->y[i] = strip->y[last];
        strip->wx[i] = strip->wx[last];
    }
}

static void begin(Evaluate *evaluate, const SHAPE *shape, STRIP *strip)
{
    fill_lanes(strip);
    EACH(i, strip)
    {
        strip->tu[i] = strip->u[i];
        strip->tv[i] = strip->v[i];
    }
    evaluate(shape, 0, WHOLE(strip->count), strip);
    begin_strip(strip);
}

/* True if a vector contains a sample whose step ends with an evaluation. */
static bool vector_moves(const STRIP *strip, int from)
{
    int any = 0;
    SIMD_SUM(any) for (int i = from; i < from + LANES; i++)
    {
        any += strip->f[i] == K_(2) ? 1 : 0;
    }
    return any > 0;
}

/* Evaluates the vectors that need it.
   Whole runs of vectors in one call; vectors whose samples all rest are skipped. */
static void evaluate_moving(Evaluate *evaluate, const SHAPE *shape, STRIP *strip)
{
    for (int from = 0, to; from < strip->count; from = to + LANES) {
        for (to = from; to < strip->count && vector_moves(strip, to);) to += LANES;
        if (to > from) evaluate(shape, from, to, strip);
    }
}

/* Newton's method. A step evaluates the surface once: at its end, which is the next step's start.
   wx becomes 1 where the method ended by a last step along the tangents: the uv cache stores it as the sign of
   u, so that `resume` can repeat that step. */
static void polish_strip(Evaluate *evaluate, const SHAPE *shape, const RAYS *rays,
                         const NEWTON *how, STRIP *strip)
{
    begin(evaluate, shape, strip);
    EACH(i, strip)
    {
        strip->wx[i] = K_(0);
    }
    for (int step = 0; step < how->steps; step++) {
        aim_strip(rays, how, strip);
        if (any_aims(strip, K_(1))) land_strip(rays, strip);
        EACH(i, strip)
        {
            strip->wx[i] = strip->f[i] == K_(1) ? K_(1) : strip->wx[i];
        }
        if (!any_aims(strip, K_(2))) break;
        evaluate_moving(evaluate, shape, strip);
        arrive_strip(rays, how, strip);
    }
}

/* Start values for Newton's method, interpolated from every eighth sample of a row.

   Every eighth sample is solved first; those between start from the cubic through the nearest four. On a smooth
   piece of surface that is a thousand times closer than the mesh's own triangles, so that one evaluation of the
   surface is enough. Elsewhere the cubic is far from the mesh's start value, which is then kept. Only for fast
   arithmetic: which samples are solved first depends on the start of the strip. Part of kern_surface_body.h. */

#ifdef WR_KERN_FAST

#define KNOT 8 /* samples from hit to hit */
#define KNOTS (WR_SPAN / KNOT)
#define NEAR_GUESS 0.5f /* of a mesh cell: largest distance of two start values of one point */

/* The cubic through four numbers, t steps after the first. */
ALWAYS REAL cubic_at(const REAL *at, REAL t)
{
    const REAL a = t - 1.0f, b = t - 2.0f, c = t - 3.0f;
    return b * c * (t * at[1] * 0.5f - a * at[0] * (1.0f / 6.0f)) +
           t * a * (b * at[3] * (1.0f / 6.0f) - c * at[2] * 0.5f);
}

/* u, v of the solved samples, at their positions in the strip. */
typedef struct Knots {
    REAL u[KNOTS], v[KNOTS];
    int count;
} Knots;

/* Solves every KNOT-th sample; the strip's samples are unchanged. */
static void solve_knots(Evaluate *evaluate, const SHAPE *shape, const RAYS *rays, const NEWTON *how,
                        STRIP *strip, Knots *knots)
{
    REAL *const all[] = { strip->u, strip->v, strip->x, strip->y };
    REAL kept[4][KNOTS * KNOT];
    const int count = strip->count;
    knots->count = (count + KNOT - 1) / KNOT;
    for (int k = 0; k < 4; k++) {
        memcpy(kept[k], all[k], (size_t)count * sizeof *kept[k]);
        for (int i = 0; i < knots->count; i++) all[k][i] = kept[k][i * KNOT];
    }
    strip->count = knots->count;
    polish_strip(evaluate, shape, rays, how, strip);
    for (int i = 0; i < knots->count; i++) knots->u[i] = strip->u[i], knots->v[i] = strip->v[i];
    for (int k = 0; k < 4; k++) memcpy(all[k], kept[k], (size_t)count * sizeof *kept[k]);
    strip->count = count;
}

/* Start values of up to KNOT samples from `from` on, from four solved samples, starting with `first`. */
FLAT static void guess_run(const Knots *knots, const NEWTON *how, int first, int from, STRIP *strip)
{
    const REAL far_u = NEAR_GUESS * how->reach_u, far_v = NEAR_GUESS * how->reach_v;
    const REAL *u = knots->u + first, *v = knots->v + first;
    const int left = strip->count - from, count = left < KNOT ? left : KNOT;
    SIMD for (int i = 0; i < count; i++)
    {
        const REAL t = (REAL)(i + from - first * KNOT) * (1.0f / (REAL)KNOT);
        const REAL own_u = strip->u[from + i], own_v = strip->v[from + i];
        const REAL new_u = cubic_at(u, t), new_v = cubic_at(v, t);
        const bool same = (r_abs(new_u - own_u) < far_u) & (r_abs(new_v - own_v) < far_v);
        strip->u[from + i] = same ? new_u : own_u;
        strip->v[from + i] = same ? new_v : own_v;
    }
}

static void guess_between(Evaluate *evaluate, const SHAPE *shape, const RAYS *rays,
                          const NEWTON *how, STRIP *strip)
{
    Knots knots;
    if (strip->count < 6 * KNOT || how->steps < 2) return;
    solve_knots(evaluate, shape, rays, how, strip, &knots);
    for (int from = 0; from < strip->count; from += KNOT) {
        const int own = from / KNOT - 1, most = knots.count - 4;
        const int first = own < 0 ? 0 : own > most ? most : own, at = first * KNOT;
        const int last = from + KNOT - 1 < strip->count ? from + KNOT - 1 : strip->count - 1;
        const int end = at + 3 * KNOT > last ? at + 3 * KNOT : last;
        /* only if they are neighbours in a row, from the first solved sample to the last */
        if (strip->y[at] == strip->y[end] && strip->x[end] - strip->x[at] == (REAL)(end - at))
            guess_run(&knots, how, first, from, strip);
    }
}

#else

static void guess_between(Evaluate *evaluate, const SHAPE *shape, const RAYS *rays,
                          const NEWTON *how, STRIP *strip)
{
    (void)evaluate, (void)shape, (void)rays, (void)how, (void)strip;
}

#endif

/* Repeats the last step of `polish` from the stored u, v, if wx indicates that there was one.
   The same functions on the same (u, v): P has the bits of the frame that filled the cache. */
static void resume_strip(Evaluate *evaluate, const SHAPE *shape, const RAYS *rays,
                         const NEWTON *how, STRIP *strip)
{
    begin(evaluate, shape, strip);
    aim_strip(rays, how, strip);
    EACH(i, strip)
    {
        strip->f[i] = strip->wx[i];
    }
    land_strip(rays, strip);
}

/* n and |N| of sample i from Pu x Pv; returns 1 if that is so short that the direction of approach decides.
   N / |N| loses all digits where Pu x Pv is as small as its rounding, as at a pole of a patch. */
ALWAYS int put_cross(REAL noise, STRIP *strip, int i)
{
    const VEC none = { 0, 0, 0 };
    POINT at;
    VEC n = v_cross(LOAD3(strip, pu, i), LOAD3(strip, pv, i));
    FN(frame_from_n)(n, none, none, &at);
    STORE3(strip, n, i, at.n_unit);
    strip->n_len[i] = at.n_len;
    return r_abs(n.x) + r_abs(n.y) + r_abs(n.z) > noise ? 0 : 1;
}

/* n and |N| of all samples; false if one is so short. */
ALWAYS bool cross_strip(REAL noise, STRIP *strip)
{
    const int count = strip->count;
    int thin = 0;
    SIMD_SUM(thin) for (int i = 0; i < count; i++)
    {
        thin += put_cross(noise, strip, i);
    }
    return thin == 0;
}

/* Surfaces whose normal costs more than everything else: it is computed after Newton's method has ended.
   Newton's method is slow for them, so better start values pay. */
#define LATE(name) (WR_SURFACE_##name == WR_SURFACE_bezier)

/* n and |N|, which `polish` left out. */
ALWAYS void frame_strip(Formula *const formula, const SHAPE *shape, STRIP *strip)
{
    if (!cross_strip(FN(bezier_noise)(shape), strip)) geometry_strip(formula, shape, 0, strip);
}

/* The surface whose formula is a program, evaluated for many samples at a time. */
#define RUNS(name) (WR_SURFACE_##name == WR_SURFACE_formula)

/* Evaluates up to LANES samples of such a surface, from u, v on; missing ones repeat the last.
   A formula's program is interpreted once for LANES samples: the cost of its interpretation is shared. */
static void run_lanes(const SHAPE *shape, int count, const REAL *u, const REAL *v, POINT *at)
{
    REAL own_u[LANES], own_v[LANES];
    for (int i = 0; i < LANES; i++) {
        const int from = i < count ? i : count - 1;
        own_u[i] = u[from], own_v[i] = v[from];
    }
    FN(formula_many)(shape, LANES, own_u, own_v, at);
}

static void run_points(const SHAPE *shape, int count, const REAL *u, const REAL *v, REAL *x,
                       REAL *y, REAL *z)
{
    POINT at[LANES];
    for (int from = 0; from < count; from += LANES) {
        const int n = count - from < LANES ? count - from : LANES;
        run_lanes(shape, n, u + from, v + from, at);
        for (int i = 0; i < n; i++)
            x[from + i] = at[i].p.x, y[from + i] = at[i].p.y, z[from + i] = at[i].p.z;
    }
}

/* turns: n_u and n_v; else the frame. */
static void run_geometry(const SHAPE *shape, bool turns, STRIP *strip)
{
    POINT at[LANES];
    const int count = strip->count;
    for (int from = 0; from < count; from += LANES) {
        const int n = count - from < LANES ? count - from : LANES;
        run_lanes(shape, n, strip->u + from, strip->v + from, at);
        for (int k = 0; k < n; k++) {
            const int i = from + k;
            if (turns) {
                STORE3(strip, nu, i, at[k].n_u);
                STORE3(strip, nv, i, at[k].n_v);
                continue;
            }
            STORE3(strip, p, i, at[k].p);
            STORE3(strip, pu, i, at[k].pu);
            STORE3(strip, pv, i, at[k].pv);
            STORE3(strip, n, i, at[k].n_unit);
            strip->n_len[i] = at[k].n_len;
        }
    }
}

/* As put_there, for a strip filled up to whole vectors. */
static void run_there(const SHAPE *shape, int first, int to, STRIP *strip)
{
    POINT at[LANES];
    for (int from = first; from < to; from += LANES) {
        run_lanes(shape, LANES, strip->tu + from, strip->tv + from, at);
        for (int k = 0; k < LANES; k++) {
            const int i = from + k;
            STORE3(strip, b, i, at[k].p);
            STORE3(strip, l, i, at[k].pu);
            STORE3(strip, v, i, at[k].pv);
            strip->dr[i] = at[k].n_unit.x, strip->dg[i] = at[k].n_unit.y;
            strip->db[i] = at[k].n_unit.z, strip->n_dot_l[i] = at[k].n_len;
        }
    }
}

/* Each surface's kernels. */
#define SURFACE_KERNELS(name)                                                                      \
    FLAT static void kern_points_##name(const SHAPE *shape, int count, const REAL *u,              \
                                        const REAL *v, REAL *x, REAL *y, REAL *z)                  \
    {                                                                                              \
        if (RUNS(name)) run_points(shape, count, u, v, x, y, z);                                   \
        else points_strip(FN(name##_at), shape, count, u, v, x, y, z);                             \
    }                                                                                              \
    FLAT static void kern_geometry_##name(const SHAPE *shape, int face, STRIP *strip)              \
    {                                                                                              \
        if (RUNS(name)) run_geometry(shape, false, strip);                                         \
        else geometry_strip(FN(name##_at), shape, face, strip);                                    \
    }                                                                                              \
    FLAT static void kern_curvature_##name(const SHAPE *shape, int face, STRIP *strip)             \
    {                                                                                              \
        if (RUNS(name)) run_geometry(shape, true, strip);                                          \
        else curvature_strip(FN(name##_at), shape, face, strip);                                   \
    }                                                                                              \
    APART FLAT static void evaluate_##name(const SHAPE *shape, int from, int to, STRIP *strip)     \
    {                                                                                              \
        if (RUNS(name)) {                                                                          \
            run_there(shape, from, to, strip);                                                     \
            return;                                                                                \
        }                                                                                          \
        const SHAPE own = *shape; /* a copy: for the compiler, no store can change it */           \
        FN(BezierPlane) ready;                                                                     \
        const Patch still = { &own, &ready };                                                      \
        if (LATE(name)) FN(bezier_ready)(&own, &ready);                                            \
        for (int at = from; at < to; at += LANES) SIMD for (int i = at; i < at + LANES; i++)       \
            {                                                                                      \
                put_there(FN(name##_at), &still, LATE(name), strip, i);                            \
            }                                                                                      \
    }                                                                                              \
    static void kern_polish_##name(const RAYS *rays, const SHAPE *shape, const NEWTON *how,        \
                                   STRIP *strip)                                                   \
    {                                                                                              \
        if (LATE(name)) guess_between(evaluate_##name, shape, rays, how, strip);                   \
        polish_strip(evaluate_##name, shape, rays, how, strip);                                    \
    }                                                                                              \
    static void kern_resume_##name(const RAYS *rays, const SHAPE *shape, const NEWTON *how,        \
                                   STRIP *strip)                                                   \
    {                                                                                              \
        resume_strip(evaluate_##name, shape, rays, how, strip);                                    \
    }                                                                                              \
    FLAT static void kern_frame_##name(const SHAPE *shape, STRIP *strip)                           \
    {                                                                                              \
        if (LATE(name)) frame_strip(FN(name##_at), shape, strip);                                  \
    }

#define WR_X(name) SURFACE_KERNELS(name)
#include "surface/surface_list.h"
