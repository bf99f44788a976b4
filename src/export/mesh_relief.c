/* Relief on an imported mesh as triangles in millimetres.

   Inside a face the exact surface is E = P + F n: P on the flat face, n the interpolated unit normal of its corners,
   F the table at the interpolated (u,v). Faces are bisected at their longest side until E's samples are within `error`
   of their triangle.

   A side is bisected in all triangles that share it, at one new point; so no side ever has a vertex of another
   triangle inside it, for any number of triangles about it: the result is closed where the mesh is, open where it
   is open. Before a side is bisected, it must be the longest of all its triangles: the triangle across a longer one
   is bisected first (longest-edge propagation, Rivara 1997). Lengths are those on the mesh without relief, equal for
   all triangles of a side, and ties are broken by the numbers of the points: so each step of the propagation goes to
   a longer side, and it ends.

   Where faces of different normals n_i or heights F_i meet (hard edges, seams of (u,v)), E has several values. The
   point gets one d with n_i . d = F_i, by least squares: a plane displaced along its normal stays a plane up to
   its edges. In the triangles there the samples cannot all be met; they are bisected until their longest side is
   below the error, and the step is as narrow as that. */
#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "export/job.h"
#include "export/solid_body.h"
#include "field/field.h"
#include "scene/scene.h"
#include "surface/triangles.h"

#include <math.h>
#include <string.h>

#define PIECE 128           /* triangles measured by one thread at a time */
#define SMALLEST (1.0 / 64) /* longest side of a triangle that is bisected, in errors */
#define SAMPLES_MAX 4096    /* of a triangle along u or v, or along a side */
#define FINE_MAX 16e6       /* texels on the mesh; above it only their centres are sampled */
#define SHARE 1e-3          /* of the error: F that differ by less are one */
#define ONE_NORMAL 0.99996  /* cosine of half a degree: normals that differ by less are one */
#define SOFT 0.03       /* damping of least squares: limits steps between nearly equal normals */
#define LIMIT_ROUNDS 40 /* halvings of the heights of folded triangles */

/* A place on a face: weights of its corners 1 and 2. They are sums of halves, so floats are exact. */
typedef struct Location {
    int32_t face;
    float b[2];
} Location;

/* Side k runs from corner k to the next one. Sides of all triangles on the same two points form a ring. */
typedef struct Triangle {
    int32_t point[3], face;
    float b[3][2];   /* of its corners on the face */
    int32_t ring[3]; /* the next side, 3 triangle + k, of side k's ring; itself on an open edge */
    float error;     /* mm: largest distance of its samples; below 0: not measured */
    int32_t longest; /* side */
} Triangle;

typedef struct Point {
    WrVec3 base, d; /* on the mesh; displacement: object units */
    double part;    /* of d that is applied: 1 unless folds are limited */
    bool crease;    /* faces of different normals or heights meet here */
} Point;

typedef struct Relief {
    WrExportJob *job;
    const WrTriangles *mesh;
    WrSolidBody *body;
    double error, scale;    /* mm; mm per object unit */
    WrVec3 stretch, middle; /* a point is (stretch (base + part d) - middle) scale */
    double texels[2];       /* of the table per unit of u and v */
    double fine;            /* samples per texel along u and v */
    double low, high;       /* of F at points */
    WR_ARRAY(Triangle) triangles;
    WR_ARRAY(Point) points;
} Relief;

/* ---- the exact surface ---- */

static WrVec3 vec_of(const float x[3])
{
    return (WrVec3){ (double)x[0], (double)x[1], (double)x[2] };
}

static const WrTriangleCorner *corner_of(const Relief *r, int32_t face, int k)
{
    return &r->mesh->corners[r->mesh->triangles[face].corner[k]];
}

typedef struct Place {
    WrVec3 p, n;
    double u, v;
} Place;

static Place place_at(const Relief *r, int32_t face, double b1, double b2)
{
    const WrTriangleCorner *c[3];
    const double w[3] = { 1.0 - b1 - b2, b1, b2 };
    Place at = { 0 };
    for (int k = 0; k < 3; k++) {
        c[k] = corner_of(r, face, k);
        at.p = v3_mad(at.p, vec_of(c[k]->p), w[k]);
        at.n = v3_mad(at.n, vec_of(c[k]->n), w[k]);
        at.u += w[k] * (double)c[k]->u;
        at.v += w[k] * (double)c[k]->v;
    }
    at.n = v3_unit(at.n, vec_of(c[0]->n));
    return at;
}

static bool is_mapped(const Relief *r, int32_t face)
{
    int i = 0;
    while (face >= r->mesh->parts[i].first + r->mesh->parts[i].count) i++;
    return r->mesh->parts[i].mapped;
}

static WrVec3 to_mm(const Relief *r, WrVec3 p)
{
    return (WrVec3){ (r->stretch.x * p.x - r->middle.x) * r->scale,
                     (r->stretch.y * p.y - r->middle.y) * r->scale,
                     (r->stretch.z * p.z - r->middle.z) * r->scale };
}

/* ---- points ---- */

/* M^-1 b of a symmetric matrix with positive determinant, by cross products of its rows. */
static WrVec3 solve(const WrVec3 row[3], WrVec3 b)
{
    const WrVec3 x = v3_cross(row[1], row[2]), y = v3_cross(row[2], row[0]),
                 z = v3_cross(row[0], row[1]);
    const WrVec3 sum = v3_mad(v3_mad(v3_scale(x, b.x), y, b.y), z, b.z);
    return v3_scale(sum, 1.0 / v3_dot(row[0], x));
}

/* d of least squares with n_i . d = f_i, by iterated Tikhonov regularisation: d += (A + SOFT I)^-1 (b - A d),
   A = mean of n n^T, b = mean of f n. Six rounds leave 3e-7 of the error at the corner of a cube (A = I / 3), and hardly move along
   directions in which A is small, those between nearly equal normals. */
static WrVec3 least_squares(const WrVec3 *n, const double *f, int count)
{
    WrVec3 a[3] = { { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 } }, b = { 0, 0, 0 }, d = b;
    for (int i = 0; i < count; i++) {
        a[0] = v3_mad(a[0], n[i], n[i].x / count);
        a[1] = v3_mad(a[1], n[i], n[i].y / count);
        a[2] = v3_mad(a[2], n[i], n[i].z / count);
        b = v3_mad(b, n[i], f[i] / count);
    }
    const WrVec3 m[3] = { { a[0].x + SOFT, a[0].y, a[0].z },
                          { a[1].x, a[1].y + SOFT, a[1].z },
                          { a[2].x, a[2].y, a[2].z + SOFT } };
    for (int round = 0; round < 6; round++) {
        const WrVec3 ad = { v3_dot(a[0], d), v3_dot(a[1], d), v3_dot(a[2], d) };
        d = v3_add(d, solve(m, v3_sub(b, ad)));
    }
    return d;
}

static void displace(Relief *r, const Location *locations, int count, Point *point)
{
    WrVec3 sum = { 0, 0, 0 };
    double mean = 0.0;
    WrVec3 *n = wr_alloc((size_t)count, sizeof *n);
    double *f = wr_alloc((size_t)count, sizeof *f);
    for (int i = 0; i < count; i++) {
        const Location *l = &locations[i];
        const Place at = place_at(r, l->face, (double)l->b[0], (double)l->b[1]);
        n[i] = at.n;
        if (is_mapped(r, l->face))
            wr_scene_height(r->job->scene, r->job->field, at.u, at.v, &f[i], NULL, NULL);
        r->low = fmin(r->low, f[i]);
        r->high = fmax(r->high, f[i]);
        sum = v3_add(sum, n[i]);
        mean += f[i] / count;
    }
    const WrVec3 middle = v3_unit(sum, n[0]);
    bool crease = false, heights = false;
    for (int i = 0; i < count; i++) {
        crease |= v3_dot(n[i], middle) < ONE_NORMAL;
        heights |= fabs(f[i] - mean) * r->scale > SHARE * r->error;
    }
    point->d = crease && !r->job->options.solid_rounded ? least_squares(n, f, count)
                                                        : v3_scale(middle, mean);
    point->crease = crease || heights;
    point->part = 1.0;
    wr_free(n);
    wr_free(f);
}

static void put_point(const Relief *r, int32_t i)
{
    const Point *point = &r->points.data[i];
    const WrVec3 p = to_mm(r, v3_mad(point->base, point->d, point->part));
    r->body->points[i][0] = (float)p.x;
    r->body->points[i][1] = (float)p.y;
    r->body->points[i][2] = (float)p.z;
}

static int32_t add_point(Relief *r, WrVec3 base, const Location *locations, int count)
{
    Point point = { .base = base };
    displace(r, locations, count, &point);
    wr_array_push(&r->points, point);
    const int32_t index = wr_solid_body_add_point(r->body, (const float[3]){ 0 });
    put_point(r, index);
    return index;
}

/* ---- the mesh without relief ---- */

/* Order of sides: by length, then by the numbers of their points; true if side a is before b. */
static bool shorter(const Relief *r, const Triangle *t, int a, int b)
{
    double length[2];
    int32_t low[2], high[2];
    for (int i = 0; i < 2; i++) {
        const int k = i ? b : a;
        const int32_t p = t->point[k], q = t->point[(k + 1) % 3];
        low[i] = p < q ? p : q, high[i] = p < q ? q : p;
        const WrVec3 e = v3_sub(r->points.data[high[i]].base, r->points.data[low[i]].base);
        const WrVec3 s = { r->stretch.x * e.x, r->stretch.y * e.y, r->stretch.z * e.z };
        length[i] = v3_dot(s, s);
    }
    if (length[0] != length[1]) return length[0] < length[1];
    return low[0] != low[1] ? low[0] < low[1] : high[0] < high[1];
}

static void set_longest(const Relief *r, Triangle *t)
{
    t->longest = shorter(r, t, 0, 1) ? 1 : 0;
    if (shorter(r, t, t->longest, 2)) t->longest = 2;
}

/* Length of the longest side, mm. */
static double extent(const Relief *r, const Triangle *t)
{
    const WrVec3 p = to_mm(r, r->points.data[t->point[t->longest]].base);
    return v3_len(v3_sub(to_mm(r, r->points.data[t->point[(t->longest + 1) % 3]].base), p));
}

/* Adds the points of all corners: all corners of equal position are one, in the order of their first. */
static bool add_corners(Relief *r, const int32_t *at, int32_t places, WrError *err)
{
    const int32_t faces = r->mesh->triangle_count;
    int32_t *first = wr_try_alloc((size_t)places + 1, sizeof *first, "a solid", err);
    Location *all = first ? wr_try_alloc(3 * (size_t)faces, sizeof *all, "a solid", err) : NULL;
    for (int32_t i = 0; i < 3 * faces && all; i++)
        first[at[r->mesh->triangles[i / 3].corner[i % 3]] + 1]++;
    for (int32_t i = 0; i < places && all; i++) first[i + 1] += first[i];
    for (int32_t i = 0; i < 3 * faces && all; i++) {
        const int32_t place = at[r->mesh->triangles[i / 3].corner[i % 3]];
        all[first[place]++] = (Location){ i / 3, { i % 3 == 1, i % 3 == 2 } };
    }
    for (int32_t i = 0, from = 0; i < places && all; from = first[i++]) {
        const Place p = place_at(r, all[from].face, (double)all[from].b[0], (double)all[from].b[1]);
        add_point(r, p.p, all + from, first[i] - from);
    }
    wr_free(all);
    wr_free(first);
    return all != NULL;
}

typedef struct Pair {
    int32_t low, high;
} Pair;

static Pair pair_of(const Triangle *t, int k)
{
    const int32_t p = t->point[k], q = t->point[(k + 1) % 3];
    return (Pair){ p < q ? p : q, p < q ? q : p };
}

/* Links the sides with equal points into rings. */
static bool link_sides(Relief *r, WrError *err)
{
    const int32_t sides = 3 * r->triangles.count;
    int32_t kinds = 0;
    Pair *pairs = wr_try_alloc((size_t)sides, sizeof *pairs, "a solid", err);
    int32_t *kind = pairs ? wr_try_alloc((size_t)sides, sizeof *kind, "a solid", err) : NULL;
    for (int32_t i = 0; i < sides && kind; i++)
        pairs[i] = pair_of(&r->triangles.data[i / 3], i % 3);
    bool good = kind && wr_weld(pairs, sizeof *pairs, sides, kind, &kinds, err);
    int32_t *last = good ? wr_try_alloc((size_t)kinds, sizeof *last, "a solid", err) : NULL;
    for (int32_t i = 0; i < sides && last; i++) { /* last: 1 + latest side of the ring */
        int32_t *own = &r->triangles.data[i / 3].ring[i % 3];
        *own = i;
        if (last[kind[i]] > 0) {
            int32_t *before =
                &r->triangles.data[(last[kind[i]] - 1) / 3].ring[(last[kind[i]] - 1) % 3];
            *own = *before;
            *before = i;
        }
        last[kind[i]] = i + 1;
    }
    good = last != NULL;
    wr_free(last);
    wr_free(kind);
    wr_free(pairs);
    return good;
}

static bool add_faces(Relief *r, WrError *err)
{
    const WrTriangles *mesh = r->mesh;
    float(*p)[3] = wr_try_alloc((size_t)mesh->corner_count, sizeof *p, "a solid", err);
    int32_t *at = p ? wr_try_alloc((size_t)mesh->corner_count, sizeof *at, "a solid", err) : NULL;
    int32_t places = 0;
    for (int32_t i = 0; i < mesh->corner_count && at; i++)
        memcpy(p[i], mesh->corners[i].p, sizeof *p);
    const bool good = at && wr_weld(p, sizeof *p, mesh->corner_count, at, &places, err) &&
                      add_corners(r, at, places, err);
    for (int32_t i = 0; i < mesh->triangle_count && good; i++) {
        Triangle t = { .face = i, .error = -1.0F, .b = { { 0, 0 }, { 1, 0 }, { 0, 1 } } };
        for (int k = 0; k < 3; k++) t.point[k] = at[mesh->triangles[i].corner[k]];
        set_longest(r, &t);
        wr_array_push(&r->triangles, t);
    }
    wr_free(at);
    wr_free(p);
    return good && link_sides(r, err);
}

/* ---- bisection ---- */

static int32_t *ring_of(Relief *r, int32_t side)
{
    return &r->triangles.data[side / 3].ring[side % 3];
}

/* The side before this one in its ring. */
static int32_t before(Relief *r, int32_t side)
{
    int32_t at = side;
    while (*ring_of(r, at) != side) at = *ring_of(r, at);
    return at;
}

/* Triangle (a, b, c) with longest side a b becomes (a, m, c) and a new one, (m, b, c); the sides a m and m b are not
   linked yet. Returns the new one's number. */
static int32_t halve(Relief *r, int32_t index, int32_t m)
{
    const Triangle t = r->triangles.data[index];
    const int k = t.longest, l = (k + 1) % 3, n = (k + 2) % 3;
    const int32_t bc = 3 * index + l, ca = 3 * index + n, other = r->triangles.count;
    const int32_t before_bc = before(r, bc), before_ca = before(r, ca);
    const float mb[2] = { (t.b[k][0] + t.b[l][0]) / 2, (t.b[k][1] + t.b[l][1]) / 2 };
    Triangle a = { { t.point[k], m, t.point[n] },
                   t.face,
                   { { t.b[k][0], t.b[k][1] }, { mb[0], mb[1] }, { t.b[n][0], t.b[n][1] } },
                   { 0, 3 * other + 2, t.ring[n] == ca ? 3 * index + 2 : t.ring[n] },
                   -1.0F,
                   0 };
    Triangle b = { { m, t.point[l], t.point[n] },
                   t.face,
                   { { mb[0], mb[1] }, { t.b[l][0], t.b[l][1] }, { t.b[n][0], t.b[n][1] } },
                   { 0, t.ring[l] == bc ? 3 * other + 1 : t.ring[l], 3 * index + 1 },
                   -1.0F,
                   0 };
    set_longest(r, &a);
    set_longest(r, &b);
    r->triangles.data[index] = a;
    wr_array_push(&r->triangles, b);
    if (before_bc != bc) *ring_of(r, before_bc) = 3 * other + 1;
    if (before_ca != ca) *ring_of(r, before_ca) = 3 * index + 2;
    return other;
}

/* Bisects all triangles of a side's ring, for all of which it is the longest. */
static void bisect(Relief *r, int32_t side)
{
    WR_ARRAY(int32_t) ring = { 0 };
    WR_ARRAY(Location) locations = { 0 };
    int32_t at = side;
    do {
        const Triangle *t = &r->triangles.data[at / 3];
        const float *p = t->b[at % 3], *q = t->b[(at % 3 + 1) % 3];
        const Location l = { t->face, { (p[0] + q[0]) / 2, (p[1] + q[1]) / 2 } };
        wr_array_push(&ring, at);
        wr_array_push(&locations, l);
        at = t->ring[at % 3];
    } while (at != side);
    const Pair ends = pair_of(&r->triangles.data[side / 3], side % 3);
    const WrVec3 base =
        v3_scale(v3_add(r->points.data[ends.low].base, r->points.data[ends.high].base), 0.5);
    const int32_t m = add_point(r, base, locations.data, locations.count);
    int32_t half[2] = { -1, -1 }; /* a side of each half's ring so far */
    for (int i = 0; i < ring.count; i++) {
        const int32_t index = ring.data[i] / 3, other = halve(r, index, m);
        const bool low = r->triangles.data[index].point[0] == ends.low;
        const int32_t own[2] = { low ? 3 * index : 3 * other, low ? 3 * other : 3 * index };
        for (int h = 0; h < 2; h++) {
            *ring_of(r, own[h]) = half[h] < 0 ? own[h] : *ring_of(r, half[h]);
            if (half[h] >= 0) *ring_of(r, half[h]) = own[h];
            half[h] = own[h];
        }
    }
    wr_array_free(&ring);
    wr_array_free(&locations);
}

/* A side of the ring of this triangle's longest side that is not the longest of its own triangle; -1: none. */
static int32_t longer_across(Relief *r, int32_t triangle)
{
    const int32_t side = 3 * triangle + r->triangles.data[triangle].longest;
    for (int32_t at = *ring_of(r, side); at != side; at = *ring_of(r, at))
        if (r->triangles.data[at / 3].longest != at % 3) return at;
    return -1;
}

/* Bisects the triangle, after those that lie across longer sides. */
static void refine(Relief *r, int32_t triangle)
{
    while (r->triangles.data[triangle].error >= 0.0F) {
        int32_t at = triangle, across;
        while ((across = longer_across(r, at)) >= 0) at = across / 3;
        bisect(r, 3 * at + r->triangles.data[at].longest);
    }
}

/* ---- errors ---- */

/* Samples of a triangle: all centres of texels in it, and points between them, where the table's kinks and extremes
   are; and points along its sides. `fine` points per texel, odd so that texels' centres are among them. */
typedef struct Samples {
    const Relief *relief;
    const Triangle *triangle;
    WrFacet facet;
    Place corner[3];
    bool mapped;
    double worst; /* squared distance of the farthest */
    int count;
    Place at[WR_HEIGHTS_RUN];
} Samples;

/* Measures the collected samples; false: the error is exceeded already, or cancelled. */
static bool measure(Samples *s)
{
    const Relief *r = s->relief;
    double u[WR_HEIGHTS_RUN], v[WR_HEIGHTS_RUN], f[WR_HEIGHTS_RUN] = { 0 };
    for (int i = 0; i < s->count; i++) u[i] = s->at[i].u, v[i] = s->at[i].v;
    if (s->mapped) wr_scene_heights(r->job->scene, r->job->field, s->count, u, v, f);
    for (int i = 0; i < s->count; i++) {
        const WrVec3 p = v3_mad(s->at[i].p, s->at[i].n, f[i]);
        const double d = wr_facet_distance2(&s->facet, to_mm(r, p));
        if (!(d <= s->worst)) s->worst = d;
    }
    s->count = 0;
    return s->worst <= r->error * r->error && !wr_progress_stopped();
}

/* w1, w2: weights of the triangle's corners 1 and 2. */
static bool add_sample(Samples *s, double w1, double w2)
{
    const float(*b)[2] = s->triangle->b;
    const double w0 = 1.0 - w1 - w2;
    s->at[s->count++] =
        place_at(s->relief, s->triangle->face,
                 w0 * (double)b[0][0] + w1 * (double)b[1][0] + w2 * (double)b[2][0],
                 w0 * (double)b[0][1] + w1 * (double)b[1][1] + w2 * (double)b[2][1]);
    return s->count < WR_HEIGHTS_RUN || measure(s);
}

/* Lattice points on one axis from low to high, at (i + 1/2) step: the first, and the step between. */
static double lattice(double texels, double low, double high, double *step)
{
    *step = 1.0 / texels;
    *step *= fmax(ceil((high - low) * texels / SAMPLES_MAX), 1.0);
    return (ceil(low / *step - 0.5) + 0.5) * *step;
}

static bool sample_texels(Samples *s)
{
    const Place *c = s->corner;
    const double du[2] = { c[1].u - c[0].u, c[2].u - c[0].u };
    const double dv[2] = { c[1].v - c[0].v, c[2].v - c[0].v };
    const double det = du[0] * dv[1] - du[1] * dv[0], fine = s->relief->fine;
    if (!(fabs(det) > 1e-9 * (fabs(du[0] * dv[1]) + fabs(du[1] * dv[0])))) return true;
    const double low = fmin(c[0].v, fmin(c[1].v, c[2].v)),
                 high = fmax(c[0].v, fmax(c[1].v, c[2].v));
    double step_u, step_v;
    for (double v = lattice(fine * s->relief->texels[1], low, high, &step_v); v < high;
         v += step_v) {
        double from = INFINITY, to = -INFINITY; /* the row's part in the triangle */
        for (int k = 0; k < 3; k++) {
            const Place *p = &c[k], *q = &c[(k + 1) % 3];
            if ((p->v <= v) == (q->v <= v)) continue;
            const double u = p->u + (q->u - p->u) * (v - p->v) / (q->v - p->v);
            from = fmin(from, u);
            to = fmax(to, u);
        }
        for (double u = lattice(fine * s->relief->texels[0], from, to, &step_u); u < to;
             u += step_u) {
            const double x = u - c[0].u, y = v - c[0].v;
            if (!add_sample(s, (x * dv[1] - y * du[1]) / det, (y * du[0] - x * dv[0]) / det))
                return false;
        }
    }
    return true;
}

static bool add_on_side(Samples *s, int k, double t)
{
    double w[3] = { 0 };
    w[k] = 1.0 - t;
    w[(k + 1) % 3] = t;
    return add_sample(s, w[1], w[2]);
}

/* The points of side k where one coordinate is that of a lattice point: from..to are its values at the side's ends. */
static bool sample_crossings(Samples *s, int k, double texels, double from, double to)
{
    double step;
    const double high = fmax(from, to);
    for (double x = lattice(s->relief->fine * texels, fmin(from, to), high, &step); x < high;
         x += step)
        if (!add_on_side(s, k, (x - from) / (to - from))) return false;
    return true;
}

/* Points along the sides, at the kinks that F has there, and the middle. */
static bool sample_sides(Samples *s)
{
    const double *texels = s->relief->texels;
    for (int k = 0; k < 3; k++) {
        const Place *p = &s->corner[k], *q = &s->corner[(k + 1) % 3];
        for (int i = 1; i < 4; i++)
            if (!add_on_side(s, k, i / 4.0)) return false;
        if (s->mapped && (!sample_crossings(s, k, texels[0], p->u, q->u) ||
                          !sample_crossings(s, k, texels[1], p->v, q->v)))
            return false;
    }
    return add_sample(s, 1.0 / 3, 1.0 / 3) && measure(s);
}

/* The largest distance of its samples, or one that exceeds the error. */
static double error_of(const Relief *r, const Triangle *t)
{
    Samples s = { .relief = r,
                  .triangle = t,
                  .facet = wr_facet_of(r->body, t->point),
                  .mapped = is_mapped(r, t->face) };
    for (int k = 0; k < 3; k++)
        s.corner[k] = place_at(r, t->face, (double)t->b[k][0], (double)t->b[k][1]);
    if (sample_sides(&s) && (!s.mapped || sample_texels(&s))) measure(&s);
    return sqrt(s.worst);
}

static bool at_crease(const Relief *r, const Triangle *t)
{
    return r->points.data[t->point[0]].crease || r->points.data[t->point[1]].crease ||
           r->points.data[t->point[2]].crease;
}

/* False for a triangle so small that bisection improves nothing. */
static bool can_bisect(const Relief *r, const Triangle *t)
{
    return extent(r, t) > r->error * (at_crease(r, t) ? 1.0 : SMALLEST);
}

typedef struct RefineWork {
    Relief *relief;
    const int32_t *fresh;
    int32_t count;
} RefineWork;

static void measure_piece(int index, int worker, void *ctx)
{
    (void)worker;
    const RefineWork *work = ctx;
    const int32_t end = (index + 1) * PIECE < work->count ? (index + 1) * PIECE : work->count;
    for (int32_t i = index * PIECE; i < end; i++) {
        Triangle *t = &work->relief->triangles.data[work->fresh[i]];
        t->error = (float)error_of(work->relief, t);
    }
}

/* Bisects all that failed. Returns the number of bisections; -1 if there are too many triangles. */
static int32_t refine_bad(Relief *r, const int32_t *fresh, int32_t count)
{
    int32_t done = 0;
    for (int32_t i = 0; i < count; i++) {
        const Triangle *t = &r->triangles.data[fresh[i]];
        if (!((double)t->error > r->error) || !can_bisect(r, t)) continue;
        refine(r, fresh[i]);
        if (r->triangles.count > WR_SOLID_MAX) return -1;
        if (++done % 4096 == 0 && wr_progress_stopped()) return 0;
    }
    return done;
}

static int32_t find_fresh(const Relief *r, int32_t *fresh)
{
    int32_t count = 0;
    for (int32_t i = 0; i < r->triangles.count; i++)
        if (r->triangles.data[i].error < 0.0F) fresh[count++] = i;
    return count;
}

static bool refine_all(Relief *r, WrError *err)
{
    int32_t done = 1;
    for (int round = 0; done > 0; round++) {
        int32_t *fresh = wr_try_alloc((size_t)r->triangles.count, sizeof *fresh, "a solid", err);
        if (!fresh) return false;
        RefineWork work = { r, fresh, find_fresh(r, fresh) };
        wr_pool_run(r->job->pool, (work.count + PIECE - 1) / PIECE, measure_piece, &work);
        done = wr_progress_stopped() ? 0 : refine_bad(r, fresh, work.count);
        wr_free(fresh);
        if (!wr_progress_report(1.0 - 8.0 / (8.0 + round))) return wr_fail(err, "cancelled");
    }
    return done == 0 ||
           wr_fail(
               err,
               "error=%.6g mm needs more than %d triangles: a larger error, a smaller size, or a "
               "coarser mesh",
               r->error, WR_SOLID_MAX);
}

/* ---- folds ---- */

/* True if the relief turned the triangle over: its normal is opposite to that without relief. */
static bool is_folded(const Relief *r, const Triangle *t)
{
    WrVec3 p[3];
    for (int k = 0; k < 3; k++) p[k] = to_mm(r, r->points.data[t->point[k]].base);
    const WrVec3 n = v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0]));
    return v3_dot(n, wr_solid_body_area(r->body, t->point[0], t->point[1], t->point[2])) < 0.0;
}

/* Counts the folded triangles; the place of the one with the largest displacement is the report's. */
static int64_t count_folds(Relief *r)
{
    WrExportReport *report = &r->job->report;
    int64_t count = 0;
    double most = -1.0;
    for (int32_t i = 0; i < r->triangles.count; i++) {
        const Triangle *t = &r->triangles.data[i];
        if (!is_folded(r, t)) continue;
        const Point *point = &r->points.data[t->point[0]];
        const WrVec3 at = to_mm(r, point->base);
        count++;
        if (!(v3_len(point->d) > most)) continue;
        most = v3_len(point->d);
        report->solid_fold[0] = at.x, report->solid_fold[1] = at.y, report->solid_fold[2] = at.z;
    }
    return count;
}

/* Halves the displacement of folded triangles' points until none is folded: at 0 the mesh itself has no fold. */
static void limit_folds(Relief *r)
{
    bool *low = wr_alloc((size_t)r->points.count, sizeof *low);
    for (int round = 0; round < LIMIT_ROUNDS; round++) {
        int32_t count = 0;
        memset(low, 0, (size_t)r->points.count * sizeof *low);
        for (int32_t i = 0; i < r->triangles.count; i++)
            for (int k = 0; k < 3 && is_folded(r, &r->triangles.data[i]); k++)
                low[r->triangles.data[i].point[k]] = true;
        for (int32_t i = 0; i < r->points.count; i++) {
            if (!low[i]) continue;
            r->points.data[i].part = round + 1 < LIMIT_ROUNDS ? r->points.data[i].part / 2 : 0.0;
            put_point(r, i);
            count++;
        }
        if (count == 0) break;
    }
    wr_free(low);
    for (int32_t i = 0; i < r->points.count; i++)
        r->job->report.solid_limited += r->points.data[i].part < 1.0;
}

/* ---- the whole ---- */

/* Millimetres per unit of the mesh: 1, with its own origin, or such that its longest side is `size`. */
static void set_scale(Relief *r)
{
    WrVec3 low = { INFINITY, INFINITY, INFINITY }, high = { -INFINITY, -INFINITY, -INFINITY };
    r->scale = 1.0;
    if (!(r->job->options.solid_size > 0)) return;
    for (int32_t i = 0; i < r->mesh->corner_count; i++) {
        const float *p = r->mesh->corners[i].p;
        const WrVec3 at = { r->stretch.x * (double)p[0], r->stretch.y * (double)p[1],
                            r->stretch.z * (double)p[2] };
        low = (WrVec3){ fmin(low.x, at.x), fmin(low.y, at.y), fmin(low.z, at.z) };
        high = (WrVec3){ fmax(high.x, at.x), fmax(high.y, at.y), fmax(high.z, at.z) };
    }
    const WrVec3 d = v3_sub(high, low);
    r->middle = v3_scale(v3_add(low, high), 0.5);
    r->scale = r->job->options.solid_size / fmax(d.x, fmax(d.y, d.z));
}

/* Texels on the whole mesh; those that several triangles share count for each. */
static double texels_of(const Relief *r)
{
    double sum = 0.0;
    for (int32_t i = 0; i < r->mesh->triangle_count; i++) {
        const WrTriangleCorner *a = corner_of(r, i, 0), *b = corner_of(r, i, 1),
                               *c = corner_of(r, i, 2);
        sum += fabs((double)(b->u - a->u) * (double)(c->v - a->v) -
                    (double)(c->u - a->u) * (double)(b->v - a->v)) /
               2;
    }
    return sum * r->texels[0] * r->texels[1];
}

static void hand_over(Relief *r)
{
    WrExportReport *report = &r->job->report;
    const WrScene *scene = r->job->scene;
    for (int32_t i = 0; i < r->triangles.count; i++) {
        const Triangle *t = &r->triangles.data[i];
        float uv[3][2];
        for (int k = 0; k < 3; k++) {
            const Place at = place_at(r, t->face, (double)t->b[k][0], (double)t->b[k][1]);
            uv[k][0] = (float)(at.u * scene->replicate_u);
            uv[k][1] = (float)(at.v * scene->replicate_v);
        }
        wr_solid_body_add_triangle(r->body, t->point, uv);
        if ((double)t->error <= report->solid_error) continue;
        if (at_crease(r, t) && (double)t->error > r->error) report->solid_steps++;
        else report->solid_error = (double)t->error;
    }
    report->low = r->low;
    report->high = r->high;
    report->solid_open = !r->mesh->closed;
    if (r->stretch.x * r->stretch.y * r->stretch.z < 0) wr_solid_body_reverse(r->body);
}

bool wr_mesh_relief_make(WrExportJob *job, WrSolidBody *body, WrError *err)
{
    Relief r = { .job = job,
                 .mesh = job->scene->triangles,
                 .body = body,
                 .error = job->options.solid_error,
                 .texels = { wr_field_width(job->field) * fabs(job->scene->replicate_u),
                             wr_field_height(job->field) * fabs(job->scene->replicate_v) },
                 .low = INFINITY,
                 .high = -INFINITY };
    WrVec3 cofactor;
    if (!r.mesh) return wr_fail(err, "the mesh has no file: `surface mesh file=FILE` reads one");
    if (!r.mesh->mapped)
        return wr_fail(err, "the mesh has no texture coordinates, which relief needs");
    wr_scene_stretch(job->scene, &r.stretch, &cofactor);
    set_scale(&r);
    r.fine = texels_of(&r) < FINE_MAX ? 3.0 : 1.0;
    const bool good = add_faces(&r, err) && refine_all(&r, err);
    if (good && job->options.solid_limited) limit_folds(&r);
    if (good) {
        job->report.solid_folds = count_folds(&r);
        hand_over(&r);
    }
    wr_array_free(&r.triangles);
    wr_array_free(&r.points);
    return good;
}
