/* Fallback for systems without control over page sizes. */
#include "system/large_pages.h"

void wr_pages_large(void *block, size_t bytes)
{
    (void)block, (void)bytes;
}

uint64_t wr_pages_free_bytes(void)
{
    return 0;
}
