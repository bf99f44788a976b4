/* Span kernels for one instruction set; CMakeLists.txt sets the flags. */
#define WR_KERN_TABLE wr_kern_v3
#define WR_KERN_NAME "v3"
#define WR_KERN_EXACT true
#include "render/kernels/kern_tables.h"

#include "render/kernels/kern_body.h"
