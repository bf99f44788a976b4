/* Large pages on Linux, where the administrator allows programs to request them. */
#include "system/large_pages.h"

#include <stdint.h>
#include <stdio.h>
#include <sys/mman.h>

#define LARGE ((uintptr_t)2 << 20) /* size on most processors; others round by themselves */

void wr_pages_large(void *block, size_t bytes)
{
    const uintptr_t start = (uintptr_t)block, from = (start + LARGE - 1) & ~(LARGE - 1);
    const uintptr_t to = (start + bytes) & ~(LARGE - 1);
    if (to > from) madvise((char *)block + (from - start), to - from, MADV_HUGEPAGE);
}

uint64_t wr_pages_free_bytes(void)
{
    char line[128];
    unsigned long long kilobytes = 0;
    FILE *file = fopen("/proc/meminfo", "re");
    if (!file) return 0;
    while (fgets(line, sizeof line, file))
        if (sscanf(line, "MemAvailable: %llu", &kilobytes) == 1) break;
    fclose(file);
    return (uint64_t)kilobytes * 1024;
}
