/* The loops of blurs for one instruction set; CMakeLists.txt sets the flags. */
#define WR_TAPS_TABLE wr_taps_v3
#define WR_TAPS_NAME "v3"
#include "field/filter_kernels_body.h"
