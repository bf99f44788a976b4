#include "export/normal_kern.h"

#include "base/cpu.h"

static const WrCpuBuilds builds = { &wr_normal_kernels_v1, &wr_normal_kernels_v3,
                                    &wr_normal_kernels_v4 };

const WrNormalKernels *wr_normal_kernels_at(int index)
{
    return wr_cpu_build(&builds, index);
}

const WrNormalKernels *wr_normal_kernels(void)
{
    return wr_cpu_best(&builds);
}
