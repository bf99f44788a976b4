/* The loops of occlusion for one instruction set; CMakeLists.txt sets the flags. */
#define WR_SKY_TABLE wr_sky_kernels_v3
#define WR_SKY_NAME "v3"
#include "field/occlusion_body.h"
