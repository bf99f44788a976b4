#include "render/kernels/kern.h"

#include "base/cpu.h"
#include "base/error.h"
#include "base/text.h"
#include "render/simd/simd_kernels.h"

#include <stdio.h>
#include <string.h>

/* WR_NATIVE_LEVEL (CMakeLists.txt): 0 compiles every set; 1 to 4 the plain set and that level's only. It is 1 on other
   processors than x86-64.
   ref: one sample at a time, plain C, the standard for tests. exact sets have equal bits at every level; fast
   sets use reciprocal estimates and fused multiply-add, and wide sets need AVX2. */
#define COMPILED(level) (WR_NATIVE_LEVEL == 0 || WR_NATIVE_LEVEL == (level))

static const struct {
    const char *name;
    int level; /* required level of the processor (cpu.h) */
    const WrKernels *exact, *fast;
    const WrKernelsd *in_double;
    const WrWide *wide; /* NULL: none */
} levels[] = {
    { "ref", 1, &wr_kern_ref, &wr_kern_ref, &wr_kern_double_ref, NULL },
#if COMPILED(1)
    { "v1", 1, &wr_kern_v1, &wr_kern_v1, &wr_kern_double_v1, NULL },
#endif
#if COMPILED(2)
    { "v2", 2, &wr_kern_v2, &wr_kern_v2, &wr_kern_double_v1, NULL },
#endif
#if COMPILED(3)
    { "v3", 3, &wr_kern_v3, &wr_kern_fast_v3, &wr_kern_double_v3, &wr_wide_v3 },
#endif
#if COMPILED(4)
    { "v4", 4, &wr_kern_v4, &wr_kern_fast_v4, &wr_kern_double_v4, &wr_wide_v4 },
#endif
};
#define LEVEL_COUNT ((int)(sizeof levels / sizeof *levels))

/* Index - 1: the level that a name needs. */
static const char *const level_names[] = { "auto", "ref", "v1", "v2", "v3", "v4", NULL };

static bool fail_level(const char *isa, WrError *err)
{
    char what[80];
    for (int i = 0; level_names[i]; i++) {
        if (strcmp(isa, level_names[i]) != 0) continue;
        if (i - 1 > wr_cpu_level())
            return wr_fail(err, "isa %s: not supported by this processor; use auto", isa);
        return wr_fail(err, "isa %s: not in this build; configure it with -DWR_KERNELS=all", isa);
    }
    snprintf(what, sizeof what, "isa %.60s", isa);
    return wr_fail_word(err, what, isa, wr_word_of_array, level_names);
}

/* Index of the row of that name, or -1 and an error.
   From the best level down; a named level must exist in the build and on the processor. */
static int find_level(const char *isa, WrError *err)
{
    const bool best = !isa || strcmp(isa, "auto") == 0;
    for (int i = LEVEL_COUNT - 1; i >= 0; i--)
        if ((best || strcmp(isa, levels[i].name) == 0) && levels[i].level <= wr_cpu_level())
            return i;
    fail_level(isa, err);
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
    for (int i = 0; i < LEVEL_COUNT; i++) {
        const WrWide *wide = levels[i].wide;
        if (wide && wide->shade && kernels == levels[i].fast) return wide;
    }
    return NULL;
}

WrWideCodes wr_wide_codes_of(const WrKernels *kernels)
{
    for (int i = 0; i < LEVEL_COUNT; i++) {
        const WrWide *wide = levels[i].wide;
        if (wide && (kernels == levels[i].exact || kernels == levels[i].fast)) return wide->codes;
    }
    return NULL;
}

const WrKernelsd *wr_kernels_double(const char *isa, WrError *err)
{
    int level = find_level(isa, err);
    return level < 0 ? NULL : levels[level].in_double;
}
