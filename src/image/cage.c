#include "image/cage.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED 1
#else
#define SANITIZED 0
#endif

#if defined(__x86_64__)
#define ARCH AUDIT_ARCH_X86_64
#elif defined(__aarch64__)
#define ARCH AUDIT_ARCH_AARCH64
#endif

static void limit(int what, uint64_t most)
{
    struct rlimit now;
    if (getrlimit((__rlimit_resource_t)what, &now) != 0) return;
    if (now.rlim_max > most) now.rlim_max = most;
    if (now.rlim_cur > now.rlim_max) now.rlim_cur = now.rlim_max;
    setrlimit((__rlimit_resource_t)what, &now);
}

uint64_t wr_cage_space(void)
{
    unsigned long long pages = 0;
    FILE *file = fopen("/proc/self/statm", "re");
    if (!file) return 0;
    if (fscanf(file, "%llu", &pages) != 1) pages = 0;
    fclose(file);
    return pages * (uint64_t)sysconf(_SC_PAGESIZE);
}

void wr_cage_memory(uint64_t space, uint64_t memory)
{
    if (memory > 0 && !SANITIZED) limit(RLIMIT_AS, space + memory);
}

/* No file can be opened but this one. Older kernels lack this; the filter holds in any case. */
static void close_file_system(int file)
{
    struct landlock_ruleset_attr rules = { .handled_access_fs = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1) -
                                                                1 }; /* all of the first version */
    struct landlock_path_beneath_attr one = { .allowed_access = LANDLOCK_ACCESS_FS_READ_FILE,
                                              .parent_fd = file };
    int ruleset = (int)syscall(SYS_landlock_create_ruleset, &rules, sizeof rules, 0);
    if (ruleset < 0) return;
    /* A memory file takes no rule and needs none. */
    syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &one, 0);
    syscall(SYS_landlock_restrict_self, ruleset, 0);
    close(ruleset);
}

#ifdef ARCH

/* What allocation, threads of the decoders, reading files and talking on a socket need. */
static const unsigned allowed[] = {
    SYS_brk,
    SYS_clock_gettime,
    SYS_clock_nanosleep,
    SYS_close,
    SYS_dup,
    SYS_exit,
    SYS_exit_group,
    SYS_faccessat,
    SYS_fcntl,
    SYS_fstat,
    SYS_futex,
    SYS_getcwd,
    SYS_getpid,
    SYS_getrandom,
    SYS_gettid,
    SYS_gettimeofday,
    SYS_getuid,
    SYS_geteuid,
    SYS_getgid,
    SYS_getegid,
    SYS_lseek,
    SYS_madvise,
    SYS_membarrier,
    SYS_mremap,
    SYS_munmap,
    SYS_nanosleep,
    SYS_newfstatat,
    SYS_ppoll,
    SYS_pread64,
    SYS_prlimit64,
    SYS_read,
    SYS_readlinkat,
    SYS_readv,
    SYS_recvmsg,
    SYS_rseq,
    SYS_rt_sigaction,
    SYS_rt_sigprocmask,
    SYS_rt_sigreturn,
    SYS_sched_getaffinity,
    SYS_sched_yield,
    SYS_sendmsg,
    SYS_sendto,
    SYS_set_robust_list,
    SYS_set_tid_address,
    SYS_statx,
    SYS_sysinfo,
    SYS_uname,
    SYS_write,
#ifdef SYS_access
    SYS_access,
    SYS_poll,
    SYS_readlink,
    SYS_stat,
    SYS_lstat,
    SYS_getrlimit,
    SYS_arch_prctl,
#endif
};
#define ALLOWED (sizeof allowed / sizeof *allowed)

/* Calls that are allowed while certain bits of one argument are all 0 (zero) or all 1 (one). */
static const struct {
    unsigned call, argument, zero, one;
} bounded[] = {
    { SYS_openat, 2, O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND, 0 },
#ifdef SYS_open
    { SYS_open, 1, O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND, 0 },
#endif
    { SYS_mmap, 2, PROT_EXEC, 0 },
    { SYS_mprotect, 2, PROT_EXEC, 0 },
    { SYS_clone, 0, 0, CLONE_THREAD | CLONE_VM }, /* threads, not processes */
};
#define BOUNDED (sizeof bounded / sizeof *bounded)

#define FIELD(name) (unsigned)offsetof(struct seccomp_data, name)
/* The low half of an argument; both processors have it first. */
#define ARGUMENT(n) (FIELD(args) + 8 * (n))

static size_t add(struct sock_filter *program, size_t at, struct sock_filter line)
{
    program[at] = line;
    return at + 1;
}

static size_t add_bounded(struct sock_filter *program, size_t n, size_t i)
{
    const struct sock_filter yes = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    const struct sock_filter no = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM);
    unsigned both = bounded[i].zero | bounded[i].one;
    n = add(program, n,
            (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, bounded[i].call, 0, 5));
    n = add(program, n,
            (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, ARGUMENT(bounded[i].argument)));
    n = add(program, n, (struct sock_filter)BPF_STMT(BPF_ALU | BPF_AND | BPF_K, both));
    n = add(program, n,
            (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, bounded[i].one, 0, 1));
    n = add(program, n, yes);
    return add(program, n, no);
}

static bool filter_calls(void)
{
    const struct sock_filter yes = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    const struct sock_filter no = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM);
    struct sock_filter program[2 * ALLOWED + 6 * BOUNDED + 8];
    size_t n = 0;
    n = add(program, n, (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, FIELD(arch)));
    n = add(program, n, (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, ARCH, 1, 0));
    n = add(program, n, (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS));
    n = add(program, n, (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, FIELD(nr)));
    for (size_t i = 0; i < ALLOWED; i++) {
        n = add(program, n,
                (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, allowed[i], 0, 1));
        n = add(program, n, yes);
    }
    for (size_t i = 0; i < BOUNDED; i++) n = add_bounded(program, n, i);
    /* The C library turns to clone, whose flags can be looked at. */
    n = add(program, n, (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_clone3, 0, 1));
    n = add(program, n, (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | ENOSYS));
    n = add(program, n, no);
    struct sock_fprog all = { (unsigned short)n, program };
    return prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &all, 0, 0) == 0;
}

#else
static bool filter_calls(void)
{
    return true; /* processors whose calls are not listed here go without */
}
#endif

bool wr_cage_enter(int file, uint64_t memory, unsigned seconds)
{
    uint64_t space = wr_cage_space();
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, 0);
    limit(RLIMIT_NOFILE, 64);
    if (seconds > 0) limit(RLIMIT_CPU, seconds);
    wr_cage_memory(space, memory);
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return false;
    if (SANITIZED) return true;
    close_file_system(file);
    return filter_calls();
}
