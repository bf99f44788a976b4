/* Atomic replacement of files (file.h). Every file that the program writes uses it. */
#include "base/error.h"
#include "base/file_internal.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "system/fd.h"
#include "system/path.h"
#include "system/process.h"
#include "system/file_permissions.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <stdint.h>
#include <string.h>

#define TRIES 16 /* attempts to find a free name */

/* ---- names ---- */

/* Links are followed by hand, so that a link to a file that does not exist yet works too. */
static char *resolve_links(const char *path, WrError *err)
{
    char *now = wr_strdup(path);
    for (int hops = 0; hops < 40; hops++) {
        char link[4096];
        if (!wr_path_read_link(now, link, sizeof link)) return now;
        char *folder = wr_path_folder(now), *next = wr_path_join(folder, link);
        wr_free(folder);
        wr_free(now);
        now = next;
    }
    wr_free(now);
    wr_fail(err, "%s: too many symbolic links", path);
    return NULL;
}

uint32_t wr_file_host(void)
{
    char name[256];
    if (!wr_process_machine(name, sizeof name)) return 0;
    return (uint32_t)wr_hash_bytes(name, strlen(name), (WrHash){ .low = 0, .high = 0 }).low;
}

char *wr_file_hidden_name(const char *folder, const char *name, const char *ending)
{
    uint64_t random = 0;
    WrText text = { 0 };
    if (!wr_random_bytes(&random, sizeof random)) return NULL;
    wr_text_addf(&text, "%s/.%.100s.%ld-%08x-%016llx.part%s%s", folder, name, (long)wr_process_id(),
                 (unsigned)wr_file_host(), (unsigned long long)random, *ending ? "." : "", ending);
    return text.data;
}

/* Skips digits of the base; returns the rest, NULL if there are no digits. */
static const char *skip_digits(const char *text, int base)
{
    const char *p = text;
    while (base == 10 ? isdigit((unsigned char)*p) : isxdigit((unsigned char)*p)) p++;
    return p > text ? p : NULL;
}

/* In a folder shared by several machines, only processes of this machine can be checked. */
long wr_file_owner(const char *name)
{
    const char *tail = NULL;
    if (name[0] != '.') return 0;
    for (const char *p = name; (p = strstr(p, ".part")); p++) tail = p;
    if (!tail || (tail[5] != '\0' && tail[5] != '.')) return 0;
    const char *dot = tail;
    while (dot > name && dot[-1] != '.') dot--;
    const char *dash = dot > name + 1 ? skip_digits(dot, 10) : NULL;
    const char *end = dash && *dash == '-' ? skip_digits(dash + 1, 16) : NULL;
    if (end && *end == '-') { /* older versions wrote no host */
        if (strtoull(dash + 1, NULL, 16) != wr_file_host()) return 0;
        end = skip_digits(end + 1, 16);
    }
    long pid = end == tail ? strtol(dot, NULL, 10) : 0;
    return pid > 0 && pid < INT_MAX ? pid : 0;
}

void wr_file_sweep(const char *folder)
{
    for (int pass = 0; pass < 2; pass++) { /* files of a group's list must not be removed before the
                                              list is processed */
        WrFolder *dir = wr_folder_open(folder);
        for (const char *name; dir && (name = wr_folder_next(dir));) {
            long pid = wr_file_owner(name);
            if (!pid || wr_process_lives(pid)) continue;
            if (pass == 0) wr_file_group_finish(folder, dir, name);
            else wr_folder_drop_unheld(dir, name);
        }
        wr_folder_close(dir);
    }
}

/* ---- writing ---- */

void wr_file_outlive_size_limit(void)
{
    wr_process_outlive_file_limit();
}

/* ---- messages of the system ---- */

static const struct {
    int error;
    const char *help;
} helps[] = {
    { ENOSPC, "make room, or write to another disk" },
    { EDQUOT, "make room, or write where there is no quota" },
    { EROFS, "write to another disk" },
    { EIO, "the disk may be failing: write to another" },
    { EFBIG, NULL }, /* from the file size limit */
};

const char *wr_file_why(int error, char text[WR_FILE_WHY])
{
    const char *said = strerror(error), *help = NULL;
    const uint64_t limit = wr_process_file_limit();
    for (size_t i = 0; i < sizeof helps / sizeof *helps; i++)
        if (helps[i].error == error) help = helps[i].help;
    if (error == EFBIG && limit != WR_LIMIT_NONE) {
        snprintf(text, WR_FILE_WHY, "%s: at most %llu bytes are allowed here (ulimit -f)", said,
                 (unsigned long long)limit);
        return text;
    }
    snprintf(text, WR_FILE_WHY, "%s%s%s", said, help ? ": " : "", help ? help : "");
    return text;
}

const char *wr_file_why_of_library(const char *reason, char text[WR_FILE_WHY])
{
    for (size_t i = 0; i < sizeof helps / sizeof *helps; i++)
        if (strstr(reason, strerror(helps[i].error))) return wr_file_why(helps[i].error, text);
    return reason;
}

bool wr_file_fail(const WrFileTarget *target, const char *reason, WrError *err)
{
    return wr_fail(err, "%s: cannot be written%s%s%s", target->path, *reason ? " (" : "", reason,
                   *reason ? ")" : "");
}

static bool fail_by_system(const WrFileTarget *target, WrError *err)
{
    char text[WR_FILE_WHY];
    return wr_file_fail(target, wr_file_why(errno, text), err);
}

/* ---- the target ---- */

static bool check_place(const char *path, const char *real, const char *folder, WrError *err)
{
    WrFileInfo info;
    bool exists = wr_path_info(real, &info);
    if (exists && info.kind == WR_KIND_FOLDER)
        return wr_fail(err, "%s: is a folder; a file name is needed", path);
    if (exists && info.kind != WR_KIND_FILE) return wr_fail(err, "%s: is not a regular file", path);
    if (!wr_path_is_there(folder)) return wr_fail(err, "%s: its folder does not exist", path);
    if (!wr_path_can_write(folder) || !wr_path_can_run(folder))
        return wr_fail(err, "%s: its folder cannot be written (%s)", path, strerror(errno));
    if (exists && !wr_path_can_write(real))
        return wr_fail(err, "%s: cannot be written (%s)", path, strerror(errno));
    return true;
}

/* Creates a new file that only the user can read, locked until it is released. */
static bool create(WrFileTarget *target, const char *folder, WrError *err)
{
    const char *slash = strrchr(target->path, '/'), *name = slash ? slash + 1 : target->path;
    const unsigned how =
        WR_OPEN_READ | WR_OPEN_WRITE | WR_OPEN_NEW | WR_OPEN_NO_LINK | WR_OPEN_PRIVATE;
    char ending[16];
    wr_path_ending(name, ending);
    errno = EEXIST;
    for (int i = 0; i < TRIES && target->fd < 0 && errno == EEXIST; i++) {
        wr_free(target->temporary);
        target->temporary = wr_file_hidden_name(folder, name, ending);
        if (!target->temporary) break;
        target->fd = wr_fd_open(target->temporary, how);
    }
    if (target->fd < 0) return fail_by_system(target, err);
    wr_fd_lock(target->fd,
               WR_LOCK_ALONE); /* some file systems have no locks; the process id in the name is
                                  enough */
    return true;
}

static void release(WrFileTarget *target)
{
    if (target->path && target->fd >= 0) wr_fd_close(target->fd);
    wr_free(target->path);
    wr_free(target->temporary);
    wr_file_sums_free(target->sums);
    *target = (WrFileTarget){ 0 };
}

static bool is_control(char c)
{
    return ((unsigned char)c < 0x20 && c != '\t') || c == 0x7f;
}

/* Commands are lines of text, so a file whose name contains a line break or another control character
   could not be opened again. The message shows ? for it, to stay one line. */
static bool check_letters(const char *path, WrError *err)
{
    char shown[120];
    snprintf(shown, sizeof shown, "%s", path);
    unsigned found = 0;
    for (const char *c = path; *c; c++)
        if (is_control(*c)) found = (unsigned char)*c;
    if (!found) return true;
    for (char *c = shown; *c; c++)
        if (is_control(*c)) *c = '?';
    return wr_fail(
        err,
        "%s: the name of a file to write holds the control character 0x%02x, such as a line break; "
        "choose a name without",
        shown, found);
}

bool wr_file_begin(WrFileTarget *target, const char *path, WrError *err)
{
    *target = (WrFileTarget){ 0 };
    if (!*path) return wr_fail(err, "the name of the file to write is empty");
    if (!check_letters(path, err)) return false;
    wr_file_outlive_size_limit();
    char *real = resolve_links(path, err);
    if (!real) return false;
    *target = (WrFileTarget){ .path = real, .fd = -1, .sums = wr_file_sums_new() };
    char *folder = wr_path_folder(real);
    bool good = check_place(path, real, folder, err);
    if (good) wr_file_sweep(folder);
    good = good && create(target, folder, err);
    wr_free(folder);
    if (!good) release(target);
    return good;
}

bool wr_file_write_at(WrFileTarget *target, const void *bytes, size_t length, int64_t at)
{
    return wr_file_sums_note(target->sums, target->fd, bytes, length, at) &&
           wr_fd_write_at(target->fd, bytes, length, at);
}

bool wr_file_put(WrFileTarget *target, const void *bytes, size_t length, WrError *err)
{
    return wr_file_write_at(target, bytes, length, wr_file_sums_end(target->sums)) ||
           fail_by_system(target, err);
}

static bool sink_write(void *to, const void *bytes, size_t length, int64_t at)
{
    return wr_file_write_at(to, bytes, length, at);
}

WrByteSink wr_file_sink(WrFileTarget *target)
{
    return (WrByteSink){ sink_write, target };
}

void wr_file_sync_folder(const char *path)
{
    char *folder = wr_path_folder(path);
    int fd = wr_fd_open(folder, WR_OPEN_READ);
    if (fd >= 0) {
        wr_fd_sync(fd); /* not supported by some file systems; the rename is valid anyway */
        wr_fd_close(fd);
    }
    wr_free(folder);
}

static bool give_rights(const WrFileTarget *target)
{
    if (wr_path_is_there(target->path)) return wr_rights_give_old(target->fd, target->path);
    char *folder = wr_path_folder(target->path);
    bool good = wr_rights_give_new(target->fd, folder);
    wr_free(folder);
    return good;
}

static bool check_bytes(const WrFileTarget *target, WrError *err)
{
    if (wr_file_sums_check(target->sums, target->fd)) return true;
    if (wr_progress_stopped()) return wr_fail(err, "cancelled");
    if (errno != EIO) return fail_by_system(target, err);
    return wr_file_fail(target,
                        "it does not read back as it was written: the disk may be failing: write "
                        "to another",
                        err);
}

bool wr_file_commit(WrFileTarget *target, WrError *err)
{
    if (!check_bytes(target, err)) {
        wr_file_abort(target);
        return false;
    }
    bool good = give_rights(target) && wr_fd_sync(target->fd);
    int fd = target->fd;
    target->fd = -1;
    if (!good) {
        int saved = errno;
        wr_fd_close(fd);
        errno = saved;
    }
    /* Some file systems report write errors only on close. */
    good = good && wr_fd_close(fd);
    if (good && wr_file_group_takes(target)) return true;
    good = good && wr_path_rename(target->temporary, target->path);
    if (!good) {
        fail_by_system(target, err);
        wr_file_abort(target);
        return false;
    }
    wr_file_sync_folder(target->path);
    release(target);
    return true;
}

void wr_file_abort(WrFileTarget *target)
{
    /* One retry: no other process removes the file before this one has ended. */
    if (target->temporary && !wr_path_remove(target->temporary) && errno != ENOENT)
        wr_path_remove(target->temporary);
    release(target);
}

bool wr_file_write(const char *path, const void *bytes, size_t length, WrError *err)
{
    WrFileTarget target;
    if (!wr_file_begin(&target, path, err)) return false;
    if (!wr_file_put(&target, bytes, length, err)) {
        wr_file_abort(&target);
        return false;
    }
    return wr_file_commit(&target, err);
}
