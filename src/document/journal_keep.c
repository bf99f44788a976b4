/* Copies of files that commands read: NAME.files/SHA256.ending, hard links of one another where two
   journals keep the same. A link counts as a copy only when its content has been read and fits. */
#include "document/journal_folder.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "document/journal_line.h"
#include "document/recover.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* SHA256, or SHA256.ending: readers of meshes and pictures go by the ending. */
static void kept_name(WrText *name, const char *sha256, const char *named)
{
    char buffer[16];
    const char *ending = named ? wr_path_ending(named, buffer) : "";
    wr_text_add(name, sha256);
    for (const char *c = ending; *c; c++)
        if (!isalnum((unsigned char)*c)) return;
    if (*ending) wr_text_addf(name, ".%s", ending);
}

static bool content_is(const char *path, const char *sha256)
{
    char have[65];
    return wr_sha256_file(path, have, NULL) && strcmp(have, sha256) == 0;
}

/* Link the same copy of another journal to `target`. */
static bool link_sibling(const char *folder, const char *target, const char *name,
                         const char *sha256)
{
    DIR *dir = opendir(folder);
    struct dirent *entry;
    bool found = false;
    while (dir && !found && (entry = readdir(dir))) {
        size_t length = strlen(entry->d_name), ending = strlen(WR_JOURNAL_FILES_ENDING);
        if (length <= ending ||
            strcmp(entry->d_name + length - ending, WR_JOURNAL_FILES_ENDING) != 0)
            continue;
        WrText other = { 0 };
        wr_text_addf(&other, "%s/%s/%s", folder, entry->d_name, name);
        found = link(wr_text_get(&other), target) == 0;
        wr_text_fini(&other);
        if (found && !content_is(target, sha256)) {
            unlink(target);
            found = false;
        }
    }
    if (dir) closedir(dir);
    return found;
}

/* By the file system itself where it can (shared blocks), else through memory. */
static bool copy_bytes(int from, int to)
{
    bool any = false;
    for (;;) {
        ssize_t n = copy_file_range(from, NULL, to, NULL, (size_t)1 << 30, 0);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0 && any) return false;
        if (n < 0 || (n == 0 && !any)) break;
        if (n == 0) return true;
        any = true;
    }
    char block[65536];
    for (;;) {
        ssize_t n = read(from, block, sizeof block);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return n == 0;
        if (!wr_fd_write(to, block, (size_t)n)) return false;
    }
}

/* Copy to a temporary name, check the copy rather than the file (which may be changing), then give
   it its name. */
static bool copy_file(const char *path, const char *target, const char *sha256, WrError *err)
{
    int from = wr_file_open(path, WR_FILE_MOST, NULL, err);
    if (from < 0) return false;
    WrText half = { 0 };
    wr_text_addf(&half, "%s.new", target);
    const char *temporary = wr_text_get(&half);
    unlink(temporary);
    int to = open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    bool ok = to >= 0 && copy_bytes(from, to) && fsync(to) == 0;
    if (!ok) wr_fail(err, "%s: no copy can be kept (%s)", path, strerror(errno));
    close(from);
    if (to >= 0) close(to);
    if (ok && !content_is(temporary, sha256))
        ok = wr_fail(err, "%s: no copy can be kept: its content is not %.12s... any more", path,
                     sha256);
    if (ok && rename(temporary, target) != 0)
        ok = wr_fail(err, "%s: no copy can be kept (%s)", path, strerror(errno));
    if (!ok) unlink(temporary);
    wr_text_fini(&half);
    return ok;
}

bool wr_journal_keep(const char *folder, const char *files, const char *path, const char *sha256,
                     WrError *err)
{
    if (!wr_journal_is_sha256(sha256))
        return wr_fail(err, "%s: its SHA-256 must be 64 lower-case hex digits", path);
    WrText name = { 0 }, target = { 0 };
    kept_name(&name, sha256, path);
    wr_text_addf(&target, "%s/%s", files, wr_text_get(&name));
    bool ok = access(wr_text_get(&target), F_OK) == 0;
    if (!ok && wr_journal_make_folder(files, err))
        ok = link_sibling(folder, wr_text_get(&target), wr_text_get(&name), sha256) ||
             copy_file(path, wr_text_get(&target), sha256, err);
    if (ok) wr_journal_sync_path(files, NULL);
    wr_text_fini(&name);
    wr_text_fini(&target);
    return ok;
}

bool wr_journal_keep_as_named(const char *files, const char *path, WrError *err)
{
    char hex[65];
    const char *slash = strrchr(path, '/');
    if (!wr_sha256_file(path, hex, err)) return false;
    WrText target = { 0 };
    wr_text_addf(&target, "%s/%s", files, slash ? slash + 1 : path);
    bool ok = wr_journal_make_folder(files, err);
    if (ok && access(wr_text_get(&target), F_OK) != 0)
        ok = copy_file(path, wr_text_get(&target), hex, err);
    else if (ok && !content_is(wr_text_get(&target), hex))
        ok = wr_fail(err, "%s: no copy can be kept: another file of that name is", path);
    if (ok) wr_journal_sync_path(files, NULL);
    wr_text_fini(&target);
    return ok;
}

bool wr_journal_kept_file(const char *journal_path, const char *sha256, const char *named,
                          WrText *path, WrError *err)
{
    if (!wr_journal_is_sha256(sha256))
        return wr_fail(err, "'%.70s': a SHA-256 must be 64 lower-case hex digits", sha256);
    char *files = wr_journal_files_folder(journal_path);
    WrText name = { 0 }, best = { 0 };
    kept_name(&name, sha256, named);
    DIR *dir = opendir(files);
    struct dirent *entry;
    while (dir && (entry = readdir(dir))) {
        bool exact = strcmp(entry->d_name, wr_text_get(&name)) == 0;
        if (strncmp(entry->d_name, sha256, 64) != 0 || (!exact && best.length)) continue;
        const char *dot = strrchr(entry->d_name, '.');
        if (dot && strcmp(dot, ".new") == 0 && !exact) continue; /* a copy that was cut short */
        wr_text_clear(&best);
        wr_text_add(&best, entry->d_name);
        if (exact) break;
    }
    if (dir) closedir(dir);
    bool ok = best.length > 0;
    if (ok) wr_text_addf(path, "%s/%s", files, wr_text_get(&best));
    else wr_fail(err, "%s: keeps no copy of the file with SHA-256 %.12s...", journal_path, sha256);
    wr_free(files);
    wr_text_fini(&name);
    wr_text_fini(&best);
    return ok;
}
