/* Ray intersection for the reference: camera and rays, closed forms, trees of patches and of triangles. */
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/vec.h"
#include "render/reference/reference_intersect.h"
#include "scene/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- curved surfaces ---- */

/* Construction: a piece is measured at 3 x 3 points and halved while its normals spread or its bend is not small
   compared with its size. A box around the four corners, grown by the bend / 8, contains the piece: its corners'
   bilinear patch is in the box, and the surface within (|Puu| du^2 + 2 |Puv| du dv + |Pvv| dv^2) / 8 of that
   (Taylor).

   Search: where a ray makes a positive angle with all normals of a piece, the piece is a graph over the ray's
   plane and has at most one root: Newton's method from its centre finds it or leaves the piece. Otherwise
   (outlines, folds, points where a tangent vanishes) it starts from five points. */

/* ---- reference bezier ---- */

#define PATCH_SLACK 1e-12
/* Bounding the groups costs 1/16 of the boxes and discards most of them; a full tree is not worth it for a few
   hundred patches. */
#define GROUP 16 /* patches that are neighbours in the file, with a common box */

struct WrReferenceBezierPiece {
    WrShape shape;
    WrReferencePatches tree;
    /* group: of the patches from here on; only in the first of each GROUP */
    WrReferenceBounds box, group;
};

/* A patch is inside the convex hull of its control points. */
static WrReferenceBounds box_of(const float *points)
{
    WrReferenceBounds box = wr_reference_bounds();
    for (int i = 0; i < 48; i++) wr_reference_bounds_add(&box, i % 3, (double)points[i]);
    return box;
}

static bool reference_patches_init(WrReferencePatches *patches, const WrShape *shape, WrError *err);

static bool reference_bezier_init(WrReferenceBezier *set, const WrPatches *source, WrError *err)
{
    *set = (WrReferenceBezier){ .source = source };
    set->pieces = wr_try_alloc((size_t)source->count, sizeof *set->pieces, "the reference", err);
    if (!set->pieces) return false;
    for (int32_t i = 0; i < source->count; i++) {
        WrReferenceBezierPiece *piece = &set->pieces[i];
        wr_shape_default(WR_SURFACE_bezier, &piece->shape);
        for (int k = 0; k < 48; k++) piece->shape.value[k] = (double)source->patch[i].point[k];
        piece->box = piece->group = box_of(source->patch[i].point);
        WrReferenceBounds *group = &set->pieces[i - i % GROUP].group;
        for (int k = 0; k < 3; k++) {
            wr_reference_bounds_add(group, k, piece->box.low[k]);
            wr_reference_bounds_add(group, k, piece->box.high[k]);
        }
        if (!reference_patches_init(&piece->tree, &piece->shape, err)) return false;
    }
    return true;
}

static void reference_patches_fini(WrReferencePatches *patches);

/* Also for a zeroed one. */
static void reference_bezier_fini(WrReferenceBezier *set)
{
    for (int32_t i = 0; set->pieces && i < set->source->count; i++)
        reference_patches_fini(&set->pieces[i].tree);
    wr_free(set->pieces);
    *set = (WrReferenceBezier){ 0 };
}

static bool reference_patches_hit(const WrReferencePatches *patches, const WrShape *shape,
                                  bool cull, const WrReferenceRay *ray, WrReferenceHit *hit);

/* Nearest hit beyond s_min: fills s, u, v (the table's), triangle (here the patch) and share (its own u, v). */
static bool reference_bezier_hit(const WrReferenceBezier *set, bool cull, const WrReferenceRay *ray,
                                 WrReferenceHit *hit)
{
    WrReferenceHit best = { .s = INFINITY, .triangle = -1 };
    for (int32_t i = 0; i < set->source->count; i++) {
        const WrReferenceBezierPiece *piece = &set->pieces[i];
        if (i % GROUP == 0 && !wr_reference_bounds_met(&piece->group, ray, best.s, PATCH_SLACK)) {
            i += GROUP - 1;
            continue;
        }
        WrReferenceHit own = { 0 };
        if (!wr_reference_bounds_met(&piece->box, ray, best.s, PATCH_SLACK) ||
            !reference_patches_hit(&piece->tree, &piece->shape, cull, ray, &own) || own.s >= best.s)
            continue;
        best = own;
        best.triangle = i;
    }
    if (best.triangle < 0) return false;
    *hit = best;
    hit->share[0] = best.u, hit->share[1] = best.v;
    wr_patch_chart(set->source, &set->source->patch[best.triangle], best.u, best.v, &hit->u,
                   &hit->v);
    return true;
}

/* The point with derivatives by the table's u and v, from the gradients of the patch's parameters.
   The map from patch to table parameters is affine and constant (chart), so gradients transform by its matrix:
   grad u_table = scale_u (c1 grad u + c2 grad v). Where N = 0 there are no gradients, and bumps vanish (HC06). */
static void reference_bezier_at(const WrReferenceBezier *set, const WrReferenceHit *hit,
                                WrSurfacePoint *out)
{
    const float *c = set->source->patch[hit->triangle].chart;
    WrSurfacePoint at;
    wr_surface_at(&set->pieces[hit->triangle].shape, 0, hit->share[0], hit->share[1], &at);
    memset(out, 0, sizeof *out);
    out->p = at.p;
    out->n_unit = at.n_unit;
    out->n = at.n_unit;
    out->n_len = 1;
    if (!(at.n_len > 0)) return;
    const WrVec3 gu = v3_scale(v3_cross(at.pv, at.n_unit), 1 / at.n_len);
    const WrVec3 gv = v3_scale(v3_cross(at.n_unit, at.pu), 1 / at.n_len);
    const WrVec3 own_u = v3_scale(v3_add(v3_scale(gu, (double)c[1]), v3_scale(gv, (double)c[2])),
                                  set->source->scale_u);
    const WrVec3 own_v = v3_scale(v3_add(v3_scale(gu, (double)c[4]), v3_scale(gv, (double)c[5])),
                                  set->source->scale_v);
    wr_reference_lay(at.n_unit, own_u, own_v, out);
}

#define PIECES_MAX (1 << 18)
#define DEPTH_MAX 40
#define SPREAD 0.15 /* largest angle, radians, between the normals of a piece and its middle one */
#define BEND 0.45   /* largest bend of a piece, relative to its length */
#define FLAT 1e-7   /* bend that needs no further subdivision, in sizes of the object */
#define SAFETY 1.5  /* for values measured at 3 x 3 points */
#define STEPS 24    /* maximum steps of Newton's method */
/* SETTLED: size of the last step, in parts of the (u,v) square. In sizes of the object: a point within TOUCHES
   of the ray is a hit even if steps remain longer, and one within UNDECIDED may be one. */
#define SETTLED 1e-12
#define TOUCHES 1e-13
#define UNDECIDED 1e-10

struct WrReferencePiece {
    WrVec3 low, high; /* box */
    double u0, u1, v0, v1;
    WrVec3 p, pu, pv; /* at its middle */
    WrVec3 n;         /* unit, there */
    double sine;      /* of the largest angle between its normals and n; over 1: unknown */
    int child;        /* index of the first of two; 0: none */
    int depth;
    int cut; /* axis of subdivision: 1 along u, 2 along v, 0 none needed */
};

typedef struct Measure {
    double uu, uv, vv; /* largest second derivatives */
    double pu, pv;     /* largest and least first derivatives */
    double pu_least, pv_least;
    double spread;
} Measure;

static double dot_sine(WrVec3 a, WrVec3 b)
{
    return v3_len(v3_cross(a, b));
}

static void include(WrReferencePiece *piece, WrVec3 p)
{
    piece->low =
        (WrVec3){ fmin(piece->low.x, p.x), fmin(piece->low.y, p.y), fmin(piece->low.z, p.z) };
    piece->high =
        (WrVec3){ fmax(piece->high.x, p.x), fmax(piece->high.y, p.y), fmax(piece->high.z, p.z) };
}

/* Nine points at 0, 0.414 and 1 of each side. The middle is measured apart: it is Newton's start. */
static Measure sample_piece(WrReferencePiece *piece, const WrShape *shape)
{
    Measure m = { .pu_least = INFINITY, .pv_least = INFINITY };
    const double du = piece->u1 - piece->u0, dv = piece->v1 - piece->v0;
    WrSurfacePoint at;
    wr_surface_at(shape, 0, piece->u0 + du / 2, piece->v0 + dv / 2, &at);
    piece->p = at.p, piece->pu = at.pu, piece->pv = at.pv, piece->n = at.n_unit;
    piece->low = piece->high = at.p;
    /* Off the middle, where waves with whole-number frequencies would have zero bend. */
    const double us[3] = { piece->u0, piece->u0 + 0.41421356 * du, piece->u1 };
    const double vs[3] = { piece->v0, piece->v0 + 0.41421356 * dv, piece->v1 };
    for (int k = 0; k < 9; k++) {
        wr_surface_at(shape, 0, us[k % 3], vs[k / 3], &at);
        const double pu = v3_len(at.pu), pv = v3_len(at.pv);
        include(piece, at.p);
        m.uu = fmax(m.uu, v3_len(at.puu));
        m.uv = fmax(m.uv, v3_len(at.puv));
        m.vv = fmax(m.vv, v3_len(at.pvv));
        m.pu = fmax(m.pu, pu), m.pu_least = fmin(m.pu_least, pu);
        m.pv = fmax(m.pv, pv), m.pv_least = fmin(m.pv_least, pv);
        const double sine = dot_sine(piece->n, at.n_unit);
        m.spread = fmax(m.spread, v3_dot(piece->n, at.n_unit) < 0 ? 2 : sine);
    }
    return m;
}

/* `bend` bounds twice the deviation from the chord: the piece is halved until that is a small part of its
   length and its normals stay within SPREAD of the middle one. FLAT ends the subdivision at collapsed edges,
   whose normals never settle. */
static void measure_piece(WrReferencePiece *piece, const WrShape *shape, double size)
{
    const Measure m = sample_piece(piece, shape);
    const double du = piece->u1 - piece->u0, dv = piece->v1 - piece->v0;
    const double bend_u = m.uu * du * du + m.uv * du * dv;
    const double bend_v = m.vv * dv * dv + m.uv * du * dv, bend = bend_u + bend_v;
    const double grow = SAFETY * bend / 8 + 1e-12 * size;
    piece->low = v3_sub(piece->low, (WrVec3){ grow, grow, grow });
    piece->high = v3_add(piece->high, (WrVec3){ grow, grow, grow });
    const double length = fmax(m.pu * du, m.pv * dv);
    const bool bent = bend > FLAT * size && (m.spread > SPREAD || bend > BEND * length);
    /* Across the greater bend; a twist, which counts for both, across the longer side. */
    const bool alike = fmin(bend_u, bend_v) > 0.5 * fmax(bend_u, bend_v);
    const bool along_u = alike ? m.pu * du >= m.pv * dv : bend_u > bend_v;
    piece->cut = bent && piece->depth < DEPTH_MAX ? along_u ? 1 : 2 : 0;
    /* Where a tangent almost vanishes, or the two are almost parallel, n does not describe the map. */
    const double across = v3_len(v3_cross(piece->pu, piece->pv));
    const bool upright = m.pu_least > 0.1 * m.pu && m.pv_least > 0.1 * m.pv &&
                         across > 0.05 * v3_len(piece->pu) * v3_len(piece->pv);
    piece->sine = upright ? 1.2 * m.spread + 0.01 : 2;
}

/* Both halves are appended, so that children always have larger indices than parents: one backward loop then
   joins boxes. */
static void halve(WrReferencePatches *patches, int index, const WrShape *shape)
{
    WrReferencePiece *piece = &patches->pieces[index];
    WrReferencePiece half = { .u0 = piece->u0, .u1 = piece->u1, .v0 = piece->v0, .v1 = piece->v1 };
    half.depth = piece->depth + 1;
    piece->child = patches->count;
    for (int k = 0; k < 2; k++) {
        WrReferencePiece *child = &patches->pieces[patches->count++];
        *child = half;
        if (piece->cut == 1) *(k ? &child->u0 : &child->u1) = 0.5 * (piece->u0 + piece->u1);
        else *(k ? &child->v0 : &child->v1) = 0.5 * (piece->v0 + piece->v1);
        measure_piece(child, shape, patches->size);
    }
}

/* Larger pieces are subdivided first, so that a surface with too many is subdivided evenly. Then boxes shrink to
   those of their halves.
   Breadth first by index: pieces[count] grows while it is scanned. Pieces is moved by realloc; halve works by
   index. */
static bool reference_patches_init(WrReferencePatches *patches, const WrShape *shape, WrError *err)
{
    int capacity = 1024;
    WrReferencePatches made = { .count = 1, .size = wr_shape_radius(shape) };
    made.pieces = wr_try_alloc((size_t)capacity, sizeof *made.pieces, "the reference's tree", err);
    if (!made.pieces) return false;
    made.pieces[0] = (WrReferencePiece){ .u1 = 1, .v1 = 1 };
    measure_piece(&made.pieces[0], shape, made.size);
    for (int i = 0; i < made.count && made.count + 2 <= PIECES_MAX; i++) {
        if (made.pieces[i].cut == 0) continue;
        if (made.count + 2 > capacity) {
            made.pieces = wr_realloc(made.pieces, (size_t)capacity, (size_t)capacity * 2,
                                     sizeof *made.pieces);
            capacity *= 2;
        }
        halve(&made, i, shape);
    }
    for (int i = made.count - 1; i >= 0; i--) {
        WrReferencePiece *piece = &made.pieces[i];
        if (piece->child == 0) continue;
        const WrReferencePiece *half = &made.pieces[piece->child];
        piece->low = half[0].low, piece->high = half[0].high;
        include(piece, half[1].low);
        include(piece, half[1].high);
    }
    *patches = made;
    return true;
}

/* Also for a zeroed one. */
static void reference_patches_fini(WrReferencePatches *patches)
{
    wr_free(patches->pieces);
    *patches = (WrReferencePatches){ 0 };
}

/* State of one ray's search. */
typedef struct Search {
    const WrShape *shape;
    const WrReferenceRay *ray;
    const WrSurfaceInfo *info;
    double size, d_length;
    WrVec3 inverse; /* 1 / direction of the ray, for each component */
    bool cull;
    bool found;
    WrReferenceHit best;
} Search;

/* Ray parameter at which the box is entered, or INFINITY. */
static double enters(const Search *search, const WrReferencePiece *piece)
{
    const WrVec3 q = search->ray->q, inverse = search->inverse;
    const double x0 = (piece->low.x - q.x) * inverse.x, x1 = (piece->high.x - q.x) * inverse.x;
    const double y0 = (piece->low.y - q.y) * inverse.y, y1 = (piece->high.y - q.y) * inverse.y;
    const double z0 = (piece->low.z - q.z) * inverse.z, z1 = (piece->high.z - q.z) * inverse.z;
    double in = x0 < x1 ? x0 : x1, out = x0 < x1 ? x1 : x0;
    const double in_y = y0 < y1 ? y0 : y1, out_y = y0 < y1 ? y1 : y0;
    const double in_z = z0 < z1 ? z0 : z1, out_z = z0 < z1 ? z1 : z0;
    in = in_y > in ? in_y : in, out = out_y < out ? out_y : out;
    in = in_z > in ? in_z : in, out = out_z < out ? out_z : out;
    return in <= out && out > search->ray->s_min ? in : INFINITY;
}

/* Offers a root or a possible root: the nearest is kept.
   s is the distance of P(u, v) along the ray, not Newton's own third unknown. Parameters on closed axes wrap;
   a root up to 1e-9 outside counts for both neighbours, so that no ray passes between two pieces. */
static void offer(Search *search, const WrSurfacePoint *at, double u, double v, bool lost)
{
    const WrReferenceRay *ray = search->ray;
    const double slack = 1e-9;
    if (search->info->closed_u) u -= floor(u);
    if (search->info->closed_v) v -= floor(v);
    if (u < -slack || u > 1 + slack || v < -slack || v > 1 + slack) return;
    if (search->cull && !(v3_dot(v3_cross(at->pu, at->pv), ray->d) < 0)) return;
    const double s = v3_dot(v3_sub(at->p, ray->q), ray->d) / v3_dot(ray->d, ray->d);
    if (!(s > ray->s_min) || (search->found && s >= search->best.s)) return;
    u = u > 0 ? u < 1 ? u : 1 : 0, v = v > 0 ? v < 1 ? v : 1 : 0;
    search->found = true;
    search->best = (WrReferenceHit){ .s = s, .u = u, .v = v, .lost = lost };
}

/* From dot products with Pv x d and d x Pu.
   Solves P + Pu du + Pv dv = q + s d. The dot product with Pv x d removes dv and s, that with d x Pu removes
   du and s; det = Pu . (Pv x d) is 0 at silhouettes: the steps are then infinite and the search ends. */
bool wr_reference_newton_step(const WrReferenceRay *ray, WrVec3 p, WrVec3 pu, WrVec3 pv, double *du,
                              double *dv)
{
    const WrVec3 gap = v3_sub(ray->q, p), a = v3_cross(pv, ray->d), b = v3_cross(ray->d, pu);
    const double det = v3_dot(pu, a);
    *du = v3_dot(gap, a) / det;
    *dv = v3_dot(gap, b) / det;
    return isfinite(*du) && isfinite(*dv);
}

/* Distance of p from the ray. */
static double off_ray(const Search *search, WrVec3 p)
{
    const WrVec3 aside = v3_cross(v3_sub(p, search->ray->q), search->ray->d);
    return sqrt(v3_dot(aside, aside)) / search->d_length;
}

/* Newton's method from (u, v), within two lengths of the piece; most: longest step, in pieces.
   off_ray is the measure that decides, as steps shrink only linearly at silhouettes. `lost` marks a point
   within UNDECIDED but not within TOUCHES: it may be a hit or not, and the reference counts such pixels
   instead of hiding them. */
static void solve(Search *search, const WrReferencePiece *piece, double u, double v, double most)
{
    const double wide = piece->u1 - piece->u0, high = piece->v1 - piece->v0;
    WrSurfacePoint at;
    double du = 0, dv = 0, nearest = INFINITY;
    for (int k = 0, stalled = 0; k < STEPS && stalled < 3; k++) {
        search->info->at(search->shape, 0, u, v, &at);
        const double distance = off_ray(search, at.p);
        stalled = distance < 0.5 * nearest ? 0 : stalled + 1;
        nearest = fmin(nearest, distance);
        if (!wr_reference_newton_step(search->ray, at.p, at.pu, at.pv, &du, &dv)) break;
        const double reach = fmax(fabs(du) / wide, fabs(dv) / high);
        const double share = reach > most ? most / reach : 1;
        u += share * du, v += share * dv;
        if (u < piece->u0 - 2 * wide || u > piece->u1 + 2 * wide || v < piece->v0 - 2 * high ||
            v > piece->v1 + 2 * high)
            return;
        if (fabs(du) + fabs(dv) < SETTLED) {
            offer(search, &at, u, v, false);
            return;
        }
    }
    const double off = off_ray(search, at.p);
    if (off < UNDECIDED * search->size) {
        u = fmin(fmax(u, piece->u0), piece->u1), v = fmin(fmax(v, piece->v0), piece->v1);
        offer(search, &at, u, v, !(off < TOUCHES * search->size));
    }
}

/* A graph over the ray's plane is crossed at most once: a Newton step from the middle that leaves by more than
   the piece's size has its root outside. The stored middle point saves one evaluation. */
static void try_piece(Search *search, const WrReferencePiece *piece)
{
    const double u = 0.5 * (piece->u0 + piece->u1), v = 0.5 * (piece->v0 + piece->v1);
    const double wide = piece->u1 - piece->u0, high = piece->v1 - piece->v0;
    if (fabs(v3_dot(piece->n, search->ray->d)) > piece->sine * search->d_length) {
        double du, dv;
        if (!wr_reference_newton_step(search->ray, piece->p, piece->pu, piece->pv, &du, &dv))
            return;
        /* half of that step already reaches the end of the piece */
        if (fabs(du) > wide || fabs(dv) > high) return;
        solve(search, piece, u + du, v + dv, 2);
        return;
    }
    static const double starts[5][2] = {
        { 0, 0 }, { -0.25, -0.25 }, { 0.25, 0.25 }, { -0.25, 0.25 }, { 0.25, -0.25 }
    };
    for (int k = 0; k < 5; k++)
        solve(search, piece, u + starts[k][0] * wide, v + starts[k][1] * high, 0.5);
}

static double reciprocal(double d)
{
    return fabs(d) > 1e-150 ? 1 / d : d < 0 ? -1e150 : 1e150;
}

/* Nearest root beyond s_min. cull: ignores roots whose N = Pu x Pv points away from the viewer.
   Depth first, nearest child first. The stack holds one sibling for each level: DEPTH_MAX + 2 entries. */
static bool reference_patches_hit(const WrReferencePatches *patches, const WrShape *shape,
                                  bool cull, const WrReferenceRay *ray, WrReferenceHit *hit)
{
    Search search = { .shape = shape,
                      .ray = ray,
                      .info = wr_surfaces[shape->kind],
                      .size = patches->size,
                      .d_length = v3_len(ray->d),
                      .inverse = { reciprocal(ray->d.x), reciprocal(ray->d.y),
                                   reciprocal(ray->d.z) },
                      .cull = cull };
    struct {
        int index;
        double from;
    } stack[DEPTH_MAX + 2];
    int depth = 0;
    double from = enters(&search, &patches->pieces[0]);
    if (from < INFINITY) stack[depth].index = 0, stack[depth++].from = from;
    while (depth > 0) {
        depth--;
        if (search.found && stack[depth].from > search.best.s) continue;
        const WrReferencePiece *piece = &patches->pieces[stack[depth].index];
        if (piece->child == 0) {
            try_piece(&search, piece);
            continue;
        }
        double in[2];
        for (int k = 0; k < 2; k++) in[k] = enters(&search, &patches->pieces[piece->child + k]);
        const int first = in[1] < in[0];
        for (int k = 1; k >= 0; k--) {
            const int which = k ? !first : first;
            if (!(in[which] < INFINITY)) continue;
            stack[depth].index = piece->child + which;
            stack[depth++].from = in[which];
        }
    }
    if (search.found) *hit = search.best;
    return search.found;
}

/* ---- mesh files ---- */

#define LEAF 4
#define TRIANGLE_SLACK 1e-14

struct WrReferenceBox {
    WrReferenceBounds about;
    /* triangles of a leaf; else 0, and first is the index of the first of two boxes */
    int32_t first, count;
};

static WrVec3 corner(const WrTriangles *t, int32_t i, int k)
{
    const float *p = t->corners[t->triangles[i].corner[k]].p;
    return (WrVec3){ (double)p[0], (double)p[1], (double)p[2] };
}

/* ---- the tree ---- */

/* Median-free: the middle of the longest side, which is enough for meshes; equal centres fall back to equal
   halves, so each box divides and the tree is finite. */

/* Three times the mean of a triangle's corners along an axis. */
static double middle(const WrTriangles *t, int32_t i, int axis)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += wr_reference_part(corner(t, i, k), axis);
    return sum;
}

static void measure(const WrReferenceMesh *m, WrReferenceBox *box)
{
    box->about = wr_reference_bounds();
    for (int32_t i = box->first; i < box->first + box->count; i++)
        for (int k = 0; k < 3; k++)
            for (int axis = 0; axis < 3; axis++)
                wr_reference_bounds_add(&box->about, axis,
                                        wr_reference_part(corner(m->source, m->order[i], k), axis));
}

/* Moves the triangles below the middle of the box's longest side to the front; returns their number. If all are
   on one side, half of them. */
static int32_t divide(WrReferenceMesh *m, const WrReferenceBox *box)
{
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (box->about.high[k] - box->about.low[k] > box->about.high[axis] - box->about.low[axis])
            axis = k;
    const double at = 1.5 * (box->about.low[axis] + box->about.high[axis]);
    int32_t below = 0;
    for (int32_t i = 0; i < box->count; i++) {
        int32_t *own = &m->order[box->first + i], *to = &m->order[box->first + below];
        if (middle(m->source, *own, axis) >= at) continue;
        const int32_t moved = *own;
        *own = *to, *to = moved;
        below++;
    }
    return below > 0 && below < box->count ? below : box->count / 2;
}

/* boxes[] in breadth-first order: at most 2 count - 1. order[] permutes triangles so that a leaf's are
   consecutive. */
bool wr_reference_mesh_init(WrReferenceMesh *mesh, WrTriangles *source, WrError *err)
{
    const size_t count = (size_t)source->triangle_count;
    *mesh = (WrReferenceMesh){ .source = source, .box_count = 1 };
    mesh->boxes = wr_try_alloc(2 * count, sizeof *mesh->boxes, "the reference's tree", err);
    mesh->order =
        mesh->boxes ? wr_try_alloc(count, sizeof *mesh->order, "the reference's tree", err) : NULL;
    if (!mesh->order) return false;
    for (size_t i = 0; i < count; i++) mesh->order[i] = (int32_t)i;
    mesh->boxes[0] = (WrReferenceBox){ .first = 0, .count = source->triangle_count };
    for (int32_t i = 0; i < mesh->box_count; i++) {
        WrReferenceBox *box = &mesh->boxes[i];
        measure(mesh, box);
        if (box->count <= LEAF) continue;
        const int32_t below = divide(mesh, box), child = mesh->box_count;
        mesh->boxes[child] = (WrReferenceBox){ .first = box->first, .count = below };
        mesh->boxes[child + 1] =
            (WrReferenceBox){ .first = box->first + below, .count = box->count - below };
        mesh->box_count += 2;
        box->first = child, box->count = 0;
    }
    return true;
}

void wr_reference_mesh_fini(WrReferenceMesh *mesh)
{
    wr_triangles_free(mesh->source);
    wr_free(mesh->boxes);
    wr_free(mesh->order);
    wr_free(mesh->tangents);
    *mesh = (WrReferenceMesh){ 0 };
}

/* ---- rays ---- */

/* The ray's longest axis is z, and positions are sheared so that the ray runs along it.
   x, y, z are axis numbers; sx, sy, sz the shear and the scale of the ray's direction. */
typedef struct Shear {
    int x, y, z;
    double sx, sy, sz;
} Shear;

static Shear shear_of(WrVec3 d)
{
    Shear s = { .z = 0 };
    for (int k = 1; k < 3; k++)
        if (fabs(wr_reference_part(d, k)) > fabs(wr_reference_part(d, s.z))) s.z = k;
    s.x = (s.z + 1) % 3, s.y = (s.z + 2) % 3;
    s.sz = 1 / wr_reference_part(d, s.z);
    s.sx = wr_reference_part(d, s.x) * s.sz, s.sy = wr_reference_part(d, s.y) * s.sz;
    return s;
}

/* Woop, Benthin and Wald: the edge functions e0, e1, e2 of the sheared triangle decide; a ray on an edge (0)
   counts as inside for both neighbours, so that no ray passes between them.
   e_k is the signed area of the ray and the edge opposite corner k; on a shared edge both triangles compute
   the same products with opposite order, so the signs are exactly opposite (HC134, HC135). t is the weighted
   mean of the sheared z. */
static void test(const WrReferenceMesh *m, int32_t i, bool cull, const WrReferenceRay *ray,
                 const Shear *s, WrReferenceHit *best)
{
    double x[3], y[3], z[3];
    WrVec3 p[3];
    for (int k = 0; k < 3; k++) {
        p[k] = corner(m->source, i, k);
        const WrVec3 w = v3_sub(p[k], ray->q);
        z[k] = wr_reference_part(w, s->z) * s->sz;
        x[k] = wr_reference_part(w, s->x) - s->sx * wr_reference_part(w, s->z);
        y[k] = wr_reference_part(w, s->y) - s->sy * wr_reference_part(w, s->z);
    }
    const double e0 = x[2] * y[1] - y[2] * x[1], e1 = x[0] * y[2] - y[0] * x[2],
                 e2 = x[1] * y[0] - y[1] * x[0], det = e0 + e1 + e2;
    if ((e0 < 0 || e1 < 0 || e2 < 0) && (e0 > 0 || e1 > 0 || e2 > 0)) return;
    if (det == 0) return;
    const double t = (e0 * z[0] + e1 * z[1] + e2 * z[2]) / det;
    if (!(t > ray->s_min) || t >= best->s) return;
    const WrVec3 n = v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0]));
    if (cull && v3_dot(n, ray->d) >= 0) return;
    best->s = t;
    best->triangle = i;
    best->facet = n;
    best->share[0] = e1 / det, best->share[1] = e2 / det;
}

bool wr_reference_mesh_hit(const WrReferenceMesh *m, bool cull, const WrReferenceRay *ray,
                           WrReferenceHit *hit)
{
    const Shear shear = shear_of(ray->d);
    WrReferenceHit best = { .s = INFINITY, .triangle = -1 };
    int32_t stack[256], height = 0;
    stack[height++] = 0;
    while (height > 0) {
        const WrReferenceBox *box = &m->boxes[stack[--height]];
        if (!wr_reference_bounds_met(&box->about, ray, best.s, TRIANGLE_SLACK)) continue;
        for (int32_t i = 0; i < box->count; i++)
            test(m, m->order[box->first + i], cull, ray, &shear, &best);
        if (box->count == 0 && height + 2 <= 256)
            stack[height++] = box->first, stack[height++] = box->first + 1;
    }
    if (best.triangle < 0) return false;
    const WrTriangles *t = m->source;
    const int32_t *c = t->triangles[best.triangle].corner;
    const double l[3] = { 1 - best.share[0] - best.share[1], best.share[0], best.share[1] };
    best.u = best.v = 0;
    for (int k = 0; k < 3; k++) {
        best.u += l[k] * (double)t->corners[c[k]].u;
        best.v += l[k] * (double)t->corners[c[k]].v;
    }
    *hit = best;
    return true;
}

/* ---- tangent frames ---- */

/* One tangent for each corner of each triangle, [3 triangle + corner], not shared: seams differ by triangle. */
static bool reference_mesh_frame(WrReferenceMesh *mesh, WrNormalFrame frame, WrError *err)
{
    const WrTriangles *t = mesh->source;
    const size_t corners = 3 * (size_t)t->triangle_count;
    mesh->mikk = frame == WR_FRAME_MIKK;
    mesh->tangents = wr_try_alloc(corners, sizeof *mesh->tangents, "the reference's frames", err);
    return mesh->tangents && (mesh->mikk ? wr_tangents_mikk : wr_tangents_average)(
                                 t->corners, t->triangles, t->triangle_count, mesh->tangents, err);
}

/* MikkTSpace interpolates n and t without normalising and computes b = sign (n x t) per point; other frames
   interpolate both tangents and normalise. */
bool wr_reference_mesh_axes(const WrReferenceMesh *mesh, const WrReferenceHit *hit, WrMapAxes *axes)
{
    const WrVec3 none = { 0, 0, 0 };
    const WrTriangles *t = mesh->source;
    const double l[3] = { 1 - hit->share[0] - hit->share[1], hit->share[0], hit->share[1] };
    double sign = 0;
    *axes = (WrMapAxes){ none, none, none };
    if (!mesh->tangents) return false;
    for (int k = 0; k < 3; k++) {
        const WrTangent *own = &mesh->tangents[3 * (size_t)hit->triangle + (size_t)k];
        const float *n = t->corners[t->triangles[hit->triangle].corner[k]].n;
        axes->t = v3_mad(axes->t, own->t, l[k]);
        axes->b = v3_mad(axes->b, own->b, l[k]);
        axes->n = v3_mad(axes->n, (WrVec3){ (double)n[0], (double)n[1], (double)n[2] }, l[k]);
        sign += l[k] * own->sign;
    }
    if (mesh->mikk) axes->b = v3_scale(v3_cross(axes->n, axes->t), sign);
    else {
        axes->t = v3_unit(axes->t, none);
        axes->b = v3_unit(axes->b, none);
        axes->n = v3_unit(axes->n, none);
    }
    return v3_len(axes->t) > 0 && v3_len(axes->b) > 0;
}

/* ---- surface at a hit ---- */

static WrVec3 shading_normal(const WrTriangles *t, const WrReferenceHit *hit, WrVec3 face)
{
    const int32_t *c = t->triangles[hit->triangle].corner;
    const double l[3] = { 1 - hit->share[0] - hit->share[1], hit->share[0], hit->share[1] };
    WrVec3 n = { 0, 0, 0 };
    for (int k = 0; k < 3; k++) {
        const float *own = t->corners[c[k]].n;
        n = v3_mad(n, (WrVec3){ (double)own[0], (double)own[1], (double)own[2] }, l[k]);
    }
    return v3_unit(n, face);
}

/* The normal, moved to the visible side of its face.
   Interpolated normals may face away from the viewer on a visible face near the outline. Adding least - n.to
   along `to` moves them to 1e-4 in front, continuously; otherwise bumps would flip sign there (HC24). */
static WrVec3 seen_normal(WrVec3 n, WrVec3 face, WrVec3 to)
{
    const double least = 1e-4;
    const double front = v3_dot(face, n) < 0 ? -1 : 1;
    const double side = front * v3_dot(face, to) < 0 ? -1 : 1;
    const double now = side * v3_dot(n, to);
    if (now >= least) return n;
    return v3_unit(v3_mad(n, to, side * (least - now)), face);
}

/* The point there: P, n, and Pu, Pv, perpendicular to n, as  grad v x n  and  n x grad u  times |N|, so that
   Blinn's formula yields unit(n - grad F). With mirrored (u,v) both have the opposite sign; with (u,v) of area 0,
   |N| is 1. The normal of a face towards the eye is turned towards the eye as well, by a cosine of at least
   1e-4. */
static void reference_mesh_at(const WrReferenceView *view, const WrReferenceHit *hit,
                              WrSurfacePoint *out)
{
    const WrTriangles *t = view->mesh.source;
    const WrVec3 eye = view->perspective ? view->eye : view->toward;
    const int32_t *c = t->triangles[hit->triangle].corner;
    const WrVec3 none = { 0, 0, 0 };
    WrVec3 p[3], face = { 0, 0, 1 }, gu = none, gv = none;
    double uv[3][2];
    for (int k = 0; k < 3; k++) {
        p[k] = corner(t, hit->triangle, k);
        uv[k][0] = (double)t->corners[c[k]].u, uv[k][1] = (double)t->corners[c[k]].v;
    }
    (void)wr_triangle_gradients(p, (const double(*)[2])uv, &face, &gu, &gv);
    memset(out, 0, sizeof *out);
    out->p =
        v3_mad(v3_mad(p[0], v3_sub(p[1], p[0]), hit->share[0]), v3_sub(p[2], p[0]), hit->share[1]);
    const WrVec3 to = v3_unit(view->perspective ? v3_sub(eye, out->p) : eye, face);
    WrVec3 n = shading_normal(t, hit, face);
    if (!view->raised) n = seen_normal(n, face, to);
    wr_reference_lay(n, gu, gv, out);
}

/* ---- camera, rays and closed forms ---- */

/* Transforms a direction. */
static WrVec3 world_to_object(const WrPlacement *place, WrVec3 w)
{
    const double *m = place->rotation;
    return (WrVec3){ m[0] * w.x + m[3] * w.y + m[6] * w.z, m[1] * w.x + m[4] * w.y + m[7] * w.z,
                     m[2] * w.x + m[5] * w.y + m[8] * w.z };
}

/* Transforms a point: w = position + size M S (p - centre), S the stretch along the object's axes. */
static WrVec3 point_to_object(const WrPlacement *place, WrVec3 w)
{
    const WrVec3 away = world_to_object(place, v3_sub(w, place->position)), s = place->stretch;
    return (WrVec3){ away.x / s.x / place->size + place->centre.x,
                     away.y / s.y / place->size + place->centre.y,
                     away.z / s.z / place->size + place->centre.z };
}

/* Transforms a direction by the inverse of the stretch. */
static WrVec3 way_to_object(const WrPlacement *place, WrVec3 w)
{
    const WrVec3 own = world_to_object(place, w), s = place->stretch;
    return (WrVec3){ own.x / s.x, own.y / s.y, own.z / s.z };
}

/* The lighting space is object space times the stretch: angles and distances there are those of the world up
   to rotation and size. */
WrVec3 wr_reference_stretched(const WrReferenceView *view, WrVec3 p)
{
    return v3_times(p, view->stretch);
}

/* A normal transforms by the cofactor matrix of the stretch, |s1 s2 s3| / s_i, which stays finite for flat
   objects (HC33, HC153). */
WrVec3 wr_reference_normal_stretched(const WrReferenceView *view, WrVec3 n)
{
    const WrVec3 turned = v3_times(n, view->cofactor), none = { 0, 0, 0 };
    return view->stretched ? v3_unit(turned, none) : n;
}

/* Positions of lamps in the lighting space of this object, so that shading needs no transformation per sample. */
static void take_lights(WrReferenceView *view, const WrScene *scene, const WrPlacement *place)
{
    view->lights = wr_alloc((size_t)scene->light_count + 1, sizeof *view->lights);
    view->light_count = scene->light_count;
    for (int i = 0; i < scene->light_count; i++) {
        const WrLight *light = &scene->lights[i];
        WrReferenceLight *out = &view->lights[i];
        const WrVec3 ahead = { 0, 0, 1 };
        out->point = wr_light_kinds[light->kind].placed;
        out->where = out->point ? v3_times(point_to_object(place, light->where), place->stretch)
                                : v3_unit(world_to_object(place, light->where), ahead);
        out->radius = light->size_deg * (WR_PI / 180);
        out->shadow = light->shadow;
        out->rgb[0] = light->colour.x * light->strength;
        out->rgb[1] = light->colour.y * light->strength;
        out->rgb[2] = light->colour.z * light->strength;
    }
}

/* Hides the back faces of a closed box seen from outside. */
static void hide_faces(WrReferenceView *view)
{
    bool away[6] = { false }, outside = false;
    for (int face = 0; face < view->info->faces; face++) {
        WrSurfacePoint at;
        const WrSurfaceCell c = wr_surface_cell(view->shape, face);
        wr_surface_at(view->shape, face, (c.u0 + c.u1) / 2, (c.v0 + c.v1) / 2, &at);
        WrVec3 to = view->perspective ? v3_sub(view->eye, at.p) : view->toward;
        away[face] = !(v3_dot(to, at.n_unit) > 0);
        outside = outside || !away[face];
    }
    for (int face = 0; face < view->info->faces; face++)
        view->hidden[face] = view->info->convex_closed && outside && away[face];
}

/* Ownership: view->mesh.source holds a reference to the mesh in all cases; bezier.source points into it. */
static bool take_mesh(WrReferenceView *view, const WrScene *scene, WrError *err)
{
    WrTriangles *mesh =
        scene->triangles ? wr_triangles_share(scene->triangles) : wr_triangles_square();
    if (mesh->patches) {
        view->mesh.source = mesh; /* contains the patches */
        return reference_bezier_init(&view->bezier, mesh->patches, err);
    }
    const WrNormalFrame frame = wr_scene_frame(scene);
    const bool framed =
        scene->normals.image && (frame == WR_FRAME_MIKK || frame == WR_FRAME_LECTURE);
    return wr_reference_mesh_init(&view->mesh, mesh, err) &&
           (!framed || reference_mesh_frame(&view->mesh, frame, err));
}

/* The camera in object space: `right`, `up`, `forward` are divided by the stretch, so they may be skewed and
   of any length; the ray parameter s stays the depth along the world's view direction. s_min is the near
   plane. */
bool wr_reference_view_init(WrReferenceView *view, const WrScene *scene, double turn_deg, int width,
                            int height, WrError *err)
{
    *view = (WrReferenceView){ .shape = &scene->shape,
                               .info = wr_surfaces[scene->shape.kind],
                               .width = width,
                               .height = height };
    WrPlacement place;
    const double aspect = (double)width / height;
    if (!wr_scene_place(scene, turn_deg, aspect, &place, err)) return false;
    view->place = place;
    view->perspective = !place.orthographic;
    view->size = place.size;
    for (int i = 0; i < 9; i++) view->rotation[i] = place.rotation[i];
    view->eye = point_to_object(&place, place.eye);
    view->right = way_to_object(&place, place.right);
    view->up = way_to_object(&place, place.up);
    view->forward = way_to_object(&place, place.forward);
    view->toward = v3_neg(view->forward);
    view->deep = v3_times(world_to_object(&place, place.forward), place.stretch);
    view->stretched = place.stretched;
    view->stretch = place.stretch;
    view->cofactor = place.cofactor;
    view->lit_eye = v3_times(view->eye, place.stretch);
    view->lit_toward = v3_neg(world_to_object(&place, place.forward));
    view->half_h = place.half_height / (view->perspective ? 1 : place.size);
    view->half_w = view->half_h * aspect;
    const WrVec3 from_eye = v3_sub(place.centre, view->eye);
    view->depth = v3_dot(from_eye, view->deep);
    view->middle = v3_mad(view->eye, view->forward, view->depth);
    view->s_min = WR_NEAR_PLANE * place.radius - view->depth;
    const bool closed = view->info->held ? scene->triangles && scene->triangles->closed
                                         : view->info->closed_u && view->info->closed_v;
    view->cull = closed && (!view->perspective || v3_len(from_eye) > place.radius);
    hide_faces(view);
    take_lights(view, scene, &place);
    if (view->info->held) return take_mesh(view, scene, err);
    return view->info->inversion != WR_INVERT_MESH ||
           reference_patches_init(&view->patches, view->shape, err);
}

void wr_reference_view_fini(WrReferenceView *view)
{
    wr_free(view->lights);
    reference_patches_fini(&view->patches);
    reference_bezier_fini(&view->bezier);
    wr_reference_mesh_fini(&view->mesh);
    *view = (WrReferenceView){ 0 };
}

/* A ray is q + s d with s = 0 in the plane through the object's centre: coordinates near the surface are small
   numbers even if the eye is far away (HC154). The eye is at s = -depth. */
WrReferenceRay wr_reference_view_ray(const WrReferenceView *view, double x, double y)
{
    const double across = (2 * x / view->width - 1) * view->half_w;
    const double above = (1 - 2 * y / view->height) * view->half_h;
    const WrVec3 aside = v3_mad(v3_scale(view->right, across), view->up, above);
    if (!view->perspective)
        return (WrReferenceRay){ v3_add(view->middle, aside), view->forward, view->s_min };
    return (WrReferenceRay){ v3_mad(view->middle, aside, view->depth), v3_add(view->forward, aside),
                             view->s_min };
}

/* Derivatives of q and d by x and y of the picture, pixels. */
void wr_reference_view_spread(const WrReferenceView *view, WrReferenceRay *per_x,
                              WrReferenceRay *per_y)
{
    const WrVec3 x = v3_scale(view->right, 2 * view->half_w / view->width);
    const WrVec3 y = v3_scale(view->up, -2 * view->half_h / view->height), none = { 0, 0, 0 };
    const double far = view->perspective ? view->depth : 1;
    *per_x = (WrReferenceRay){ v3_scale(x, far), view->perspective ? x : none, 0 };
    *per_y = (WrReferenceRay){ v3_scale(y, far), view->perspective ? y : none, 0 };
}

/* The angle of (x, y) in turns, 0 <= u < 1. */
static double turns(double y, double x)
{
    const double u = wr_atan2(y, x) / (2 * WR_PI), up = u < 0 ? u + 1 : u;
    return up < 1 ? up : 0;
}

static double within(double t)
{
    return t > 0 ? t < 1 ? t : 1 : 0;
}

/* Roots relative to the foot of the perpendicular from the centre: R^2 - foot^2 is not a difference of large
   squares, however far the ray starts. The nearer root counts unless it is in front of the near plane. */
static bool hit_sphere(const WrReferenceView *view, const WrReferenceRay *ray, WrReferenceHit *hit)
{
    const double R = view->shape->value[0], dd = v3_dot(ray->d, ray->d);
    const double foot = -v3_dot(ray->q, ray->d) / dd;
    const WrVec3 nearest = v3_mad(ray->q, ray->d, foot);
    const double left = R * R - v3_dot(nearest, nearest);
    if (!(left >= 0)) return false;
    double half = sqrt(left / dd);
    if (foot - half > ray->s_min) half = -half;
    if (!(foot + half > ray->s_min)) return false;
    const WrVec3 p = v3_mad(nearest, ray->d, half);
    *hit = (WrReferenceHit){
        .s = foot + half,
        .u = turns(p.y, p.x),
        .v = within(0.5 + wr_atan2(p.z, sqrt(p.x * p.x + p.y * p.y)) / WR_PI),
    };
    return true;
}

/* As the sphere, in x and y only; rays parallel to the axis hit nothing, because the tube is open.
   Both roots are tried: the nearer one may lie beyond a rim while the far one shows the inside. */
static bool hit_cylinder(const WrReferenceView *view, const WrReferenceRay *ray,
                         WrReferenceHit *hit)
{
    const double R = view->shape->value[0];
    const double dd = ray->d.x * ray->d.x + ray->d.y * ray->d.y;
    if (!(dd > 1e-30)) return false;
    const double foot = -(ray->q.x * ray->d.x + ray->q.y * ray->d.y) / dd;
    const double x = ray->q.x + foot * ray->d.x, y = ray->q.y + foot * ray->d.y;
    const double left = R * R - (x * x + y * y);
    if (!(left >= 0)) return false;
    const double half = sqrt(left / dd), H = view->shape->value[1];
    for (int k = -1; k <= 1; k += 2) { /* the nearer root between the rims */
        const double s = foot + k * half;
        const WrVec3 p = v3_mad(ray->q, ray->d, s);
        if (!(s > ray->s_min && fabs(p.z) <= H / 2)) continue;
        *hit = (WrReferenceHit){ .s = s, .u = turns(p.y, p.x), .v = within(0.5 + p.z / H) };
        return true;
    }
    return false;
}

/* x^2 + y^2 = (R/H)^2 w^2, w = H/2 - z; the roots by t / a and c / t, and b^2 - a c by Lagrange's identity: no
   difference of values that are nearly equal at the tip. Relative to the ray's point nearest the tip. */
static bool hit_cone(const WrReferenceView *view, const WrReferenceRay *ray, WrReferenceHit *hit)
{
    const double H = view->shape->value[1], slope = view->shape->value[0] / H;
    const WrVec3 d = ray->d, from = { ray->q.x, ray->q.y, ray->q.z - H / 2 };
    const double foot = -v3_dot(from, d) / v3_dot(d, d);
    const WrVec3 q = v3_mad(from, d, foot);
    const double w = -slope * q.z, dw = -slope * d.z;
    const double a = d.x * d.x + d.y * d.y - dw * dw, b = q.x * d.x + q.y * d.y - w * dw;
    const double c = q.x * q.x + q.y * q.y - w * w;
    const double x = q.x * dw - w * d.x, y = q.y * dw - w * d.y, z = q.x * d.y - q.y * d.x;
    const double disc = x * x + y * y - z * z;
    if (!(disc >= 0)) return false;
    const double t = b > 0 ? -b - sqrt(disc) : -b + sqrt(disc);
    const double s0 = a != 0 ? t / a : INFINITY, s1 = t != 0 ? c / t : 0;
    const double roots[2] = { fmin(s0, s1), fmax(s0, s1) };
    for (int k = 0; k < 2; k++) {
        const WrVec3 p = v3_mad(q, d, roots[k]);
        if (!(foot + roots[k] > ray->s_min && p.z <= 0 && p.z >= -H)) continue;
        *hit = (WrReferenceHit){ .s = foot + roots[k],
                                 .u = turns(p.y, p.x),
                                 .v = within(1 + p.z / H) };
        return true;
    }
    return false;
}

/* The plane of each visible face: (u,v) are the dot products with Pu and Pv, which are perpendicular.
   u = w . Pu / |Pu|^2 along a face's own axes. The slack of 2^-48 makes neighbouring faces overlap by rounding
   only. */
static bool hit_faces(const WrReferenceView *view, const WrReferenceRay *ray, WrReferenceHit *hit)
{
    bool found = false;
    for (int face = 0; face < view->info->faces; face++) {
        if (view->hidden[face]) continue;
        WrSurfacePoint at;
        const WrSurfaceCell c = wr_surface_cell(view->shape, face);
        wr_surface_at(view->shape, face, c.u0, c.v0, &at);
        const double dn = v3_dot(ray->d, at.n_unit);
        const double s = v3_dot(v3_sub(at.p, ray->q), at.n_unit) / dn;
        if (!(dn != 0 && s > ray->s_min && isfinite(s)) || (found && s >= hit->s)) continue;
        const WrVec3 w = v3_sub(v3_mad(ray->q, ray->d, s), at.p);
        const double wide = c.u1 - c.u0, high = c.v1 - c.v0;
        const double x = v3_dot(w, at.pu) / v3_dot(at.pu, at.pu) / wide;
        const double y = v3_dot(w, at.pv) / v3_dot(at.pv, at.pv) / high;
        const double edge = 0x1p-48; /* a ray along the edge of two faces hits one */
        if (wr_shape_endless(view->shape) || view->beyond) {
            if (!(fmax(fabs(x), fabs(y)) <= WR_ENDLESS)) continue;
            *hit = (WrReferenceHit){ .s = s, .u = x, .v = y, .face = face };
            return true;
        }
        if (!(x >= -edge && x <= 1 + edge && y >= -edge && y <= 1 + edge)) continue;
        *hit = (WrReferenceHit){
            .s = s, .u = c.u0 + wide * within(x), .v = c.v0 + high * within(y), .face = face
        };
        found = true;
    }
    return found;
}

void wr_reference_surface_point(const WrReferenceView *view, const WrReferenceHit *hit,
                                WrSurfacePoint *out)
{
    if (!view->info->held) {
        wr_surface_at(view->shape, hit->face, hit->u, hit->v, out);
        return;
    }
    if (view->bezier.source) {
        reference_bezier_at(&view->bezier, hit, out);
        return;
    }
    reference_mesh_at(view, hit, out);
}

bool wr_reference_view_hit(const WrReferenceView *view, const WrReferenceRay *ray,
                           WrReferenceHit *hit)
{
    switch (view->info->inversion) {
    case WR_INVERT_SPHERE: return hit_sphere(view, ray, hit);
    case WR_INVERT_CYLINDER: return hit_cylinder(view, ray, hit);
    case WR_INVERT_CONE: return hit_cone(view, ray, hit);
    case WR_INVERT_PLANE:
    case WR_INVERT_CUBE: return hit_faces(view, ray, hit);
    case WR_INVERT_TRIANGLES:
        return view->bezier.source ? reference_bezier_hit(&view->bezier, view->cull, ray, hit)
                                   : wr_reference_mesh_hit(&view->mesh, view->cull, ray, hit);
    case WR_INVERT_MESH: break;
    }
    return reference_patches_hit(&view->patches, view->shape, view->cull, ray, hit);
}
