/* Use of sparse hits in a tile of samples. */
#include "render/visibility/sparse_hits_internal.h"

#include <float.h>
#include <stddef.h>

bool wr_sparse_hits_deep(const WrSparseHits *knots, int32_t x0, int32_t y0, int32_t x1, int32_t y1)
{
    const WrSparseHitsBlocks b = wr_sparse_hits_blocks(knots, x0, y0, x1, y1);
    for (int y = b.y0; y <= b.y1; y++) {
        const unsigned char *row = knots->place + (size_t)y * (size_t)knots->across;
        for (int x = b.x0; x <= b.x1; x++)
            if (row[x] == WR_SPARSE_HITS_DEPTH) return true;
    }
    return false;
}

/* u, v of a whole block. */
static void fill_block(const WrSparseHits *k, const WrWide *wide, int x, int y, int shift, float *u,
                       float *v, int pitch)
{
    const size_t at = (size_t)(y - shift / 3) * (size_t)k->across + (size_t)(x - shift % 3);
    const WrWideKnots how = { k->across, shift % 3, shift / 3, pitch };
    wide->between(k->u + at, &how, k->closed_u, u);
    wide->between(k->v + at, &how, k->closed_v, v);
}

/* The part of a block inside a tile, relative to the block's hit; `to`: position of that hit. */
typedef struct Part {
    int x0, y0, x1, y1;
    ptrdiff_t to;
} Part;

static Part part_of(const WrSparseHits *k, int x, int y, const WrDepthTile *tile)
{
    const int gx = (x - WR_SPARSE_HITS_AROUND) * WR_KNOT - tile->x,
              gy = (y + k->top) * WR_KNOT - tile->y;
    return (Part){ gx < 0 ? -gx : 0, gy < 0 ? -gy : 0,
                   gx + WR_KNOT > tile->w ? tile->w - gx : WR_KNOT,
                   gy + WR_KNOT > tile->h ? tile->h - gy : WR_KNOT, (ptrdiff_t)gy * tile->w + gx };
}

static void put_close(const Part *part, float close, WrDepthTile *tile)
{
    for (int y = part->y0; y < part->y1; y++)
        for (int x = part->x0; x < part->x1; x++)
            tile->close[part->to + (ptrdiff_t)y * tile->w + x] = close;
}

/* Removes the triangles' samples from a block that is interpolated. */
static void clear_part(const WrSparseHits *k, int x, int y, WrDepthTile *tile)
{
    const Part part = part_of(k, x, y, tile);
    put_close(&part, -FLT_MAX, tile);
}

static void fill_part(const WrSparseHits *k, const WrWide *wide, int x, int y, int shift,
                      WrDepthTile *tile)
{
    const Part part = part_of(k, x, y, tile);
    float u[WR_KNOT * WR_KNOT], v[WR_KNOT * WR_KNOT];
    put_close(&part, 0, tile);
    if (part.x1 - part.x0 == WR_KNOT && part.y1 - part.y0 == WR_KNOT) {
        fill_block(k, wide, x, y, shift, tile->u + part.to, tile->v + part.to, tile->w);
        return;
    }
    fill_block(k, wide, x, y, shift, u, v, WR_KNOT);
    for (int row = part.y0; row < part.y1; row++)
        for (int i = part.x0; i < part.x1; i++) {
            tile->u[part.to + (ptrdiff_t)row * tile->w + i] = u[row * WR_KNOT + i];
            tile->v[part.to + (ptrdiff_t)row * tile->w + i] = v[row * WR_KNOT + i];
        }
}

void wr_sparse_hits_report(const WrSparseHits *knots, WrDepthTile *tile)
{
    const int x1 = (tile->x + tile->w - 1) / WR_KNOT + WR_SPARSE_HITS_AROUND;
    const int y1 = (tile->y + tile->h - 1) / WR_KNOT - knots->top;
    tile->knots = knots;
    for (int y = tile->y / WR_KNOT - knots->top; y <= y1; y++)
        for (int x = tile->x / WR_KNOT + WR_SPARSE_HITS_AROUND; x <= x1; x++) {
            const int place = knots->place[(size_t)y * (size_t)knots->across + (size_t)x];
            tile->untold |= place == WR_SPARSE_HITS_DEPTH || place >= WR_SPARSE_HITS_BETWEEN;
            tile->deep |= place == WR_SPARSE_HITS_DEPTH;
        }
}

void wr_sparse_hits_fill(const WrSparseHits *knots, const WrWide *wide, WrDepthTile *tile)
{
    const int x1 = (tile->x + tile->w - 1) / WR_KNOT + WR_SPARSE_HITS_AROUND;
    const int y1 = (tile->y + tile->h - 1) / WR_KNOT - knots->top;
    for (int y = tile->y / WR_KNOT - knots->top; y <= y1; y++)
        for (int x = tile->x / WR_KNOT + WR_SPARSE_HITS_AROUND; x <= x1; x++) {
            const int place = knots->place[(size_t)y * (size_t)knots->across + (size_t)x];
            if (place == WR_SPARSE_HITS_SHEET && tile->deep) clear_part(knots, x, y, tile);
            if (place >= WR_SPARSE_HITS_BETWEEN)
                fill_part(knots, wide, x, y, place - WR_SPARSE_HITS_BETWEEN, tile);
        }
}

void wr_sparse_hits_row(const WrSparseHits *knots, const WrWide *wide, int x, int y, int count,
                        int at, WrStrip *strip)
{
    const int left = x / WR_KNOT + WR_SPARSE_HITS_AROUND - 1, above = y / WR_KNOT - knots->top - 1;
    const size_t first = (size_t)above * (size_t)knots->across + (size_t)left;
    const WrWideRow row = { .numbers = knots->numbers + first,
                            .plane = (size_t)knots->across * (size_t)knots->down,
                            .across = knots->across,
                            .down = y % WR_KNOT,
                            .skip = x % WR_KNOT,
                            .x = (float)x,
                            .y = (float)y };
    wide->sheet_row(&row, count, at, strip);
}
