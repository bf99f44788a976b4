#include "base/file.h"
#include "base/memory.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdint.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

bool wr_file_read(const char *path, size_t limit, char **bytes, size_t *length, WrError *err)
{
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0) return wr_fail(err, "%s: %s", path, strerror(errno));
    struct stat info;
    char *block = NULL;
    if (fstat(fd, &info) != 0 || !S_ISREG(info.st_mode)) {
        wr_fail(err, "%s: not a regular file", path);
        goto fail;
    }
    if ((uintmax_t)info.st_size > limit) {
        wr_fail(err, "%s: %.1f MB is over the limit of %.1f MB", path, (double)info.st_size / 1e6,
                (double)limit / 1e6);
        goto fail;
    }
    size_t want = (size_t)info.st_size, have = 0;
    block = wr_try_alloc(want + 1, 1, path, err);
    if (!block) goto fail;
    while (have < want) {
        ssize_t n = read(fd, block + have, want - have);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) {
            wr_fail(err, "%s: %s", path, strerror(errno));
            goto fail;
        }
        if (n == 0) break;
        have += (size_t)n;
    }
    block[have] = '\0';
    close(fd);
    *bytes = block;
    *length = have;
    return true;
fail:
    wr_free(block);
    close(fd);
    return false;
}

char *wr_path_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    if (!slash) return wr_strdup(".");
    if (slash == path) return wr_strdup("/");
    return wr_strndup(path, (size_t)(slash - path));
}

char *wr_path_join(const char *folder, const char *path)
{
    if (path[0] == '/' || !folder || !*folder || strcmp(folder, ".") == 0) return wr_strdup(path);
    WrText text = { 0 };
    wr_text_addf(&text, "%s%s%s", folder, folder[strlen(folder) - 1] == '/' ? "" : "/", path);
    return text.data;
}

const char *wr_path_ending(const char *path, char buffer[16])
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    size_t n = 0;
    if (dot && dot != name)
        for (dot++; dot[n] && n < 15; n++) buffer[n] = (char)tolower((unsigned char)dot[n]);
    buffer[n] = '\0';
    return buffer;
}

/* Follow symbolic links by hand, so that a link to a file that does not exist yet works too. */
static char *resolve_links(const char *path, WrError *err)
{
    char *now = wr_strdup(path);
    for (int hops = 0; hops < 40; hops++) {
        char link[PATH_MAX];
        ssize_t n = readlink(now, link, sizeof link - 1);
        if (n < 0) return now;
        link[n] = '\0';
        char *folder = wr_path_folder(now), *next = wr_path_join(folder, link);
        wr_free(folder);
        wr_free(now);
        now = next;
    }
    wr_free(now);
    wr_fail(err, "%s: too many symbolic links", path);
    return NULL;
}

bool wr_file_begin(WrFileTarget *target, const char *path, WrError *err)
{
    *target = (WrFileTarget){ 0 };
    if (!*path) return wr_fail(err, "the name of the file to write is empty");
    char *real = resolve_links(path, err);
    if (!real) return false;
    struct stat info;
    bool exists = stat(real, &info) == 0;
    char *folder = wr_path_folder(real);
    WrText temporary = { 0 };
    if (exists && S_ISDIR(info.st_mode)) {
        wr_fail(err, "%s: is a folder; a file name is needed", path);
    } else if (exists && !S_ISREG(info.st_mode)) {
        wr_fail(err, "%s: is not a regular file", path);
    } else if (access(folder, F_OK) != 0) {
        wr_fail(err, "%s: its folder does not exist", path);
    } else if (access(folder, W_OK | X_OK) != 0) {
        wr_fail(err, "%s: its folder cannot be written (%s)", path, strerror(errno));
    } else if (exists && access(real, W_OK) != 0) {
        wr_fail(err, "%s: cannot be written (%s)", path, strerror(errno));
    } else {
        const char *slash = strrchr(real, '/'), *name = slash ? slash + 1 : real;
        char ending[16];
        wr_path_ending(real, ending);
        static unsigned counter;
        wr_text_addf(&temporary, "%s/.%.100s.%ld-%u.part%s%s", folder, name, (long)getpid(),
                     __atomic_fetch_add(&counter, 1, __ATOMIC_RELAXED), *ending ? "." : "", ending);
    }
    wr_free(folder);
    if (!temporary.data) {
        wr_free(real);
        return false;
    }
    *target = (WrFileTarget){ real, temporary.data };
    return true;
}

static void release(WrFileTarget *target)
{
    wr_free(target->path);
    wr_free(target->temporary);
    *target = (WrFileTarget){ 0 };
}

static bool sync_path(const char *path, int flags)
{
    int fd = open(path, O_RDONLY | O_CLOEXEC | flags);
    if (fd < 0) return false;
    bool ok = fsync(fd) == 0;
    return (close(fd) == 0) && ok;
}

bool wr_file_commit(WrFileTarget *target, WrError *err)
{
    struct stat old;
    bool ok = true;
    if (stat(target->path, &old) == 0) {
        ok = chmod(target->temporary, old.st_mode & 07777) == 0;
    } else {
        mode_t mask = umask(0);
        umask(mask);
        ok = chmod(target->temporary, 0666 & ~mask) == 0;
    }
    ok = ok && sync_path(target->temporary, 0) && rename(target->temporary, target->path) == 0;
    if (!ok) {
        wr_fail(err, "%s: cannot be written (%s)", target->path, strerror(errno));
        wr_file_abort(target);
        return false;
    }
    char *folder = wr_path_folder(target->path);
    sync_path(folder, O_DIRECTORY); /* some file systems cannot; the rename itself stands */
    wr_free(folder);
    release(target);
    return true;
}

void wr_file_abort(WrFileTarget *target)
{
    if (target->temporary) unlink(target->temporary);
    release(target);
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

int wr_fd_in_memory(const char *name, const void *bytes, size_t length, WrError *err)
{
    int fd = memfd_create("wrinkle", MFD_CLOEXEC);
    if (fd >= 0 && wr_fd_write(fd, bytes, length) && lseek(fd, 0, SEEK_SET) == 0) return fd;
    wr_fail(err, "%s: no memory to read it from (%s)", name, strerror(errno));
    if (fd >= 0) close(fd);
    return -1;
}

bool wr_file_write(const char *path, const void *bytes, size_t length, WrError *err)
{
    WrFileTarget target;
    if (!wr_file_begin(&target, path, err)) return false;
    int fd = open(target.temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    bool ok = fd >= 0 && wr_fd_write(fd, bytes, length);
    int saved = errno;
    if (fd >= 0 && close(fd) != 0) ok = false;
    if (!ok) {
        wr_fail(err, "%s: cannot be written (%s)", path, strerror(saved));
        wr_file_abort(&target);
        return false;
    }
    return wr_file_commit(&target, err);
}

char *wr_program_folder(void)
{
    char exe[PATH_MAX];
    ssize_t n = readlink("/proc/self/exe", exe, sizeof exe - 1);
    if (n < 0) return wr_strdup(".");
    exe[n] = '\0';
    return wr_path_folder(exe);
}

bool wr_data_find(const char *name, WrText *path)
{
    char *folder = wr_program_folder();
    const char *given = getenv("WRINKLE_DATA");
    const char *tails[] = { given, "/../share/wrinkle", "/.." };
    bool found = false;
    for (int i = 0; i < 3 && !found; i++) {
        if (!tails[i]) continue;
        wr_text_clear(path);
        wr_text_addf(path, "%s%s/%s", i == 0 ? "" : folder, tails[i], name);
        found = access(wr_text_get(path), R_OK) == 0;
    }
    wr_free(folder);
    return found;
}
