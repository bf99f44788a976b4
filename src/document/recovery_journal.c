/* The journal of a session: its folder and locks, copies of the files that commands read, and writing. */
#include "document/recovery_journal.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "document/recover.h"
#include "system/clock.h"
#include "system/fd.h"
#include "system/path.h"
#include "system/process.h"
#include "system/thread.h"

#include <ctype.h>
#include <errno.h>
#include <string.h>
#include <time.h>

/* ---- the journal folder ---- */

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

/* Creates a folder and its parents, mode 0700 each; succeeds if it exists. */
static bool journal_make_folder(const char *path, WrError *err)
{
    if (!*path) return wr_fail(err, "a folder needs a name");
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
    return ok || wr_fail(err, "%s: cannot be created (%s)", path, strerror(saved));
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

/* Syncs a file, or a folder so that its names are on the disk. Some file systems cannot sync folders; that is
   not a failure. */
static bool journal_sync_path(const char *path, WrError *err)
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
    return wr_file_open_no_link(path, WR_FILE_MAX, NULL, err);
}

/* The lock belongs to the file, not to its name: between open and lock another program may have replaced it, hence the
   comparison of inodes. */
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
        wr_folder_remove_entry(dir, entry);
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

/* Removes incomplete files of killed programs from the folder, if they are older than a day. */
static void journal_sweep(const char *folder)
{
    WrFolder *dir = wr_folder_open(folder);
    const char *entry;
    time_t now = time(NULL);
    while (dir && (entry = wr_folder_next(dir))) {
        bool half = entry[0] == '.' && ends_in(entry, ".new");
        bool files = entry[0] != '.' && ends_in(entry, WR_JOURNAL_FILES_ENDING);
        WrFileInfo info;
        if (!half && !files) continue;
        if (!wr_folder_entry_info(dir, entry, &info) ||
            now - info.seconds < WR_JOURNAL_LEFTOVER_SECONDS)
            continue;
        char *path = wr_path_join(folder, entry);
        if (half) sweep_new(path);
        else if (info.kind == WR_KIND_FOLDER) sweep_files(path);
        wr_free(path);
    }
    wr_folder_close(dir);
}

/* ---- copies of files ---- */

/* Copies of files that commands read: NAME.files/SHA256.extension, hard links of one another if two journals
   keep equal content. A link is accepted only after its content has been read and verified. */

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

/* A copy to be kept, of the content of `from`. */
typedef struct Copy {
    char *folder, *files; /* all journals, and the files of this one */
    char *path;           /* for messages and the extension */
    char sha256[65];
    int from; /* descriptor at the beginning of the content; owned */
    bool good;
    bool changed; /* the content is not that of sha256 */
    /* of a copy made by a thread of its own: */
    WrThread thread;
    volatile int cancel;
    _Atomic bool ended;
} Copy;

/* Copies inside the file system if it can share blocks, else through memory. */
static bool copy_bytes(int from, int to)
{
    int copied = wr_fd_copy_blocks(from, to);
    if (copied != 0) return copied > 0;
    char block[65536];
    for (;;) {
        if (wr_progress_stopped()) return errno = ECANCELED, false;
        int64_t n = wr_fd_read(from, block, sizeof block);
        if (n <= 0) return n == 0;
        if (!wr_fd_write(to, block, (size_t)n)) return false;
    }
}

/* Copies to a temporary name, verifies the copy rather than the file (which may be changing), then renames it. *changed: the
   content is another one. */
static bool copy_open(int from, const char *path, const char *target, const char *sha256,
                      bool *changed, WrError *err)
{
    WrText half = { 0 };
    wr_text_addf(&half, "%s.new", target);
    const char *temporary = wr_text_get(&half);
    wr_path_remove(temporary);
    int to = wr_fd_open(temporary, WR_OPEN_WRITE | WR_OPEN_NEW | WR_OPEN_PRIVATE);
    bool ok = to >= 0 && copy_bytes(from, to) && wr_fd_sync(to);
    if (!ok) wr_fail(err, "%s: cannot be copied (%s)", path, strerror(errno));
    if (to >= 0) wr_fd_close(to);
    *changed = ok && !content_is(temporary, sha256) && !wr_progress_stopped();
    if (*changed || (ok && wr_progress_stopped()))
        ok = wr_fail(err, "%s: cannot be copied: its content is no longer %.12s...", path, sha256);
    if (ok && !wr_path_rename(temporary, target))
        ok = wr_fail(err, "%s: cannot be copied (%s)", path, strerror(errno));
    if (!ok) wr_path_remove(temporary);
    wr_text_fini(&half);
    return ok;
}

/* Takes ownership of `from`. */
static Copy *new_copy(const char *folder, const char *files, const char *path, int from,
                      const char *sha256)
{
    Copy *copy = wr_alloc(1, sizeof *copy);
    copy->folder = wr_strdup(folder);
    copy->files = wr_strdup(files);
    copy->path = wr_strdup(path);
    memcpy(copy->sha256, sha256, sizeof copy->sha256);
    copy->from = from;
    return copy;
}

static void free_copy(Copy *copy)
{
    wr_fd_close(copy->from);
    wr_free(copy->folder);
    wr_free(copy->files);
    wr_free(copy->path);
    wr_free(copy);
}

static void make_copy(Copy *copy, WrError *err)
{
    WrText name = { 0 }, target = { 0 };
    kept_name(&name, copy->sha256, copy->path);
    wr_text_addf(&target, "%s/%s", copy->files, wr_text_get(&name));
    const char *to = wr_text_get(&target);
    copy->good = wr_path_is_there(to);
    if (!copy->good && journal_make_folder(copy->files, err))
        copy->good = link_sibling(copy->folder, to, wr_text_get(&name), copy->sha256) ||
                     copy_open(copy->from, copy->path, to, copy->sha256, &copy->changed, err);
    if (copy->good) journal_sync_path(copy->files, NULL);
    wr_text_fini(&name);
    wr_text_fini(&target);
}

static void *make_copy_aside(void *arg)
{
    Copy *copy = arg;
    const WrProgress progress = { .cancel = &copy->cancel };
    wr_thread_step_back();
    wr_progress_set(&progress);
    make_copy(copy, NULL);
    copy->ended = true;
    return NULL;
}

static bool copy_named(const char *path, const char *target, const char *sha256, WrError *err)
{
    bool changed;
    int from = wr_file_open(path, WR_FILE_MAX, NULL, err);
    if (from < 0) return false;
    bool ok = copy_open(from, path, target, sha256, &changed, err);
    wr_fd_close(from);
    return ok;
}

static bool journal_keep_as_named(const char *files, const char *path, WrError *err)
{
    char hex[65];
    const char *slash = strrchr(path, '/');
    if (!wr_sha256_file(path, hex, err)) return false;
    WrText target = { 0 };
    wr_text_addf(&target, "%s/%s", files, slash ? slash + 1 : path);
    bool ok = journal_make_folder(files, err);
    if (ok && !wr_path_is_there(wr_text_get(&target)))
        ok = copy_named(path, wr_text_get(&target), hex, err);
    else if (ok && !content_is(wr_text_get(&target), hex))
        ok = wr_fail(err, "%s: cannot be copied: another file of that name is kept", path);
    if (ok) journal_sync_path(files, NULL);
    wr_text_fini(&target);
    return ok;
}

bool wr_journal_find_input_copy(const char *journal_path, const char *sha256, const char *named,
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
    else wr_fail(err, "%s: has no copy of the file with SHA-256 %.12s...", journal_path, sha256);
    wr_free(files);
    wr_text_fini(&name);
    wr_text_fini(&best);
    return ok;
}

/* ---- an open journal ---- */

#ifndef WR_VERSION
#define WR_VERSION "0"
#endif

#define MAX_BYTES ((int64_t)64 << 20)
#define MAX_LINES 20000
#define PATIENCE_SECONDS 10.0
#define PATIENCE_MAX_SECONDS 300.0
#define PROBE_BYTES 65536 /* free disk space that counts as "writing works again" */

typedef enum Open { OPEN_NOTHING, OPEN_COMMAND, OPEN_STROKE } Open;

struct WrJournal {
    WrJournalOptions options; /* folder and program are owned copies */
    char *path, *temporary, *files;
    int fd;        /* locked, appending; -1: no file yet */
    int64_t bytes; /* whole lines in the file: a failed write is truncated to this */
    int64_t lines, commands;
    uint64_t sequence; /* of the next record */
    Open open;
    WrText line;             /* scratch */
    bool unsynced;           /* lines were written after synced_at */
    double synced_at;        /* wr_clock_seconds */
    bool broken;             /* lines are missing: only a restart helps */
    bool gap_marked;         /* and the file records that */
    bool writable;           /* broken, but writing has worked again */
    double tried_at;         /* wr_clock_seconds of the last failure or attempt */
    double ask_at;           /* no request for a restart before */
    double patience;         /* delay before the next request, seconds, after one is put off */
    int snapshot;            /* number of the last snapshot path */
    char start_sha256[65];   /* of the document that it starts from; "": none */
    WR_ARRAY(Copy *) copies; /* that threads are making */
    char reason[384];        /* reason of `broken` */
};

/* ---- failure and recovery ---- */

static void report(WrJournal *journal, const char *text)
{
    if (journal->options.report) journal->options.report(journal->options.ctx, text);
}

/* Records the gap for the reader. The record may be missing without harm, so a failure to write it is ignored. */
static void mark_gap(WrJournal *journal)
{
    if (journal->fd < 0 || journal->gap_marked) return;
    if (!wr_fd_cut(journal->fd, journal->bytes)) return; /* nothing may follow torn bytes */
    wr_text_clear(&journal->line);
    wr_journal_print_line(&journal->line, journal->sequence, 'g', journal->reason);
    journal->gap_marked = wr_fd_write(journal->fd, journal->line.data, journal->line.length);
    if (!journal->gap_marked && !wr_fd_cut(journal->fd, journal->bytes))
        return; /* the reader drops torn bytes */
}

/* Called only while the journal is safe: the writing functions check that first. */
static void become_unsafe(WrJournal *journal, const char *reason)
{
    journal->broken = true;
    journal->writable = false;
    journal->tried_at = wr_clock_seconds();
    snprintf(journal->reason, sizeof journal->reason, "%.380s", reason);
    mark_gap(journal);
    WrText text = { 0 };
    wr_text_addf(&text, "the journal is not safe: %s", journal->reason);
    report(journal, wr_text_get(&text));
    wr_text_fini(&text);
}

void wr_journal_break(WrJournal *journal, const char *reason)
{
    if (!journal->broken) become_unsafe(journal, reason);
}

/* True if a new file would have space. Writes one and removes it. */
static bool probe(const WrJournal *journal)
{
    if (!journal->path || !journal_make_folder(journal->options.folder, NULL)) return false;
    wr_path_remove(journal->temporary);
    int fd = wr_fd_open(journal->temporary, WR_OPEN_WRITE | WR_OPEN_NEW | WR_OPEN_PRIVATE);
    if (fd < 0) return false;
    char *block = wr_alloc(PROBE_BYTES, 1);
    bool ok = wr_fd_write(fd, block, PROBE_BYTES) && wr_fd_sync(fd);
    wr_free(block);
    wr_fd_close(fd);
    wr_path_remove(journal->temporary);
    return ok;
}

/* After a failed write the journal has a gap and stays broken, but it checks at intervals whether writing works again; the
   session then starts a new journal from a snapshot of the document. */
static void retry(WrJournal *journal)
{
    double now = wr_clock_seconds();
    if (journal->writable || now - journal->tried_at < journal->options.retry_seconds) return;
    journal->tried_at = now;
    journal->writable = probe(journal);
    if (journal->writable) mark_gap(journal);
}

/* ---- copies made by threads ---- */

#define COPY_ASIDE ((uint64_t)4 << 20) /* bytes of a file for which no command waits */

/* The journal is not safe if the document that it starts from was another file. */
static void check_start(WrJournal *journal, const Copy *copy)
{
    if (!copy->changed || strcmp(copy->sha256, journal->start_sha256) != 0) return;
    WrText text = { 0 };
    wr_text_addf(&text, "%s: was changed while it was opened", copy->path);
    wr_journal_break(journal, wr_text_get(&text));
    wr_text_fini(&text);
}

/* Checks and frees the copies that have ended. wait: all, each when it has ended. */
static void settle_copies(WrJournal *journal, bool wait)
{
    int left = 0;
    for (int i = 0; i < journal->copies.count; i++) {
        Copy *copy = journal->copies.data[i];
        if (!wait && !copy->ended) {
            journal->copies.data[left++] = copy;
            continue;
        }
        wr_thread_join(copy->thread);
        check_start(journal, copy);
        free_copy(copy);
    }
    journal->copies.count = left;
}

/* except: SHA-256 of a copy that is still needed; NULL: none. */
static void cancel_copies(WrJournal *journal, const char *except)
{
    for (int i = 0; i < journal->copies.count; i++)
        if (!except || strcmp(journal->copies.data[i]->sha256, except) != 0)
            __atomic_store_n(&journal->copies.data[i]->cancel, 1, __ATOMIC_RELAXED);
    settle_copies(journal, true);
}

/* from: at the beginning of the content; owned by this function. aside: by a thread, if one starts. */
static bool keep_copy(WrJournal *journal, const char *path, int from, bool aside,
                      const char *sha256, WrError *err)
{
    Copy *copy = new_copy(journal->options.folder, journal->files, path, from, sha256);
    if (aside && wr_thread_begin(&copy->thread, make_copy_aside, copy)) {
        wr_array_push(&journal->copies, copy);
        return true;
    }
    make_copy(copy, err);
    const bool good = copy->good;
    check_start(journal, copy);
    free_copy(copy);
    return good;
}

/* ---- writing lines ---- */

static bool write_line(WrJournal *journal, WrError *err)
{
    WrFileInfo info;
    int64_t length = (int64_t)journal->line.length;
    if (length > WR_JOURNAL_LINE_MAX)
        return wr_fail(err, "a line of %.0f MB is over the limit of %.0f MB", (double)length / 1e6,
                       (double)WR_JOURNAL_LINE_MAX / 1e6);
    if (journal->bytes + length >= WR_JOURNAL_FILE_MAX)
        return wr_fail(err, "%s: over %.0f MB", journal->path, (double)WR_JOURNAL_FILE_MAX / 1e6);
    if (!wr_fd_info(journal->fd, &info) || info.links == 0)
        return wr_fail(err, "%s: was removed", journal->path);
    if (wr_fd_write(journal->fd, journal->line.data, (size_t)length)) return true;
    return wr_fail(err, "%s: %s", journal->path, strerror(errno));
}

/* Order: the line is written before the command runs; it is flushed to the disk at intervals, not per line, since a process
   crash loses nothing that was written, and only a power failure needs the flush. */
static bool append(WrJournal *journal, char kind, const char *payload, WrError *err)
{
    WrError local;
    if (!err) err = &local;
    settle_copies(journal, false);
    if (journal->broken) {
        retry(journal);
        return wr_fail(err, "the journal is not safe: %s", journal->reason);
    }
    wr_text_clear(&journal->line);
    wr_journal_print_line(&journal->line, journal->sequence, kind, payload);
    if (!write_line(journal, err)) {
        become_unsafe(journal, err->text);
        return false;
    }
    journal->bytes += (int64_t)journal->line.length;
    journal->sequence++;
    journal->lines++;
    journal->unsynced = true;
    double wait = journal->options.sync_seconds;
    if (wait < 0 || wr_clock_seconds() - journal->synced_at < wait) return true;
    return wr_journal_sync(journal, err);
}

bool wr_journal_command(WrJournal *journal, const char *text, WrError *err)
{
    journal->open = OPEN_COMMAND;
    journal->commands++;
    return append(journal, 'c', text, err);
}

bool wr_journal_done(WrJournal *journal, WrJournalOutcome outcome, const WrHash *hash, WrError *err)
{
    char text[48] = "dropped", digits[33];
    if (journal->open == OPEN_NOTHING) return true;
    journal->open = OPEN_NOTHING;
    if (outcome == WR_JOURNAL_OK) {
        if (hash) wr_hash_print(*hash, digits);
        snprintf(text, sizeof text, "ok%s%s", hash ? " " : "", hash ? digits : "");
    }
    return append(journal, 'd', text, err);
}

bool wr_journal_stroke_begin(WrJournal *journal, const char *head, WrError *err)
{
    journal->open = OPEN_STROKE;
    journal->commands++;
    return append(journal, 'b', head, err);
}

bool wr_journal_stroke_add(WrJournal *journal, const char *samples, WrError *err)
{
    if (journal->open != OPEN_STROKE) return wr_fail(err, "no stroke is open in the journal");
    return append(journal, 's', samples, err);
}

bool wr_journal_stroke_end(WrJournal *journal, WrError *err)
{
    if (journal->open != OPEN_STROKE) return wr_fail(err, "no stroke is open in the journal");
    journal->open = OPEN_COMMAND;
    return append(journal, 'e', "", err);
}

bool wr_journal_note(WrJournal *journal, const char *text, WrError *err)
{
    return append(journal, 'n', text, err);
}

/* Absolute path, valid after a change of the working folder. Caller frees. */
static char *absolute_path(const char *path)
{
    char *here = wr_path_here(), *whole = wr_path_join(here ? here : "/", path);
    free(here);
    return whole;
}

bool wr_journal_saved(WrJournal *journal, const char *path, const WrHash *hash, WrError *err)
{
    if (journal->open != OPEN_NOTHING)
        return wr_fail(err, "a save cannot be recorded while a command runs");
    char digits[33], *absolute = absolute_path(path);
    WrText text = { 0 };
    wr_hash_print(*hash, digits);
    wr_text_addf(&text, "%s %s", digits, absolute);
    bool ok = append(journal, 'v', wr_text_get(&text), err) && wr_journal_sync(journal, err);
    wr_text_fini(&text);
    wr_free(absolute);
    return ok;
}

bool wr_journal_sync(WrJournal *journal, WrError *err)
{
    WrError local;
    WrFileInfo mine, named;
    if (!err) err = &local;
    settle_copies(journal, false);
    if (journal->broken) {
        retry(journal);
        return wr_fail(err, "the journal is not safe: %s", journal->reason);
    }
    journal->synced_at = wr_clock_seconds();
    bool ok = true;
    if (!wr_path_info(journal->path, &named) || !wr_fd_info(journal->fd, &mine) ||
        named.inode != mine.inode || named.device != mine.device)
        ok = wr_fail(err, "%s: was removed or moved", journal->path);
    else if (journal->unsynced && !wr_fd_sync_bytes(journal->fd))
        ok = wr_fail(err, "%s: cannot be written to the disk (%s)", journal->path, strerror(errno));
    journal->unsynced = false;
    if (!ok) become_unsafe(journal, err->text);
    return ok;
}

WrJournalState wr_journal_state(const WrJournal *journal)
{
    bool busy = journal->open != OPEN_NOTHING;
    bool ask = !busy && wr_clock_seconds() >= journal->ask_at;
    bool too_long =
        journal->bytes > journal->options.max_bytes || journal->lines > journal->options.max_lines;
    WrJournalWant want = WR_JOURNAL_WANT_NOTHING;
    if (ask && journal->broken && journal->writable) want = WR_JOURNAL_WANT_WHOLE;
    if (ask && !journal->broken && too_long) want = WR_JOURNAL_WANT_SHORTER;
    return (WrJournalState){ .safe = !journal->broken,
                             .reason = journal->broken ? journal->reason : "",
                             .want = want,
                             .busy = busy,
                             .commands = journal->commands,
                             .lines = journal->lines,
                             .bytes = journal->bytes };
}

const char *wr_journal_path(const WrJournal *journal)
{
    return journal->path ? journal->path : "";
}

/* ---- start and restart ---- */

/* Prints the header of a start state; the caller frees *absolute. */
static bool print_start(WrJournal *journal, const WrJournalStart *start, char **absolute,
                        WrError *err)
{
    WrJournalHeader header = { .start = *start,
                               .program = journal->options.program,
                               .time = (int64_t)time(NULL) };
    if (start->kind == WR_JOURNAL_DOCUMENT && (!start->path || !*start->path))
        return wr_fail(err, "a journal that starts from a document needs its path");
    if (start->sha256 && !wr_journal_is_sha256(start->sha256))
        return wr_fail(err, "'%.70s': a SHA-256 must be 64 lower-case hex digits", start->sha256);
    header.start.snapshot = NULL;
    if (start->kind == WR_JOURNAL_SNAPSHOT) {
        const char *slash = start->snapshot ? strrchr(start->snapshot, '/') : NULL;
        if (!slash || strncmp(start->snapshot, journal->files, strlen(journal->files)) != 0 ||
            start->snapshot + strlen(journal->files) != slash || !wr_journal_is_name(slash + 1))
            return wr_fail(err, "%s: not a snapshot of this journal",
                           start->snapshot ? start->snapshot : "no file");
        if (!journal_sync_path(start->snapshot, err)) return false;
        journal_sync_path(journal->files, NULL);
        header.start.snapshot = slash + 1;
    }
    if (start->path && *start->path) header.start.path = *absolute = absolute_path(start->path);
    wr_text_clear(&journal->line);
    wr_journal_print_header(&journal->line, &header);
    return true;
}

/* Creates a locked file with the header from journal->line, under its temporary name, synced to disk. */
static int create_file(const WrJournal *journal, WrError *err)
{
    wr_path_remove(journal->temporary);
    const unsigned how =
        WR_OPEN_READ | WR_OPEN_WRITE | WR_OPEN_APPEND | WR_OPEN_NEW | WR_OPEN_PRIVATE;
    int fd = wr_fd_open(journal->temporary, how);
    if (fd < 0) {
        wr_fail(err, "%s: cannot be written (%s)", journal->path, strerror(errno));
        return -1;
    }
    if (wr_fd_lock(fd, WR_LOCK_ALONE) &&
        wr_fd_write(fd, journal->line.data, journal->line.length) && wr_fd_sync(fd) &&
        wr_path_rename(journal->temporary, journal->path))
        return fd;
    wr_fail(err, "%s: cannot be written (%s)", journal->path, strerror(errno));
    wr_path_remove(journal->temporary);
    wr_fd_close(fd);
    return -1;
}

/* Replaces the old file, if any, by a new one with another start state. */
static bool start_file(WrJournal *journal, const WrJournalStart *start, WrError *err)
{
    char *absolute = NULL;
    if (!journal->path) return wr_fail(err, "%s", journal->reason);
    if (!journal_make_folder(journal->options.folder, err)) return false;
    bool ok = print_start(journal, start, &absolute, err);
    int fd = ok ? create_file(journal, err) : -1;
    wr_free(absolute);
    if (fd < 0) return false;
    journal_sync_path(journal->options.folder, NULL);
    if (journal->fd >= 0)
        wr_fd_close(journal->fd); /* only now, so that the name is locked at every moment */
    journal->fd = fd;
    journal->bytes = (int64_t)journal->line.length;
    journal->lines = 1;
    snprintf(journal->start_sha256, sizeof journal->start_sha256, "%s",
             start->sha256 ? start->sha256 : "");
    journal->commands = 0;
    journal->sequence = 1;
    journal->unsynced = false;
    journal->synced_at = wr_clock_seconds();
    journal->broken = journal->gap_marked = journal->writable = false;
    journal->patience = PATIENCE_SECONDS;
    journal->ask_at = 0;
    return true;
}

/* "20260131-235959-PID-RANDOM": unique by the random part, readable by the rest. */
static void choose_paths(WrJournal *journal)
{
    uint64_t random = 0;
    if (!wr_random_bytes(&random, sizeof random)) random = (uint64_t)(wr_clock_seconds() * 1e9);
    struct tm date = { 0 };
    wr_clock_universal((int64_t)time(NULL), &date);
    char stamp[32], name[96];
    if (strftime(stamp, sizeof stamp, "%Y%m%d-%H%M%S", &date) == 0) stamp[0] = '\0';
    snprintf(name, sizeof name, "%s-%ld-%016llx", stamp, (long)wr_process_id(),
             (unsigned long long)random);
    WrText path = { 0 }, temporary = { 0 };
    const char *folder = journal->options.folder;
    wr_text_addf(&path, "%s/%s" WR_JOURNAL_ENDING, folder, name);
    wr_text_addf(&temporary, "%s/.%s.new", folder, name);
    journal->path = path.data;
    journal->temporary = temporary.data;
    journal->files = wr_journal_files_folder(journal->path);
}

WrJournal *wr_journal_begin(const WrJournalOptions *options, const WrJournalStart *start)
{
    WrJournal *journal = wr_alloc(1, sizeof *journal);
    WrJournalOptions *o = &journal->options;
    WrError err = { "" };
    *o = *options;
    journal->fd = -1;
    if (o->max_bytes <= 0) o->max_bytes = MAX_BYTES;
    if (o->max_lines <= 0) o->max_lines = MAX_LINES;
    if (o->sync_seconds == 0) o->sync_seconds = 1;
    if (o->retry_seconds <= 0) o->retry_seconds = 1;
    o->program = wr_strdup(o->program ? o->program : WR_VERSION);
    WrText folder = { 0 };
    if (o->folder) wr_text_add(&folder, o->folder);
    else wr_journal_folder(&folder, &err);
    o->folder = folder.data ? absolute_path(folder.data) : NULL;
    wr_text_fini(&folder);
    wr_file_outlive_size_limit();
    if (o->folder) {
        journal_sweep(o->folder);
        choose_paths(journal);
        start_file(journal, start, &err);
    }
    journal->patience = PATIENCE_SECONDS;
    if (journal->fd < 0) become_unsafe(journal, err.text);
    return journal;
}

bool wr_journal_restart(WrJournal *journal, const WrJournalStart *start, WrError *err)
{
    if (journal->open != OPEN_NOTHING)
        return wr_fail(err, "the journal cannot restart while a command runs");
    bool was_broken = journal->broken;
    if (!start_file(journal, start, err)) return false;
    const char *slash = start->snapshot ? strrchr(start->snapshot, '/') : NULL;
    cancel_copies(journal, start->sha256);
    wr_journal_clear_files(journal->files, slash ? slash + 1 : NULL, start->sha256);
    if (was_broken) report(journal, "the journal is safe again");
    return true;
}

void wr_journal_put_off(WrJournal *journal)
{
    journal->ask_at = wr_clock_seconds() + journal->patience;
    journal->patience *= 2;
    if (journal->patience > PATIENCE_MAX_SECONDS) journal->patience = PATIENCE_MAX_SECONDS;
}

/* ---- neighbouring files ---- */

static bool can_keep(const WrJournal *journal, const char *path, const char *sha256, WrError *err)
{
    if (!journal->path) return wr_fail(err, "%s", journal->reason);
    return wr_journal_is_sha256(sha256) ||
           wr_fail(err, "%s: its SHA-256 must be 64 lower-case hex digits", path);
}

bool wr_journal_keep_file(WrJournal *journal, const char *path, const char *sha256, WrError *err)
{
    uint64_t size;
    if (!can_keep(journal, path, sha256, err)) return false;
    int from = wr_file_open(path, WR_FILE_MAX, &size, err);
    return from >= 0 && keep_copy(journal, path, from, size >= COPY_ASIDE, sha256, err);
}

bool wr_journal_keep_bytes(WrJournal *journal, const char *path, const void *bytes, size_t length,
                           const char *sha256, WrError *err)
{
    if (!can_keep(journal, path, sha256, err)) return false;
    int from = wr_fd_in_memory(path, bytes, length, err);
    return from >= 0 && keep_copy(journal, path, from, false, sha256, err);
}

bool wr_journal_keep_named(WrJournal *journal, const char *path, WrError *err)
{
    if (!journal->path) return wr_fail(err, "%s", journal->reason);
    return journal_keep_as_named(journal->files, path, err);
}

bool wr_journal_snapshot_path(WrJournal *journal, WrText *path, WrError *err)
{
    if (!journal->path) return wr_fail(err, "%s", journal->reason);
    if (!journal_make_folder(journal->files, err)) return false;
    wr_text_addf(path, "%s/" WR_JOURNAL_SNAPSHOT_NAME, journal->files, ++journal->snapshot);
    return true;
}

/* ---- closing ---- */

static void free_journal(WrJournal *journal)
{
    if (journal->fd >= 0) wr_fd_close(journal->fd); /* this also releases the lock */
    wr_free((char *)journal->options.folder);
    wr_free((char *)journal->options.program);
    wr_free(journal->path);
    wr_free(journal->temporary);
    wr_free(journal->files);
    wr_text_fini(&journal->line);
    wr_array_free(&journal->copies);
    wr_free(journal);
}

void wr_journal_finish(WrJournal *journal)
{
    WrFileInfo mine, named;
    if (!journal) return;
    /* The journal is removed first: the files are useless without it, while it would be misleading without them. */
    if (journal->fd >= 0 && wr_fd_info(journal->fd, &mine) && wr_path_info(journal->path, &named) &&
        mine.inode == named.inode && mine.device == named.device)
        wr_path_remove(journal->path);
    cancel_copies(journal, NULL);
    if (journal->path) wr_journal_clear_files(journal->files, NULL, NULL);
    free_journal(journal);
}

void wr_journal_leave(WrJournal *journal)
{
    if (!journal) return;
    settle_copies(journal, true);
    if (!journal->broken && journal->unsynced) wr_journal_sync(journal, NULL);
    free_journal(journal);
}
