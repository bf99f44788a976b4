/* The loops of filters and of occlusion for one instruction set; CMakeLists.txt sets the flags. */
#define WR_TAPS_TABLE wr_taps_v3
#define WR_TAPS_NAME "v3"
#include "field/filter_kernels_body.h"

#define WR_SKY_TABLE wr_sky_kernels_v3
#define WR_SKY_NAME "v3"
#include "field/occlusion_body.h"
