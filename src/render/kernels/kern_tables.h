/* kern_tables.h - the compiled kernel sets. Private to kern.c and kern_*.c. */
#pragma once
#include "render/kernels/kern.h"

extern const WrKernels wr_kern_ref, wr_kern_v1, wr_kern_v2, wr_kern_v3, wr_kern_v4;
extern const WrKernels wr_kern_fast_v3, wr_kern_fast_v4;
extern const WrKernelsd wr_kern_double_ref, wr_kern_double_v1, wr_kern_double_v3, wr_kern_double_v4;
