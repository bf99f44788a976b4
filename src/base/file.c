#include "base/file.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/stamp.h"
#include "base/text.h"

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
    uint64_t size;
    int fd = wr_file_open(path, limit, &size, err);
    if (fd < 0) return false;
    size_t want = (size_t)size, have = 0;
    char *block = wr_try_alloc(want + 1, 1, path, err);
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

char *wr_program_folder(void)
{
    char exe[PATH_MAX];
    ssize_t n = readlink("/proc/self/exe", exe, sizeof exe - 1);
    if (n < 0) return wr_strdup(".");
    exe[n] = '\0';
    return wr_path_folder(exe);
}

/* Told by the build; a fuzzer that is made of single files has none. */
#ifndef WR_BUILD_FOLDER
#define WR_BUILD_FOLDER ""
#define WR_SOURCE_FOLDER ""
#endif

/* The checkout that the program was made from, if it runs where it was built; else NULL. */
static const char *source_folder(const char *program_folder)
{
    WrFileStamp here = wr_file_stamp(program_folder), built = wr_file_stamp(WR_BUILD_FOLDER);
    bool same = here.there && here.device == built.device && here.inode == built.inode;
    return same ? WR_SOURCE_FOLDER : NULL;
}

bool wr_data_find(const char *name, WrText *path)
{
    char *folder = wr_program_folder();
    const struct {
        const char *folder, *tail;
    } places[] = { { getenv("WRINKLE_DATA"), "" },
                   { folder, "/../share/wrinkle" },
                   { folder, "/.." },
                   { source_folder(folder), "" } };
    bool found = false;
    for (size_t i = 0; i < sizeof places / sizeof *places && !found; i++) {
        if (!places[i].folder) continue;
        wr_text_clear(path);
        wr_text_addf(path, "%s%s/%s", places[i].folder, places[i].tail, name);
        found = access(wr_text_get(path), R_OK) == 0;
    }
    wr_free(folder);
    return found;
}
