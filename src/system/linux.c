/* What Linux and its C library add to POSIX (src/README.md): child processes, descriptors, permissions, file watches, large
   pages, threads. */
#include "system/system_internal.h"
#include "system/fd.h"
#include "system/file_watch.h"
#include "system/large_pages.h"
#include "system/path.h"
#include "system/process.h"
#include "system/shared_object.h"
#include "system/thread.h"

#include <endian.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <sys/xattr.h>
#include <time.h>
#include <unistd.h>

/* ---- child processes ---- */

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

/* ---- this process ---- */

/* Pages of address space, and resident pages. */
static bool read_pages(unsigned long long pages[2])
{
    FILE *file = fopen("/proc/self/statm", "re");
    if (!file) return false;
    bool good = fscanf(file, "%llu %llu", &pages[0], &pages[1]) == 2;
    fclose(file);
    return good;
}

uint64_t wr_process_space(void)
{
    unsigned long long pages[2];
    return read_pages(pages) ? pages[0] * (uint64_t)sysconf(_SC_PAGESIZE) : 0;
}

uint64_t wr_process_resident(void)
{
    unsigned long long pages[2];
    return read_pages(pages) ? pages[1] * (uint64_t)sysconf(_SC_PAGESIZE) : 0;
}

bool wr_process_program(char *path, size_t size)
{
    return wr_path_read_link("/proc/self/exe", path, size);
}

void wr_process_called(const char *argument)
{
    (void)argument;
}

bool wr_process_has_cage(void)
{
    return true;
}

bool wr_process_has_gpu(void)
{
    static const char device[] = "/dev/dri/renderD128";
    return wr_path_can_read(device) && wr_path_can_write(device);
}

static void (*at_end)(int);

static void call(int status, void *ctx)
{
    (void)ctx;
    at_end(status);
}

bool wr_process_at_end(void (*work)(int status))
{
    if (at_end) return false;
    at_end = work;
    return on_exit(call, NULL) == 0;
}

bool wr_process_die_with(WrPid parent)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    return (WrPid)getppid() == parent; /* else the parent died before the line above */
}

void wr_process_keep_rights(void)
{
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
}

/* True if every other thread of this process sleeps. */
static bool others_sleep(void)
{
    WrFolder *folder = wr_folder_open("/proc/self/task");
    bool asleep = true;
    if (!folder) return true;
    for (const char *name; (name = wr_folder_next(folder));) {
        char path[64], state = 'S';
        if (atoi(name) == getpid()) continue;
        snprintf(path, sizeof path, "/proc/self/task/%.20s/stat", name);
        FILE *file = fopen(path, "re");
        if (file && fscanf(file, "%*d (%*[^)]) %c", &state) == 1 && state != 'S') asleep = false;
        if (file) fclose(file);
    }
    wr_folder_close(folder);
    return asleep;
}

void wr_process_wait_for_threads(void)
{
    int quiet = 0;
    for (int ms = 0; ms < 3000 && quiet < 3; ms++) {
        quiet = others_sleep() ? quiet + 1 : 0;
        wr_thread_sleep_ms(1);
    }
}

/* ---- threads ---- */

#define NICENESS 5 /* below the priority of interactive threads */

void wr_cond_wait_ms(WrCond *cond, WrMutex *mutex, int ms)
{
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_sec += ms / 1000;
    until.tv_nsec += ms % 1000 * 1000000L;
    until.tv_sec += until.tv_nsec / 1000000000L;
    until.tv_nsec %= 1000000000L;
    pthread_cond_clockwait(&cond->it, &mutex->it, CLOCK_MONOTONIC, &until);
}

void wr_thread_step_back(void)
{
    /* on Linux this applies to the thread and its children */
    setpriority(PRIO_PROCESS, 0, NICENESS);
}

bool wr_thread_pin(WrPin *pin)
{
    cpu_set_t one, before;
    _Static_assert(sizeof before <= sizeof pin->before, "a set of processors fits");
    pin->held = false;
    if (sched_getaffinity(0, sizeof before, &before) != 0) return false;
    const int here = sched_getcpu();
    if (here < 0) return false;
    CPU_ZERO(&one);
    CPU_SET(here, &one);
    memcpy(pin->before, &before, sizeof before);
    pin->held = sched_setaffinity(0, sizeof one, &one) == 0;
    return pin->held;
}

void wr_thread_unpin(const WrPin *pin)
{
    cpu_set_t before;
    memcpy(&before, pin->before, sizeof before);
    if (pin->held) sched_setaffinity(0, sizeof before, &before);
}

/* ---- descriptors ---- */

void wr_fd_name(int fd, char name[WR_FD_NAME])
{
    snprintf(name, WR_FD_NAME, "/proc/self/fd/%d", fd);
}

void wr_fd_close_range(int from, int to)
{
    close_range((unsigned)from, to < 0 ? ~0U : (unsigned)to, 0);
}

void wr_fd_begin_sync(int fd)
{
    sync_file_range(fd, 0, 0, SYNC_FILE_RANGE_WRITE);
}

int wr_fd_copy_blocks(int from, int to)
{
    bool any = false;
    for (;;) {
        ssize_t n = copy_file_range(from, NULL, to, NULL, (size_t)1 << 30, 0);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0 && any) return -1;
        if (n < 0 || (n == 0 && !any)) return 0;
        if (n == 0) return 1;
        any = true;
    }
}

void wr_fd_punch_hole(int fd, int64_t at, int64_t length)
{
    fallocate(fd, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, (off_t)at, (off_t)length);
}

int wr_fd_memory(const char *name)
{
    return memfd_create(name, MFD_CLOEXEC);
}

int wr_fd_memory_fixed(const char *name, size_t bytes)
{
    int fd = memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING);
    if (fd < 0) return -1;
    if (ftruncate(fd, (off_t)bytes) == 0 &&
        fcntl(fd, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) == 0)
        return fd;
    close(fd);
    return -1;
}

bool wr_fd_pipe(int ends[2], bool wait)
{
    return pipe2(ends, O_CLOEXEC | (wait ? 0 : O_NONBLOCK)) == 0;
}

bool wr_random_bytes(void *bytes, size_t length)
{
    return getrandom(bytes, length, 0) == (ssize_t)length;
}

/* ---- file permissions ---- */

#define ACL "system.posix_acl_access"
#define ACL_PASSED_ON "system.posix_acl_default"
#define ACL_MAX 65536 /* bytes of an access control list */

static mode_t read_umask(void)
{
    char text[2048];
    int fd = wr_fd_open("/proc/self/status", WR_OPEN_READ);
    int64_t n = fd < 0 ? -1 : wr_fd_read(fd, text, sizeof text - 1);
    if (fd >= 0) wr_fd_close(fd);
    text[n > 0 ? n : 0] = '\0';
    const char *line = strstr(text, "\nUmask:");
    if (line) return (mode_t)strtoul(line + 7, NULL, 8);
    mode_t mask = umask(0077); /* without /proc the mask can be read only by setting it */
    umask(mask);
    return mask;
}

/* Rights that a folder's default list sets for new files, as a mode: owner, mask or else group, others.
   A list consists of a 32-bit version and 64-bit entries: kind, rights, id; linux/posix_acl_xattr.h. */
static mode_t passed_on(const char *list, size_t length)
{
    mode_t owner = 0, group = 0, mask = 0, others = 0;
    bool masked = false;
    for (size_t at = 4; at + 8 <= length; at += 8) {
        uint16_t kind, may;
        memcpy(&kind, list + at, sizeof kind);
        memcpy(&may, list + at + 2, sizeof may);
        kind = le16toh(kind);
        may = le16toh(may);
        if (kind == 1) owner = may;
        if (kind == 4) group = may;
        if (kind == 16) mask = may;
        if (kind == 32) others = may;
        masked = masked || kind == 16;
    }
    return (owner & 7) << 6 | ((masked ? mask : group) & 7) << 3 | (others & 7);
}

mode_t wr_rights_of_new(const char *folder)
{
    char list[ACL_MAX];
    ssize_t length = getxattr(folder, ACL_PASSED_ON, list, sizeof list);
    return length > 0 ? passed_on(list, (size_t)length) : ~read_umask();
}

bool wr_rights_copy_list(int fd, const char *path, bool same_group)
{
    char list[ACL_MAX];
    ssize_t length = getxattr(path, ACL, list, sizeof list);
    if (length > 0) return same_group && fsetxattr(fd, ACL, list, (size_t)length, 0) == 0;
    fremovexattr(fd, ACL); /* may have been inherited from the folder */
    return true;
}

/* ---- file watches ---- */

#define WANTED (IN_CLOSE_WRITE | IN_MOVED_TO | IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR)

typedef struct Mark {
    int folder; /* inotify's watch number */
    char name[NAME_MAX + 1];
} Mark;

struct WrWatch {
    int fd;
    int count, room;
    Mark *marks; /* each path and its link target */
};

static bool add(WrWatch *watch, const char *path)
{
    char folder[PATH_MAX];
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const size_t length = !slash ? 0 : slash == path ? 1 : (size_t)(slash - path);
    if (length >= sizeof folder || strlen(name) > NAME_MAX) {
        errno = ENAMETOOLONG;
        return false;
    }
    if (slash) memcpy(folder, path, length);
    folder[length] = '\0';
    if (watch->count == watch->room) {
        const int room = 2 * watch->room + 2;
        Mark *grown = realloc(watch->marks, (size_t)room * sizeof *grown);
        if (!grown) return false;
        watch->marks = grown;
        watch->room = room;
    }
    Mark *mark = &watch->marks[watch->count];
    strcpy(mark->name, name);
    mark->folder = inotify_add_watch(watch->fd, slash ? folder : ".", WANTED);
    if (mark->folder < 0) return false;
    for (int i = 0; i < watch->count; i++)
        if (watch->marks[i].folder == mark->folder && strcmp(watch->marks[i].name, name) == 0)
            return true;
    watch->count++;
    return true;
}

bool wr_watch_add(WrWatch *watch, const char *path)
{
    const bool good = add(watch, path);
    char *real = good ? wr_path_real(path) : NULL;
    if (real) add(watch, real);
    free(real);
    return good;
}

WrWatch *wr_watch_new(const char *path)
{
    WrWatch *watch = calloc(1, sizeof *watch);
    if (!watch) return NULL;
    watch->fd = inotify_init1(IN_CLOEXEC | IN_NONBLOCK);
    if (watch->fd >= 0 && wr_watch_add(watch, path)) return watch;
    const int why = errno;
    if (watch->fd >= 0) close(watch->fd);
    free(watch->marks);
    free(watch);
    errno = why;
    return NULL;
}

void wr_watch_free(WrWatch *watch)
{
    if (!watch) return;
    close(watch->fd);
    free(watch->marks);
    free(watch);
}

static WrWatchEnd judge(const WrWatch *watch, const struct inotify_event *event)
{
    if (event->mask & IN_Q_OVERFLOW) return WR_WATCH_CHANGED; /* possibly */
    for (int i = 0; i < watch->count; i++) {
        if (event->wd != watch->marks[i].folder) continue;
        if (event->mask & (IN_DELETE_SELF | IN_MOVE_SELF)) return WR_WATCH_LOST;
        if (event->len > 0 && strcmp(event->name, watch->marks[i].name) == 0)
            return event->mask & IN_MOVED_TO ? WR_WATCH_REPLACED : WR_WATCH_CHANGED;
    }
    return WR_WATCH_NOTHING;
}

/* Processes all pending events. */
static WrWatchEnd take(WrWatch *watch)
{
    _Alignas(struct inotify_event) char block[16 * (sizeof(struct inotify_event) + NAME_MAX + 1)];
    WrWatchEnd end = WR_WATCH_NOTHING;
    for (ssize_t n; (n = read(watch->fd, block, sizeof block)) > 0;)
        for (ssize_t at = 0; at < n;) {
            const struct inotify_event *event = (const struct inotify_event *)(block + at);
            const WrWatchEnd one = judge(watch, event);
            if (one > end) end = one;
            at += (ssize_t)(sizeof *event + event->len);
        }
    return end;
}

WrWatchEnd wr_watch_wait(WrWatch *watch, double seconds)
{
    const double ms = seconds * 1000.0;
    struct pollfd one = { .fd = watch->fd, .events = POLLIN };
    if (poll(&one, 1, ms < INT_MAX ? (int)ms + 1 : INT_MAX) <= 0) return WR_WATCH_NOTHING;
    return take(watch);
}

/* ---- large pages ---- */

#define LARGE ((uintptr_t)2 << 20) /* size on most processors; others round by themselves */

static void advise(void *block, size_t bytes, int advice)
{
    const uintptr_t start = (uintptr_t)block, from = (start + LARGE - 1) & ~(LARGE - 1);
    const uintptr_t to = (start + bytes) & ~(LARGE - 1);
    if (to > from) madvise((char *)block + (from - start), to - from, advice);
}

void wr_pages_large(void *block, size_t bytes)
{
    advise(block, bytes, MADV_HUGEPAGE);
}

void wr_pages_small(void *block, size_t bytes)
{
    advise(block, bytes, MADV_NOHUGEPAGE);
}

uint64_t wr_pages_free_bytes(void)
{
    char line[128];
    unsigned long long kilobytes = 0;
    FILE *file = fopen("/proc/meminfo", "re");
    if (!file) return 0;
    while (fgets(line, sizeof line, file))
        if (sscanf(line, "MemAvailable: %llu", &kilobytes) == 1) break;
    fclose(file);
    return (uint64_t)kilobytes * 1024;
}

/* ---- shared libraries ---- */

bool wr_object_path(const void *symbol, char *path, size_t size)
{
    Dl_info info;
    if (!dladdr(symbol, &info) || !info.dli_fname) return false;
    return (size_t)snprintf(path, size, "%s", info.dli_fname) < size;
}
