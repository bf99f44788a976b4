#include "render/kern.h"
#include "render/kern_tables.h"

#include <string.h>

/* The levels of x86-64; GCC and clang agree on single features only, so those are asked for. */
static bool has_v2(void)
{
    return __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
}

static bool has_v3(void)
{
    return has_v2() && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
           __builtin_cpu_supports("bmi2");
}

static bool has_v4(void)
{
    return has_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}

static bool has_any(void)
{
    return true;
}

static const struct {
    const char *name;
    bool (*here)(void);
    const WrKernels *exact, *fast;
    const WrKernelsd *wide;
} levels[] = {
    { "ref", has_any, &wr_kern_ref, &wr_kern_ref, &wr_kern_double_ref },
    { "v1", has_any, &wr_kern_v1, &wr_kern_v1, &wr_kern_double_v1 },
    { "v2", has_v2, &wr_kern_v2, &wr_kern_v2, &wr_kern_double_v1 },
    { "v3", has_v3, &wr_kern_v3, &wr_kern_fast_v3, &wr_kern_double_v3 },
    { "v4", has_v4, &wr_kern_v4, &wr_kern_fast_v4, &wr_kern_double_v4 },
};

/* The row of that name, or -1 and an error. */
static int find_level(const char *isa, WrError *err)
{
    const int count = (int)(sizeof levels / sizeof *levels);
    bool best = !isa || strcmp(isa, "auto") == 0;
    for (int i = count - 1; i >= 0; i--) {
        if (!best && strcmp(isa, levels[i].name) != 0) continue;
        if (levels[i].here()) return i;
        if (best) continue;
        wr_fail(err, "isa %s: this processor does not have it; auto picks the best that it has",
                isa);
        return -1;
    }
    wr_fail(err, "isa %s: must be ref, v1, v2, v3, v4 or auto", isa);
    return -1;
}

const WrKernels *wr_kernels_get(const char *isa, bool fast, WrError *err)
{
    int level = find_level(isa, err);
    if (level < 0) return NULL;
    return fast ? levels[level].fast : levels[level].exact;
}

const WrKernelsd *wr_kernels_double(const char *isa, WrError *err)
{
    int level = find_level(isa, err);
    return level < 0 ? NULL : levels[level].wide;
}
