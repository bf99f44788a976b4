#include "brush/blend_target.h"

#include "base/memory.h"
#include "brush/scan_convert.h"
#include "field/field.h"

#include <math.h>
#include <string.h>

#define TEXELS (WR_TILE * WR_TILE)

/* A clone's source offset in texels, rounded to a fine grid so that whole texels are detected; limited
   in size. */
static double shift(double source, int n, WrWrap wrap)
{
    double texels = source * n;
    if (wrap == WR_WRAP_PERIODIC) texels -= n * floor(texels / n);
    if (!(fabs(texels) <= 2.0 * n)) texels = texels > 0.0 ? 2.0 * n : texels < 0.0 ? -2.0 * n : 0.0;
    return rint(texels * 65536.0) / 65536.0;
}

WrTargets wr_targets(const WrBrushGround *ground, const WrField *start, const WrBrush *brush)
{
    return (WrTargets){ .kind = wr_mode_work(brush->mode)->target,
                        .start = start,
                        .below = ground->below,
                        .neutral = isfinite(ground->neutral) ? ground->neutral : 0.0f,
                        .shift_x =
                            shift(brush->source_u, wr_field_width(start), wr_field_wrap_u(start)),
                        .shift_y =
                            shift(-brush->source_v, wr_field_height(start), wr_field_wrap_v(start)),
                        .reach = (int)brush->reach };
}

static int limit(int i, int n)
{
    return i < 0 ? 0 : i < n ? i : n - 1;
}

/* Reads one row, j inside the table. */
static void read_row(const WrField *field, int i, int j, int count, float *out)
{
    int width = wr_field_width(field);
    bool clamps = wr_field_wrap_u(field) == WR_WRAP_CLAMP;
    for (int k = 0; k < count;) {
        int texel, run;
        if (clamps && (i + k < 0 || i + k >= width)) {
            texel = limit(i + k, width);
            run = 1;
        } else {
            run = wr_tile_run(i + k, i + count - 1, width, &texel);
        }
        const float *tile = wr_field_tile(field, texel / WR_TILE, j / WR_TILE);
        const float *from = tile ? tile + j % WR_TILE * WR_TILE + texel % WR_TILE : NULL;
        for (int n = 0; n < run; n++) out[k + n] = from ? from[n] : wr_field_level(field);
        k += run;
    }
}

void wr_read_box(const WrField *field, int i, int j, int count_i, int count_j, int pitch,
                 float *out)
{
    int height = wr_field_height(field);
    bool clamps = wr_field_wrap_v(field) == WR_WRAP_CLAMP;
    for (int row = 0; row < count_j; row++) {
        int at = j + row, wrapped = at % height < 0 ? at % height + height : at % height;
        read_row(field, i, clamps ? limit(at, height) : wrapped, count_i,
                 out + (size_t)row * (size_t)pitch);
    }
}

static void below_tile(const WrTargets *t, int tx, int ty, float *out)
{
    const float *tile = t->below ? wr_field_tile(t->below, tx, ty) : NULL;
    float level = t->below ? wr_field_level(t->below) : t->neutral;
    if (tile) memcpy(out, tile, TEXELS * sizeof *out);
    else
        for (int k = 0; k < TEXELS; k++) out[k] = level;
}

/* Bilinear between whole texels; an integer shift copies. */
static void shifted_tile(const WrTargets *t, int tx, int ty, float *out)
{
    enum { SIDE = WR_TILE + 1 };
    float taps[SIDE * SIDE];
    double whole_x = floor(t->shift_x), whole_y = floor(t->shift_y);
    double fx = t->shift_x - whole_x, fy = t->shift_y - whole_y;
    wr_read_box(t->start, tx * WR_TILE + (int)whole_x, ty * WR_TILE + (int)whole_y, SIDE, SIDE,
                SIDE, taps);
    for (int y = 0; y < WR_TILE; y++)
        for (int x = 0; x < WR_TILE; x++) {
            const float *at = taps + y * SIDE + x;
            double upper = at[0] * (1.0 - fx) + at[1] * fx;
            double lower = at[SIDE] * (1.0 - fx) + at[SIDE + 1] * fx;
            out[y * WR_TILE + x] = (float)(upper * (1.0 - fy) + lower * fy);
        }
}

/* Half the width of a disc's row `off` texels from its middle; at least 0. */
static int half_width(int reach, int off)
{
    double r = reach + 0.5, half2 = r * r - (double)off * off;
    return half2 > 0.0 ? (int)sqrt(half2) : 0;
}

/* Prefix sums of rows give the sum of any part of a row by one difference. */
static void sharp_tile(const WrTargets *t, int tx, int ty, float *out)
{
    int reach = t->reach, side = WR_TILE + 2 * reach, texels = 0;
    float *row = wr_alloc((size_t)side, sizeof *row);
    double *sums = wr_alloc((size_t)side + 1, sizeof *sums);
    double *means = wr_alloc(TEXELS, sizeof *means);
    for (int off = -reach; off <= reach; off++) texels += 2 * half_width(reach, off) + 1;
    for (int j = 0; j < side; j++) {
        wr_read_box(t->start, tx * WR_TILE - reach, ty * WR_TILE - reach + j, side, 1, side, row);
        for (int i = 0; i < side; i++) sums[i + 1] = sums[i] + row[i];
        for (int y = 0; y < WR_TILE; y++) {
            int off = j - reach - y;
            if (off < -reach || off > reach) continue;
            int half = half_width(reach, off);
            const double *left = sums + reach - half, *right = sums + reach + half + 1;
            for (int x = 0; x < WR_TILE; x++) means[y * WR_TILE + x] += right[x] - left[x];
        }
    }
    wr_read_box(t->start, tx * WR_TILE, ty * WR_TILE, WR_TILE, WR_TILE, WR_TILE, out);
    for (int k = 0; k < TEXELS; k++) {
        double f = out[k];
        out[k] = wr_finite_float(f + (f - means[k] / texels));
    }
    wr_free(row);
    wr_free(sums);
    wr_free(means);
}

#define LEVELS 10 /* 2^9 <= 2 WR_REACH_MAX + 1 < 2^10 */

/* Maxima (of heights times sign) of runs of 1, 2, 4, ... texels starting at each texel. */
static void doublings(const float *row, int side, float sign, int levels, float *runs)
{
    for (int i = 0; i < side; i++) runs[i] = sign * row[i];
    for (int level = 1; level < levels; level++) {
        const float *from = runs + (size_t)(level - 1) * (size_t)side;
        float *to = runs + (size_t)level * (size_t)side;
        int half = 1 << (level - 1), last = side - 2 * half;
        for (int i = 0; i <= last; i++) to[i] = from[i] > from[i + half] ? from[i] : from[i + half];
    }
}

static void extreme_tile(const WrTargets *t, int tx, int ty, float sign, float *out)
{
    int reach = t->reach, side = WR_TILE + 2 * reach, levels = 1;
    while ((1 << levels) <= 2 * reach + 1) levels++;
    float *row = wr_alloc((size_t)side, sizeof *row);
    float *runs = wr_alloc((size_t)side * LEVELS, sizeof *runs);
    for (int k = 0; k < TEXELS; k++) out[k] = -3.4028234663852886e38f;
    for (int j = 0; j < side; j++) {
        wr_read_box(t->start, tx * WR_TILE - reach, ty * WR_TILE - reach + j, side, 1, side, row);
        doublings(row, side, sign, levels, runs);
        for (int y = 0; y < WR_TILE; y++) {
            int off = j - reach - y;
            if (off < -reach || off > reach) continue;
            int half = half_width(reach, off), level = 0;
            while ((2 << level) <= 2 * half + 1) level++;
            const float *left = runs + (size_t)level * (size_t)side + (reach - half);
            const float *right = left + (2 * half + 1 - (1 << level));
            float *to = out + y * WR_TILE;
            for (int x = 0; x < WR_TILE; x++) {
                float larger = left[x] > right[x] ? left[x] : right[x];
                to[x] = to[x] > larger ? to[x] : larger;
            }
        }
    }
    for (int k = 0; k < TEXELS; k++) out[k] = sign * out[k];
    wr_free(row);
    wr_free(runs);
}

void wr_blend_target_tile(const WrTargets *t, int tx, int ty, float *out)
{
    switch (t->kind) {
    case WR_BLEND_TARGET_NONE: break;
    case WR_BLEND_TARGET_BELOW: below_tile(t, tx, ty, out); break;
    case WR_BLEND_TARGET_SHIFTED: shifted_tile(t, tx, ty, out); break;
    case WR_BLEND_TARGET_SHARP: sharp_tile(t, tx, ty, out); break;
    case WR_BLEND_TARGET_LARGEST: extreme_tile(t, tx, ty, 1.0f, out); break;
    case WR_BLEND_TARGET_SMALLEST: extreme_tile(t, tx, ty, -1.0f, out); break;
    }
}
