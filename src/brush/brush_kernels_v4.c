/* The loops of the brush for one instruction set; CMakeLists.txt sets the flags. */
#define WR_BRUSH_TABLE wr_brush_kernels_v4
#define WR_BRUSH_NAME "v4"
#include "brush/brush_kernels_body.h"
