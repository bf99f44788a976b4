/* The loops of filters and of occlusion for one instruction set; CMakeLists.txt sets the flags. */
#define WR_TAPS_TABLE wr_taps_v4
#define WR_TAPS_NAME "v4"
#include "field/filter_kernels_body.h"

#define WR_SKY_TABLE wr_sky_kernels_v4
#define WR_SKY_NAME "v4"
#include "field/occlusion_body.h"
