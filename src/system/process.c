#include "system/process.h"

#include <errno.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

WrPid wr_process_id(void)
{
    return (WrPid)getpid();
}

bool wr_process_lives(WrPid process)
{
    return kill((pid_t)process, 0) == 0 || errno != ESRCH;
}

int wr_process_become(const char *program, char *const *arguments)
{
    execv(program, arguments);
    return errno;
}

bool wr_process_machine(char *name, size_t size)
{
    if (gethostname(name, size) != 0) return false;
    name[size - 1] = '\0'; /* a truncated name may lack it */
    return true;
}

bool wr_process_has_terminal(void)
{
    return isatty(STDERR_FILENO) != 0;
}

/* ---- limits ---- */

uint64_t wr_process_file_limit(void)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return WR_LIMIT_NONE;
    return (uint64_t)limit.rlim_cur;
}

static void ignore_default(int signal)
{
    struct sigaction now;
    if (sigaction(signal, NULL, &now) != 0 || now.sa_handler != SIG_DFL) return;
    now.sa_handler = SIG_IGN;
    sigaction(signal, &now, NULL);
}

void wr_process_outlive_file_limit(void)
{
    ignore_default(SIGXFSZ);
}

void wr_process_outlive_pipes(void)
{
    ignore_default(SIGPIPE);
}

void wr_process_limit(WrLimit what, uint64_t most)
{
    static const int kinds[] = { [WR_LIMIT_CORE] = RLIMIT_CORE,
                                 [WR_LIMIT_FILE] = RLIMIT_FSIZE,
                                 [WR_LIMIT_FILES] = RLIMIT_NOFILE,
                                 [WR_LIMIT_SPACE] = RLIMIT_AS };
    struct rlimit now;
    if (getrlimit(kinds[what], &now) != 0) return;
    if (now.rlim_max > most) now.rlim_max = (rlim_t)most;
    if (now.rlim_cur > now.rlim_max) now.rlim_cur = now.rlim_max;
    setrlimit(kinds[what], &now);
}

/* At the soft limit a signal reports the reason; the hard limit ends the process and cannot be caught. */
void wr_process_limit_time(unsigned seconds)
{
    struct rlimit now;
    if (getrlimit(RLIMIT_CPU, &now) != 0) return;
    if (now.rlim_max > (rlim_t)seconds + 1) now.rlim_max = (rlim_t)seconds + 1;
    if (now.rlim_cur > seconds) now.rlim_cur = seconds;
    setrlimit(RLIMIT_CPU, &now);
}

/* ---- the end ---- */

void wr_process_leave(int status)
{
    _exit(status);
}

void wr_process_stand_alone(void)
{
    setsid(); /* fails if it already leads a session */
}

bool wr_process_leave_folder(void)
{
    return chdir("/") == 0;
}

void wr_process_hear_signals(void)
{
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
}

/* ---- interrupts ---- */

static void (*on_interrupt)(void);
static unsigned patience;

static void hear(int number)
{
    (void)number;
    on_interrupt();
    alarm(patience);
}

/* Runs when the program has not ended within `patience` seconds. */
static void give_up(int number)
{
    (void)number;
    signal(SIGTERM, SIG_DFL);
    kill(getpid(), SIGTERM);
}

static void catch_one(int number, void (*handler)(int))
{
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = handler;
    action.sa_flags = (int)SA_RESETHAND;
    sigemptyset(&action.sa_mask);
    sigaction(number, &action, NULL);
}

void wr_process_catch_interrupts(void (*work)(void), unsigned seconds)
{
    on_interrupt = work;
    patience = seconds;
    catch_one(SIGINT, hear);
    catch_one(SIGTERM, hear);
    catch_one(SIGALRM, give_up);
}

void wr_process_drop_interrupts(void)
{
    signal(SIGINT, SIG_DFL);
    signal(SIGTERM, SIG_DFL);
}
