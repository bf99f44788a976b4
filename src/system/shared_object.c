#include "system/shared_object.h"

#include <dlfcn.h>

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
