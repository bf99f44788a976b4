/* bench_peak_body.h - the loop that finds how many sums of products a second a processor makes. Included once by each
   bench_peak_v*.c, which defines WR_PEAK_NAME.
   A header without a guard, by intention. */
#include "cli/bench_peak_inner.h"

/* Sixteen in a row on each number: what lies between is loaded and stored too seldom to count, and a processor works
   at several numbers' chains at once. */
#define FOUR(v) (v) = (v)*k + c, (v) = (v)*k + c, (v) = (v)*k + c, (v) = (v)*k + c

static void peak_sums(long rounds, float k, float c, float *x)
{
    for (long r = 0; r < rounds; r++) {
        _Pragma("omp simd") for (int i = 0; i < WR_PEAK_NUMBERS; i++)
        {
            float v = x[i];
            FOUR(v);
            FOUR(v);
            FOUR(v);
            FOUR(v);
            x[i] = v;
        }
    }
}

const WrPeakSums WR_PEAK_NAME = { peak_sums };
