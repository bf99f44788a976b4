/* Where a system hands out pages as it likes. */
#include "system/pages.h"

void wr_pages_large(void *block, size_t bytes)
{
    (void)block, (void)bytes;
}
