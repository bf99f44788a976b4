/* This process: the functions that Linux and its C library add to POSIX. */
#include "system/process.h"

#include "system/path.h"
#include "system/thread.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <unistd.h>

/* Pages of address space, and resident pages. */
static bool read_pages(unsigned long long pages[2])
{
    FILE *file = fopen("/proc/self/statm", "re");
    if (!file) return false;
    bool good = fscanf(file, "%llu %llu", &pages[0], &pages[1]) == 2;
    fclose(file);
    return good;
}

uint64_t wr_process_space(void)
{
    unsigned long long pages[2];
    return read_pages(pages) ? pages[0] * (uint64_t)sysconf(_SC_PAGESIZE) : 0;
}

uint64_t wr_process_resident(void)
{
    unsigned long long pages[2];
    return read_pages(pages) ? pages[1] * (uint64_t)sysconf(_SC_PAGESIZE) : 0;
}

bool wr_process_program(char *path, size_t size)
{
    return wr_path_read_link("/proc/self/exe", path, size);
}

void wr_process_called(const char *argument)
{
    (void)argument;
}

bool wr_process_has_cage(void)
{
    return true;
}

bool wr_process_has_gpu(void)
{
    static const char device[] = "/dev/dri/renderD128";
    return wr_path_can_read(device) && wr_path_can_write(device);
}

static void (*at_end)(int);

static void call(int status, void *ctx)
{
    (void)ctx;
    at_end(status);
}

bool wr_process_at_end(void (*work)(int status))
{
    if (at_end) return false;
    at_end = work;
    return on_exit(call, NULL) == 0;
}

bool wr_process_die_with(WrPid parent)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    return (WrPid)getppid() == parent; /* else the parent died before the line above */
}

void wr_process_keep_rights(void)
{
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
}

/* True if every other thread of this process sleeps. */
static bool others_sleep(void)
{
    WrFolder *folder = wr_folder_open("/proc/self/task");
    bool asleep = true;
    if (!folder) return true;
    for (const char *name; (name = wr_folder_next(folder));) {
        char path[64], state = 'S';
        if (atoi(name) == getpid()) continue;
        snprintf(path, sizeof path, "/proc/self/task/%.20s/stat", name);
        FILE *file = fopen(path, "re");
        if (file && fscanf(file, "%*d (%*[^)]) %c", &state) == 1 && state != 'S') asleep = false;
        if (file) fclose(file);
    }
    wr_folder_close(folder);
    return asleep;
}

void wr_process_wait_for_threads(void)
{
    int quiet = 0;
    for (int ms = 0; ms < 3000 && quiet < 3; ms++) {
        quiet = others_sleep() ? quiet + 1 : 0;
        wr_thread_sleep_ms(1);
    }
}
