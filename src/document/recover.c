#include "document/recover.h"

#include "base/memory.h"
#include "document/journal_folder.h"
#include "document/journal_line.h"

#include <errno.h>
#include <inttypes.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define HEADER_MAX 65536 /* bytes: some paths, escaped */
#define FIRST_BUFFER 65536

/* ---- lines of a file, none longer than WR_JOURNAL_LINE_MAX ---- */

typedef struct Reader {
    int fd;
    char *buffer; /* owned; one byte more than capacity, for a NUL */
    size_t capacity, start, end;
    int64_t offset; /* in the file, of buffer[start] */
    bool ended;
} Reader;

typedef enum Next { NEXT_LINE, NEXT_END, NEXT_BAD } Next;

/* Room behind `end`: move what is left to the front, or grow. */
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
    ssize_t n;
    do n = read(reader->fd, reader->buffer + reader->end, room);
    while (n < 0 && errno == EINTR);
    if (n < 0) return wr_fail(err, "cannot be read (%s)", strerror(errno));
    reader->ended = n == 0;
    reader->end += (size_t)n;
    return true;
}

/* The next whole line, without its end, in place; until the next call. *err only with NEXT_BAD. */
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
            wr_fail(err, "torn: it has no end");
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

typedef struct Collector {
    char *texts; /* owned; NUL-ended command lines one after the other */
    size_t used, capacity;
    Command *commands; /* owned */
    int count, room;
    bool pending; /* the last command has no end yet */
    bool drawing; /* and is a stroke that takes samples */
    size_t head;  /* bytes of its head: as long as there is no more, nothing happened */
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

/* The last command will not get more text, and may or may not have had an end. */
static void settle(Collector *c, bool done)
{
    if (!c->pending) return;
    Command *last = &c->commands[c->count - 1];
    if (last->line.stroke && c->used == last->text + c->head) { /* no samples */
        c->used = last->text;
        c->count--;
    } else {
        last->line.done = done;
        c->used++; /* the NUL */
    }
    c->pending = c->drawing = false;
}

static bool add_command(Collector *c, const char *text, size_t length, bool stroke, WrError *err)
{
    settle(c, true); /* the program lived on */
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
    c->commands[c->count++] = (Command){ .text = at, .line.stroke = stroke };
    c->pending = true;
    c->drawing = stroke;
    c->head = length;
    return true;
}

static bool add_samples(Collector *c, const char *text, size_t length, WrError *err)
{
    if (!c->drawing) return wr_fail(err, "samples without a stroke");
    if (length == 0) return true;
    bool first = c->used == c->commands[c->count - 1].text + c->head;
    return (first || add_bytes(c, ";", 1, err)) && add_bytes(c, text, length, err);
}

static bool end_command(Collector *c, const char *text, WrError *err)
{
    WrHash hash;
    bool hashed = strncmp(text, "ok ", 3) == 0;
    bool dropped = strcmp(text, "dropped") == 0;
    if (!dropped && !hashed && strcmp(text, "ok") != 0) return wr_fail(err, "an unknown outcome");
    if (hashed && !wr_journal_parse_hash(text + 3, &hash))
        return wr_fail(err, "an outcome without its hash");
    if (!c->pending) return true; /* a stroke without samples */
    if (dropped) {
        c->used = c->commands[--c->count].text;
        c->pending = c->drawing = false;
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
    if (!c->drawing) return wr_fail(err, "the end of a stroke without its begin");
    c->drawing = false;
    if (c->used == c->commands[c->count - 1].text + c->head) settle(c, true);
    return true;
}

/* Take one record in. *ended: what follows does not count. */
static bool take(Collector *c, char kind, const char *text, size_t length, WrJournalRead *read,
                 bool *ended, WrError *err)
{
    switch (kind) {
    case 'c': return add_command(c, text, length, false, err);
    case 'b': return add_command(c, text, length, true, err);
    case 's': return add_samples(c, text, length, err);
    case 'e': return end_stroke(c, err);
    case 'd': return end_command(c, text, err);
    case 'g':
        snprintf(read->gap, sizeof read->gap, "%.250s", *text ? text : "for an unknown reason");
        settle(c, true);
        *ended = true;
        return true;
    default: return true; /* notes */
    }
}

/* ---- the whole ---- */

static bool read_header(Reader *reader, const char *path, WrJournalRead *read, WrHash *chain,
                        WrError *err)
{
    char *line;
    size_t length;
    WrError why = { "" };
    WrJournalHeader header;
    Next next = next_line(reader, &line, &length, &why);
    if (next == NEXT_END) return wr_fail(err, "%s: empty: no journal", path);
    if (next == NEXT_BAD && reader->end - reader->start < HEADER_MAX)
        return wr_fail(err, "%s: the journal's first line is %s", path, why.text);
    if (next == NEXT_BAD || length > HEADER_MAX)
        return wr_fail(err, "%s: not a journal of this program", path);
    char *own = wr_strndup(line, length);
    if (!wr_journal_parse_header(own, length, &header, chain, &why)) {
        wr_free(own);
        return wr_fail(err, "%s: %s", path, why.text);
    }
    read->owned[0] = own;
    read->start = header.start;
    read->program = header.program;
    read->started = header.time;
    if (header.start.snapshot) {
        char *files = wr_journal_files_folder(path);
        WrText whole = { 0 };
        wr_text_addf(&whole, "%s/%s", files, header.start.snapshot);
        wr_free(files);
        read->start.snapshot = read->owned[1] = whole.data;
    }
    return true;
}

/* All records up to the first bad one; *good is the offset behind the last good one. */
static void read_records(Reader *reader, Collector *collector, WrHash chain, WrJournalRead *read,
                         int64_t *good)
{
    WrError why = { "" };
    bool ended = false;
    uint64_t sequence = 1;
    *good = reader->offset;
    while (!ended) {
        char *line, *text, kind;
        size_t length;
        Next next = next_line(reader, &line, &length, &why);
        if (next == NEXT_END) break;
        if (next == NEXT_BAD ||
            !wr_journal_parse_line(line, length, sequence, &chain, &kind, &text, &length, &why) ||
            !take(collector, kind, text, length, read, &ended, &why)) {
            snprintf(read->damage, sizeof read->damage, "line %" PRIu64 ": %.200s", sequence + 1,
                     why.text);
            break;
        }
        sequence++;
        *good = reader->offset;
    }
}

/* Hand the commands over, their texts where they lie. */
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
    read->count = collector->count;
    read->owned[2] = collector->texts;
    collector->texts = NULL;
    return true;
}

bool wr_journal_read_fd(int fd, const char *path, WrJournalRead *out, WrError *err)
{
    Reader reader = { .fd = fd };
    Collector collector = { 0 };
    WrJournalRead read = { 0 };
    WrHash chain;
    struct stat info;
    int64_t good;
    bool ok = read_header(&reader, path, &read, &chain, err);
    if (ok) {
        read_records(&reader, &collector, chain, &read, &good);
        if (fstat(fd, &info) == 0 && info.st_size > good) read.dropped_bytes = info.st_size - good;
        ok = hand_over(&collector, &read, err);
    }
    wr_free(reader.buffer);
    wr_free(collector.texts);
    wr_free(collector.commands);
    if (ok) *out = read;
    else wr_journal_read_fini(&read);
    return ok;
}

bool wr_journal_read(const char *path, WrJournalRead *out, WrError *err)
{
    int fd = wr_journal_open(path, err);
    if (fd < 0) return false;
    bool ok = wr_journal_read_fd(fd, path, out, err);
    close(fd);
    return ok;
}

void wr_journal_read_fini(WrJournalRead *read)
{
    for (int i = 0; i < 3; i++) wr_free(read->owned[i]);
    wr_free(read->lines);
    *read = (WrJournalRead){ 0 };
}
