#include "document/journal_folder.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "system/fd.h"
#include "system/path.h"

#include <errno.h>
#include <string.h>
#include <time.h>

bool wr_journal_folder(WrText *path, WrError *err)
{
    const char *own = getenv("WRINKLE_STATE"), *state = getenv("XDG_STATE_HOME");
    const char *home = getenv("HOME");
    char known[1024];
    if (own && *own) {
        wr_text_addf(path, "%s/journals", own);
        return true;
    }
    if (state && state[0] == '/') {
        wr_text_addf(path, "%s/wrinkle/journals", state);
        return true;
    }
    if ((!home || home[0] != '/') && wr_path_home(known, sizeof known)) home = known;
    if (!home || home[0] != '/')
        return wr_fail(err, "no home folder for journals: set XDG_STATE_HOME to a folder");
    wr_text_addf(path, "%s/.local/state/wrinkle/journals", home);
    return true;
}

bool wr_journal_make_folder(const char *path, WrError *err)
{
    if (!*path) return wr_fail(err, "a folder without a name cannot be made");
    char *part = wr_strdup(path);
    bool ok = true;
    int saved = 0;
    for (char *slash = part + 1; ok; slash++) {
        slash = strchr(slash, '/');
        if (slash) *slash = '\0';
        ok = wr_folder_make(part, WR_FOLDER_FOR_ME) || errno == EEXIST;
        saved = errno;
        if (!ok) ok = wr_path_can_run(part); /* EROFS, EACCES: the folder exists */
        if (!slash) break;
        *slash = '/';
    }
    wr_free(part);
    WrFileInfo info;
    if (ok && (!wr_path_info(path, &info) || info.kind != WR_KIND_FOLDER)) {
        ok = false;
        saved = ENOTDIR;
    }
    return ok || wr_fail(err, "%s: cannot be made (%s)", path, strerror(saved));
}

char *wr_journal_files_folder(const char *journal_path)
{
    size_t length = strlen(journal_path), ending = strlen(WR_JOURNAL_ENDING);
    if (length > ending && strcmp(journal_path + length - ending, WR_JOURNAL_ENDING) == 0)
        length -= ending;
    WrText text = { 0 };
    wr_text_add_n(&text, journal_path, length);
    wr_text_add(&text, WR_JOURNAL_FILES_ENDING);
    return text.data;
}

char *wr_journal_newest_snapshot(const char *files)
{
    WrFolder *dir = wr_folder_open(files);
    const char *entry;
    int newest = 0;
    while (dir && (entry = wr_folder_next(dir))) {
        int number = 0, end = 0;
        if (sscanf(entry, WR_JOURNAL_SNAPSHOT_NAME "%n", &number, &end) == 1 && end > 0 &&
            !entry[end] && number > newest)
            newest = number;
    }
    wr_folder_close(dir);
    WrText name = { 0 };
    if (newest > 0) wr_text_addf(&name, WR_JOURNAL_SNAPSHOT_NAME, newest);
    return name.data;
}

bool wr_journal_sync_path(const char *path, WrError *err)
{
    int fd = wr_fd_open(path, WR_OPEN_READ);
    if (fd < 0) return wr_fail(err, "%s: %s", path, strerror(errno));
    bool ok = wr_fd_sync(fd) || errno == EINVAL || errno == EROFS;
    if (!ok) wr_fail(err, "%s: cannot be written to the disk (%s)", path, strerror(errno));
    wr_fd_close(fd);
    return ok;
}

int wr_journal_open(const char *path, WrError *err)
{
    return wr_file_open_no_link(path, WR_FILE_MOST, NULL, err);
}

bool wr_journal_lock(int fd, const char *path, WrLock how)
{
    WrFileInfo mine, named;
    if (!wr_fd_lock(fd, how)) return false;
    if (wr_fd_info(fd, &mine) && wr_path_info(path, &named) && mine.inode == named.inode &&
        mine.device == named.device)
        return true;
    wr_fd_lock(fd, WR_LOCK_NONE);
    return false;
}

static bool ends_in(const char *name, const char *ending)
{
    size_t n = strlen(name), m = strlen(ending);
    return n > m && strcmp(name + n - m, ending) == 0;
}

/* True if `name` is KEEP or KEEP.extension. */
static bool is_kept(const char *name, const char *keep)
{
    size_t n = keep ? strlen(keep) : 0;
    return n > 0 && strncmp(name, keep, n) == 0 && (name[n] == '\0' || name[n] == '.');
}

void wr_journal_clear_files(const char *files, const char *keep_a, const char *keep_b)
{
    WrFolder *dir = wr_folder_open(files);
    const char *entry;
    while (dir && (entry = wr_folder_next(dir))) {
        if (is_kept(entry, keep_a) || is_kept(entry, keep_b)) continue;
        wr_folder_drop(dir, entry);
    }
    wr_folder_close(dir);
    wr_folder_remove(files);
}

/* Removes a journal whose creation was interrupted: no program has locked it. */
static void sweep_new(const char *path)
{
    int fd = wr_journal_open(path, NULL);
    if (fd < 0) return;
    if (wr_journal_lock(fd, path, WR_LOCK_ALONE)) wr_path_remove(path);
    wr_fd_close(fd);
}

/* Removes files whose journal is gone: its removal was interrupted. */
static void sweep_files(const char *path)
{
    WrText journal = { 0 };
    wr_text_add_n(&journal, path, strlen(path) - strlen(WR_JOURNAL_FILES_ENDING));
    wr_text_add(&journal, WR_JOURNAL_ENDING);
    if (!wr_path_is_there(wr_text_get(&journal)) && errno == ENOENT)
        wr_journal_clear_files(path, NULL, NULL);
    wr_text_fini(&journal);
}

void wr_journal_sweep(const char *folder)
{
    WrFolder *dir = wr_folder_open(folder);
    const char *entry;
    time_t now = time(NULL);
    while (dir && (entry = wr_folder_next(dir))) {
        bool half = entry[0] == '.' && ends_in(entry, ".new");
        bool files = entry[0] != '.' && ends_in(entry, WR_JOURNAL_FILES_ENDING);
        WrFileInfo info;
        if (!half && !files) continue;
        if (!wr_folder_info(dir, entry, &info) || now - info.seconds < WR_JOURNAL_LEFTOVER_SECONDS)
            continue;
        char *path = wr_path_join(folder, entry);
        if (half) sweep_new(path);
        else if (info.kind == WR_KIND_FOLDER) sweep_files(path);
        wr_free(path);
    }
    wr_folder_close(dir);
}
