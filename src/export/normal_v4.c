/* Loops of normal maps for one instruction set; CMakeLists.txt sets the flags. */
#define WR_NORMAL_TABLE wr_normal_kernels_v4
#define WR_NORMAL_NAME "v4"
#include "export/normal_kern_body.h"
