#include "noise/texel_grid.h"

#include "base/error.h"
#include "noise/noise_internal.h"
#include "noise/octave_kernels.h"

#include <math.h>
#include <string.h>

/* noise_band for sheared noise of at most one cell per texel along x. */
static void noise_band_sheared(const WrOctave *octave, const WrNoiseGrid *grid, bool slopes,
                               WrNoiseBand *band);

/* ---- octave ---- */

/* A grid is filled in pieces of WR_NOISE_STRIP x WR_NOISE_BAND texels, and each piece octave by octave, so
   that its arrays stay in the first-level cache. On square cells a column's fraction, fade and lattice index
   do not depend on the row; they are computed once per piece. A row then needs two rows of lattice data
   (hashed once for all texel rows between them), a blend along y at each lattice point, and a blend along x at
   each texel. */

/* One octave over a piece of a grid (texel_grid.h), using the loops of octave_kernels.h. */

static uint32_t reduced_index(double whole, int period)
{
    return (uint32_t)(int64_t)wr_noise_reduce(whole, period);
}

/* chain[k] is the hash of seed and x: a lattice row adds one link for y.
   Positions are computed in double and only the fraction, 0..1, is converted to float (HC61). `narrow`: a
   texel is at most half a cell, so that neighbouring texels use the same or adjacent lattice points. */
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

/* Prescribed values and slopes of lattice row y. From the hash by a vector kernel; other sources point by
   point. */
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
        row->f[k] =
            (float)wr_noise_lattice_value(noise, (uint32_t[]){ columns->index[k], y }, slope);
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

/* The lattice rows on either side of texel row j.
   Rows are visited in ascending order, so of the two lattice rows at most one is new. Even and odd rows have
   fixed places: the far row of one cell is the near row of the next without a copy. */
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

/* Blending y first costs one blend per lattice point and component; then each texel blends two points. The
   order of additions differs from wr_noise_at, which works in double: results agree to float rounding only. */
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

/* Adds one octave over a piece to n. False, without any change, if there is no fast path.
   The fast path for heights only: the octave is blended, weighted and added in one pass, for all texel rows of
   a cell row at once. */
static bool noise_sum(const WrOctave *octave, const WrNoiseGrid *grid, WrNoiseShare share, float *n,
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

/* grid: at most a piece. Without slopes, fx and fy are unchanged.
   Finer octaves than one cell per texel would need more lattice points than a strip has room for; they go
   point by point. Such octaves are above the sampling limit anyway (HC62). */
static void noise_band(const WrOctave *octave, const WrNoiseGrid *grid, bool slopes,
                       WrNoiseBand *band)
{
    WR_ASSERT(grid->count_i <= WR_NOISE_STRIP && grid->count_j <= WR_NOISE_BAND);
    if (octave->frequency[0] <= grid->width && wr_noises[octave->noise.kind].cells)
        band_of_cells(octave, grid, slopes, band);
    else if (octave->frequency[0] <= grid->width && octave->noise.kind == WR_NOISE_SHEARED)
        noise_band_sheared(octave, grid, slopes, band);
    else band_of_points(octave, grid, slopes, band);
}

/* ---- sheared ---- */

/* One octave of sheared noise over a piece of a grid: noise_sheared's three corners, in float, with
   the lattice's rows hashed once for all texel rows between two of them. In row v of the lattice points
   are at integer x, shifted right by half a cell for odd v: point m of a LatticeRow is at x = first + m
   (+ 1/2), which is u0 = x + v/2 in the sheared coordinate. So corner (u0, v) is point u0 - ceil(v/2) -
   first of its row. */

/* At most one cell per texel: a cell for each, and on either side the reach of the shear and the
 * corners. */
#define POINTS (WR_NOISE_STRIP + 16)
#define MARGIN 2 /* cells to the left of the first texel's */

typedef struct Columns {
    int count;                   /* texels */
    int points;                  /* lattice points of a row */
    double cell[WR_NOISE_STRIP]; /* floor of the position along x, from `first` */
    double x[WR_NOISE_STRIP];    /* its fraction */
    uint32_t chain[2][POINTS];   /* partial hash including 2x, for even and odd rows */
    float set[16][2];            /* the set of slopes */
} Columns;

typedef struct LatticeRow {
    double index; /* v, not reduced; NaN: empty */
    float gx[POINTS], gy[POINTS];
} LatticeRow;

/* Data of a row of texels for each column: the lower left corner of its unit square, and the distance
 * from it. */
typedef struct Places {
    int32_t near[WR_NOISE_STRIP]; /* point of the near row */
    float u[WR_NOISE_STRIP];      /* fraction of the sheared coordinate */
} Places;

/* The chain is hashed of twice x, because odd rows have points at half-integers; the period in x is 2 P then. */
static void fill_columns_sheared(const WrOctave *octave, const WrNoiseGrid *grid, Columns *columns)
{
    const WrLattice *lattice = &octave->noise.lattice;
    double first = 0.0;
    columns->count = grid->count_i;
    for (int i = 0; i < grid->count_i; i++) {
        double t = octave->frequency[0] * wr_noise_grid_u(grid, grid->i + i) + octave->offset[0];
        double whole = floor(t);
        if (i == 0) first = whole - MARGIN;
        columns->cell[i] = whole - first;
        columns->x[i] = t - whole;
    }
    columns->points = (int)columns->cell[grid->count_i - 1] + 4;
    WR_ASSERT(columns->points <= POINTS);
    uint32_t start = wr_lattice_hash_start(lattice->seed);
    for (int odd = 0; odd < 2; odd++)
        for (int m = 0; m < columns->points; m++) {
            double twice = wr_noise_reduce(2.0 * (first + m) + odd, 2.0 * lattice->period[0]);
            uint32_t part = wr_lattice_hash_part((uint32_t)(int64_t)twice, 0);
            columns->chain[odd][m] = wr_lattice_hash_link(start, part);
        }
    for (uint32_t k = 0; k < 16; k++)
        for (int a = 0; a < 2; a++) columns->set[k][a] = (float)wr_lattice_gradient(2, k << 28)[a];
}

static void fill_row_sheared(const WrNoise *noise, const Columns *columns, double v,
                             LatticeRow *row)
{
    int odd = (int)((int64_t)v & 1);
    double reduced = wr_noise_reduce(v, noise->lattice.period[1]);
    uint32_t part = wr_lattice_hash_part((uint32_t)(int64_t)reduced, 1);
    row->index = v;
    for (int m = 0; m < columns->points; m++) {
        uint32_t h = wr_lattice_hash_link(columns->chain[odd][m], part) >> 28;
        row->gx[m] = columns->set[h][0];
        row->gy[m] = columns->set[h][1];
    }
}

/* The sheared coordinate from the near row's first point on: position + y/2 with y from v, minus half a
 * cell if v is odd and its points are shifted right. The far row's point above the same corner is one
 * further left if v is even, and has the same index if it is odd. */
static void place_row(const Columns *columns, double y, int odd, Places *places)
{
    double shift = 0.5 * y - 0.5 * odd;
#pragma omp simd
    for (int i = 0; i < columns->count; i++) {
        double u = columns->x[i] + shift, whole = floor(u);
        places->near[i] = (int32_t)(columns->cell[i] + whole);
        places->u[i] = (float)(u - whole);
    }
}

/* m of a corner's term m^4 (g . x): max(0, 4/5 - x^2 - y^2). */
static inline float part_m(float x, float y)
{
    float m = 0.8f - (x * x + y * y);
    return m > 0.0f ? m : 0.0f;
}

#define SCALE 10.92f /* noise_sheared's */

/* Corner 0 is (u0, v), corner 2 (u0 + 1, v + 1), corner 1 the lower right one if u >= y, else the upper left
   one. x = u - y/2 undoes the shear, so that distances are those of the plane. */
static void span_heights(const Columns *columns, const Places *places, const LatticeRow *near,
                         const LatticeRow *far, int odd, float y, float *restrict f)
{
#pragma omp simd
    for (int i = 0; i < columns->count; i++) {
        float u = places->u[i], x0 = u - 0.5f * y, x2 = x0 - 0.5f;
        int32_t k0 = places->near[i], k2 = k0 + odd;
        int32_t right = u >= y;
        float x1 = right ? x0 - 1.0f : x0 + 0.5f, y1 = right ? y : y - 1.0f;
        float g1x = right ? near->gx[k0 + 1] : far->gx[k2 - 1];
        float g1y = right ? near->gy[k0 + 1] : far->gy[k2 - 1];
        float m0 = part_m(x0, y), m1 = part_m(x1, y1), m2 = part_m(x2, y - 1.0f);
        m0 *= m0, m1 *= m1, m2 *= m2;
        float sum = m0 * m0 * (near->gx[k0] * x0 + near->gy[k0] * y) +
                    m1 * m1 * (g1x * x1 + g1y * y1) +
                    m2 * m2 * (far->gx[k2] * x2 + far->gy[k2] * (y - 1.0f));
        f[i] = SCALE * sum;
    }
}

/* m^4 g - 8 m^3 (g . x) x */
static inline float part_slope(float m, float dot, float g, float x)
{
    float m3 = m * m * m;
    return m3 * (m * g - 8.0f * dot * x);
}

static void span_slopes(const Columns *columns, const Places *places, const LatticeRow *near,
                        const LatticeRow *far, int odd, float y, float *restrict fx,
                        float *restrict fy)
{
    float y2 = y - 1.0f;
#pragma omp simd
    for (int i = 0; i < columns->count; i++) {
        float u = places->u[i], x0 = u - 0.5f * y, x2 = x0 - 0.5f;
        int32_t k0 = places->near[i], k2 = k0 + odd;
        int32_t right = u >= y;
        float x1 = right ? x0 - 1.0f : x0 + 0.5f, y1 = right ? y : y2;
        float g1x = right ? near->gx[k0 + 1] : far->gx[k2 - 1];
        float g1y = right ? near->gy[k0 + 1] : far->gy[k2 - 1];
        float m0 = part_m(x0, y), m1 = part_m(x1, y1), m2 = part_m(x2, y2);
        float dot0 = near->gx[k0] * x0 + near->gy[k0] * y, dot1 = g1x * x1 + g1y * y1;
        float dot2 = far->gx[k2] * x2 + far->gy[k2] * y2;
        fx[i] = SCALE * (part_slope(m0, dot0, near->gx[k0], x0) + part_slope(m1, dot1, g1x, x1) +
                         part_slope(m2, dot2, far->gx[k2], x2));
        fy[i] = SCALE * (part_slope(m0, dot0, near->gy[k0], y) + part_slope(m1, dot1, g1y, y1) +
                         part_slope(m2, dot2, far->gy[k2], y2));
    }
}

/* noise_band for sheared noise of at most one cell per texel along x. */
static void noise_band_sheared(const WrOctave *octave, const WrNoiseGrid *grid, bool slopes,
                               WrNoiseBand *band)
{
    Columns columns;
    LatticeRow rows[2]; /* the lattice's even and odd rows */
    Places places;
    fill_columns_sheared(octave, grid, &columns);
    rows[0].index = rows[1].index = NAN;
    for (int j = 0; j < grid->count_j; j++) {
        double t = octave->frequency[1] * wr_noise_grid_v(grid, grid->j + j) + octave->offset[1];
        double v = floor(t), y = t - v;
        int odd = (int)((int64_t)v & 1);
        LatticeRow *near = &rows[odd], *far = &rows[1 - odd];
        if (near->index != v) fill_row_sheared(&octave->noise, &columns, v, near);
        if (far->index != v + 1.0) fill_row_sheared(&octave->noise, &columns, v + 1.0, far);
        place_row(&columns, y, odd, &places);
        span_heights(&columns, &places, near, far, odd, (float)y, band->f[j]);
        if (slopes)
            span_slopes(&columns, &places, near, far, odd, (float)y, band->fx[j], band->fy[j]);
    }
}

/* Output of one row of a piece, and the ridge state that is carried from octave to octave. */
typedef struct Row {
    int count;
    float *n, *nu, *nv; /* owned by the caller; nu, nv NULL if not wanted */
    float *w, *wu, *wv; /* ridged: the weight of the next octave, and its slopes */
} Row;

typedef struct Weights {
    float w[WR_NOISE_BAND][WR_NOISE_STRIP];
    float wu[WR_NOISE_BAND][WR_NOISE_STRIP], wv[WR_NOISE_BAND][WR_NOISE_STRIP];
} Weights;

static inline float sign(float f)
{
    return (f > 0.0f ? 1.0f : 0.0f) - (f < 0.0f ? 1.0f : 0.0f);
}

/* The contribution of an octave in the modes other than ridged.
   Billow adds 2 |f| - 1 per octave, turbulence |f|, fBm f (L6). */
static WrNoiseShare share_of(WrOctavesMode mode, float amplitude)
{
    bool billow = mode == WR_OCTAVES_BILLOW;
    return (WrNoiseShare){ .factor = billow ? 2.0f * amplitude : amplitude,
                           .below = billow ? amplitude : 0.0f,
                           .magnitude = mode != WR_OCTAVES_FBM };
}

/* The factor has the sign of f if |f| is added.
   Turbulence has a crease where f = 0; its slope there uses sign(0) = 0 (HC65). */
static void add_heights(WrOctavesMode mode, float amplitude, const float *f, const Row *row)
{
    const WrNoiseKernels *kern = wr_noise_kernels();
    WrNoiseShare share = share_of(mode, amplitude);
    if (share.magnitude) kern->add_magnitude(share.factor, share.below, f, row->count, row->n);
    else kern->add(share.factor, f, row->count, row->n);
}

static void add_slopes(WrOctavesMode mode, float amplitude, float frequency,
                       const float *restrict f, const float *restrict fa, int count,
                       float *restrict na)
{
    float factor = (mode == WR_OCTAVES_BILLOW ? 2.0f * amplitude : amplitude) * frequency;
    if (mode == WR_OCTAVES_FBM) {
#pragma omp simd
        for (int i = 0; i < count; i++) na[i] += factor * fa[i];
        return;
    }
#pragma omp simd
    for (int i = 0; i < count; i++) na[i] += factor * sign(f[i]) * fa[i];
}

/* dS = dw h^2 - 2 w h sign(f) df,  h = offset - |f|; computed before the weight is updated.
   S = w h^2 is the octave's signal and min(1, gain S) the next weight. Where it saturates the weight's slope
   is 0. `frequency` is the chain rule: f and its slopes are by lattice cells, n by the table's u or v. u and v
   are added apart, but before add_ridge_heights replaces w. */
static void add_ridge_slopes(const WrOctavesPlan *plan, float amplitude, float frequency,
                             const float *restrict f, const float *restrict fa, const Row *row,
                             float *restrict na, float *restrict wa)
{
    float offset = (float)plan->ridge_offset, gain = (float)plan->ridge_gain;
    const float *w = row->w;
#pragma omp simd
    for (int i = 0; i < row->count; i++) {
        float h = offset - fabsf(f[i]);
        float ds = wa[i] * (h * h) - 2.0f * w[i] * h * sign(f[i]) * (frequency * fa[i]);
        na[i] += amplitude * ds;
        wa[i] = gain * (w[i] * (h * h)) < 1.0f ? gain * ds : 0.0f;
    }
}

static void add_ridge_heights(const WrOctavesPlan *plan, float amplitude, const float *restrict f,
                              const Row *row)
{
    float offset = (float)plan->ridge_offset, gain = (float)plan->ridge_gain;
    float *restrict n = row->n, *restrict w = row->w;
#pragma omp simd
    for (int i = 0; i < row->count; i++) {
        float h = offset - fabsf(f[i]), signal = w[i] * (h * h), next = gain * signal;
        n[i] += amplitude * signal;
        w[i] = next < 1.0f ? next : 1.0f;
    }
}

static void add_row(const WrOctavesPlan *plan, const WrOctave *octave, const WrNoiseBand *band,
                    int j, const Row *row)
{
    float amplitude = (float)octave->amplitude;
    float frequency[2] = { (float)octave->frequency[0], (float)octave->frequency[1] };
    if (plan->mode == WR_OCTAVES_RIDGED) {
        if (row->nu) {
            add_ridge_slopes(plan, amplitude, frequency[0], band->f[j], band->fx[j], row, row->nu,
                             row->wu);
            add_ridge_slopes(plan, amplitude, frequency[1], band->f[j], band->fy[j], row, row->nv,
                             row->wv);
        }
        add_ridge_heights(plan, amplitude, band->f[j], row);
        return;
    }
    add_heights(plan->mode, amplitude, band->f[j], row);
    if (!row->nu) return;
    add_slopes(plan->mode, amplitude, frequency[0], band->f[j], band->fx[j], row->count, row->nu);
    add_slopes(plan->mode, amplitude, frequency[1], band->f[j], band->fy[j], row->count, row->nv);
}

static void start_row(const Row *row, bool ridged)
{
    for (int i = 0; i < row->count; i++) row->n[i] = 0.0f;
    for (int i = 0; ridged && i < row->count; i++) row->w[i] = 1.0f;
    for (int i = 0; row->nu && i < row->count; i++)
        row->nu[i] = row->nv[i] = row->wu[i] = row->wv[i] = 0.0f;
}

/* Fills one piece with all octaves, in order.
   The octaves' order is that of the plan: sums of floats depend on it, and the result must be the same for
   each piece. */
static void fill_piece(const WrOctavesPlan *plan, const WrNoiseGrid *grid, float *f, float *fu,
                       float *fv, size_t pitch)
{
    WrNoiseBand band;
    Weights weights;
    Row rows[WR_NOISE_BAND];
    for (int j = 0; j < grid->count_j; j++) {
        size_t at = (size_t)j * pitch;
        rows[j] = (Row){ grid->count_i, f + at,        fu ? fu + at : NULL, fv ? fv + at : NULL,
                         weights.w[j],  weights.wu[j], weights.wv[j] };
        start_row(&rows[j], plan->mode == WR_OCTAVES_RIDGED);
    }
    bool plain = !fu && plan->mode != WR_OCTAVES_RIDGED; /* heights only, octaves simply added */
    for (int k = 0; k < plan->used; k++) {
        WrNoiseShare share = share_of(plan->mode, (float)plan->octave[k].amplitude);
        if (plain && noise_sum(&plan->octave[k], grid, share, f, pitch)) continue;
        noise_band(&plan->octave[k], grid, fu != NULL, &band);
        for (int j = 0; j < grid->count_j; j++) add_row(plan, &plan->octave[k], &band, j, &rows[j]);
    }
}

/* Pieces are cut at multiples from grid->i, not of the table: a texel's result must not depend on the piece it
   falls in. It does not, since each texel computes its position from its own index. */
void wr_octaves_grid(const WrOctavesPlan *plan, const WrNoiseGrid *grid, float *f, float *fu,
                     float *fv, size_t pitch)
{
    WR_ASSERT(plan->dim == 2 && !fu == !fv && grid->i >= 0 && grid->j >= 0);
    WR_ASSERT(grid->i + grid->count_i <= grid->width && grid->j + grid->count_j <= grid->height);
    for (int j = 0; j < grid->count_j; j += WR_NOISE_BAND)
        for (int i = 0; i < grid->count_i; i += WR_NOISE_STRIP) {
            WrNoiseGrid piece = *grid;
            size_t at = (size_t)j * pitch + (size_t)i;
            piece.i += i;
            piece.j += j;
            if (piece.count_i - i < WR_NOISE_STRIP) piece.count_i -= i;
            else piece.count_i = WR_NOISE_STRIP;
            if (piece.count_j - j < WR_NOISE_BAND) piece.count_j -= j;
            else piece.count_j = WR_NOISE_BAND;
            fill_piece(plan, &piece, f + at, fu ? fu + at : NULL, fv ? fv + at : NULL, pitch);
        }
}

void wr_octaves_scale(double level, double amplitude, int count, float *f)
{
    wr_noise_kernels()->scale(level, amplitude, count, f);
}
