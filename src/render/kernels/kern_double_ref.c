/* Double-precision span kernels, one sample at a time; CMakeLists.txt sets the flags. */
#define WR_KERN_PLAIN
#define WR_KERN_DOUBLE
#define WR_KERN_TABLE wr_kern_double_ref
#define WR_KERN_NAME "ref"
#define WR_KERN_EXACT true
#include "render/kernels/kern_tables.h"

#include "render/kernels/kern_body.h"
