#include "field/taps.h"

#include "base/cpu.h"

#include <stddef.h>

const WrTaps *wr_taps_at(int index)
{
    if (index == 0) return &wr_taps_v1;
    if (index == 1 && wr_cpu_level() >= 3) return &wr_taps_v3;
    if (index == 2 && wr_cpu_level() >= 4) return &wr_taps_v4;
    return NULL;
}

const WrTaps *wr_taps(void)
{
    const int level = wr_cpu_level();
    return level >= 4 ? &wr_taps_v4 : level >= 3 ? &wr_taps_v3 : &wr_taps_v1;
}
