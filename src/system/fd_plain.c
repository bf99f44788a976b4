/* Descriptors: fallback for any POSIX system.

   Missing here: files in memory (they are unnamed files of the temporary folder, can fill the disk, and
   do not release space in their middle); files of fixed size (so rows of an image are not shared with
   the reader process); copies that share blocks. A program that another thread starts between the
   creation of a descriptor and its marking inherits it. */
#include "system/fd.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* On some systems such a name is a duplicate with a shared position, or exists only for the first three
 * descriptors. */
void wr_fd_name(int fd, char name[WR_FD_NAME])
{
    snprintf(name, WR_FD_NAME, "/dev/fd/%d", fd);
}

void wr_fd_close_range(int from, int to)
{
    long most = sysconf(_SC_OPEN_MAX);
    if (most < 0 || most > 65536) most = 65536;
    for (int fd = from; fd < most && (to < 0 || fd <= to); fd++) close(fd);
}

int wr_fd_copy_blocks(int from, int to)
{
    (void)from;
    (void)to;
    return 0;
}

void wr_fd_forget(int fd, int64_t at, int64_t length)
{
    (void)fd;
    (void)at;
    (void)length;
}

int wr_fd_memory(const char *name)
{
    const char *folder = getenv("TMPDIR");
    char path[1024];
    (void)name;
    int length = snprintf(path, sizeof path, "%s/wrinkle-XXXXXX",
                          folder && folder[0] == '/' ? folder : "/tmp");
    if (length < 0 || (size_t)length >= sizeof path) {
        errno = ENAMETOOLONG;
        return -1;
    }
    int fd = mkstemp(path);
    if (fd < 0) return -1;
    fcntl(fd, F_SETFD, FD_CLOEXEC);
    unlink(path);
    return fd;
}

int wr_fd_memory_fixed(const char *name, size_t bytes)
{
    (void)name;
    (void)bytes;
    errno = ENOTSUP;
    return -1;
}

bool wr_fd_pipe(int ends[2], bool wait)
{
    if (pipe(ends) != 0) return false;
    for (int i = 0; i < 2; i++) {
        fcntl(ends[i], F_SETFD, FD_CLOEXEC);
        if (!wait) fcntl(ends[i], F_SETFL, O_NONBLOCK);
    }
    return true;
}

bool wr_random_bytes(void *bytes, size_t length)
{
    int fd = wr_fd_open("/dev/urandom", WR_OPEN_READ);
    bool good = fd >= 0 && wr_fd_read(fd, bytes, length) == (int64_t)length;
    if (fd >= 0) close(fd);
    return good;
}
