#include "system/child.h"

#include "system/child_internal.h"

#include <errno.h>
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
