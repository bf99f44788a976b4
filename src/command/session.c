/* A session: runs command lines, and keeps the document, its steps and its views. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/message.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/commands.h"
#include "command/estimate.h"
#include "command/command_line.h"
#include "command/session_internal.h"
#include "command/variants.h"
#include "document/document.h"
#include "document/edit.h"
#include "document/history.h"
#include "document/layer_times.h"
#include "export/export.h"
#include "export/receipt.h"
#include "field/field.h"
#include "render/frame/frame.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "surface/mesh_texels.h"
#include "system/clock.h"
#include "system/path.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* ---- helpers for commands that change a document ---- */

/* ---- input files ---- */

/* Inputs are files that the session has read, with their identity at that time; the window watches them and offers to run the
   script again after a change. */
void wr_session_note_input(WrSession *session, const char *path)
{
    for (int i = 0; i < session->inputs.count; i++)
        if (strcmp(session->inputs.data[i].path, path) == 0) return;
    wr_array_push(&session->inputs, ((WrSessionInput){ wr_strdup(path), wr_file_identity(path) }));
}

static void session_forget_inputs(WrSession *session)
{
    for (int i = 0; i < session->inputs.count; i++) wr_free((char *)session->inputs.data[i].path);
    wr_array_free(&session->inputs);
}

bool wr_session_check_export(const WrSession *session, const WrExportKind *kind, const char *path,
                             WrError *err)
{
    const WrFileIdentity target = wr_file_identity(path);
    for (int i = 0; i < session->inputs.count && kind->ending && target.there; i++) {
        const WrFileIdentity file = wr_file_identity(session->inputs.data[i].path);
        if (file.there && file.device == target.device && file.inode == target.inode)
            return wr_fail(err, "%s: this file was read as an input: choose another name", path);
    }
    return true;
}

int wr_session_input_count(const WrSession *session)
{
    return session->inputs.count;
}

WrSessionInput wr_session_input(const WrSession *session, int index)
{
    return session->inputs.data[index];
}

char *wr_session_input_path(WrSession *session, const char *path)
{
    char *full = wr_path_join(session->folder, path);
    wr_session_note_input(session, full);
    return full;
}

void wr_session_replace_scene(WrSession *session, WrScene *scene)
{
    wr_scene_free(session->state.document->scene);
    session->state.document->scene = scene;
}

/* ---- layers ---- */

const char *wr_session_layer_name(const WrSession *session, int index, WrText *buffer)
{
    char excerpt[WR_EXCERPT_SIZE];
    wr_text_clear(buffer);
    wr_text_addf(buffer, "layer %d \"%s\"", index + 1,
                 wr_excerpt(session->state.document->layers[index].name, excerpt));
    return wr_text_get(buffer);
}

bool wr_session_check_unlocked(const WrSession *session, int index, WrError *err)
{
    const WrDocument *document = session->state.document;
    while (index >= 0 && !document->layers[index].locked)
        index = wr_document_parent(document, index);
    if (index < 0) return true; /* neither it nor a group that it is in */
    WrText name = { 0 };
    wr_fail(err, "%s is locked: `layer set %d lock=off` unlocks it",
            wr_session_layer_name(session, index, &name), index + 1);
    wr_text_fini(&name);
    return false;
}

/* True if an object uses the layer as its table; a hidden layer is then visible on it. */
static bool is_worn(const WrDocument *document, int index)
{
    const char *name = document->layers[index].name;
    if (document->solo >= 0) return false;
    if (wr_scene_uses_layer(document->scene, name)) return true;
    const int group = document->layers[index].visible ? wr_document_parent(document, index) : -1;
    return group >= 0 && is_worn(document, group);
}

static bool check_shown(const WrSession *session, int index, WrError *err)
{
    const WrDocument *document = session->state.document;
    if (wr_document_shows(document, index) || is_worn(document, index)) return true;
    WrText name = { 0 };
    while (document->solo < 0 && document->layers[index].visible)
        index = wr_document_parent(document, index); /* a group that it is in is hidden */
    wr_session_layer_name(session, index, &name);
    if (document->solo >= 0)
        wr_fail(err, "%s is not shown while layer %d is alone: `layer solo off` shows all",
                wr_text_get(&name), document->solo + 1);
    else
        wr_fail(err, "%s is hidden: `layer set %d visible=on` shows it", wr_text_get(&name),
                index + 1);
    wr_text_fini(&name);
    return false;
}

/* Fails if that layer is a filter or a group, which have no heights, or a generator layer, whose heights are its line's; or, if edits go
   to its mask, if that is a live one. */
static bool session_check_heights(const WrSession *session, int index, WrError *err)
{
    const WrLayer *layer = &session->state.document->layers[index];
    if (layer->on_mask ? !layer->mask_line : wr_layer_holds(layer) && !layer->line) return true;
    WrText name = { 0 };
    wr_session_layer_name(session, index, &name);
    if (layer->on_mask)
        wr_fail(err,
                "%s has a live mask: `layer mask %d live=off` converts it to one that can be "
                "painted on",
                wr_text_get(&name), index + 1);
    else if (layer->is_group)
        wr_fail(err,
                "%s is a group, which has no heights of its own: `layer use` one of its layers, or "
                "its mask",
                wr_text_get(&name));
    else if (layer->filter.op)
        wr_fail(err,
                "%s is a filter layer, which has no heights of its own: `layer use` another layer, "
                "or its mask",
                wr_text_get(&name));
    else
        wr_fail(err,
                "%s is a generator layer: `layer set %d change=` changes its arguments, `layer "
                "rasterize %d` converts it to a layer that can be painted on",
                wr_text_get(&name), index + 1, index + 1);
    wr_text_fini(&name);
    return false;
}

/* All edits pass here: the active layer must be unlocked, visible and have heights. A hidden layer would change without any
   visible effect, and the user would notice much later. */
bool wr_session_check_layer(const WrSession *session, WrError *err)
{
    const int active = session->state.document->active;
    return wr_session_check_unlocked(session, active, err) && check_shown(session, active, err) &&
           session_check_heights(session, active, err);
}

WrLayer *wr_session_layer(WrSession *session, WrError *err)
{
    if (!wr_session_check_layer(session, err)) return NULL;
    return wr_document_edit_begin(session->state.document, &session->stand_in);
}

/* The selection s applies to every edit alike: old + s (made - old), where s = 0 the bits stay (wr_edit_within). */
void wr_session_put_field(WrSession *session, WrField **field, WrField *made)
{
    const WrField *selection = session->state.document->selection;
    if (selection) {
        WrField *within = wr_edit_within(*field, made, selection);
        wr_field_free(made);
        made = within;
    }
    wr_field_free(*field);
    *field = made;
}

void wr_session_put_heights(WrSession *session, WrLayer *layer, WrField *heights)
{
    wr_session_put_field(session, &layer->heights, heights);
    wr_edit_mark(layer->cover, session->state.document->selection);
}

/* Value of a word of digits, or 0. */
static int layer_number(const char *word)
{
    size_t length = strlen(word);
    if (length == 0 || length > 6 || strspn(word, "0123456789") != length) return 0;
    return atoi(word);
}

static bool find_layer(const WrDocument *document, const char *word, int *index, WrError *err)
{
    char excerpt[WR_EXCERPT_SIZE];
    int number = layer_number(word), found = -1, same = 0;
    if (strspn(word, "0123456789") == strlen(word)) {
        if (number < 1 || number > document->layer_count)
            return wr_fail(err, "layer %s: must be 1..%d", wr_excerpt(word, excerpt),
                           document->layer_count);
        *index = number - 1;
        return true;
    }
    for (int i = 0; i < document->layer_count; i++)
        if (strcmp(document->layers[i].name, word) == 0) {
            found = i;
            same++;
        }
    if (same == 0)
        return wr_fail(err, "no layer is called \"%s\": must be a name or 1..%d",
                       wr_excerpt(word, excerpt), document->layer_count);
    if (same > 1)
        return wr_fail(err, "%d layers are called \"%s\": give its number", same,
                       wr_excerpt(word, excerpt));
    *index = found;
    return true;
}

/* Mark the layers of one word of a list: a layer, or a range such as 4..6. A name may contain dots. */
static bool list_word(const WrDocument *document, char *word, bool listed[WR_LAYERS_MAX],
                      WrError *err)
{
    int first, last;
    char *dots = wr_layer_named(document, word) < 0 ? strstr(word, "..") : NULL;
    if (dots) *dots = '\0';
    if (!find_layer(document, word, &first, err)) return false;
    last = first;
    if (dots && !find_layer(document, dots + 2, &last, err)) return false;
    for (int i = first < last ? first : last; i <= first || i <= last; i++) listed[i] = true;
    return true;
}

bool wr_session_find_layer(const WrSession *session, const char *word, int *index, WrError *err)
{
    return find_layer(session->state.document, word, index, err);
}

bool wr_layers_find(const WrDocument *document, const char *words, WrLayerList *layers,
                    WrError *err)
{
    bool listed[WR_LAYERS_MAX] = { false };
    /* a name may contain commas */
    const bool one = !strchr(words, ',') || wr_layer_named(document, words) >= 0;
    for (const char *p = words;;) {
        const size_t length = one ? strlen(p) : strcspn(p, ",");
        char excerpt[WR_EXCERPT_SIZE];
        if (!length)
            return wr_fail(err, "\"%s\": a layer is missing before or after a comma",
                           wr_excerpt(words, excerpt));
        char *word = wr_strndup(p, length);
        const bool good = list_word(document, word, listed, err);
        wr_free(word);
        if (!good) return false;
        if (!p[length]) break;
        p += length + 1;
    }
    layers->count = 0;
    for (int i = 0; i < document->layer_count; i++)
        if (listed[i]) layers->index[layers->count++] = i;
    return true;
}

/* ---- view history ---- */

/* Record a view if the view of the document has changed. Views have a history of their own: moving the camera must not push
   edits out of the undo list. */
static void session_note_view(WrSession *session)
{
    WrViews *views = session->state.views;
    int64_t before = wr_views_number(views);
    WrSceneView view = wr_scene_view(session->state.document->scene);
    wr_views_make_current(views, &view);
    if (wr_views_number(views) != before) session->view_top = wr_views_number(views);
}

int wr_session_view_undo_count(const WrSession *session)
{
    return wr_views_back(session->state.views);
}

int wr_session_redoable_views(const WrSession *session)
{
    return wr_views_forward(session->state.views);
}

/* ---- the view at the start ---- */

WrScene *wr_session_scene_at_start(const WrSession *session)
{
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    WrSceneView view = wr_views_start(session->state.views);
    wr_scene_set_pose(scene, &view);
    return scene;
}

/* ---- read-only snapshots for other threads ---- */

/* Everything is shared by reference or copied small; tables are copy-on-write, so a snapshot costs the same for any table
   size. */
WrSession *wr_session_snapshot(const WrSession *session)
{
    const WrSessionState *state = &session->state;
    const char *reason;
    WrSession *still = wr_alloc(1, sizeof *still);
    still->still = true;
    still->options.smooth = session->options.smooth;
    still->options.pool = session->options.pool; /* memory estimates depend on the thread count */
    still->state = (WrSessionState){ .document = wr_document_share(state->document),
                                     .history = wr_history_snapshot(state->history),
                                     .views = wr_views_clone(state->views),
                                     .saved_revision = state->saved_revision,
                                     .path = wr_strdup(state->path),
                                     .stamp = state->stamp,
                                     .chosen = wr_strdup(state->chosen) };
    still->last_revision = session->last_revision;
    still->made_before = session->made_before;
    still->budget = session->budget;
    still->unsafe = !wr_session_journal_safe(session, &reason);
    still->unsafe_words = wr_strdup(reason);
    return still;
}

void wr_session_let_run(WrSession *snapshot, WrPool *pool)
{
    snapshot->still = false;
    snapshot->options.pool = pool;
}

/* ---- the session ---- */

static void state_fini(WrSessionState *state)
{
    wr_document_free(state->document);
    wr_history_free(state->history);
    wr_views_free(state->views);
    wr_free(state->path);
    wr_free(state->origin);
    wr_free(state->newer_path);
    wr_free(state->chosen);
    *state = (WrSessionState){ 0 };
}

WrDocument *wr_session_new_document(const WrSession *session)
{
    WrDocument *document = wr_document_new();
    if (!session->options.smooth) return document;
    WrScene *scene = wr_scene_clone(document->scene);
    wr_dials_smooth(&scene->dials);
    wr_scene_free(document->scene);
    document->scene = scene;
    return document;
}

WrSession *wr_session_new(const WrSessionOptions *options)
{
    WrSession *session = wr_alloc(1, sizeof *session);
    if (options) session->options = *options;
    session->options.isa = wr_strdup(session->options.isa);
    session->budget = WR_HISTORY_BUDGET;
    session->state.document = wr_session_new_document(session);
    WrSceneView view = wr_scene_view(session->state.document->scene);
    session->state.history = wr_history_new(session->state.document, 0, session->budget);
    session->state.views = wr_views_new(&view);
    return session;
}

void wr_session_free(WrSession *session)
{
    if (!session) return;
    wr_session_stroke_cancel(session);
    wr_session_journal_drop(session);
    state_fini(&session->state);
    wr_renderer_free(session->renderer);
    wr_tables_free(session->tables);
    wr_table_cache_fini(&session->table_cache);
    wr_choice_fini(&session->choice);
    wr_brush_files_free(session->brush_files);
    wr_made_from_free(session->made_from);
    wr_mesh_texels_free(session->mesh_texels);
    session_forget_inputs(session);
    wr_layer_fini(&session->group);
    wr_free((char *)session->options.isa);
    wr_free(session->unsafe_words);
    wr_free(session);
}

WrSession *wr_session_of(const WrDocument *document, WrPool *pool)
{
    WrSession *session = wr_session_new(&(WrSessionOptions){ .pool = pool });
    wr_session_put_document(session, wr_document_share(document));
    return session;
}

void wr_session_set_outputs(WrSession *session, bool outputs)
{
    session->options.outputs = outputs;
}

#define NOTE_TEXT 4096 /* bytes; a report on a mesh has a dozen parts, and paths */

void wr_session_note(WrSession *session, const char *format, ...)
{
    if (!session->options.note) return;
    char text[NOTE_TEXT], message[2 * NOTE_TEXT];
    va_list args;
    va_start(args, format);
    wr_message_format(text, sizeof text, message, sizeof message, format, args);
    va_end(args);
    const bool whole = session->options.note_messages && message[0];
    session->options.note(session->options.note_ctx, whole ? message : text);
}

void wr_session_receipt(WrSession *session, const char *file, const char *kind,
                        const WrExportReport *report, double began)
{
    WrReceipts receipts = { 0 };
    if (!session->options.receipt) return;
    wr_receipts_add(&receipts, file, kind, report, began);
    session->options.receipt(session->options.receipt_ctx, receipts.files.data);
    wr_receipts_free(&receipts);
}

/* ---- running ---- */

/* Absolute path of the folder that relative file names of a line refer to; NULL if the line names no file. */
static char *folder_of(const WrSession *session, const WrCall *call)
{
    bool names = false;
    for (int i = 0; i < call->count; i++) names |= wr_call_names_file(call, i);
    if (!names) return NULL;
    char *full = wr_path_real(session->folder ? session->folder : ".");
    char *kept = wr_strdup(full);
    free(full);
    return kept;
}

/* The step's text is the canonical line, not the typed one: with all arguments of the file's folder resolved, it can be
   repeated elsewhere. */
void wr_session_remember(WrSession *session, const WrCall *call)
{
    WrText text = { 0 };
    char *folder = folder_of(session, call);
    wr_call_print(call, &text);
    wr_history_push(session->state.history, session->state.document, wr_text_get(&text), folder,
                    ++session->last_revision);
    wr_history_note_step(session->state.history, session->step_seconds, false);
    session->step_seconds = 0.0;
    wr_free(folder);
    wr_text_fini(&text);
}

void wr_session_put_document(WrSession *session, WrDocument *document)
{
    wr_document_swap_composites(document, session->state.document);
    wr_document_free(session->state.document);
    session->state.document = document;
}

void wr_session_restore(WrSession *session)
{
    WrHistory *history = session->state.history;
    wr_session_put_document(session, wr_history_go(history, wr_history_position(history)));
}

typedef struct VariantOutput {
    WrSession *session;
    WrCall *call;
} VariantOutput;

/* Run an output command with the variant's name in place of <VARIANT>. */
static bool run_for_variant(void *ctx, const char *variant, WrError *err)
{
    const VariantOutput *output = ctx;
    WrCall *call = output->call;
    char *patterns[WR_ARGS_MAX] = { NULL };
    for (int i = 0; variant && i < call->count; i++) {
        if (!wr_variant_is_pattern(call->args[i].text)) continue;
        patterns[i] = call->args[i].text;
        call->args[i].text = wr_variant_fill(patterns[i], variant);
    }
    const bool good = call->command->run(output->session, call, err);
    for (int i = 0; i < call->count; i++) {
        if (!patterns[i]) continue;
        wr_free(call->args[i].text);
        call->args[i].text = patterns[i];
    }
    return good;
}

static bool run_output(WrSession *session, WrCall *call, WrError *err)
{
    if (session->options.outputs && !session->skip_outputs) {
        const char *path = NULL;
        for (int i = 0; i < call->count && call->command->of_variants && !path; i++)
            if (wr_variant_is_pattern(call->args[i].text)) path = call->args[i].text;
        VariantOutput output = { session, call };
        return wr_session_for_variants(session, path, run_for_variant, &output, err);
    }
    WrText text = { 0 };
    wr_call_print(call, &text);
    wr_session_note(session, "skipped: %s (only `wrinkle run` writes files)", wr_text_get(&text));
    wr_text_fini(&text);
    return true;
}

/* After a cancellation the result is incomplete and counts as a failure, whatever the command returned. */
static bool went_through(bool good, WrError *err)
{
    return good && (!wr_progress_stopped() || wr_fail(err, "cancelled"));
}

/* Update the composite after the outermost command, if options.composites is set. */
bool wr_session_make_composite(WrSession *session, WrError *err)
{
    if (!session->options.composites || session->depth > 1 || session->opening) return true;
    wr_document_composite(session->state.document, session->options.pool);
    return went_through(true, err);
}

/* Use the precomputed tables of layers. The window computes slow filters on a worker thread with a clone of the document and
   then runs the line with its result. Names stay those of the session, since the clone may be older; tables that did not
   change are compared by key. */
static bool take_made(WrSession *session, const WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    const WrDocument *made = session->made;
    bool all = wr_call_gives(call, "layers") && wr_call_choice(call, "layers") == 1;
    if (!all && !wr_session_check_layer(session, err)) return false;
    if (made->layer_count != document->layer_count)
        return wr_fail(err, "the result has %d layers, the document %d", made->layer_count,
                       document->layer_count);
    for (int i = 0; i < document->layer_count; i++) {
        WrLayer *layer = &document->layers[i], taken = wr_layer_share(&made->layers[i]);
        if (wr_field_key(layer->heights) != wr_field_key(taken.heights) &&
            !wr_session_check_unlocked(session, i, err)) {
            wr_layer_fini(&taken);
            return false;
        }
        char *name = layer->name;
        layer->name = taken.name;
        taken.name = name;
        WrLayer old = *layer;
        *layer = taken;
        wr_layer_fini(&old);
    }
    return true;
}

/* The filter's result was precomputed, so the composite is known too. */
static void know_made(WrSession *session)
{
    WrDocument *knows = wr_document_share(session->made);
    wr_document_swap_composites(session->state.document, knows);
    wr_document_free(knows);
}

static bool run_edit(WrSession *session, WrCall *call, WrError *err)
{
    bool layers = session->options.composites && session->state.document->layer_count > 1;
    WrProgressPart part;
    const WrProgress *whole = wr_progress_enter(&part, 0.0, layers ? 0.8 : 1.0);
    const bool takes = session->made && call->command->prework == WR_PREWORK_TABLES;
    wr_filters_forget();
    bool good = !wr_progress_stopped() &&
                (takes ? take_made(session, call, err) : call->command->run(session, call, err));
    wr_document_edit_end(session->state.document, &session->stand_in);
    if (good && session->made && !takes) know_made(session);
    /* a filter's result is valid only if every filter below it ran */
    good = good && wr_filters_carried(err);
    good = went_through(good, err);
    part.from = part.to;
    part.to = 1.0;
    good = good && wr_session_make_composite(session, err);
    wr_progress_set(whole);
    return good;
}

static void record_choice(WrSession *session, const WrCall *call)
{
    WrText text = { 0 };
    wr_call_print(call, &text);
    wr_history_record_choice(session->state.history, session->state.document, wr_text_get(&text));
    wr_text_fini(&text);
}

/* Only the outermost command is a step, and only its failure restores the old state. A view is no step: it changes
   only the view of the present state; nor is the choice of a layer. Commands run others (gltf, script); depth counts the nesting. Order: the journal is
   written before the change, so that a crash within the command leaves its line to be reported by the recovery. */
static bool run_call(WrSession *session, WrCall *call, WrError *err)
{
    if (!call->command) return true;
    if (wr_call_class(call) == WR_CLASS_OUTPUT) return run_output(session, call, err);
    bool good, view = wr_call_class(call) == WR_CLASS_VIEW;
    const bool choice = wr_call_class(call) == WR_CLASS_CHOICE;
    const double began = wr_clock_seconds();
    wr_session_journal_before(session, call);
    if (wr_call_class(call) == WR_CLASS_HISTORY) {
        good = call->command->run(session, call, err);
        if (good) session_note_view(session);
        wr_session_journal_after(session, call, good, false);
        return good;
    }
    if (session->depth == 0 && !view && !choice && !session->made)
        session->made_before = wr_layer_time_last(); /* `made` was made before */
    session->depth++;
    good = run_edit(session, call, err);
    session->depth--;
    if (session->depth > 0) return good;
    good = good && wr_session_follow(session, err);
    if (!good) wr_session_restore(session);
    else if (view) wr_history_record_view(session->state.history, session->state.document);
    else if (choice) record_choice(session, call);
    else {
        session->step_seconds = wr_clock_seconds() - began;
        wr_session_remember(session, call);
    }
    if (good) session_note_view(session);
    wr_session_journal_after(session, call, good, !view && !choice);
    return good;
}

bool wr_session_refuse_in_stroke(const WrSession *session, WrError *err)
{
    if (session->still) return wr_fail(err, "busy: another command is running");
    if (!session->stroke) return true;
    return wr_fail(err, "busy: a stroke is being drawn");
}

/* Prefix a message with the verb unless it begins with it. */
static void name_command(WrError *err, const char *verb)
{
    size_t length = strlen(verb);
    if (err && (strncmp(err->text, verb, length) != 0 || isalnum((unsigned char)err->text[length])))
        wr_error_prefix(err, "%s: ", verb);
}

bool wr_session_takes_made(const char *line)
{
    WrCall *call = NULL;
    if (!wr_call_parse(line, false, &call, NULL)) return false;
    bool takes = call->command && call->command->prework != WR_PREWORK_NONE;
    for (int i = 0; i < call->count; i++) takes = takes && !wr_call_hash_argument(call, i);
    wr_call_free(call);
    return takes;
}

bool wr_session_run_made(WrSession *session, const char *line, const WrDocument *made, WrError *err)
{
    if (!wr_session_takes_made(line))
        return wr_fail(err, "%.60s: cannot be computed in advance", line);
    session->made = made;
    bool good = wr_session_run(session, line, err);
    session->made = NULL;
    return good;
}

static void foretell(WrSession *session, const WrCall *call)
{
    WrEstimate estimate;
    char text[WR_ESTIMATE_TEXT];
    wr_session_estimate_call(session, call, &estimate);
    wr_estimate_print(&estimate, text);
    if (text[0])
        wr_session_note(session, "%s%s%s: needs %s of memory", call->command->name,
                        call->form >= 0 ? " " : "", call->form_name, text);
}

/* Parse a line. `rotate` is a view with a single object and an edit with several; the edit's command is then
   substituted. */
static bool parse(const WrSession *session, const char *line, WrCall **out, WrError *err)
{
    if (!wr_call_parse(line, false, out, err)) return false;
    const WrCommand *command = (*out)->command;
    if (!command || !command->of_several ||
        wr_scene_object_count(session->state.document->scene) == 1)
        return true;
    WrText edit = { 0 };
    bool good = true;
    if (command->of_several(*out, &edit)) {
        wr_call_free(*out);
        good = wr_call_parse(wr_text_get(&edit), false, out, err);
    }
    wr_text_fini(&edit);
    return good;
}

bool wr_session_run(WrSession *session, const char *line, WrError *err)
{
    WrCall *call;
    if (!wr_session_refuse_in_stroke(session, err)) return false;
    if (!parse(session, line, &call, err)) return false;
    if (session->options.foretell && !session->opening) foretell(session, call);
    wr_session_spell_change(session, call);
    bool good = wr_session_take_tiles(session, call, err) && run_call(session, call, err);
    if (!good && wr_progress_stopped())
        wr_fail(err, "cancelled"); /* the half-done state was restored
                                                                      above */
    if (!good) wr_call_add_hint(call, err);
    if (!good && !session->nameless) name_command(err, call->command->name);
    wr_call_free(call);
    return good;
}

/* ---- moves through the history ---- */

/* The journal can replay undo and redo; after `step go` it starts again from a snapshot. */
void wr_session_history_go_line(const WrSession *session, int state, char line[WR_GO_LINE])
{
    const WrHistory *history = session->state.history;
    const int steps = state - wr_history_position(history);
    const bool beyond =
        state < wr_history_list_end(history) || steps == 0 || state > wr_history_count(history);
    if (beyond) snprintf(line, WR_GO_LINE, "step go %d", state);
    else snprintf(line, WR_GO_LINE, "%s %d", steps < 0 ? "undo" : "redo", abs(steps));
}

/* Goes through a command line, so that moves are written to the journal like every other command. */
bool wr_session_history_go(WrSession *session, int state, WrError *err)
{
    char line[WR_GO_LINE];
    wr_session_history_go_line(session, state, line);
    return wr_session_run(session, line, err);
}

bool wr_session_travel(WrSession *session, int steps)
{
    WrHistory **history = &session->state.history, *before = *history;
    if (steps == 0 || -steps > wr_history_undo_count(before) ||
        steps > wr_history_redo_count(before))
        return false;
    wr_session_put_document(session, wr_history_travel(history, steps));
    if (*history != before) wr_session_journal_cut(session);
    return true;
}

bool wr_session_go_to(WrSession *session, int state, WrError *err)
{
    WrHistory *history = session->state.history;
    int count = wr_history_count(history), oldest = wr_history_oldest(history);
    if (!wr_session_refuse_in_stroke(session, err)) return false;
    if (state < 0 || state > count) return wr_fail(err, "step %d: there are %d", state, count);
    if (state < oldest)
        return wr_fail(
            err,
            "step %d was dropped to stay within the memory limit of the history: %d is the oldest",
            state, oldest);
    wr_session_put_document(session, wr_history_go(history, state));
    return true;
}

int wr_session_history_count(const WrSession *session)
{
    return wr_history_count(session->state.history);
}

int wr_session_undo_count(const WrSession *session)
{
    return wr_history_undo_count(session->state.history);
}

int wr_session_redo_count(const WrSession *session)
{
    return wr_history_redo_count(session->state.history);
}

int wr_session_history_position(const WrSession *session)
{
    return wr_history_position(session->state.history);
}

int wr_session_history_oldest(const WrSession *session)
{
    return wr_history_oldest(session->state.history);
}

const char *wr_session_history_line(const WrSession *session, int index)
{
    if (index < 0 || index >= wr_history_count(session->state.history)) return "";
    return wr_history_line(session->state.history, index);
}

bool wr_session_history_is_off(const WrSession *session, int index)
{
    return index >= 0 && index < wr_history_count(session->state.history) &&
           wr_history_is_off(session->state.history, index);
}

double wr_session_history_seconds(const WrSession *session, int index)
{
    double seconds = 0.0;
    for (int k = index < 0 ? 0 : index; k < wr_history_position(session->state.history); k++)
        seconds += wr_history_step_seconds(session->state.history, k);
    return seconds;
}

size_t wr_session_history_bytes(const WrSession *session)
{
    return wr_history_bytes(session->state.history);
}

size_t wr_session_history_step_bytes(const WrSession *session, int index)
{
    if (index < 0 || index >= wr_history_count(session->state.history)) return 0;
    return wr_history_step_bytes(session->state.history, index);
}

const WrField *wr_session_history_heights(const WrSession *session, int position)
{
    if (position < 0 || position > wr_history_count(session->state.history)) return NULL;
    return wr_history_heights(session->state.history, position);
}

size_t wr_session_history_budget(const WrSession *session)
{
    return session->budget;
}

void wr_session_set_history_budget(WrSession *session, size_t bytes)
{
    session->budget = bytes;
    wr_history_set_budget(session->state.history, bytes);
}

/* ---- queries ---- */

const WrDocument *wr_session_document(const WrSession *session)
{
    return session->state.document;
}

const char *wr_session_last_command(const WrSession *session)
{
    return wr_session_history_line(session, wr_session_history_position(session) - 1);
}

uint64_t wr_session_revision(const WrSession *session)
{
    return wr_history_mark(session->state.history);
}

bool wr_session_file_changed(const WrSession *session)
{
    const WrSessionState *state = &session->state;
    if (!state->path) return false;
    WrFileIdentity now = wr_file_identity(state->path);
    return now.there && !wr_file_identity_same(&now, &state->stamp);
}

uint64_t wr_session_saved_revision(const WrSession *session)
{
    return session->state.saved_revision;
}

const char *wr_session_path(const WrSession *session)
{
    return session->state.path ? session->state.path : "";
}

void wr_session_scene_text(const WrSession *session, WrText *text)
{
    wr_print_scene(session->state.document->scene, NULL, NULL, text);
}

WrHash wr_session_hash_with(const WrSession *session, const WrScene *scene)
{
    WrText text = { 0 };
    wr_print_identity(scene, &text);
    WrHash hash = wr_document_hash(session->state.document, wr_text_get(&text));
    wr_text_fini(&text);
    return hash;
}

WrHash wr_session_hash(const WrSession *session)
{
    return wr_session_hash_with(session, session->state.document->scene);
}

/* ---- replacing the document as a whole ---- */

void wr_session_restart_history(WrSession *session)
{
    WrSceneView view = wr_scene_view(session->state.document->scene);
    wr_history_free(session->state.history);
    wr_views_free(session->state.views);
    session->state.history =
        wr_history_new(session->state.document, ++session->last_revision, session->budget);
    session->state.views = wr_views_new(&view);
}

WrSessionState wr_session_begin_state(WrSession *session, WrDocument *document)
{
    WrSessionState old = session->state;
    session->state = (WrSessionState){ .document = document };
    wr_session_restart_history(session);
    return old;
}

void wr_session_keep_state(WrSession *session, WrSessionState *old)
{
    state_fini(old);
    session->state.saved_revision = wr_session_revision(session);
}

void wr_session_restore_state(WrSession *session, WrSessionState *old)
{
    state_fini(&session->state);
    session->state = *old;
}

void wr_session_reset(WrSession *session)
{
    wr_session_stroke_cancel(session);
    wr_session_journal_drop(session);
    WrSessionState old = wr_session_begin_state(session, wr_session_new_document(session));
    wr_session_keep_state(session, &old);
}
