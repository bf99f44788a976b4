/* Processes: the functions that Linux and its C library add to POSIX. */
#include "system/child_internal.h"

#include "system/fd.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/prctl.h>
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

static void place(int fd, int as)
{
    if (fd == as) fcntl(fd, F_SETFD, 0);
    else if (fd >= 0) dup2(fd, as);
}

/* Runs in the child, which shares this process's memory until it executes the program. */
static void become(const WrChildStart *start, pid_t parent)
{
    char *const *arguments = (char *const *)start->arguments;
    sigset_t none;
    for (int number = 1; number < NSIG; number++) signal(number, SIG_DFL);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(127); /* the parent died before the line above */
    setsid();
    place(start->in, STDIN_FILENO);
    place(start->out, STDOUT_FILENO);
    place(start->err, STDERR_FILENO);
    wr_fd_close_range(STDERR_FILENO + 1, -1);
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    if (start->search) execvp(start->program, arguments);
    else execv(start->program, arguments);
}

/* Signals are blocked: no handler may run in the child, which shares this process's memory. */
int wr_child_start_bound(const WrChildStart *start, WrPid *child)
{
    const pid_t parent = getpid();
    volatile int trouble = 0;
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    pid_t pid = vfork();
    if (pid == 0) {
        become(start, parent);
        trouble = errno;
        _exit(127);
    }
    if (pid < 0) trouble = errno;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (pid > 0 && trouble != 0) waitpid(pid, NULL, 0);
    *child = (WrPid)pid;
    return trouble;
}

static void only_ended(sigset_t *set)
{
    sigemptyset(set);
    sigaddset(set, SIGCHLD);
}

/* Blocked before libraries start threads, which would otherwise receive the signal. */
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
