#include "noise/octave_kernels.h"

#include "base/error.h"

#include <math.h>
#include <string.h>

/* One octave over a piece of a grid (grid.h), using the loops of octave_kernels.h. */

static uint32_t reduced_index(double whole, int period)
{
    return (uint32_t)(int64_t)wr_noise_reduce(whole, period);
}

static void fill_columns(const WrNoiseKernels *kern, const WrOctave *octave,
                         const WrNoiseGrid *grid, WrNoiseColumns *columns)
{
    int period = octave->noise.lattice.period[0];
    columns->count = grid->count_i;
    columns->narrow = 2.0 * octave->frequency[0] <= grid->width;
    kern->place(&wr_fades[octave->noise.fade], octave->frequency[0], octave->offset[0], grid->i,
                grid->width, columns);
    columns->points = columns->cell[grid->count_i - 1] + 2;
    WR_ASSERT(columns->points <= WR_NOISE_POINTS - WR_NOISE_BLOCK);
    uint32_t start = wr_lattice_hash_start(octave->noise.lattice.seed);
    uint32_t index = reduced_index(columns->first, period);
    for (int k = 0; k < columns->points; k++) {
        columns->index[k] = index;
        columns->chain[k] = wr_lattice_hash_link(start, wr_lattice_hash_part(index, 0));
        index++;
        if (period && index == (uint32_t)period) index = 0;
    }
    if (octave->noise.kind != WR_NOISE_PERLIN) return;
    double scale = wr_noise_perlin_scale(2);
    for (uint32_t k = 0; k < 16; k++)
        for (int a = 0; a < 2; a++)
            columns->set[a][k] = (float)(scale * wr_lattice_gradient(2, k << 28)[a]);
}

static void fill_row(const WrNoiseKernels *kern, const WrNoise *noise,
                     const WrNoiseColumns *columns, double whole, WrNoiseLattice *row)
{
    uint32_t y = reduced_index(whole, noise->lattice.period[1]);
    row->index = whole;
    if (noise->lattice.source == WR_LATTICE_HASH) {
        kern->prescribe(noise->kind, columns, wr_lattice_hash_part(y, 1), row);
        return;
    }
    for (int k = 0; k < columns->points; k++) {
        double slope[2];
        row->f[k] = (float)wr_noise_prescribed(noise, (uint32_t[]){ columns->index[k], y }, slope);
        row->gx[k] = (float)slope[0];
        row->gy[k] = (float)slope[1];
    }
}

/* State of one octave on square cells: rows of texels in order, and the two lattice rows around them. */
typedef struct Cells {
    const WrNoiseKernels *kern;
    const WrOctave *octave;
    WrNoiseColumns columns;
    WrNoiseRows rows;
    WrNoiseLattice lattice[2]; /* the even and the odd row */
} Cells;

static void begin_cells(Cells *cells, const WrOctave *octave, const WrNoiseGrid *grid)
{
    cells->kern = wr_noise_kernels();
    cells->octave = octave;
    memset(cells->lattice, 0, sizeof cells->lattice); /* kernels read whole vectors */
    cells->lattice[0].index = cells->lattice[1].index = NAN;
    fill_columns(cells->kern, octave, grid, &cells->columns);
    cells->rows.count = grid->count_j;
    cells->kern->stand(&wr_fades[octave->noise.fade], octave->frequency[1], octave->offset[1],
                       grid->j, grid->height, &cells->rows);
}

/* The lattice rows on either side of texel row j. */
static void enclose(Cells *cells, int j, const WrNoiseLattice **near, const WrNoiseLattice **far)
{
    double whole = cells->rows.whole[j];
    int odd = (int)((int64_t)whole & 1);
    WrNoiseLattice *below = &cells->lattice[odd], *above = &cells->lattice[1 - odd];
    const WrNoise *noise = &cells->octave->noise;
    if (below->index != whole) fill_row(cells->kern, noise, &cells->columns, whole, below);
    if (above->index != whole + 1.0)
        fill_row(cells->kern, noise, &cells->columns, whole + 1.0, above);
    *near = below;
    *far = above;
}

static void band_of_cells(const WrOctave *octave, const WrNoiseGrid *grid, bool slopes,
                          WrNoiseBand *band)
{
    Cells cells;
    WrNoiseBlended blended = { .a = { 0 } };
    begin_cells(&cells, octave, grid);
    const WrNoiseRows *rows = &cells.rows;
    for (int j = 0; j < grid->count_j; j++) {
        const WrNoiseLattice *near, *far;
        enclose(&cells, j, &near, &far);
        cells.kern->blend(cells.columns.points, near, far, rows->y[j], rows->alpha[j],
                          rows->rate[j], &blended);
        cells.kern->heights(&cells.columns, &blended, band->f[j]);
        if (slopes) cells.kern->slopes(&cells.columns, &blended, band->fx[j], band->fy[j]);
    }
}

bool wr_noise_sum(const WrOctave *octave, const WrNoiseGrid *grid, WrNoiseShare share, float *n,
                  size_t pitch)
{
    if (!wr_noises[octave->noise.kind].cells || 2.0 * octave->frequency[0] > grid->width)
        return false;
    Cells cells;
    begin_cells(&cells, octave, grid);
    const double *whole = cells.rows.whole;
    for (int j = 0, count; j < grid->count_j; j += count) {
        const WrNoiseLattice *near, *far;
        enclose(&cells, j, &near, &far);
        for (count = 1; j + count < grid->count_j && whole[j + count] == whole[j];) count++;
        cells.kern->sum(&cells.columns, near, far, &cells.rows, j, count, share,
                        n + (size_t)j * pitch, pitch);
    }
    return true;
}

/* Evaluates any kind of noise point by point. */
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
