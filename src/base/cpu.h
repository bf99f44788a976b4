/* cpu.h - instruction-set level of this processor, and the choice of the kernel table compiled for it. */
#pragma once
#include <stdbool.h>

/* Returns the highest level of x86-64 (numbered as in its psABI) that this processor supports
   completely, as far as the kernels use it: 1 the baseline and every other processor, 2 SSE4.2, 3 AVX2
   and FMA, 4 AVX-512. */
int wr_cpu_level(void);

/* True if it has instructions for SHA-256, and SSE4.1 with them. */
bool wr_cpu_has_sha(void);

/* One kernel table of a module, compiled for levels 1, 3 and 4. */
typedef struct WrCpuBuilds {
    const void *v1, *v3, *v4;
} WrCpuBuilds;
/* Returns the fastest table that this processor can run. */
const void *wr_cpu_best(const WrCpuBuilds *builds);
/* Enumerates the tables, index = 0, 1, ...; NULL where this processor cannot run that one, or past the
 * last. */
const void *wr_cpu_build(const WrCpuBuilds *builds, int index);
