/* cpu.h - which instructions this processor has.
   Layer 0. */
#pragma once

/* The highest level of x86-64 (as its psABI numbers them) that this processor has all of that the kernels
   are compiled for: 1 the baseline and every other processor, 2 SSE4.2, 3 AVX2 and FMA, 4 AVX-512. */
int wr_cpu_level(void);
