/* The loops of blurs for one instruction set; CMakeLists.txt sets the flags. */
#define WR_TAPS_TABLE wr_taps_v1
#define WR_TAPS_NAME "v1"
#include "field/filter_kernels_body.h"
