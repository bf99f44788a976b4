/* Opening of files named by others (file.h). */
#include "base/file.h"

#include "base/error.h"
#include "system/fd.h"
#include "system/path.h"

#include <errno.h>
#include <string.h>

static const char *const kinds[] = {
    [WR_KIND_FILE] = "a file",          [WR_KIND_FOLDER] = "a folder",
    [WR_KIND_LINK] = "a link",          [WR_KIND_PIPE] = "a pipe",
    [WR_KIND_SOCKET] = "a socket",      [WR_KIND_DEVICE] = "a device",
    [WR_KIND_OTHER] = "no regular file"
};

static bool check_kind(const char *path, const WrFileInfo *info, WrError *err)
{
    if (info->kind == WR_KIND_FILE) return true;
    return wr_fail(err, "%s: is %s; a file is needed", path, kinds[info->kind]);
}

/* The kind is checked before opening, since opening a device may have effects, and again after it: the
 * file may have been replaced. */
static int open_regular(const char *path, unsigned how, WrFileInfo *info, WrError *err)
{
    bool there = wr_path_info(path, info);
    if (there && !check_kind(path, info, err)) return -1;
    int fd = wr_fd_open(path, how | WR_OPEN_NO_WAIT);
    if (fd < 0 || !wr_fd_info(fd, info)) wr_fail(err, "%s: %s", path, strerror(errno));
    else if (check_kind(path, info, err)) return fd;
    if (fd >= 0) wr_fd_close(fd);
    return -1;
}

static int open_to_read(const char *path, unsigned how, uint64_t limit, uint64_t *length,
                        WrError *err)
{
    WrFileInfo info;
    int fd = open_regular(path, WR_OPEN_READ | how, &info, err);
    if (fd < 0) return -1;
    if ((uint64_t)info.bytes > limit) {
        wr_fail(err, "%s: %.1f MB is over the limit of %.1f MB", path, (double)info.bytes / 1e6,
                (double)limit / 1e6);
        wr_fd_close(fd);
        return -1;
    }
    if (length) *length = (uint64_t)info.bytes;
    return fd;
}

int wr_file_open(const char *path, uint64_t limit, uint64_t *length, WrError *err)
{
    return open_to_read(path, 0, limit, length, err);
}

int wr_file_open_no_link(const char *path, uint64_t limit, uint64_t *length, WrError *err)
{
    return open_to_read(path, WR_OPEN_NO_LINK, limit, length, err);
}

int wr_file_create(const char *path, WrError *err)
{
    int fd = wr_fd_open(path, WR_OPEN_WRITE | WR_OPEN_CREATE | WR_OPEN_EMPTY | WR_OPEN_NO_WAIT);
    if (fd < 0) wr_fail(err, "%s: cannot be written: %s", path, strerror(errno));
    return fd;
}

size_t wr_file_peek(const char *path, void *bytes, size_t count)
{
    WrError err;
    uint64_t length;
    int fd = wr_file_open(path, WR_FILE_MOST, &length, &err);
    if (fd < 0) return 0;
    int64_t n = wr_fd_read_at(fd, bytes, count < length ? count : (size_t)length, 0);
    wr_fd_close(fd);
    return n > 0 ? (size_t)n : 0;
}
