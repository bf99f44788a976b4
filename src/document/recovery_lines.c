/* Lines of a journal: escapes, checksums, the header. A checksum covers its line alone, so a torn last line costs that line
   only. */
#include "document/recovery_journal.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/text.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAGIC "wrinkle-journal"
#define HASH_DIGITS 32
#define HEADER_WORDS 7 /* after the checksum: program, time, kind, hash, sha256, snapshot, path */

WR_ROWS(kind_words);
static const char *const kind_words[WR_JOURNAL_KINDS] = { [WR_ROW(WR_JOURNAL_EMPTY)] = "empty",
                                                          [WR_ROW(WR_JOURNAL_DOCUMENT)] =
                                                              "document",
                                                          [WR_ROW(WR_JOURNAL_SNAPSHOT)] =
                                                              "snapshot" };
WR_ROWS_END(kind_words, WR_JOURNAL_KINDS);

/* ---- escapes ---- */

/* Escapes keep a record on one line and its words without blanks: \n, \r, \s blank, \\, \e empty word. */
static void add_escaped(WrText *line, const char *text, bool word)
{
    const char *special = word ? "\\\n\r " : "\\\n\r";
    if (word && !*text) wr_text_add(line, "\\e");
    while (*text) {
        size_t plain = strcspn(text, special);
        wr_text_add_n(line, text, plain);
        text += plain;
        if (!*text) break;
        char letter = *text == '\n' ? 'n' : *text == '\r' ? 'r' : *text == ' ' ? 's' : '\\';
        wr_text_add_n(line, (char[]){ '\\', letter }, 2);
        text++;
    }
}

/* True if each backslash of text[0..length) starts an escape that add_escaped writes. */
static bool escapes_are_good(const char *text, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        if (text[i] != '\\') continue;
        i++;
        if (i >= length || !strchr("nrse\\", text[i]) || !text[i]) return false;
    }
    return true;
}

/* Unescapes in place; returns the new length. The escapes are valid, and text has room for a NUL. */
static size_t unescape(char *text, size_t length)
{
    size_t out = 0;
    for (size_t i = 0; i < length; i++) {
        char c = text[i];
        if (c == '\\') {
            c = text[++i];
            if (c == 'e') continue;
            c = c == 'n' ? '\n' : c == 'r' ? '\r' : c == 's' ? ' ' : '\\';
        }
        text[out++] = c;
    }
    text[out] = '\0';
    return out;
}

/* ---- checksums ---- */

bool wr_journal_is_sha256(const char *text)
{
    return memchr(text, '\0', 65) == text + 64 && strspn(text, "0123456789abcdef") == 64;
}

bool wr_journal_is_name(const char *text)
{
    return *text && *text != '.' && !strchr(text, '/');
}

/* "CHECKSUM BODY\n": the checksum is computed after the body, so space is reserved for it. */
static size_t begin_body(WrText *line)
{
    char room[HASH_DIGITS + 2];
    snprintf(room, sizeof room, "%*s", HASH_DIGITS + 1, "");
    wr_text_add(line, room);
    return line->length;
}

/* Separates the checksums of different formats. */
static const WrHash seed = { WR_JOURNAL_FORMAT, 0 };

static void end_body(WrText *line, size_t body)
{
    char digits[HASH_DIGITS + 1];
    wr_hash_print(wr_hash_bytes(line->data + body, line->length - body, seed), digits);
    memcpy(line->data + body - HASH_DIGITS - 1, digits, HASH_DIGITS);
    wr_text_add(line, "\n");
}

static bool body_has(const char *text, size_t length, WrHash start, const WrHash *written)
{
    WrHash hash = wr_hash_bytes(text + HASH_DIGITS + 1, length - HASH_DIGITS - 1, start);
    return wr_hash_equal(hash, *written);
}

/* text = "CHECKSUM BODY": checks the checksum of the body. In format 1 it depends on the checksum of the line
   before, so the stored checksum of a damaged line is kept for the next one. */
static bool check_body(const char *text, size_t length, WrJournalSeal *seal)
{
    WrHash before = seal->chain, written;
    char digits[HASH_DIGITS + 1] = "";
    if (length < HASH_DIGITS + 1 || text[HASH_DIGITS] != ' ') return false;
    memcpy(digits, text, HASH_DIGITS);
    if (!wr_hash_parse(digits, &written)) return false;
    seal->chain = written;
    return (seal->format != 1 && body_has(text, length, seed, &written)) ||
           (seal->format != 2 && body_has(text, length, before, &written));
}

/* ---- header ---- */

/* Header: MAGIC FORMAT CHECKSUM PROGRAM TIME KIND HASH SHA256 SNAPSHOT PATH. Records: CHECKSUM NUMBER KIND PAYLOAD, one a
   line, kinds: c command, d its outcome, b s e stroke's head, samples and end, n note, g gap, v saved. Every line is checked
   by itself, so a torn last line costs that line only. */
void wr_journal_print_header(WrText *line, const WrJournalHeader *header)
{
    const WrJournalStart *start = &header->start;
    char hash[HASH_DIGITS + 1];
    wr_text_addf(line, MAGIC " %d ", WR_JOURNAL_FORMAT);
    size_t body = begin_body(line);
    add_escaped(line, header->program, true);
    wr_hash_print(start->hash, hash);
    wr_text_addf(line, " %" PRId64 " %s %s ", header->time, kind_words[start->kind], hash);
    add_escaped(line, start->sha256 ? start->sha256 : "", true);
    wr_text_add(line, " ");
    add_escaped(line, start->snapshot ? start->snapshot : "", true);
    wr_text_add(line, " ");
    add_escaped(line, start->path ? start->path : "", true);
    end_body(line, body);
}

/* Splits "a b c" at its spaces into exactly `count` words, each unescaped. */
static bool split_words(char *text, size_t length, char **words, int count)
{
    if (!escapes_are_good(text, length)) return false;
    char *end = text + length;
    for (int i = 0; i < count; i++) {
        char *space = memchr(text, ' ', (size_t)(end - text));
        if ((space == NULL) != (i == count - 1)) return false;
        char *stop = space ? space : end;
        if (stop == text) return false;
        words[i] = text;
        text = stop + 1;
        unescape(words[i], (size_t)(stop - words[i]));
    }
    return true;
}

static bool parse_time(const char *text, int64_t *value)
{
    size_t digits = strspn(text, "0123456789");
    if (digits == 0 || digits > 18 || text[digits]) return false;
    *value = strtoll(text, NULL, 10);
    return true;
}

/* Parses the words of a header with a valid checksum: still validated, since anybody can compute a checksum. */
static bool header_from_words(char *const words[HEADER_WORDS], WrJournalHeader *out)
{
    WrJournalHeader h = { .program = words[0] };
    int kind = 0;
    while (kind < WR_JOURNAL_KINDS && strcmp(words[2], kind_words[kind]) != 0) kind++;
    if (kind == WR_JOURNAL_KINDS) return false;
    h.start.kind = (WrJournalKind)kind;
    if (!parse_time(words[1], &h.time)) return false;
    if (!wr_hash_parse(words[3], &h.start.hash)) return false;
    if (*words[4]) h.start.sha256 = words[4];
    if (*words[5]) h.start.snapshot = words[5];
    if (*words[6]) h.start.path = words[6];
    if (h.start.sha256 && !wr_journal_is_sha256(h.start.sha256)) return false;
    if (h.start.snapshot && !wr_journal_is_name(h.start.snapshot)) return false;
    if (h.start.path && h.start.path[0] != '/') return false;
    if ((h.start.kind == WR_JOURNAL_SNAPSHOT) != (h.start.snapshot != NULL)) return false;
    if (h.start.kind == WR_JOURNAL_DOCUMENT && !h.start.path) return false;
    *out = h;
    return true;
}

/* "MAGIC VERSION ": returns the offset after it, 0 if the line does not match. */
static size_t parse_magic(const char *line, size_t length, int *version)
{
    size_t at = strlen(MAGIC " "), digits = 0;
    *version = 0;
    if (length < at || memcmp(line, MAGIC " ", at) != 0) return 0;
    while (at < length && digits < 6 && line[at] >= '0' && line[at] <= '9') {
        *version = *version * 10 + (line[at++] - '0');
        digits++;
    }
    return digits > 0 && at < length && line[at] == ' ' ? at + 1 : 0;
}

static bool parse_words(char *body, size_t length, WrJournalHeader *out)
{
    char *words[HEADER_WORDS];
    return split_words(body, length, words, HEADER_WORDS) && header_from_words(words, out);
}

bool wr_journal_parse_header(char *line, size_t length, WrJournalHeader *out, WrJournalSeal *seal,
                             WrError *err)
{
    int version;
    size_t rest = parse_magic(line, length, &version), body = HASH_DIGITS + 1;
    if (length < strlen(MAGIC " ") || memcmp(line, MAGIC " ", strlen(MAGIC " ")) != 0)
        return wr_fail(err, "not a journal of this program");
    if (version > WR_JOURNAL_FORMAT)
        return wr_fail(err,
                       "journal of format %d, which is newer than this program's (%d): use the "
                       "program that wrote it, or a newer one",
                       version, WR_JOURNAL_FORMAT);
    WrJournalSeal made = { .format = version };
    if (!rest || version < 1 || memchr(line, '\0', length) ||
        !check_body(line + rest, length - rest, &made))
        return wr_fail(err, "the journal's first line is damaged");
    if (!parse_words(line + rest + body, length - rest - body, out))
        return wr_fail(err, "the journal's first line is invalid");
    *seal = made;
    return true;
}

bool wr_journal_guess_header(char *line, size_t length, WrJournalHeader *out)
{
    int version;
    size_t rest = parse_magic(line, length, &version), body = HASH_DIGITS + 1;
    return rest && !memchr(line, '\0', length) && length > rest + body &&
           parse_words(line + rest + body, length - rest - body, out);
}

/* ---- records ---- */

void wr_journal_print_line(WrText *line, uint64_t sequence, char kind, const char *payload)
{
    size_t body = begin_body(line);
    wr_text_addf(line, "%" PRIu64 " %c ", sequence, kind);
    add_escaped(line, payload, false);
    end_body(line, body);
}

/* "17 c ": returns the offset after it, 0 if the text does not match. */
static size_t parse_sequence(const char *text, size_t length, uint64_t *sequence)
{
    size_t at = 0;
    uint64_t number = 0;
    while (at < length && at < 18 && text[at] >= '0' && text[at] <= '9')
        number = number * 10 + (uint64_t)(text[at++] - '0');
    if (at == 0 || text[0] == '0' || length < at + 3 || text[at] != ' ' || text[at + 2] != ' ')
        return 0;
    *sequence = number;
    return at + 3;
}

bool wr_journal_parse_line(char *line, size_t length, WrJournalSeal *seal, uint64_t *sequence,
                           char *kind, char **payload, size_t *payload_length, WrError *err)
{
    uint64_t number;
    size_t body = HASH_DIGITS + 1;
    if (!check_body(line, length, seal))
        return wr_fail(err, "its checksum is wrong: the line is damaged");
    size_t skip = parse_sequence(line + body, length - body, &number);
    if (!skip) return wr_fail(err, "a line without its number");
    skip += body; /* "17 c " */
    if (!strchr("cdbsengv", line[skip - 2]) || !line[skip - 2])
        return wr_fail(err, "a line of an unknown kind");
    if (memchr(line + skip, '\0', length - skip) || !escapes_are_good(line + skip, length - skip))
        return wr_fail(err, "an invalid line");
    *sequence = number;
    *kind = line[skip - 2];
    *payload = line + skip;
    *payload_length = unescape(line + skip, length - skip);
    return true;
}
