#include "brush/brush_kernels.h"

#include "base/cpu.h"

static const WrCpuBuilds builds = { &wr_brush_kernels_v1, &wr_brush_kernels_v3,
                                    &wr_brush_kernels_v4 };

const WrBrushKernels *wr_brush_kernels_at(int index)
{
    return wr_cpu_build(&builds, index);
}

const WrBrushKernels *wr_brush_kernels(void)
{
    return wr_cpu_best(&builds);
}
