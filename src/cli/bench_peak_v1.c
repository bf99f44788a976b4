#define WR_PEAK_NAME wr_peak_v1
#include "cli/bench_peak_body.h"
