#include "field/filter_kernels.h"

#include "base/cpu.h"

static const WrCpuBuilds builds = { &wr_taps_v1, &wr_taps_v3, &wr_taps_v4 };

const WrTaps *wr_taps_at(int index)
{
    return wr_cpu_build(&builds, index);
}

const WrTaps *wr_taps(void)
{
    return wr_cpu_best(&builds);
}
