#include "surface/uv_coverage.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/udim.h"
#include "base/vec.h"
#include "surface/triangles.h"

#include <math.h>

#define LOOK 4096   /* triangles between two checks for cancellation */
#define SLIVER 1e-5 /* smallest ratio of height to longest side */
#define ROWS 16     /* of a piece of padding */

/* Owners of padded texels: of earlier rings, and of the present one. */
enum { PADDING = -2, THIS_RING = -3 };

bool wr_uv_coverage_init(WrUvCoverage *cover, const WrTriangles *mesh, int width, int height,
                         WrError *err)
{
    *cover = (WrUvCoverage){ .mesh = mesh, .width = width, .height = height };
    cover->owner = wr_try_alloc((size_t)width * (size_t)height, sizeof *cover->owner, "a map", err);
    return cover->owner != NULL;
}

void wr_uv_coverage_fini(WrUvCoverage *cover)
{
    wr_free(cover->owner);
    *cover = (WrUvCoverage){ 0 };
}

/* ---- coverage of texels by triangles ---- */

/* A triangle on the map: texels from the top left, samples at whole numbers. */
typedef struct Flat {
    double x[3], y[3], area2; /* signed */
    int x0, x1, y0, y1;       /* texels that it can cover; not wrapped into the map */
} Flat;

static int whole(double x)
{
    return x < -2e9 ? -2000000000 : x > 2e9 ? 2000000000 : (int)x;
}

static bool lay_flat(const WrUvCoverage *cover, int32_t triangle, Flat *flat)
{
    const double w = cover->width, h = cover->height;
    const int32_t *corner = cover->mesh->triangles[triangle].corner;
    const int column = cover->udim ? wr_udim_column(cover->udim) : 0;
    const int row = cover->udim ? wr_udim_row(cover->udim) : 0;
    double low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY };
    for (int k = 0; k < 3; k++) {
        const WrTriangleCorner *c = &cover->mesh->corners[corner[k]];
        flat->x[k] = w * ((double)c->u - column) - 0.5 - cover->dx;
        flat->y[k] = h * (1.0 + row - (double)c->v) - 0.5 - cover->dy;
        low[0] = fmin(low[0], flat->x[k]), high[0] = fmax(high[0], flat->x[k]);
        low[1] = fmin(low[1], flat->y[k]), high[1] = fmax(high[1], flat->y[k]);
    }
    flat->area2 = (flat->x[1] - flat->x[0]) * (flat->y[2] - flat->y[0]) -
                  (flat->x[2] - flat->x[0]) * (flat->y[1] - flat->y[0]);
    flat->x0 = whole(ceil(low[0] - 1e-9)), flat->x1 = whole(floor(high[0] + 1e-9));
    flat->y0 = whole(ceil(low[1] - 1e-9)), flat->y1 = whole(floor(high[1] + 1e-9));
    if (cover->udim) {
        if (flat->x0 < 0) flat->x0 = 0;
        if (flat->y0 < 0) flat->y0 = 0;
        if (flat->x1 >= cover->width) flat->x1 = cover->width - 1;
        if (flat->y1 >= cover->height) flat->y1 = cover->height - 1;
    }
    /* A triangle larger than the map overlaps itself: one period is enough. */
    if (flat->x1 - flat->x0 >= cover->width) flat->x1 = flat->x0 + cover->width - 1;
    if (flat->y1 - flat->y0 >= cover->height) flat->y1 = flat->y0 + cover->height - 1;
    return flat->area2 != 0.0 && isfinite(flat->area2);
}

/* Barycentric coordinates of a texel's sample. */
static void shares(const Flat *flat, double x, double y, double l[3])
{
    for (int k = 0; k < 3; k++) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        l[k] = ((flat->x[a] - x) * (flat->y[b] - y) - (flat->x[b] - x) * (flat->y[a] - y)) /
               flat->area2;
    }
}

static int wrapped(int i, int size)
{
    const int rest = i % size;
    return rest < 0 ? rest + size : rest;
}

static bool is_sliver(const WrTriangles *mesh, int32_t triangle)
{
    const int32_t *corner = mesh->triangles[triangle].corner;
    WrVec3 p[3];
    for (int k = 0; k < 3; k++) {
        const float *at = mesh->corners[corner[k]].p;
        p[k] = (WrVec3){ (double)at[0], (double)at[1], (double)at[2] };
    }
    const WrVec3 a = v3_sub(p[1], p[0]), b = v3_sub(p[2], p[0]), c = v3_sub(p[2], p[1]);
    const double longest = fmax(fmax(v3_dot(a, a), v3_dot(b, b)), v3_dot(c, c));
    return !(v3_len(v3_cross(a, b)) > SLIVER * longest);
}

static void fill_triangle(WrUvCoverage *cover, int32_t triangle)
{
    const int width = cover->width, height = cover->height;
    Flat flat;
    if (!lay_flat(cover, triangle, &flat) || is_sliver(cover->mesh, triangle)) return;
    for (int y = flat.y0; y <= flat.y1; y++)
        for (int x = flat.x0; x <= flat.x1; x++) {
            double l[3];
            shares(&flat, x, y, l);
            if (l[0] < -1e-9 || l[1] < -1e-9 || l[2] < -1e-9) continue;
            cover->owner[(size_t)wrapped(y, height) * (size_t)width + (size_t)wrapped(x, width)] =
                triangle;
        }
}

void wr_uv_coverage_fill(WrUvCoverage *cover, double dx, double dy)
{
    const size_t texels = (size_t)cover->width * (size_t)cover->height;
    cover->dx = dx, cover->dy = dy;
    for (size_t i = 0; i < texels; i++) cover->owner[i] = WR_UV_UNCOVERED;
    for (int32_t i = 0; i < cover->mesh->triangle_count; i++) {
        if (i % LOOK == 0 && wr_progress_stopped()) return;
        fill_triangle(cover, i);
    }
}

void wr_uv_coverage_shares(const WrUvCoverage *cover, int32_t triangle, int x, int y, double l[3])
{
    Flat flat;
    lay_flat(cover, triangle, &flat);
    /* Chooses the periodic copy of the texel that is inside the triangle. */
    shares(&flat, flat.x0 + wrapped(x - flat.x0, cover->width),
           flat.y0 + wrapped(y - flat.y0, cover->height), l);
}

/* ---- padding ---- */

typedef struct Pad {
    WrUvCoverage *cover;
    float *map;
    int channels;
    bool unit;
    int padded; /* set if the current ring has any texel */
} Pad;

/* Sets an uncovered texel to the mean of its covered neighbours: covered by triangles, or by an earlier ring. */
static bool pad_texel(const Pad *pad, int x, int y)
{
    const int width = pad->cover->width, height = pad->cover->height;
    const size_t channels = (size_t)pad->channels;
    double sum[3] = { 0, 0, 0 };
    int count = 0;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++) {
            if (pad->cover->udim &&
                (x + dx < 0 || x + dx >= width || y + dy < 0 || y + dy >= height))
                continue;
            const size_t at =
                (size_t)wrapped(y + dy, height) * (size_t)width + (size_t)wrapped(x + dx, width);
            const int32_t owner = __atomic_load_n(&pad->cover->owner[at], __ATOMIC_RELAXED);
            if (owner == WR_UV_UNCOVERED || owner == THIS_RING) continue;
            for (size_t c = 0; c < channels; c++) sum[c] += (double)pad->map[channels * at + c];
            count++;
        }
    if (count == 0) return false;
    const WrVec3 n = v3_unit((WrVec3){ sum[0], sum[1], sum[2] }, (WrVec3){ 0, 0, 1 });
    const double mean[3] = { pad->unit ? n.x : sum[0] / count, pad->unit ? n.y : sum[1] / count,
                             pad->unit ? n.z : sum[2] / count };
    float *to = pad->map + channels * ((size_t)y * (size_t)width + (size_t)x);
    for (size_t c = 0; c < channels; c++) to[c] = (float)mean[c];
    return true;
}

/* Texels of this ring are used only by the next one. */
static void ring_piece(int index, int worker, void *ctx)
{
    Pad *pad = ctx;
    const int width = pad->cover->width, height = pad->cover->height;
    (void)worker;
    for (int j = ROWS * index; j < height && j < ROWS * (index + 1); j++)
        for (int i = 0; i < width; i++) {
            int32_t *owner = &pad->cover->owner[(size_t)j * (size_t)width + (size_t)i];
            if (*owner != WR_UV_UNCOVERED || !pad_texel(pad, i, j)) continue;
            __atomic_store_n(owner, THIS_RING, __ATOMIC_RELAXED);
            __atomic_store_n(&pad->padded, 1, __ATOMIC_RELAXED);
        }
}

static void settle_piece(int index, int worker, void *ctx)
{
    const Pad *pad = ctx;
    const size_t row = (size_t)pad->cover->width, all = row * (size_t)pad->cover->height;
    const size_t first = ROWS * row * (size_t)index, end = first + ROWS * row;
    (void)worker;
    for (size_t i = first; i < all && i < end; i++)
        if (pad->cover->owner[i] == THIS_RING) pad->cover->owner[i] = PADDING;
}

void wr_uv_coverage_pad(WrUvCoverage *cover, float *map, int channels, bool unit, int rings,
                        WrPool *pool)
{
    Pad pad = { cover, map, channels, unit, 1 };
    const int pieces = (cover->height + ROWS - 1) / ROWS;
    for (int ring = 0; ring < rings && pad.padded && !wr_progress_stopped(); ring++) {
        pad.padded = 0;
        wr_pool_run(pool, pieces, ring_piece, &pad);
        wr_pool_run(pool, pieces, settle_piece, &pad);
    }
}
