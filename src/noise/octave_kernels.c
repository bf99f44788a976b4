#include "noise/octave_kernels.h"

#include "base/cpu.h"

static const WrCpuBuilds builds = { &wr_noise_kernels_v1, &wr_noise_kernels_v3,
                                    &wr_noise_kernels_v4 };

const WrNoiseKernels *wr_noise_kernels_at(int index)
{
    return wr_cpu_build(&builds, index);
}

const WrNoiseKernels *wr_noise_kernels(void)
{
    return wr_cpu_best(&builds);
}
