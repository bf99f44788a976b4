#include "base/cpu.h"

#include <stddef.h>
#ifdef __x86_64__
#include <cpuid.h>
#endif

/* The single features are checked because GCC and clang agree only on their names. */
int wr_cpu_level(void)
{
#ifdef __x86_64__
    if (!__builtin_cpu_supports("sse4.2") || !__builtin_cpu_supports("popcnt")) return 1;
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma") ||
        !__builtin_cpu_supports("bmi2"))
        return 2;
    if (!__builtin_cpu_supports("avx512f") || !__builtin_cpu_supports("avx512bw") ||
        !__builtin_cpu_supports("avx512dq") || !__builtin_cpu_supports("avx512vl"))
        return 3;
    return 4;
#else
    return 1;
#endif
}

/* Bit 29 of EBX of leaf 7; the compiler has no name for it. */
bool wr_cpu_has_sha(void)
{
#ifdef __x86_64__
    unsigned a, b = 0, c, d;
    return wr_cpu_level() >= 2 && __get_cpuid_count(7, 0, &a, &b, &c, &d) && (b >> 29 & 1);
#else
    return false;
#endif
}

const void *wr_cpu_best(const WrCpuBuilds *builds)
{
    const int level = wr_cpu_level();
    return level >= 4 ? builds->v4 : level >= 3 ? builds->v3 : builds->v1;
}

const void *wr_cpu_build(const WrCpuBuilds *builds, int index)
{
    if (index == 0) return builds->v1;
    if (index == 1 && wr_cpu_level() >= 3) return builds->v3;
    if (index == 2 && wr_cpu_level() >= 4) return builds->v4;
    return NULL;
}
