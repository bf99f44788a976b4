#include "system/file_map.h"

#include <sys/mman.h>

void *wr_map(int fd, size_t length, WrMapFor what)
{
    int may = what == WR_MAP_SHARE ? PROT_READ | PROT_WRITE : PROT_READ;
    void *bytes = mmap(NULL, length, may, what == WR_MAP_READ ? MAP_PRIVATE : MAP_SHARED, fd, 0);
    return bytes == MAP_FAILED ? NULL : bytes;
}

void wr_map_end(const void *bytes, size_t length)
{
    if (bytes) munmap((void *)bytes, length);
}
