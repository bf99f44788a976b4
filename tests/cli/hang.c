/* hang.c - preloaded into the program: the first read of a file never ends, whatever signal arrives. */
#include <sys/types.h>
#include <unistd.h>

ssize_t pread(int fd, void *bytes, size_t count, off_t offset)
{
    (void)fd;
    (void)bytes;
    (void)count;
    (void)offset;
    static const char sign[] = "hanging\n";
    if (write(STDERR_FILENO, sign, sizeof sign - 1) < 0) _exit(9);
    for (;;) pause();
}
