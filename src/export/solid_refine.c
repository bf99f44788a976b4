/* Bisection of triangles that are too far from a sample. Each triangle is measured against all samples inside
   it. All new ones are measured at once, by any number of threads; those that fail are then bisected one after
   the other, so that the result does not depend on the threads. */
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "export/solid.h"

#include <math.h>

#define PIECE 128 /* triangles measured by one thread at a time */
/* relative to the distance of two samples: smaller triangles are not bisected */
#define LEAST 0.0625
#define SLACK 1e-6 /* relative to that distance: samples on a side are in both triangles */

/* ---- distance of a point from a triangle ---- */

typedef struct Facet {
    WrVec3 p[3], side[3]; /* side k runs from corner k to the next */
    WrVec3 in[3];         /* across side k, inwards */
    WrVec3 n;             /* unit */
    double length2[3];
    bool flat; /* it has no area, only sides */
} Facet;

static WrVec3 vec_of(const float at[3])
{
    return (WrVec3){ at[0], at[1], at[2] };
}

static Facet facet_of(const WrSolid *s, const WrSolidTriangle *t)
{
    Facet f;
    for (int k = 0; k < 3; k++) f.p[k] = vec_of(s->points[t->point[k]]);
    for (int k = 0; k < 3; k++) {
        f.side[k] = v3_sub(f.p[(k + 1) % 3], f.p[k]);
        f.length2[k] = v3_dot(f.side[k], f.side[k]);
    }
    const WrVec3 n = v3_cross(f.side[0], f.side[1]);
    f.flat = !(v3_len(n) > 1e-12 * (f.length2[0] + f.length2[1]));
    f.n = v3_unit(n, (WrVec3){ 0, 0, 0 });
    for (int k = 0; k < 3; k++) f.in[k] = v3_cross(f.n, f.side[k]);
    return f;
}

static double from_side2(const Facet *f, int k, WrVec3 p)
{
    const WrVec3 q = v3_sub(p, f->p[k]);
    const double along = f->length2[k] > 0 ? v3_dot(q, f->side[k]) / f->length2[k] : 0.0;
    const WrVec3 d = v3_mad(q, f->side[k], -fmin(fmax(along, 0.0), 1.0));
    return v3_dot(d, d);
}

/* Squared distance of a point. */
static double from_facet2(const Facet *f, WrVec3 p)
{
    bool over = !f->flat;
    for (int k = 0; k < 3 && over; k++) over = v3_dot(v3_sub(p, f->p[k]), f->in[k]) >= 0.0;
    if (over) {
        const double h = v3_dot(v3_sub(p, f->p[0]), f->n);
        return h * h;
    }
    return fmin(from_side2(f, 0, p), fmin(from_side2(f, 1, p), from_side2(f, 2, p)));
}

/* ---- samples in a triangle ---- */

/* Interval of the row v of the domain inside the triangle; false: empty. */
static bool row_of(const WrSolidTriangle *t, double v, double *from, double *to)
{
    *from = INFINITY, *to = -INFINITY;
    for (int k = 0; k < 3; k++) {
        const int n = (k + 1) % 3;
        const double low = fmin(t->v[k], t->v[n]), high = fmax(t->v[k], t->v[n]);
        if (v < low || v > high) continue;
        const double part = high > low ? (v - t->v[k]) / (t->v[n] - t->v[k]) : 0.0;
        const double u = t->u[k] + (t->u[n] - t->u[k]) * part;
        *from = fmin(*from, high > low ? u : fmin(t->u[k], t->u[n]));
        *to = fmax(*to, high > low ? u : fmax(t->u[k], t->u[n]));
    }
    return *from <= *to;
}

static int first_at(double x, double step, double first)
{
    return (int)fmax(ceil(x / step - 0.5 - first - SLACK), 0.0);
}

static int last_at(double x, double step, double first, int count)
{
    return (int)fmin(floor(x / step - 0.5 - first + SLACK), count - 1.0);
}

/* The largest distance of its samples, or one that exceeds `enough`. */
static double error_of(const WrSolid *s, const WrSolidTriangle *t, double enough)
{
    const WrSolidLattice *l = &s->lattice[t->face];
    const Facet facet = facet_of(s, t);
    const double low = fmin(t->v[0], fmin(t->v[1], t->v[2]));
    const double high = fmax(t->v[0], fmax(t->v[1], t->v[2]));
    const int last = last_at(high, l->step_v, l->first_v, l->count_v);
    double worst = 0.0;
    for (int j = first_at(low, l->step_v, l->first_v); j <= last; j++) {
        const double v = (l->first_v + j + 0.5) * l->step_v;
        double from, to;
        if (wr_progress_stopped()) break;
        if (!row_of(t, fmin(fmax(v, low), high), &from, &to)) continue;
        const int end = last_at(to, l->step_u, l->first_u, l->count_u);
        for (int i = first_at(from, l->step_u, l->first_u); i <= end; i++) {
            const float *at = l->at[(size_t)j * (size_t)l->count_u + (size_t)i];
            const double d = from_facet2(&facet, vec_of(at));
            if (!(d <= worst)) worst = d;
        }
        if (!(worst <= enough * enough)) break;
    }
    return sqrt(worst);
}

typedef struct Work {
    WrSolid *solid;
    const int32_t *fresh;
    int32_t count;
} Work;

static void measure_piece(int index, int worker, void *ctx)
{
    (void)worker;
    const Work *work = ctx;
    WrSolid *s = work->solid;
    int32_t end = (index + 1) * PIECE < work->count ? (index + 1) * PIECE : work->count;
    for (int32_t i = index * PIECE; i < end; i++) {
        WrSolidTriangle *t = &s->relief.data[work->fresh[i]];
        t->error = (float)error_of(s, t, s->error);
    }
}

/* ---- bisection ---- */

/* True unless the triangle is smaller than the distance of its samples, where bisection improves nothing. */
static bool can_halve(const WrSolid *s, const WrSolidTriangle *t)
{
    const WrSolidLattice *l = &s->lattice[t->face];
    const double du = fmax(t->u[0], fmax(t->u[1], t->u[2])) - fmin(t->u[0], fmin(t->u[1], t->u[2]));
    const double dv = fmax(t->v[0], fmax(t->v[1], t->v[2])) - fmin(t->v[0], fmin(t->v[1], t->v[2]));
    return du > LEAST * l->step_u || dv > LEAST * l->step_v;
}

static WrSolidSight middle_of(const WrSolidTriangle *t)
{
    return (WrSolidSight){ (t->u[0] + t->u[1]) / 2, (t->v[0] + t->v[1]) / 2, t->face };
}

static int32_t middle_point(WrSolid *s, const WrSolidTriangle *t, const WrSolidTriangle *beyond)
{
    if (t->point[0] == t->point[1]) return t->point[0]; /* a pole */
    WrSolidSight sights[2] = { middle_of(t) };
    int count = 1;
    if (beyond) {
        sights[1] = middle_of(beyond);
        count += sights[1].face != sights[0].face || sights[1].u != sights[0].u ||
                 sights[1].v != sights[0].v;
    }
    return wr_solid_add_point(s, sights, count);
}

/* Replaces a neighbour's number in a triangle. */
static void tell(WrSolid *s, int32_t triangle, int32_t was, int32_t now)
{
    if (triangle < 0) return;
    for (int k = 0; k < 3; k++)
        if (s->relief.data[triangle].across[k] == was) {
            s->relief.data[triangle].across[k] = now;
            return;
        }
}

/* Divides into (2, 0, m), which keeps its number, and (1, 2, m); returns the second's. The neighbour beyond side
   0 1 is set by the caller. */
static int32_t halve(WrSolid *s, int32_t index, int32_t point)
{
    const WrSolidTriangle t = s->relief.data[index];
    const WrSolidSight m = middle_of(&t);
    const int32_t other = s->relief.count;
    const WrSolidTriangle a = {
        { t.point[2], t.point[0], point }, { -1, other, t.across[1] }, t.face, -1.0f,
        { t.u[2], t.u[0], m.u },           { t.v[2], t.v[0], m.v }
    };
    const WrSolidTriangle b = {
        { t.point[1], t.point[2], point }, { index, -1, t.across[0] }, t.face, -1.0f,
        { t.u[1], t.u[2], m.u },           { t.v[1], t.v[2], m.v }
    };
    s->relief.data[index] = a;
    wr_array_push(&s->relief, b);
    tell(s, t.across[0], index, other);
    return other;
}

/* Bisects the two triangles at the longest side of one; before that the neighbour, until that side is its
   longest, too. */
static void refine(WrSolid *s, int32_t index)
{
    int32_t beyond;
    while ((beyond = s->relief.data[index].across[2]) >= 0 &&
           s->relief.data[beyond].across[2] != index)
        refine(s, beyond);
    const WrSolidTriangle *t = &s->relief.data[index];
    const int32_t m = middle_point(s, t, beyond >= 0 ? &s->relief.data[beyond] : NULL);
    const int32_t half = halve(s, index, m);
    if (beyond < 0) return;
    const int32_t far = halve(s, beyond, m);
    s->relief.data[index].across[0] = far;
    s->relief.data[half].across[1] = beyond;
    s->relief.data[beyond].across[0] = half;
    s->relief.data[far].across[1] = index;
}

/* Bisects all that failed. Returns the number of bisections; -1 if there are too many triangles. */
static int32_t halve_bad(WrSolid *s, const int32_t *fresh, int32_t count)
{
    int32_t halved = 0;
    for (int32_t i = 0; i < count; i++) {
        const WrSolidTriangle *t = &s->relief.data[fresh[i]];
        if (!(t->error > s->error) || !can_halve(s, t)) continue;
        refine(s, fresh[i]);
        halved++;
        if (s->relief.count > WR_SOLID_MOST) return -1;
        if (halved % 4096 == 0 && wr_progress_stopped()) return 0;
    }
    return halved;
}

static int32_t find_fresh(const WrSolid *s, int32_t *fresh)
{
    int32_t count = 0;
    for (int32_t i = 0; i < s->relief.count; i++)
        if (s->relief.data[i].error < 0.0f) fresh[count++] = i;
    return count;
}

static bool settle(WrSolid *s, WrError *err)
{
    s->worst = 0.0;
    for (int32_t i = 0; i < s->relief.count; i++)
        if (!(s->relief.data[i].error <= s->worst)) s->worst = s->relief.data[i].error;
    if (s->worst <= s->error) return true;
    return wr_fail(
        err,
        "error=%.6g: the relief cannot be followed so closely: the best is %.3g mm; a larger "
        "error, or a larger size",
        s->error, s->worst);
}

bool wr_solid_refine(WrSolid *solid, WrError *err)
{
    int32_t halved = 1;
    for (int round = 0; halved > 0; round++) {
        int32_t *fresh = wr_try_alloc((size_t)solid->relief.count, sizeof *fresh, "a solid", err);
        if (!fresh) return false;
        Work work = { solid, fresh, find_fresh(solid, fresh) };
        wr_pool_run(solid->pool, (work.count + PIECE - 1) / PIECE, measure_piece, &work);
        halved = wr_progress_stopped() ? 0 : halve_bad(solid, fresh, work.count);
        wr_free(fresh);
        if (!wr_progress_report(1.0 - 8.0 / (8.0 + round))) return wr_fail(err, "cancelled");
    }
    if (halved == 0) return settle(solid, err);
    return wr_fail(err,
                   "error=%.6g mm takes more than %d triangles: a larger error, or a smaller size",
                   solid->error, WR_SOLID_MOST);
}
