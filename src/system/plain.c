/* What a system without files of its own here gets in place of linux.c (src/README.md): POSIX alone. */
#include "system/system_internal.h"
#include "system/fd.h"
#include "system/file_watch.h"
#include "system/large_pages.h"
#include "system/path.h"
#include "system/process.h"
#include "system/shared_object.h"
#include "system/thread.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* ---- child processes ---- */

/* The text may be overwritten by the next call, so callers copy it at once. */
const char *wr_child_crash(int number)
{
    return strsignal(number);
}

short wr_child_set_apart(posix_spawn_file_actions_t *actions, posix_spawnattr_t *attributes)
{
    (void)actions;
    (void)attributes;
    return 0;
}

int wr_child_start_bound(const WrChildStart *start, WrPid *child)
{
    (void)start;
    (void)child;
    return -1;
}

/* A pipe to this process itself: a signal handler may write to it. */
static int ends[2] = { -1, -1 };

static void note(int number)
{
    int saved = errno;
    (void)number;
    if (write(ends[1], "", 1) < 0) errno = saved; /* a full pipe already signals the news */
    errno = saved;
}

void wr_children_hold(void)
{
    struct sigaction action;
    if (!wr_fd_pipe(ends, false)) return;
    memset(&action, 0, sizeof action);
    action.sa_handler = note;
    action.sa_flags = SA_RESTART | SA_NOCLDSTOP;
    sigemptyset(&action.sa_mask);
    sigaction(SIGCHLD, &action, NULL);
}

int wr_children_watch(void)
{
    return ends[0];
}

WrPid wr_children_next(int watch, WrChildEnd *end)
{
    char bytes[64];
    int status;
    while (read(watch, bytes, sizeof bytes) > 0) continue;
    pid_t pid = waitpid(-1, &status, WNOHANG);
    if (pid <= 0) return 0;
    *end = wr_child_end_of(status);
    return (WrPid)pid;
}

/* ---- this process ---- */

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

/* ---- threads ---- */

void wr_cond_wait_ms(WrCond *cond, WrMutex *mutex, int ms)
{
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_sec += ms / 1000;
    until.tv_nsec += ms % 1000 * 1000000L;
    until.tv_sec += until.tv_nsec / 1000000000L;
    until.tv_nsec %= 1000000000L;
    pthread_cond_timedwait(&cond->it, &mutex->it, &until);
}

void wr_thread_step_back(void)
{
}

bool wr_thread_pin(WrPin *pin)
{
    pin->held = false;
    return false;
}

void wr_thread_unpin(const WrPin *pin)
{
    (void)pin;
}

/* ---- descriptors ---- */

/* On some systems such a name is a duplicate with a shared position, or exists only for the first three
 * descriptors. */
void wr_fd_name(int fd, char name[WR_FD_NAME])
{
    snprintf(name, WR_FD_NAME, "/dev/fd/%d", fd);
}

void wr_fd_close_range(int from, int to)
{
    long most = sysconf(_SC_OPEN_MAX);
    if (most < 0 || most > 65536) most = 65536;
    for (int fd = from; fd < most && (to < 0 || fd <= to); fd++) close(fd);
}

void wr_fd_begin_sync(int fd)
{
    (void)fd;
}

int wr_fd_copy_blocks(int from, int to)
{
    (void)from;
    (void)to;
    return 0;
}

void wr_fd_punch_hole(int fd, int64_t at, int64_t length)
{
    (void)fd;
    (void)at;
    (void)length;
}

int wr_fd_memory(const char *name)
{
    const char *folder = getenv("TMPDIR");
    char path[1024];
    (void)name;
    int length = snprintf(path, sizeof path, "%s/wrinkle-XXXXXX",
                          folder && folder[0] == '/' ? folder : "/tmp");
    if (length < 0 || (size_t)length >= sizeof path) {
        errno = ENAMETOOLONG;
        return -1;
    }
    int fd = mkstemp(path);
    if (fd < 0) return -1;
    fcntl(fd, F_SETFD, FD_CLOEXEC);
    unlink(path);
    return fd;
}

int wr_fd_memory_fixed(const char *name, size_t bytes)
{
    (void)name;
    (void)bytes;
    errno = ENOTSUP;
    return -1;
}

bool wr_fd_pipe(int ends[2], bool wait)
{
    if (pipe(ends) != 0) return false;
    for (int i = 0; i < 2; i++) {
        fcntl(ends[i], F_SETFD, FD_CLOEXEC);
        if (!wait) fcntl(ends[i], F_SETFL, O_NONBLOCK);
    }
    return true;
}

bool wr_random_bytes(void *bytes, size_t length)
{
    int fd = wr_fd_open("/dev/urandom", WR_OPEN_READ);
    bool good = fd >= 0 && wr_fd_read(fd, bytes, length) == (int64_t)length;
    if (fd >= 0) close(fd);
    return good;
}

/* ---- file permissions ---- */

mode_t wr_rights_of_new(const char *folder)
{
    (void)folder;
    mode_t mask = umask(0077);
    umask(mask);
    return ~mask;
}

bool wr_rights_copy_list(int fd, const char *path, bool same_group)
{
    (void)fd;
    (void)path;
    (void)same_group;
    return true;
}

/* ---- file watches ---- */

#define CHECK_SECONDS 0.5

struct WrWatch {
    WrFileInfo last;
    bool there;
    WrWatch *more; /* the next path; NULL: none */
    char path[];
};

WrWatch *wr_watch_new(const char *path)
{
    WrWatch *watch = calloc(1, sizeof *watch + strlen(path) + 1);
    if (!watch) return NULL;
    strcpy(watch->path, path);
    watch->there = wr_path_info(path, &watch->last);
    return watch;
}

void wr_watch_free(WrWatch *watch)
{
    for (WrWatch *more; watch; watch = more) {
        more = watch->more;
        free(watch);
    }
}

bool wr_watch_add(WrWatch *watch, const char *path)
{
    WrWatch *one = wr_watch_new(path);
    if (!one) return false;
    one->more = watch->more;
    watch->more = one;
    return true;
}

static bool has_changed(WrWatch *watch)
{
    WrFileInfo now;
    if (!wr_path_info(watch->path, &now)) return false; /* being replaced, or removed */
    const WrFileInfo *last = &watch->last;
    const bool same = watch->there && now.device == last->device && now.inode == last->inode &&
                      now.bytes == last->bytes && now.seconds == last->seconds &&
                      now.nanoseconds == last->nanoseconds;
    watch->last = now;
    watch->there = true;
    return !same;
}

WrWatchEnd wr_watch_wait(WrWatch *watch, double seconds)
{
    for (;;) {
        for (WrWatch *one = watch; one; one = one->more)
            if (has_changed(one)) return WR_WATCH_CHANGED;
        if (!(seconds > 0)) return WR_WATCH_NOTHING;
        const double rest = seconds < CHECK_SECONDS ? seconds : CHECK_SECONDS;
        const struct timespec nap = { (time_t)rest, (long)((rest - (double)(time_t)rest) * 1e9) };
        if (nanosleep(&nap, NULL) != 0) return WR_WATCH_NOTHING; /* interrupted */
        seconds -= rest;
    }
}

/* ---- large pages ---- */

void wr_pages_large(void *block, size_t bytes)
{
    (void)block, (void)bytes;
}

void wr_pages_small(void *block, size_t bytes)
{
    (void)block, (void)bytes;
}

uint64_t wr_pages_free_bytes(void)
{
    return 0;
}

/* ---- shared libraries ---- */

bool wr_object_path(const void *symbol, char *path, size_t size)
{
    (void)symbol, (void)path, (void)size;
    return false;
}
