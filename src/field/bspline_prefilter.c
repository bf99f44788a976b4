/* The interpolating prefilter of the uniform cubic B-spline.
 *
 * The spline has the value (c[i-1] + 4 c[i] + c[i+1]) / 6 at sample i. The inverse of that filter on an
 * infinite (or circular) row is c[i] = sqrt(3) sum over k of z^|k| T[i+k] with z = sqrt(3) - 2 =
 * -0.268. It is truncated where z^|k| falls below double's rounding (z^29 = 2.6e-17). So an edit
 * affects only WR_PREFILTER_REACH texels on each side, and a coefficient does not depend on the
 * rectangle that was read.
 *
 * A chunk of columns is processed from top to bottom: each table row is filtered along u into a ring of
 * rows, and each output row is the same filter across the ring. */
#include "field/scheme.h"

#include "base/memory.h"
#include "field/field.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define REACH WR_PREFILTER_REACH
#define TAPS (2 * REACH + 1)
#define CHUNK 512 /* columns; the ring (230 kB) stays in the second-level cache */

typedef struct Fit {
    double weight[REACH + 1];
    int width;     /* columns of a chunk: at most CHUNK */
    float *texels; /* [width + 2 REACH] one row as read, */
    double *wide;  /* and converted to double */
    double *ring;  /* [TAPS][width] row j is in slot (j - first row) % TAPS */
    double *sum;   /* [width] */
} Fit;

/* One allocation for all buffers: fitting 4 x 4 texels should not be dominated by allocation. */
static Fit *fit_new(int width)
{
    size_t across = (size_t)width + 2 * REACH;
    size_t doubles = across + (size_t)width * (TAPS + 1);
    Fit *fit = wr_alloc(1, sizeof *fit + doubles * sizeof(double) + across * sizeof(float));
    fit->width = width;
    fit->wide = (double *)(fit + 1);
    fit->ring = fit->wide + across;
    fit->sum = fit->ring + (size_t)width * TAPS;
    fit->texels = (float *)(fit->sum + width);
    double root = sqrt(3.0), w = root;
    for (int k = 0; k <= REACH; k++, w *= root - 2.0) fit->weight[k] = w;
    return fit;
}

static double *ring_row(Fit *fit, int j)
{
    return fit->ring + (size_t)(j % TAPS) * (size_t)fit->width;
}

/* Two sums side by side, with the bits of scalar sums on every processor. */
typedef double Two __attribute__((vector_size(2 * sizeof(double))));
#define SIDE 8 /* sums at a time, kept in registers */

static inline Two load(const double *from)
{
    Two two;
    memcpy(&two, from, sizeof two);
    return two;
}

/* sum[i] = centre[i] + sum over k, from 1 outwards, of weight[k] (below[k][i] + above[k][i] - 2
   centre[i]), centre = below[0]. The weights sum to 1, so each coefficient of a flat row equals its
   level to the bit (HC47), and a high level costs no precision of the details on it. */
static void fold(const Fit *fit, const double *const below[REACH + 1],
                 const double *const above[REACH + 1], int count, double *restrict sum)
{
    const double *weight = fit->weight;
    int i = 0;
    for (; i + SIDE <= count; i += SIDE) {
        Two part[SIDE / 2], twice[SIDE / 2];
        for (int n = 0; n < SIDE / 2; n++) {
            part[n] = load(below[0] + i + 2 * n);
            twice[n] = part[n] + part[n];
        }
        for (int k = 1; k <= REACH; k++) {
            const double *low = below[k] + i, *high = above[k] + i;
            part[0] += weight[k] * (load(low) + load(high) - twice[0]);
            part[1] += weight[k] * (load(low + 2) + load(high + 2) - twice[1]);
            part[2] += weight[k] * (load(low + 4) + load(high + 4) - twice[2]);
            part[3] += weight[k] * (load(low + 6) + load(high + 6) - twice[3]);
        }
        memcpy(sum + i, part, sizeof part);
    }
    for (; i < count; i++) {
        const double centre = below[0][i];
        double part = centre;
        for (int k = 1; k <= REACH; k++)
            part += weight[k] * (below[k][i] + above[k][i] - (centre + centre));
        sum[i] = part;
    }
}

/* Filters table row j, columns i .. i + count - 1, along u. */
static void fit_row(Fit *fit, const WrField *field, int i, int j, int count, double *out)
{
    const double *below[REACH + 1], *above[REACH + 1];
    wr_field_read(field, i - REACH, j, count + 2 * REACH, 1, fit->texels, 0);
    for (int k = 0; k < count + 2 * REACH; k++) fit->wide[k] = fit->texels[k];
    for (int k = 0; k <= REACH; k++) {
        below[k] = fit->wide + REACH - k;
        above[k] = fit->wide + REACH + k;
    }
    fold(fit, below, above, count, out);
}

/* Filters across the ring, rows middle - REACH .. middle + REACH, into fit->sum. */
static void fit_columns(Fit *fit, int middle, int count)
{
    const double *below[REACH + 1], *above[REACH + 1];
    for (int k = 0; k <= REACH; k++) {
        below[k] = ring_row(fit, middle - k);
        above[k] = ring_row(fit, middle + k);
    }
    fold(fit, below, above, count, fit->sum);
}

/* Destination of the coefficients: one of the two. */
typedef struct Out {
    float *single;
    double *wide;
} Out;

static void put(Out out, size_t at, const double *sum, int count)
{
    if (out.wide) {
        memcpy(out.wide + at, sum, (size_t)count * sizeof *sum);
        return;
    }
    for (int k = 0; k < count; k++) {
        double c = sum[k] > FLT_MAX ? FLT_MAX : sum[k];
        out.single[at + (size_t)k] = (float)(c < -FLT_MAX ? -FLT_MAX : c);
    }
}

static void read_fitted(const WrField *field, int i, int j, int count_i, int count_j, Out out,
                        size_t pitch)
{
    if (count_i <= 0 || count_j <= 0) return;
    Fit *fit = fit_new(count_i < CHUNK ? count_i : CHUNK);
    for (int col = 0; col < count_i; col += CHUNK) {
        int cols = count_i - col < CHUNK ? count_i - col : CHUNK;
        for (int row = 0; row < count_j + 2 * REACH; row++) {
            fit_row(fit, field, i + col, j - REACH + row, cols, ring_row(fit, row));
            int ready = row - 2 * REACH; /* this output row has all its input rows in the ring */
            if (ready < 0) continue;
            fit_columns(fit, ready + REACH, cols);
            put(out, (size_t)ready * pitch + (size_t)col, fit->sum, cols);
        }
    }
    wr_free(fit);
}

void wr_field_read_fitted(const WrField *field, int i, int j, int count_i, int count_j, float *out,
                          size_t pitch)
{
    read_fitted(field, i, j, count_i, count_j, (Out){ .single = out }, pitch);
}

void wr_field_read_fitted_double(const WrField *field, int i, int j, int count_i, int count_j,
                                 double *out, size_t pitch)
{
    read_fitted(field, i, j, count_i, count_j, (Out){ .wide = out }, pitch);
}
