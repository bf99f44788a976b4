/* Recovery of journals: reading, listing and locking, and the trial of a command in a child process. */
#include "document/recover.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "document/recovery_journal.h"
#include "system/child.h"
#include "system/fd.h"
#include "system/path.h"
#include "system/thread.h"

#include <errno.h>
#include <inttypes.h>
#include <string.h>
#include <time.h>

/* ---- reading a journal ---- */

#define HEADER_MAX 65536 /* bytes: several paths, escaped */
#define FIRST_BUFFER 65536

/* ---- lines of a file, limited to WR_JOURNAL_LINE_MAX ---- */

/* A journal may be torn anywhere, since its program died while it wrote, and like every file it is treated as a
   stranger's. Hence the limits of line, file and number of commands, and memory that grows with the data read and
   not with a length in the file. */
typedef struct Reader {
    int fd;
    char *buffer; /* owned; one byte more than capacity, for a NUL */
    size_t capacity, start, end;
    int64_t offset; /* in the file, of buffer[start] */
    bool ended;
} Reader;

typedef enum Next { NEXT_LINE, NEXT_END, NEXT_BAD } Next;

/* Makes space after `end`: moves the rest to the front, or grows. */
static bool make_room(Reader *reader, WrError *err)
{
    size_t used = reader->end - reader->start;
    if (reader->start > 0) {
        memmove(reader->buffer, reader->buffer + reader->start, used);
        reader->start = 0;
        reader->end = used;
    }
    if (used < reader->capacity) return true;
    size_t grown = reader->capacity ? reader->capacity * 2 : FIRST_BUFFER;
    if (grown > (size_t)WR_JOURNAL_LINE_MAX) grown = (size_t)WR_JOURNAL_LINE_MAX;
    if (grown == reader->capacity)
        return wr_fail(err, "longer than %.0f MB", (double)WR_JOURNAL_LINE_MAX / 1e6);
    char *buffer = wr_try_alloc(grown + 1, 1, "a line of the journal", err);
    if (!buffer) return false;
    if (used) memcpy(buffer, reader->buffer, used);
    wr_free(reader->buffer);
    reader->buffer = buffer;
    reader->capacity = grown;
    return true;
}

static bool fill(Reader *reader, WrError *err)
{
    if (!make_room(reader, err)) return false;
    size_t room = reader->capacity - reader->end;
    int64_t left = WR_JOURNAL_FILE_MAX - reader->offset - (int64_t)(reader->end - reader->start);
    if (left <= 0)
        return wr_fail(err, "beyond %.0f MB, which is the most that is read",
                       (double)WR_JOURNAL_FILE_MAX / 1e6);
    if ((int64_t)room > left) room = (size_t)left;
    int64_t n = wr_fd_read(reader->fd, reader->buffer + reader->end, room);
    if (n < 0) return wr_fail(err, "cannot be read (%s)", strerror(errno));
    reader->ended = n == 0;
    reader->end += (size_t)n;
    return true;
}

/* The next whole line, without its end, in place; valid until the next call. *err is set only with NEXT_BAD. `searched` keeps
   the search linear: a line of n bytes that arrives in pieces is not searched again from its start. make_room moves the data,
   therefore it is an offset and no pointer. */
static Next next_line(Reader *reader, char **line, size_t *length, WrError *err)
{
    size_t searched = 0;
    for (;;) {
        char *from = reader->buffer ? reader->buffer + reader->start : NULL;
        size_t have = reader->end - reader->start;
        char *stop = have > searched ? memchr(from + searched, '\n', have - searched) : NULL;
        if (stop) {
            *line = from;
            *length = (size_t)(stop - from);
            reader->start += *length + 1;
            reader->offset += (int64_t)*length + 1;
            return NEXT_LINE;
        }
        if (reader->ended && have == 0) return NEXT_END;
        if (reader->ended) {
            wr_fail(err, "truncated: it has no end");
            return NEXT_BAD;
        }
        searched = have;
        if (!fill(reader, err)) return NEXT_BAD;
    }
}

/* ---- from records to command lines ---- */

typedef struct Command {
    size_t text; /* offset in the texts */
    WrJournalLine line;
} Command;

/* Command lines are concatenated in `texts` because a stroke arrives as a head and many records of samples, which are
   appended to the last text. Offsets are stored since the buffer moves when it grows. */
typedef struct Collector {
    char *texts; /* owned; NUL-ended command lines, concatenated */
    size_t used, capacity;
    Command *commands; /* owned */
    int count, room;
    bool pending; /* the last command has no end yet */
    bool drawing; /* it is a stroke that accepts samples */
    size_t head;  /* bytes of its head: a stroke without more has no effect */
    int sound;    /* number of commands before the first damage; -1: no damage yet */
    int gap;      /* lines lost directly before the next record */
    /* records that continue a lost command are lost with it, until the next command begins */
    bool orphans;
    int lost; /* since the last command */
    WrJournalSave saved;
    char *saved_path; /* owned */
} Collector;

static bool add_bytes(Collector *c, const char *bytes, size_t length, WrError *err)
{
    if (c->used + length + 1 > c->capacity) {
        size_t grown = c->capacity * 2 + length + 4096;
        char *texts = wr_try_alloc(grown, 1, "the journal's commands", err);
        if (!texts) return false;
        if (c->used) memcpy(texts, c->texts, c->used);
        wr_free(c->texts);
        c->texts = texts;
        c->capacity = grown;
    }
    memcpy(c->texts + c->used, bytes, length);
    c->used += length;
    c->texts[c->used] = '\0'; /* counted when the command is complete */
    return true;
}

/* Removes the last command. */
static void drop(Collector *c)
{
    c->used = c->commands[--c->count].text;
    c->pending = c->drawing = false;
    if (c->sound > c->count) c->sound = c->count;
}

/* Closes the last command, with or without a recorded end. */
static void settle(Collector *c, bool done)
{
    if (!c->pending) return;
    Command *last = &c->commands[c->count - 1];
    if (last->line.stroke && c->used == last->text + c->head) { /* no samples */
        drop(c);
        return;
    }
    last->line.done = done;
    c->used++; /* includes the NUL */
    c->pending = c->drawing = false;
}

static void note_damage(Collector *c, WrJournalRead *read, uint64_t line, const char *why)
{
    if (c->sound < 0) c->sound = c->count;
    if (!*read->damage)
        snprintf(read->damage, sizeof read->damage, "line %" PRIu64 ": %.200s", line, why);
}

/* Records `lost` missing lines. A single one cannot have begun another command while one is open: so the
   following records still belong to the open one. */
static void open_gap(Collector *c, WrJournalRead *read, int lost)
{
    if (lost <= 0) return;
    read->lost += lost;
    c->lost += lost;
    c->gap = lost;
    if (lost == 1 && c->pending) return;
    settle(c, true);
    c->orphans = true;
}

static bool add_command(Collector *c, const char *text, size_t length, bool stroke, WrError *err)
{
    if (c->gap && c->drawing) drop(c); /* only a cancelled stroke has no end before its d */
    c->orphans = false;
    settle(c, true); /* a later record shows that the program continued */
    if (c->count >= WR_JOURNAL_COMMANDS_MAX)
        return wr_fail(err, "more than %d commands", WR_JOURNAL_COMMANDS_MAX);
    if (c->count == c->room) {
        int grown = c->room * 2 + 64;
        Command *commands =
            wr_try_alloc((size_t)grown, sizeof *commands, "the journal's commands", err);
        if (!commands) return false;
        if (c->count) memcpy(commands, c->commands, (size_t)c->count * sizeof *commands);
        wr_free(c->commands);
        c->commands = commands;
        c->room = grown;
    }
    size_t at = c->used;
    if (!add_bytes(c, text, length, err)) return false;
    c->commands[c->count++] =
        (Command){ .text = at, .line = { .stroke = stroke, .lost = c->lost } };
    c->lost = 0;
    c->pending = true;
    c->drawing = stroke;
    c->head = length;
    return true;
}

/* The line lost before this one contained samples of the stroke. */
static void note_hole(Collector *c)
{
    if (!c->gap) return;
    c->commands[c->count - 1].line.holed = true;
    if (c->sound >= c->count) c->sound = c->count - 1;
}

static bool add_samples(Collector *c, const char *text, size_t length, WrError *err)
{
    if (!c->drawing) return wr_fail(err, "samples without a stroke");
    if (length == 0) return true;
    Command *last = &c->commands[c->count - 1];
    bool first = c->used == last->text + c->head;
    note_hole(c);
    return (first || add_bytes(c, ";", 1, err)) && add_bytes(c, text, length, err);
}

static bool end_command(Collector *c, const char *text, WrError *err)
{
    WrHash hash;
    bool hashed = strncmp(text, "ok ", 3) == 0;
    bool dropped = strcmp(text, "dropped") == 0;
    if (!dropped && !hashed && strcmp(text, "ok") != 0) return wr_fail(err, "an unknown outcome");
    if (hashed && !wr_hash_parse(text + 3, &hash)) return wr_fail(err, "an outcome without a hash");
    if (!c->pending) return true; /* a stroke without samples */
    if (dropped) {
        drop(c);
        return true;
    }
    WrJournalLine *line = &c->commands[c->count - 1].line;
    line->hashed = hashed;
    if (hashed) line->hash = hash;
    settle(c, true);
    return true;
}

static bool end_stroke(Collector *c, WrError *err)
{
    if (!c->drawing) return wr_fail(err, "the end of a stroke without a begin");
    note_hole(c);
    c->drawing = false;
    if (c->used == c->commands[c->count - 1].text + c->head) settle(c, true);
    return true;
}

/* "HASH PATH" */
static bool take_save(Collector *c, const char *text, WrError *err)
{
    char digits[33] = "";
    WrHash hash;
    strncpy(digits, text, 32);
    if (!wr_hash_parse(digits, &hash) || text[32] != ' ' || text[33] != '/')
        return wr_fail(err, "a save without a hash or file");
    settle(c, true);
    c->lost = 0; /* the saved file contains all of it */
    wr_free(c->saved_path);
    c->saved_path = wr_strdup(text + 33);
    c->saved = (WrJournalSave){ .path = c->saved_path, .hash = hash, .at = c->count };
    return true;
}

/* Processes one record. *ended: the following records are ignored. */
static bool take(Collector *c, char kind, const char *text, size_t length, WrJournalRead *read,
                 bool *ended, WrError *err)
{
    if (c->orphans && strchr("sed", kind)) {
        read->lost++;
        c->lost++;
        return true;
    }
    switch (kind) {
    case 'c': return add_command(c, text, length, false, err);
    case 'b': return add_command(c, text, length, true, err);
    case 's': return add_samples(c, text, length, err);
    case 'e': return end_stroke(c, err);
    case 'd': return end_command(c, text, err);
    case 'v': return take_save(c, text, err);
    case 'g':
        snprintf(read->gap, sizeof read->gap, "%.250s", *text ? text : "for an unknown reason");
        settle(c, true);
        *ended = true;
        return true;
    default: return true; /* notes */
    }
}

/* ---- whole journal ---- */

static void set_start(WrJournalRead *read, const WrJournalHeader *header, const char *path)
{
    read->start = header->start;
    read->program = header->program;
    read->started = header->time;
    if (!header->start.snapshot) return;
    char *files = wr_journal_files_folder(path);
    WrText whole = { 0 };
    wr_text_addf(&whole, "%s/%s", files, header->start.snapshot);
    wr_free(files);
    read->start.snapshot = read->owned[1] = whole.data;
}

/* Guesses the start state from a first line that is damaged; modifies the line. */
static void guess_start(WrJournalRead *read, char *line, size_t length, const char *path)
{
    WrJournalHeader header = { .program = "" };
    char *files = wr_journal_files_folder(path), *name = NULL;
    read->headless = true;
    read->owned[0] = line;
    if (!wr_journal_guess_header(line, length, &header)) {
        header = (WrJournalHeader){ .program = "" };
        name = wr_journal_newest_snapshot(files);
        if (name) header.start = (WrJournalStart){ .kind = WR_JOURNAL_SNAPSHOT, .snapshot = name };
    }
    set_start(read, &header, path);
    wr_free(name);
    wr_free(files);
}

/* Reads the header; false if there is not even a damaged one. *why: "" or the damage, for the case that no later
   line is whole either. */
static bool read_header(Reader *reader, const char *path, WrJournalRead *read, WrJournalSeal *seal,
                        WrError *why, WrError *err)
{
    char *line;
    size_t length;
    WrJournalHeader header;
    Next next = next_line(reader, &line, &length, why);
    if (next == NEXT_END) return wr_fail(err, "%s: empty: not a journal", path);
    if (next == NEXT_BAD && reader->end - reader->start < HEADER_MAX)
        return wr_fail(err, "%s: the journal's first line is %s", path, wr_error_message(why));
    if (next == NEXT_BAD) return wr_fail(err, "%s: not a journal of this program", path);
    char *own = wr_strndup(line, length < HEADER_MAX ? length : HEADER_MAX);
    why->text[0] = '\0';
    if (length > HEADER_MAX) wr_fail(why, "not a journal of this program");
    else wr_journal_parse_header(own, length, &header, seal, why);
    if (why->text[0]) {
        guess_start(read, own, strlen(own), path);
        return true;
    }
    read->owned[0] = own;
    set_start(read, &header, path);
    return true;
}

static int as_lines(uint64_t lines)
{
    return lines > INT32_MAX / 2 ? INT32_MAX / 2 : (int)lines;
}

/* Reads all whole records; returns their number. *good is the offset after the last one before any damage. */
static int64_t read_records(Reader *reader, Collector *c, WrJournalSeal seal, WrJournalRead *read,
                            int64_t *good)
{
    WrError why = { "" };
    bool ended = false, torn = false;
    uint64_t expected = 1, number, line_number = 1;
    int64_t whole = 0;
    int bad = 0; /* since the last whole one */
    *good = reader->offset;
    while (!ended && !torn) {
        char *line, *text, kind;
        size_t length;
        Next next = next_line(reader, &line, &length, &why);
        if (next == NEXT_END) break;
        line_number++;
        torn = next == NEXT_BAD;
        if (torn ||
            !wr_journal_parse_line(line, length, &seal, &number, &kind, &text, &length, &why) ||
            (number < expected &&
             !wr_fail(&why, "not line %llu of the journal", (unsigned long long)expected))) {
            note_damage(c, read, line_number, why.text);
            bad++;
            continue;
        }
        if (number > expected) {
            note_damage(c, read, line_number, "lines before it are missing");
            open_gap(c, read, as_lines(number - expected));
        }
        bad = 0;
        expected = number + 1;
        whole++;
        if (!take(c, kind, text, length, read, &ended, &why)) {
            note_damage(c, read, line_number, why.text);
            open_gap(c, read, 1);
            continue;
        }
        c->gap = 0;
        if (c->sound < 0) *good = reader->offset;
    }
    read->lost += bad;
    read->lost_at_end = c->lost + bad;
    return whole;
}

/* Moves the commands and their texts to the result. */
static bool hand_over(Collector *collector, WrJournalRead *read, WrError *err)
{
    bool pending = collector->pending, drawing = collector->drawing;
    int before = collector->count;
    settle(collector, false);
    read->unfinished = pending && collector->count == before;
    read->in_stroke = read->unfinished && drawing;
    size_t count = (size_t)collector->count;
    read->lines = wr_try_alloc(count ? count : 1, sizeof *read->lines, "commands", err);
    if (!read->lines) return false;
    for (size_t i = 0; i < count; i++) {
        read->lines[i] = collector->commands[i].line;
        read->lines[i].text = collector->texts + collector->commands[i].text;
    }
    read->total = read->count = collector->count;
    if (collector->sound >= 0 && collector->sound < read->total) read->count = collector->sound;
    read->saved = collector->saved;
    if (read->saved.at > read->total) read->saved.at = read->total;
    read->owned[2] = collector->texts;
    read->owned[3] = collector->saved_path;
    collector->texts = collector->saved_path = NULL;
    return true;
}

bool wr_journal_read_fd(int fd, const char *path, WrJournalRead *out, WrError *err)
{
    Reader reader = { .fd = fd };
    Collector collector = { .sound = -1 };
    WrJournalRead read = { 0 };
    WrJournalSeal seal = { 0 };
    WrError why = { "" };
    WrFileInfo info;
    int64_t good;
    bool ok = read_header(&reader, path, &read, &seal, &why, err);
    if (ok && read.headless) note_damage(&collector, &read, 1, why.text);
    if (ok) {
        int64_t whole = read_records(&reader, &collector, seal, &read, &good);
        if (read.headless && whole == 0) ok = wr_fail(err, "%s: %s", path, wr_error_message(&why));
        if (wr_fd_info(fd, &info) && info.bytes > good) read.dropped_bytes = info.bytes - good;
        ok = ok && hand_over(&collector, &read, err);
    }
    wr_free(reader.buffer);
    wr_free(collector.texts);
    wr_free(collector.commands);
    wr_free(collector.saved_path);
    if (ok) *out = read;
    else wr_journal_read_fini(&read);
    return ok;
}

bool wr_journal_read(const char *path, WrJournalRead *out, WrError *err)
{
    int fd = wr_journal_open(path, err);
    if (fd < 0) return false;
    bool ok = wr_journal_read_fd(fd, path, out, err);
    wr_fd_close(fd);
    return ok;
}

int wr_journal_sound_end(const WrJournalRead *read, int from, bool known)
{
    int end = from;
    if (read->headless && !known) return from;
    while (end < read->total && !read->lines[end].lost && !read->lines[end].holed) end++;
    return end;
}

void wr_journal_read_fini(WrJournalRead *read)
{
    for (int i = 0; i < 4; i++) wr_free(read->owned[i]);
    wr_free(read->lines);
    *read = (WrJournalRead){ 0 };
}

/* ---- journals that were left behind ---- */

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

/* ---- trial of a command in a child process ---- */

#define LEAST_SECONDS 0.02

/* The child's result, sent before it ends; small enough for one write. */
typedef struct Verdict {
    bool result;
    WrError err;
} Verdict;

typedef struct Trial {
    WrProbeFunction function;
    void *ctx;
} Trial;

static void work(void *ctx, void *answer)
{
    const Trial *trial = ctx;
    Verdict *verdict = answer;
    verdict->result = trial->function(trial->ctx, &verdict->err);
}

static WrProbeEnd judge(const Verdict *verdict, WrError *err)
{
    if (verdict->result) return WR_PROBE_TRUE;
    wr_fail(err, "%s", wr_error_message(&verdict->err));
    return WR_PROBE_FALSE;
}

static WrProbeEnd report_crash(WrChildEnd end, WrError *err)
{
    const char *name = wr_child_crash(end.number);
    if (end.why == WR_CHILD_LEFT)
        wr_fail(err, "it ended the program by itself (status %d)", end.number);
    else wr_fail(err, "it crashed: %s (signal %d)", name ? name : "unknown", end.number);
    return WR_PROBE_CRASHED;
}

WrProbeEnd wr_journal_trial(WrProbeFunction function, void *ctx, double seconds, size_t bytes,
                            WrError *err)
{
    Verdict verdict;
    WrChildEnd end;
    Trial trial = { function, ctx };
    if (!(seconds > 0)) seconds = LEAST_SECONDS;
    if (seconds > 1e6) seconds = 1e6;
    WrTry it = { .work = work,
                 .ctx = &trial,
                 .answer = &verdict,
                 .length = sizeof verdict,
                 .seconds = seconds,
                 .memory = bytes,
                 .stopped = wr_progress_stopped };
    const WrTryResult result = wr_child_try(&it, &end);
    verdict.err.text[sizeof verdict.err.text - 1] = '\0';
    if (result == WR_TRY_ANSWERED) return judge(&verdict, err);
    if (result == WR_TRY_ENDED) return report_crash(end, err);
    if (result == WR_TRY_LATE) {
        wr_fail(err, "it took more than %g s", seconds);
        return WR_PROBE_TIMEOUT;
    }
    wr_fail(err, "no %s a crash test: %s", result == WR_TRY_NO_PIPE ? "pipe to" : "child for",
            strerror(errno));
    return WR_PROBE_UNABLE;
}
