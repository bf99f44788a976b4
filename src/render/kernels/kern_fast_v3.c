/* Fast span kernels: contraction and reordering allowed; CMakeLists.txt sets the flags. */
#define WR_KERN_TABLE wr_kern_fast_v3
#define WR_KERN_NAME "v3"
#define WR_KERN_EXACT false
#define WR_KERN_FAST
#include "render/kernels/kern_tables.h"

#include "render/kernels/kern_body.h"
