/* Fused SIMD kernels for one instruction set; CMakeLists.txt sets the flags. */
#define WR_WIDE_TABLE wr_wide_v4
#include "render/simd/simd_set_body.h"
