/* peak.h - peak arithmetic and copy rates of this machine, for comparison with rendering. Measured with the threads of
   the pool; the best of several rounds. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrPool WrPool;

#define WR_PEAK_BUILDS 3
#define WR_PEAK_LEVELS 3

typedef struct WrPeaks {
    /* GFLOP/s of x k + c in single precision, counted as two operations; 0: not supported by this processor. */
    double gflops[WR_PEAK_BUILDS];
    /* GB/s of copies; bytes read and bytes written both count. */
    double gbytes[WR_PEAK_LEVELS];
    double bytes[WR_PEAK_LEVELS]; /* source and copy together, per thread */
} WrPeaks;

extern const char *const wr_peak_builds[WR_PEAK_BUILDS]; /* "v1", "v3", "v4" */
extern const char *const wr_peak_levels[WR_PEAK_LEVELS]; /* "L1", "L2", "DRAM" */

/* Fails with "interrupted" when *cancel is set (base/progress.h), which is checked between rounds. */
bool wr_peaks_measure(WrPool *pool, bool quick, const volatile int *cancel, WrPeaks *peaks,
                      WrError *err);
