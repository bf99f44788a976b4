#include "noise/inner.h"

#include <math.h>

/* One octave over a piece of a grid (grid.h).

   Columns holds what the piece's columns are to the lattice, once for all rows; LatticeRow what a row
   of the lattice prescribes at the lattice columns that the piece touches, once for all texel rows
   between it and the next; Blended the row's A, B and their derivatives by y, C and D. Then

     p = A_k + B_k x     q = A_(k+1) + B_(k+1) (x - 1)     f = p + alpha (q - p)
     fx = B_k + alpha (B_(k+1) - B_k) + alpha' (q - p)
     fy = the blend of C + D x as f is of A + B x. */

/* At most one cell a texel: 256 cells, the rounding of the first and the last, and the far corner. */
#define POINTS (WR_NOISE_STRIP + 8)

typedef struct Columns {
    int count;                    /* texels */
    int points;                   /* lattice columns */
    int32_t cell[WR_NOISE_STRIP]; /* near lattice column, from the piece's first */
    float x[WR_NOISE_STRIP];      /* place within the cell */
    float alpha[WR_NOISE_STRIP];  /* the fade there */
    float rate[WR_NOISE_STRIP];   /* its derivative */
    uint32_t index[POINTS];       /* lattice index, within the period */
    uint32_t chain[POINTS];       /* the hash as far as x goes */
    float set[16][2];             /* perlin: the slopes to choose from */
} Columns;

typedef struct LatticeRow {
    double index; /* floor(t), not reduced; NaN: empty */
    float f[POINTS], gx[POINTS], gy[POINTS];
} LatticeRow;

typedef struct Blended {
    float a[POINTS], b[POINTS], c[POINTS], d[POINTS];
} Blended;

static uint32_t reduced_index(double whole, int period)
{
    return (uint32_t)(int64_t)wr_noise_reduce(whole, period);
}

static void fill_columns(const WrOctave *octave, const WrNoiseGrid *grid, Columns *columns)
{
    const WrFadeInfo *fade = &wr_fades[octave->noise.fade];
    int period = octave->noise.lattice.period[0];
    double first = 0.0;
    columns->count = grid->count_i;
    for (int i = 0; i < grid->count_i; i++) {
        double t = octave->frequency[0] * wr_noise_grid_u(grid, grid->i + i) + octave->offset[0];
        double whole = floor(t), x = t - whole;
        if (i == 0) first = whole;
        columns->cell[i] = (int32_t)(whole - first);
        columns->x[i] = (float)x;
        columns->alpha[i] = (float)wr_fade_alpha(fade, x);
        columns->rate[i] = (float)wr_fade_slope(fade, x);
    }
    columns->points = columns->cell[grid->count_i - 1] + 2;
    WR_ASSERT(columns->points <= POINTS);
    uint32_t start = wr_lattice_hash_start(octave->noise.lattice.seed);
    uint32_t index = reduced_index(first, period);
    for (int k = 0; k < columns->points; k++) {
        columns->index[k] = index;
        columns->chain[k] = wr_lattice_hash_link(start, wr_lattice_hash_part(index, 0));
        index++;
        if (period && index == (uint32_t)period) index = 0;
    }
    double scale = wr_noise_perlin_scale(2);
    for (uint32_t k = 0; k < 16; k++)
        for (int a = 0; a < 2; a++)
            columns->set[k][a] = (float)(scale * wr_lattice_gradient(2, k << 28)[a]);
}

/* wr_lattice_number in float: exact. */
static inline float number(uint32_t h)
{
    return (float)(2 * (int32_t)(h >> 9) + 1) * 0x1p-23f - 1.0f;
}

static void fill_row_hashed(const WrNoise *noise, const Columns *columns, uint32_t y,
                            LatticeRow *row)
{
    uint32_t part = wr_lattice_hash_part(y, 1);
    int points = columns->points;
    if (noise->kind == WR_NOISE_PERLIN) {
        for (int k = 0; k < points; k++) {
            uint32_t h = wr_lattice_hash_link(columns->chain[k], part) >> 28;
            row->f[k] = 0.0f;
            row->gx[k] = columns->set[h][0];
            row->gy[k] = columns->set[h][1];
        }
        return;
    }
    float slope = noise->kind == WR_NOISE_GRADIENT ? 1.0f : 0.0f;
#pragma omp simd
    for (int k = 0; k < points; k++) {
        uint32_t h = wr_lattice_hash_link(columns->chain[k], part);
        row->f[k] = number(h);
        row->gx[k] = slope * number(wr_lattice_slope_hash(h, 0));
        row->gy[k] = slope * number(wr_lattice_slope_hash(h, 1));
    }
}

static void fill_row(const WrNoise *noise, const Columns *columns, double whole, LatticeRow *row)
{
    uint32_t y = reduced_index(whole, noise->lattice.period[1]);
    row->index = whole;
    if (noise->lattice.source == WR_LATTICE_HASH) {
        fill_row_hashed(noise, columns, y, row);
        return;
    }
    for (int k = 0; k < columns->points; k++) {
        double slope[2];
        row->f[k] = (float)wr_noise_prescribed(noise, (uint32_t[]){ columns->index[k], y }, slope);
        row->gx[k] = (float)slope[0];
        row->gy[k] = (float)slope[1];
    }
}

static void blend_rows(int points, const LatticeRow *near, const LatticeRow *far, float y,
                       float alpha, float rate, Blended *out)
{
#pragma omp simd
    for (int k = 0; k < points; k++) {
        float p = near->f[k] + near->gy[k] * y, q = far->f[k] + far->gy[k] * (y - 1.0f);
        float dx = far->gx[k] - near->gx[k];
        out->a[k] = p + alpha * (q - p);
        out->b[k] = near->gx[k] + alpha * dx;
        out->c[k] = near->gy[k] + alpha * (far->gy[k] - near->gy[k]) + rate * (q - p);
        out->d[k] = rate * dx;
    }
}

static void span_heights(const Columns *columns, const Blended *in, float *restrict f)
{
#pragma omp simd
    for (int i = 0; i < columns->count; i++) {
        int32_t k = columns->cell[i];
        float x = columns->x[i];
        float p = in->a[k] + in->b[k] * x, q = in->a[k + 1] + in->b[k + 1] * (x - 1.0f);
        f[i] = p + columns->alpha[i] * (q - p);
    }
}

static void span_slopes(const Columns *columns, const Blended *in, float *restrict fx,
                        float *restrict fy)
{
#pragma omp simd
    for (int i = 0; i < columns->count; i++) {
        int32_t k = columns->cell[i];
        float x = columns->x[i], alpha = columns->alpha[i], b0 = in->b[k], b1 = in->b[k + 1];
        float p = in->a[k] + b0 * x, q = in->a[k + 1] + b1 * (x - 1.0f);
        float py = in->c[k] + in->d[k] * x, qy = in->c[k + 1] + in->d[k + 1] * (x - 1.0f);
        fx[i] = b0 + alpha * (b1 - b0) + columns->rate[i] * (q - p);
        fy[i] = py + alpha * (qy - py);
    }
}

static void band_of_cells(const WrOctave *octave, const WrNoiseGrid *grid, bool slopes,
                          WrNoiseBand *band)
{
    const WrFadeInfo *fade = &wr_fades[octave->noise.fade];
    Columns columns;
    LatticeRow rows[2]; /* the lattice's even and odd rows */
    Blended blended;
    fill_columns(octave, grid, &columns);
    rows[0].index = rows[1].index = NAN;
    for (int j = 0; j < grid->count_j; j++) {
        double t = octave->frequency[1] * wr_noise_grid_v(grid, grid->j + j) + octave->offset[1];
        double whole = floor(t), y = t - whole;
        int odd = (int)((int64_t)whole & 1);
        LatticeRow *near = &rows[odd], *far = &rows[1 - odd];
        if (near->index != whole) fill_row(&octave->noise, &columns, whole, near);
        if (far->index != whole + 1.0) fill_row(&octave->noise, &columns, whole + 1.0, far);
        blend_rows(columns.points, near, far, (float)y, (float)wr_fade_alpha(fade, y),
                   (float)wr_fade_slope(fade, y), &blended);
        span_heights(&columns, &blended, band->f[j]);
        if (slopes) span_slopes(&columns, &blended, band->fx[j], band->fy[j]);
    }
}

/* Any kind: point by point. */
static void band_of_points(const WrOctave *octave, const WrNoiseGrid *grid, bool slopes,
                           WrNoiseBand *band)
{
    for (int j = 0; j < grid->count_j; j++)
        for (int i = 0; i < grid->count_i; i++) {
            double place[2] = { wr_noise_grid_u(grid, grid->i + i),
                                wr_noise_grid_v(grid, grid->j + j) };
            double t[2], slope[2];
            for (int a = 0; a < 2; a++) t[a] = octave->frequency[a] * place[a] + octave->offset[a];
            band->f[j][i] = (float)wr_noise_at(&octave->noise, t, slope);
            if (!slopes) continue;
            band->fx[j][i] = (float)slope[0];
            band->fy[j][i] = (float)slope[1];
        }
}

void wr_noise_band(const WrOctave *octave, const WrNoiseGrid *grid, bool slopes, WrNoiseBand *band)
{
    WR_ASSERT(grid->count_i <= WR_NOISE_STRIP && grid->count_j <= WR_NOISE_BAND);
    if (octave->frequency[0] <= grid->width && wr_noises[octave->noise.kind].cells)
        band_of_cells(octave, grid, slopes, band);
    else if (octave->frequency[0] <= grid->width && octave->noise.kind == WR_NOISE_SHEARED)
        wr_noise_band_sheared(octave, grid, slopes, band);
    else band_of_points(octave, grid, slopes, band);
}
