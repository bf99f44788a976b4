/* Listing of journals that were left behind, and locking of one while it is recovered. */
#include "document/recover.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "document/journal_folder.h"
#include "system/fd.h"
#include "system/path.h"
#include "system/thread.h"

#include <errno.h>
#include <string.h>
#include <time.h>

static void fini_entry(WrJournalEntry *entry)
{
    wr_free(entry->path);
    wr_free(entry->document);
}

static bool all_is_saved(const WrJournalRead *read, WrJournalCounts counts)
{
    if (!read->saved.path) return false;
    int i = read->saved.at;
    while (counts && i < read->total && !counts(read->lines[i].text)) i++;
    return i == read->total;
}

static void describe(int fd, WrJournalCounts counts, WrJournalEntry *entry)
{
    WrJournalRead read;
    WrError err;
    if (!wr_journal_read_fd(fd, entry->path, &read, &err)) {
        entry->document = wr_strdup("");
        snprintf(entry->error, sizeof entry->error, "%.250s", err.text);
        return;
    }
    const char *name = read.saved.path ? read.saved.path : read.start.path;
    /* the saved file contains the earlier commands */
    int from = read.saved.path ? read.saved.at : 0;
    bool all_saved = all_is_saved(&read, counts);
    entry->document = wr_strdup(name ? name : "");
    entry->kind = read.start.kind;
    entry->started = read.started;
    entry->complete = wr_journal_sound_end(&read, from, read.saved.path) - from;
    entry->beyond = read.total - from - entry->complete;
    if (read.unfinished && entry->beyond > 0) entry->beyond--;
    else if (read.unfinished) entry->complete--;
    entry->unfinished = read.unfinished;
    entry->headless = read.headless;
    entry->lost = read.lost;
    entry->dropped_bytes = read.dropped_bytes;
    memcpy(entry->damage, read.damage, sizeof entry->damage);
    entry->nothing = (all_saved || (read.total == 0 && read.start.kind != WR_JOURNAL_SNAPSHOT)) &&
                     !(read.headless && !all_saved) && read.lost_at_end == 0 && !*read.gap;
    wr_journal_read_fini(&read);
}

/* Reads a journal's summary. False if a program holds it, or it is not a journal file. The lock is held only for
   the test, and shared, so that two programs can list it at the same time. */
static bool look_at(const char *path, WrJournalCounts counts, WrJournalEntry *entry)
{
    WrFileInfo info;
    int fd = wr_journal_open(path, NULL);
    if (fd < 0) return false;
    bool left = wr_journal_lock(fd, path, WR_LOCK_SHARED) && wr_fd_info(fd, &info);
    if (left) {
        wr_fd_lock(fd, WR_LOCK_NONE);
        *entry = (WrJournalEntry){ .path = wr_strdup(path),
                                   .written = (int64_t)info.seconds,
                                   .bytes = (int64_t)info.bytes };
        describe(fd, counts, entry);
    }
    wr_fd_close(fd);
    return left;
}

/* True if it was killed after everything was saved: the journal is useless. */
static bool is_old_and_empty(const WrJournalEntry *entry)
{
    return entry->nothing && time(NULL) - (time_t)entry->written >= WR_JOURNAL_LEFTOVER_SECONDS;
}

static void remove_old(const char *path)
{
    WrJournalClaim *claim = wr_journal_claim(path, NULL);
    if (claim) wr_journal_claim_remove(claim, NULL);
}

static int newest_first(const void *a, const void *b)
{
    const WrJournalEntry *x = a, *y = b;
    if (x->written != y->written) return x->written < y->written ? 1 : -1;
    return strcmp(y->path, x->path);
}

bool wr_journal_list(const char *folder, WrJournalList *out, WrError *err)
{
    return wr_journal_list_that(folder, NULL, out, err);
}

bool wr_journal_list_that(const char *folder, WrJournalCounts counts, WrJournalList *out,
                          WrError *err)
{
    WrText usual = { 0 };
    if (!folder && !wr_journal_folder(&usual, err)) return false;
    const char *place = folder ? folder : wr_text_get(&usual);
    WR_ARRAY(WrJournalEntry) found = { 0 };
    WrFolder *dir = wr_folder_open(place);
    bool ok = dir || errno == ENOENT || wr_fail(err, "%s: %s", place, strerror(errno));
    const char *entry;
    while (dir && (entry = wr_folder_next(dir))) {
        size_t length = strlen(entry), ending = strlen(WR_JOURNAL_ENDING);
        if (entry[0] == '.' || length <= ending ||
            strcmp(entry + length - ending, WR_JOURNAL_ENDING) != 0)
            continue;
        WrJournalEntry one;
        char *path = wr_path_join(place, entry);
        bool left = look_at(path, counts, &one), old = left && is_old_and_empty(&one);
        if (old) {
            fini_entry(&one);
            remove_old(path);
        } else if (left) {
            wr_array_push(&found, one);
        }
        wr_free(path);
    }
    wr_folder_close(dir);
    wr_text_fini(&usual);
    if (!ok) return false;
    if (found.count > 1) qsort(found.data, (size_t)found.count, sizeof *found.data, newest_first);
    *out = (WrJournalList){ found.data, found.count };
    return true;
}

void wr_journal_list_fini(WrJournalList *list)
{
    for (int i = 0; i < list->count; i++) fini_entry(&list->entries[i]);
    wr_free(list->entries);
    *list = (WrJournalList){ 0 };
}

struct WrJournalClaim {
    char *path; /* owned */
    int fd;     /* locked */
};

/* Retries the lock, since other programs that list journals hold it for a moment. */
static bool lock_patiently(int fd, const char *path)
{
    for (int tries = 0; tries < 10; tries++) {
        if (wr_journal_lock(fd, path, WR_LOCK_ALONE)) return true;
        wr_thread_sleep_ms(5);
    }
    return false;
}

WrJournalClaim *wr_journal_claim(const char *path, WrError *err)
{
    int fd = wr_journal_open(path, err);
    if (fd < 0) return NULL;
    if (!lock_patiently(fd, path)) {
        wr_fd_close(fd);
        wr_fail(err, "%s: in use by a running program", path);
        return NULL;
    }
    WrJournalClaim *claim = wr_alloc(1, sizeof *claim);
    *claim = (WrJournalClaim){ wr_strdup(path), fd };
    return claim;
}

void wr_journal_claim_free(WrJournalClaim *claim)
{
    if (!claim) return;
    wr_fd_close(claim->fd);
    wr_free(claim->path);
    wr_free(claim);
}

bool wr_journal_claim_remove(WrJournalClaim *claim, WrError *err)
{
    bool ok = wr_path_remove(claim->path) || errno == ENOENT ||
              wr_fail(err, "%s: cannot be removed (%s)", claim->path, strerror(errno));
    if (ok) {
        char *files = wr_journal_files_folder(claim->path);
        wr_journal_clear_files(files, NULL, NULL);
        wr_free(files);
    }
    wr_journal_claim_free(claim);
    return ok;
}
