/* Loops of normal maps for one instruction set; CMakeLists.txt sets the flags. */
#define WR_NORMAL_TABLE wr_normal_kernels_v1
#define WR_NORMAL_NAME "v1"
#include "export/normal_kern_body.h"
