#include "render/kern.h"

#include "base/cpu.h"
#include "base/error.h"
#include "render/kern_tables.h"
#include "render/kern_wide.h"

#include <string.h>

static const struct {
    const char *name;
    int level; /* of the processor, at least (cpu.h) */
    const WrKernels *exact, *fast;
    const WrKernelsd *wide;
} levels[] = {
    { "ref", 1, &wr_kern_ref, &wr_kern_ref, &wr_kern_double_ref },
    { "v1", 1, &wr_kern_v1, &wr_kern_v1, &wr_kern_double_v1 },
    { "v2", 2, &wr_kern_v2, &wr_kern_v2, &wr_kern_double_v1 },
    { "v3", 3, &wr_kern_v3, &wr_kern_fast_v3, &wr_kern_double_v3 },
    { "v4", 4, &wr_kern_v4, &wr_kern_fast_v4, &wr_kern_double_v4 },
};

/* The row of that name, or -1 and an error. */
static int find_level(const char *isa, WrError *err)
{
    const int count = (int)(sizeof levels / sizeof *levels);
    bool best = !isa || strcmp(isa, "auto") == 0;
    for (int i = count - 1; i >= 0; i--) {
        if (!best && strcmp(isa, levels[i].name) != 0) continue;
        if (levels[i].level <= wr_cpu_level()) return i;
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

const WrWide *wr_wide_of(const WrKernels *kernels)
{
    const WrWide *wide = kernels == &wr_kern_fast_v4   ? &wr_wide_v4
                         : kernels == &wr_kern_fast_v3 ? &wr_wide_v3
                                                       : NULL;
    return wide && wide->shade ? wide : NULL;
}

WrWideCodes wr_wide_codes_of(const WrKernels *kernels)
{
    if (kernels == &wr_kern_v4 || kernels == &wr_kern_fast_v4) return wr_wide_v4.codes;
    if (kernels == &wr_kern_v3 || kernels == &wr_kern_fast_v3) return wr_wide_v3.codes;
    return NULL;
}

const WrKernelsd *wr_kernels_double(const char *isa, WrError *err)
{
    int level = find_level(isa, err);
    return level < 0 ? NULL : levels[level].wide;
}
