/* The sandbox of the reader process (src/system/sandbox.h): each forbidden action is tried from inside, with Landlock
   and without, since each mechanism must work alone. */
#include "test.h"
#include "test_folder.h"

#include "system/sandbox.h"

#include <linux/capability.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <linux/landlock.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <seccomp.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED 1
#else
#define SANITIZED 0
#endif

#define MEMORY ((uint64_t)64 << 20)
#define SECONDS 10
#define FILE_FD 4 /* as in the reader process */

/* Read before: inside the sandbox even asking is forbidden. */
static pid_t *parent_place(void)
{
    static pid_t parent;
    return &parent;
}

static pid_t the_parent(void)
{
    return *parent_place();
}

/* ---- forbidden actions; true: it succeeded ---- */

static bool opens_a_path(void)
{
    return open("/etc/passwd", O_RDONLY) >= 0;
}
static bool opens_its_own_file_again(void)
{
    return open("/proc/self/fd/4", O_RDONLY) >= 0;
}
static bool opens_relative(void)
{
    return openat(FILE_FD, "file", O_RDONLY) >= 0;
}
static bool opens_in_a_newer_way(void)
{
    struct {
        uint64_t flags, mode, resolve;
    } how = { O_RDONLY, 0, 0 };
    return syscall(SYS_openat2, AT_FDCWD, "/etc/passwd", &how, sizeof how) >= 0;
}
static bool opens_to_write(void)
{
    return open("file", O_WRONLY) >= 0;
}
static bool creates(void)
{
    return open("new", O_RDWR | O_CREAT, 0666) >= 0 || mkdir("folder", 0777) == 0;
}
static bool removes(void)
{
    return unlink("victim") == 0 || rename("victim", "other") == 0;
}
static bool asks_about_a_path(void)
{
    struct stat info;
    return stat("/etc/passwd", &info) == 0 || lstat("/etc/passwd", &info) == 0;
}
static bool asks_in_a_newer_way(void)
{
    struct statx info;
    return statx(AT_FDCWD, "/etc/passwd", 0, STATX_SIZE, &info) == 0;
}
static bool asks_whether_a_path_is_there(void)
{
    return access("/etc/passwd", F_OK) == 0;
}
static bool reads_a_link(void)
{
    char to[64];
    return readlink("/proc/self/exe", to, sizeof to) > 0;
}
static bool changes_the_file(void)
{
    return fchmod(FILE_FD, 0777) == 0 || ftruncate(FILE_FD, 0) == 0;
}
static bool makes_a_socket(void)
{
    int ends[2];
    return socket(AF_INET, SOCK_STREAM, 0) >= 0 || socket(AF_UNIX, SOCK_STREAM, 0) >= 0 ||
           socketpair(AF_UNIX, SOCK_STREAM, 0, ends) == 0;
}
static bool makes_a_process(void)
{
    pid_t pid = fork();
    if (pid == 0) _exit(0);
    return pid > 0;
}
static bool makes_a_namespace(void)
{
    return unshare(CLONE_NEWUSER) == 0;
}
static bool runs_a_program(void)
{
    char *const arguments[] = { (char *)"true", NULL };
    execv("/bin/true", arguments); /* if it returns, it failed */
    return false;
}
static bool signals_its_parent(void)
{
    return kill(the_parent(), 0) == 0 || syscall(SYS_tgkill, the_parent(), the_parent(), 0) == 0 ||
           syscall(SYS_pidfd_open, the_parent(), 0) >= 0;
}
static bool limits_its_parent(void)
{
    struct rlimit now, same;
    if (prlimit(the_parent(), RLIMIT_CORE, NULL, &now) == 0) return true;
    same = (struct rlimit){ 0, 0 };
    return prlimit(the_parent(), RLIMIT_CORE, &same, NULL) == 0;
}
static bool raises_its_limits(void)
{
    struct rlimit more = { RLIM_INFINITY, RLIM_INFINITY };
    return setrlimit(RLIMIT_FSIZE, &more) == 0 || setrlimit(RLIMIT_AS, &more) == 0 ||
           setrlimit(RLIMIT_CPU, &more) == 0;
}
static bool has_signals_sent(void)
{
    return fcntl(FILE_FD, F_SETOWN, the_parent()) == 0;
}
static bool has_signals_sent_in_other_ways(void)
{
    struct f_owner_ex owner = { F_OWNER_PID, the_parent() };
    return fcntl(FILE_FD, F_SETOWN_EX, &owner) == 0 || fcntl(FILE_FD, F_SETSIG, SIGKILL) == 0 ||
           fcntl(FILE_FD, F_SETLEASE, F_RDLCK) == 0 || fcntl(FILE_FD, F_NOTIFY, DN_ACCESS) == 0;
}
static bool has_signals_switched_on(void)
{
    return fcntl(FILE_FD, F_SETFL, O_ASYNC) == 0 || fcntl(FILE_FD, F_SETFL, O_ASYNC | O_RDWR) == 0;
}
static bool locks_the_file(void)
{
    struct flock lock = { .l_type = F_RDLCK };
    return fcntl(FILE_FD, F_SETLK, &lock) == 0;
}
static bool controls_a_device(void)
{
    int bytes;
    return ioctl(FILE_FD, FIONREAD, &bytes) == 0;
}
static bool traces(void)
{
    return ptrace(PTRACE_TRACEME, 0, NULL, NULL) == 0;
}
static bool reads_its_parent(void)
{
    char here[8], *there = here; /* the same address: this process is a copy */
    struct iovec to = { here, sizeof here }, from = { there, sizeof here };
    return process_vm_readv(the_parent(), &to, 1, &from, 1, 0) > 0;
}
static bool maps_code(void)
{
    return mmap(NULL, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) !=
           MAP_FAILED;
}
static bool makes_code(void)
{
    void *page = mmap(NULL, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return page != MAP_FAILED && mprotect(page, 4096, PROT_READ | PROT_EXEC) == 0;
}
static bool makes_a_memory_file(void)
{
    return memfd_create("code", 0) >= 0;
}
static bool makes_a_ring(void)
{
    char parameters[120] = { 0 };
    return syscall(SYS_io_uring_setup, 1, parameters) >= 0;
}
static bool takes_more_memory(void)
{
    return malloc((size_t)200 << 20) != NULL;
}

/* ---- necessary actions; true: it was impossible ---- */

static bool cannot_read_its_file(void)
{
    char bytes[4];
    return pread(FILE_FD, bytes, 4, 0) != 4 || lseek(FILE_FD, 0, SEEK_END) != 4;
}
static bool cannot_copy_its_file(void)
{
    int copy = fcntl(FILE_FD, F_DUPFD_CLOEXEC, 0);
    FILE *file = copy < 0 ? NULL : fdopen(copy, "rb");
    char bytes[4];
    return !file || fseek(file, 0, SEEK_SET) != 0 || fread(bytes, 1, 4, file) != 4;
}
static bool cannot_have_memory(void)
{
    return malloc((size_t)20 << 20) == NULL;
}
static bool cannot_see_its_limits(void)
{
    struct rlimit now;
    return getrlimit(RLIMIT_AS, &now) != 0;
}
static void *in_a_thread(void *ctx)
{
    *(int *)ctx = 1;
    return NULL;
}
static bool cannot_have_threads(void)
{
    pthread_t thread;
    int ran = 0;
    pthread_attr_t small;
    pthread_attr_init(&small);
    pthread_attr_setstacksize(&small, 1 << 18);
    if (pthread_create(&thread, &small, in_a_thread, &ran) != 0) return true;
    pthread_join(thread, NULL);
    return ran != 1;
}

typedef enum Parts { FILTER = 1, LANDLOCK = 2 } Parts;

static const struct {
    const char *what;
    bool (*done)(void);
    int kept_by; /* each of these mechanisms forbids it alone; 0: the limits do */
} attempts[] = {
    { "opens a path", opens_a_path, FILTER | LANDLOCK },
    { "opens its own file again", opens_its_own_file_again, FILTER | LANDLOCK },
    { "opens relative to a descriptor", opens_relative, FILTER },
    { "opens by openat2", opens_in_a_newer_way, FILTER | LANDLOCK },
    { "opens to write", opens_to_write, FILTER | LANDLOCK },
    { "creates", creates, FILTER | LANDLOCK },
    { "removes", removes, FILTER | LANDLOCK },
    { "asks about a path", asks_about_a_path, FILTER },
    { "asks by statx", asks_in_a_newer_way, FILTER },
    { "asks whether a path is there", asks_whether_a_path_is_there, FILTER },
    { "reads a link", reads_a_link, FILTER },
    { "changes the file", changes_the_file, FILTER },
    { "makes a socket", makes_a_socket, FILTER },
    { "makes a process", makes_a_process, FILTER },
    { "makes a namespace", makes_a_namespace, FILTER },
    { "runs a program", runs_a_program, FILTER },
    { "signals its parent", signals_its_parent, FILTER },
    { "limits its parent", limits_its_parent, FILTER },
    { "has signals sent", has_signals_sent, FILTER },
    { "has signals sent in other ways", has_signals_sent_in_other_ways, FILTER },
    { "has signals switched on", has_signals_switched_on, FILTER },
    { "locks the file", locks_the_file, FILTER },
    { "controls a device", controls_a_device, FILTER },
    { "traces", traces, FILTER },
    { "reads its parent", reads_its_parent, FILTER },
    { "maps code", maps_code, FILTER },
    { "makes code", makes_code, FILTER },
    { "makes a memory file", makes_a_memory_file, FILTER },
    { "makes a ring", makes_a_ring, FILTER },
    { "raises its limits", raises_its_limits, 0 },
    { "takes more memory", takes_more_memory, 0 },
    { "cannot read its file", cannot_read_its_file, 0 },
    { "cannot copy its file", cannot_copy_its_file, 0 },
    { "cannot have memory", cannot_have_memory, 0 },
    { "cannot see its limits", cannot_see_its_limits, 0 },
    { "cannot have threads", cannot_have_threads, 0 },
};
#define ATTEMPTS ((int)(sizeof attempts / sizeof *attempts))

/* ---- the sandbox ---- */

static bool enter(int parts)
{
    wr_sandbox_limit(MEMORY, SECONDS);
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return false;
    if (parts & LANDLOCK) wr_sandbox_close_files();
    return !(parts & FILTER) || wr_sandbox_filter_calls();
}

/* One attempt in a child process; true if it succeeded. parts 0: as set up by the reader process. */
static bool is_done(int index, int parts)
{
    int status;
    *parent_place() = getpid();
    pid_t pid = fork();
    if (pid == 0) {
        int file = open("file", O_RDWR);
        dup2(file, FILE_FD);
        if (!(parts ? enter(parts) : wr_sandbox_enter(MEMORY, SECONDS))) _exit(2);
        _exit(attempts[index].done());
    }
    assert_int_equal(waitpid(pid, &status, 0), pid);
    if (!WIFEXITED(status) || WEXITSTATUS(status) > 1)
        fail_msg("'%s': ended with %d", attempts[index].what, status);
    return WEXITSTATUS(status) == 1;
}

static void write_files(void)
{
    FILE *file = fopen("file", "w");
    fputs("text", file);
    fclose(file);
    file = fopen("victim", "w");
    fclose(file);
}

static void a_caged_process_can_do_nothing_but_read_its_file(void **state)
{
    (void)state;
    if (SANITIZED) skip();
    write_files();
    for (int i = 0; i < ATTEMPTS; i++)
        if (is_done(i, 0)) fail_msg("a caged process %s", attempts[i].what);
}

static void the_filter_holds_where_landlock_is_missing(void **state)
{
    (void)state;
    if (SANITIZED) skip();
    write_files();
    for (int i = 0; i < ATTEMPTS; i++)
        if (is_done(i, FILTER)) fail_msg("without Landlock a caged process %s", attempts[i].what);
}

/* Available in kernels since 5.13. */
static bool has_landlock(void)
{
    return syscall(SYS_landlock_create_ruleset, NULL, 0, LANDLOCK_CREATE_RULESET_VERSION) >= 1;
}

/* Replaces the library's function: a filter that was never loaded. */
static bool unfiltered;

int seccomp_load(const scmp_filter_ctx filter)
{
    int (*load)(scmp_filter_ctx) = NULL;
    *(void **)&load = dlsym(RTLD_NEXT, "seccomp_load");
    return unfiltered ? 0 : load(filter);
}

static void entering_the_cage_takes_landlock_too(void **state)
{
    (void)state;
    if (SANITIZED || !has_landlock()) skip();
    write_files();
    unfiltered = true;
    for (int i = 0; i < ATTEMPTS; i++)
        if ((attempts[i].kept_by & LANDLOCK) && is_done(i, 0))
            fail_msg("a caged process without its filter %s", attempts[i].what);
    unfiltered = false;
}

static void landlock_keeps_files_by_itself(void **state)
{
    (void)state;
    if (SANITIZED || !has_landlock()) skip();
    write_files();
    for (int i = 0; i < ATTEMPTS; i++)
        if ((attempts[i].kept_by & LANDLOCK) && is_done(i, LANDLOCK))
            fail_msg("with Landlock alone a process %s", attempts[i].what);
}

/* Otherwise the tests above prove nothing. */
static void without_a_cage_most_of_it_works(void **state)
{
    (void)state;
    if (SANITIZED) skip();
    int done = 0;
    *parent_place() = getpid();
    write_files();
    for (int i = 0; i < ATTEMPTS && attempts[i].kept_by; i++) {
        pid_t pid = fork();
        int status;
        if (pid == 0) {
            int file = open("file", O_RDWR);
            dup2(file, FILE_FD);
            _exit(attempts[i].done());
        }
        assert_int_equal(waitpid(pid, &status, 0), pid);
        done += status == 0 ? 0 : 1;
    }
    assert_true(done >= 20); /* some need privileges that this process may lack */
}

static rlim_t limit_of(__rlimit_resource_t what)
{
    struct rlimit now;
    return getrlimit(what, &now) == 0 ? now.rlim_max : 0;
}

/* With root privileges a limit could be raised again. */
static void limits_are_set_and_no_rights_are_left(void **state)
{
    (void)state;
    int status;
    pid_t pid = fork();
    if (pid == 0) {
        struct __user_cap_header_struct whose = { _LINUX_CAPABILITY_VERSION_3, 0 };
        struct __user_cap_data_struct rights[_LINUX_CAPABILITY_U32S_3];
        wr_sandbox_limit(0, 20);
        if (syscall(SYS_capget, &whose, rights) != 0) _exit(2);
        for (int i = 0; i < _LINUX_CAPABILITY_U32S_3; i++)
            if (rights[i].effective || rights[i].permitted) _exit(3);
        if (limit_of(RLIMIT_CORE) != 0 || limit_of(RLIMIT_FSIZE) != 0) _exit(4);
        _exit(limit_of(RLIMIT_NOFILE) > 64 || limit_of(RLIMIT_CPU) > 21 ? 5 : 0);
    }
    assert_int_equal(waitpid(pid, &status, 0), pid);
    assert_int_equal(status, 0);
}

/* A process that computes for ever gets the reason of its end, and ends even if it ignores the signal. */
static void processor_time_is_limited(void **state)
{
    (void)state;
    for (int deaf = 0; deaf < 2; deaf++) {
        int status;
        pid_t pid = fork();
        if (pid == 0) {
            if (deaf) signal(SIGXCPU, SIG_IGN);
            else signal(SIGXCPU, SIG_DFL);
            if (!wr_sandbox_enter(MEMORY, 1)) _exit(2);
            for (volatile unsigned n = 0;; n++) continue;
        }
        assert_int_equal(waitpid(pid, &status, 0), pid);
        assert_true(WIFSIGNALED(status));
        assert_int_equal(WTERMSIG(status), deaf ? SIGKILL : SIGXCPU);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_caged_process_can_do_nothing_but_read_its_file),
        cmocka_unit_test(the_filter_holds_where_landlock_is_missing),
        cmocka_unit_test(entering_the_cage_takes_landlock_too),
        cmocka_unit_test(landlock_keeps_files_by_itself),
        cmocka_unit_test(without_a_cage_most_of_it_works),
        cmocka_unit_test(limits_are_set_and_no_rights_are_left),
        cmocka_unit_test(processor_time_is_limited),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
