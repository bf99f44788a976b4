#include "system/child.h"

#include "system/system_internal.h"
#include "system/clock.h"
#include "system/fd.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

WrChildEnd wr_child_end_of(int status)
{
    if (!WIFSIGNALED(status)) return (WrChildEnd){ WR_CHILD_LEFT, WEXITSTATUS(status) };
    const int number = WTERMSIG(status);
    return (WrChildEnd){ number == SIGXCPU   ? WR_CHILD_LATE
                         : number == SIGKILL ? WR_CHILD_KILLED
                                             : WR_CHILD_CRASHED,
                         number };
}

static void give(posix_spawn_file_actions_t *actions, int fd, int as)
{
    if (fd >= 0) posix_spawn_file_actions_adddup2(actions, fd, as);
}

int wr_child_start(const WrChildStart *start, WrPid *child)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t none, all;
    pid_t pid;
    int trouble = start->bound ? wr_child_start_bound(start, child) : -1;
    if (trouble >= 0) return trouble;
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    give(&actions, start->in, STDIN_FILENO);
    give(&actions, start->out, STDOUT_FILENO);
    give(&actions, start->err, STDERR_FILENO);
    if (start->apart || start->bound) {
        sigemptyset(&none);
        sigfillset(&all);
        posix_spawnattr_setsigmask(&attributes, &none);
        posix_spawnattr_setsigdefault(&attributes, &all);
        short flags = wr_child_set_apart(&actions, &attributes);
        posix_spawnattr_setflags(&attributes,
                                 (short)(flags | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF));
    }
    char *const *arguments = (char *const *)start->arguments;
    trouble = start->search
                  ? posix_spawnp(&pid, start->program, &actions, &attributes, arguments, environ)
                  : posix_spawn(&pid, start->program, &actions, &attributes, arguments, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (trouble == 0) *child = (WrPid)pid;
    return trouble;
}

bool wr_child_wait(WrPid child, WrChildEnd *end)
{
    int status = 0;
    pid_t got;
    do got = waitpid((pid_t)child, &status, 0);
    while (got < 0 && errno == EINTR);
    *end = wr_child_end_of(status);
    return got == (pid_t)child;
}

bool wr_child_ended(WrPid child, WrChildEnd *end)
{
    int status = 0;
    pid_t got = waitpid((pid_t)child, &status, WNOHANG);
    if (got == 0 || (got < 0 && errno == EINTR)) return false;
    *end = got < 0 ? (WrChildEnd){ WR_CHILD_KILLED, 0 } : wr_child_end_of(status);
    return true;
}

bool wr_child_is_gone(WrPid child)
{
    return waitpid((pid_t)child, NULL, WNOHANG) != 0;
}

void wr_child_kill(WrPid child)
{
    kill((pid_t)child, SIGKILL);
}

WrPid wr_child_fork(void)
{
    return (WrPid)fork();
}

void wr_children_wait_for_all(void)
{
    while (waitpid(-1, NULL, 0) > 0) continue;
}

/* ---- work in a forked copy ---- */

/* Runs work in a forked copy of the process, so that a crash affects only the copy. */

#define SLICE_SECONDS 0.02 /* a child that ends silently is noticed within this time */

static void confine(const WrTry *it)
{
    const int deadly[] = { SIGSEGV, SIGBUS, SIGFPE, SIGILL,  SIGABRT, SIGTRAP,
                           SIGSYS,  SIGINT, SIGHUP, SIGTERM, SIGALRM };
    for (size_t i = 0; i < sizeof deadly / sizeof *deadly; i++) signal(deadly[i], SIG_DFL);
    wr_process_limit(WR_LIMIT_CORE, 0);
    wr_process_limit_time((unsigned)it->seconds + 2);
    uint64_t space = it->memory > 0 ? wr_process_space() : 0;
    if (space > 0) wr_process_limit(WR_LIMIT_SPACE, space + it->memory);
    for (int fd = WR_FD_IN; fd <= WR_FD_ERR; fd++) wr_fd_nowhere(fd);
}

static _Noreturn void run_child(const WrTry *it, int to, WrPid parent)
{
    setpgid(0, 0); /* so that processes it starts can be killed with it */
    if (!wr_process_die_with(parent)) _exit(1);
    confine(it);
    it->work(it->ctx, it->answer);
    ssize_t n = write(to, it->answer, it->length);
    _exit(n == (ssize_t)it->length ? 0 : 1); /* not exit: the buffers belong to the parent */
}

/* Reads available bytes from the pipe; false at the end of the data. */
static bool hear(const WrTry *it, int from, size_t *have)
{
    if (*have == it->length) return false;
    ssize_t n = read(from, (char *)it->answer + *have, it->length - *have);
    if (n > 0) *have += (size_t)n;
    return n > 0 || (n < 0 && (errno == EAGAIN || errno == EINTR));
}

/* Waits until the child has ended or the time is over. The child is not reaped yet, so that its number
   stays reserved. True if it ended. */
static bool listen_to(const WrTry *it, pid_t child, int from, size_t *have)
{
    double stop = wr_clock_seconds() + it->seconds;
    bool open = true;
    for (;;) {
        struct pollfd one = { from, POLLIN, 0 };
        siginfo_t info = { 0 };
        poll(open ? &one : NULL, open ? 1 : 0, (int)(SLICE_SECONDS * 1000));
        int asked = waitid(P_PID, (id_t)child, &info, WEXITED | WNOHANG | WNOWAIT);
        bool ended = (asked == 0 && info.si_pid == child) || (asked != 0 && errno == ECHILD);
        if (open) open = hear(it, from, have); /* the result arrived completely, or not at all */
        if (ended) return true;
        if (wr_clock_seconds() >= stop || it->stopped()) return false;
    }
}

WrTryResult wr_child_try(const WrTry *it, WrChildEnd *end)
{
    int ends[2], status = 0;
    size_t have = 0;
    WrPid parent = wr_process_id();
    memset(it->answer, 0, it->length);
    if (!wr_fd_pipe(ends, false)) return WR_TRY_NO_PIPE;
    pid_t child = fork();
    if (child == 0) run_child(it, ends[1], parent);
    int saved = errno;
    close(ends[1]);
    if (child < 0) {
        close(ends[0]);
        errno = saved;
        return WR_TRY_NO_CHILD;
    }
    setpgid(child, child); /* in parent and child: whichever runs first */
    bool ended = listen_to(it, child, ends[0], &have);
    close(ends[0]);
    kill(-child, SIGKILL); /* including processes it started */
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
    *end = wr_child_end_of(status);
    if (have == it->length) return WR_TRY_ANSWERED;
    return ended ? WR_TRY_ENDED : WR_TRY_LATE;
}
