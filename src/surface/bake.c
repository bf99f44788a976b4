#include "surface/bake.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/vec.h"
#include "surface/ray_tree.h"
#include "surface/tangent_frames.h"
#include "surface/triangles.h"
#include "surface/uv_coverage.h"

#include <math.h>
#include <string.h>

#define ROWS 4            /* of a piece */
#define POINTS 4096       /* corners of a piece */
#define MARGIN 1.02       /* of an automatic cage over the least one */
#define LEAST_COSINE 0.25 /* between the normals of a corner and of its face, for that */
#define OCCLUSION_RAYS 64
#define GOLDEN 0.38196601125010515 /* turns */
#define CURVATURE_SCALE 0.05       /* of the simple mesh's radius */

/* State of a texel: the number of its rays that hit, and COVERED, BACK. */
enum { COVERED = 1, BACK = 2, FRAMELESS = 4 };
typedef struct Texel {
    uint8_t hits, seen;
} Texel;

typedef struct Bake {
    const WrTriangles *low, *high;
    const WrBakeOptions *options;
    WrBakeReport *report;
    WrRayTree **trees; /* [tree_count] of the whole detailed mesh, or of each part */
    int tree_count;
    bool *pairs;       /* [low parts][tree_count] partners; NULL: all */
    WrTangent *frames; /* [3 low triangles]; NULL: not needed */
    WrUvCoverage cover;
    float *map;
    Texel *texels;
    int pass;
} Bake;

/* A hit of the detailed mesh, and the point of the simple one that it belongs to. */
typedef struct WrBakeHit {
    const Bake *bake;
    WrVec3 vt, vn; /* interpolated */
    double sign, height;
    WrVec3 p, n; /* of the detailed mesh: position, interpolated unit normal, */
    WrVec3 face; /* unit normal of the triangle */
    const WrTriangleCorner *corner[3];
    int32_t triangle;
    const WrRayTree *tree;
    double turn; /* 0..1, random */
} WrBakeHit;

static WrVec3 vector(const float p[3])
{
    return (WrVec3){ (double)p[0], (double)p[1], (double)p[2] };
}

static WrVec3 mixed(const double l[3], WrVec3 a, WrVec3 b, WrVec3 c)
{
    return v3_mad(v3_mad(v3_scale(a, l[0]), b, l[1]), c, l[2]);
}

/* ---- quantities ---- */

static bool take_height(const WrBakeHit *at, double out[3])
{
    out[0] = at->height;
    return true;
}

static bool take_vector(WrVec3 v, double out[3])
{
    out[0] = v.x, out[1] = v.y, out[2] = v.z;
    return true;
}

static bool take_normal(const WrBakeHit *at, double out[3])
{
    WrVec3 n;
    return wr_tangent_components(at->vt, at->vn, at->sign, at->n, &n) && take_vector(n, out);
}

static bool take_object_normal(const WrBakeHit *at, double out[3])
{
    return take_vector(at->n, out);
}

static bool take_position(const WrBakeHit *at, double out[3])
{
    const double *c = at->bake->low->centre, by = 0.5 / at->bake->low->radius;
    return take_vector((WrVec3){ 0.5 + (at->p.x - c[0]) * by, 0.5 + (at->p.y - c[1]) * by,
                                 0.5 + (at->p.z - c[2]) * by },
                       out);
}

/* Rays through equal areas of the unit disc, projected up to the hemisphere, are distributed by the cosine. They start
   off the triangle by more than the rounding of float positions, and may not go below its plane. */
static bool take_occlusion(const WrBakeHit *at, double out[3])
{
    const double lift = 1e-5 * at->bake->high->radius;
    const WrVec3 n = at->n, o = v3_mad(at->p, at->face, lift);
    const WrVec3 least = fabs(n.x) < 0.6 ? (WrVec3){ 1, 0, 0 } : (WrVec3){ 0, 1, 0 };
    const WrVec3 a = v3_unit(v3_cross(n, least), least), b = v3_cross(n, a);
    int open = 0;
    for (int k = 0; k < OCCLUSION_RAYS; k++) {
        const double rr = (k + 0.5) / OCCLUSION_RAYS, r = sqrt(rr);
        double sine, cosine;
        wr_sincos_turns(GOLDEN * k + at->turn, &sine, &cosine);
        const WrVec3 d = v3_mad(v3_mad(v3_scale(n, sqrt(1 - rr)), a, r * cosine), b, r * sine);
        open += v3_dot(d, at->face) > 0 && !wr_ray_tree_any(at->tree, o, d, INFINITY);
    }
    out[0] = (double)open / OCCLUSION_RAYS;
    return true;
}

/* The normal curvature along an edge is dn.dp / dp.dp; the mean over three edges is near the mean curvature. */
static bool take_curvature(const WrBakeHit *at, double out[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const WrTriangleCorner *a = at->corner[k], *b = at->corner[(k + 1) % 3];
        const WrVec3 dp = v3_sub(vector(b->p), vector(a->p));
        const double pp = v3_dot(dp, dp);
        if (pp > 0) sum += v3_dot(v3_sub(vector(b->n), vector(a->n)), dp) / pp / 3;
    }
    const double x = sum * CURVATURE_SCALE * at->bake->low->radius;
    out[0] = 0.5 + 0.5 * x / (1 + fabs(x));
    return true;
}

static int part_of(const WrTriangles *mesh, int32_t triangle)
{
    int low = 0, high = mesh->part_count;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (mesh->parts[middle].first <= triangle) low = middle;
        else high = middle;
    }
    return low;
}

/* Hues a golden angle apart: 1 and the two neighbouring values of a hexagon's edge. */
static bool take_part(const WrBakeHit *at, double out[3])
{
    const double turns = GOLDEN * part_of(at->bake->high, at->triangle);
    for (int k = 0; k < 3; k++) {
        const double from = 6 * fabs(turns + k / 3.0 - floor(turns + k / 3.0) - 0.5) - 1;
        out[k] = fmin(1, fmax(0, from));
    }
    return true;
}

static const float hit_colour[3] = { 0.1f, 0.5f, 0.1f }, back_colour[3] = { 0.1f, 0.1f, 0.8f },
                   miss_colour[3] = { 0.8f, 0.05f, 0.05f };

static bool take_hit(const WrBakeHit *at, double out[3])
{
    (void)at;
    for (int k = 0; k < 3; k++) out[k] = (double)hit_colour[k];
    return true;
}

WR_ROWS(wr_bakes);
const WrBakeRow wr_bakes[WR_BAKE_KINDS] = {
    [WR_ROW(WR_BAKE_HEIGHT)] = { "height", 1, false, take_height,
                                 "distance of the detailed mesh from the object's, along its "
                                 "normal: a new layer" },
    [WR_ROW(
        WR_BAKE_NORMAL)] = { "normal", 3, true, take_normal,
                             "normals in tangent frames of MikkTSpace: the object's normal map" },
    [WR_ROW(WR_BAKE_OBJECT_NORMAL)] = { "object-normal", 3, true, take_object_normal,
                                        "normals in the object's axes: its normal map" },
    [WR_ROW(WR_BAKE_POSITION)] = { "position", 3, false, take_position,
                                   "x, y, z in the object's bounding sphere as colours" },
    [WR_ROW(WR_BAKE_OCCLUSION)] = { "occlusion", 1, false, take_occlusion,
                                    "visible share of the surroundings in grey, 1: all" },
    [WR_ROW(WR_BAKE_CURVATURE)] = { "curvature", 1, false, take_curvature,
                                    "curvature in grey: bright on edges, dark in grooves, 0.5 "
                                    "where flat" },
    [WR_ROW(WR_BAKE_PARTS)] = { "parts", 3, false, take_part,
                                "a colour for each part or material of the detailed mesh" },
    [WR_ROW(
        WR_BAKE_HITS)] = { "hits", 3, false, take_hit,
                           "rays that hit: green; that miss: red; that hit only back faces: blue" },
};
WR_ROWS_END(wr_bakes, WR_BAKE_KINDS);

/* ---- one ray ---- */

/* The first front among the partners of the texel's part. *back: none, but a back was hit. */
static bool cast(const Bake *bake, int32_t triangle, WrVec3 o, WrVec3 d, double most, WrRayHit *hit,
                 const WrRayTree **tree, bool *back)
{
    const bool *pairs =
        bake->pairs ? bake->pairs + (size_t)part_of(bake->low, triangle) * (size_t)bake->tree_count
                    : NULL;
    bool met = false;
    *back = false;
    for (int i = 0; i < bake->tree_count; i++) {
        WrRayHit next;
        if (pairs && !pairs[i]) continue;
        if (!wr_ray_tree_closest(bake->trees[i], o, d, most, true, &next)) continue;
        met = true, *hit = next, *tree = bake->trees[i], most = next.t;
    }
    for (int i = 0; i < bake->tree_count && !met && !*back; i++)
        *back = (!pairs || pairs[i]) && wr_ray_tree_any(bake->trees[i], o, d, most);
    return met;
}

/* A number in 0..1 for each texel and sample (splitmix64). */
static double turn_of(uint64_t index)
{
    uint64_t z = (index + 1) * 0x9e3779b97f4a7c15ULL;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ z >> 27) * 0x94d049bb133111ebULL;
    return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

static void bake_texel(const Bake *bake, int x, int y)
{
    const size_t index = (size_t)y * (size_t)bake->cover.width + (size_t)x;
    const int32_t triangle = bake->cover.owner[index];
    const int channels = wr_bakes[bake->options->kind].channels;
    const double cage = bake->report->cage;
    Texel *texel = &bake->texels[index];
    if (triangle < 0) return;
    const int32_t *corner = bake->low->triangles[triangle].corner;
    const WrTriangleCorner *c[3];
    WrVec3 p[3];
    double l[3];
    for (int k = 0; k < 3; k++) c[k] = &bake->low->corners[corner[k]], p[k] = vector(c[k]->p);
    wr_uv_coverage_shares(&bake->cover, triangle, x, y, l);
    WrBakeHit at = { .bake = bake, .turn = turn_of(64 * index + (uint64_t)bake->pass) };
    const WrVec3 face = v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0]));
    at.vn = mixed(l, vector(c[0]->n), vector(c[1]->n), vector(c[2]->n));
    const WrVec3 n = v3_unit(at.vn, v3_unit(face, (WrVec3){ 0, 0, 1 }));
    if (bake->frames) {
        const WrTangent *frame = &bake->frames[3 * (size_t)triangle];
        at.vt = mixed(l, frame[0].t, frame[1].t, frame[2].t);
        at.sign = frame[0].sign;
    }
    const WrVec3 o = v3_mad(mixed(l, p[0], p[1], p[2]), n, cage), d = v3_neg(n);
    WrRayHit hit = { 0 };
    bool back;
    texel->seen |= COVERED;
    if (!cast(bake, triangle, o, d, 2 * cage, &hit, &at.tree, &back)) {
        texel->seen |= back ? BACK : 0;
        return;
    }
    for (int k = 0; k < 3; k++)
        at.corner[k] = c[k] = &bake->high->corners[bake->high->triangles[hit.triangle].corner[k]],
        p[k] = vector(c[k]->p);
    at.triangle = hit.triangle;
    at.height = cage - hit.t;
    at.p = mixed(hit.share, p[0], p[1], p[2]);
    at.face = v3_unit(v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0])), n);
    at.n = v3_unit(mixed(hit.share, vector(c[0]->n), vector(c[1]->n), vector(c[2]->n)), at.face);
    double value[3];
    if (!wr_bakes[bake->options->kind].take(&at, value)) {
        texel->seen |= FRAMELESS;
        return;
    }
    texel->hits++;
    for (int k = 0; k < channels; k++)
        bake->map[(size_t)channels * index + (size_t)k] += (float)value[k];
}

static void bake_piece(int index, int worker, void *ctx)
{
    const Bake *bake = ctx;
    (void)worker;
    for (int y = ROWS * index; y < bake->cover.height && y < ROWS * (index + 1); y++)
        for (int x = 0; x < bake->cover.width; x++) bake_texel(bake, x, y);
}

/* Means of the texels' samples, and the counts of the report; texels without a hit become uncovered. */
static void finish(Bake *bake)
{
    const WrBakeRow *row = &wr_bakes[bake->options->kind];
    const size_t all = (size_t)bake->cover.width * (size_t)bake->cover.height;
    const size_t channels = (size_t)row->channels;
    WrBakeReport *report = bake->report;
    report->low = INFINITY, report->high = -INFINITY;
    for (size_t i = 0; i < all; i++) {
        const Texel *texel = &bake->texels[i];
        float *value = bake->map + channels * i;
        bake->cover.owner[i] = texel->hits ? 0 : WR_UV_UNCOVERED;
        report->texels += texel->seen & COVERED;
        if (row->unit) {
            const WrVec3 n = v3_unit(vector(value), (WrVec3){ 0, 0, 1 });
            value[0] = (float)n.x, value[1] = (float)n.y, value[2] = (float)n.z;
        }
        if (texel->hits == 0 && texel->seen && bake->options->kind == WR_BAKE_HITS) {
            memcpy(value, texel->seen & BACK ? back_colour : miss_colour, sizeof hit_colour);
            bake->cover.owner[i] = 0;
        }
        if (texel->hits == 0) {
            report->missed += texel->seen & COVERED;
            report->backs += (texel->seen & BACK) != 0;
            report->frameless += (texel->seen & FRAMELESS) != 0;
            continue;
        }
        for (size_t k = 0; k < channels && !row->unit; k++) value[k] /= (float)texel->hits;
        report->low = fmin(report->low, (double)value[0]);
        report->high = fmax(report->high, (double)value[0]);
    }
}

/* ---- the cage ---- */

typedef struct Reach {
    const WrTriangles *high;
    const WrRayTree *low;
    double *most; /* [pieces] */
} Reach;

static void reach_piece(int index, int worker, void *ctx)
{
    const Reach *reach = ctx;
    const int32_t first = POINTS * index;
    double most = 0;
    (void)worker;
    for (int32_t i = first; i < reach->high->corner_count && i < first + POINTS; i++)
        most = fmax(most,
                    wr_ray_tree_distance(reach->low, vector(reach->high->corners[i].p), INFINITY));
    reach->most[index] = most;
}

/* Least cosine between the normals of a corner and of its face: rays along the former need so much longer ways. */
static double least_cosine(const WrTriangles *mesh)
{
    double least = 1;
    for (int32_t i = 0; i < mesh->triangle_count; i++) {
        const WrTriangleCorner *c[3];
        for (int k = 0; k < 3; k++) c[k] = &mesh->corners[mesh->triangles[i].corner[k]];
        const WrVec3 a = vector(c[0]->p), none = { 0, 0, 0 };
        const WrVec3 n =
            v3_unit(v3_cross(v3_sub(vector(c[1]->p), a), v3_sub(vector(c[2]->p), a)), none);
        if (v3_dot(n, n) == 0) continue;
        for (int k = 0; k < 3; k++) least = fmin(least, v3_dot(n, vector(c[k]->n)));
    }
    return fmax(least, LEAST_COSINE);
}

/* The largest distance of a corner of the detailed mesh from the simple one, over that cosine. */
static bool make_cage(Bake *bake, WrError *err)
{
    const int pieces = (int)((bake->high->corner_count + POINTS - 1) / POINTS);
    WrRayTree *tree = wr_ray_tree_new(bake->low, 0, bake->low->triangle_count, err);
    if (!tree) return false;
    Reach reach = { bake->high, tree, wr_alloc((size_t)pieces, sizeof(double)) };
    WrProgressPart part;
    const WrProgress *outer = wr_progress_enter(&part, 0, 0.1);
    const bool whole = wr_pool_run_with_progress(bake->options->pool, pieces, reach_piece, &reach);
    wr_progress_set(outer);
    double most = 0;
    for (int i = 0; i < pieces; i++) most = fmax(most, reach.most[i]);
    bake->report->cage = MARGIN * most / least_cosine(bake->low) + 1e-4 * bake->low->radius;
    wr_free(reach.most);
    wr_ray_tree_free(tree);
    return whole || wr_fail(err, "cancelled");
}

/* ---- parts ---- */

/* Length of a name without its ending _low or _high. */
static size_t stem(const char *name)
{
    const size_t length = strlen(name);
    if (length > 4 && strcmp(name + length - 4, "_low") == 0) return length - 4;
    if (length > 5 && strcmp(name + length - 5, "_high") == 0) return length - 5;
    return length;
}

static void pair_parts(Bake *bake)
{
    const size_t trees = (size_t)bake->tree_count;
    bake->pairs = wr_alloc((size_t)bake->low->part_count * trees, sizeof *bake->pairs);
    for (int i = 0; i < bake->low->part_count; i++) {
        const char *name = bake->low->parts[i].name;
        bool any = false;
        for (int k = 0; k < bake->tree_count; k++) {
            const char *other = bake->high->parts[k].name;
            const bool same = stem(name) == stem(other) && memcmp(name, other, stem(name)) == 0;
            bake->pairs[(size_t)i * trees + (size_t)k] = same;
            any = any || same;
        }
        bake->report->alone += !any;
    }
}

static bool grow_trees(Bake *bake, WrError *err)
{
    const WrTriangles *high = bake->high;
    const bool match = bake->options->match;
    bake->tree_count = match ? high->part_count : 1;
    bake->trees = wr_alloc((size_t)bake->tree_count, sizeof *bake->trees);
    for (int i = 0; i < bake->tree_count; i++) {
        const WrTrianglePart *part = &high->parts[i];
        bake->trees[i] = match ? wr_ray_tree_new(high, part->first, part->count, err)
                               : wr_ray_tree_new(high, 0, high->triangle_count, err);
        if (!bake->trees[i]) return false;
    }
    if (match) pair_parts(bake);
    return true;
}

/* ---- all ---- */

/* The parts of the work that all tiles share. */
static bool prepare(Bake *bake, WrError *err)
{
    const WrBakeOptions *options = bake->options;
    const WrTriangles *low = bake->low;
    const size_t corners = 3 * (size_t)low->triangle_count;
    if (!low->mapped)
        return wr_fail(err, "the object has no texture coordinates to bake into: unwrap it in a "
                            "modelling program and read it again");
    bake->report->cage = options->cage;
    if (options->kind == WR_BAKE_NORMAL) {
        bake->frames = wr_try_alloc(corners, sizeof *bake->frames, "the frames of a mesh", err);
        if (!bake->frames ||
            !wr_tangents_mikk(low->corners, low->triangles, low->triangle_count, bake->frames, err))
            return false;
    }
    return grow_trees(bake, err) && (options->cage > 0 || make_cage(bake, err));
}

/* One pass for each of the samples of all texels. */
static bool run(Bake *bake, WrError *err)
{
    const WrBakeOptions *options = bake->options;
    const WrBakeRow *row = &wr_bakes[options->kind];
    const int n = options->samples, pieces = (options->height + ROWS - 1) / ROWS;
    bool good = true;
    for (int i = 0; i < n * n && good; i++) {
        WrProgressPart part;
        const WrProgress *outer =
            wr_progress_enter(&part, (double)i / (n * n), (i + 1.0) / (n * n));
        bake->pass = i;
        wr_uv_coverage_fill(&bake->cover, (i % n + 0.5) / n - 0.5, (i / n + 0.5) / n - 0.5);
        good = wr_pool_run_with_progress(options->pool, pieces, bake_piece, bake);
        wr_progress_set(outer);
    }
    if (good) finish(bake);
    if (good)
        wr_uv_coverage_pad(&bake->cover, bake->map, row->channels, row->unit, options->padding,
                           options->pool);
    return (good && !wr_progress_stopped()) || wr_fail(err, "cancelled");
}

/* The map of one tile, or of all (u,v) modulo 1; the caller frees it. */
static float *bake_map(Bake *bake, int udim, WrError *err)
{
    const WrBakeOptions *options = bake->options;
    const size_t all = (size_t)options->width * (size_t)options->height;
    bake->map =
        wr_try_alloc(all, (size_t)wr_bakes[options->kind].channels * sizeof(float), "a map", err);
    bake->texels = bake->map ? wr_try_alloc(all, sizeof *bake->texels, "a map", err) : NULL;
    bool good = bake->texels &&
                wr_uv_coverage_init(&bake->cover, bake->low, options->width, options->height, err);
    bake->cover.udim = udim;
    good = good && run(bake, err);
    wr_free(bake->texels);
    wr_uv_coverage_fini(&bake->cover);
    if (good) return bake->map;
    wr_free(bake->map);
    return NULL;
}

static void bake_fini(Bake *bake)
{
    for (int i = 0; i < bake->tree_count; i++) wr_ray_tree_free(bake->trees[i]);
    wr_free(bake->trees);
    wr_free(bake->pairs);
    wr_free(bake->frames);
}

bool wr_bake_tiles(const WrTriangles *simple, const WrTriangles *detailed,
                   const WrBakeOptions *options, const int *udims, int count, WrBakeTake *take,
                   void *ctx, WrError *err)
{
    WrBakeReport common = { 0 };
    Bake bake = { .low = simple, .high = detailed, .options = options, .report = &common };
    bool good = prepare(&bake, err);
    for (int i = 0; i < count && good; i++) {
        WrBakeReport report = { .cage = common.cage, .alone = common.alone };
        WrProgressPart part;
        const WrProgress *outer =
            wr_progress_enter(&part, 0.1 + 0.9 * i / count, 0.1 + 0.9 * (i + 1) / count);
        bake.report = &report;
        float *map = bake_map(&bake, udims[i], err);
        wr_progress_set(outer);
        good = map && take(ctx, udims[i], map, &report, err);
    }
    bake_fini(&bake);
    return good;
}

typedef struct Single {
    float *map;
    WrBakeReport *report;
} Single;

static bool take_single(void *ctx, int udim, float *map, const WrBakeReport *report, WrError *err)
{
    Single *single = ctx;
    (void)udim, (void)err;
    single->map = map;
    *single->report = *report;
    return true;
}

float *wr_bake(const WrTriangles *simple, const WrTriangles *detailed, const WrBakeOptions *options,
               WrBakeReport *report, WrError *err)
{
    Single single = { NULL, report };
    wr_bake_tiles(simple, detailed, options, &options->udim, 1, take_single, &single, err);
    return single.map;
}
