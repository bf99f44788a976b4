/* Session files: scripts, documents, pictures. */
#include "command/session_internal.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "document/document.h"
#include "document/document_file.h"
#include "document/ora.h"
#include "system/fd.h"
#include "system/path.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#define LINE_MAX_BYTES (64 << 20) /* a stroke of a million samples is some 20 MB */

/* ---- scripts ---- */

typedef enum LineResult { LINE_READ, LINE_END, LINE_FAILED } LineResult;

typedef struct Lines {
    FILE *stream;
    uint64_t left; /* remaining bytes, if known */
} Lines;

static int next_byte(Lines *lines)
{
    return lines->left > 0 ? lines->left--, wr_stream_byte(lines->stream) : EOF;
}

/* The next line without its end (LF or CR LF). */
static LineResult read_line(Lines *lines, WrText *line, WrError *err)
{
    int c, count = 0;
    wr_text_clear(line);
    while ((c = next_byte(lines)) != EOF && c != '\n') {
        char byte = (char)c;
        if (byte == '\0') {
            wr_fail(err, "a NUL byte: this is no text file");
            return LINE_FAILED;
        }
        if (++count > LINE_MAX_BYTES) {
            wr_fail(err, "a line of more than %d MB", LINE_MAX_BYTES >> 20);
            return LINE_FAILED;
        }
        wr_text_add_n(line, &byte, 1);
    }
    if (ferror(lines->stream)) {
        wr_fail(err, "%s", strerror(errno));
        return LINE_FAILED;
    }
    if (c == EOF && count == 0) return LINE_END;
    if (line->length > 0 && line->data[line->length - 1] == '\r') line->data[--line->length] = '\0';
    return LINE_READ;
}

/* Run a line; its share of the progress is its share of the file's bytes. */
static bool run_line(WrSession *session, const char *text, double *place, double size, WrError *err)
{
    WrProgressPart part;
    double from = *place;
    *place += (double)strlen(text) + 1.0;
    double end = size > *place ? size : *place;
    const WrProgress *whole = wr_progress_enter(&part, from / end, *place / end);
    if (size == 0.0) part.progress.report = NULL; /* the total length is unknown */
    bool good =
        wr_progress_stopped() ? wr_fail(err, "cancelled") : wr_session_run(session, text, err);
    wr_progress_set(whole);
    return good;
}

static bool run_lines(WrSession *session, Lines lines, const char *name, WrError *err)
{
    WrText line = { 0 };
    double place = 0.0, size = lines.left < UINT64_MAX ? (double)lines.left : 0.0;
    bool good = true;
    for (int64_t number = 1;; number++) {
        LineResult result = read_line(&lines, &line, err);
        if (result == LINE_END) break;
        const char *text = wr_text_get(&line);
        if (number == 1 && strncmp(text, "\xEF\xBB\xBF", 3) == 0) text += 3; /* byte order mark */
        good = result == LINE_READ && run_line(session, text, &place, size, err);
        if (good) wr_session_journal_tend(session);
        if (!good) {
            wr_error_prefix(err, "%s:%lld: ", name, (long long)number);
            break;
        }
    }
    wr_text_fini(&line);
    return good;
}

bool wr_session_run_stream(WrSession *session, FILE *stream, const char *name, WrError *err)
{
    return run_lines(session, (Lines){ stream, UINT64_MAX }, name, err);
}

bool wr_session_run_script(WrSession *session, const char *path, WrError *err)
{
    Lines lines;
    int fd = wr_file_open(path, WR_FILE_MOST, &lines.left, err);
    if (fd < 0) return false;
    lines.stream = wr_fd_stream(fd, "r");
    if (!lines.stream) {
        wr_fd_close(fd);
        return wr_fail(err, "%s: %s", path, strerror(errno));
    }
    char *outer = session->folder;
    session->folder = wr_path_folder(path);
    bool good = run_lines(session, lines, path, err);
    wr_free(session->folder);
    session->folder = outer;
    fclose(lines.stream);
    return good;
}

/* ---- opening ---- */

/* Run a document's scene lines. Only scene commands are allowed: a document opens no files. lenient: failing lines
   are skipped with a note. */
static bool run_scene_lines(WrSession *session, const char *text, bool lenient, WrError *err)
{
    for (const char *p = text; *p;) {
        size_t length = strcspn(p, "\n");
        char *line = wr_strndup(p, length);
        WrCall *call = NULL;
        bool good = wr_call_parse(line, false, &call, err);
        if (good && call->command && !call->command->print)
            good = wr_fail(err, "%s is no command of a scene", call->command->name);
        if (good) good = wr_session_run(session, line, err);
        wr_call_free(call);
        wr_free(line);
        if (!good && !lenient) return false;
        if (!good) wr_session_note(session, "left out: %s", err ? wr_error_message(err) : "a line");
        p += length + (p[length] == '\n');
    }
    return true;
}

/* Note a file of a newer version: unknown parts were skipped, so the file must not be overwritten. */
static void note_newer(WrSession *session, const char *path, double version)
{
    wr_session_note(
        session,
        "%s: was saved by a newer version of the program (document version %g; this one "
        "knows up to %d): opened without what it does not understand; saving over it is "
        "refused",
        path, version, WR_DOCUMENT_VERSION);
    wr_free(session->state.newer_path);
    session->state.newer_path = wr_strdup(path);
}

/* Load an OpenRaster file; its notes list the losses line by line. */
static bool load_ora(WrSession *session, const char *path, WrLoaded *loaded, int64_t *replaced,
                     WrError *err)
{
    WrText notes = { 0 };
    bool good = wr_ora_load(path, loaded, replaced, &notes, err);
    for (const char *p = wr_text_get(&notes); good && *p;) {
        size_t length = strcspn(p, "\n");
        wr_session_note(session, "%s: %.*s", path, (int)length, p);
        p += length + (p[length] == '\n');
    }
    wr_text_fini(&notes);
    return good;
}

bool wr_session_load(WrSession *session, const char *path, WrError *err)
{
    WrLoaded loaded = { 0 };
    int64_t replaced = 0;
    if (!(wr_ora_recognise(path) ? load_ora(session, path, &loaded, &replaced, err)
                                 : wr_document_load(path, &loaded, &replaced, err)))
        return false;
    wr_document_free(session->state.document);
    session->state.document = loaded.document;
    session->loading = true;
    session->embedded = loaded.pictures;
    session->embedded_mesh = loaded.mesh;
    session->depth++;
    bool newer = loaded.newer_version > 0;
    bool good = run_scene_lines(session, loaded.scene_text ? loaded.scene_text : "", newer, err);
    session->depth--;
    if (!good) wr_error_prefix(err, "%s: ", path);
    session->loading = false;
    good = good && wr_session_follow(session, err);
    session->embedded = NULL;
    session->embedded_mesh = NULL;
    wr_loaded_free_images(&loaded);
    wr_free(loaded.scene_text);
    if (good && replaced)
        wr_session_note(session, "%s: %lld texels were not finite and became 0", path,
                        (long long)replaced);
    if (good && newer) note_newer(session, path, loaded.newer_version);
    return good;
}

bool wr_session_reads_back(WrSession *session, const char *path, WrError *err)
{
    WrSessionOptions options = { .pool = session->options.pool };
    WrSession *other = wr_session_new(&options);
    bool good = wr_session_load(other, path, err) &&
                (wr_hash_equal(wr_session_hash(other), wr_session_hash(session)) ||
                 wr_fail(err, "%s: reads back as something else than was written", path));
    wr_session_free(other);
    return good;
}

/* Store the command that opens the document again, for a script of the history. */
static bool note_origin(WrSession *session, const char *path, WrError *err)
{
    char hex[65], *full = wr_path_real(path);
    bool good = wr_sha256_file(path, hex, err);
    WrText line = { 0 };
    wr_text_add(&line, "open ");
    wr_text_add_word(&line, full ? full : path);
    wr_text_addf(&line, " sha256=%s", good ? hex : "");
    if (good) session->state.origin = wr_strdup(wr_text_get(&line));
    wr_text_fini(&line);
    free(full);
    return good;
}

static bool open_document(WrSession *session, const char *path, WrError *err)
{
    WrFileIdentity stamp = wr_file_identity(path); /* taken before the file is read */
    if (!note_origin(session, path, err) || !wr_session_load(session, path, err)) return false;
    wr_session_rebase(session);
    session->state.path = wr_strdup(path);
    session->state.stamp = stamp;
    return true;
}

static bool open_script(WrSession *session, const char *path, WrError *err)
{
    bool outer = session->skip_outputs;
    session->skip_outputs = true;
    bool good = wr_session_run_script(session, path, err);
    session->skip_outputs = outer;
    return good;
}

static bool open_picture(WrSession *session, const char *path, WrError *err)
{
    WrText line = { 0 };
    wr_text_add(&line, "image ");
    wr_text_add_word(&line, path);
    session->nameless = true; /* the user gave no command */
    bool good = wr_session_run(session, wr_text_get(&line), err);
    session->nameless = false;
    wr_text_fini(&line);
    return good;
}

/* Check that the file is readable, and whether it starts like an OpenEXR file; scripts and mistyped names then never
   load the picture library. */
static bool look_at_file(const char *path, bool *exr, WrError *err)
{
    static const char magic[4] = { 0x76, 0x2f, 0x31, 0x01 };
    char start[4];
    int fd = wr_file_open(path, WR_FILE_MOST, NULL, err);
    if (fd < 0) return false;
    wr_fd_close(fd);
    *exr = wr_file_peek(path, start, sizeof start) == sizeof start &&
           memcmp(start, magic, sizeof magic) == 0;
    return true;
}

/* Remove temporary files that a killed program left beside the file. */
static void sweep_beside(const char *path)
{
    char *folder = wr_path_folder(path);
    wr_file_sweep(folder);
    wr_free(folder);
}

bool wr_session_open(WrSession *session, const char *path, WrError *err)
{
    char buffer[16];
    bool exr = false, good, script = strcmp(wr_path_ending(path, buffer), "wrinkle") == 0;
    if (!wr_session_refuse_in_stroke(session, err)) return false;
    if (!script && !look_at_file(path, &exr, err)) return false;
    sweep_beside(path);
    WrSessionState old = wr_session_begin_state(session, wr_session_new_document(session));
    session->opening = true;
    if (script) good = open_script(session, path, err);
    else if ((exr && wr_document_recognise(path)) || wr_ora_recognise(path))
        good = open_document(session, path, err);
    else good = open_picture(session, path, err);
    session->opening = false;
    if (good && wr_progress_stopped()) good = wr_fail(err, "%s: cancelled", path);
    if (good) wr_session_journal_drop(session);
    if (good) wr_session_keep_state(session, &old);
    else wr_session_restore_state(session, &old);
    return good;
}
