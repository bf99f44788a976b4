/* Large pages on Linux, where the administrator lets programs ask for them. */
#include "system/pages.h"

#include <stdint.h>
#include <sys/mman.h>

#define LARGE ((uintptr_t)2 << 20) /* of most processors; others round by themselves */

void wr_pages_large(void *block, size_t bytes)
{
    const uintptr_t start = (uintptr_t)block, from = (start + LARGE - 1) & ~(LARGE - 1);
    const uintptr_t to = (start + bytes) & ~(LARGE - 1);
    if (to > from) madvise((char *)block + (from - start), to - from, MADV_HUGEPAGE);
}
