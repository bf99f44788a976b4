/* Processes: what Linux and its C library have of their own. */
#include "system/child_inner.h"

#include <signal.h>
#include <string.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

const char *wr_child_crash(int number)
{
    return sigdescr_np(number);
}

short wr_child_set_apart(posix_spawn_file_actions_t *actions, posix_spawnattr_t *attributes)
{
    (void)attributes;
    posix_spawn_file_actions_addclosefrom_np(actions, STDERR_FILENO + 1);
    return POSIX_SPAWN_SETSID;
}

static void only_ended(sigset_t *set)
{
    sigemptyset(set);
    sigaddset(set, SIGCHLD);
}

/* Before libraries start threads of their own, which would swallow it. */
void wr_children_hold(void)
{
    sigset_t ended;
    only_ended(&ended);
    sigprocmask(SIG_BLOCK, &ended, NULL);
}

int wr_children_watch(void)
{
    sigset_t ended;
    only_ended(&ended);
    return signalfd(-1, &ended, SFD_CLOEXEC | SFD_NONBLOCK);
}

WrPid wr_children_next(int watch, WrChildEnd *end)
{
    struct signalfd_siginfo told;
    int status;
    while (read(watch, &told, sizeof told) > 0) continue;
    pid_t pid = waitpid(-1, &status, WNOHANG);
    if (pid <= 0) return 0;
    *end = wr_child_end_of(status);
    return (WrPid)pid;
}
