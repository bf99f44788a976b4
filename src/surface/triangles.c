#include "surface/triangles.h"

#include "surface/triangles_internal.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/hash.h"
#include "base/memory.h"
#include "surface/patches.h"
#include "surface/relief_weights.h"

#include <math.h>
#include <string.h>

/* ---- meshes ---- */

/* Fills in all members derived from the arrays.
   A mesh is three arrays: `corners` (position, normal, u, v; equal rows exist once), `triangles` (three corner
   indices, counter- clockwise seen from outside) and `parts` (consecutive triangles). A finished mesh is
   immutable and shared by reference; `key` is a hash of the arrays, so caches compare one number. */
static void triangles_measure(WrTriangles *made);

/* ---- Sorting of a mesh's triangles, and its final arrays ---- */

/* Spreads 21 bits to every third bit.
   Morton code: bit n of x goes to bit 3 n. Each step doubles the number of gaps; 21 bits of three axes fill 63
   of 64. */
static uint64_t spread_bits(uint64_t x)
{
    x &= 0x1fffff;
    x = (x | x << 32) & 0x1f00000000ffffULL;
    x = (x | x << 16) & 0x1f0000ff0000ffULL;
    x = (x | x << 8) & 0x100f00f00f00f00fULL;
    x = (x | x << 4) & 0x10c30c30c30c30c3ULL;
    return (x | x << 2) & 0x1249249249249249ULL;
}

/* Position of a face's centre on the space-filling curve.
   Faces near each other in space become near in memory: blocks of consecutive triangles then have tight
   bounding spheres and narrow normal cones. The mean of corners is inside the bounding sphere, so t is 0 ..
   2^21; only order depends on it. */
static uint64_t curve_place(const WrTrianglesBuild *b, int32_t i)
{
    const WrTriangleCorner *c = b->corner + 3 * (size_t)i;
    uint64_t key = 0;
    for (int k = 0; k < 3; k++) {
        const double mid =
            ((double)c[0].p[k] + (double)c[1].p[k] + (double)c[2].p[k]) / 3 - b->centre[k];
        const double t = (mid / b->radius + 1) * 0x1p20;
        key |= spread_bits((uint64_t)(t > 0 ? t : 0)) << k;
    }
    return key;
}

typedef struct Item {
    uint64_t key;
    int32_t face;
} Item;

/* Stable radix sort by key: eight passes of a byte each.
   Stable, so that faces with equal keys keep the file's order and the result does not depend on the library's
   qsort. The number of passes is even: the result ends in `items`. */
static void sort_items(Item *items, Item *spare, int32_t count)
{
    for (int shift = 0; shift < 64; shift += 8) {
        size_t start[257] = { 0 };
        for (int32_t i = 0; i < count; i++) start[(items[i].key >> shift & 255) + 1]++;
        for (int k = 0; k < 256; k++) start[k + 1] += start[k];
        for (int32_t i = 0; i < count; i++) spare[start[items[i].key >> shift & 255]++] = items[i];
        Item *old = items;
        items = spare, spare = old;
    }
}

/* Sorts faces by parts and the curve.
   Each part is sorted on its own and stays one range. b->of[k] is the source triangle of kept face k,
   increasing. */
static bool sort_faces(const WrTrianglesBuild *b, Item *items, WrError *err)
{
    const WrTrianglesSource *source = b->source;
    Item *spare = wr_try_alloc((size_t)b->count, sizeof *spare, "a mesh's order", err);
    if (!spare) return false;
    for (int32_t i = 0; i < b->count; i++) items[i] = (Item){ curve_place(b, i), i };
    int32_t from = 0;
    for (int part = 0; part < (source->parts ? source->part_count : 1); part++) {
        const int32_t end = source->parts ? source->parts[part].first + source->parts[part].count
                                          : source->triangle_count;
        int32_t to = from;
        while (to < b->count && b->of[to] < end) to++;
        sort_items(items + from, spare, to - from);
        from = to;
    }
    wr_free(spare);
    return true;
}

static WrTrianglePart *make_parts(const WrTrianglesBuild *b, int *count)
{
    const WrTrianglesSource *source = b->source;
    const int most = source->parts ? source->part_count : 1;
    WrTrianglePart *parts = wr_alloc((size_t)most, sizeof *parts);
    int32_t at = 0;
    *count = 0;
    for (int i = 0; i < most; i++) {
        WrTrianglePart part = { .first = at };
        if (source->parts) {
            memcpy(part.name, source->parts[i].name, sizeof part.name - 1);
            part.patch = source->parts[i].patch;
            part.number = source->parts[i].number;
        }
        const int32_t end = source->parts ? source->parts[i].first + source->parts[i].count
                                          : source->triangle_count;
        for (; at < b->count && b->of[at] < end; at++) part.mapped |= b->mapped[at];
        part.count = at - part.first;
        if (part.count > 0) parts[(*count)++] = part;
    }
    return parts;
}

/* Numbers corners in the order of their first use.
   Each corner of a face comes as a row of its own; wr_weld merges rows with equal bits. Rows were cleared of
   -0, which compares equal to 0 but has other bits. At most 2^24 corners: documents store indices as floats,
   exact up to there. */
static bool number_corners(WrTriangles *made, WrTriangleCorner *rows, WrError *err)
{
    const int32_t count = 3 * made->triangle_count;
    WrTriangle *triangles =
        wr_try_alloc((size_t)made->triangle_count, sizeof *triangles, "a mesh", err);
    made->triangles = triangles;
    if (!triangles ||
        !wr_weld(rows, sizeof *rows, count, &triangles[0].corner[0], &made->corner_count, err))
        return false;
    if (made->corner_count > 1 << 24)
        return wr_fail(err, "%d different corners: at most %d", (int)made->corner_count, 1 << 24);
    WrTriangleCorner *corners =
        wr_try_alloc((size_t)made->corner_count, sizeof *corners, "a mesh", err);
    made->corners = corners;
    if (!corners) return false;
    for (int32_t i = 0; i < count; i++) corners[triangles[i / 3].corner[i % 3]] = rows[i];
    return true;
}

/* ---- nearly equal corners ---- */

/* True within four units of the last place of the larger. */
static bool all_but(float a, float b)
{
    return fabsf(a - b) <= 0x1p-21f * fmaxf(fabsf(a), fabsf(b));
}

static bool all_but_one(const WrTriangleCorner *a, const WrTriangleCorner *b)
{
    return memcmp(a->n, b->n, sizeof a->n) == 0 && all_but(a->u, b->u) && all_but(a->v, b->v);
}

/* Counts corners whose position and normal equal another's, and nearly its (u,v): seams by rounding,
 * which split tangent frames (HC129).
 * A list for each position: last[place] is its latest corner, before[corner] the one before, both plus 1. At
 * most 16 are compared, so that a fan with thousands of corners at its hub stays linear. Out of memory reports
 * 0: it is only a statistic. */
static int32_t count_near(const WrTriangles *made)
{
    const int32_t count = made->corner_count;
    int32_t places = 0, near = 0;
    float(*p)[3] = wr_try_alloc((size_t)count, sizeof *p, "a mesh's seams", NULL);
    int32_t *at = wr_try_alloc((size_t)count, sizeof *at, "a mesh's seams", NULL);
    int32_t *last = wr_try_alloc((size_t)count, sizeof *last, "a mesh's seams", NULL);
    int32_t *before = wr_try_alloc((size_t)count, sizeof *before, "a mesh's seams", NULL);
    bool good = p && at && last && before;
    for (int32_t i = 0; i < count && good; i++) memcpy(p[i], made->corners[i].p, sizeof p[i]);
    good = good && wr_weld(p, sizeof *p, count, at, &places, NULL);
    for (int32_t i = 0; i < count && good && places < count; i++) {
        int32_t other = last[at[i]] - 1; /* an earlier one of the same position */
        before[i] = last[at[i]];
        last[at[i]] = i + 1;
        for (int looks = 0; other >= 0 && looks < 16; looks++, other = before[other] - 1)
            if (all_but_one(&made->corners[i], &made->corners[other])) {
                near++;
                break;
            }
    }
    wr_free(p);
    wr_free(at);
    wr_free(last);
    wr_free(before);
    return near;
}

static bool carry_mask_uv(const WrTrianglesBuild *b, const Item *items, WrTriangles *made,
                          WrError *err)
{
    const int32_t count = 3 * b->count;
    if (!b->source->mask_uv) return true;
    float(*uv)[2] = wr_try_alloc((size_t)count, sizeof *uv, "a mesh's mask", err);
    made->mask_uv = (const float(*)[2])uv;
    for (int32_t i = 0; i < count && uv; i++)
        memcpy(uv[i], b->source->mask_uv[b->face[items[i / 3].face].corner[i % 3]], sizeof *uv);
    return uv != NULL;
}

/* Sorts, numbers the corners in that order, and packs the mesh. NULL: out of memory. */
static WrTriangles *triangles_finish(WrTrianglesBuild *b, WrError *err)
{
    WrTriangles *made = wr_alloc(1, sizeof *made);
    const size_t count = (size_t)b->count;
    made->refs = 1;
    made->triangle_count = b->count;
    made->closed = b->closed;
    made->report = b->report;
    Item *items = wr_try_alloc(count, sizeof *items, "a mesh's order", err);
    WrTriangleCorner *rows = items ? wr_try_alloc(count, 3 * sizeof *rows, "a mesh", err) : NULL;
    bool good = rows && sort_faces(b, items, err);
    for (size_t i = 0; i < count && good; i++)
        memcpy(rows + 3 * i, b->corner + 3 * (size_t)items[i].face, 3 * sizeof *rows);
    good = good && number_corners(made, rows, err) && carry_mask_uv(b, items, made, err);
    wr_free(rows);
    wr_free(items);
    if (!good) {
        wr_triangles_free(made);
        return NULL;
    }
    made->parts = make_parts(b, &made->part_count);
    memcpy(made->centre, b->centre, sizeof made->centre);
    made->radius = b->radius;
    triangles_measure(made);
    return made;
}

static bool same_normals(const WrTriangles *made, int32_t i)
{
    const int32_t *c = made->triangles[i].corner;
    const float *a = made->corners[c[0]].n;
    return memcmp(a, made->corners[c[1]].n, sizeof made->corners[0].n) == 0 &&
           memcmp(a, made->corners[c[2]].n, sizeof made->corners[0].n) == 0;
}

static void triangles_measure(WrTriangles *made)
{
    const WrHash none = { 0, 0 };
    WrHash hash =
        wr_hash_bytes(made->corners, (size_t)made->corner_count * sizeof *made->corners, none);
    hash = wr_hash_bytes(made->triangles, (size_t)made->triangle_count * sizeof *made->triangles,
                         hash);
    made->key = hash.low;
    made->faceted = true;
    for (int32_t i = 0; i < made->triangle_count && made->faceted; i++)
        made->faceted = same_normals(made, i);
    made->mapped = false;
    for (int i = 0; i < made->part_count; i++) made->mapped |= made->parts[i].mapped;
    made->report.near_uv = made->mapped ? count_near(made) : 0;
}

/* ---- Serialisation of a mesh as numbers, for documents ---- */

/* Layout, all as floats: HEAD, REPORT_COUNT statistics, BALL (centre and radius as sums of three floats), PART
   numbers for each part, 8 for each corner in the order of WrTriangleCorner, 3 indices for each triangle. */
#define PACK_VERSION 1

/* version, corners, triangles, parts, closed, then the statistics; the bounding sphere as twice three
 * floats and so on */
enum { HEAD = 5, REPORT_COUNT = 9, BALL = 12, PART = 3 + WR_TRIANGLE_NAME };

static void report_to_floats(const WrTrianglesReport *report, float *out)
{
    const int32_t numbers[REPORT_COUNT] = {
        report->no_area, report->no_normal, report->bad_normal, report->face_normal, report->bad_uv,
        report->no_map,  report->collinear, report->mirrored,   report->inside_out
    };
    for (int i = 0; i < REPORT_COUNT; i++) out[i] = (float)numbers[i];
}

static void report_from_floats(const float *in, WrTrianglesReport *report)
{
    int32_t n[REPORT_COUNT];
    for (int i = 0; i < REPORT_COUNT; i++) n[i] = (int32_t)in[i];
    *report = (WrTrianglesReport){ .no_area = n[0],
                                   .no_normal = n[1],
                                   .bad_normal = n[2],
                                   .face_normal = n[3],
                                   .bad_uv = n[4],
                                   .no_map = n[5],
                                   .collinear = n[6],
                                   .mirrored = n[7],
                                   .inside_out = n[8] != 0 };
}

/* A double as three floats whose sum it is.
   3 * 24 bits hold the 53 of a double. join adds the small ones first; all sums are exact. */
static void split(double x, float out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = (float)x;
        x -= (double)out[i];
    }
}

static double join(const float in[3])
{
    return ((double)in[2] + (double)in[1]) + (double)in[0];
}

static size_t packed(int32_t corners, int32_t triangles, int32_t parts)
{
    return HEAD + REPORT_COUNT + BALL + (size_t)parts * PART + (size_t)corners * 8 +
           (size_t)triangles * 3;
}

float *wr_triangles_serialize(const WrTriangles *t, size_t *count)
{
    if (t->patches) return wr_patches_serialize(t->patches, count);
    *count = packed(t->corner_count, t->triangle_count, t->part_count);
    float *block = wr_alloc(*count, sizeof *block), *at = block;
    const float head[HEAD] = { PACK_VERSION, (float)t->corner_count, (float)t->triangle_count,
                               (float)t->part_count, t->closed };
    memcpy(at, head, sizeof head), at += HEAD;
    report_to_floats(&t->report, at), at += REPORT_COUNT;
    for (int k = 0; k < 3; k++) split(t->centre[k], at + 3 * k);
    split(t->radius, at + 9), at += BALL;
    for (int i = 0; i < t->part_count; i++, at += PART) {
        const WrTrianglePart *part = &t->parts[i];
        at[0] = (float)part->first, at[1] = (float)part->count, at[2] = part->mapped;
        for (int k = 0; k < WR_TRIANGLE_NAME; k++) at[3 + k] = (float)(unsigned char)part->name[k];
    }
    memcpy(at, t->corners, (size_t)t->corner_count * sizeof *t->corners);
    at += 8 * (size_t)t->corner_count;
    for (size_t i = 0; i < 3 * (size_t)t->triangle_count; i++)
        at[i] = (float)t->triangles[i / 3].corner[i % 3];
    return block;
}

/* True for an integer of low .. high. */
static bool whole(float x, double low, double high)
{
    return (double)x >= low && (double)x <= high && (double)x == floor((double)x);
}

/* Values come from a file: each is checked to be a whole number in its range before the cast, because a cast
   of a float out of range is undefined. `packed` cannot overflow for counts within these limits. */
static bool check_head(const float *block, size_t count)
{
    return count >= HEAD + REPORT_COUNT + BALL && whole(block[0], PACK_VERSION, PACK_VERSION) &&
           whole(block[1], 3, 1 << 24) && whole(block[2], 1, WR_TRIANGLES_MAX) &&
           whole(block[3], 1, WR_TRIANGLE_PARTS_MAX) && whole(block[4], 0, 1) &&
           count >= packed((int32_t)block[1], (int32_t)block[2], (int32_t)block[3]);
}

static bool check_numbers(const WrTriangles *t, const float *report)
{
    for (int i = 0; i < REPORT_COUNT; i++)
        if (!whole(report[i], 0, 0x1p30)) return false;
    for (int32_t i = 0; i < t->corner_count; i++) {
        const WrTriangleCorner *c = &t->corners[i];
        for (int k = 0; k < 3; k++)
            if (!(fabsf(c->p[k]) <= 1e30f) || !(fabsf(c->n[k]) <= 1.001f)) return false;
        if (!(fabsf(c->u) <= 1e6f) || !(fabsf(c->v) <= 1e6f)) return false;
    }
    return t->radius > 0 && t->radius <= 1e31 && fabs(t->centre[0]) <= 1e30 &&
           fabs(t->centre[1]) <= 1e30 && fabs(t->centre[2]) <= 1e30;
}

static bool take_parts(const float *at, int count, int32_t triangles, WrTrianglePart *parts)
{
    int32_t sum = 0;
    for (int i = 0; i < count; i++, at += PART) {
        if (!whole(at[0], sum, sum) || !whole(at[1], 1, triangles - sum) || !whole(at[2], 0, 1))
            return false;
        parts[i] = (WrTrianglePart){ .first = sum, .count = (int32_t)at[1], .mapped = at[2] != 0 };
        for (int k = 0; k + 1 < WR_TRIANGLE_NAME; k++) {
            if (!whole(at[3 + k], 0, 255)) return false;
            parts[i].name[k] = (char)(unsigned char)at[3 + k];
        }
        sum += parts[i].count;
    }
    return sum == triangles;
}

static bool take_triangles(const float *at, int32_t corners, int32_t count, WrTriangle *out)
{
    for (size_t i = 0; i < 3 * (size_t)count; i++) {
        if (!whole(at[i], 0, corners - 1)) return false;
        out[i / 3].corner[i % 3] = (int32_t)at[i];
    }
    return true;
}

WrTriangles *wr_triangles_deserialize(const float *block, size_t count, WrError *err)
{
    if (count > 0 && block[0] == (float)WR_PATCHES_PACKED)
        return wr_patches_deserialize(block, count, err);
    if (!check_head(block, count)) {
        wr_fail(err, "the stored mesh is inconsistent");
        return NULL;
    }
    WrTriangles *t = wr_alloc(1, sizeof *t);
    t->refs = 1;
    t->corner_count = (int32_t)block[1];
    t->triangle_count = (int32_t)block[2];
    t->part_count = (int32_t)block[3];
    t->closed = block[4] != 0;
    WrTriangleCorner *corners =
        wr_try_alloc((size_t)t->corner_count, sizeof *corners, "a mesh", err);
    WrTriangle *triangles =
        corners ? wr_try_alloc((size_t)t->triangle_count, sizeof *triangles, "a mesh", err) : NULL;
    WrTrianglePart *parts = wr_alloc((size_t)t->part_count, sizeof *parts);
    t->corners = corners, t->triangles = triangles, t->parts = parts;
    if (triangles) {
        const float *at = block + HEAD + REPORT_COUNT;
        for (int k = 0; k < 3; k++) t->centre[k] = join(at + 3 * k);
        t->radius = join(at + 9), at += BALL;
        const float *rows = at + (size_t)t->part_count * PART;
        memcpy(corners, rows, (size_t)t->corner_count * sizeof *corners);
        if (check_numbers(t, block + HEAD) &&
            take_parts(at, t->part_count, t->triangle_count, parts) &&
            take_triangles(rows + 8 * (size_t)t->corner_count, t->corner_count, t->triangle_count,
                           triangles)) {
            report_from_floats(block + HEAD, &t->report);
            triangles_measure(t);
            return t;
        }
        wr_fail(err, "the stored mesh is damaged");
    }
    wr_triangles_free(t);
    return NULL;
}

/* ---- Areas of a mesh with overlapping texture coordinates ---- */

/* The (u,v) plane is divided in cells x cells squares of the unit table; a cell is covered if its centre is
   inside a triangle, modulo 1. The share of cells covered more than once is the overlap. */

/* Coverage count of cell centres: 0, 1, 2 for more. */
typedef struct Count {
    unsigned char *cell;
    int cells;
} Count;

typedef struct Flat {
    double u[3], v[3]; /* in cells */
} Flat;

/* Twice the signed area of the point and the edge opposite corner k. */
static double side(const Flat *t, int k, double x, double y)
{
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    return (t->u[b] - t->u[a]) * (y - t->v[a]) - (t->v[b] - t->v[a]) * (x - t->u[a]);
}

/* True if the edge includes the points on it; its reverse does not (fill rule). */
static bool owns(const Flat *t, int k)
{
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    const double du = t->u[b] - t->u[a], dv = t->v[b] - t->v[a];
    return dv < 0 || (dv == 0 && du < 0);
}

/* sign: 1 for a counter-clockwise triangle. A centre exactly on an edge belongs to one of the two triangles
   that share it, so that a seamless atlas counts no cell twice. */
static bool holds(const Flat *t, double sign, double x, double y)
{
    for (int k = 0; k < 3; k++) {
        const double e = sign * side(t, k, x, y);
        if (e < 0 || (e == 0 && owns(t, k) != (sign > 0))) return false;
    }
    return true;
}

static void cover(const Count *count, const Flat *t)
{
    const double area = side(t, 0, t->u[0], t->v[0]);
    if (area == 0) return;
    const double sign = area > 0 ? 1 : -1;
    /* A triangle over very many repeats covers everything it can within the first ones. */
    const int most = 4 * count->cells;
    const double x0 = floor(fmin(fmin(t->u[0], t->u[1]), t->u[2]) - 0.5);
    const double y0 = floor(fmin(fmin(t->v[0], t->v[1]), t->v[2]) - 0.5);
    const double x1 = fmin(ceil(fmax(fmax(t->u[0], t->u[1]), t->u[2])), x0 + most);
    const double y1 = fmin(ceil(fmax(fmax(t->v[0], t->v[1]), t->v[2])), y0 + most);
    for (double y = y0; y <= y1; y++)
        for (double x = x0; x <= x1; x++) {
            if (!holds(t, sign, x + 0.5, y + 0.5)) continue;
            const double n = count->cells;
            const int i = (int)(x - n * floor(x / n)), j = (int)(y - n * floor(y / n));
            unsigned char *cell = &count->cell[(size_t)j * (size_t)count->cells + (size_t)i];
            *cell = (unsigned char)(*cell < 2 ? *cell + 1 : 2);
        }
}

WrUvOverlap wr_triangles_overlap(const WrTriangles *triangles, int cells)
{
    WrUvOverlap overlap = { 0 };
    const size_t total = (size_t)cells * (size_t)cells;
    Count count = { wr_alloc(total, 1), cells };
    for (int32_t i = 0; i < triangles->triangle_count; i++) {
        Flat t;
        bool out = false;
        for (int k = 0; k < 3; k++) {
            const WrTriangleCorner *c = &triangles->corners[triangles->triangles[i].corner[k]];
            t.u[k] = (double)c->u * cells, t.v[k] = (double)c->v * cells;
            out |= c->u < 0 || c->u > 1 || c->v < 0 || c->v > 1;
        }
        overlap.outside += out;
        cover(&count, &t);
    }
    size_t once = 0, often = 0;
    for (size_t i = 0; i < total; i++) {
        once += count.cell[i] > 0;
        if (count.cell[i] < 2 || often++ > 0) continue;
        overlap.at[0] = ((double)(i % (size_t)cells) + 0.5) / cells;
        overlap.at[1] = ((double)(i / (size_t)cells) + 0.5) / cells;
    }
    wr_free(count.cell);
    overlap.share = once > 0 ? (double)often / (double)once : 0;
    return overlap;
}

/* ---- merging of equal positions ---- */

/* All keys are multiples of 4 bytes. The multiply-and-xor of each word makes equal low bits of floats (many
   zeros in the mantissa) spread over the table. */
static uint32_t mix(const void *key, size_t size)
{
    const unsigned char *from = key;
    uint32_t h = 0x9e3779b9U;
    for (size_t i = 0; i < size; i += 4) {
        uint32_t word;
        memcpy(&word, from + i, 4);
        h = wr_mix32(h ^ word) + 0x9e3779b9U;
    }
    return h;
}

/* Hash table with linear probing, at most half full. to[i] is a number in the order of first appearance,
   independent of the hash; the result is the same on every machine. */
bool wr_weld(const void *rows, size_t size, int32_t count, int32_t *to, int32_t *kinds,
             WrError *err)
{
    size_t room = 16;
    while (room < 2 * (size_t)count) room *= 2;
    int32_t *table = wr_try_alloc(room, sizeof *table, "a mesh's places", err); /* 1 + the first */
    if (!table) return false;
    const char *bytes = rows;
    int32_t found = 0;
    for (int32_t i = 0; i < count; i++) {
        const char *row = bytes + (size_t)i * size;
        size_t at = mix(row, size) & (room - 1);
        while (table[at] && memcmp(bytes + (size_t)(table[at] - 1) * size, row, size) != 0)
            at = (at + 1) & (room - 1);
        if (!table[at]) {
            table[at] = i + 1;
            to[i] = found++;
        } else {
            to[i] = to[table[at] - 1];
        }
    }
    wr_free(table);
    *kinds = found;
    return true;
}

/* ---- faces ---- */

static WrVec3 place(const WrTrianglesBuild *b, int32_t point)
{
    const float *p = b->points[point];
    return (WrVec3){ (double)p[0], (double)p[1], (double)p[2] };
}

/* The cross product of the triangle's two shortest edges, oriented by the winding; *from: the corner
   between them.
   All three corners yield the same cross product in exact arithmetic; the two shortest edges subtract the
   closest coordinates, so a needle triangle of 1 : 1e7 keeps its normal's digits (HC133). */
static WrVec3 face_of(const WrVec3 p[3], int *from)
{
    double side[3]; /* of the edge opposite corner i, relative to the longest */
    for (int i = 0; i < 3; i++) side[i] = v3_len(v3_sub(p[(i + 2) % 3], p[(i + 1) % 3]));
    int longest = 0;
    for (int i = 1; i < 3; i++)
        if (side[i] > side[longest]) longest = i;
    *from = longest;
    return v3_cross(v3_sub(p[(longest + 1) % 3], p[longest]),
                    v3_sub(p[(longest + 2) % 3], p[longest]));
}

static bool usable(WrVec3 n)
{
    const double l = v3_len(n);
    return l > 0 && isfinite(l);
}

static void note_no_area(WrTrianglesBuild *b, const int32_t c[3])
{
    for (int k = 0; k < 3; k++)
        b->report.no_area_at[k] =
            b->points[c[0]][k] / 3 + b->points[c[1]][k] / 3 + b->points[c[2]][k] / 3;
    b->report.no_area_known = true;
}

/* Keeps the triangles with an area, each from the corner between its two shortest edges; computes their
 * normals.
 * Two faces of a mesh may have no area although their corners differ (collinear), or have corners of equal
 * position; both count as no_area (HC29). */
static void keep_faces(WrTrianglesBuild *b)
{
    const WrVec3 none = { 0, 0, 0 };
    int32_t kept = 0;
    for (int32_t i = 0; i < b->source->triangle_count; i++) {
        const int32_t *c = b->source->corners[i];
        const WrVec3 p[3] = { place(b, c[0]), place(b, c[1]), place(b, c[2]) };
        int from;
        const WrVec3 n = face_of(p, &from);
        if (b->at[c[0]] == b->at[c[1]] || b->at[c[1]] == b->at[c[2]] ||
            b->at[c[2]] == b->at[c[0]] || !usable(n)) {
            if (b->report.no_area++ == 0) note_no_area(b, c);
            continue;
        }
        for (int k = 0; k < 3; k++) b->face[kept].corner[k] = c[(from + k) % 3];
        b->normal[kept] = v3_unit(n, none);
        b->of[kept++] = i;
    }
    b->count = kept;
}

/* ---- closed bodies ---- */

/* For each position, the other ends of its outgoing (or incoming) directed edges.
   Compressed lists: place[first[p] .. first[p + 1]) are the other ends at position p. Pass 0 counts into
   first[p + 2], the sums become starts, pass 1 fills and moves first[p + 1] from the start to the end of its
   list. */
typedef struct Ends {
    int32_t *first; /* [places + 1] into place */
    int32_t *place; /* [3 count] */
} Ends;

static bool find_ends(const WrTrianglesBuild *b, bool leaving, Ends *out)
{
    const size_t edges = 3 * (size_t)b->count;
    int32_t *at = wr_try_alloc((size_t)b->places + 2, sizeof *at, "a mesh's edges", NULL);
    out->first = at;
    out->place = at ? wr_try_alloc(edges, sizeof *out->place, "a mesh's edges", NULL) : NULL;
    if (!out->place) return false;
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < edges; i++) {
            const int32_t *c = b->face[i / 3].corner;
            const int32_t from = b->at[c[i % 3]], to = b->at[c[(i + 1) % 3]];
            const int32_t own = leaving ? from : to;
            if (pass == 0) at[own + 2]++;
            else out->place[at[own + 1]++] = leaving ? to : from;
        }
        for (int32_t i = 0; i < b->places && pass == 0; i++) at[i + 2] += at[i + 1];
    }
    return true;
}

static void free_ends(Ends *ends)
{
    wr_free(ends->first);
    wr_free(ends->place);
}

static int32_t end_count(const Ends *ends, int32_t place)
{
    return ends->first[place + 1] - ends->first[place];
}

static int32_t times(const Ends *ends, int32_t place, int32_t other)
{
    int32_t found = 0;
    for (int32_t i = ends->first[place]; i < ends->first[place + 1]; i++)
        found += ends->place[i] == other;
    return found;
}

/* Multiplicity of the edge; searched at its end with fewer edges, so that the hub of a fan costs no
 * more than others. */
static int32_t how_often(const Ends *leave, const Ends *come, int32_t from, int32_t to)
{
    return end_count(leave, from) <= end_count(come, to) ? times(leave, from, to)
                                                         : times(come, to, from);
}

/* True if each directed edge exists once, and its reverse too.
   On a closed, oriented body each directed edge and its reverse exist once. Three faces at one edge, a hole or
   two neighbours of opposite winding fail. Edges are compared by position, so (u,v) seams do not open a body. */
static bool is_closed(const WrTrianglesBuild *b)
{
    Ends leave = { NULL, NULL }, come = { NULL, NULL };
    bool closed = find_ends(b, true, &leave) && find_ends(b, false, &come);
    for (int32_t i = 0; i < 3 * b->count && closed; i++) {
        const int32_t *c = b->face[i / 3].corner;
        const int32_t from = b->at[c[i % 3]], to = b->at[c[(i + 1) % 3]];
        closed = how_often(&leave, &come, from, to) == 1 && how_often(&leave, &come, to, from) == 1;
    }
    free_ends(&leave);
    free_ends(&come);
    return closed;
}

/* The bounding sphere about the box's centre; its size defines the scale in which volumes are summed. */
static void find_ball(WrTrianglesBuild *b)
{
    double low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };
    for (int32_t i = 0; i < 3 * b->count; i++) {
        const float *p = b->points[b->face[i / 3].corner[i % 3]];
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], (double)p[k]);
            high[k] = fmax(high[k], (double)p[k]);
        }
    }
    for (int k = 0; k < 3; k++) b->centre[k] = low[k] / 2 + high[k] / 2;
    const WrVec3 centre = { b->centre[0], b->centre[1], b->centre[2] };
    double most = 0;
    for (int32_t i = 0; i < 3 * b->count; i++)
        most = fmax(most, v3_len(v3_sub(place(b, b->face[i / 3].corner[i % 3]), centre)));
    b->radius = fmax(most * (1 + 1e-12), 1e-30);
}

/* Six times the volume by the divergence theorem, the sum of p0 . (p1 x p2); in units of the radius about the
   box's centre, so that neither a distant body nor a tiny one loses the sign. Only the sign is used: negative
   is inside out. */
static double volume(const WrTrianglesBuild *b)
{
    const WrVec3 centre = { b->centre[0], b->centre[1], b->centre[2] };
    const double per = 1 / b->radius;
    double sum = 0;
    for (int32_t i = 0; i < b->count; i++) {
        WrVec3 p[3];
        for (int k = 0; k < 3; k++)
            p[k] = v3_scale(v3_sub(place(b, b->face[i].corner[k]), centre), per);
        sum += v3_dot(p[0], v3_cross(p[1], p[2]));
    }
    return sum;
}

static void turn_out(WrTrianglesBuild *b)
{
    b->report.inside_out = true;
    for (int32_t i = 0; i < b->count; i++) {
        int32_t *c = b->face[i].corner;
        const int32_t last = c[2];
        c[2] = c[1], c[1] = last;
        b->normal[i] = v3_neg(b->normal[i]);
    }
}

/* ---- normals ---- */

/* The vertex normal is the sum of face normals weighted by the corner's angle: independent of how a flat
   region is cut into triangles, unlike equal or area weights. */
static double corner_angle(const WrTrianglesBuild *b, int32_t i, int k)
{
    const int32_t *c = b->face[i].corner;
    const WrVec3 p = place(b, c[k]);
    return wr_angle(v3_sub(place(b, c[(k + 1) % 3]), p), v3_sub(place(b, c[(k + 2) % 3]), p));
}

/* Copies the file's normals as unit vectors; 0 where they are unusable. */
static void take_normals(WrTrianglesBuild *b)
{
    const WrVec3 none = { 0, 0, 0 };
    for (int32_t i = 0; i < b->source->point_count; i++) {
        const float *given = b->source->normals ? b->source->normals[i] : NULL;
        const WrVec3 n =
            given ? (WrVec3){ (double)given[0], (double)given[1], (double)given[2] } : none;
        b->own[i] = usable(n) ? v3_unit(n, none) : none;
        if (!given) b->report.no_normal++;
        else if (!usable(n)) b->report.bad_normal++;
    }
}

static bool is_none(WrVec3 n)
{
    return n.x == 0 && n.y == 0 && n.z == 0;
}

/* Flips the file's normals if most of them point into the reversed body. */
static void turn_normals(WrTrianglesBuild *b)
{
    double sum = 0;
    for (int32_t i = 0; i < 3 * b->count; i++)
        sum += v3_dot(b->own[b->face[i / 3].corner[i % 3]], b->normal[i / 3]);
    for (int32_t i = 0; i < b->source->point_count && sum < 0; i++) b->own[i] = v3_neg(b->own[i]);
}

/* Computes missing normals from the faces about the position.
   Sums are by position, not by corner: both sides of a (u,v) seam get one normal, and bumps continue across
   it. Opposite faces may cancel; then make_corner falls back to the face's own normal (HC136). */
static bool fill_normals(WrTrianglesBuild *b, WrError *err)
{
    const WrVec3 none = { 0, 0, 0 };
    if (b->report.no_normal + b->report.bad_normal == 0) return true;
    WrVec3 *sum = wr_try_alloc((size_t)b->places, sizeof *sum, "a mesh's normals", err);
    if (!sum) return false;
    for (int32_t i = 0; i < b->count; i++)
        for (int k = 0; k < 3; k++) {
            WrVec3 *at = &sum[b->at[b->face[i].corner[k]]];
            *at = v3_mad(*at, b->normal[i], corner_angle(b, i, k));
        }
    for (int32_t i = 0; i < b->source->point_count; i++) {
        const WrVec3 n = sum[b->at[i]];
        if (is_none(b->own[i])) b->own[i] = v3_len(n) > 1e-9 ? v3_unit(n, none) : none;
    }
    wr_free(sum);
    return true;
}

/* ---- corners ---- */

static bool good_uv(const float *uv)
{
    return fabsf(uv[0]) <= 1e6f && fabsf(uv[1]) <= 1e6f;
}

/* Corner k of face i; returns true if it has (u,v).
   Adding 0 turns -0 into 0, because corners are merged by their bits. */
static bool make_corner(WrTrianglesBuild *b, int32_t i, int k, WrTriangleCorner *out)
{
    const int32_t point = b->face[i].corner[k];
    WrVec3 n = b->own[point];
    if (is_none(n)) {
        n = b->normal[i];
        b->report.face_normal++;
    }
    memcpy(out->p, b->points[point], sizeof out->p);
    out->n[0] = (float)n.x + 0.0f, out->n[1] = (float)n.y + 0.0f, out->n[2] = (float)n.z + 0.0f;
    out->u = out->v = 0;
    if (!b->source->uv) return false;
    const float *uv = b->source->uv[point];
    if (!good_uv(uv)) return false;
    out->u = uv[0] + 0.0f, out->v = uv[1] + 0.0f;
    return true;
}

static void make_face(WrTrianglesBuild *b, int32_t i)
{
    WrTriangleCorner *out = b->corner + 3 * (size_t)i;
    int with = 0;
    for (int k = 0; k < 3; k++) with += make_corner(b, i, k, &out[k]);
    b->mapped[i] = with == 3;
    for (int k = 0; k < 3 && with < 3; k++) out[k].u = out[k].v = 0;
    if (with < 3) b->report.no_map++;
}

static void count_bad_uv(WrTrianglesBuild *b)
{
    for (int32_t i = 0; i < b->source->point_count && b->source->uv; i++)
        b->report.bad_uv += !good_uv(b->source->uv[i]);
}

/* Counts the orientations of the (u,v) of mapped faces.
   det = du1 dv2 - du2 dv1 is the signed (u,v) area; it is compared with the sum of its two products, which
   bounds its rounding error. A test against a fixed number would depend on the map's scale (HC126). */
static void count_maps(WrTrianglesBuild *b)
{
    for (int32_t i = 0; i < b->count; i++) {
        const WrTriangleCorner *c = b->corner + 3 * (size_t)i;
        if (!b->mapped[i]) continue;
        const double u1 = (double)c[1].u - (double)c[0].u, v1 = (double)c[1].v - (double)c[0].v;
        const double u2 = (double)c[2].u - (double)c[0].u, v2 = (double)c[2].v - (double)c[0].v;
        const double a = u1 * v2, d = u2 * v1;
        if (fabs(a - d) <= WR_COLLINEAR * (fabs(a) + fabs(d))) b->report.collinear++;
        else b->report.mirrored += a < d;
    }
}

/* ---- construction ---- */

/* All checks of a mesh from outside are here, once; the code after it relies on them. 1e30 keeps squares of
   lengths within double range by far, and float positions finite. */
static bool check_source(const WrTrianglesSource *source, WrError *err)
{
    if (source->triangle_count < 1 || source->triangle_count > WR_TRIANGLES_MAX ||
        source->point_count < 3 || source->point_count > 3 * WR_TRIANGLES_MAX)
        return wr_fail(err, "a mesh of %d triangles and %d points: must be 1..%d triangles",
                       (int)source->triangle_count, (int)source->point_count, WR_TRIANGLES_MAX);
    for (int32_t i = 0; i < 3 * source->triangle_count; i++) {
        const int32_t c = source->corners[i / 3][i % 3];
        if (c < 0 || c >= source->point_count)
            return wr_fail(err, "triangle %d refers to point %d of %d", (int)(i / 3 + 1), (int)c,
                           (int)source->point_count);
    }
    for (int32_t i = 0; i < source->point_count; i++) {
        const float *p = source->points[i];
        if (!(fabsf(p[0]) <= 1e30f && fabsf(p[1]) <= 1e30f && fabsf(p[2]) <= 1e30f))
            return wr_fail(err, "point %d is %g,%g,%g: coordinates are numbers from -1e30 to 1e30",
                           (int)i + 1, (double)p[0], (double)p[1], (double)p[2]);
    }
    int64_t sum = 0;
    for (int32_t i = 0; i < source->part_count; i++) {
        if (source->parts[i].first != sum || source->parts[i].count < 0) sum = -1;
        if (sum < 0) break;
        sum += source->parts[i].count;
    }
    if (source->parts &&
        (sum != source->triangle_count || source->part_count > WR_TRIANGLE_PARTS_MAX))
        return wr_fail(err, "a mesh's %d parts: must hold all triangles in order, in at most %d",
                       (int)source->part_count, WR_TRIANGLE_PARTS_MAX);
    return true;
}

static bool begin(WrTrianglesBuild *b, WrError *err)
{
    const WrTrianglesSource *source = b->source;
    const size_t points = (size_t)source->point_count, faces = (size_t)source->triangle_count;
    const char *what = "a mesh";
    b->points = wr_try_alloc(points, sizeof *b->points, what, err);
    b->at = b->points ? wr_try_alloc(points, sizeof *b->at, what, err) : NULL;
    b->own = b->at ? wr_try_alloc(points, sizeof *b->own, what, err) : NULL;
    b->face = b->own ? wr_try_alloc(faces, sizeof *b->face, what, err) : NULL;
    b->of = b->face ? wr_try_alloc(faces, sizeof *b->of, what, err) : NULL;
    b->normal = b->of ? wr_try_alloc(faces, sizeof *b->normal, what, err) : NULL;
    b->mapped = b->normal ? wr_try_alloc(faces, sizeof *b->mapped, what, err) : NULL;
    b->corner = b->mapped ? wr_try_alloc(faces, 3 * sizeof *b->corner, what, err) : NULL;
    if (!b->corner) return false;
    for (size_t i = 0; i < points; i++) /* -0 is 0 */
        for (int k = 0; k < 3; k++) b->points[i][k] = source->points[i][k] + 0.0f;
    return wr_weld(b->points, sizeof *b->points, source->point_count, b->at, &b->places, err);
}

static void end(WrTrianglesBuild *b)
{
    wr_free(b->points);
    wr_free(b->at);
    wr_free(b->own);
    wr_free(b->face);
    wr_free(b->of);
    wr_free(b->normal);
    wr_free(b->mapped);
    wr_free(b->corner);
}

/* Order matters: the bounding sphere scales the volume, the volume decides the winding, and face normals must
   have their final sign before missing vertex normals are summed from them. */
static bool build(WrTrianglesBuild *b, WrError *err)
{
    if (!begin(b, err)) return false;
    keep_faces(b);
    if (b->count == 0) return wr_fail(err, "no triangle has an area");
    find_ball(b);
    b->closed = is_closed(b);
    take_normals(b);
    if (b->closed && volume(b) < 0) {
        turn_out(b);
        turn_normals(b);
    }
    if (!fill_normals(b, err)) return false;
    count_bad_uv(b);
    for (int32_t i = 0; i < b->count; i++) make_face(b, i);
    count_maps(b);
    return true;
}

WrTriangles *wr_triangles_new(const WrTrianglesSource *source, WrError *err)
{
    if (!check_source(source, err)) return NULL;
    WrTrianglesBuild b = { .source = source };
    WrTriangles *made = build(&b, err) ? triangles_finish(&b, err) : NULL;
    end(&b);
    return made;
}

WrTriangles *wr_triangles_share(const WrTriangles *triangles)
{
    WrTriangles *shared = (WrTriangles *)triangles; /* only the reference count changes */
    __atomic_fetch_add(&shared->refs, 1, __ATOMIC_RELAXED);
    return shared;
}

void wr_triangles_free(WrTriangles *triangles)
{
    if (!triangles || __atomic_sub_fetch(&triangles->refs, 1, __ATOMIC_ACQ_REL) > 0) return;
    wr_free((void *)triangles->corners);
    wr_free((void *)triangles->triangles);
    wr_free((void *)triangles->parts);
    wr_patches_free(triangles->patches);
    wr_relief_weights_free(triangles->weights);
    wr_free((void *)triangles->mask_uv);
    wr_free(triangles);
}

WrTriangles *wr_triangles_square(void)
{
    static const float points[4][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };
    static const float uv[4][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    static const int32_t corners[2][3] = { { 0, 1, 2 }, { 0, 2, 3 } };
    const WrTrianglesSource source = {
        .points = points, .uv = uv, .corners = corners, .point_count = 4, .triangle_count = 2
    };
    return wr_triangles_new(&source, NULL);
}

/* With e_i the edge opposite corner i, grad u = n x (sum of u_i e_i) / 2A (NUMERICS-SCENES a). The edges sum
   to 0, so u of the first corner can be subtracted from all. There is no division by the (u,v) determinant:
   sheared, mirrored and collinear maps need no special case (HC126, HC127). */
bool wr_triangle_gradients(const WrVec3 p[3], const double uv[3][2], WrVec3 *normal, WrVec3 *grad_u,
                           WrVec3 *grad_v)
{
    const WrVec3 none = { 0, 0, 0 };
    int from;
    const WrVec3 cross = face_of(p, &from), n = v3_unit(cross, none);
    const double twice = v3_len(cross);
    const int a = from, b = (from + 1) % 3, c = (from + 2) % 3;
    /* the sum over edges needs only differences to the first corner */
    const WrVec3 eb = v3_sub(p[a], p[c]), ec = v3_sub(p[b], p[a]); /* opposite b and c */
    WrVec3 g[2];
    for (int k = 0; k < 2; k++) {
        const double db = uv[b][k] - uv[a][k], dc = uv[c][k] - uv[a][k];
        g[k] = v3_cross(n, v3_add(v3_scale(eb, db / twice), v3_scale(ec, dc / twice)));
    }
    if (!usable(cross) || !isfinite(v3_len(g[0])) || !isfinite(v3_len(g[1]))) return false;
    *normal = n, *grad_u = g[0], *grad_v = g[1];
    return true;
}

/* ---- points ---- */

/* Searching points by (u,v): several triangles may show one texel, and a triangle may cover several repeats of
   the table. */
#define EDGE                                                                                       \
    1e-9 /* tolerance outside a triangle, as a fraction of it, within which a point still counts as
            on its edge */
#define SHIFTS 64 /* maximum repeats of the table covered by one triangle, in each direction */
#define SAME 1e-6 /* points closer than this fraction of the radius are equal */

/* ---- search ---- */

typedef struct Search {
    const WrTriangles *mesh;
    double u, v;
    int most;
    WrTrianglesPlace *out;
    int64_t count;
} Search;

/* Neighbours both contain a point on their common edge; places that are equal in space within SAME are added
   once. Beyond `most` places are only counted. */
static void add_place(Search *search, int32_t index, double a, double b)
{
    const WrTrianglesPlace place = { index, { a, b } };
    WrSurfacePoint at, other;
    wr_triangles_at(search->mesh, &place, &at);
    const int64_t kept = search->count < search->most ? search->count : search->most;
    for (int64_t i = 0; i < kept; i++) {
        wr_triangles_at(search->mesh, &search->out[i], &other);
        if (v3_len(v3_sub(at.p, other.p)) <= SAME * search->mesh->radius) return;
    }
    if (search->count < search->most) search->out[search->count] = place;
    search->count++;
}

/* The weights (a, b) for which the corner at (o) plus a du, b dv is (u,v) or a repeat of it; in a
 * triangle or a square.
 * Solves o + a A + b B = (u, v) + (i, j) for the repeats (i, j) that the bounding box admits, by Cramer's
 * rule. EDGE is relative to the triangle, so points on a shared edge are found in at least one of its
 * triangles in spite of rounding. */
typedef struct Frame {
    double o[2], a[2], b[2];
    bool square;
} Frame;

static void try_frame(Search *search, int32_t index, const Frame *f)
{
    const double det = f->a[0] * f->b[1] - f->a[1] * f->b[0];
    const double want[2] = { search->u, search->v };
    double first[2], last[2];
    if (!(fabs(det) > 0)) return;
    for (int k = 0; k < 2; k++) { /* integer shifts that bring the target into its range */
        const double x = f->o[k], y = x + f->a[k], z = x + f->b[k], w = f->square ? y + f->b[k] : x;
        const double slack = EDGE * (fabs(f->a[k]) + fabs(f->b[k])) + 1e-12;
        first[k] = ceil(fmin(fmin(x, y), fmin(z, w)) - want[k] - slack);
        last[k] = fmin(floor(fmax(fmax(x, y), fmax(z, w)) - want[k] + slack), first[k] + SHIFTS);
    }
    for (double j = first[1]; j <= last[1]; j++)
        for (double i = first[0]; i <= last[0]; i++) {
            const double x = want[0] + i - f->o[0], y = want[1] + j - f->o[1];
            const double a = (x * f->b[1] - y * f->b[0]) / det;
            const double b = (y * f->a[0] - x * f->a[1]) / det;
            const bool within = f->square ? a <= 1 + EDGE && b <= 1 + EDGE : a + b <= 1 + EDGE;
            if (a >= -EDGE && b >= -EDGE && within)
                add_place(search, index, fmin(fmax(a, 0), 1), fmin(fmax(b, 0), 1));
        }
}

static void search_mesh(Search *search)
{
    const WrTriangles *t = search->mesh;
    for (int32_t p = 0; p < t->part_count; p++) {
        const WrTrianglePart *part = &t->parts[p];
        for (int32_t i = part->first; part->mapped && i < part->first + part->count; i++) {
            const WrTriangleCorner *c[3];
            for (int k = 0; k < 3; k++) c[k] = &t->corners[t->triangles[i].corner[k]];
            const double u = (double)c[0]->u, v = (double)c[0]->v;
            const Frame frame = { { u, v },
                                  { (double)c[1]->u - u, (double)c[1]->v - v },
                                  { (double)c[2]->u - u, (double)c[2]->v - v },
                                  false };
            try_frame(search, i, &frame);
        }
    }
}

static void search_patches(Search *search)
{
    const WrPatches *set = search->mesh->patches;
    for (int32_t i = 0; i < set->count; i++) {
        const WrPatch *patch = &set->patch[i];
        Frame f = { .square = true };
        wr_patch_chart(set, patch, 0, 0, &f.o[0], &f.o[1]);
        wr_patch_chart(set, patch, 1, 0, &f.a[0], &f.a[1]);
        wr_patch_chart(set, patch, 0, 1, &f.b[0], &f.b[1]);
        for (int k = 0; k < 2; k++) f.a[k] -= f.o[k], f.b[k] -= f.o[k];
        try_frame(search, i, &f);
    }
}

int64_t wr_triangles_find(const WrTriangles *triangles, double u, double v, int most,
                          WrTrianglesPlace *out)
{
    Search search = {
        .mesh = triangles, .u = u - floor(u), .v = v - floor(v), .most = most, .out = out
    };
    if (!(fabs(u) < 1e15 && fabs(v) < 1e15)) return 0;
    if (triangles->patches) search_patches(&search);
    else search_mesh(&search);
    return search.count;
}

/* ---- the point ---- */

/* Tangents from gradients: with L = 1 / |grad u x grad v|, N = L n, Pu = L (grad v x n), Pv = L (n x grad u).
   Then
       D = Fu (n x Pv) - Fv (n x Pu) = -|N| (Fu grad u + Fv grad v),
   so equation B7 perturbs by the surface gradient. For mirrored (u,v) these are minus the true tangents: the
   bump's sign then follows n and not the map (HC31). Second derivatives are 0: triangles are flat. */
static void lay(WrVec3 n, WrVec3 grad_u, WrVec3 grad_v, WrSurfacePoint *out)
{
    const double area = v3_len(v3_cross(grad_u, grad_v)), length = area > 1e-30 ? 1 / area : 1;
    out->n_unit = n;
    out->n = v3_scale(n, length);
    out->n_len = length;
    out->pu = v3_scale(v3_cross(grad_v, n), length);
    out->pv = v3_scale(v3_cross(n, grad_u), length);
}

/* The point and the gradients are those of the flat triangle; only the normal is interpolated. The surface
   gradient is projected onto its plane by lay's cross products. */
static void mesh_at(const WrTriangles *mesh, const WrTrianglesPlace *place, WrSurfacePoint *out)
{
    const double share[3] = { 1 - place->share[0] - place->share[1], place->share[0],
                              place->share[1] };
    const WrVec3 none = { 0, 0, 0 };
    WrVec3 p[3], n = none, face = { 0, 0, 1 }, gu = none, gv = none;
    double uv[3][2];
    for (int k = 0; k < 3; k++) {
        const WrTriangleCorner *corner = &mesh->corners[mesh->triangles[place->index].corner[k]];
        p[k] = v3_load(corner->p);
        n = v3_mad(n, v3_load(corner->n), share[k]);
        uv[k][0] = (double)corner->u, uv[k][1] = (double)corner->v;
        out->p = v3_mad(out->p, p[k], share[k]);
    }
    (void)wr_triangle_gradients(p, (const double(*)[2])uv, &face, &gu, &gv);
    lay(v3_unit(n, face), gu, gv, out);
}

/* The patch's own gradients, transformed by the chart: table's u = (c0 + c1 u + c2 v) scale_u. */
static void patch_at(const WrPatches *set, const WrTrianglesPlace *place, WrSurfacePoint *out)
{
    const WrPatch *patch = &set->patch[place->index];
    const float *c = patch->chart;
    WrShape shape;
    WrSurfacePoint own;
    wr_shape_default(WR_SURFACE_bezier, &shape);
    for (int k = 0; k < 48; k++) shape.value[k] = (double)patch->point[k];
    wr_surface_at(&shape, 0, place->share[0], place->share[1], &own);
    out->p = own.p;
    const double inverse = own.n_len > 0 ? 1 / own.n_len : 0;
    const WrVec3 gu = v3_scale(v3_cross(own.pv, own.n_unit), inverse);
    const WrVec3 gv = v3_scale(v3_cross(own.n_unit, own.pu), inverse);
    lay(own.n_unit,
        v3_scale(v3_add(v3_scale(gu, (double)c[1]), v3_scale(gv, (double)c[2])), set->scale_u),
        v3_scale(v3_add(v3_scale(gu, (double)c[4]), v3_scale(gv, (double)c[5])), set->scale_v),
        out);
}

void wr_triangles_at(const WrTriangles *triangles, const WrTrianglesPlace *place,
                     WrSurfacePoint *out)
{
    memset(out, 0, sizeof *out);
    if (triangles->patches) patch_at(triangles->patches, place, out);
    else mesh_at(triangles, place, out);
}
