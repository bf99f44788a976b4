#include "noise/noise_internal.h"

#include "base/error.h"

#include <math.h>

/* One octave of sheared noise over a piece of a grid: wr_noise_sheared's three corners, in float, with
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

static void fill_columns(const WrOctave *octave, const WrNoiseGrid *grid, Columns *columns)
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

static void fill_row(const WrNoise *noise, const Columns *columns, double v, LatticeRow *row)
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

#define SCALE 10.92f /* wr_noise_sheared's */

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

void wr_noise_band_sheared(const WrOctave *octave, const WrNoiseGrid *grid, bool slopes,
                           WrNoiseBand *band)
{
    Columns columns;
    LatticeRow rows[2]; /* the lattice's even and odd rows */
    Places places;
    fill_columns(octave, grid, &columns);
    rows[0].index = rows[1].index = NAN;
    for (int j = 0; j < grid->count_j; j++) {
        double t = octave->frequency[1] * wr_noise_grid_v(grid, grid->j + j) + octave->offset[1];
        double v = floor(t), y = t - v;
        int odd = (int)((int64_t)v & 1);
        LatticeRow *near = &rows[odd], *far = &rows[1 - odd];
        if (near->index != v) fill_row(&octave->noise, &columns, v, near);
        if (far->index != v + 1.0) fill_row(&octave->noise, &columns, v + 1.0, far);
        place_row(&columns, y, odd, &places);
        span_heights(&columns, &places, near, far, odd, (float)y, band->f[j]);
        if (slopes)
            span_slopes(&columns, &places, near, far, odd, (float)y, band->fx[j], band->fy[j]);
    }
}
