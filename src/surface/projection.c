#include "surface/projection.h"

#include "surface/relief_weights.h"
#include "surface/triangles_internal.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/hash.h"
#include "base/memory.h"
#include "field/field.h"

#include <math.h>
#include <string.h>

#define WIDE_TAN                                                                                   \
    0.087664535059884502  /* tan 5.01 degrees: rounding does not divide bodies of 72 sides */
#define SHORT (1.0 / 128) /* edges below this fraction of R are not divided: 0.45 degrees at R */
#define POLE 1e-6         /* distance from the axis, as a fraction of R, without an angle */
#define DIAGONAL                                                                                   \
    (1 + 1e-5)    /* factor by which a component must be larger, so that the rounding of a face at
                              45 degrees does not decide */
#define DEPTH 128 /* of divisions; the count of triangles ends them earlier */

const char *const wr_projection_names[WR_PROJECTIONS + 1] = { "uv",          "planar",    "box",
                                                              "cylindrical", "spherical", NULL };
const char *const wr_facing_names[WR_FACINGS + 1] = { "any", "x",  "y",   "z",  "-x",
                                                      "-y",  "-z", "out", "in", NULL };
const WrProjection wr_projection_default = { .cell = { 10, 10 },
                                             .crease_deg = WR_CREASE_NONE,
                                             .facing_deg = 45 };

/* The first corner is between the two shortest edges, so this is the most exact one (triangles.h). */
static WrVec3 face_cross(const WrTriangles *mesh, int32_t triangle)
{
    const WrVec3 p = v3_load(wr_triangle_corner(mesh, triangle, 0)->p);
    return v3_cross(v3_sub(v3_load(wr_triangle_corner(mesh, triangle, 1)->p), p),
                    v3_sub(v3_load(wr_triangle_corner(mesh, triangle, 2)->p), p));
}

/* ---- edges ---- */

void wr_mesh_edges_fini(WrMeshEdges *edges)
{
    wr_free(edges->place);
    wr_free(edges->edge);
}

bool wr_mesh_edges_find(const WrTriangles *mesh, WrMeshEdges *out, WrError *err)
{
    const size_t corners = (size_t)mesh->corner_count, halves = 3 * (size_t)mesh->triangle_count;
    *out = (WrMeshEdges){ 0 };
    out->place = wr_try_alloc(corners, sizeof *out->place, "a mesh's edges", err);
    out->edge = wr_try_alloc(halves, sizeof *out->edge, "a mesh's edges", err);
    float(*p)[3] = wr_try_alloc(corners, sizeof *p, "a mesh's edges", err);
    int32_t(*ends)[2] = wr_try_alloc(halves, sizeof *ends, "a mesh's edges", err);
    bool good = out->place && out->edge && p && ends;
    for (size_t i = 0; i < corners && good; i++) memcpy(p[i], mesh->corners[i].p, sizeof p[i]);
    good = good && wr_weld(p, sizeof *p, mesh->corner_count, out->place, &out->places, err);
    for (size_t i = 0; i < halves && good; i++) {
        const int32_t *c = mesh->triangles[i / 3].corner;
        const int32_t a = out->place[c[i % 3]], b = out->place[c[(i + 1) % 3]];
        ends[i][0] = a < b ? a : b, ends[i][1] = a < b ? b : a;
    }
    good = good && wr_weld(ends, sizeof *ends, (int32_t)halves, out->edge, &out->count, err);
    wr_free(p);
    wr_free(ends);
    if (!good) wr_mesh_edges_fini(out);
    return good;
}

/* The corner numbers (0..2) at the ends of a half-edge, the one of the lower position first. */
static void ends_of(const WrTriangles *mesh, const WrMeshEdges *edges, int32_t half, int end[2])
{
    const int32_t *c = mesh->triangles[half / 3].corner;
    const int a = half % 3, b = (half + 1) % 3;
    const bool rising = edges->place[c[a]] < edges->place[c[b]];
    end[0] = rising ? a : b, end[1] = rising ? b : a;
}

/* Sets as trees: of[i] is another member of i's set, or i itself at the root. */
static int32_t root_of(int32_t *of, int32_t i)
{
    while (of[i] != i) i = of[i] = of[of[i]];
    return i;
}

static void join(int32_t *of, int32_t a, int32_t b)
{
    a = root_of(of, a), b = root_of(of, b);
    if (a < b) of[b] = a;
    else of[a] = b;
}

static int32_t *new_sets(int32_t count, WrError *err)
{
    int32_t *of = wr_try_alloc((size_t)count, sizeof *of, "a mesh's edges", err);
    for (int32_t i = 0; i < count && of; i++) of[i] = i;
    return of;
}

/* ---- crease normals ---- */

/* Joins the corners of faces that meet at a smooth edge; group: [3 triangle_count]. */
static void join_smooth(const WrTriangles *mesh, const WrMeshEdges *edges, double cosine,
                        int32_t *last, int32_t *group)
{
    const WrVec3 none = { 0, 0, 0 };
    for (int32_t h = 0; h < 3 * mesh->triangle_count; h++) {
        const int32_t before = last[edges->edge[h]] - 1;
        last[edges->edge[h]] = h + 1;
        if (before < 0 || v3_dot(v3_unit(face_cross(mesh, h / 3), none),
                                 v3_unit(face_cross(mesh, before / 3), none)) < cosine - 1e-6)
            continue;
        int own[2], other[2];
        ends_of(mesh, edges, h, own);
        ends_of(mesh, edges, before, other);
        for (int k = 0; k < 2; k++) join(group, h - h % 3 + own[k], before - before % 3 + other[k]);
    }
}

/* Normals of all corners, [3 triangle_count]: of each group of smoothly connected faces the mean, weighted by
   the corners' angles, as of meshes without normals (triangles.c). NULL: out of memory. */
static WrVec3 *crease_normals(const WrTriangles *mesh, double crease_deg, WrError *err)
{
    const int32_t count = 3 * mesh->triangle_count;
    WrMeshEdges edges;
    double sine, cosine;
    if (!wr_mesh_edges_find(mesh, &edges, err)) return NULL;
    wr_sincos_turns(crease_deg / 360, &sine, &cosine);
    int32_t *last = wr_try_alloc((size_t)edges.count, sizeof *last, "a mesh's edges", err);
    int32_t *group = last ? new_sets(count, err) : NULL;
    WrVec3 *sum = group ? wr_try_alloc((size_t)count, sizeof *sum, "a mesh's normals", err) : NULL;
    if (sum) join_smooth(mesh, &edges, cosine, last, group);
    for (int32_t i = 0; i < count && sum; i++) {
        const WrVec3 p = v3_load(wr_triangle_corner(mesh, i / 3, i % 3)->p);
        const WrVec3 a = v3_sub(v3_load(wr_triangle_corner(mesh, i / 3, (i + 1) % 3)->p), p);
        const WrVec3 b = v3_sub(v3_load(wr_triangle_corner(mesh, i / 3, (i + 2) % 3)->p), p);
        const WrVec3 face = v3_unit(face_cross(mesh, i / 3), (WrVec3){ 0, 0, 0 });
        WrVec3 *to = &sum[root_of(group, i)];
        *to = v3_mad(*to, face, wr_angle(a, b));
    }
    for (int32_t i = count; i-- > 0 && sum;) /* roots come last: they are the lowest of a group */
        sum[i] = v3_unit(sum[root_of(group, i)], v3_unit(face_cross(mesh, i / 3), sum[i]));
    wr_free(group);
    wr_free(last);
    wr_mesh_edges_fini(&edges);
    return sum;
}

/* ---- the projection's frame ---- */

typedef struct Work {
    const WrTriangles *mesh;
    const WrProjection *is;
    WrVec3 axis[3], at;    /* axes and origin, in the mesh's coordinates */
    double scale;          /* millimetres per unit of the mesh */
    double radius, round;  /* R, n */
    WrTriangleCorner *out; /* [3 count], or NULL: only counts */
    float (*mask_uv)[2];   /* [3 count] the mesh's own (u,v), or NULL: not wanted */
    int32_t count;
} Work;

static bool is_round(const WrProjection *projection)
{
    return projection->kind >= WR_PROJECTION_CYLINDRICAL;
}

static WrVec3 turned(WrVec3 v, const double deg[3])
{
    double s, c;
    wr_sincos_turns(deg[0] / 360, &s, &c);
    v = (WrVec3){ v.x, c * v.y - s * v.z, s * v.y + c * v.z };
    wr_sincos_turns(deg[1] / 360, &s, &c);
    v = (WrVec3){ c * v.x + s * v.z, v.y, c * v.z - s * v.x };
    wr_sincos_turns(deg[2] / 360, &s, &c);
    return (WrVec3){ c * v.x - s * v.y, s * v.x + c * v.y, v.z };
}

static WrVec3 to_axes(const Work *w, WrVec3 v)
{
    return (WrVec3){ v3_dot(v, w->axis[0]), v3_dot(v, w->axis[1]), v3_dot(v, w->axis[2]) };
}

static WrVec3 local(const Work *w, const float p[3])
{
    return to_axes(w, v3_scale(v3_sub(v3_load(p), w->at), w->scale));
}

/* The point without its part along the axis; all of it for a sphere. */
static WrVec3 radial(const Work *w, WrVec3 q)
{
    return w->is->kind == WR_PROJECTION_SPHERICAL ? q : (WrVec3){ q.x, q.y, 0 };
}

/* R = sum |A.r| / sum |A.r| / |r| over the triangles' centroids r and area vectors A. */
static void find_radius(Work *w)
{
    double sum = 0, weight = 0, most = 0;
    for (int32_t i = 0; i < w->mesh->triangle_count; i++) {
        WrVec3 middle = { 0, 0, 0 };
        for (int k = 0; k < 3; k++) {
            const WrVec3 q = local(w, wr_triangle_corner(w->mesh, i, k)->p);
            middle = v3_mad(middle, q, 1.0 / 3);
            most = fmax(most, v3_len(radial(w, q)));
        }
        const WrVec3 r = radial(w, middle);
        const double facing = fabs(v3_dot(to_axes(w, face_cross(w->mesh, i)), r)), away = v3_len(r);
        if (!(away > 0)) continue;
        sum += facing, weight += facing / away;
    }
    w->radius = weight > 0 ? sum / weight : most;
    w->round = fmax(1, floor(2 * WR_PI * w->radius / w->is->cell[0] + 0.5));
}

static void find_centre(const WrTriangles *mesh, double at[3])
{
    double low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };
    for (int32_t i = 0; i < mesh->corner_count; i++)
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], (double)mesh->corners[i].p[k]);
            high[k] = fmax(high[k], (double)mesh->corners[i].p[k]);
        }
    for (int k = 0; k < 3; k++) at[k] = low[k] / 2 + high[k] / 2;
}

static Work begin(const WrTriangles *mesh, const WrProjection *projection)
{
    Work w = { .mesh = mesh, .is = projection };
    double at[3];
    if (projection->placed) memcpy(at, projection->at, sizeof at);
    else find_centre(mesh, at);
    w.at = (WrVec3){ at[0], at[1], at[2] };
    w.axis[0] = turned((WrVec3){ 1, 0, 0 }, projection->turn_deg);
    w.axis[1] = turned((WrVec3){ 0, 1, 0 }, projection->turn_deg);
    w.axis[2] = turned((WrVec3){ 0, 0, 1 }, projection->turn_deg);
    w.scale = wr_length_unit_mm(projection->unit);
    if (is_round(projection)) find_radius(&w);
    return w;
}

/* ---- texture coordinates of one triangle ---- */

/* n: of the face, along the projection's axes. */
static void lay_box(const Work *w, const WrVec3 q[3], WrVec3 n, double uv[3][2])
{
    const double part[3] = { n.x, n.y, n.z };
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(part[k]) > fabs(part[axis]) * DIAGONAL) axis = k;
    const double sign = part[axis] < 0 ? -1 : 1;
    for (int k = 0; k < 3; k++) {
        uv[k][0] = sign * (axis == 0 ? q[k].y : axis == 1 ? -q[k].x : q[k].x) / w->is->cell[0];
        uv[k][1] = (axis == 2 ? q[k].y : q[k].z) / w->is->cell[1];
    }
}

static bool on_axis(const Work *w, WrVec3 q)
{
    return v3_len((WrVec3){ q.x, q.y, 0 }) <= POLE * w->radius;
}

static void lay_round(const Work *w, const WrVec3 q[3], double uv[3][2])
{
    double turn[3], sum = 0;
    int first = -1, count = 0;
    for (int k = 0; k < 3; k++) {
        const double height =
            w->is->kind == WR_PROJECTION_CYLINDRICAL
                ? q[k].z
                : w->radius * wr_atan2(q[k].z, v3_len((WrVec3){ q[k].x, q[k].y, 0 }));
        uv[k][1] = height / w->is->cell[1];
        if (on_axis(w, q[k])) continue;
        turn[k] = wr_atan2(q[k].y, q[k].x) / (2 * WR_PI);
        if (first < 0) first = k;
        turn[k] -= floor(turn[k] - turn[first] + 0.5); /* within half a turn of the first */
        sum += turn[k], count++;
    }
    for (int k = 0; k < 3; k++)
        uv[k][0] = w->round * (!on_axis(w, q[k]) ? turn[k] : count > 0 ? sum / count : 0);
}

/* Sets (u,v) of corners c; n: of the face, along the projection's axes. */
static bool lay(const Work *w, WrTriangleCorner c[3], WrVec3 n, WrError *err)
{
    double uv[3][2];
    WrVec3 q[3];
    if (w->is->kind == WR_PROJECTION_UV) return true;
    for (int k = 0; k < 3; k++) q[k] = local(w, c[k].p);
    if (w->is->kind == WR_PROJECTION_PLANAR) lay_box(w, q, (WrVec3){ 0, 0, 1 }, uv);
    else if (w->is->kind == WR_PROJECTION_BOX) lay_box(w, q, n, uv);
    else lay_round(w, q, uv);
    for (int k = 0; k < 3; k++) {
        if (!(fabs(uv[k][0]) <= WR_PROJECTION_CELLS && fabs(uv[k][1]) <= WR_PROJECTION_CELLS))
            return wr_fail(err,
                           "cell=%g,%g mm: the mesh extends over more than %d cells from the "
                           "projection's origin; give larger cells, or another unit=",
                           w->is->cell[0], w->is->cell[1], WR_PROJECTION_CELLS);
        c[k].u = (float)uv[k][0], c[k].v = (float)uv[k][1];
    }
    return true;
}

/* ---- division of triangles ---- */

/* True if the angles along an edge are to be divided; at the axis always, so that its triangles, which meet without
   a common angle there, are short. Depends on its two ends alone, in either order: each
   product and sum here is the same, or its negative, for the reverse edge. */
static bool is_wide(const Work *w, WrVec3 a, WrVec3 b)
{
    const WrVec3 d = v3_sub(b, a);
    const double shortest = SHORT * w->radius;
    if (v3_dot(d, d) <= shortest * shortest) return false;
    const double dot = a.x * b.x + a.y * b.y, cross = a.x * b.y - a.y * b.x;
    const int poles = on_axis(w, a) + on_axis(w, b);
    if (poles == 1 || (poles == 0 && (dot <= 0 || fabs(cross) > WIDE_TAN * dot))) return true;
    return w->is->kind == WR_PROJECTION_SPHERICAL &&
           (v3_dot(a, b) <= 0 || v3_len(v3_cross(a, b)) > WIDE_TAN * v3_dot(a, b));
}

/* Sums are the same in either order, so both faces at an edge get the same bits. */
static WrTriangleCorner middle(const WrTriangleCorner *a, const WrTriangleCorner *b)
{
    WrTriangleCorner m = { .u = (a->u + b->u) / 2, .v = (a->v + b->v) / 2 };
    const WrVec3 n = v3_unit(v3_add(v3_load(a->n), v3_load(b->n)), (WrVec3){ 0, 0, 0 });
    for (int k = 0; k < 3; k++) m.p[k] = (float)(((double)a->p[k] + (double)b->p[k]) / 2);
    m.n[0] = (float)n.x, m.n[1] = (float)n.y, m.n[2] = (float)n.z;
    return m;
}

static bool emit(Work *w, const WrTriangleCorner c[3], WrVec3 n, WrError *err)
{
    if (w->count == WR_TRIANGLES_MAX)
        return wr_fail(err, "projection=%s: the mesh is divided into more than %d triangles",
                       wr_projection_names[w->is->kind], WR_TRIANGLES_MAX);
    if (w->out) {
        WrTriangleCorner *to = w->out + 3 * (size_t)w->count;
        memcpy(to, c, 3 * sizeof *to);
        for (int k = 0; k < 3 && w->mask_uv; k++) {
            float *own = w->mask_uv[3 * (size_t)w->count + (size_t)k];
            own[0] = c[k].u, own[1] = c[k].v;
        }
        if (!lay(w, to, n, err)) return false;
    }
    w->count++;
    return true;
}

static bool divide(Work *w, const WrTriangleCorner c[3], WrVec3 n, int depth, WrError *err)
{
    bool wide[3] = { false };
    int edges = 0, from = 0;
    for (int k = 0; k < 3 && is_round(w->is) && depth < DEPTH; k++)
        edges += wide[k] = is_wide(w, local(w, c[k].p), local(w, c[(k + 1) % 3].p));
    if (edges == 0) return emit(w, c, n, err);
    /* the divided edges become the first ones */
    while (edges < 3 && !(wide[from] && !wide[(from + 2) % 3])) from++;
    const WrTriangleCorner a = c[from], b = c[(from + 1) % 3], d = c[(from + 2) % 3];
    const WrTriangleCorner ab = middle(&a, &b), bd = middle(&b, &d), da = middle(&d, &a);
    const WrTriangleCorner one[2][3] = { { a, ab, d }, { ab, b, d } };
    const WrTriangleCorner two[3][3] = { { ab, b, bd }, { a, ab, bd }, { a, bd, d } };
    const WrTriangleCorner all[4][3] = {
        { a, ab, da }, { ab, b, bd }, { da, bd, d }, { ab, bd, da }
    };
    const WrTriangleCorner(*parts)[3] = edges == 1 ? one : edges == 2 ? two : all;
    for (int i = 0; i <= edges; i++)
        if (!divide(w, parts[i], n, depth + 1, err)) return false;
    return true;
}

/* normals: [3 triangle_count] or NULL; parts: [part_count], whose ranges are set. */
static bool divide_all(Work *w, const WrVec3 *normals, WrTrianglePart *parts, WrError *err)
{
    w->count = 0;
    for (int32_t p = 0; p < w->mesh->part_count; p++) {
        const WrTrianglePart *part = &w->mesh->parts[p];
        parts[p] = *part;
        parts[p].first = w->count;
        for (int32_t i = part->first; i < part->first + part->count; i++) {
            WrTriangleCorner c[3];
            for (int k = 0; k < 3; k++) {
                c[k] = *wr_triangle_corner(w->mesh, i, k);
                if (!part->mapped && w->is->kind == WR_PROJECTION_UV) c[k].u = c[k].v = NAN;
                if (!normals) continue;
                const WrVec3 n = normals[3 * i + k];
                c[k].n[0] = (float)n.x, c[k].n[1] = (float)n.y, c[k].n[2] = (float)n.z;
            }
            if (!divide(w, c, to_axes(w, face_cross(w->mesh, i)), 0, err)) return false;
        }
        parts[p].count = w->count - parts[p].first;
    }
    return true;
}

/* ---- the new mesh ---- */

/* The corners as a source, each a point of its own. */
static WrTriangles *make(const Work *w, const WrTrianglePart *parts, WrError *err)
{
    const size_t rows = 3 * (size_t)w->count;
    WrTriangles *made = NULL;
    int32_t *corners = wr_try_alloc(rows, sizeof *corners, "a mesh", err);
    float(*p)[3] = corners ? wr_try_alloc(rows, sizeof *p, "a mesh", err) : NULL;
    float(*n)[3] = p ? wr_try_alloc(rows, sizeof *n, "a mesh", err) : NULL;
    float(*uv)[2] = n ? wr_try_alloc(rows, sizeof *uv, "a mesh", err) : NULL;
    if (uv) {
        for (size_t i = 0; i < rows; i++) {
            const WrTriangleCorner *c = &w->out[i];
            corners[i] = (int32_t)i;
            memcpy(p[i], c->p, sizeof *p);
            memcpy(n[i], c->n, sizeof *n);
            uv[i][0] = c->u, uv[i][1] = c->v;
        }
        const WrTrianglesSource source = { .points = (const float(*)[3])p,
                                           .normals = (const float(*)[3])n,
                                           .uv = (const float(*)[2])uv,
                                           .mask_uv = (const float(*)[2])w->mask_uv,
                                           .corners = (const int32_t(*)[3])(void *)corners,
                                           .point_count = (int32_t)rows,
                                           .triangle_count = w->count,
                                           .parts = parts,
                                           .part_count = w->mesh->part_count };
        made = wr_triangles_new(&source, err);
    }
    wr_free(uv);
    wr_free(n);
    wr_free(p);
    wr_free(corners);
    return made;
}

/* Gives the mesh its weights. Its key changes with them, so that caches notice. */
static WrTriangles *with_weights(WrTriangles *made, const Work *w, const WrField *mask,
                                 WrError *err)
{
    const WrProjection *is = w->is;
    const WrProjectionFrame frame = { { w->axis[0], w->axis[1], w->axis[2] }, w->at, w->scale };
    const double numbers[] = { is->facing, is->facing_deg, is->facing_soft_deg, is->blend };
    WrHash hash = { made->key, 0 };
    hash = wr_hash_bytes(numbers, sizeof numbers, hash);
    hash = wr_hash_bytes(&frame, sizeof frame, hash);
    hash = wr_hash_bytes(is->materials, strlen(is->materials), hash);
    if (mask) {
        const WrHash own = wr_field_hash(mask);
        hash = wr_hash_bytes(&own, sizeof own, hash);
        hash = wr_hash_bytes(made->mask_uv,
                             3 * (size_t)made->triangle_count * sizeof *made->mask_uv, hash);
    }
    made->key = hash.low;
    made->weights = wr_relief_weights_new(made, is, &frame, mask, err);
    if (made->weights) return made;
    wr_triangles_free(made);
    return NULL;
}

WrTriangles *wr_triangles_project(const WrTriangles *mesh, const WrProjection *projection,
                                  const WrField *mask, WrError *err)
{
    const bool creased = projection->crease_deg < WR_CREASE_NONE;
    const bool weighted = mask || wr_relief_is_weighted(projection);
    if (projection->kind == WR_PROJECTION_UV && !creased && !weighted)
        return wr_triangles_share(mesh);
    Work w = begin(mesh, projection);
    WrTriangles *made = NULL;
    WrVec3 *normals = creased ? crease_normals(mesh, projection->crease_deg, err) : NULL;
    WrTrianglePart *parts = wr_alloc((size_t)mesh->part_count, sizeof *parts);
    if ((normals || !creased) && divide_all(&w, normals, parts, err)) {
        w.out = wr_try_alloc((size_t)w.count, 3 * sizeof *w.out, "a mesh", err);
        if (w.out && mask)
            w.mask_uv = wr_try_alloc((size_t)w.count, 3 * sizeof *w.mask_uv, "a mesh's mask", err);
        if (w.out && (w.mask_uv || !mask) && divide_all(&w, normals, parts, err))
            made = make(&w, parts, err);
        wr_free(w.mask_uv);
        wr_free(w.out);
    }
    wr_free(parts);
    wr_free(normals);
    return made && weighted ? with_weights(made, &w, mask, err) : made;
}

int wr_projection_round(const WrTriangles *mesh, const WrProjection *projection, double *radius_mm)
{
    const Work w = begin(mesh, projection);
    *radius_mm = w.radius;
    return (int)fmin(w.round, 1e9);
}

/* ---- seams ---- */

/* (u,v) are floats: differences carry the rounding of their magnitude. */
static bool differ(const WrTriangleCorner *const a[2], const WrTriangleCorner *const b[2])
{
    double whole[2][2];
    for (int end = 0; end < 2; end++) {
        const double x[2][2] = { { (double)a[end]->u, (double)b[end]->u },
                                 { (double)a[end]->v, (double)b[end]->v } };
        for (int k = 0; k < 2; k++) {
            const double d = x[k][0] - x[k][1];
            whole[end][k] = rint(d);
            if (fabs(d - whole[end][k]) > 1e-5 + 0x1p-21 * fmax(fabs(x[k][0]), fabs(x[k][1])))
                return true;
        }
    }
    return whole[0][0] != whole[1][0] || whole[0][1] != whole[1][1];
}

/* True if masks leave no relief along a half-edge of its face. */
static bool is_bare(const WrTriangles *mesh, int32_t half)
{
    WrReliefTap taps[WR_RELIEF_TAPS];
    if (!mesh->weights) return false;
    for (int i = 0; i <= 4; i++) {
        double w[3] = { 0 };
        w[half % 3] = 1 - i / 4.0, w[(half + 1) % 3] = i / 4.0;
        if (wr_relief_taps(mesh, half / 3, w[1], w[2], taps) > 0) return false;
    }
    return true;
}

/* Marks the seams: first[e] is 1 + the first half-edge of edge e, negative for a seam. */
static int32_t mark_seams(const WrTriangles *mesh, const WrMeshEdges *edges, int32_t *first,
                          int32_t *run)
{
    int32_t count = 0;
    for (int32_t h = 0; h < 3 * mesh->triangle_count; h++) {
        int32_t *one = &first[edges->edge[h]];
        if (*one == 0) *one = h + 1;
        if (*one < 0 || *one == h + 1) continue;
        const WrTriangleCorner *own[2], *other[2];
        int end[2], back[2];
        ends_of(mesh, edges, h, end);
        ends_of(mesh, edges, *one - 1, back);
        for (int k = 0; k < 2; k++) {
            own[k] = wr_triangle_corner(mesh, h / 3, end[k]);
            other[k] = wr_triangle_corner(mesh, (*one - 1) / 3, back[k]);
        }
        if (!differ(own, other) || is_bare(mesh, h) || is_bare(mesh, *one - 1)) continue;
        *one = -*one;
        count++;
        const int32_t *c = mesh->triangles[h / 3].corner;
        join(run, edges->place[c[end[0]]], edges->place[c[end[1]]]);
    }
    return count;
}

static double edge_length(const WrTriangles *mesh, int32_t half, WrVec3 *mid)
{
    const WrVec3 a = v3_load(wr_triangle_corner(mesh, half / 3, half % 3)->p);
    const WrVec3 b = v3_load(wr_triangle_corner(mesh, half / 3, (half + 1) % 3)->p);
    *mid = v3_scale(v3_add(a, b), 0.5);
    return v3_len(v3_sub(a, b));
}

/* The longest runs, by the point that stands for each; of equal ones the first. Returns their number. */
static int longest_runs(const double *length, int32_t places, WrTextureSeams *out,
                        int32_t root[WR_TEXTURE_SEAMS])
{
    int count = 0;
    for (int32_t i = 0; i < places; i++) {
        if (!(length[i] > 0)) continue;
        out->runs++;
        int k = count;
        for (; k > 0 && length[i] > length[root[k - 1]]; k--)
            if (k < WR_TEXTURE_SEAMS) root[k] = root[k - 1];
        if (k < WR_TEXTURE_SEAMS) root[k] = i;
        if (count < WR_TEXTURE_SEAMS) count++;
    }
    for (int k = 0; k < count; k++) out->run[k].length = length[root[k]];
    return count;
}

/* The run of a seam's half-edge among those listed, or -1. */
static int listed(const WrTriangles *mesh, const WrMeshEdges *edges, int32_t half, int32_t *run,
                  const int32_t *root, int count)
{
    const int32_t own = root_of(run, edges->place[mesh->triangles[half / 3].corner[half % 3]]);
    for (int k = 0; k < count; k++)
        if (root[k] == own) return k;
    return -1;
}

static void find_runs(const WrTriangles *mesh, const WrMeshEdges *edges, const int32_t *first,
                      int32_t *run, double *length, WrTextureSeams *out)
{
    int32_t root[WR_TEXTURE_SEAMS], edge[WR_TEXTURE_SEAMS];
    double longest[WR_TEXTURE_SEAMS] = { 0 };
    int count = 0;
    WrVec3 mid;
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t e = 0; e < edges->count; e++) {
            if (first[e] >= 0) continue;
            const int32_t half = -first[e] - 1;
            const int k = listed(mesh, edges, half, run, root, count);
            const double l = edge_length(mesh, half, &mid);
            if (pass == 0)
                length[root_of(run, edges->place[mesh->triangles[half / 3].corner[half % 3]])] += l;
            if (k >= 0 && l > longest[k]) longest[k] = l, out->run[k].at = mid, edge[k] = e;
        }
        if (pass == 0) count = longest_runs(length, edges->places, out, root);
    }
    for (int32_t h = 0; h < 3 * mesh->triangle_count; h++) {
        const WrVec3 none = { 0, 0, 0 };
        if (first[edges->edge[h]] >= 0) continue;
        const int k = listed(mesh, edges, h, run, root, count);
        if (k >= 0 && edge[k] == edges->edge[h])
            out->run[k].n = v3_add(out->run[k].n, v3_unit(face_cross(mesh, h / 3), none));
    }
    for (int k = 0; k < count; k++) out->run[k].n = v3_unit(out->run[k].n, (WrVec3){ 0, 0, 1 });
    out->length = out->run[0].length;
    out->at = out->run[0].at;
}

bool wr_triangles_seams(const WrTriangles *mesh, WrTextureSeams *out, WrError *err)
{
    WrMeshEdges edges;
    *out = (WrTextureSeams){ 0 };
    if (wr_relief_is_blended(mesh)) return true;
    if (!wr_mesh_edges_find(mesh, &edges, err)) return false;
    int32_t *first = wr_try_alloc((size_t)edges.count, sizeof *first, "a mesh's seams", err);
    int32_t *run = first ? new_sets(edges.places, err) : NULL;
    double *length =
        run ? wr_try_alloc((size_t)edges.places, sizeof *length, "a mesh's seams", err) : NULL;
    if (length) {
        out->edges = mark_seams(mesh, &edges, first, run);
        if (out->edges > 0) find_runs(mesh, &edges, first, run, length, out);
    }
    wr_free(length);
    wr_free(run);
    wr_free(first);
    wr_mesh_edges_fini(&edges);
    return length != NULL;
}
