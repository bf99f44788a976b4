#include "system/sandbox.h"

#include "system/process.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/capability.h>
#include <linux/landlock.h>
#include <sched.h>
#include <seccomp.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED 1
#else
#define SANITIZED 0
#endif

uint64_t wr_sandbox_space(void)
{
    return wr_process_space();
}

void wr_sandbox_memory(uint64_t space, uint64_t memory)
{
    if (memory > 0 && !SANITIZED) wr_process_limit(WR_LIMIT_SPACE, space + memory);
}

/* Root privileges are dropped first: with them a limit could be raised again. */
static void drop_rights(void)
{
    struct __user_cap_header_struct whose = { _LINUX_CAPABILITY_VERSION_3, 0 };
    struct __user_cap_data_struct none[_LINUX_CAPABILITY_U32S_3] = { { 0 } };
    syscall(SYS_capset, &whose, none);
}

void wr_sandbox_limit(uint64_t memory, unsigned seconds)
{
    uint64_t space = wr_sandbox_space();
    drop_rights();
    wr_process_limit(WR_LIMIT_CORE, 0);
    wr_process_limit(WR_LIMIT_FILE, 0);
    wr_process_limit(WR_LIMIT_FILES, 64);
    if (seconds > 0) wr_process_limit_time(seconds);
    wr_sandbox_memory(space, memory);
}

/* Landlock: no path can be opened. Older kernels lack it; the system call filter applies in any case. */
void wr_sandbox_close_files(void)
{
    struct landlock_ruleset_attr rules = { .handled_access_fs = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1) -
                                                                1 }; /* all rights of Landlock's
                                                                        first version */
    int ruleset = (int)syscall(SYS_landlock_create_ruleset, &rules, sizeof rules, 0);
    if (ruleset < 0) return;
    syscall(SYS_landlock_restrict_self, ruleset, 0);
    close(ruleset);
}

/* System calls needed by allocation, decoder threads, reading open files and an open socket. None of
 * them accepts a path or a process number. */
static const int allowed[] = {
    SCMP_SYS(brk),
    SCMP_SYS(clock_gettime),
    SCMP_SYS(clock_nanosleep),
    SCMP_SYS(close),
    SCMP_SYS(dup),
    SCMP_SYS(exit),
    SCMP_SYS(exit_group),
    SCMP_SYS(fstat),
    SCMP_SYS(futex),
    SCMP_SYS(getegid),
    SCMP_SYS(geteuid),
    SCMP_SYS(getgid),
    SCMP_SYS(getpid),
    SCMP_SYS(getrandom),
    SCMP_SYS(gettid),
    SCMP_SYS(gettimeofday),
    SCMP_SYS(getuid),
    SCMP_SYS(lseek),
    SCMP_SYS(madvise),
    SCMP_SYS(membarrier),
    SCMP_SYS(mremap),
    SCMP_SYS(munmap),
    SCMP_SYS(nanosleep),
    SCMP_SYS(poll),
    SCMP_SYS(ppoll),
    SCMP_SYS(pread64),
    SCMP_SYS(read),
    SCMP_SYS(readv),
    SCMP_SYS(recvmsg),
    SCMP_SYS(rseq),
    SCMP_SYS(rt_sigaction),
    SCMP_SYS(rt_sigprocmask),
    SCMP_SYS(rt_sigreturn),
    SCMP_SYS(sched_yield),
    SCMP_SYS(sendmsg),
    SCMP_SYS(sendto),
    SCMP_SYS(set_robust_list),
    SCMP_SYS(sysinfo),
    SCMP_SYS(uname),
    SCMP_SYS(write),
};

/* Calls allowed only if one masked argument has a certain value. A call may have several rows; one
 * match is enough. */
typedef struct Bound {
    int call;
    unsigned argument;
    uint64_t mask, value;
} Bound;

#define INT 0xffffffffU /* an argument of type int */

static const Bound bounds[] = {
    /* On an open file: flags and duplicates, but no signals on file events. */
    { SCMP_SYS(fcntl), 1, INT, F_GETFD },
    { SCMP_SYS(fcntl), 1, INT, F_SETFD },
    { SCMP_SYS(fcntl), 1, INT, F_GETFL },
    { SCMP_SYS(fcntl), 1, INT, F_DUPFD },
    { SCMP_SYS(fcntl), 1, INT, F_DUPFD_CLOEXEC },
    { SCMP_SYS(mmap), 2, PROT_EXEC, 0 },
    { SCMP_SYS(mprotect), 2, PROT_EXEC, 0 },
    { SCMP_SYS(clone), 0, CLONE_THREAD | CLONE_VM, CLONE_THREAD | CLONE_VM }, /* no processes */
    { SCMP_SYS(prlimit64), 0, INT, 0 },                                       /* own process only */
    { SCMP_SYS(sched_getaffinity), 0, INT, 0 },
};

static bool allow_calls(scmp_filter_ctx filter)
{
    const uint32_t yes = SCMP_ACT_ALLOW;
    bool good = true;
    for (size_t i = 0; i < sizeof allowed / sizeof *allowed; i++)
        good = good && seccomp_rule_add(filter, yes, allowed[i], 0) == 0;
    for (size_t i = 0; i < sizeof bounds / sizeof *bounds; i++) {
        const Bound *b = &bounds[i];
        struct scmp_arg_cmp fits = SCMP_CMP(b->argument, SCMP_CMP_MASKED_EQ, b->mask, b->value);
        good = good && seccomp_rule_add_array(filter, yes, b->call, 1, &fits) == 0;
    }
    /* abort() signals its own process, so that the parent learns the exit status. */
    good = good && seccomp_rule_add(filter, yes, SCMP_SYS(tgkill), 1,
                                    SCMP_A0(SCMP_CMP_MASKED_EQ, INT, (uint32_t)getpid())) == 0;
    good = good && seccomp_rule_add(filter, yes, SCMP_SYS(fcntl), 2,
                                    SCMP_A1(SCMP_CMP_MASKED_EQ, INT, F_SETFL),
                                    SCMP_A2(SCMP_CMP_MASKED_EQ, O_ASYNC, 0)) == 0;
    /* The C library falls back to clone, whose flags the filter can check. */
    return good && seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0) == 0;
}

bool wr_sandbox_filter_calls(void)
{
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
    bool good = filter && allow_calls(filter) && seccomp_load(filter) == 0;
    if (filter) seccomp_release(filter);
    return good;
}

bool wr_sandbox_enter(uint64_t memory, unsigned seconds)
{
    wr_sandbox_limit(memory, seconds);
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return false;
    if (SANITIZED) return true;
    wr_sandbox_close_files();
    return wr_sandbox_filter_calls();
}
