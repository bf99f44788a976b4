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
#include "render/tessellation/mesh_relief.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"
#include "field/scheme_list.h"
#include "render/tessellation/facet.h"
#include "scene/scene.h"
#include "surface/relief_weights.h"
#include "surface/triangles.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define PIECE 128           /* triangles measured by one thread at a time */
#define SMALLEST (1.0 / 64) /* longest side of a triangle that is bisected, in errors */
#define MOST_SAMPLES 64     /* of a triangle along u or v in a picture */
#define SPAN 256            /* texels along u or v: larger triangles are bisected unseen */
#define FORMULA 256         /* samples of a formula per cell */
#define FINE_MAX 4e6        /* texels on the mesh; above it only their centres are sampled */
#define FEW 8               /* faces about a point, without allocation */
#define SHARE 1e-3          /* of the error: F that differ by less are one */
#define ONE_NORMAL 0.99996  /* cosine of half a degree: normals that differ by less are one */
#define SOFT 0.03       /* damping of least squares: limits steps between nearly equal normals */
#define LIMIT_ROUNDS 40 /* halvings of the heights of folded triangles */

/* A place on a face: weights of its corners 1 and 2. They are sums of halves, so floats are exact. */
typedef struct Location {
    int32_t face;
    float b[2];
} Location;

static bool is_stopped(const WrMeshRelief *r)
{
    return wr_progress_stopped() || wr_cancel_requested(r->request.cancel);
}

/* ---- the exact surface ---- */

WrMeshReliefPlace wr_mesh_relief_place(const WrTriangles *mesh, int32_t face, double b1, double b2)
{
    const WrTriangleCorner *c[3];
    const double w[3] = { 1.0 - b1 - b2, b1, b2 };
    WrMeshReliefPlace at = { .face = face, .b1 = b1, .b2 = b2 };
    for (int k = 0; k < 3; k++) {
        c[k] = wr_triangle_corner(mesh, face, k);
        at.p = v3_mad(at.p, v3_load(c[k]->p), w[k]);
        at.n = v3_mad(at.n, v3_load(c[k]->n), w[k]);
        at.u += w[k] * (double)c[k]->u;
        at.v += w[k] * (double)c[k]->v;
    }
    at.n = v3_unit(at.n, v3_load(c[0]->n));
    return at;
}

/* False where F is 0 on the whole face. */
static bool is_mapped(const WrMeshRelief *r, int32_t face)
{
    int i = 0;
    if (!wr_relief_covers(r->request.mesh, face)) return false;
    while (face >= r->request.mesh->parts[i].first + r->request.mesh->parts[i].count) i++;
    return r->request.mesh->parts[i].mapped;
}

/* True where a mask takes all relief. */
static bool is_outside(const WrMeshRelief *r, const Location *l)
{
    WrReliefTap taps[WR_RELIEF_TAPS];
    return r->request.mesh->weights &&
           wr_relief_taps(r->request.mesh, l->face, (double)l->b[0], (double)l->b[1], taps) == 0;
}

/* Heights of the table that are fetched together; each is added to one of the sums. */
typedef struct Fetch {
    double u[WR_HEIGHTS_RUN], v[WR_HEIGHTS_RUN], weight[WR_HEIGHTS_RUN];
    int of[WR_HEIGHTS_RUN], count;
} Fetch;

static void add_fetched(const WrMeshRelief *r, Fetch *fetch, double *sums)
{
    double t[WR_HEIGHTS_RUN];
    wr_scene_heights(r->request.scene, r->request.field, fetch->count, fetch->u, fetch->v, t);
    for (int i = 0; i < fetch->count; i++) sums[fetch->of[i]] += fetch->weight[i] * t[i];
    fetch->count = 0;
}

static void weighted_heights_at(const WrMeshRelief *r, const WrMeshReliefPlace *at, int count,
                                double *f)
{
    Fetch fetch;
    fetch.count = 0;
    for (int i = 0; i < count; i++) {
        WrReliefTap taps[WR_RELIEF_TAPS];
        const int terms = wr_relief_taps(r->request.mesh, at[i].face, at[i].b1, at[i].b2, taps);
        f[i] = 0.0;
        for (int k = 0; k < terms; k++) {
            if (!(taps[k].weight > 0.0)) continue;
            fetch.u[fetch.count] = taps[k].u, fetch.v[fetch.count] = taps[k].v;
            fetch.weight[fetch.count] = taps[k].weight;
            fetch.of[fetch.count++] = i;
            if (fetch.count == WR_HEIGHTS_RUN) add_fetched(r, &fetch, f);
        }
    }
    if (fetch.count > 0) add_fetched(r, &fetch, f);
}

/* F at places of mapped faces; count: up to WR_HEIGHTS_RUN. */
static void heights_at(const WrMeshRelief *r, const WrMeshReliefPlace *at, int count, double *f)
{
    double u[WR_HEIGHTS_RUN], v[WR_HEIGHTS_RUN];
    const WrMeshReliefRequest *ask = &r->request;
    if (ask->mesh->weights) {
        weighted_heights_at(r, at, count, f);
        return;
    }
    for (int i = 0; i < count; i++) u[i] = at[i].u, v[i] = at[i].v;
    wr_scene_heights(ask->scene, ask->field, count, u, v, f);
}

WrVec3 wr_mesh_relief_position(const WrMeshRelief *r, WrVec3 p)
{
    return (WrVec3){ (r->request.stretch.x * p.x - r->request.middle.x) * r->request.scale,
                     (r->request.stretch.y * p.y - r->request.middle.y) * r->request.scale,
                     (r->request.stretch.z * p.z - r->request.middle.z) * r->request.scale };
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

/* Relief ends at the border of a mask, and faces beyond it stay as they are: f becomes 0 on faces whose normal is that
   of a face without relief. Faces at a crease are bound by their own planes, and stay in them anyway; edges that are rounded
   have one normal. Returns the mean of f. */
static double end_at_mask(const WrMeshRelief *r, const WrVec3 *n, const bool *outside, int count,
                          double *f)
{
    double mean = 0.0;
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < count; k++)
            if (outside[k] && (r->request.rounded || v3_dot(n[i], n[k]) >= ONE_NORMAL)) f[i] = 0.0;
        mean += f[i] / count;
    }
    return mean;
}

static void displace(WrMeshRelief *r, const Location *locations, int count,
                     WrMeshReliefPoint *point)
{
    WrVec3 sum = { 0, 0, 0 };
    double mean = 0.0;
    WrVec3 few_n[FEW] = { { 0, 0, 0 } },
           *n = count <= FEW ? few_n : wr_alloc((size_t)count, sizeof *n);
    double few_f[FEW], *f = count <= FEW ? few_f : wr_alloc((size_t)count, sizeof *f);
    bool few_outside[FEW],
        *outside = count <= FEW ? few_outside : wr_alloc((size_t)count, sizeof *outside);
    for (int i = 0; i < count; i++) {
        const Location *l = &locations[i];
        const WrMeshReliefPlace at =
            wr_mesh_relief_place(r->request.mesh, l->face, (double)l->b[0], (double)l->b[1]);
        n[i] = at.n;
        f[i] = 0.0;
        outside[i] = is_outside(r, l);
        if (is_mapped(r, l->face)) heights_at(r, &at, 1, &f[i]);
        r->low = fmin(r->low, f[i]);
        r->high = fmax(r->high, f[i]);
        sum = v3_add(sum, n[i]);
        mean += f[i] / count;
    }
    const WrVec3 middle = v3_unit(sum, n[0]);
    bool crease = false, heights = false;
    for (int i = 0; i < count; i++) {
        crease |= v3_dot(n[i], middle) < ONE_NORMAL;
        heights |= fabs(f[i] - mean) * r->request.scale > SHARE * r->request.error;
    }
    if (r->request.mesh->weights) mean = end_at_mask(r, n, outside, count, f);
    point->d = crease && !r->request.rounded ? least_squares(n, f, count) : v3_scale(middle, mean);
    point->crease = crease || heights;
    point->part = 1.0;
    if (n != few_n) wr_free(n);
    if (f != few_f) wr_free(f);
    if (outside != few_outside) wr_free(outside);
}

void wr_mesh_relief_move(WrMeshRelief *r, int32_t i)
{
    const WrMeshReliefPoint *point = &r->points.data[i];
    const WrVec3 p = wr_mesh_relief_position(r, v3_mad(point->base, point->d, point->part));
    float *at = &r->at.data[3 * i];
    at[0] = (float)p.x, at[1] = (float)p.y, at[2] = (float)p.z;
}

static int32_t add_point(WrMeshRelief *r, WrVec3 base, const Location *locations, int count)
{
    WrMeshReliefPoint point = { .base = base };
    displace(r, locations, count, &point);
    wr_array_push(&r->points, point);
    const int32_t index = r->points.count - 1;
    wr_array_reserve(&r->at, 3 * r->points.count);
    r->at.count = 3 * r->points.count;
    wr_mesh_relief_move(r, index);
    return index;
}

/* ---- the mesh without relief ---- */

/* Order of sides: by length, then by the numbers of their points; true if side a is before b. */
static bool shorter(const WrMeshRelief *r, const WrMeshReliefTriangle *t, int a, int b)
{
    double length[2];
    int32_t low[2], high[2];
    for (int i = 0; i < 2; i++) {
        const int k = i ? b : a;
        const int32_t p = t->point[k], q = t->point[(k + 1) % 3];
        low[i] = p < q ? p : q, high[i] = p < q ? q : p;
        const WrVec3 e = v3_sub(r->points.data[high[i]].base, r->points.data[low[i]].base);
        const WrVec3 s = { r->request.stretch.x * e.x, r->request.stretch.y * e.y,
                           r->request.stretch.z * e.z };
        length[i] = v3_dot(s, s);
    }
    if (length[0] != length[1]) return length[0] < length[1];
    return low[0] != low[1] ? low[0] < low[1] : high[0] < high[1];
}

static void set_longest(const WrMeshRelief *r, WrMeshReliefTriangle *t)
{
    t->longest = shorter(r, t, 0, 1) ? 1 : 0;
    if (shorter(r, t, t->longest, 2)) t->longest = 2;
}

/* Length of the longest side, mm. */
static double extent(const WrMeshRelief *r, const WrMeshReliefTriangle *t)
{
    const WrVec3 p = wr_mesh_relief_position(r, r->points.data[t->point[t->longest]].base);
    return v3_len(
        v3_sub(wr_mesh_relief_position(r, r->points.data[t->point[(t->longest + 1) % 3]].base), p));
}

/* Adds the points of all corners: all corners of equal position are one, in the order of their first. */
static bool add_corners(WrMeshRelief *r, const int32_t *at, int32_t places, WrError *err)
{
    const int32_t faces = r->request.mesh->triangle_count;
    int32_t *first = wr_try_alloc((size_t)places + 1, sizeof *first, "triangles of a relief", err);
    Location *all =
        first ? wr_try_alloc(3 * (size_t)faces, sizeof *all, "triangles of a relief", err) : NULL;
    for (int32_t i = 0; i < 3 * faces && all; i++)
        first[at[r->request.mesh->triangles[i / 3].corner[i % 3]] + 1]++;
    for (int32_t i = 0; i < places && all; i++) first[i + 1] += first[i];
    for (int32_t i = 0; i < 3 * faces && all; i++) {
        const int32_t place = at[r->request.mesh->triangles[i / 3].corner[i % 3]];
        all[first[place]++] = (Location){ i / 3, { i % 3 == 1, i % 3 == 2 } };
    }
    for (int32_t i = 0, from = 0; i < places && all; from = first[i++]) {
        const WrMeshReliefPlace p = wr_mesh_relief_place(
            r->request.mesh, all[from].face, (double)all[from].b[0], (double)all[from].b[1]);
        add_point(r, p.p, all + from, first[i] - from);
    }
    wr_free(all);
    wr_free(first);
    return all != NULL;
}

typedef struct Pair {
    int32_t low, high;
} Pair;

static Pair pair_of(const WrMeshReliefTriangle *t, int k)
{
    const int32_t p = t->point[k], q = t->point[(k + 1) % 3];
    return (Pair){ p < q ? p : q, p < q ? q : p };
}

/* Links the sides with equal points into rings. */
static bool link_sides(WrMeshRelief *r, WrError *err)
{
    const int32_t sides = 3 * r->triangles.count;
    int32_t kinds = 0;
    Pair *pairs = wr_try_alloc((size_t)sides, sizeof *pairs, "triangles of a relief", err);
    int32_t *kind =
        pairs ? wr_try_alloc((size_t)sides, sizeof *kind, "triangles of a relief", err) : NULL;
    for (int32_t i = 0; i < sides && kind; i++)
        pairs[i] = pair_of(&r->triangles.data[i / 3], i % 3);
    bool good = kind && wr_weld(pairs, sizeof *pairs, sides, kind, &kinds, err);
    int32_t *last =
        good ? wr_try_alloc((size_t)kinds, sizeof *last, "triangles of a relief", err) : NULL;
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

static bool add_faces(WrMeshRelief *r, WrError *err)
{
    const WrTriangles *mesh = r->request.mesh;
    float(*p)[3] =
        wr_try_alloc((size_t)mesh->corner_count, sizeof *p, "triangles of a relief", err);
    int32_t *at =
        p ? wr_try_alloc((size_t)mesh->corner_count, sizeof *at, "triangles of a relief", err)
          : NULL;
    int32_t places = 0;
    for (int32_t i = 0; i < mesh->corner_count && at; i++)
        memcpy(p[i], mesh->corners[i].p, sizeof *p);
    const bool good = at && wr_weld(p, sizeof *p, mesh->corner_count, at, &places, err) &&
                      add_corners(r, at, places, err);
    for (int32_t i = 0; i < mesh->triangle_count && good; i++) {
        WrMeshReliefTriangle t = { .face = i,
                                   .error = -1.0F,
                                   .b = { { 0, 0 }, { 1, 0 }, { 0, 1 } } };
        for (int k = 0; k < 3; k++) t.point[k] = at[mesh->triangles[i].corner[k]];
        set_longest(r, &t);
        wr_array_push(&r->triangles, t);
    }
    wr_free(at);
    wr_free(p);
    return good && link_sides(r, err);
}

/* ---- bisection ---- */

static int32_t *ring_of(WrMeshRelief *r, int32_t side)
{
    return &r->triangles.data[side / 3].ring[side % 3];
}

/* The side before this one in its ring. */
static int32_t before(WrMeshRelief *r, int32_t side)
{
    int32_t at = side;
    while (*ring_of(r, at) != side) at = *ring_of(r, at);
    return at;
}

/* Triangle (a, b, c) with longest side a b becomes (a, m, c) and a new one, (m, b, c); the sides a m and m b are not
   linked yet. Returns the new one's number. */
static int32_t halve(WrMeshRelief *r, int32_t index, int32_t m)
{
    const WrMeshReliefTriangle t = r->triangles.data[index];
    const int k = t.longest, l = (k + 1) % 3, n = (k + 2) % 3;
    const int32_t bc = 3 * index + l, ca = 3 * index + n, other = r->triangles.count;
    const int32_t before_bc = before(r, bc), before_ca = before(r, ca);
    const float mb[2] = { (t.b[k][0] + t.b[l][0]) / 2, (t.b[k][1] + t.b[l][1]) / 2 };
    WrMeshReliefTriangle a = {
        { t.point[k], m, t.point[n] },
        t.face,
        { { t.b[k][0], t.b[k][1] }, { mb[0], mb[1] }, { t.b[n][0], t.b[n][1] } },
        { 0, 3 * other + 2, t.ring[n] == ca ? 3 * index + 2 : t.ring[n] },
        -1.0F,
        0.0F,
        0
    };
    WrMeshReliefTriangle b = {
        { m, t.point[l], t.point[n] },
        t.face,
        { { mb[0], mb[1] }, { t.b[l][0], t.b[l][1] }, { t.b[n][0], t.b[n][1] } },
        { 0, t.ring[l] == bc ? 3 * other + 1 : t.ring[l], 3 * index + 1 },
        -1.0F,
        0.0F,
        0
    };
    set_longest(r, &a);
    set_longest(r, &b);
    r->triangles.data[index] = a;
    wr_array_push(&r->triangles, b);
    if (before_bc != bc) *ring_of(r, before_bc) = 3 * other + 1;
    if (before_ca != ca) *ring_of(r, before_ca) = 3 * index + 2;
    return other;
}

/* Bisects all triangles of a side's ring, for all of which it is the longest. */
static void bisect(WrMeshRelief *r, int32_t side)
{
    WR_ARRAY(int32_t) ring = { 0 };
    WR_ARRAY(Location) locations = { 0 };
    int32_t at = side;
    do {
        const WrMeshReliefTriangle *t = &r->triangles.data[at / 3];
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
static int32_t longer_across(WrMeshRelief *r, int32_t triangle)
{
    const int32_t side = 3 * triangle + r->triangles.data[triangle].longest;
    for (int32_t at = *ring_of(r, side); at != side; at = *ring_of(r, at))
        if (r->triangles.data[at / 3].longest != at % 3) return at;
    return -1;
}

/* Bisects the triangle, after those that lie across longer sides. */
static void refine(WrMeshRelief *r, int32_t triangle)
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
    const WrMeshRelief *relief;
    const WrMeshReliefTriangle *triangle;
    WrFacet facet;
    WrMeshReliefPlace corner[3];
    double uv[WR_RELIEF_TAPS + 1][3][2];  /* [planes] of the corners; one plane unless they are
                                              blended, and that of a mask table */
    double texels[WR_RELIEF_TAPS + 1][2]; /* [planes] samples per unit of u and v */
    int planes;
    bool mapped;
    double error;   /* largest allowed distance */
    double worst;   /* squared distance of the farthest */
    int count, run; /* collected; measured at once: more each time, as most errors show early */
    WrMeshReliefPlace *at; /* [WR_HEIGHTS_RUN] */
} Samples;

/* Measures the collected samples; false: the error is exceeded already, or cancelled. */
static bool measure(Samples *s)
{
    const WrMeshRelief *r = s->relief;
    double f[WR_HEIGHTS_RUN];
    for (int i = 0; i < s->count; i++) f[i] = 0.0;
    if (s->mapped) heights_at(r, s->at, s->count, f);
    for (int i = 0; i < s->count; i++) {
        const WrVec3 p = v3_mad(s->at[i].p, s->at[i].n, f[i]);
        const double d = wr_facet_distance2(&s->facet, wr_mesh_relief_position(r, p));
        if (!(d <= s->worst)) s->worst = d;
    }
    s->count = 0;
    if (s->run < WR_HEIGHTS_RUN) s->run *= 2;
    return s->worst <= s->error * s->error && !is_stopped(r);
}

/* w1, w2: weights of the triangle's corners 1 and 2. */
static bool add_sample(Samples *s, double w1, double w2)
{
    const float(*b)[2] = s->triangle->b;
    const double w0 = 1.0 - w1 - w2;
    s->at[s->count++] =
        wr_mesh_relief_place(s->relief->request.mesh, s->triangle->face,
                             w0 * (double)b[0][0] + w1 * (double)b[1][0] + w2 * (double)b[2][0],
                             w0 * (double)b[0][1] + w1 * (double)b[1][1] + w2 * (double)b[2][1]);
    return s->count < s->run || measure(s);
}

/* Lattice points on one axis from low to high, at (i + 1/2) step: the first, and the step between. */
static double lattice(const WrMeshRelief *r, double texels, double low, double high, double *step)
{
    *step = r->request.fine ? 1.0 / texels
                            : fmax(ceil((high - low) * texels / MOST_SAMPLES), 1.0) / texels;
    return (ceil(low / *step - 0.5) + 0.5) * *step;
}

static bool sample_texels(Samples *s, int plane)
{
    const double(*uv)[2] = (const double(*)[2])s->uv[plane], *texels = s->texels[plane];
    const double du[2] = { uv[1][0] - uv[0][0], uv[2][0] - uv[0][0] };
    const double dv[2] = { uv[1][1] - uv[0][1], uv[2][1] - uv[0][1] };
    const double det = du[0] * dv[1] - du[1] * dv[0];
    if (!(fabs(det) > 1e-9 * (fabs(du[0] * dv[1]) + fabs(du[1] * dv[0])))) return true;
    const double low = fmin(uv[0][1], fmin(uv[1][1], uv[2][1])),
                 high = fmax(uv[0][1], fmax(uv[1][1], uv[2][1]));
    double step_u, step_v;
    for (double v = lattice(s->relief, texels[1], low, high, &step_v); v < high; v += step_v) {
        double from = INFINITY, to = -INFINITY; /* the row's part in the triangle */
        for (int k = 0; k < 3; k++) {
            const double *p = uv[k], *q = uv[(k + 1) % 3];
            if ((p[1] <= v) == (q[1] <= v)) continue;
            const double u = p[0] + (q[0] - p[0]) * (v - p[1]) / (q[1] - p[1]);
            from = fmin(from, u);
            to = fmax(to, u);
        }
        for (double u = lattice(s->relief, texels[0], from, to, &step_u); u < to; u += step_u) {
            const double x = u - uv[0][0], y = v - uv[0][1];
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
    for (double x = lattice(s->relief, texels, fmin(from, to), high, &step); x < high; x += step)
        if (!add_on_side(s, k, (x - from) / (to - from))) return false;
    return true;
}

/* Points along the sides, at the kinks that F has there, and the middle. */
static bool sample_sides(Samples *s)
{
    for (int k = 0; k < 3; k++) {
        const int steps = s->relief->request.fine ? 4 : 2;
        for (int i = 1; i < steps; i++)
            if (!add_on_side(s, k, (double)i / steps)) return false;
        for (int j = 0; j < s->planes && steps > 2 && s->mapped; j++) {
            const double *p = s->uv[j][k], *q = s->uv[j][(k + 1) % 3];
            if (!sample_crossings(s, k, s->texels[j][0], p[0], q[0]) ||
                !sample_crossings(s, k, s->texels[j][1], p[1], q[1]))
                return false;
        }
    }
    return add_sample(s, 1.0 / 3, 1.0 / 3) && measure(s);
}

/* Adds the plane in which a mask table lies. A B-spline needs no samples between its texels. */
static void add_mask_plane(Samples *s)
{
    const WrTriangles *mesh = s->relief->request.mesh;
    const WrField *mask = wr_relief_mask(mesh);
    const WrMeshReliefPlace *c = s->corner;
    if (!mask || !s->mapped) return;
    for (int k = 0; k < 3; k++)
        wr_relief_mask_uv(mesh, c[k].face, c[k].b1, c[k].b2, s->uv[s->planes][k]);
    s->texels[s->planes][0] = wr_field_width(mask);
    s->texels[s->planes++][1] = wr_field_height(mask);
}

/* The planes of which F has a part in the triangle; a plane's u jumps where the surface turns to its other side, and
   its part is 0 there. */
static void find_planes(Samples *s)
{
    WrReliefTap taps[4][WR_RELIEF_TAPS];
    const WrMeshReliefPlace *c = s->corner;
    const bool blended = wr_relief_is_blended(s->relief->request.mesh);
    for (int k = 0; k < 3; k++) s->uv[0][k][0] = c[k].u, s->uv[0][k][1] = c[k].v;
    s->planes = 1;
    for (int j = 0; j < WR_RELIEF_TAPS; j++) {
        s->texels[j][0] = s->relief->fine * s->relief->texels[0];
        s->texels[j][1] = s->relief->fine * s->relief->texels[1];
    }
    if (!blended || !s->mapped) return;
    bool covered = true;
    for (int i = 0; i < 4; i++) {
        const double b1 = i < 3 ? c[i].b1 : (c[0].b1 + c[1].b1 + c[2].b1) / 3;
        const double b2 = i < 3 ? c[i].b2 : (c[0].b2 + c[1].b2 + c[2].b2) / 3;
        covered &= wr_relief_taps(s->relief->request.mesh, c[0].face, b1, b2, taps[i]) > 0;
    }
    if (!covered) return; /* where a mask ends: the face's own plane */
    s->planes = 0;
    for (int j = 0; j < WR_RELIEF_TAPS; j++) {
        double part = 0.0;
        for (int i = 0; i < 4; i++) part += taps[i][j].weight;
        if (!(part > 0.0)) continue;
        for (int k = 0; k < 3; k++)
            s->uv[s->planes][k][0] = taps[k][j].u, s->uv[s->planes][k][1] = taps[k][j].v;
        s->planes++;
    }
}

/* False for a triangle over so many texels that sampling it would take long: it is bisected first. */
static bool fits_span(const WrMeshRelief *r, const WrMeshReliefPlace corner[3])
{
    double most = 0.0;
    const WrField *mask = wr_relief_mask(r->request.mesh);
    for (int k = 0; k < 3; k++) {
        const WrMeshReliefPlace *p = &corner[k], *q = &corner[(k + 1) % 3];
        most = fmax(most, fmax(fabs(p->u - q->u) * r->texels[0], fabs(p->v - q->v) * r->texels[1]));
        if (!mask) continue;
        double a[2], b[2];
        wr_relief_mask_uv(r->request.mesh, p->face, p->b1, p->b2, a);
        wr_relief_mask_uv(r->request.mesh, q->face, q->b1, q->b2, b);
        most = fmax(most, fmax(fabs(a[0] - b[0]) * wr_field_width(mask),
                               fabs(a[1] - b[1]) * wr_field_height(mask)));
    }
    return most <= SPAN;
}

static double allowed_error(const WrMeshRelief *r, const WrMeshReliefTriangle *t)
{
    const WrMeshReliefRequest *ask = &r->request;
    if (!ask->error_at) return ask->error;
    const WrVec3 *p[3];
    for (int k = 0; k < 3; k++) p[k] = &r->points.data[t->point[k]].base;
    const WrVec3 centre = v3_scale(v3_add(*p[0], v3_add(*p[1], *p[2])), 1.0 / 3);
    double radius = 0.0;
    for (int k = 0; k < 3; k++) radius = fmax(radius, v3_len(v3_sub(*p[k], centre)));
    return fmax(ask->error, ask->error_at(ask->ctx, centre, radius));
}

/* The largest distance of its samples, or one that exceeds the allowed error. */
static double error_of(const WrMeshRelief *r, const WrMeshReliefTriangle *t)
{
    WrMeshReliefPlace at[WR_HEIGHTS_RUN];
    Samples s = { .relief = r,
                  .at = at,
                  .run = 8,
                  .triangle = t,
                  .facet = wr_facet_of((const float(*)[3])r->at.data, t->point),
                  .mapped = is_mapped(r, t->face),
                  .error = (double)t->allowed };
    if (!(s.error < INFINITY)) return 0.0;
    for (int k = 0; k < 3; k++)
        s.corner[k] =
            wr_mesh_relief_place(r->request.mesh, t->face, (double)t->b[k][0], (double)t->b[k][1]);
    if (r->request.fine && s.mapped && !fits_span(r, s.corner)) return INFINITY;
    find_planes(&s);
    add_mask_plane(&s);
    bool good = sample_sides(&s);
    for (int k = 0; k < s.planes && s.mapped && good; k++) good = sample_texels(&s, k);
    if (good) measure(&s);
    return sqrt(s.worst);
}

bool wr_mesh_relief_at_crease(const WrMeshRelief *r, const WrMeshReliefTriangle *t)
{
    return r->points.data[t->point[0]].crease || r->points.data[t->point[1]].crease ||
           r->points.data[t->point[2]].crease;
}

/* False for a triangle so small that bisection improves nothing. */
static bool can_bisect(const WrMeshRelief *r, const WrMeshReliefTriangle *t)
{
    return extent(r, t) > (double)t->allowed * (wr_mesh_relief_at_crease(r, t) ? 1.0 : SMALLEST);
}

typedef struct RefineWork {
    WrMeshRelief *relief;
    const int32_t *fresh;
    int32_t count;
} RefineWork;

static void measure_piece(int index, int worker, void *ctx)
{
    (void)worker;
    const RefineWork *work = ctx;
    const int32_t end = (index + 1) * PIECE < work->count ? (index + 1) * PIECE : work->count;
    for (int32_t i = index * PIECE; i < end; i++) {
        WrMeshReliefTriangle *t = &work->relief->triangles.data[work->fresh[i]];
        t->allowed = (float)allowed_error(work->relief, t);
        t->error = (float)error_of(work->relief, t);
    }
}

/* Bisects all that failed. Returns the number of bisections. */
static int32_t refine_bad(WrMeshRelief *r, const int32_t *fresh, int32_t count)
{
    int32_t done = 0;
    for (int32_t i = 0; i < count && !r->full; i++) {
        const WrMeshReliefTriangle *t = &r->triangles.data[fresh[i]];
        if (!(t->error > t->allowed) || !can_bisect(r, t)) continue;
        refine(r, fresh[i]);
        r->full = r->triangles.count > r->request.most;
        if (++done % 4096 == 0 && is_stopped(r)) return 0;
    }
    return done;
}

static int32_t find_fresh(const WrMeshRelief *r, int32_t *fresh)
{
    int32_t count = 0;
    for (int32_t i = 0; i < r->triangles.count; i++)
        if (r->triangles.data[i].error < 0.0F) fresh[count++] = i;
    return count;
}

/* Progress 1 - 8 / (8 + round) is an estimate: the number of rounds is unknown before. */
static bool refine_all(WrMeshRelief *r, WrError *err)
{
    int32_t done = 1;
    for (int round = 0; done > 0 && !r->full; round++) {
        int32_t *fresh =
            wr_try_alloc((size_t)r->triangles.count, sizeof *fresh, "triangles of a relief", err);
        if (!fresh) return false;
        RefineWork work = { r, fresh, find_fresh(r, fresh) };
        wr_pool_run(r->request.pool, (work.count + PIECE - 1) / PIECE, measure_piece, &work);
        done = is_stopped(r) ? 0 : refine_bad(r, fresh, work.count);
        wr_free(fresh);
        if (!wr_progress_report(1.0 - 8.0 / (8.0 + round)) || is_stopped(r))
            return wr_fail(err, "cancelled");
    }
    return true;
}

/* ---- the error that fits ---- */

#define MEASURED 4096 /* triangles */
/* Triangles that pass have half the allowed error or more, those that make the mesh conforming have less. */
#define FITTING 1.5

int32_t wr_fitting_error_step(int32_t count)
{
    return count / MEASURED + 1;
}

double wr_fitting_error(double sum, int32_t base, int32_t most)
{
    const double room = 0.8 * most - base;
    return room > 0.0 ? FITTING * sum / room : INFINITY;
}

double wr_mesh_relief_fitting_error(const WrMeshRelief *r)
{
    const int32_t step = wr_fitting_error_step(r->triangles.count);
    const WrVec3 size = r->request.stretch;
    const double most = (r->high - r->low) * fabs(r->request.scale) *
                        fmax(fabs(size.x), fmax(fabs(size.y), fabs(size.z)));
    double sum = 0.0;
    for (int32_t i = 0; i < r->triangles.count; i += step) {
        WrMeshReliefTriangle t = r->triangles.data[i];
        t.allowed = FLT_MAX;
        const double error = error_of(r, &t);
        sum += step * (error < INFINITY ? error : most);
    }
    return wr_fitting_error(sum, r->request.mesh->triangle_count, r->request.most);
}

/* ---- the whole ---- */

/* Texels on the whole mesh; those that several triangles share count for each. */
static double texels_of(const WrMeshRelief *r)
{
    double sum = 0.0;
    for (int32_t i = 0; i < r->request.mesh->triangle_count; i++) {
        const WrTriangleCorner *a = wr_triangle_corner(r->request.mesh, i, 0),
                               *b = wr_triangle_corner(r->request.mesh, i, 1),
                               *c = wr_triangle_corner(r->request.mesh, i, 2);
        if (!wr_relief_covers(r->request.mesh, i)) continue;
        sum += fabs((double)(b->u - a->u) * (double)(c->v - a->v) -
                    (double)(c->u - a->u) * (double)(b->v - a->v)) /
               2;
    }
    return sum * r->texels[0] * r->texels[1];
}

bool wr_mesh_relief_make(WrMeshRelief *r, const WrMeshReliefRequest *request, WrError *err)
{
    const WrScene *scene = request->scene;
    const bool formula = scene->analytic.kind != WR_ANALYTIC_OFF;
    r->request = *request;
    r->texels[0] = fabs(scene->replicate_u) * (formula ? FORMULA : wr_field_width(request->field));
    r->texels[1] = fabs(scene->replicate_v) * (formula ? FORMULA : wr_field_height(request->field));
    /* a bilinear F has its kinks and extremes at texels' centres, and on the lines between them */
    const bool straight =
        !formula && (scene->scheme == WR_SCHEME_BILINEAR || scene->scheme == WR_SCHEME_CENTRAL);
    r->fine = request->fine && !straight && texels_of(r) < FINE_MAX ? 3.0 : 1.0;
    r->low = INFINITY, r->high = -INFINITY;
    if (request->fine && texels_of(r) > 0.5 * SPAN * SPAN * request->most) {
        r->full = true;
        return true;
    }
    return add_faces(r, err) && refine_all(r, err);
}

void wr_mesh_relief_fini(WrMeshRelief *r)
{
    wr_array_free(&r->triangles);
    wr_array_free(&r->points);
    wr_array_free(&r->at);
    *r = (WrMeshRelief){ 0 };
}

WrTriangles *wr_mesh_relief_triangles(const WrMeshRelief *r, int32_t **base_of, WrError *err)
{
    const int32_t count = r->triangles.count, faces = r->request.mesh->triangle_count;
    const char *const purpose = "a displaced surface";
    WrTriangleCorner *corners = wr_try_alloc(3 * (size_t)count, sizeof *corners, purpose, err);
    WrTriangle *triangles =
        corners ? wr_try_alloc((size_t)count, sizeof *triangles, purpose, err) : NULL;
    int32_t *next = triangles ? wr_try_alloc((size_t)faces + 1, sizeof *next, purpose, err) : NULL;
    *base_of = next ? wr_try_alloc((size_t)count, sizeof **base_of, purpose, err) : NULL;
    if (!*base_of) {
        wr_free(next);
        wr_free(triangles);
        wr_free(corners);
        return NULL;
    }
    for (int32_t i = 0; i < count; i++) next[r->triangles.data[i].face + 1]++;
    for (int32_t i = 0; i < faces; i++) next[i + 1] += next[i];
    for (int32_t i = 0; i < count; i++) {
        const WrMeshReliefTriangle *t = &r->triangles.data[i];
        const int32_t to = next[t->face]++;
        (*base_of)[to] = t->face;
        for (int k = 0; k < 3; k++) {
            const float *at = r->at.data + 3 * (size_t)t->point[k];
            triangles[to].corner[k] = 3 * to + k;
            /* + 0 turns -0 into +0, whose bits differ */
            corners[3 * to + k] = (WrTriangleCorner){
                .p = { at[0] + 0.0f, at[1] + 0.0f, at[2] + 0.0f }, .u = t->b[k][0], .v = t->b[k][1]
            };
        }
    }
    wr_free(next);
    WrTriangles *made = wr_alloc(1, sizeof *made);
    *made = (WrTriangles){ .refs = 1,
                           .corners = corners,
                           .triangles = triangles,
                           .corner_count = 3 * count,
                           .triangle_count = count,
                           .faceted = true,
                           .mapped = true,
                           .radius = r->request.mesh->radius };
    return made;
}
