/* The reader process replaces open, fopen, stat and access for the one file it was given: they return
   the descriptor that is already open. So decoders that insist on a path work without the right to open
   files. The replacements precede the C library's functions for every library of this process; all
   other paths go to the system, which rejects them in the sandbox. The symbols are weak because their
   names lack the project prefix. C code uses other names, because the headers may declare these
   functions inline. */
#include "system/open_interposer.h"

#include "system/fd.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

/* sanitizers have replacements of their own */
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#define STANDS_FOR(name) __asm__(name) __attribute__((weak))

int wr_interposed_open(const char *path, int flags, ...) STANDS_FOR("open");
int wr_interposed_open64(const char *path, int flags, ...) STANDS_FOR("open64");
FILE *wr_interposed_fopen(const char *path, const char *mode) STANDS_FOR("fopen");
FILE *wr_interposed_fopen64(const char *path, const char *mode) STANDS_FOR("fopen64");
int wr_interposed_access(const char *path, int mode) STANDS_FOR("access");
int wr_interposed_stat(const char *path, struct stat *info) STANDS_FOR("stat");
int wr_interposed_stat64(const char *path, struct stat *info) STANDS_FOR("stat64");
int wr_interposed_fstat(int fd, struct stat *info) STANDS_FOR("fstat");
int wr_interposed_fstat64(int fd, struct stat *info) STANDS_FOR("fstat64");

static bool is_the_file(const char *path)
{
    char name[WR_FD_NAME];
    wr_fd_name(WR_INTERPOSED_FILE, name);
    return strcmp(path, name) == 0;
}

/* Positioned at the beginning. The offset is shared by all duplicates: decoders open one at a time. */
static int copy(void)
{
    int fd = fcntl(WR_INTERPOSED_FILE, F_DUPFD_CLOEXEC, 0);
    if (fd >= 0) lseek(fd, 0, SEEK_SET);
    return fd;
}

static int open_path(const char *path, int flags, va_list *rest)
{
    int mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(*rest, int) : 0;
    if (is_the_file(path) && (flags & O_ACCMODE) == O_RDONLY) return copy();
    return (int)syscall(SYS_openat, AT_FDCWD, path, flags, mode);
}

int wr_interposed_open(const char *path, int flags, ...)
{
    va_list rest;
    va_start(rest, flags);
    int fd = open_path(path, flags, &rest);
    va_end(rest);
    return fd;
}

int wr_interposed_open64(const char *path, int flags, ...)
{
    va_list rest;
    va_start(rest, flags);
    int fd = open_path(path, flags, &rest);
    va_end(rest);
    return fd;
}

FILE *wr_interposed_fopen(const char *path, const char *mode)
{
    if (!is_the_file(path) || mode[0] != 'r' || strchr(mode, '+')) {
        union {
            void *found;
            FILE *(*call)(const char *, const char *);
        } next = { .found = dlsym(RTLD_NEXT, "fopen") };
        return next.call(path, mode);
    }
    int fd = copy();
    FILE *file = fd < 0 ? NULL : fdopen(fd, "rb");
    if (fd >= 0 && !file) close(fd);
    return file;
}

FILE *wr_interposed_fopen64(const char *path, const char *mode)
{
    return wr_interposed_fopen(path, mode);
}

int wr_interposed_access(const char *path, int mode)
{
    if (is_the_file(path) && !(mode & (W_OK | X_OK))) return 0;
    return (int)syscall(SYS_faccessat, AT_FDCWD, path, mode);
}

/* The C library's fstat passes an empty path, which the filter rejects. */
int wr_interposed_fstat(int fd, struct stat *info)
{
    return (int)syscall(SYS_fstat, fd, info);
}

int wr_interposed_fstat64(int fd, struct stat *info)
{
    return wr_interposed_fstat(fd, info);
}

int wr_interposed_stat(const char *path, struct stat *info)
{
    if (is_the_file(path)) return wr_interposed_fstat(WR_INTERPOSED_FILE, info);
    return (int)syscall(SYS_newfstatat, AT_FDCWD, path, info, 0);
}

int wr_interposed_stat64(const char *path, struct stat *info)
{
    return wr_interposed_stat(path, info);
}

#endif
