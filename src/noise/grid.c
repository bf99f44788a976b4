#include "noise/grid.h"

#include "base/error.h"
#include "noise/octave_kernels.h"

#include <math.h>

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

/* The contribution of an octave in the modes other than ridged. */
static WrNoiseShare share_of(WrOctavesMode mode, float amplitude)
{
    bool billow = mode == WR_OCTAVES_BILLOW;
    return (WrNoiseShare){ .factor = billow ? 2.0f * amplitude : amplitude,
                           .below = billow ? amplitude : 0.0f,
                           .magnitude = mode != WR_OCTAVES_FBM };
}

/* The factor has the sign of f if |f| is added. */
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

/* dS = dw h^2 - 2 w h sign(f) df,  h = offset - |f|; computed before the weight is updated. */
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

/* Fills one piece with all octaves, in order. */
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
        if (plain && wr_noise_sum(&plan->octave[k], grid, share, f, pitch)) continue;
        wr_noise_band(&plan->octave[k], grid, fu != NULL, &band);
        for (int j = 0; j < grid->count_j; j++) add_row(plan, &plan->octave[k], &band, j, &rows[j]);
    }
}

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

void wr_octaves_warped_grid(const WrOctavesPlan *plan, const WrOctavesPlan *const *warp,
                            double amount, const WrNoiseGrid *grid, float *f, float *fu, float *fv,
                            size_t pitch)
{
    for (int j = 0; j < grid->count_j; j++)
        for (int i = 0; i < grid->count_i; i++) {
            double p[2] = { wr_noise_grid_u(grid, grid->i + i),
                            wr_noise_grid_v(grid, grid->j + j) };
            double slope[2];
            size_t at = (size_t)j * pitch + (size_t)i;
            f[at] = (float)wr_octaves_warped_at(plan, warp, amount, p, slope);
            if (fu) fu[at] = (float)slope[0];
            if (fv) fv[at] = (float)slope[1];
        }
}
