#include "surface/mesh_texels.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "surface/ray_tree.h"
#include "surface/triangles_internal.h"

#include <math.h>
#include <stdlib.h>

#define GUTTER 2.0 /* texels */
#define FOLDED                                                                                     \
    1.6 /* a way longer than this times the straight one leads round a fold; half a circle: 1.57 */
#define FADE 0.17 /* cosine of the angle to the eye's direction where clipping begins: 80 degrees */
#define INSIDE 1e-6  /* texels */
#define FAR 1e9      /* texels */
#define SURFACE 1e-6 /* of the radius: distance from the surface at which rays to the eye begin */
#define LOOK 256     /* triangles between two reports of progress */

/* Bits of a texel. */
enum { COVERED = 1, ONCE = 2, SHARED = 4, COUNTED = 8 };

/* A triangle that the flood has entered by the edge from a to b; for the first one there is none. */
typedef struct Reached {
    int32_t triangle;
    double key;      /* no point of the triangle is nearer */
    double base;     /* length of the way to the source: above 0 behind a corner */
    WrVec3 source;   /* the centre, or such a corner, unfolded into the triangle's plane */
    WrVec3 a, e, in; /* an end of the edge; unit vectors along it, and from it inwards */
    double length;   /* of the edge; 0: none */
} Reached;

/* A texel's place on the surface. */
typedef struct Place {
    int32_t index;
    double beyond; /* texels outside the triangle; 0: inside */
    double d, weight;
    WrVec3 from; /* the centre */
} Place;

struct WrMeshTexels {
    WrTriangles *mesh;
    WrMeshTexelsTable table;
    WrRayTree *tree;
    int32_t *across;  /* [3 triangles] half-edge -> one of a neighbour, or -1 */
    uint8_t *covered; /* [height][width] bits */
    double side;
    int64_t shared;            /* texels with COUNTED */
    bool crossed;              /* the present disc reaches over a seam */
    uint32_t *stamp, now;      /* [triangles] == now: reached by the present disc */
    WR_ARRAY(Reached) heap;    /* the flood's front, nearest first */
    WR_ARRAY(Reached) reached; /* in the order of their distance */
    WR_ARRAY(Place) places;
    WR_ARRAY(WrMeshTexel) texels;
};

/* ---- a triangle in space and in the table ---- */

/* Positions, and texels as in the header. */
typedef struct Flat {
    WrVec3 p[3];
    double x[3], y[3], area2; /* texels, signed */
    double out[3][3];         /* of each edge: a x + b y + c is the distance beyond it */
} Flat;

static WrVec3 corner_at(const WrTriangles *mesh, int32_t triangle, int k)
{
    return v3_load(wr_triangle_corner(mesh, triangle, k)->p);
}

static bool lay_flat(const WrMeshTexels *t, int32_t triangle, Flat *flat)
{
    double most = 0;
    for (int k = 0; k < 3; k++) {
        const WrTriangleCorner *c = wr_triangle_corner(t->mesh, triangle, k);
        flat->p[k] = corner_at(t->mesh, triangle, k);
        flat->x[k] = t->table.width * t->table.ru * (double)c->u - 0.5;
        flat->y[k] = t->table.height * (1 - t->table.rv * (double)c->v) - 0.5;
        most = fmax(most, fmax(fabs(flat->x[k]), fabs(flat->y[k])));
    }
    flat->area2 = (flat->x[1] - flat->x[0]) * (flat->y[2] - flat->y[0]) -
                  (flat->x[2] - flat->x[0]) * (flat->y[1] - flat->y[0]);
    for (int k = 0; k < 3; k++) {
        const double ex = flat->x[(k + 1) % 3] - flat->x[k], ey = flat->y[(k + 1) % 3] - flat->y[k];
        const double by = (flat->area2 > 0 ? -1 : 1) / sqrt(ex * ex + ey * ey);
        flat->out[k][0] = -ey * by, flat->out[k][1] = ex * by;
        flat->out[k][2] = by * (ey * flat->x[k] - ex * flat->y[k]);
    }
    return fabs(flat->area2) > WR_COLLINEAR * most && most < FAR;
}

static WrVec3 normal_of(const WrVec3 p[3])
{
    return v3_unit(v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0])), (WrVec3){ 0, 0, 0 });
}

/* How far (x, y) is outside, in texels along the table; negative inside. */
static double beyond(const Flat *flat, double x, double y)
{
    double most = -INFINITY;
    for (int k = 0; k < 3; k++) {
        const double out = flat->out[k][0] * x + flat->out[k][1] * y + flat->out[k][2];
        most = out > most ? out : most;
    }
    return most;
}

static int wrapped(int i, int size)
{
    const int rest = i % size;
    return rest < 0 ? rest + size : rest;
}

/* Index of a texel, -1 beyond the ends of a clamped axis. */
static int32_t index_of(const WrMeshTexels *t, int x, int y)
{
    const WrMeshTexelsTable *table = &t->table;
    if (!table->periodic_u && (x < 0 || x >= table->width)) return -1;
    if (!table->periodic_v && (y < 0 || y >= table->height)) return -1;
    return wrapped(y, table->height) * table->width + wrapped(x, table->width);
}

/* ---- tables of a mesh ---- */

static void cover(WrMeshTexels *t, const Flat *flat)
{
    const double *x = flat->x, *y = flat->y;
    const int x0 = (int)ceil(fmin(x[0], fmin(x[1], x[2])) - INSIDE);
    const int y0 = (int)ceil(fmin(y[0], fmin(y[1], y[2])) - INSIDE);
    int x1 = (int)floor(fmax(x[0], fmax(x[1], x[2])) + INSIDE);
    int y1 = (int)floor(fmax(y[0], fmax(y[1], y[2])) + INSIDE);
    /* A triangle over several periods covers all texels; two of them show that it shares texels with itself. */
    if (x1 - x0 >= 2 * t->table.width) x1 = x0 + 2 * t->table.width - 1;
    if (y1 - y0 >= 2 * t->table.height) y1 = y0 + 2 * t->table.height - 1;
    for (int j = y0; j <= y1; j++)
        for (int i = x0; i <= x1; i++) {
            const double out = beyond(flat, i, j);
            const int32_t at = out <= INSIDE ? index_of(t, i, j) : -1;
            if (at < 0) continue;
            /* A texel on an edge belongs to both neighbours and is not shared for that. */
            const int strict = out < -INSIDE ? t->covered[at] & ONCE ? SHARED : ONCE : 0;
            t->covered[at] = (uint8_t)(t->covered[at] | COVERED | strict);
        }
}

static void link_edges(WrMeshTexels *t, const WrMeshEdges *edges, int32_t *first)
{
    const int32_t halves = 3 * t->mesh->triangle_count;
    for (int32_t i = 0; i < edges->count; i++) first[i] = -1;
    for (int32_t h = 0; h < halves; h++) {
        int32_t *one = &first[edges->edge[h]];
        t->across[h] = *one;
        if (*one >= 0) t->across[*one] = h;
        *one = *one >= 0 ? -1 : h; /* of more than two faces at an edge, pairs */
    }
}

static bool prepare(WrMeshTexels *t, WrError *err)
{
    const size_t count = (size_t)t->mesh->triangle_count;
    WrMeshEdges edges;
    t->side = wr_mesh_texel_side_of(t->mesh, &t->table);
    if (!(t->side > 0))
        return wr_fail(err, "the mesh has no texture coordinates to paint on: `surface mesh "
                            "projection=box` computes them");
    if (!t->tree) t->tree = wr_ray_tree_new(t->mesh, 0, t->mesh->triangle_count, err);
    if (!t->tree || !wr_mesh_edges_find(t->mesh, &edges, err)) return false;
    int32_t *first = wr_try_alloc((size_t)edges.count, sizeof *first, "a mesh's edges", err);
    t->across = first ? wr_try_alloc(3 * count, sizeof *t->across, "a mesh's edges", err) : NULL;
    if (t->across) link_edges(t, &edges, first);
    wr_free(first);
    wr_mesh_edges_fini(&edges);
    t->stamp = wr_try_alloc(count, sizeof *t->stamp, "a mesh's texels", err);
    t->covered =
        wr_try_alloc((size_t)t->table.width * (size_t)t->table.height, 1, "a mesh's texels", err);
    if (!t->across || !t->stamp || !t->covered) return false;
    for (int32_t i = 0; i < t->mesh->triangle_count; i++) {
        Flat flat;
        if (lay_flat(t, i, &flat)) cover(t, &flat);
    }
    return true;
}

WrMeshTexels *wr_mesh_texels_new(const WrTriangles *mesh, const WrMeshTexelsTable *table,
                                 const WrMeshTexels *before, WrError *err)
{
    const WrRayTree *tree = before ? wr_mesh_texels_tree(before, mesh) : NULL;
    WrMeshTexels *t = wr_alloc(1, sizeof *t);
    t->mesh = wr_triangles_share(mesh);
    t->table = *table;
    t->tree = tree ? wr_ray_tree_share(tree) : NULL;
    if (prepare(t, err)) return t;
    wr_mesh_texels_free(t);
    return NULL;
}

void wr_mesh_texels_free(WrMeshTexels *t)
{
    if (!t) return;
    wr_ray_tree_free(t->tree);
    wr_triangles_free(t->mesh);
    wr_free(t->across);
    wr_free(t->covered);
    wr_free(t->stamp);
    wr_array_free(&t->heap);
    wr_array_free(&t->reached);
    wr_array_free(&t->places);
    wr_array_free(&t->texels);
    wr_free(t);
}

bool wr_mesh_texels_fit(const WrMeshTexels *t, const WrTriangles *mesh,
                        const WrMeshTexelsTable *table)
{
    const WrMeshTexelsTable *own = &t->table;
    return t->mesh->key == mesh->key && own->width == table->width &&
           own->height == table->height && own->periodic_u == table->periodic_u &&
           own->periodic_v == table->periodic_v && own->ru == table->ru && own->rv == table->rv;
}

const WrRayTree *wr_mesh_texels_tree(const WrMeshTexels *t, const WrTriangles *mesh)
{
    return t->mesh->key == mesh->key ? t->tree : NULL;
}

double wr_mesh_texel_side(const WrMeshTexels *t)
{
    return t->side;
}

double wr_mesh_texel_side_of(const WrTriangles *mesh, const WrMeshTexelsTable *table)
{
    const WrMeshTexels t = { .mesh = (WrTriangles *)mesh, .table = *table };
    double area = 0, texels = 0;
    for (int32_t i = 0; i < mesh->triangle_count; i++) {
        Flat flat;
        if (!lay_flat(&t, i, &flat)) continue;
        area += v3_len(v3_cross(v3_sub(flat.p[1], flat.p[0]), v3_sub(flat.p[2], flat.p[0])));
        texels += fabs(flat.area2);
    }
    return texels > 0 ? sqrt(area / texels) : 0;
}

int64_t wr_mesh_texels_shared(const WrMeshTexels *t)
{
    return t->shared;
}

/* ---- points ---- */

WrVec3 wr_mesh_mirrors_at(const WrTriangles *mesh)
{
    const WrVec3 centre = { mesh->centre[0], mesh->centre[1], mesh->centre[2] };
    const WrVec3 origin = { 0, 0, 0 };
    return v3_len(centre) < mesh->radius ? origin : centre;
}

static double clamped(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

/* The foot of p on the plane if that is inside, else the nearest point of the edges. */
static WrVec3 nearest_in(const WrVec3 p[3], WrVec3 n, WrVec3 to)
{
    WrVec3 best = p[0];
    double least = INFINITY;
    bool inside = v3_dot(n, n) > 0;
    for (int k = 0; k < 3; k++) {
        const WrVec3 e = v3_sub(p[(k + 1) % 3], p[k]), from = v3_sub(to, p[k]);
        const double ee = v3_dot(e, e);
        const WrVec3 on = v3_mad(p[k], e, ee > 0 ? clamped(v3_dot(from, e) / ee, 0, 1) : 0);
        const WrVec3 off = v3_sub(to, on);
        if (v3_dot(off, off) < least) least = v3_dot(off, off), best = on;
        inside = inside && v3_dot(v3_cross(e, from), n) >= 0;
    }
    return inside ? v3_mad(to, n, -v3_dot(v3_sub(to, p[0]), n)) : best;
}

WrMeshSpot wr_mesh_texels_nearest(const WrMeshTexels *t, WrVec3 p)
{
    WrMeshSpot spot;
    WrVec3 corner[3];
    wr_ray_tree_nearest(t->tree, p, INFINITY, &spot.triangle);
    for (int k = 0; k < 3; k++) corner[k] = corner_at(t->mesh, spot.triangle, k);
    spot.n = normal_of(corner);
    spot.p = nearest_in(corner, spot.n, p);
    return spot;
}

/* Derivatives of the surface point by the texel position: p changes by dx px + dy py. */
static void slopes_of(const Flat *flat, WrVec3 *px, WrVec3 *py)
{
    const WrVec3 a = v3_sub(flat->p[1], flat->p[0]), b = v3_sub(flat->p[2], flat->p[0]);
    const double ax = flat->x[1] - flat->x[0], ay = flat->y[1] - flat->y[0];
    const double bx = flat->x[2] - flat->x[0], by = flat->y[2] - flat->y[0];
    *px = v3_scale(v3_mad(v3_scale(a, by), b, -ay), 1 / flat->area2);
    *py = v3_scale(v3_mad(v3_scale(b, ax), a, -bx), 1 / flat->area2);
}

/* Gradients of x and y over the triangle's plane: gx.px = 1, gx.py = 0, and so on. false: no area. */
static bool gradients_of(WrVec3 px, WrVec3 py, WrVec3 *gx, WrVec3 *gy)
{
    const double xx = v3_dot(px, px), xy = v3_dot(px, py), yy = v3_dot(py, py);
    const double det = xx * yy - xy * xy;
    if (!(det > 1e-12 * xx * yy)) return false;
    *gx = v3_scale(v3_mad(v3_scale(px, yy), py, -xy), 1 / det);
    *gy = v3_scale(v3_mad(v3_scale(py, xx), px, -xy), 1 / det);
    return true;
}

void wr_mesh_texels_place(const WrMeshTexels *t, const WrMeshSpot *spot, double *x, double *y)
{
    Flat flat;
    WrVec3 px, py, gx, gy;
    *x = *y = 0;
    if (!lay_flat(t, spot->triangle, &flat)) return;
    slopes_of(&flat, &px, &py);
    *x = flat.x[0], *y = flat.y[0];
    if (!gradients_of(px, py, &gx, &gy)) return;
    const WrVec3 from = v3_sub(spot->p, flat.p[0]);
    *x += v3_dot(gx, from), *y += v3_dot(gy, from);
}

WrVec3 wr_mesh_texels_along(const WrMeshTexels *t, const WrMeshSpot *spot)
{
    Flat flat;
    WrVec3 px, py;
    const WrVec3 any = fabs(spot->n.x) < 0.7 ? (WrVec3){ 1, 0, 0 } : (WrVec3){ 0, 1, 0 };
    if (!lay_flat(t, spot->triangle, &flat)) return v3_unit(v3_cross(spot->n, any), any);
    slopes_of(&flat, &px, &py);
    return v3_unit(px, any);
}

/* ---- the flood ---- */

static void push(WrMeshTexels *t, Reached item)
{
    wr_array_push(&t->heap, item);
    Reached *heap = t->heap.data;
    int i = t->heap.count - 1;
    for (; i > 0 && heap[(i - 1) / 2].key > item.key; i = (i - 1) / 2) heap[i] = heap[(i - 1) / 2];
    heap[i] = item;
}

static Reached pop(WrMeshTexels *t)
{
    Reached *heap = t->heap.data;
    const Reached first = heap[0], last = heap[--t->heap.count];
    int i = 0;
    for (int child = 1; child < t->heap.count; child = 2 * i + 1) {
        if (child + 1 < t->heap.count && heap[child + 1].key < heap[child].key) child++;
        if (!(heap[child].key < last.key)) break;
        heap[i] = heap[child];
        i = child;
    }
    heap[i] = last;
    return first;
}

/* Where the straight way from the source to p crosses the entered edge, along it. */
static double crossing(const Reached *r, WrVec3 p)
{
    const WrVec3 s = v3_sub(r->source, r->a), q = v3_sub(p, r->a);
    const double back = fmax(0, -v3_dot(s, r->in)), ahead = fmax(0, v3_dot(q, r->in));
    const double from = v3_dot(s, r->e), to = v3_dot(q, r->e), sum = back + ahead;
    return sum > 0 ? from + (to - from) * (back / sum) : clamped(to, 0, r->length);
}

/* Length of the way to a point of the triangle's plane: straight, or round an end of the entered edge. */
static double way_to(const Reached *r, WrVec3 p)
{
    const double straight = v3_len(v3_sub(p, r->source));
    if (r->length == 0) return straight;
    const double t = crossing(r, p);
    if (t >= 0 && t <= r->length) return r->base + straight;
    const WrVec3 end = t < 0 ? r->a : v3_mad(r->a, r->e, r->length);
    return r->base + v3_len(v3_sub(end, r->source)) + v3_len(v3_sub(p, end));
}

/* True if the half-edges have the same (u,v) at their ends, in either order. */
static bool joined(const WrTriangles *mesh, int32_t h, int32_t other)
{
    const WrTriangleCorner *a = wr_triangle_corner(mesh, h / 3, h % 3);
    const WrTriangleCorner *b = wr_triangle_corner(mesh, h / 3, (h + 1) % 3);
    const WrTriangleCorner *c = wr_triangle_corner(mesh, other / 3, other % 3);
    const WrTriangleCorner *d = wr_triangle_corner(mesh, other / 3, (other + 1) % 3);
    return (a->u == c->u && a->v == c->v && b->u == d->u && b->v == d->v) ||
           (a->u == d->u && a->v == d->v && b->u == c->u && b->v == c->v);
}

/* Enters the neighbour behind half-edge h: its plane is unfolded about the edge. */
static void enter(WrMeshTexels *t, const Reached *r, int32_t h, double radius)
{
    const int32_t other = t->across[h];
    if (other < 0 || t->stamp[other / 3] == t->now) return;
    const WrVec3 none = { 0, 0, 0 };
    const WrVec3 a = corner_at(t->mesh, h / 3, h % 3), b = corner_at(t->mesh, h / 3, (h + 1) % 3);
    const WrVec3 c = corner_at(t->mesh, h / 3, (h + 2) % 3);
    const WrVec3 d = corner_at(t->mesh, other / 3, (other + 2) % 3);
    Reached next = { .triangle = other / 3, .base = r->base, .source = r->source, .a = a };
    next.length = v3_len(v3_sub(b, a));
    next.e = v3_unit(v3_sub(b, a), none);
    if (!(next.length > 0)) return;
    /* Seen from the source, the whole edge may lie behind an end of the one entered before. */
    const double ta = r->length > 0 ? crossing(r, a) : 0, tb = r->length > 0 ? crossing(r, b) : 0;
    const bool before = ta < 0 && tb<0, after = ta> r->length && tb > r->length;
    if (r->length > 0 && (before || after)) {
        next.source = before ? r->a : v3_mad(r->a, r->e, r->length);
        next.base += v3_len(v3_sub(next.source, r->source));
    }
    const WrVec3 inner = v3_sub(c, a), outer = v3_sub(d, a), from = v3_sub(next.source, a);
    const WrVec3 back = v3_unit(v3_mad(inner, next.e, -v3_dot(inner, next.e)), none);
    next.in = v3_unit(v3_mad(outer, next.e, -v3_dot(outer, next.e)), none);
    const double along = v3_dot(from, next.e), height = v3_dot(from, back);
    next.source = v3_mad(v3_mad(a, next.e, along), next.in, -height);
    const double off = along - clamped(along, 0, next.length);
    next.key = fmax(r->key, next.base + sqrt(off * off + height * height));
    if (!(next.key < radius)) return;
    if (!joined(t->mesh, h, other)) t->crossed = true;
    push(t, next);
}

/* Reaches every triangle with a point nearer than the radius, in the order of their distance (Dijkstra). */
static void flood(WrMeshTexels *t, const WrMeshDisc *disc)
{
    t->heap.count = t->reached.count = 0;
    t->crossed = false;
    t->now++;
    push(t, (Reached){ .triangle = disc->centre.triangle, .source = disc->centre.p });
    while (t->heap.count > 0) {
        const Reached r = pop(t);
        if (t->stamp[r.triangle] == t->now) continue;
        t->stamp[r.triangle] = t->now;
        wr_array_push(&t->reached, r);
        for (int k = 0; k < 3; k++) enter(t, &r, 3 * r.triangle + k, disc->radius);
    }
}

/* ---- the texels of a disc ---- */

static void count_shared(WrMeshTexels *t, int32_t index)
{
    if ((t->covered[index] & (SHARED | COUNTED)) != SHARED) return;
    t->covered[index] |= COUNTED;
    t->shared++;
}

/* 1 towards the eye, 0 where the normal is across the direction to it or turned away. */
static double fade(WrVec3 n, WrVec3 to_eye)
{
    const double x = clamped(v3_dot(v3_unit(to_eye, n), n) / FADE, 0, 1);
    return x * x * (3 - 2 * x);
}

/* Whole numbers of the table's texels between a and b that are also within the triangle's own range. */
static void range_of(const double own[3], double middle, double reach, int *low, int *high)
{
    const double least = fmin(own[0], fmin(own[1], own[2])) - GUTTER;
    const double most = fmax(own[0], fmax(own[1], own[2])) + GUTTER;
    *low = (int)ceil(fmax(least, middle - reach));
    *high = (int)floor(fmin(most, middle + reach));
}

/* Adds the texels of one triangle; returns their part of the mean normal. */
static WrVec3 collect(WrMeshTexels *t, const WrMeshDisc *disc, const Reached *r)
{
    Flat flat;
    WrVec3 px, py, gx, gy, sum = { 0, 0, 0 };
    const WrVec3 c = disc->centre.p;
    if (!lay_flat(t, r->triangle, &flat)) return sum;
    slopes_of(&flat, &px, &py);
    if (!gradients_of(px, py, &gx, &gy)) return sum;
    const WrVec3 n = normal_of(flat.p), from = v3_sub(c, flat.p[0]);
    const double high = v3_dot(from, n), area = v3_len(v3_cross(px, py));
    const double reach = sqrt(fmax(0, disc->radius * disc->radius - high * high));
    const double x = flat.x[0] + v3_dot(gx, from), y = flat.y[0] + v3_dot(gy, from);
    int x0, x1, y0, y1;
    range_of(flat.x, x, reach * v3_len(gx), &x0, &x1);
    range_of(flat.y, y, reach * v3_len(gy), &y0, &y1);
    for (int j = y0; j <= y1; j++)
        for (int i = x0; i <= x1; i++) {
            const WrVec3 p = v3_mad(v3_mad(flat.p[0], px, i - flat.x[0]), py, j - flat.y[0]);
            const WrVec3 away = v3_sub(p, c);
            const double straight = sqrt(v3_dot(away, away));
            if (!(straight < disc->radius)) continue;
            const double out = beyond(&flat, i, j);
            const int32_t index = out <= GUTTER ? index_of(t, i, j) : -1;
            if (index < 0 || (out > INSIDE && (t->covered[index] & COVERED))) continue;
            const double d = straight + fmax(0, way_to(r, p) - FOLDED * straight);
            if (!(d < disc->radius)) continue;
            const double weight = disc->clips ? fade(n, v3_sub(disc->eye, p)) : 1;
            const Place place = { index, out > INSIDE ? out : 0, d, weight, away };
            wr_array_push(&t->places, place);
            if (place.beyond == 0) sum = v3_mad(sum, n, area * (1 - d / disc->radius));
        }
    return sum;
}

static int by_index(const void *a, const void *b)
{
    const Place *p = a, *q = b;
    if (p->index != q->index) return p->index < q->index ? -1 : 1;
    if (p->beyond != q->beyond) return p->beyond < q->beyond ? -1 : 1;
    return (p->d > q->d) - (p->d < q->d);
}

const WrMeshTexel *wr_mesh_texels_disc(WrMeshTexels *t, const WrMeshDisc *disc, int *count)
{
    WrVec3 sum = { 0, 0, 0 };
    t->places.count = t->texels.count = 0;
    flood(t, disc);
    for (int i = 0; i < t->reached.count; i++)
        sum = v3_add(sum, collect(t, disc, &t->reached.data[i]));
    if (t->places.count > 0)
        qsort(t->places.data, (size_t)t->places.count, sizeof *t->places.data, by_index);
    /* The plane of the mean normal: a disc on an edge lies on both faces alike. */
    const WrVec3 n = v3_unit(sum, disc->centre.n);
    const WrVec3 right = v3_unit(v3_mad(disc->along, n, -v3_dot(disc->along, n)), disc->along);
    const WrVec3 up = v3_cross(disc->mirrored ? v3_neg(n) : n, right);
    for (int i = 0; i < t->places.count; i++) {
        const Place *p = &t->places.data[i];
        if (i > 0 && p[-1].index == p->index) continue;
        const double x = v3_dot(p->from, right), y = v3_dot(p->from, up), l = sqrt(x * x + y * y);
        const double by = p->d / t->side;
        const WrMeshTexel texel = { .x = p->index % t->table.width,
                                    .y = p->index / t->table.width,
                                    .dx = l > 0 ? by * (x / l) : by,
                                    .dy = l > 0 ? -by * (y / l) : 0,
                                    .weight = p->weight };
        wr_array_push(&t->texels, texel);
        if (p->weight > 0) count_shared(t, p->index);
    }
    *count = t->texels.count;
    return t->texels.data;
}

bool wr_mesh_texels_crossed(const WrMeshTexels *t)
{
    return t->crossed;
}

/* ---- projection of a picture ---- */

/* Where the ray through p meets the picture; false: p is behind the eye. */
static bool on_slide(const WrMeshSlide *slide, WrVec3 p, double *s, double *t)
{
    const WrVec3 line = v3_sub(slide->middle, slide->eye), from = v3_sub(p, slide->eye);
    const double depth = v3_dot(from, line);
    if (!(depth > 0)) return false;
    const double by = slide->parallel ? 1 : v3_dot(line, line) / depth;
    const WrVec3 at = v3_sub(v3_scale(from, by), line);
    *s = 0.5 + 0.5 * v3_dot(at, slide->right) / v3_dot(slide->right, slide->right);
    *t = 0.5 + 0.5 * v3_dot(at, slide->up) / v3_dot(slide->up, slide->up);
    return true;
}

static WrVec3 to_eye(const WrMeshSlide *slide, WrVec3 p)
{
    return v3_sub(slide->eye, slide->parallel ? slide->middle : p);
}

/* True if the whole triangle is beside the picture. */
static bool is_beside(const WrMeshSlide *slide, const Flat *flat)
{
    int sides[4] = { 0, 0, 0, 0 };
    for (int k = 0; k < 3; k++) {
        double s, t;
        if (!on_slide(slide, flat->p[k], &s, &t)) return false;
        sides[0] += s<-0.1, sides[1] += s> 1.1, sides[2] += t<-0.1, sides[3] += t> 1.1;
    }
    return sides[0] == 3 || sides[1] == 3 || sides[2] == 3 || sides[3] == 3;
}

/* The mean of four values within the texel. */
static double slide_value(const WrMeshSlide *slide, WrVec3 p, WrVec3 px, WrVec3 py)
{
    double sum = 0, s, t;
    for (int k = 0; k < 4; k++) {
        const WrVec3 q = v3_mad(v3_mad(p, px, k % 2 ? 0.25 : -0.25), py, k / 2 ? 0.25 : -0.25);
        if (!on_slide(slide, q, &s, &t) || !(s >= 0 && s <= 1 && t >= 0 && t <= 1)) continue;
        sum += 0.25 * slide->value(slide->ctx, s, t);
    }
    return sum;
}

static void lay_slide(WrMeshTexels *t, const WrMeshSlide *slide, const Flat *flat, float *cover)
{
    const WrVec3 n = normal_of(flat->p);
    WrVec3 px, py;
    int x0, x1, y0, y1;
    slopes_of(flat, &px, &py);
    range_of(flat->x, flat->x[0], FAR, &x0, &x1);
    range_of(flat->y, flat->y[0], FAR, &y0, &y1);
    for (int j = y0; j <= y1 && !wr_progress_stopped(); j++)
        for (int i = x0; i <= x1; i++) {
            const double out = beyond(flat, i, j);
            const int32_t index = out <= GUTTER ? index_of(t, i, j) : -1;
            if (index < 0 || (out > INSIDE && (t->covered[index] & COVERED))) continue;
            const WrVec3 p = v3_mad(v3_mad(flat->p[0], px, i - flat->x[0]), py, j - flat->y[0]);
            const float value = (float)(fade(n, to_eye(slide, p)) * slide_value(slide, p, px, py));
            if (!(value > cover[index])) continue;
            /* Beyond an island's edge the point may be within the body: the nearest one of the face is seen or not. */
            const WrVec3 from = v3_mad(nearest_in(flat->p, n, p), n, SURFACE * t->mesh->radius);
            if (wr_ray_tree_any(t->tree, from, to_eye(slide, from), 1)) continue;
            cover[index] = value;
            count_shared(t, index);
        }
}

bool wr_mesh_texels_slide(WrMeshTexels *t, const WrMeshSlide *slide, float *cover)
{
    for (int32_t i = 0; i < t->mesh->triangle_count; i++) {
        Flat flat;
        if (i % LOOK == 0 && !wr_progress_report((double)i / t->mesh->triangle_count)) return false;
        if (!lay_flat(t, i, &flat) || is_beside(slide, &flat)) continue;
        lay_slide(t, slide, &flat, cover);
    }
    return !wr_progress_stopped();
}
