/* bench_peak_inner.h - the multiply-add loop compiled for each level of x86-64. Private to bench_peak*.c. */
#pragma once

#define WR_PEAK_NUMBERS 256
#define WR_PEAK_SUMS 16 /* operations on each number in a round */

typedef struct WrPeakSums {
    /* Repeat `rounds` times: x = x k + c, WR_PEAK_SUMS times on each of x's WR_PEAK_NUMBERS. */
    void (*run)(long rounds, float k, float c, float *x);
} WrPeakSums;

extern const WrPeakSums wr_peak_v1, wr_peak_v3, wr_peak_v4;
