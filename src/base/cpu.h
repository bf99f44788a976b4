/* cpu.h - which instructions this processor has.
   Layer 0. */
#pragma once

/* The highest level of x86-64 (as its psABI numbers them) that this processor has all of that the kernels
   are compiled for: 1 the baseline and every other processor, 2 SSE4.2, 3 AVX2 and FMA, 4 AVX-512. */
int wr_cpu_level(void);

/* The same functions as they were compiled for levels 1, 3 and 4: the tables of a kernel's room. */
typedef struct WrCpuBuilds {
    const void *v1, *v3, *v4;
} WrCpuBuilds;
/* Those that this processor runs best. */
const void *wr_cpu_best(const WrCpuBuilds *builds);
/* One after another for index = 0, 1, ...; NULL where this processor cannot run it, or there is none. */
const void *wr_cpu_build(const WrCpuBuilds *builds, int index);
