#include "system/fd.h"

#include "system/system_internal.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <unistd.h>

static WrKind kind_of(mode_t mode)
{
    if (S_ISREG(mode)) return WR_KIND_FILE;
    if (S_ISDIR(mode)) return WR_KIND_FOLDER;
    if (S_ISLNK(mode)) return WR_KIND_LINK;
    if (S_ISFIFO(mode)) return WR_KIND_PIPE;
    if (S_ISSOCK(mode)) return WR_KIND_SOCKET;
    return S_ISCHR(mode) || S_ISBLK(mode) ? WR_KIND_DEVICE : WR_KIND_OTHER;
}

/* Apple's names of the time members are older than the standard's. */
#ifdef __APPLE__
#define st_mtim st_mtimespec
#define st_ctim st_ctimespec
#endif

void wr_fd_info_of(const struct stat *from, WrFileInfo *to)
{
    *to = (WrFileInfo){ .kind = kind_of(from->st_mode),
                        .device = (uint64_t)from->st_dev,
                        .inode = (uint64_t)from->st_ino,
                        .links = (uint64_t)from->st_nlink,
                        .bytes = (int64_t)from->st_size,
                        .seconds = (int64_t)from->st_mtim.tv_sec,
                        .nanoseconds = (int64_t)from->st_mtim.tv_nsec,
                        .changed_seconds = (int64_t)from->st_ctim.tv_sec,
                        .changed_nanoseconds = (int64_t)from->st_ctim.tv_nsec };
}

bool wr_fd_info(int fd, WrFileInfo *info)
{
    struct stat got;
    if (fstat(fd, &got) != 0) return false;
    wr_fd_info_of(&got, info);
    return true;
}

int wr_fd_flags(unsigned how)
{
    int flags = O_CLOEXEC;
    bool reads = (how & WR_OPEN_READ) != 0, writes = (how & WR_OPEN_WRITE) != 0;
    flags |= reads && writes ? O_RDWR : writes ? O_WRONLY : O_RDONLY;
    if (how & (WR_OPEN_CREATE | WR_OPEN_NEW)) flags |= O_CREAT;
    if (how & WR_OPEN_NEW) flags |= O_EXCL;
    if (how & WR_OPEN_EMPTY) flags |= O_TRUNC;
    if (how & WR_OPEN_APPEND) flags |= O_APPEND;
    if (how & WR_OPEN_NO_LINK) flags |= O_NOFOLLOW;
    if (how & WR_OPEN_NO_WAIT) flags |= O_NONBLOCK | O_NOCTTY;
    return flags;
}

int wr_fd_open(const char *path, unsigned how)
{
    return open(path, wr_fd_flags(how), how & WR_OPEN_PRIVATE ? 0600 : 0666);
}

bool wr_fd_close(int fd)
{
    return close(fd) == 0;
}

int wr_fd_copy(int fd)
{
    return fcntl(fd, F_DUPFD_CLOEXEC, 0);
}

FILE *wr_fd_stream(int fd, const char *mode)
{
    return fdopen(fd, mode);
}

bool wr_stream_seek(FILE *stream, int64_t at)
{
    return fseeko(stream, (off_t)at, SEEK_SET) == 0;
}

int64_t wr_stream_position(FILE *stream)
{
    return (int64_t)ftello(stream);
}

int wr_stream_byte(FILE *stream)
{
    return getc_unlocked(stream);
}

bool wr_stream_info(FILE *stream, WrFileInfo *info)
{
    return wr_fd_info(fileno(stream), info);
}

int wr_fd_reopen(int fd)
{
    char name[WR_FD_NAME];
    wr_fd_name(fd, name);
    return wr_fd_open(name, WR_OPEN_READ);
}

bool wr_fd_place(int fd, int to)
{
    return dup2(fd, to) == to;
}

int wr_fd_copy_above(int fd, int least)
{
    return fcntl(fd, F_DUPFD, least);
}

int wr_fd_open_nowhere(void)
{
    return wr_fd_open("/dev/null", WR_OPEN_READ | WR_OPEN_WRITE);
}

bool wr_fd_nowhere(int fd)
{
    int nothing = wr_fd_open_nowhere();
    bool good = nothing >= 0 && wr_fd_place(nothing, fd);
    if (nothing >= 0 && nothing != fd) close(nothing);
    return good;
}

/* ---- bytes ---- */

int64_t wr_fd_read(int fd, void *bytes, size_t length)
{
    ssize_t n;
    do n = read(fd, bytes, length);
    while (n < 0 && errno == EINTR);
    return (int64_t)n;
}

int64_t wr_fd_read_at(int fd, void *bytes, size_t length, int64_t at)
{
    ssize_t n;
    do n = pread(fd, bytes, length, (off_t)at);
    while (n < 0 && errno == EINTR);
    return (int64_t)n;
}

bool wr_fd_write(int fd, const void *bytes, size_t length)
{
    const char *from = bytes;
    while (length > 0) {
        ssize_t n = write(fd, from, length);
        if (n < 0 && errno == EINTR) continue;
        if (n == 0) errno = ENOSPC;
        if (n <= 0) return false;
        from += n;
        length -= (size_t)n;
    }
    return true;
}

bool wr_fd_write_at(int fd, const void *bytes, size_t length, int64_t at)
{
    const char *from = bytes;
    while (length > 0) {
        ssize_t n = pwrite(fd, from, length, (off_t)at);
        if (n < 0 && errno == EINTR) continue;
        if (n == 0) errno = ENOSPC;
        if (n <= 0) return false;
        from += n;
        at += n;
        length -= (size_t)n;
    }
    return true;
}

int64_t wr_fd_seek(int fd, int64_t at)
{
    return (int64_t)lseek(fd, (off_t)at, SEEK_SET);
}

int64_t wr_fd_position(int fd)
{
    return (int64_t)lseek(fd, 0, SEEK_CUR);
}

bool wr_fd_cut(int fd, int64_t length)
{
    return ftruncate(fd, (off_t)length) == 0;
}

bool wr_fd_sync(int fd)
{
    return fsync(fd) == 0;
}

bool wr_fd_sync_bytes(int fd)
{
#ifdef __APPLE__ /* macOS has the other call, and does not declare this one */
    return fsync(fd) == 0;
#else
    return fdatasync(fd) == 0;
#endif
}

bool wr_fd_lock(int fd, WrLock lock)
{
    const int kinds[] = {
        [WR_LOCK_NONE] = LOCK_UN, [WR_LOCK_SHARED] = LOCK_SH, [WR_LOCK_ALONE] = LOCK_EX
    };
    int done;
    do done = flock(fd, kinds[lock] | LOCK_NB);
    while (done != 0 && errno == EINTR);
    return done == 0;
}

/* ---- memory-mapped files ---- */

void *wr_map(int fd, size_t length, WrMapFor what)
{
    int may = what == WR_MAP_SHARE ? PROT_READ | PROT_WRITE : PROT_READ;
    void *bytes = mmap(NULL, length, may, what == WR_MAP_READ ? MAP_PRIVATE : MAP_SHARED, fd, 0);
    return bytes == MAP_FAILED ? NULL : bytes;
}

void wr_map_end(const void *bytes, size_t length)
{
    if (bytes) munmap((void *)bytes, length);
}
