#include "document/journal_folder.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <pwd.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

bool wr_journal_folder(WrText *path, WrError *err)
{
    const char *own = getenv("WRINKLE_STATE"), *state = getenv("XDG_STATE_HOME");
    const char *home = getenv("HOME");
    char buffer[4096];
    struct passwd user, *found = NULL;
    if (own && *own) {
        wr_text_addf(path, "%s/journals", own);
        return true;
    }
    if (state && state[0] == '/') {
        wr_text_addf(path, "%s/wrinkle/journals", state);
        return true;
    }
    if ((!home || home[0] != '/') &&
        getpwuid_r(getuid(), &user, buffer, sizeof buffer, &found) == 0 && found)
        home = user.pw_dir;
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
        ok = mkdir(part, 0700) == 0 || errno == EEXIST;
        saved = errno;
        if (!ok) ok = access(part, X_OK) == 0; /* EROFS, EACCES: but it is there */
        if (!slash) break;
        *slash = '/';
    }
    wr_free(part);
    struct stat info;
    if (ok && (stat(path, &info) != 0 || !S_ISDIR(info.st_mode))) {
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
    DIR *dir = opendir(files);
    struct dirent *entry;
    int newest = 0;
    while (dir && (entry = readdir(dir))) {
        int number = 0, end = 0;
        if (sscanf(entry->d_name, WR_JOURNAL_SNAPSHOT_NAME "%n", &number, &end) == 1 && end > 0 &&
            !entry->d_name[end] && number > newest)
            newest = number;
    }
    if (dir) closedir(dir);
    WrText name = { 0 };
    if (newest > 0) wr_text_addf(&name, WR_JOURNAL_SNAPSHOT_NAME, newest);
    return name.data;
}

bool wr_journal_sync_path(const char *path, WrError *err)
{
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    if (fd < 0) return wr_fail(err, "%s: %s", path, strerror(errno));
    bool ok = fsync(fd) == 0 || errno == EINVAL || errno == EROFS;
    if (!ok) wr_fail(err, "%s: cannot be written to the disk (%s)", path, strerror(errno));
    close(fd);
    return ok;
}

int wr_journal_open(const char *path, WrError *err)
{
    return wr_file_open_no_link(path, WR_FILE_MOST, NULL, err);
}

bool wr_journal_lock(int fd, const char *path, int how)
{
    struct stat mine, named;
    int done;
    do done = flock(fd, how | LOCK_NB);
    while (done != 0 && errno == EINTR);
    if (done != 0) return false;
    if (fstat(fd, &mine) == 0 && stat(path, &named) == 0 && mine.st_ino == named.st_ino &&
        mine.st_dev == named.st_dev)
        return true;
    flock(fd, LOCK_UN);
    return false;
}

static bool ends_in(const char *name, const char *ending)
{
    size_t n = strlen(name), m = strlen(ending);
    return n > m && strcmp(name + n - m, ending) == 0;
}

/* `name` is KEEP or KEEP.ending. */
static bool is_kept(const char *name, const char *keep)
{
    size_t n = keep ? strlen(keep) : 0;
    return n > 0 && strncmp(name, keep, n) == 0 && (name[n] == '\0' || name[n] == '.');
}

void wr_journal_clear_files(const char *files, const char *keep_a, const char *keep_b)
{
    DIR *dir = opendir(files);
    struct dirent *entry;
    while (dir && (entry = readdir(dir))) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
        if (is_kept(entry->d_name, keep_a) || is_kept(entry->d_name, keep_b)) continue;
        unlinkat(dirfd(dir), entry->d_name, 0);
    }
    if (dir) closedir(dir);
    rmdir(files);
}

/* A journal that was never finished being begun: no program holds it. */
static void sweep_new(const char *path)
{
    int fd = wr_journal_open(path, NULL);
    if (fd < 0) return;
    if (wr_journal_lock(fd, path, LOCK_EX)) unlink(path);
    close(fd);
}

/* Files whose journal is gone: its removal was cut short. */
static void sweep_files(const char *path)
{
    WrText journal = { 0 };
    wr_text_add_n(&journal, path, strlen(path) - strlen(WR_JOURNAL_FILES_ENDING));
    wr_text_add(&journal, WR_JOURNAL_ENDING);
    if (access(wr_text_get(&journal), F_OK) != 0 && errno == ENOENT)
        wr_journal_clear_files(path, NULL, NULL);
    wr_text_fini(&journal);
}

void wr_journal_sweep(const char *folder)
{
    DIR *dir = opendir(folder);
    struct dirent *entry;
    time_t now = time(NULL);
    while (dir && (entry = readdir(dir))) {
        bool half = entry->d_name[0] == '.' && ends_in(entry->d_name, ".new");
        bool files = entry->d_name[0] != '.' && ends_in(entry->d_name, WR_JOURNAL_FILES_ENDING);
        struct stat info;
        if (!half && !files) continue;
        if (fstatat(dirfd(dir), entry->d_name, &info, AT_SYMLINK_NOFOLLOW) != 0 ||
            now - info.st_mtime < WR_JOURNAL_LEFTOVER_SECONDS)
            continue;
        char *path = wr_path_join(folder, entry->d_name);
        if (half) sweep_new(path);
        else if (S_ISDIR(info.st_mode)) sweep_files(path);
        wr_free(path);
    }
    if (dir) closedir(dir);
}
