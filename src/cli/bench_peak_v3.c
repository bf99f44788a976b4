#define WR_PEAK_NAME wr_peak_v3
#include "cli/bench_peak_body.h"
