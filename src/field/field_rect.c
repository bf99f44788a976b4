/* Copying rectangles between a table and plain memory. The part inside the table is copied tile by
   tile; a rectangle that extends beyond it is first cut into parts that do not. */
#include "field/field.h"

#include "base/error.h"
#include "base/memory.h"

#include <float.h>
#include <math.h>
#include <string.h>

static int64_t min64(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static int wrap_index(int64_t i, int n)
{
    int64_t rest = i % n;
    return (int)(rest < 0 ? rest + n : rest);
}

/* Copies by pieces of constant sizes: for one row of a tile the compiler would use a string instruction
 * whose start-up takes longer than the copy. */
static inline void copy_texels(const float *restrict in, int count, float *restrict out)
{
    int k = 0;
    for (; k + 16 <= count; k += 16) memcpy(out + k, in + k, 16 * sizeof *out);
    if (count & 8) memcpy(out + k, in + k, 8 * sizeof *out), k += 8;
    if (count & 4) memcpy(out + k, in + k, 4 * sizeof *out), k += 4;
    if (count & 2) memcpy(out + k, in + k, 2 * sizeof *out), k += 2;
    if (count & 1) out[k] = in[k];
}

static void copy_block(const float *tile, float level, int x, int y, int count_i, int count_j,
                       float *out, size_t pitch)
{
    for (int row = 0; row < count_j; row++, out += pitch) {
        if (tile) copy_texels(tile + (y + row) * WR_TILE + x, count_i, out);
        else
            for (int col = 0; col < count_i; col++) out[col] = level;
    }
}

/* A rectangle that lies inside the table. */
static void read_inside(const WrField *field, int i, int j, int count_i, int count_j, float *out,
                        size_t pitch)
{
    float level = wr_field_level(field);
    for (int row = 0; row < count_j;) {
        int y = (j + row) % WR_TILE, rows = (int)min64(WR_TILE - y, count_j - row);
        for (int col = 0; col < count_i;) {
            int x = (i + col) % WR_TILE, cols = (int)min64(WR_TILE - x, count_i - col);
            const float *tile = wr_field_tile(field, (i + col) / WR_TILE, (j + row) / WR_TILE);
            copy_block(tile, level, x, y, cols, rows, out + (size_t)row * pitch + col, pitch);
            col += cols;
        }
        row += rows;
    }
}

void wr_field_expect(const WrField *field, int i, int j, int count_i)
{
    enum { LINE = WR_ALIGN / (int)sizeof(float) };
    const int width = wr_field_width(field), end = count_i < width - i ? i + count_i : width;
    if (i < 0 || j < 0 || j >= wr_field_height(field)) return;
    for (int after; i < end; i = after) {
        const float *tile = wr_field_tile(field, i / WR_TILE, j / WR_TILE);
        after = (i / WR_TILE + 1) * WR_TILE;
        for (int k = i / LINE * LINE; tile && k < after && k < end; k += LINE)
            __builtin_prefetch(tile + j % WR_TILE * WR_TILE + k % WR_TILE);
    }
}

/* The quadratic through t0, t1, t2 at 0, 1, 2, extrapolated to `x` < 0, in Newton's form of
 * differences, so that equal heights stay exactly equal; at -1 it is 3 t0 - 3 t1 + t2. */
static float beyond(float t0, float t1, float t2, double x)
{
    double first = (double)t1 - t0, second = ((double)t2 - t1) - first;
    double value = t0 + x * first + 0.5 * x * (x - 1.0) * second;
    if (value > FLT_MAX) return FLT_MAX;
    return value < -FLT_MAX ? -FLT_MAX : (float)value;
}

/* Position of index i outside a clamped axis of n texels, as a coordinate that runs inwards from the
 * nearer end: -1 is the first missing texel. *end is that end's index, *step points inwards. */
static double outside(int64_t i, int n, int *end, int *step)
{
    *end = i < 0 ? 0 : n - 1;
    *step = n < 3 ? 0 : i < 0 ? 1 : -1;
    return (double)(i < 0 ? i : n - 1 - i);
}

/* Rows j .. j + count_j - 1, all inside the table; columns anywhere on a clamped axis. */
static void read_rows_clamped(const WrField *field, int64_t i, int j, int64_t count_i, int count_j,
                              float *out, size_t pitch)
{
    int width = wr_field_width(field);
    int64_t first = i < 0 ? min64(-i, count_i) : 0; /* columns left of the table */
    int64_t inside = min64(width - (i + first), count_i - first);
    if (inside > 0)
        read_inside(field, (int)(i + first), j, (int)inside, count_j, out + first, pitch);
    for (int row = 0; row < count_j; row++, out += pitch)
        for (int64_t col = 0; col < count_i; col++) {
            if (col == first && inside > 0) {
                col += inside - 1;
                continue;
            }
            int end, step;
            double x = outside(i + col, width, &end, &step);
            out[col] =
                beyond(wr_field_get(field, end, j + row), wr_field_get(field, end + step, j + row),
                       wr_field_get(field, end + 2 * step, j + row), x);
        }
}

static void read_rows(const WrField *field, int64_t i, int j, int64_t count_i, int count_j,
                      float *out, size_t pitch)
{
    if (wr_field_wrap_u(field) == WR_WRAP_CLAMP) {
        read_rows_clamped(field, i, j, count_i, count_j, out, pitch);
        return;
    }
    int width = wr_field_width(field);
    for (int64_t col = 0; col < count_i;) {
        int from = wrap_index(i + col, width);
        int cols = (int)min64(width - from, count_i - col);
        read_inside(field, from, j, cols, count_j, out + col, pitch);
        col += cols;
    }
}

/* One row above or below a clamped table, from the three rows at that end. */
static void read_row_outside(const WrField *field, int64_t i, int64_t j, int64_t count_i,
                             float *out)
{
    enum { PART = 256 };
    float rows[3][PART];
    int end, step;
    double y = outside(j, wr_field_height(field), &end, &step);
    for (int64_t col = 0; col < count_i; col += PART) {
        int64_t cols = min64(PART, count_i - col);
        for (int k = 0; k < 3; k++) read_rows(field, i + col, end + k * step, cols, 1, rows[k], 0);
        for (int64_t c = 0; c < cols; c++)
            out[col + c] = beyond(rows[0][c], rows[1][c], rows[2][c], y);
    }
}

void wr_field_read(const WrField *field, int i, int j, int count_i, int count_j, float *out,
                   size_t pitch)
{
    int width = wr_field_width(field), height = wr_field_height(field);
    if (count_i <= 0 || count_j <= 0) return;
    if (i >= 0 && j >= 0 && count_i <= width - i && count_j <= height - j) {
        read_inside(field, i, j, count_i, count_j, out, pitch);
        return;
    }
    bool clamped = wr_field_wrap_v(field) == WR_WRAP_CLAMP;
    for (int64_t row = 0; row < count_j;) {
        int64_t at = j + row, rows = 1;
        float *to = out + (size_t)row * pitch;
        if (clamped && (at < 0 || at >= height)) {
            read_row_outside(field, i, at, count_i, to);
        } else {
            int from = wrap_index(at, height);
            rows = min64(height - from, count_j - row);
            read_rows(field, i, from, count_i, (int)rows, to, pitch);
        }
        row += rows;
    }
}

static bool all_equal(const float *in, size_t pitch, int count_i, int count_j, float level)
{
    for (int row = 0; row < count_j; row++, in += pitch)
        for (int col = 0; col < count_i; col++)
            if (memcmp(&in[col], &level, sizeof level) != 0) return false;
    return true;
}

static int64_t write_block(float *tile, int x, int y, int count_i, int count_j, const float *in,
                           size_t pitch)
{
    int64_t mended = 0;
    for (int row = 0; row < count_j; row++, in += pitch) {
        float *to = tile + (y + row) * WR_TILE + x;
        for (int col = 0; col < count_i; col++) {
            bool finite = fabsf(in[col]) <= FLT_MAX;
            to[col] = finite ? in[col] : 0.0f;
            mended += !finite;
        }
    }
    return mended;
}

int64_t wr_field_write(WrField *field, int i, int j, int count_i, int count_j, const float *in,
                       size_t pitch)
{
    WR_ASSERT(i >= 0 && j >= 0 && count_i <= wr_field_width(field) - i &&
              count_j <= wr_field_height(field) - j);
    float level = wr_field_level(field);
    int64_t mended = 0;
    for (int row = 0; row < count_j;) {
        int y = (j + row) % WR_TILE, rows = (int)min64(WR_TILE - y, count_j - row);
        for (int col = 0; col < count_i;) {
            int x = (i + col) % WR_TILE, cols = (int)min64(WR_TILE - x, count_i - col);
            int tx = (i + col) / WR_TILE, ty = (j + row) / WR_TILE;
            const float *from = in + (size_t)row * pitch + col;
            /* unchanged heights allocate no tile */
            if (wr_field_tile(field, tx, ty) || !all_equal(from, pitch, cols, rows, level))
                mended +=
                    write_block(wr_field_tile_write(field, tx, ty), x, y, cols, rows, from, pitch);
            col += cols;
        }
        row += rows;
    }
    return mended;
}

/* ---- differences --------------------------------------------------------------------------------- */

/* Columns that differ between two rows of a tile, from *first to before *end; false: none. */
static bool rows_differ(const float *a, const float *b, int count, int *first, int *end)
{
    if (memcmp(a, b, (size_t)count * sizeof *a) == 0) return false;
    *first = 0, *end = count;
    while (memcmp(&a[*first], &b[*first], sizeof *a) == 0) ++*first;
    while (memcmp(&a[*end - 1], &b[*end - 1], sizeof *a) == 0) --*end;
    return true;
}

WrFieldRect wr_field_difference(const WrField *a, const WrField *b, int tx, int ty)
{
    const float *of_a = wr_field_tile(a, tx, ty), *of_b = wr_field_tile(b, tx, ty);
    const int left = tx * WR_TILE, top = ty * WR_TILE;
    const int w = wr_field_width(a) - left, h = wr_field_height(a) - top;
    float level_a[WR_TILE], level_b[WR_TILE];
    WrFieldRect all = { WR_TILE, 0, WR_TILE, 0 };
    for (int i = 0; i < WR_TILE; i++)
        level_a[i] = wr_field_level(a), level_b[i] = wr_field_level(b);
    for (int y = 0; y < WR_TILE && y < h; y++) {
        const float *row_a = of_a ? of_a + y * WR_TILE : level_a;
        const float *row_b = of_b ? of_b + y * WR_TILE : level_b;
        int first, end;
        if (!rows_differ(row_a, row_b, w < WR_TILE ? w : WR_TILE, &first, &end)) continue;
        all.i0 = first < all.i0 ? first : all.i0;
        all.i1 = end > all.i1 ? end : all.i1;
        all.j0 = y < all.j0 ? y : all.j0;
        all.j1 = y + 1;
    }
    if (all.i1 == 0) return (WrFieldRect){ 0, 0, 0, 0 };
    return (WrFieldRect){ left + all.i0, left + all.i1, top + all.j0, top + all.j1 };
}
