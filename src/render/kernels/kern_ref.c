/* Reference span kernels in plain C, one sample at a time; all other sets must agree with them. */
#define WR_KERN_PLAIN
#define WR_KERN_TABLE wr_kern_ref
#define WR_KERN_NAME "ref"
#define WR_KERN_EXACT true
#include "render/kernels/kern_tables.h"

#include "render/kernels/kern_body.h"
