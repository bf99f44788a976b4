/* filter_kernels.h - inner loops of blurs (ops_filter.c) and of the final step of all
   operations (ops_build.c), compiled once per instruction set.

   All sets give the same bits: only + - * and comparisons, in the same order, without contraction.
   Private to this module. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

#define WR_TAPS_LANES 16 /* texels of an element, filtered side by side: a cache line */

/* Rows (or columns) that boxes filter side by side: a vector of doubles, and the data of one piece of
 * work fits the second-level cache. */
#define WR_BOX_LANES 8

/* 2r + 1 texels of weight 1 and one more on either side of weight `end`. */
typedef struct WrBox {
    int r;
    double end, inverse; /* inverse: 1 / the sum of all weights */
} WrBox;

typedef struct WrTaps {
    const char *name; /* "v1", "v3", "v4": levels of x86-64; v1 is plain C everywhere */

    /* out[j] = sum over k = 1..reach of weight[k] ((c[j - k] + c[j + k]) - 2 c[j]), nearest taps first,
     * for j = 0..count-1. Elements are WR_TAPS_LANES floats, `step` floats apart in c, `to` in out.
     * `reach` more of them exist before and after. */
    void (*add)(const float *weight, int reach, const float *c, ptrdiff_t step, int count,
                float *out, ptrdiff_t to);
    /* The same sum plus c[j]. */
    void (*smooth)(const float *weight, int reach, const float *c, ptrdiff_t step, int count,
                   float *out, ptrdiff_t to);
    /* Transposes WR_TAPS_LANES rows of as many texels: out[y][x] = in[x][y]. */
    void (*turn)(const float *in, ptrdiff_t pitch, float *out, ptrdiff_t out_pitch);
    /* out[i] = box around in[i + r + 1], rounded to an integer, for i = 0 .. count - 1; elements are
     * WR_BOX_LANES integers below 2^51. */
    void (*box)(const WrBox *box, const double *in, int count, double *out);
    /* Conversion of texels to integer steps, one lane of a row; and blurred heights from the sum of two
     * boxes. */
    void (*to_steps)(double scale, const float *texels, int count, double *row);
    void (*add_steps)(double scale, double step, const double *both, int count, float *heights);
    /* Both conversions for WR_BOX_LANES adjacent texels. */
    void (*to_steps_across)(double scale, const float *texels, double *element);
    void (*add_steps_across)(double scale, double step, const double *both, float *heights);
    /* Compares new heights with the previous ones, `columns` in each of `rows`: clamps them to float's
     * range, and keeps the previous bits where the heights are equal or the new one is NaN. True if the
     * bits of any texel differ. */
    bool (*settle)(const float *before, size_t before_pitch, float *now, size_t pitch, int columns,
                   int rows);
} WrTaps;

extern const WrTaps wr_taps_v1, wr_taps_v3, wr_taps_v4;

/* The fastest table for this processor. */
const WrTaps *wr_taps(void);

/* Enumerates the tables, index = 0, 1, ...; NULL where this processor cannot run that one, or past the
 * last. */
const WrTaps *wr_taps_at(int index);
