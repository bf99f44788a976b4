#include "brush/kern.h"

#include "base/cpu.h"

#include <stddef.h>

const WrBrushKernels *wr_brush_kernels_at(int index)
{
    if (index == 0) return &wr_brush_kernels_v1;
    if (index == 1 && wr_cpu_level() >= 3) return &wr_brush_kernels_v3;
    if (index == 2 && wr_cpu_level() >= 4) return &wr_brush_kernels_v4;
    return NULL;
}

const WrBrushKernels *wr_brush_kernels(void)
{
    const int level = wr_cpu_level();
    return level >= 4   ? &wr_brush_kernels_v4
           : level >= 3 ? &wr_brush_kernels_v3
                        : &wr_brush_kernels_v1;
}
