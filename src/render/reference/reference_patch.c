/* Construction: a piece is measured at 3 x 3 points and halved while its normals spread or its bend is not small
   compared with its size. A box around the four corners, grown by the bend / 8, contains the piece: its corners'
   bilinear patch is in the box, and the surface within (|Puu| du^2 + 2 |Puv| du dv + |Pvv| dv^2) / 8 of that
   (Taylor).

   Search: where a ray makes a positive angle with all normals of a piece, the piece is a graph over the ray's
   plane and has at most one root: Newton's method from its centre finds it or leaves the piece. Otherwise
   (outlines, folds, points where a tangent vanishes) it starts from five points. */
#include "render/reference/reference_patch.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/vec.h"

#include <math.h>
#include <string.h>

/* ---- reference bezier ---- */

#define SLACK 1e-12
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

bool wr_reference_bezier_init(WrReferenceBezier *set, const WrPatches *source, WrError *err)
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
        if (!wr_reference_patches_init(&piece->tree, &piece->shape, err)) return false;
    }
    return true;
}

void wr_reference_bezier_fini(WrReferenceBezier *set)
{
    for (int32_t i = 0; set->pieces && i < set->source->count; i++)
        wr_reference_patches_fini(&set->pieces[i].tree);
    wr_free(set->pieces);
    *set = (WrReferenceBezier){ 0 };
}

bool wr_reference_bezier_hit(const WrReferenceBezier *set, bool cull, const WrReferenceRay *ray,
                             WrReferenceHit *hit)
{
    WrReferenceHit best = { .s = INFINITY, .triangle = -1 };
    for (int32_t i = 0; i < set->source->count; i++) {
        const WrReferenceBezierPiece *piece = &set->pieces[i];
        if (i % GROUP == 0 && !wr_reference_bounds_met(&piece->group, ray, best.s, SLACK)) {
            i += GROUP - 1;
            continue;
        }
        WrReferenceHit own = { 0 };
        if (!wr_reference_bounds_met(&piece->box, ray, best.s, SLACK) ||
            !wr_reference_patches_hit(&piece->tree, &piece->shape, cull, ray, &own) ||
            own.s >= best.s)
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

/* The point with derivatives by the table's u and v, from the gradients of the patch's parameters. */
void wr_reference_bezier_at(const WrReferenceBezier *set, const WrReferenceHit *hit,
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
   those of their halves. */
bool wr_reference_patches_init(WrReferencePatches *patches, const WrShape *shape, WrError *err)
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

void wr_reference_patches_fini(WrReferencePatches *patches)
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

/* Offers a root or a possible root: the nearest is kept. */
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

/* From dot products with Pv x d and d x Pu. */
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

/* Newton's method from (u, v), within two lengths of the piece; most: longest step, in pieces. */
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

bool wr_reference_patches_hit(const WrReferencePatches *patches, const WrShape *shape, bool cull,
                              const WrReferenceRay *ray, WrReferenceHit *hit)
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
