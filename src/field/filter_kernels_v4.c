/* The loops of blurs for one instruction set; CMakeLists.txt sets the flags. */
#define WR_TAPS_TABLE wr_taps_v4
#define WR_TAPS_NAME "v4"
#include "field/filter_kernels_body.h"
