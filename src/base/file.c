#include "base/file.h"

#include "base/error.h"
#include "base/file_identity.h"
#include "base/memory.h"
#include "base/text.h"
#include "system/fd.h"
#include "system/path.h"
#include "system/process.h"

#include <ctype.h>
#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* ---- identity ---- */

WrFileIdentity wr_file_identity(const char *path)
{
    WrFileInfo info;
    if (!wr_path_info(path, &info)) return (WrFileIdentity){ 0 };
    return (WrFileIdentity){ .there = true,
                             .device = info.device,
                             .inode = info.inode,
                             .bytes = info.bytes,
                             .seconds = info.seconds,
                             .nanoseconds = info.nanoseconds };
}

bool wr_file_identity_same(const WrFileIdentity *a, const WrFileIdentity *b)
{
    return a->there == b->there && a->device == b->device && a->inode == b->inode &&
           a->bytes == b->bytes && a->seconds == b->seconds && a->nanoseconds == b->nanoseconds;
}

/* ---- Opening of files named by others (file.h) ---- */

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

int wr_file_open_truncate(const char *path, WrError *err)
{
    int fd = wr_fd_open(path, WR_OPEN_WRITE | WR_OPEN_CREATE | WR_OPEN_EMPTY | WR_OPEN_NO_WAIT);
    if (fd < 0) wr_fail(err, "%s: cannot be written: %s", path, strerror(errno));
    return fd;
}

size_t wr_file_peek(const char *path, void *bytes, size_t count)
{
    WrError err;
    uint64_t length;
    int fd = wr_file_open(path, WR_FILE_MAX, &length, &err);
    if (fd < 0) return 0;
    int64_t n = wr_fd_read_at(fd, bytes, count < length ? count : (size_t)length, 0);
    wr_fd_close(fd);
    return n > 0 ? (size_t)n : 0;
}

bool wr_file_read(const char *path, size_t limit, char **bytes, size_t *length, WrError *err)
{
    uint64_t size;
    int fd = wr_file_open(path, limit, &size, err);
    if (fd < 0) return false;
    size_t want = (size_t)size, have = 0;
    char *block = wr_try_alloc(want + 1, 1, path, err);
    if (!block) goto fail;
    while (have < want) {
        int64_t n = wr_fd_read(fd, block + have, want - have);
        if (n < 0) {
            wr_fail(err, "%s: %s", path, strerror(errno));
            goto fail;
        }
        if (n == 0) break;
        have += (size_t)n;
    }
    block[have] = '\0';
    wr_fd_close(fd);
    *bytes = block;
    *length = have;
    return true;
fail:
    wr_free(block);
    wr_fd_close(fd);
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

int wr_fd_in_memory(const char *name, const void *bytes, size_t length, WrError *err)
{
    int fd = wr_fd_memory("wrinkle");
    if (fd >= 0 && wr_fd_write(fd, bytes, length) && wr_fd_seek(fd, 0) == 0) return fd;
    wr_fail(err, "%s: no memory to read it from (%s)", name, strerror(errno));
    if (fd >= 0) wr_fd_close(fd);
    return -1;
}

char *wr_config_path(const char *name)
{
    const char *xdg = getenv("XDG_CONFIG_HOME"), *home = getenv("HOME");
    WrText path = { 0 };
    if (xdg && xdg[0] == '/') wr_text_addf(&path, "%s/wrinkle/%s", xdg, name);
    else if (home && home[0] == '/') wr_text_addf(&path, "%s/.config/wrinkle/%s", home, name);
    return path.data;
}

/* Defined by the build. Fuzzers, which are built from single files, do not define it. */
#ifndef WR_BUILD_FOLDER
#define WR_BUILD_FOLDER ""
#define WR_SOURCE_FOLDER ""
#endif

char *wr_program_folder(void)
{
    char exe[4096];
    if (wr_process_program(exe, sizeof exe)) return wr_path_folder(exe);
    return wr_strdup(*WR_BUILD_FOLDER ? WR_BUILD_FOLDER : "."); /* the system does not report the
                                                                   path */
}

/* The checkout that the program was built from, if the program runs in its build folder; else NULL. */
static const char *source_folder(const char *program_folder)
{
    WrFileIdentity here = wr_file_identity(program_folder),
                   built = wr_file_identity(WR_BUILD_FOLDER);
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
        found = wr_path_can_read(wr_text_get(path));
    }
    wr_free(folder);
    return found;
}
