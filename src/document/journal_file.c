/* Journal files: the folder with its locks, and the encoding of lines. */
#include "document/journal_file.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "system/fd.h"
#include "system/path.h"

#include <errno.h>
#include <inttypes.h>
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
    return wr_file_open_no_link(path, WR_FILE_MAX, NULL, err);
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

/* ---- lines ---- */

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

static bool parse_hex(const char *text, int digits, uint64_t *value)
{
    uint64_t v = 0;
    for (int i = 0; i < digits; i++) {
        char c = text[i];
        if (c >= '0' && c <= '9') v = v << 4 | (uint64_t)(c - '0');
        else if (c >= 'a' && c <= 'f') v = v << 4 | (uint64_t)(c - 'a' + 10);
        else return false;
    }
    *value = v;
    return true;
}

bool wr_journal_parse_hash(const char *text, WrHash *hash)
{
    WrHash h;
    if (memchr(text, '\0', HASH_DIGITS + 1) != text + HASH_DIGITS) return false;
    if (!parse_hex(text, 16, &h.high) || !parse_hex(text + 16, 16, &h.low)) return false;
    *hash = h;
    return true;
}

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
    if (!wr_journal_parse_hash(digits, &written)) return false;
    seal->chain = written;
    return (seal->format != 1 && body_has(text, length, seed, &written)) ||
           (seal->format != 2 && body_has(text, length, before, &written));
}

/* ---- header ---- */

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
    if (!wr_journal_parse_hash(words[3], &h.start.hash)) return false;
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
        return wr_fail(err, "the journal's first line makes no sense");
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
        return wr_fail(err, "its checksum does not fit: the line is damaged");
    size_t skip = parse_sequence(line + body, length - body, &number);
    if (!skip) return wr_fail(err, "a line without its number");
    skip += body; /* "17 c " */
    if (!strchr("cdbsengv", line[skip - 2]) || !line[skip - 2])
        return wr_fail(err, "a line of an unknown kind");
    if (memchr(line + skip, '\0', length - skip) || !escapes_are_good(line + skip, length - skip))
        return wr_fail(err, "a line that makes no sense");
    *sequence = number;
    *kind = line[skip - 2];
    *payload = line + skip;
    *payload_length = unescape(line + skip, length - skip);
    return true;
}
