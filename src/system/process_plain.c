/* This process: fallback for any POSIX system. Missing here: memory size (so journal replays in a copy
   have no memory limit, and the status bar shows none), the status at exit (so the exit waits for
   libraries that are being loaded), termination together with the parent (a child left by a killed
   program ends at its time limit, or when it next reads its channel), thread states. */
#include "system/process.h"

#include "system/path.h"
#include "system/thread.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

uint64_t wr_process_space(void)
{
    return 0;
}

uint64_t wr_process_resident(void)
{
    return 0;
}

static char program[4096]; /* written before threads exist */

/* Resolves argument 0: a path directly, a name by searching PATH. */
static void find_called(const char *argument)
{
    const char *path = getenv("PATH");
    char tried[sizeof program];
    if (strchr(argument, '/')) path = NULL;
    do {
        size_t length = path ? strcspn(path, ":") : 0;
        snprintf(tried, sizeof tried, "%.*s%s%s", (int)length, path ? path : "", length ? "/" : "",
                 argument);
        char *real = wr_path_can_run(tried) ? wr_path_real(tried) : NULL;
        if (real) snprintf(program, sizeof program, "%s", real);
        free(real);
        path = path && path[length] ? path + length + 1 : NULL;
    } while (path && !program[0]);
}

void wr_process_called(const char *argument)
{
    if (argument && *argument) find_called(argument);
}

bool wr_process_program(char *path, size_t size)
{
    int length = snprintf(path, size, "%s", program);
    return program[0] && length > 0 && (size_t)length < size;
}

bool wr_process_has_cage(void)
{
    return false;
}

bool wr_process_has_gpu(void)
{
    return true; /* assumed; the window library reports a missing GPU itself */
}

bool wr_process_at_end(void (*work)(int status))
{
    (void)work;
    return false;
}

bool wr_process_die_with(WrPid parent)
{
    return (WrPid)getppid() == parent;
}

void wr_process_keep_rights(void)
{
}

void wr_process_wait_for_threads(void)
{
    wr_thread_sleep_ms(100);
}
