/* Descriptors: the functions that Linux adds to POSIX. */
#include "system/fd.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <unistd.h>

void wr_fd_name(int fd, char name[WR_FD_NAME])
{
    snprintf(name, WR_FD_NAME, "/proc/self/fd/%d", fd);
}

void wr_fd_close_range(int from, int to)
{
    close_range((unsigned)from, to < 0 ? ~0U : (unsigned)to, 0);
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

void wr_fd_forget(int fd, int64_t at, int64_t length)
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
