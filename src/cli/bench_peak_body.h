/* bench_peak_body.h - the multiply-add loop that measures peak arithmetic. Included once by each bench_peak_v*.c,
   which defines WR_PEAK_NAME; intentionally without an include guard. */
#include "cli/bench_peak_inner.h"

/* Sixteen dependent operations per number: loads and stores between them are then negligible, and the processor
   overlaps the chains of several numbers. */
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
