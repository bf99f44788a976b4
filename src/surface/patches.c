#include "surface/patches.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "surface/patches_internal.h"
#include "surface/surface.h"
#include "surface/triangles_internal.h"

#include <math.h>
#include <string.h>

const char *const wr_patch_tables[WR_PATCH_TABLES] = { "each", "joined", "split", "own" };

void wr_patches_free(WrPatches *patches)
{
    if (!patches) return;
    wr_free((void *)patches->patch);
    wr_free((void *)patches->of);
    wr_free(patches);
}

/* ---- one patch ---- */

static void shape_of(const float *points, WrShape *shape)
{
    wr_shape_default(WR_SURFACE_bezier, shape);
    for (int i = 0; i < 48; i++) shape->value[i] = (double)points[i];
}

static double size_of(const float *points, const int at[4], const double by[4])
{
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        double x = 0;
        for (int i = 0; i < 4; i++)
            if (by[i] != 0) x += by[i] * (double)points[3 * at[i] + k];
        sum += x * x;
    }
    return sqrt(sum);
}

/* Bounds of |Puu|, |Puv|, |Pvv|, from differences of points. */
typedef struct Bend {
    double uu, uv, vv;
} Bend;

static Bend bend_of(const float *points)
{
    static const double second[4] = { 6, -12, 6, 0 }, mixed[4] = { 9, -9, -9, 9 };
    Bend bend = { 0, 0, 0 };
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 2; i++) {
            const int along[4] = { 4 * j + i, 4 * j + i + 1, 4 * j + i + 2, 0 };
            const int across[4] = { 4 * i + j, 4 * i + j + 4, 4 * i + j + 8, 0 };
            bend.uu = fmax(bend.uu, size_of(points, along, second));
            bend.vv = fmax(bend.vv, size_of(points, across, second));
        }
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++) {
            const int at = 4 * j + i, corner[4] = { at, at + 1, at + 4, at + 5 };
            bend.uv = fmax(bend.uv, size_of(points, corner, mixed));
        }
    return bend;
}

/* ---- subdivision counts ---- */

typedef struct Build {
    const float (*points)[48];
    WrPatchEdge *edges; /* [4 count] */
    int32_t *up;        /* [2 count] u and v of each patch: union-find of those with equal counts */
    int *cuts;          /* [2 count], for the root */
    float (*place)[3];
    float (*normal)[3];
    float (*uv)[2];
    int32_t (*corner)[3];
    WrTrianglePart *parts;
    int32_t count, place_count, triangle_count;
    WrPatches *set;
    WrPatch *patch;
} Build;

static int cuts_of(const Build *b, int32_t patch, int axis)
{
    return b->cuts[wr_root_of(b->up, 2 * patch + axis)];
}

static double extent(const Build *b)
{
    double low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };
    for (int32_t i = 0; i < b->count; i++)
        for (int k = 0; k < 48; k++) {
            low[k % 3] = fmin(low[k % 3], (double)b->points[i][k]);
            high[k % 3] = fmax(high[k % 3], (double)b->points[i][k]);
        }
    return 0.5 * hypot(hypot(high[0] - low[0], high[1] - low[1]), high[2] - low[2]);
}

/* Chooses counts by |P - its triangle| <= (|Puu| du^2 + 2 |Puv| du dv + |Pvv| dv^2) / 8, half of the
 * error for each direction. */
static void ask_cuts(Build *b, double off)
{
    for (int32_t i = 0; i < 2 * b->count; i++) b->cuts[i] = 1;
    for (int32_t i = 0; i < b->count; i++) {
        const Bend bend = bend_of(b->points[i]);
        for (int axis = 0; axis < 2; axis++) {
            const double own = (axis ? bend.vv : bend.uu) + bend.uv;
            const double cuts = off > 0 ? ceil(sqrt(own / (4 * off))) : 1;
            int *at = &b->cuts[wr_root_of(b->up, 2 * i + axis)];
            const int wanted = cuts < WR_PATCH_CUTS_MAX ? (int)cuts : WR_PATCH_CUTS_MAX;
            if (wanted > *at) *at = wanted;
        }
    }
}

static void count_triangles(Build *b)
{
    b->place_count = b->triangle_count = 0;
    for (int32_t i = 0; i < b->count; i++) {
        const int32_t nu = cuts_of(b, i, 0), nv = cuts_of(b, i, 1);
        b->place_count += (nu + 1) * (nv + 1);
        b->triangle_count += 2 * nu * nv;
    }
}

static void choose_cuts(Build *b)
{
    for (int32_t i = 0; i < 2 * b->count; i++) b->up[i] = i;
    for (int32_t i = 0; i < 4 * b->count; i++) {
        const int32_t other = b->edges[i].other;
        if (other < i) continue;
        b->up[wr_root_of(b->up, 2 * (i / 4) + i % 4 / 2)] =
            wr_root_of(b->up, 2 * (other / 4) + other % 4 / 2);
    }
    double off = WR_PATCH_OFF * extent(b);
    do {
        ask_cuts(b, off);
        count_triangles(b);
        off *= 2;
    } while (b->triangle_count > WR_PATCH_TRIANGLES && off > 0 && isfinite(off));
}

/* ---- triangles ---- */

static double mix4(const double p[4], double t)
{
    const double w = 1 - t;
    return w * w * w * p[0] + 3 * w * w * t * p[1] + 3 * w * t * t * p[2] + t * t * t * p[3];
}

/* The point of step i of n on an edge, computed from the same end for both neighbours. */
static void edge_place(const Build *b, int32_t patch, int edge, int i, int n, float out[3])
{
    const WrPatchEdge *own = &b->edges[4 * patch + edge];
    const double t = own->backward ? (double)(n - i) / n : (double)i / n;
    for (int k = 0; k < 3; k++) {
        double p[4];
        for (int j = 0; j < 4; j++)
            p[j] =
                (double)
                    b->points[patch][3 * wr_patch_edge_point(edge, own->backward ? 3 - j : j) + k];
        out[k] = (float)(own->collapsed ? p[0] : mix4(p, t)) + 0.0f;
    }
}

static void put_place(Build *b, int32_t patch, const WrShape *shape, int i, int j)
{
    const int nu = cuts_of(b, patch, 0), nv = cuts_of(b, patch, 1);
    const int32_t at = b->place_count++;
    WrSurfacePoint point;
    wr_surface_at(shape, 0, (double)i / nu, (double)j / nv, &point);
    const WrVec3 p = point.p, n = point.n_unit;
    b->place[at][0] = (float)p.x + 0.0f, b->place[at][1] = (float)p.y + 0.0f;
    b->place[at][2] = (float)p.z + 0.0f;
    b->normal[at][0] = (float)n.x, b->normal[at][1] = (float)n.y, b->normal[at][2] = (float)n.z;
    b->uv[at][0] = (float)i / (float)nu, b->uv[at][1] = (float)j / (float)nv;
    /* ends of edges are the patch's corners, bit for bit, for both edges */
    if (j == 0 || j == nv) edge_place(b, patch, j == 0 ? 0 : 1, i, nu, b->place[at]);
    if (i == 0 || i == nu) edge_place(b, patch, i == 0 ? 2 : 3, j, nv, b->place[at]);
}

static void cut_patch(Build *b, int32_t patch)
{
    const int nu = cuts_of(b, patch, 0), nv = cuts_of(b, patch, 1);
    const int32_t first = b->place_count, from = b->triangle_count;
    WrShape shape;
    shape_of(b->points[patch], &shape);
    for (int j = 0; j <= nv; j++)
        for (int i = 0; i <= nu; i++) put_place(b, patch, &shape, i, j);
    for (int j = 0; j < nv; j++)
        for (int i = 0; i < nu; i++) {
            const int32_t a = first + j * (nu + 1) + i, c = a + nu + 2;
            const int32_t two[2][3] = { { a, a + 1, c }, { a, c, c - 1 } };
            memcpy(b->corner[b->triangle_count], two, sizeof two);
            b->triangle_count += 2;
        }
    b->parts[patch] =
        (WrTrianglePart){ .first = from, .count = b->triangle_count - from, .patch = patch };
    b->patch[patch].reach_u = 1.0f / (float)nu;
    b->patch[patch].reach_v = 1.0f / (float)nv;
}

static WrTriangles *cut_all(Build *b, WrError *err)
{
    const size_t places = (size_t)b->place_count, triangles = (size_t)b->triangle_count;
    const char *what = "triangles of patches";
    b->place = wr_try_alloc(places, sizeof *b->place, what, err);
    b->normal = b->place ? wr_try_alloc(places, sizeof *b->normal, what, err) : NULL;
    b->uv = b->normal ? wr_try_alloc(places, sizeof *b->uv, what, err) : NULL;
    b->corner = b->uv ? wr_try_alloc(triangles, sizeof *b->corner, what, err) : NULL;
    b->parts = b->corner ? wr_try_alloc((size_t)b->count, sizeof *b->parts, what, err) : NULL;
    if (!b->parts) return NULL;
    b->place_count = b->triangle_count = 0;
    for (int32_t i = 0; i < b->count; i++) cut_patch(b, i);
    const WrTrianglesSource source = { .points = (const float(*)[3])b->place,
                                       .normals = (const float(*)[3])b->normal,
                                       .uv = (const float(*)[2])b->uv,
                                       .corners = (const int32_t(*)[3])b->corner,
                                       .point_count = b->place_count,
                                       .triangle_count = b->triangle_count,
                                       .parts = b->parts,
                                       .part_count = b->count };
    return wr_triangles_new(&source, err);
}

/* ---- creases ---- */

static WrVec3 normal_on_edge(const float *points, int edge, double t)
{
    WrShape shape;
    WrSurfacePoint at;
    shape_of(points, &shape);
    wr_surface_at(&shape, 0, edge < 2 ? t : edge - 2, edge < 2 ? edge : t, &at);
    return at.n_unit;
}

#define CREASE 0.1      /* smallest angle of a crease, in degrees */
#define CREASE_MEANT 45 /* larger angles are always intended */

static void find_creases(Build *b, WrPatchesTold *told)
{
    for (int32_t i = 0; i < 4 * b->count; i++) {
        const WrPatchEdge *edge = &b->edges[i];
        if (edge->other < i) continue;
        double worst = 0;
        for (int k = 0; k < 5; k++) {
            const double t = 0.1 + 0.2 * k;
            const WrVec3 own = normal_on_edge(b->points[i / 4], i % 4, t);
            const WrVec3 other = normal_on_edge(b->points[edge->other / 4], edge->other % 4,
                                                edge->turned ? 1 - t : t);
            const double angle = wr_angle(own, other) * (180 / WR_PI);
            worst = fmax(worst, angle > 90 ? 180 - angle : angle);
        }
        told->creased += worst >= CREASE;
        if (worst < CREASE || worst > CREASE_MEANT || worst <= told->crease_deg) continue;
        told->crease_deg = worst;
        told->crease_of[0] = i / 4, told->crease_of[1] = edge->other / 4;
    }
}

/* ---- construction ---- */

static bool number_triangles(WrTriangles *made, WrPatches *set, WrError *err)
{
    int32_t *of = wr_try_alloc((size_t)made->triangle_count, sizeof *of, "patches", err);
    set->of = of;
    for (int32_t part = 0; part < made->part_count && of; part++) {
        const WrTrianglePart *from = &made->parts[part];
        for (int32_t i = 0; i < from->count; i++) of[from->first + i] = from->patch;
    }
    return of != NULL;
}

/* The key distinguishes shapes. */
static uint64_t key_of(const WrTriangles *made, const WrPatches *set)
{
    const WrHash start = { made->key, 1 + (uint64_t)set->table };
    return wr_hash_bytes(set->patch, (size_t)set->count * sizeof *set->patch, start).low;
}

static WrTriangles *finish(Build *b, WrError *err)
{
    WrPatches *set = b->set;
    WrTriangles *made = NULL;
    if (wr_patches_find_edges(b->points, b->count, b->edges, &set->told, err) &&
        wr_patches_lay_out(set, b->patch, b->edges, err)) {
        choose_cuts(b);
        made = cut_all(b, err);
    }
    if (!made) return NULL;
    find_creases(b, &set->told);
    made->patches = set;
    if (!number_triangles(made, set, err)) {
        b->set = NULL; /* freed with the triangles */
        wr_triangles_free(made);
        return NULL;
    }
    made->key = key_of(made, set);
    return made;
}

static WrTriangles *build(const float (*points)[48], int32_t count, WrPatchTable table,
                          WrError *err)
{
    Build b = { .points = points, .count = count };
    const size_t patches = (size_t)count;
    b.patch = wr_try_alloc(patches, sizeof *b.patch, "patches", err);
    if (!b.patch) return NULL;
    for (size_t i = 0; i < patches; i++)
        memcpy(b.patch[i].point, points[i], sizeof b.patch[i].point);
    b.set = wr_alloc(1, sizeof *b.set);
    *b.set = (WrPatches){ .patch = b.patch, .count = count, .table = table };
    b.edges = wr_alloc(4 * patches, sizeof *b.edges);
    b.up = wr_alloc(2 * patches, sizeof *b.up);
    b.cuts = wr_alloc(2 * patches, sizeof *b.cuts);
    WrTriangles *made = finish(&b, err);
    if (!made) wr_patches_free(b.set);
    wr_free(b.edges);
    wr_free(b.up);
    wr_free(b.cuts);
    wr_free(b.place);
    wr_free(b.normal);
    wr_free(b.uv);
    wr_free(b.corner);
    wr_free(b.parts);
    return made;
}

/* Orients a closed body outwards. */
static WrTriangles *face_and_build(float (*points)[48], int32_t count, WrPatchTable table,
                                   WrError *err)
{
    int32_t turned, inside;
    if (!wr_patches_face(points, count, false, &turned, err)) return NULL;
    WrTriangles *made = build((const float(*)[48])points, count, table, err);
    if (made && made->told.inside_out) {
        wr_triangles_free(made);
        if (!wr_patches_face(points, count, true, &inside, err)) return NULL;
        made = build((const float(*)[48])points, count, table, err);
        turned = count - turned;
    }
    if (made) made->patches->told.turned = turned;
    return made;
}

WrTriangles *wr_patches_new(const float (*points)[48], int32_t count, WrPatchTable table,
                            WrError *err)
{
    if (count < 1 || count > WR_PATCHES_MAX) {
        wr_fail(err, "%d patches: must be 1..%d", (int)count, WR_PATCHES_MAX);
        return NULL;
    }
    float(*own)[48] = wr_try_alloc((size_t)count, sizeof *own, "patches", err);
    if (!own) return NULL;
    memcpy(own, points, (size_t)count * sizeof *own);
    WrTriangles *made = face_and_build(own, count, table, err);
    wr_free(own);
    return made;
}

/* ---- documents ---- */

enum { HEAD = 3 }; /* WR_PATCHES_PACKED, count, table */

float *wr_patches_pack(const WrPatches *patches, size_t *count)
{
    *count = HEAD + 48 * (size_t)patches->count;
    float *block = wr_alloc(*count, sizeof *block);
    block[0] = WR_PATCHES_PACKED;
    block[1] = (float)patches->count;
    block[2] = (float)patches->table;
    for (int32_t i = 0; i < patches->count; i++)
        memcpy(block + HEAD + 48 * (size_t)i, patches->patch[i].point, 48 * sizeof *block);
    return block;
}

WrTriangles *wr_patches_unpack(const float *block, size_t count, WrError *err)
{
    const bool head = count >= HEAD && block[0] == (float)WR_PATCHES_PACKED && block[1] >= 1 &&
                      block[1] <= WR_PATCHES_MAX && block[2] >= 0 && block[2] < WR_PATCH_TABLES;
    if (!head || count < HEAD + 48 * (size_t)block[1]) {
        wr_fail(err, "the patches that are kept here make no sense");
        return NULL;
    }
    for (size_t i = 0; i < 48 * (size_t)block[1]; i++)
        if (!(fabsf(block[HEAD + i]) <= 1e30f)) {
            wr_fail(err, "the patches that are kept here are damaged");
            return NULL;
        }
    return wr_patches_new((const float(*)[48])(const void *)(block + HEAD), (int32_t)block[1],
                          (WrPatchTable)(int)block[2], err);
}
