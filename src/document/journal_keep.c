/* Copies of files that commands read: NAME.files/SHA256.extension, hard links of one another if two journals
   keep equal content. A link is accepted only after its content has been read and verified. */
#include "document/journal_folder.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "document/journal_line.h"
#include "document/recover.h"
#include "system/fd.h"
#include "system/path.h"

#include <ctype.h>
#include <errno.h>
#include <string.h>

/* SHA256, or SHA256.extension: readers of meshes and pictures depend on the extension. */
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

/* Links an equal copy of another journal to `target`. */
static bool link_sibling(const char *folder, const char *target, const char *name,
                         const char *sha256)
{
    WrFolder *dir = wr_folder_open(folder);
    const char *entry;
    bool found = false;
    while (dir && !found && (entry = wr_folder_next(dir))) {
        size_t length = strlen(entry), ending = strlen(WR_JOURNAL_FILES_ENDING);
        if (length <= ending || strcmp(entry + length - ending, WR_JOURNAL_FILES_ENDING) != 0)
            continue;
        WrText other = { 0 };
        wr_text_addf(&other, "%s/%s/%s", folder, entry, name);
        found = wr_path_link(wr_text_get(&other), target);
        wr_text_fini(&other);
        if (found && !content_is(target, sha256)) {
            wr_path_remove(target);
            found = false;
        }
    }
    wr_folder_close(dir);
    return found;
}

/* Copies inside the file system if it can share blocks, else through memory. */
static bool copy_bytes(int from, int to)
{
    int copied = wr_fd_copy_blocks(from, to);
    if (copied != 0) return copied > 0;
    char block[65536];
    for (;;) {
        int64_t n = wr_fd_read(from, block, sizeof block);
        if (n <= 0) return n == 0;
        if (!wr_fd_write(to, block, (size_t)n)) return false;
    }
}

/* Copies to a temporary name, verifies the copy rather than the file (which may be changing), then renames it. */
static bool copy_open(int from, const char *path, const char *target, const char *sha256,
                      WrError *err)
{
    WrText half = { 0 };
    wr_text_addf(&half, "%s.new", target);
    const char *temporary = wr_text_get(&half);
    wr_path_remove(temporary);
    int to = wr_fd_open(temporary, WR_OPEN_WRITE | WR_OPEN_NEW | WR_OPEN_PRIVATE);
    bool ok = to >= 0 && copy_bytes(from, to) && wr_fd_sync(to);
    if (!ok) wr_fail(err, "%s: no copy can be kept (%s)", path, strerror(errno));
    if (to >= 0) wr_fd_close(to);
    if (ok && !content_is(temporary, sha256))
        ok = wr_fail(err, "%s: no copy can be kept: its content is not %.12s... any more", path,
                     sha256);
    if (ok && !wr_path_rename(temporary, target))
        ok = wr_fail(err, "%s: no copy can be kept (%s)", path, strerror(errno));
    if (!ok) wr_path_remove(temporary);
    wr_text_fini(&half);
    return ok;
}

static bool copy_file(const char *path, const char *target, const char *sha256, WrError *err)
{
    int from = wr_file_open(path, WR_FILE_MOST, NULL, err);
    if (from < 0) return false;
    bool ok = copy_open(from, path, target, sha256, err);
    wr_fd_close(from);
    return ok;
}

bool wr_journal_keep(const char *folder, const char *files, const char *path, int from,
                     const char *sha256, WrError *err)
{
    if (!wr_journal_is_sha256(sha256))
        return wr_fail(err, "%s: its SHA-256 must be 64 lower-case hex digits", path);
    WrText name = { 0 }, target = { 0 };
    kept_name(&name, sha256, path);
    wr_text_addf(&target, "%s/%s", files, wr_text_get(&name));
    bool ok = wr_path_is_there(wr_text_get(&target));
    if (!ok && wr_journal_make_folder(files, err))
        ok = link_sibling(folder, wr_text_get(&target), wr_text_get(&name), sha256) ||
             (from < 0 ? copy_file(path, wr_text_get(&target), sha256, err)
                       : copy_open(from, path, wr_text_get(&target), sha256, err));
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
    if (ok && !wr_path_is_there(wr_text_get(&target)))
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
    WrFolder *dir = wr_folder_open(files);
    const char *entry;
    while (dir && (entry = wr_folder_next(dir))) {
        bool exact = strcmp(entry, wr_text_get(&name)) == 0;
        if (strncmp(entry, sha256, 64) != 0 || (!exact && best.length)) continue;
        const char *dot = strrchr(entry, '.');
        if (dot && strcmp(dot, ".new") == 0 && !exact) continue; /* an incomplete copy */
        wr_text_clear(&best);
        wr_text_add(&best, entry);
        if (exact) break;
    }
    wr_folder_close(dir);
    bool ok = best.length > 0;
    if (ok) wr_text_addf(path, "%s/%s", files, wr_text_get(&best));
    else wr_fail(err, "%s: keeps no copy of the file with SHA-256 %.12s...", journal_path, sha256);
    wr_free(files);
    wr_text_fini(&name);
    wr_text_fini(&best);
    return ok;
}
