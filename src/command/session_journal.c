/* The journal of a session: each command is on disk before it runs. */
#include "command/session_internal.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "document/document_file.h"
#include "image/gltf.h"
#include "scene/scene.h"
#include "system/path.h"

#include <stdlib.h>
#include <string.h>

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
        if (!wr_session_preset_file(session, word, folder, &file, NULL)) return false;
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
static void name_files(WrSession *session, WrCall *call, const char *folder)
{
    for (int i = 0; i < call->count; i++) {
        const char *hash_name = wr_call_hash_name(call, i);
        WrText path = { 0 };
        char hex[65];
        const bool word = call->specs[i].type == WR_ARG_PATH && !wr_call_names_file(call, i);
        if (hash_name && call->args[i].given && !word &&
            file_of(session, call, i, folder, &path, hex)) {
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
    name_files(session, call, folder);
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

/* Record the state before the first command as the journal's start. The document's file counts only if it is
   unchanged since it was opened. */
static void begin(WrSession *session)
{
    const WrSessionState *state = &session->state;
    WrJournalOptions options = { .report = report, .ctx = session };
    WrJournalStart start = { .kind = WR_JOURNAL_EMPTY };
    char hex[65] = "";
    bool opened = state->origin && state->path && wr_sha256_file(state->path, hex, NULL) &&
                  strstr(state->origin, hex);
    if (opened)
        start = (WrJournalStart){ .kind = WR_JOURNAL_DOCUMENT, .path = state->path, .sha256 = hex };
    if (wr_history_position(state->history) == 0) start.hash = hash_at_start(session);
    if (wr_progress_stopped())
        return; /* the hash is incomplete: the next command begins the
                                          journal */
    session->journal = wr_journal_begin(&options, &start);
    forget_kept(session);
    if (opened) keep(session, state->path, hex);
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
    if (!session->journal) return;
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

void wr_session_journal_after(WrSession *session, bool good, bool pushed)
{
    if (!journaled(session) || !session->journal) return;
    wr_journal_done(session->journal, good ? WR_JOURNAL_OK : WR_JOURNAL_DROPPED, NULL, NULL);
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

void wr_session_journal_stroke_add(WrSession *session, const double rows[][6], const int *lengths,
                                   int count)
{
    if (!journaled(session) || !session->journal || count == 0) return;
    WrText text = { 0 };
    for (int i = 0; i < count; i++) {
        if (i > 0) wr_text_add(&text, ";");
        for (int k = 0; k < lengths[i]; k++) {
            if (k > 0) wr_text_add(&text, ",");
            wr_text_add_number(&text, rows[i][k]);
        }
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
    bool good =
        wr_journal_snapshot_path(session->journal, &path, err) &&
        wr_document_save(session->state.document, wr_text_get(&scene), wr_text_get(&path), err);
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

bool wr_session_journal_wants(const WrSession *session)
{
    if (!session->journal || session->stroke) return false;
    WrJournalState state = wr_journal_state(session->journal);
    return !state.busy && state.want != WR_JOURNAL_WANT_NOTHING;
}

bool wr_session_journal_tend(WrSession *session)
{
    if (!wr_session_journal_wants(session)) return false;
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
