/* Trying a function in a child, so that its crash is only the child's. */
#include "document/recover.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/progress.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#define SLICE_SECONDS 0.02 /* a child that ends without a word is noticed within this */

/* What the child says before it ends; small enough for one write. */
typedef struct Verdict {
    bool result;
    WrError err;
} Verdict;

/* Bytes of addresses that this program has now; 0 if the system does not say. */
static rlim_t address_space(void)
{
    char text[64] = "";
    int fd = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    if (fd < 0) return 0;
    ssize_t n = read(fd, text, sizeof text - 1);
    close(fd);
    return n > 0 ? (rlim_t)strtoull(text, NULL, 10) * (rlim_t)sysconf(_SC_PAGESIZE) : 0;
}

static void confine(double seconds, size_t bytes)
{
    const int deadly[] = { SIGSEGV, SIGBUS, SIGFPE, SIGILL,  SIGABRT, SIGTRAP,
                           SIGSYS,  SIGINT, SIGHUP, SIGTERM, SIGALRM };
    for (size_t i = 0; i < sizeof deadly / sizeof *deadly; i++) signal(deadly[i], SIG_DFL);
    struct rlimit none = { 0, 0 }, cpu = { (rlim_t)seconds + 2, (rlim_t)seconds + 2 };
    setrlimit(RLIMIT_CORE, &none);
    setrlimit(RLIMIT_CPU, &cpu);
    if (bytes > 0) {
        rlim_t most = address_space() + (rlim_t)bytes;
        setrlimit(RLIMIT_AS, &(struct rlimit){ most, most });
    }
    int null = open("/dev/null", O_RDWR);
    if (null >= 0) {
        dup2(null, STDIN_FILENO);
        dup2(null, STDOUT_FILENO);
        dup2(null, STDERR_FILENO);
    }
}

static _Noreturn void run_child(WrTrialFunction function, void *ctx, double seconds, size_t bytes,
                                int to, pid_t parent)
{
    setpgid(0, 0); /* so that what it starts can be ended with it */
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1); /* it died before the line above */
    confine(seconds, bytes);
    Verdict verdict = { 0 };
    verdict.result = function(ctx, &verdict.err);
    ssize_t n = write(to, &verdict, sizeof verdict);
    _exit(n == (ssize_t)sizeof verdict ? 0 : 1); /* not exit: the parent's buffers are not ours */
}

/* Read from the pipe what is there; false once nothing more can come. */
static bool hear(int from, Verdict *verdict, size_t *have)
{
    if (*have == sizeof *verdict) return false;
    ssize_t n = read(from, (char *)verdict + *have, sizeof *verdict - *have);
    if (n > 0) *have += (size_t)n;
    return n > 0 || (n < 0 && (errno == EAGAIN || errno == EINTR));
}

/* Wait until the child has ended, which is not taken note of yet so that its number stays its own,
   or the time is over. True if it ended. */
static bool listen_to(pid_t child, int from, double seconds, Verdict *verdict, size_t *have)
{
    double stop = wr_clock_seconds() + seconds;
    bool open = true;
    for (;;) {
        struct pollfd one = { from, POLLIN, 0 };
        siginfo_t info = { 0 };
        poll(open ? &one : NULL, open ? 1 : 0, (int)(SLICE_SECONDS * 1000));
        int asked = waitid(P_PID, (id_t)child, &info, WEXITED | WNOHANG | WNOWAIT);
        bool ended = (asked == 0 && info.si_pid == child) || (asked != 0 && errno == ECHILD);
        if (open) open = hear(from, verdict, have); /* it came whole, or not at all */
        if (ended) return true;
        if (wr_clock_seconds() >= stop || wr_progress_stopped()) return false;
    }
}

static WrTrialEnd judge(const Verdict *verdict, bool told, int status, WrError *err)
{
    if (told && verdict->result) return WR_TRIAL_TRUE;
    if (told) {
        wr_fail(err, "%.500s", verdict->err.text);
        return WR_TRIAL_FALSE;
    }
    if (WIFSIGNALED(status)) {
        const char *name = strsignal(WTERMSIG(status));
        wr_fail(err, "it crashed: %s (signal %d)", name ? name : "unknown", WTERMSIG(status));
    } else {
        wr_fail(err, "it ended the program by itself (status %d)", WEXITSTATUS(status));
    }
    return WR_TRIAL_CRASHED;
}

WrTrialEnd wr_journal_trial(WrTrialFunction function, void *ctx, double seconds, size_t bytes,
                            WrError *err)
{
    int ends[2], status = 0;
    size_t have = 0;
    Verdict verdict = { 0 };
    pid_t parent = getpid();
    if (!(seconds > 0)) seconds = SLICE_SECONDS;
    if (seconds > 1e6) seconds = 1e6;
    if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) {
        wr_fail(err, "no pipe to a trial: %s", strerror(errno));
        return WR_TRIAL_UNABLE;
    }
    pid_t child = fork();
    if (child == 0) run_child(function, ctx, seconds, bytes, ends[1], parent);
    int saved = errno;
    close(ends[1]);
    if (child < 0) {
        close(ends[0]);
        wr_fail(err, "no child for a trial: %s", strerror(saved));
        return WR_TRIAL_UNABLE;
    }
    setpgid(child, child); /* whichever of the two comes first */
    bool ended = listen_to(child, ends[0], seconds, &verdict, &have);
    close(ends[0]);
    kill(-child, SIGKILL); /* and whatever it started */
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
    verdict.err.text[sizeof verdict.err.text - 1] = '\0';
    if (ended || have == sizeof verdict)
        return judge(&verdict, have == sizeof verdict, status, err);
    wr_fail(err, "it took more than %g s", seconds);
    return WR_TRIAL_TIMEOUT;
}
