/* The loops of occlusion for one instruction set; CMakeLists.txt sets the flags. */
#define WR_SKY_TABLE wr_sky_kernels_v4
#define WR_SKY_NAME "v4"
#include "field/occlusion_body.h"
