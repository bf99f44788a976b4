#include "system/shared_object.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdint.h>

void *wr_object_open(const char *path)
{
    return dlopen(path, RTLD_NOW | RTLD_LOCAL);
}

void *wr_object_find(void *library, const char *symbol)
{
    return dlsym(library, symbol);
}

void wr_object_close(void *library)
{
    dlclose(library);
}

const char *wr_object_why(void)
{
    return dlerror();
}

bool wr_object_path(const void *symbol, char *path, size_t size)
{
    Dl_info info;
    if (!dladdr(symbol, &info) || !info.dli_fname) return false;
    return (size_t)snprintf(path, size, "%s", info.dli_fname) < size;
}
