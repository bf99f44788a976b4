/* Files of a session: pictures that commands read, scripts and documents, and the journal. */
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "base/udim.h"
#include "command/session_internal.h"
#include "document/document.h"
#include "document/document_file.h"
#include "document/ora.h"
#include "image/gltf.h"
#include "image/image.h"
#include "image/mesh.h"
#include "image/svg.h"
#include "scene/scene.h"
#include "surface/triangles.h"
#include "system/fd.h"
#include "system/path.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Reading of pictures for commands: checksum, part, note ---- */

/* ---- checksums and pictures ---- */

/* Bytes of a picture in a glTF file. */
static bool picture_bytes(const char *name, size_t length, int image, char **bytes, size_t *size,
                          WrError *err)
{
    char *path = wr_strdup(name);
    path[length] = 0;
    const bool good = wr_gltf_picture(path, image, bytes, size, err);
    wr_free(path);
    return good;
}

WrImage *wr_input_image(const char *path, const WrImageRequest *wish, WrError *err)
{
    size_t length, size;
    int index;
    char *bytes;
    WrText name = { 0 };
    if (!wr_gltf_names_picture(path, &length, &index))
        return wr_image_read_request(path, wish, err);
    if (wish->channel || wish->part) {
        wr_fail(err,
                "%s: channel= and part= are for picture files, not for pictures in a glTF file",
                path);
        return NULL;
    }
    if (!picture_bytes(path, length, index, &bytes, &size, err)) return NULL;
    /* glTF allows only PNG and JPEG; the extension selects the decoder */
    const bool png = size > 4 && memcmp(bytes, "\x89PNG", 4) == 0;
    const bool jpeg = size > 2 && memcmp(bytes, "\xff\xd8", 2) == 0;
    WrImage *image = NULL;
    wr_text_addf(&name, "%s.%s", path, png ? "png" : "jpg");
    if (png || jpeg) image = wr_image_read_bytes(wr_text_get(&name), bytes, size, err);
    else wr_fail(err, "%s: is neither PNG nor JPEG", path);
    wr_text_fini(&name);
    wr_free(bytes);
    return image;
}

/* The checksum of a picture inside a glTF file covers the picture's bytes, that of a packed glTF the file with all its
   buffers: only so does a change of a .bin beside the .gltf change the checksum. */
bool wr_input_sha256(const char *path, char hex[65], WrError *err)
{
    WrText text = { 0 };
    size_t length, size;
    int image;
    char *bytes;
    if (wr_gltf_names_picture(path, &length, &image)) {
        if (!picture_bytes(path, length, image, &bytes, &size, err)) return false;
        wr_sha256_bytes(bytes, size, hex);
        wr_free(bytes);
        return true;
    }
    bool packed, good = wr_gltf_pack(path, &text, &packed, err);
    if (good && packed) wr_sha256_bytes(text.data, text.length, hex);
    else if (good) good = wr_sha256_file(path, hex, err);
    wr_text_fini(&text);
    return good;
}

bool wr_session_check_sha256(WrCall *call, const char *path, WrError *err)
{
    char hex[65];
    return wr_input_sha256(path, hex, err) && wr_call_check_sha256(call, "sha256", path, hex, err);
}

bool wr_call_check_sha256(WrCall *call, const char *name, const char *path, const char *hex,
                          WrError *err)
{
    const WrArg *arg = wr_call_arg(call, name);
    if (arg->given && strcmp(arg->text, hex) != 0)
        return wr_fail(err, "%s: file has changed: its SHA-256 is %s, not the one in the command",
                       path, hex);
    if (!arg->given) wr_call_set_text(call, name, hex);
    return true;
}

WrImageRequest wr_call_request(WrCall *call)
{
    return (WrImageRequest){ .channel = wr_call_arg(call, "layer")->text,
                             .part = wr_call_arg(call, "part")->text };
}

void wr_session_note_read(WrSession *session, const char *path, const WrImage *image)
{
    if (image->taken[0])
        wr_session_note(session, "%s: used %s (channel= and part= choose others)", path,
                        image->taken);
    if (image->note[0]) wr_session_note(session, "%s: %s", path, image->note);
    if (image->filled)
        wr_session_note(session, "%s: %lld missing values filled from their neighbours", path,
                        (long long)image->filled);
    if (image->replaced)
        wr_session_note(session, "%s: %lld values were not finite and became 0", path,
                        (long long)image->replaced);
}

/* ---- tiles in file names ---- */

static int object_tile(const WrSession *session)
{
    return session->state.document->scene->projection.udim;
}

char *wr_session_output_name(const WrSession *session, const char *path, WrError *err)
{
    const int tile = object_tile(session);
    if (tile || !wr_udim_is_pattern(path)) return wr_udim_fill(path, tile);
    wr_fail(
        err,
        "%s: the object has no tile: choose one by `surface mesh udim=1002`, or give its number",
        path);
    return NULL;
}

/* The tile of a pattern: the object's, else the first. 0 and an error: it has no file. numbers: of all files. */
static int choose_tile(const WrSession *session, const char *name, const int *numbers, int count,
                       WrError *err)
{
    const int tile = object_tile(session);
    for (int i = 0; i < count; i++)
        if (numbers[i] == tile || tile == 0) return numbers[i];
    WrText list = { 0 };
    wr_udim_list(numbers, count, &list);
    if (count == 0) wr_fail(err, "%s: no file has such a name with a tile number, from 1001", name);
    else
        wr_fail(err, "%s: no file of the object's tile %d; there are %s", name, tile,
                wr_text_get(&list));
    wr_text_fini(&list);
    return 0;
}

static void note_others(WrSession *session, const char *name, int tile, int *numbers, int count)
{
    int others = 0;
    for (int i = 0; i < count; i++)
        if (numbers[i] != tile) numbers[others++] = numbers[i];
    if (others == 0) return;
    WrText list = { 0 };
    wr_udim_list(numbers, others, &list);
    wr_session_note(session, "%s: tile %d; there are also %s", name, tile, wr_text_get(&list));
    wr_text_fini(&list);
}

/* The tile of argument i. numbers: [WR_UDIM_COUNT], as space. */
static bool take_tile(WrSession *session, WrCall *call, int i, int *numbers, WrError *err)
{
    const char *name = call->args[i].text;
    char *path = wr_path_join(session->folder, name);
    int tile;
    const int count = wr_udim_files(path, &tile, numbers, WR_UDIM_COUNT);
    wr_free(path);
    if (wr_udim_is_pattern(name)) {
        tile = choose_tile(session, name, numbers, count, err);
        if (!tile) return false;
        char *filled = wr_udim_fill(name, tile);
        wr_call_set_text(call, call->specs[i].name, filled);
        wr_free(filled);
        name = call->args[i].text;
    }
    note_others(session, name, tile, numbers, count);
    return true;
}

bool wr_session_take_tiles(WrSession *session, WrCall *call, WrError *err)
{
    bool good = true;
    int *numbers = NULL;
    if (session->loading || !call->command || wr_call_class(call) == WR_CLASS_OUTPUT) return true;
    for (int i = 0; i < call->count && good; i++) {
        if (call->specs[i].type != WR_ARG_PATH || !wr_call_names_file(call, i)) continue;
        if (!numbers) numbers = wr_alloc(WR_UDIM_COUNT, sizeof *numbers);
        good = take_tile(session, call, i, numbers, err);
    }
    wr_free(numbers);
    return good;
}

/* ---- Session files: scripts, documents, pictures ---- */

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

/* The next line without its end (LF or CR LF). NUL bytes are rejected because all later code treats lines as C strings: the
   part after a NUL would be skipped silently. */
static LineResult read_line(Lines *lines, WrText *line, WrError *err)
{
    int c, count = 0;
    wr_text_clear(line);
    while ((c = next_byte(lines)) != EOF && c != '\n') {
        char byte = (char)c;
        if (byte == '\0') {
            wr_fail(err, "contains a NUL byte: not a text file");
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
        if (good) wr_session_journal_compact(session);
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
    int fd = wr_file_open(path, WR_FILE_MAX, &lines.left, err);
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
            good = wr_fail(err, "%s is not a command of a scene", call->command->name);
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
        "%s: was saved by a newer version of the program (document version %g; this one reads up "
        "to %d): opened without its unknown parts; saving over it is refused",
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
    if (good) wr_session_note_lines(session);
    if (good && newer) note_newer(session, path, loaded.newer_version);
    return good;
}

bool wr_session_reads_back(WrSession *session, const char *path, WrError *err)
{
    WrSessionOptions options = { .pool = session->options.pool };
    WrSession *other = wr_session_new(&options);
    bool good = wr_session_load(other, path, err) &&
                (wr_hash_equal(wr_session_hash(other), wr_session_hash(session)) ||
                 wr_fail(err, "%s: differs from what was written when read back", path));
    wr_session_free(other);
    return good;
}

/* Store the command that opens the document again, for a script of the history. */
static void note_origin(WrSessionState *state, const char *path)
{
    char *full = wr_path_real(path);
    WrText line = { 0 };
    wr_text_add(&line, "open ");
    wr_text_add_word(&line, full ? full : path);
    wr_text_addf(&line, " sha256=%s", state->origin_sha256);
    state->origin = wr_strdup(wr_text_get(&line));
    wr_text_fini(&line);
    free(full);
}

static bool open_document(WrSession *session, const char *path, WrError *err)
{
    WrSessionState *state = &session->state;
    const WrFileIdentity stamp = wr_file_identity(path); /* taken before the file is read */
    WrSha256Work *hash = wr_sha256_begin(path);
    const bool loaded = wr_session_load(session, path, err);
    if (!wr_sha256_end(hash, state->origin_sha256, loaded ? err : NULL) || !loaded) return false;
    note_origin(state, path);
    wr_session_restart_history(session);
    state->path = wr_strdup(path);
    state->stamp = state->origin_file = stamp;
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

/* verb: of the command that reads it, with a space or "=" at the end. */
static bool open_picture(WrSession *session, const char *verb, const char *path, WrError *err)
{
    WrText line = { 0 };
    wr_text_add(&line, verb);
    wr_text_add_word(&line, path);
    session->nameless = true; /* the user gave no command */
    bool good = wr_session_run(session, wr_text_get(&line), err);
    session->nameless = false;
    wr_text_fini(&line);
    return good;
}

/* A mesh without texture coordinates is projected, else painting would have no place on it: the table is as wide as its
   bounding sphere's radius. */
static bool open_mesh(WrSession *session, const char *path, WrError *err)
{
    if (!open_picture(session, "surface mesh file=", path, err)) return false;
    const WrTriangles *mesh = wr_scene_mesh_source(session->state.document->scene);
    if (mesh->mapped) return true;
    WrText line = { 0 }, cell = { 0 };
    wr_text_add_number(&cell, (double)(float)mesh->radius);
    wr_text_addf(&line, "surface mesh projection=box cell=%s,%s", wr_text_get(&cell),
                 wr_text_get(&cell));
    const bool good = wr_session_run(session, wr_text_get(&line), err);
    wr_text_fini(&line);
    wr_text_fini(&cell);
    return good;
}

/* Check that the file is readable, and whether it starts like an OpenEXR file; scripts and mistyped names then never
   load the picture library. */
static bool look_at_file(const char *path, bool *exr, WrError *err)
{
    static const char magic[4] = { 0x76, 0x2f, 0x31, 0x01 };
    char start[4];
    int fd = wr_file_open(path, WR_FILE_MAX, NULL, err);
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
    else if (wr_mesh_named(path)) good = open_mesh(session, path, err);
    else if ((exr && wr_document_recognise(path)) || wr_ora_recognise(path))
        good = open_document(session, path, err);
    else good = open_picture(session, wr_svg_named(path) ? "open " : "image ", path, err);
    session->opening = false;
    if (good && wr_progress_stopped()) good = wr_fail(err, "%s: cancelled", path);
    if (good) wr_session_journal_drop(session);
    if (good) wr_session_keep_state(session, &old);
    else wr_session_restore_state(session, &old);
    return good;
}

/* ---- The journal of a session: each command is on disk before it runs ---- */

static void report(void *ctx, const char *text)
{
    wr_session_note(ctx, "%s", text);
}

/* ---- copies of files ---- */

static void forget_kept(WrSession *session)
{
    for (int i = 0; i < session->kept.count; i++) wr_free(session->kept.data[i]);
    wr_array_free(&session->kept);
}

/* A glTF is copied as one packed file, since other files may have parts of the same names. */
static bool keep_content(WrSession *session, const char *path, const char *sha256)
{
    WrText text = { 0 };
    bool packed, kept = wr_gltf_pack(path, &text, &packed, NULL);
    if (kept)
        kept = packed ? wr_journal_keep_bytes(session->journal, path, text.data, text.length,
                                              sha256, NULL)
                      : wr_journal_keep_file(session->journal, path, sha256, NULL);
    wr_text_fini(&text);
    return kept;
}

/* Look for the copy only once, since strokes name the same brush many times. */
static void keep(WrSession *session, const char *path, const char *sha256)
{
    for (int i = 0; i < session->kept.count; i++)
        if (strcmp(session->kept.data[i], sha256) == 0) return;
    if (keep_content(session, path, sha256)) wr_array_push(&session->kept, wr_strdup(sha256));
}

/* Copy the tip as well: a preset refers to a tip by name in its own folder. */
static void keep_tip_beside(WrSession *session, const char *path)
{
    for (int i = 0; i < session->kept.count; i++)
        if (strcmp(session->kept.data[i], path) == 0) return;
    if (wr_journal_keep_named(session->journal, path, NULL))
        wr_array_push(&session->kept, wr_strdup(path));
}

/* The file that argument `index` names, and its checksum. False if it is unreadable, or the argument names none. */
static bool file_of(WrSession *session, const WrCall *call, int index, const char *folder,
                    WrText *path, char hex[65])
{
    const char *word = call->args[index].text;
    WrBrushFile file;
    if (call->specs[index].type == WR_ARG_PRESET) {
        if (!wr_session_load_preset(session, word, folder, &file, NULL)) return false;
        wr_text_add(path, file.path);
        memcpy(hex, file.sha256, 65);
        if (file.tip_path) keep_tip_beside(session, file.tip_path);
        return true;
    }
    if (strcmp(call->specs[index].name, "tip") == 0 &&
        wr_session_tip_file(session, word, folder, &file, NULL)) {
        wr_text_add(path, file.path);
        memcpy(hex, file.sha256, 65);
        return true;
    }
    char *seen = wr_path_join(folder ? folder : ".", word), *full = wr_path_real(seen);
    bool good = full && wr_input_sha256(full, hex, NULL);
    if (good) wr_text_add(path, full);
    free(full);
    wr_free(seen);
    return good;
}

/* Replace file names in a line by absolute paths and checksums, and keep copies of the files. A replay then depends
   neither on the folder nor on later changes of the files. */
typedef struct Naming {
    WrSession *session;
    const char *folder;
} Naming;

static void name_files(WrCall *call, void *ctx)
{
    const Naming *naming = ctx;
    WrSession *session = naming->session;
    for (int i = 0; i < call->count; i++) {
        const char *hash_name = wr_call_hash_argument(call, i);
        WrText path = { 0 };
        char hex[65];
        const bool word = call->specs[i].type == WR_ARG_PATH && !wr_call_names_file(call, i);
        if (hash_name && call->args[i].given && !word &&
            file_of(session, call, i, naming->folder, &path, hex)) {
            if (!wr_call_given(call, hash_name)) wr_call_set_text(call, hash_name, hex);
            wr_call_set_text(call, call->specs[i].name, wr_text_get(&path));
            keep(session, wr_text_get(&path), wr_call_arg(call, hash_name)->text);
        }
        wr_text_fini(&path);
    }
}

/* Form of a line in the journal. */
static void journal_line(WrSession *session, const char *line, const char *folder, WrText *text)
{
    WrCall *call = NULL;
    if (!wr_call_parse(line, true, &call, NULL)) { /* the head of a stroke has no points yet */
        wr_text_add(text, line);
        return;
    }
    Naming naming = { session, folder };
    wr_call_visit(call, name_files, &naming);
    wr_call_print(call, text);
    wr_call_free(call);
}

/* Add a line that leads to the journal's start. */
static void put_line(void *ctx, const char *line, const char *folder)
{
    WrSession *session = ctx;
    WrText text = { 0 };
    journal_line(session, line, folder, &text);
    wr_journal_command(session->journal, wr_text_get(&text), NULL);
    wr_journal_done(session->journal, WR_JOURNAL_OK, NULL, NULL);
    wr_text_fini(&text);
}

static WrHash hash_at_start(const WrSession *session)
{
    WrScene *scene = wr_session_scene_at_start(session);
    WrHash hash = wr_session_hash_with(session, scene);
    wr_scene_free(scene);
    return hash;
}

static bool restart(WrSession *session, bool checked, WrError *err);

/* True if nothing was done since the document was saved or opened. */
static bool is_saved(const WrSession *session)
{
    return session->state.path && wr_session_revision(session) == session->state.saved_revision;
}

void wr_session_journal_saved(WrSession *session)
{
    if (!session->journal) return;
    WrHash hash = wr_session_hash(session);
    wr_journal_saved(session->journal, session->state.path, &hash, NULL);
}

/* Record the history before the journal: lines of an opened script or picture, --do, and views. */
static void add_history(WrSession *session)
{
    wr_session_lines(session, put_line, session);
    if (wr_history_position(session->state.history) > 0 && is_saved(session))
        wr_session_journal_saved(session);
}

/* True if the document's file is the one that was opened, unchanged. */
static bool is_as_opened(const WrSessionState *state)
{
    if (!state->origin || !state->path) return false;
    const WrFileIdentity now = wr_file_identity(state->path);
    return now.there && wr_file_identity_same(&now, &state->origin_file);
}

/* Record the state before the first command as the journal's start. The document's file counts only if it is
   unchanged since it was opened. */
static void begin(WrSession *session)
{
    const WrSessionState *state = &session->state;
    WrJournalOptions options = { .report = report, .ctx = session };
    WrJournalStart start = { .kind = WR_JOURNAL_EMPTY };
    bool opened = is_as_opened(state);
    if (opened)
        start = (WrJournalStart){ .kind = WR_JOURNAL_DOCUMENT,
                                  .path = state->path,
                                  .sha256 = state->origin_sha256 };
    if (wr_history_position(state->history) == 0) start.hash = hash_at_start(session);
    if (wr_progress_stopped())
        return; /* the hash is incomplete: the next command begins the
                                          journal */
    session->journal = wr_journal_begin(&options, &start);
    forget_kept(session);
    if (opened) keep(session, state->path, state->origin_sha256);
    opened = opened && wr_journal_state(session->journal).safe; /* its content may be another */
    session->journal_base = 0;
    session->journal_top = wr_history_position(state->history);
    session->view_base = session->view_top = wr_views_number(state->views);
    WrError why = { "" };
    if (opened || !state->origin) add_history(session);
    else if (!restart(session, false, &why)) {
        if (wr_progress_stopped())
            wr_session_journal_drop(session); /* the next command begins a new one */
        else wr_journal_break(session->journal, why.text);
    }
}

static bool journaled(const WrSession *session)
{
    return session->options.journal && session->depth == 0 && !session->opening &&
           !session->loading;
}

void wr_session_journal_before(WrSession *session, const WrCall *call)
{
    if (!journaled(session)) return;
    bool view = wr_call_of_views(call);
    if (!session->journal && view) return;
    if (!session->journal) begin(session);
    if (!session->journal || call->command->after_journal) return;
    WrText canonical = { 0 }, text = { 0 };
    wr_call_print(call, &canonical);
    journal_line(session, wr_text_get(&canonical), session->folder, &text);
    wr_journal_command(session->journal, wr_text_get(&text), NULL);
    wr_text_fini(&canonical);
    wr_text_fini(&text);
}

/* A replay has the steps and views since the journal's start. An undo, a redo or a view beyond them cannot be
   replayed, so the journal then restarts at the resulting state. */
static void follow(WrSession *session, bool pushed)
{
    int position = wr_session_history_position(session);
    if (pushed) session->journal_top = position;
    int64_t view = wr_views_number(session->state.views);
    bool known = position >= session->journal_base && position <= session->journal_top;
    bool seen = view >= session->view_base && view <= session->view_top;
    if (!known || !seen) restart(session, false, NULL);
}

void wr_session_journal_cut(WrSession *session)
{
    session->journal_base = INT_MAX;
}

void wr_session_journal_after(WrSession *session, const WrCall *call, bool good, bool pushed)
{
    if (!journaled(session) || !session->journal) return;
    if (!call->command->after_journal)
        wr_journal_done(session->journal, good ? WR_JOURNAL_OK : WR_JOURNAL_DROPPED, NULL, NULL);
    else if (good) wr_session_journal_cut(session);
    if (good) follow(session, pushed);
}

/* ---- strokes ---- */

void wr_session_journal_stroke_begin(WrSession *session, const WrCall *call)
{
    if (!journaled(session)) return;
    if (!session->journal) begin(session);
    WrText canonical = { 0 }, head = { 0 };
    wr_call_print(call, &canonical);
    journal_line(session, wr_text_get(&canonical), session->folder, &head);
    wr_text_add(&head, " points=");
    wr_journal_stroke_begin(session->journal, wr_text_get(&head), NULL);
    wr_text_fini(&canonical);
    wr_text_fini(&head);
}

void wr_session_journal_stroke_add(WrSession *session, const double *row, int length)
{
    if (!journaled(session) || !session->journal) return;
    WrText text = { 0 };
    for (int k = 0; k < length; k++) {
        if (k > 0) wr_text_add(&text, ",");
        wr_text_add_number(&text, row[k]);
    }
    wr_journal_stroke_add(session->journal, wr_text_get(&text), NULL);
    wr_text_fini(&text);
}

void wr_session_journal_stroke_end(WrSession *session, bool kept)
{
    if (!journaled(session) || !session->journal) return;
    if (kept) wr_journal_stroke_end(session->journal, NULL);
    wr_journal_done(session->journal, kept ? WR_JOURNAL_OK : WR_JOURNAL_DROPPED, NULL, NULL);
    if (!kept) return;
    wr_journal_sync(session->journal, NULL);
    follow(session, true);
}

/* ---- between commands ---- */

void wr_session_set_journal(WrSession *session, bool journal)
{
    session->options.journal = journal;
}

void wr_session_journal_leave(WrSession *session)
{
    wr_journal_leave(session->journal);
    session->journal = NULL;
    forget_kept(session);
}

void wr_session_journal_drop(WrSession *session)
{
    wr_journal_finish(session->journal);
    session->journal = NULL;
    forget_kept(session);
}

/* Restart the journal at the current document. checked: from a snapshot that is read back. */
static bool restart(WrSession *session, bool checked, WrError *err)
{
    WrText path = { 0 }, scene = { 0 };
    wr_session_kept_text(session, &scene);
    WrJournalStart start = { .kind = WR_JOURNAL_SNAPSHOT,
                             .hash = wr_session_hash(session),
                             .path = session->state.path };
    bool good = wr_journal_snapshot_path(session->journal, &path, err) &&
                wr_document_save(session->state.document, wr_text_get(&scene), wr_text_get(&path),
                                 session->options.pool, err);
    if (good && wr_progress_stopped())
        good = wr_fail(err, "cancelled"); /* the hash may be incomplete too */
    start.snapshot = wr_text_get(&path);
    good = good && (!checked || wr_session_reads_back(session, start.snapshot, err));
    good = good && wr_journal_restart(session->journal, &start, err);
    if (good) forget_kept(session);
    if (good) session->journal_base = session->journal_top = wr_session_history_position(session);
    if (good) session->view_base = session->view_top = wr_views_number(session->state.views);
    else wr_journal_put_off(session->journal);
    if (good && is_saved(session)) wr_session_journal_saved(session);
    wr_text_fini(&path);
    wr_text_fini(&scene);
    return good;
}

bool wr_session_journal_anew(WrSession *session, WrError *err)
{
    if (!session->options.journal) return true;
    if (!session->journal) {
        WrJournalOptions options = { .report = report, .ctx = session };
        WrJournalStart start = { .kind = WR_JOURNAL_EMPTY };
        session->journal = wr_journal_begin(&options, &start);
    }
    return restart(session, true, err);
}

bool wr_session_journal_needs_compacting(const WrSession *session)
{
    if (!session->journal || session->stroke) return false;
    WrJournalState state = wr_journal_state(session->journal);
    return !state.busy && state.want != WR_JOURNAL_WANT_NOTHING;
}

bool wr_session_journal_compact(WrSession *session)
{
    if (!wr_session_journal_needs_compacting(session)) return false;
    restart(session, false, NULL);
    return true;
}

bool wr_session_journal_safe(const WrSession *session, const char **reason)
{
    *reason = session->still ? session->unsafe_words : "";
    if (!session->journal) return !session->unsafe;
    WrJournalState state = wr_journal_state(session->journal);
    *reason = state.reason;
    return state.safe;
}
