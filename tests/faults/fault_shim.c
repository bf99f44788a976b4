/* Implementation of fault.h. System calls are made directly, since this library replaces the C library's
   functions. */
#include "fault.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#define SHOWN __attribute__((visibility("default")))

SHOWN const char *const wr_fault_kinds[FAULT_KINDS] = { "open",   "write", "truncate", "sync",
                                                        "rename", "link",  "unlink",   "close" };
SHOWN const char *const wr_fault_modes[FAULT_MODES] = { "count", "error", "short", "kill", "torn",
                                                        "plant", "flip",  "drop",  "stuck" };
SHOWN const char *const wr_fault_places[FAULT_PLACES] = { "part", "journal", "memory", "folder",
                                                          "other" };
SHOWN const char *const wr_fault_stages[FAULT_STAGES] = { "before", "writing", "synced",
                                                          "renamed" };

static FaultState *state;

/* ---- unsynced files ---- */

#define PENDING_MAX 64

static struct {
    dev_t device;
    ino_t inode;
} pending[PENDING_MAX];
static int pending_count, pending_held;

static void hold_written(void)
{
    while (__atomic_exchange_n(&pending_held, 1, __ATOMIC_ACQUIRE)) continue;
}

static void let_go_written(void)
{
    state->unsynced = pending_count;
    __atomic_store_n(&pending_held, 0, __ATOMIC_RELEASE);
}

static int place_of_written(const struct stat *info)
{
    int i = 0;
    while (i < pending_count &&
           (pending[i].device != info->st_dev || pending[i].inode != info->st_ino))
        i++;
    return i;
}

static void note_written(int fd)
{
    struct stat info;
    if (syscall(SYS_newfstatat, fd, "", &info, AT_EMPTY_PATH) != 0) return;
    hold_written();
    int i = place_of_written(&info);
    if (i == pending_count && i < PENDING_MAX) {
        pending[i].device = info.st_dev;
        pending[i].inode = info.st_ino;
        pending_count++;
    }
    let_go_written();
}

/* True if the file was not synced; its record is removed. */
static bool forget_written(int folder, const char *path, int flags)
{
    struct stat info;
    int saved = errno;
    bool there = syscall(SYS_newfstatat, folder, path, &info, flags) == 0;
    errno = saved;
    if (!there) return false;
    hold_written();
    int i = place_of_written(&info);
    bool found = i < pending_count;
    if (found) pending[i] = pending[--pending_count];
    let_go_written();
    return found;
}

/* ---- orders ---- */

static int index_of(const char *word, size_t length, const char *const *words, int count)
{
    for (int i = 0; i < count; i++)
        if (strlen(words[i]) == length && memcmp(words[i], word, length) == 0) return i;
    return -1;
}

/* Parse "write,3,error,28". */
static void take_orders(const char *text)
{
    const char *comma = strchr(text, ',');
    if (!comma) return;
    int kind = index_of(text, (size_t)(comma - text), wr_fault_kinds, FAULT_KINDS);
    char *rest;
    long long n = strtoll(comma + 1, &rest, 10);
    if (kind < 0 || *rest != ',') return;
    const char *word = rest + 1;
    size_t length = strcspn(word, ",");
    int mode = index_of(word, length, wr_fault_modes, FAULT_MODES);
    if (mode < 0) return;
    wr_fault_arm((FaultKind)kind, n, (FaultMode)mode, word[length] ? atoi(word + length + 1) : 28);
}

__attribute__((constructor)) static void begin(void)
{
    const char *orders = getenv("WR_FAULT"), *report = getenv("WR_FAULT_REPORT");
    char program[256];
    ssize_t n = readlink("/proc/self/exe", program, sizeof program - 1);
    program[n > 0 ? n : 0] = '\0';
    const char *slash = strrchr(program, '/');
    bool reader = slash && strcmp(slash, "/wrinkle-reader") == 0;
    int fd = report && !reader
                 ? (int)syscall(SYS_openat, AT_FDCWD, report, O_RDWR | O_CREAT | O_CLOEXEC, 0600)
                 : -1;
    if (fd >= 0 && syscall(SYS_ftruncate, fd, (off_t)sizeof *state) != 0) {
        syscall(SYS_close, fd);
        fd = -1;
    }
    void *map = mmap(NULL, sizeof *state, PROT_READ | PROT_WRITE,
                     MAP_SHARED | (fd < 0 ? MAP_ANONYMOUS : 0), fd, 0);
    if (fd >= 0) syscall(SYS_close, fd);
    state = map == MAP_FAILED ? NULL : map;
    if (state && orders && !reader) take_orders(orders);
}

SHOWN FaultState *wr_fault_state(void)
{
    return state;
}

SHOWN void wr_fault_arm(FaultKind kind, int64_t n, FaultMode mode, int error)
{
    *state = (FaultState){ .kind = (int)kind, .mode = (int)mode, .error = error, .n = n };
    pending_count = 0;
    state->armed = 1;
}

/* ---- selection of the call ---- */

static FaultPlace place_of_path(const char *path)
{
    if (strstr(path, ".part")) return FAULT_PART;
    if (strstr(path, "/journals/") || strstr(path, ".wj")) return FAULT_JOURNAL;
    return FAULT_OTHER;
}

/* False for descriptors that store no bytes. */
static bool place_of(int fd, FaultPlace *place)
{
    struct stat info;
    char link[64], path[4096];
    if (syscall(SYS_newfstatat, fd, "", &info, AT_EMPTY_PATH) != 0) return false;
    if (S_ISDIR(info.st_mode)) {
        *place = FAULT_FOLDER;
        return true;
    }
    if (!S_ISREG(info.st_mode)) return false;
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    ssize_t n = readlink(link, path, sizeof path - 1);
    path[n > 0 ? n : 0] = '\0';
    *place = strncmp(path, "/memfd:", 7) == 0 ? FAULT_MEMORY : place_of_path(path);
    return true;
}

/* True for modes that report success. */
static bool is_silent(void)
{
    return state->mode == FAULT_FLIP || state->mode == FAULT_DROP;
}

/* Count a call; true for the selected one, unless the program ends here. */
static bool is_the_one(FaultKind kind, FaultPlace place)
{
    /* Memory files are reliable; only calls that reach the disk are counted. */
    if (is_silent() && place == FAULT_MEMORY) return false;
    int64_t n = __atomic_add_fetch(&state->counts[kind], 1, __ATOMIC_RELAXED);
    __atomic_add_fetch(&state->seen[kind][place], 1, __ATOMIC_RELAXED);
    if (state->mode == FAULT_COUNT || (int)kind != state->kind) return false;
    if (state->mode == FAULT_SHORT && n == state->n + 1 && state->fell) {
        errno = state->error;
        return true;
    }
    if (state->mode == FAULT_STUCK && n > state->n) {
        errno = state->error;
        return true;
    }
    /* three in a row */
    bool again = state->mode == FAULT_PLANT && n > state->n && n < state->n + 3;
    if (n != state->n && !again) return false;
    state->fell = 1;
    state->fell_place = (int)place;
    state->fell_stage = state->stage;
    if (state->mode == FAULT_KILL) kill(getpid(), SIGKILL);
    errno = state->error;
    return true;
}

static bool fails(FaultKind kind, int fd)
{
    FaultPlace place;
    int saved = errno;
    if (!state || !state->armed || !place_of(fd, &place)) return false;
    if (kind == FAULT_WRITE && place != FAULT_MEMORY) note_written(fd);
    errno = saved;
    return is_the_one(kind, place);
}

static bool fails_path(FaultKind kind, const char *path)
{
    return state && state->armed && is_the_one(kind, place_of_path(path));
}

static void reach(FaultStage stage)
{
    if (state && state->armed) state->stage = (int)stage;
}

/* Bytes that a failing write still writes; -1: it fails. */
static ssize_t falls_short(size_t length)
{
    bool first = state->counts[FAULT_WRITE] == state->n;
    return first && (state->mode == FAULT_SHORT || state->mode == FAULT_TORN) && length > 1
               ? (ssize_t)(length / 2)
               : -1;
}

static ssize_t torn(ssize_t written)
{
    if (state->mode == FAULT_TORN) kill(getpid(), SIGKILL);
    return written;
}

/* Write with one bit flipped in the middle, or not at all. `at`: negative for the descriptor's position. */
static ssize_t silently(int fd, const void *bytes, size_t length, off_t at)
{
    if (state->mode == FAULT_DROP || length == 0) {
        if (at < 0) syscall(SYS_lseek, fd, (off_t)length, SEEK_CUR);
        return (ssize_t)length;
    }
    char *other = malloc(length);
    memcpy(other, bytes, length);
    other[length / 2] ^= 1;
    ssize_t done = at < 0 ? syscall(SYS_write, fd, other, length)
                          : syscall(SYS_pwrite64, fd, other, length, at);
    free(other);
    return done;
}

/* ---- the calls ---- */

SHOWN ssize_t write(int fd, const void *bytes, size_t length);
SHOWN ssize_t write(int fd, const void *bytes, size_t length)
{
    if (!fails(FAULT_WRITE, fd)) return syscall(SYS_write, fd, bytes, length);
    if (is_silent()) return silently(fd, bytes, length, -1);
    ssize_t half = falls_short(length);
    return half < 0 ? half : torn(syscall(SYS_write, fd, bytes, half));
}

SHOWN ssize_t pwrite(int fd, const void *bytes, size_t length, off_t at);
SHOWN ssize_t pwrite(int fd, const void *bytes, size_t length, off_t at)
{
    if (!fails(FAULT_WRITE, fd)) return syscall(SYS_pwrite64, fd, bytes, length, at);
    if (is_silent()) return silently(fd, bytes, length, at);
    ssize_t half = falls_short(length);
    return half < 0 ? half : torn(syscall(SYS_pwrite64, fd, bytes, half, at));
}

SHOWN ssize_t pwrite64(int fd, const void *bytes, size_t length, off_t at);
SHOWN ssize_t pwrite64(int fd, const void *bytes, size_t length, off_t at)
{
    return pwrite(fd, bytes, length, at);
}

SHOWN ssize_t writev(int fd, const struct iovec *parts, int count);
SHOWN ssize_t writev(int fd, const struct iovec *parts, int count)
{
    if (!fails(FAULT_WRITE, fd)) return syscall(SYS_writev, fd, parts, count);
    if (is_silent() && count > 0) return silently(fd, parts[0].iov_base, parts[0].iov_len, -1);
    ssize_t half = count > 0 ? falls_short(parts[0].iov_len) : -1;
    return half < 0 ? half : torn(syscall(SYS_write, fd, parts[0].iov_base, half));
}

SHOWN ssize_t copy_file_range(int from, off_t *from_at, int to, off_t *to_at, size_t length,
                              unsigned flags);
SHOWN ssize_t copy_file_range(int from, off_t *from_at, int to, off_t *to_at, size_t length,
                              unsigned flags)
{
    if (fails(FAULT_WRITE, to) && !is_silent()) return -1;
    return syscall(SYS_copy_file_range, from, from_at, to, to_at, length, flags);
}

SHOWN size_t fwrite(const void *bytes, size_t size, size_t count, FILE *file);
SHOWN size_t fwrite(const void *bytes, size_t size, size_t count, FILE *file)
{
    size_t (*real)(const void *, size_t, size_t, FILE *);
    *(void **)&real = dlsym(RTLD_NEXT, "fwrite");
    if (!fails(FAULT_WRITE, fileno(file))) return real(bytes, size, count, file);
    if (!is_silent()) return 0;
    return silently(fileno(file), bytes, size * count, -1) < 0 ? 0 : count;
}

SHOWN int fputs(const char *text, FILE *file);
SHOWN int fputs(const char *text, FILE *file)
{
    int (*real)(const char *, FILE *);
    *(void **)&real = dlsym(RTLD_NEXT, "fputs");
    if (!fails(FAULT_WRITE, fileno(file))) return real(text, file);
    if (!is_silent()) return EOF;
    return silently(fileno(file), text, strlen(text), -1) < 0 ? EOF : 0;
}

SHOWN int ftruncate(int fd, off_t length);
SHOWN int ftruncate(int fd, off_t length)
{
    return fails(FAULT_TRUNCATE, fd) ? -1 : (int)syscall(SYS_ftruncate, fd, length);
}

SHOWN int ftruncate64(int fd, off_t length);
SHOWN int ftruncate64(int fd, off_t length)
{
    return ftruncate(fd, length);
}

static int sync_by(long call, int fd)
{
    FaultPlace place;
    if (fails(FAULT_SYNC, fd)) return -1;
    int done = (int)syscall(call, fd);
    if (state && state->armed && done == 0) forget_written(fd, "", AT_EMPTY_PATH);
    if (state && state->armed && place_of(fd, &place) && place == FAULT_PART) reach(FAULT_SYNCED);
    return done;
}

SHOWN int fsync(int fd);
SHOWN int fsync(int fd)
{
    return sync_by(SYS_fsync, fd);
}

SHOWN int fdatasync(int fd);
SHOWN int fdatasync(int fd)
{
    return sync_by(SYS_fdatasync, fd);
}

SHOWN int renameat2(int a, const char *from, int b, const char *to, unsigned flags);
SHOWN int renameat2(int a, const char *from, int b, const char *to, unsigned flags)
{
    if (fails_path(FAULT_RENAME, from)) return -1;
    if (state && state->armed && forget_written(a, from, AT_SYMLINK_NOFOLLOW)) state->careless++;
    int done = (int)syscall(SYS_renameat2, a, from, b, to, flags);
    if (place_of_path(from) == FAULT_PART) reach(FAULT_RENAMED);
    return done;
}

SHOWN int rename(const char *from, const char *to);
SHOWN int rename(const char *from, const char *to)
{
    return renameat2(AT_FDCWD, from, AT_FDCWD, to, 0);
}

SHOWN int renameat(int a, const char *from, int b, const char *to);
SHOWN int renameat(int a, const char *from, int b, const char *to)
{
    return renameat2(a, from, b, to, 0);
}

SHOWN int linkat(int a, const char *from, int b, const char *to, int flags);
SHOWN int linkat(int a, const char *from, int b, const char *to, int flags)
{
    return fails_path(FAULT_LINK, to) ? -1 : (int)syscall(SYS_linkat, a, from, b, to, flags);
}

SHOWN int link(const char *from, const char *to);
SHOWN int link(const char *from, const char *to)
{
    return linkat(AT_FDCWD, from, AT_FDCWD, to, 0);
}

SHOWN int unlink(const char *path);
SHOWN int unlink(const char *path)
{
    return fails_path(FAULT_UNLINK, path) ? -1 : (int)syscall(SYS_unlinkat, AT_FDCWD, path, 0);
}

SHOWN int unlinkat(int folder, const char *path, int flags);
SHOWN int unlinkat(int folder, const char *path, int flags)
{
    return fails_path(FAULT_UNLINK, path) ? -1 : (int)syscall(SYS_unlinkat, folder, path, flags);
}

/* A descriptor is closed even if close fails. */
SHOWN int close(int fd);
SHOWN int close(int fd)
{
    bool failed = fails(FAULT_CLOSE, fd);
    int error = errno, done = (int)syscall(SYS_close, fd);
    if (failed) errno = error;
    return failed ? -1 : done;
}

SHOWN int fclose(FILE *file);
SHOWN int fclose(FILE *file)
{
    int (*real)(FILE *);
    *(void **)&real = dlsym(RTLD_NEXT, "fclose");
    bool failed = fails(FAULT_CLOSE, fileno(file));
    int error = errno, done = real(file);
    if (failed) errno = error;
    return failed ? EOF : done;
}

static int open_by(int folder, const char *path, int flags, mode_t mode)
{
    bool device = strncmp(path, "/dev/", 5) == 0 && strncmp(path, "/dev/shm/", 9) != 0;
    bool writes = (flags & O_ACCMODE) != O_RDONLY && !device;
    if (writes && fails_path(FAULT_OPEN, path)) {
        if (state->mode != FAULT_PLANT) return -1;
        if ((flags & O_CREAT) && syscall(SYS_symlinkat, state->victim, folder, path) == 0)
            snprintf(state->planted[state->plants++ % 3], sizeof *state->planted, "%s", path);
    }
    int fd = (int)syscall(SYS_openat, folder, path, flags, mode);
    if (fd >= 0 && (flags & O_CREAT) && place_of_path(path) == FAULT_PART) reach(FAULT_WRITING);
    return fd;
}

#define MODE_OF(mode, flags)                                                                       \
    mode_t mode = 0;                                                                               \
    if ((flags) & (O_CREAT | O_TMPFILE)) {                                                         \
        va_list list;                                                                              \
        va_start(list, flags);                                                                     \
        mode = va_arg(list, mode_t);                                                               \
        va_end(list);                                                                              \
    }

SHOWN int open(const char *path, int flags, ...);
SHOWN int open(const char *path, int flags, ...)
{
    MODE_OF(mode, flags)
    return open_by(AT_FDCWD, path, flags, mode);
}

SHOWN int open64(const char *path, int flags, ...);
SHOWN int open64(const char *path, int flags, ...)
{
    MODE_OF(mode, flags)
    return open_by(AT_FDCWD, path, flags, mode);
}

SHOWN int openat(int folder, const char *path, int flags, ...);
SHOWN int openat(int folder, const char *path, int flags, ...)
{
    MODE_OF(mode, flags)
    return open_by(folder, path, flags, mode);
}

SHOWN int openat64(int folder, const char *path, int flags, ...);
SHOWN int openat64(int folder, const char *path, int flags, ...)
{
    MODE_OF(mode, flags)
    return open_by(folder, path, flags, mode);
}
