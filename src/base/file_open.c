/* The one door to files that somebody else names. */
#include "base/file.h"

#include "base/error.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *kind_of(mode_t mode)
{
    if (S_ISDIR(mode)) return "a folder";
    if (S_ISFIFO(mode)) return "a pipe";
    if (S_ISSOCK(mode)) return "a socket";
    return S_ISCHR(mode) || S_ISBLK(mode) ? "a device" : "no regular file";
}

static bool check_kind(const char *path, const struct stat *info, WrError *err)
{
    if (S_ISREG(info->st_mode)) return true;
    return wr_fail(err, "%s: is %s; a file is needed", path, kind_of(info->st_mode));
}

/* Asked before it is opened, since opening a device may do things, and again after: it may be another now. */
static int open_regular(const char *path, int flags, struct stat *info, WrError *err)
{
    bool there = stat(path, info) == 0;
    if (there && !check_kind(path, info, err)) return -1;
    int fd = open(path, flags | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (fd < 0 || fstat(fd, info) != 0) wr_fail(err, "%s: %s", path, strerror(errno));
    else if (check_kind(path, info, err)) return fd;
    if (fd >= 0) close(fd);
    return -1;
}

static int open_to_read(const char *path, int flags, uint64_t limit, uint64_t *length, WrError *err)
{
    struct stat info;
    int fd = open_regular(path, O_RDONLY | flags, &info, err);
    if (fd < 0) return -1;
    if ((uint64_t)info.st_size > limit) {
        wr_fail(err, "%s: %.1f MB is over the limit of %.1f MB", path, (double)info.st_size / 1e6,
                (double)limit / 1e6);
        close(fd);
        return -1;
    }
    if (length) *length = (uint64_t)info.st_size;
    return fd;
}

int wr_file_open(const char *path, uint64_t limit, uint64_t *length, WrError *err)
{
    return open_to_read(path, 0, limit, length, err);
}

int wr_file_open_no_link(const char *path, uint64_t limit, uint64_t *length, WrError *err)
{
    return open_to_read(path, O_NOFOLLOW, limit, length, err);
}

int wr_file_create(const char *path, WrError *err)
{
    int flags = O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;
    int fd = open(path, flags, 0666);
    if (fd < 0) wr_fail(err, "%s: cannot be written: %s", path, strerror(errno));
    return fd;
}

size_t wr_file_peek(const char *path, void *bytes, size_t count)
{
    WrError err;
    uint64_t length;
    int fd = wr_file_open(path, WR_FILE_MOST, &length, &err);
    if (fd < 0) return 0;
    ssize_t n = pread(fd, bytes, count < length ? count : (size_t)length, 0);
    close(fd);
    return n > 0 ? (size_t)n : 0;
}
