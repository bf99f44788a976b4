/* taps.h - the inner loop of narrow blurs (ops_blur.c), compiled once per instruction set. All sets give the
   same bits: only + - *, in the same order, without contraction.
   Layer 1, private to this room. */
#pragma once
#include <stddef.h>

#define WR_TAPS_STRIP                                                                              \
    64 /* of a row that filters along v, so that all rows stay in the nearest cache */

typedef struct WrTaps {
    const char *name; /* "v1", "v3", "v4": levels of x86-64; v1 is plain C everywhere */

    /* sum[i] = sum over k = 1..reach of weight[k] ((c[i - k step] + c[i + k step]) - 2 c[i]), nearest
     * taps first, for i = 0..count-1. c lies in rows with reach step floats before and after. */
    void (*add)(const float *weight, int reach, const float *c, ptrdiff_t step, int count,
                float *sum);
    /* The same, and c[i] added. */
    void (*smooth)(const float *weight, int reach, const float *c, ptrdiff_t step, int count,
                   float *out);
} WrTaps;

extern const WrTaps wr_taps_v1, wr_taps_v3, wr_taps_v4;

/* Those that this processor runs best. */
const WrTaps *wr_taps(void);

/* One after another for index = 0, 1, ...; NULL where this processor cannot run it, or there is none. */
const WrTaps *wr_taps_at(int index);
