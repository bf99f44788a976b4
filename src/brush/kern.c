#include "brush/kern.h"

#include <stddef.h>

/* The levels of x86-64, by single features: GCC and clang agree on those only. */
static bool has_v3(void)
{
#ifdef __x86_64__
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
           __builtin_cpu_supports("bmi2");
#else
    return false;
#endif
}

static bool has_v4(void)
{
#ifdef __x86_64__
    return has_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#else
    return false;
#endif
}

const WrBrushKernels *wr_brush_kernels_at(int index)
{
    if (index == 0) return &wr_brush_kernels_v1;
    if (index == 1 && has_v3()) return &wr_brush_kernels_v3;
    if (index == 2 && has_v4()) return &wr_brush_kernels_v4;
    return NULL;
}

const WrBrushKernels *wr_brush_kernels(void)
{
    return has_v4() ? &wr_brush_kernels_v4 : has_v3() ? &wr_brush_kernels_v3 : &wr_brush_kernels_v1;
}
