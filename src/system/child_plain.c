/* Processes: fallback for any POSIX system. Missing here: closing all descriptors that a started
   program should not inherit (descriptors opened by the program are marked; those of libraries may not
   be, and the reader closes everything by itself), a session of its own from the start (the reader
   creates one), termination together with the starting thread. */
#include "system/child_internal.h"

#include "system/fd.h"

#include <errno.h>
#include <signal.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

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
