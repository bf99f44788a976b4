/* Sorting of a mesh's triangles, and its final arrays. */
#include "surface/triangles_internal.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"

#include <string.h>

/* Spreads 21 bits to every third bit. */
static uint64_t spread_bits(uint64_t x)
{
    x &= 0x1fffff;
    x = (x | x << 32) & 0x1f00000000ffffULL;
    x = (x | x << 16) & 0x1f0000ff0000ffULL;
    x = (x | x << 8) & 0x100f00f00f00f00fULL;
    x = (x | x << 4) & 0x10c30c30c30c30c3ULL;
    return (x | x << 2) & 0x1249249249249249ULL;
}

/* Position of a face's centre on the space-filling curve. */
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

/* Stable radix sort by key: eight passes of a byte each. */
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

/* Sorts faces by parts and the curve. */
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
        }
        const int32_t end = source->parts ? source->parts[i].first + source->parts[i].count
                                          : source->triangle_count;
        for (; at < b->count && b->of[at] < end; at++) part.mapped |= b->mapped[at];
        part.count = at - part.first;
        if (part.count > 0) parts[(*count)++] = part;
    }
    return parts;
}

/* Numbers corners in the order of their first use. */
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
 * which split tangent frames (HC129). */
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

WrTriangles *wr_triangles_finish(WrTrianglesBuild *b, WrError *err)
{
    WrTriangles *made = wr_alloc(1, sizeof *made);
    const size_t count = (size_t)b->count;
    made->refs = 1;
    made->triangle_count = b->count;
    made->closed = b->closed;
    made->told = b->told;
    Item *items = wr_try_alloc(count, sizeof *items, "a mesh's order", err);
    WrTriangleCorner *rows = items ? wr_try_alloc(count, 3 * sizeof *rows, "a mesh", err) : NULL;
    bool good = rows && sort_faces(b, items, err);
    for (size_t i = 0; i < count && good; i++)
        memcpy(rows + 3 * i, b->corner + 3 * (size_t)items[i].face, 3 * sizeof *rows);
    good = good && number_corners(made, rows, err);
    wr_free(rows);
    wr_free(items);
    if (!good) {
        wr_triangles_free(made);
        return NULL;
    }
    made->parts = make_parts(b, &made->part_count);
    memcpy(made->centre, b->centre, sizeof made->centre);
    made->radius = b->radius;
    wr_triangles_measure(made);
    return made;
}

static bool same_normals(const WrTriangles *made, int32_t i)
{
    const int32_t *c = made->triangles[i].corner;
    const float *a = made->corners[c[0]].n;
    return memcmp(a, made->corners[c[1]].n, sizeof made->corners[0].n) == 0 &&
           memcmp(a, made->corners[c[2]].n, sizeof made->corners[0].n) == 0;
}

void wr_triangles_measure(WrTriangles *made)
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
    made->told.near_uv = made->mapped ? count_near(made) : 0;
}
