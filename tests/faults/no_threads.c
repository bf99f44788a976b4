/* A shared library loaded before the C library: the program gets at most WR_THREADS threads. Used with LD_PRELOAD;
   the reader process for pictures is excluded, since its libraries are not ours. */
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef int Create(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);

__attribute__((visibility("default"))) int
pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *arg)
{
    static int given;
    const char *most = getenv("WR_THREADS");
    void *found = dlsym(RTLD_NEXT, "pthread_create");
    Create *create;
    memcpy(&create, &found, sizeof create);
    bool ours = strcmp(program_invocation_short_name, "wrinkle") == 0;
    if (ours && most && __atomic_fetch_add(&given, 1, __ATOMIC_RELAXED) >= atoi(most))
        return EAGAIN;
    return create(thread, attributes, run, arg);
}
