/* filter_kernels.h - the inner loops of blurs (ops_blur.c, ops_blur_wide.c), and of what all operations end with (ops_build.c),
   compiled once per instruction set. All sets give the same bits: only + - * and comparisons, in the same order, without
   contraction.
   Private to this module. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

#define WR_TAPS_LANES 16 /* texels of an element, which are filtered side by side: a cache line */

/* Rows (or columns) that boxes filter side by side: a vector of doubles, where all that one piece of work holds
 * stays in the second cache. */
#define WR_BOX_LANES 8

/* 2r + 1 texels of weight 1 and one more on either side of weight `end`. */
typedef struct WrBox {
    int r;
    double end, inverse; /* the latter: 1 / the sum of all weights */
} WrBox;

typedef struct WrTaps {
    const char *name; /* "v1", "v3", "v4": levels of x86-64; v1 is plain C everywhere */

    /* out[j] = sum over k = 1..reach of weight[k] ((c[j - k] + c[j + k]) - 2 c[j]), nearest taps first, for
     * j = 0..count-1: of elements of WR_TAPS_LANES floats that lie `step` floats apart in c, `to` in out. There are
     * `reach` more of them before and after. */
    void (*add)(const float *weight, int reach, const float *c, ptrdiff_t step, int count,
                float *out, ptrdiff_t to);
    /* The same, and c[j] added. */
    void (*smooth)(const float *weight, int reach, const float *c, ptrdiff_t step, int count,
                   float *out, ptrdiff_t to);
    /* WR_TAPS_LANES rows of as many texels: out[y][x] = in[x][y]. */
    void (*turn)(const float *in, ptrdiff_t pitch, float *out, ptrdiff_t out_pitch);
    /* out[i] = box around in[i + r + 1], rounded to a whole number, for i = 0 .. count - 1; elements are
     * WR_BOX_LANES whole numbers below 2^51. */
    void (*box)(const WrBox *box, const double *in, int count, double *out);
    /* Texels to steps, whole numbers, one lane of a row; and the blurred height of the sum of two boxes. */
    void (*to_steps)(double scale, const float *texels, int count, double *row);
    void (*add_steps)(double scale, double step, const double *both, int count, float *heights);
    /* The same of WR_BOX_LANES texels that lie side by side. */
    void (*to_steps_across)(double scale, const float *texels, double *element);
    void (*add_steps_across)(double scale, double step, const double *both, float *heights);
    /* New heights beside what they were, `columns` of each of `rows`: within float's range, with the bits of before where
     * they are equal to that or no number. True if the bits of one differ. */
    bool (*settle)(const float *before, size_t before_pitch, float *now, size_t pitch, int columns,
                   int rows);
} WrTaps;

extern const WrTaps wr_taps_v1, wr_taps_v3, wr_taps_v4;

/* Those that this processor runs best. */
const WrTaps *wr_taps(void);

/* One after another for index = 0, 1, ...; NULL where this processor cannot run it, or there is none. */
const WrTaps *wr_taps_at(int index);
