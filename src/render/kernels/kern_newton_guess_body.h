/* kern_newton_guess_body.h - start values for Newton's method, interpolated from every eighth sample of a row.

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
