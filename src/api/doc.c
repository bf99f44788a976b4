/* Documents of the C interface: each is a session with its own threads, notes and progress. */
#include "api/doc.h"

#include "api/api_internal.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/text.h"
#include "brush/brush.h"
#include "command/help.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "render/frame/frame.h"
#include "scene/scene.h"
#include "system/path.h"
#include "system/shared_object.h"
#include "system/thread.h"

#include <stdlib.h>
#include <string.h>

const char *wr_doc_version(void)
{
    return WR_VERSION;
}

#define THREADS_MAX 256

/* ---- calls ---- */

void wr_api_error(WrDocError *error, int status, const char *text)
{
    if (!error) return;
    error->status = status;
    snprintf(error->text, sizeof error->text, "%s", text);
}

static void report(void *ctx, double fraction)
{
    WrDoc *doc = ctx;
    if (doc->report && !doc->report(doc->ctx, fraction)) wr_doc_cancel(doc);
}

/* const: calls that only read have a progress too */
void wr_api_begin(ApiCall *call, const WrDoc *doc)
{
    call->doc = (WrDoc *)doc;
    call->err.text[0] = '\0';
    call->outer = wr_progress_here();
    if (!doc->threads) return;
    call->doc->cancel = 0;
    call->doc->progress =
        (WrProgress){ .cancel = &call->doc->cancel, .report = report, .ctx = call->doc };
    wr_progress_set(&call->doc->progress);
}

bool wr_api_end(ApiCall *call, bool good, WrDocError *error)
{
    if (!good)
        wr_api_error(error, wr_progress_stopped() ? WR_DOC_CANCELLED : WR_DOC_FAILED,
                     call->err.text);
    wr_progress_set(call->outer);
    return good;
}

void wr_doc_cancel(WrDoc *doc)
{
    __atomic_store_n(&doc->cancel, 1, __ATOMIC_RELAXED);
}

static void note(void *ctx, const char *text)
{
    WrDoc *doc = ctx;
    if (doc->note) doc->note(doc->ctx, text);
}

/* ---- the life of documents ---- */

#ifndef WR_PROGRAM_FROM_LIBRARY
#define WR_PROGRAM_FROM_LIBRARY "../bin"
#endif

static void set_program(const char *library)
{
    char *folder = wr_path_folder(library);
    WrText path = { 0 };
    wr_text_addf(&path, "%s/wrinkle-reader", folder);
    const bool built = wr_path_is_file(wr_text_get(&path));
    wr_text_clear(&path);
    wr_text_addf(&path, "%s%s", folder, built ? "" : "/" WR_PROGRAM_FROM_LIBRARY);
    wr_program_folder_set(wr_text_get(&path));
    wr_text_fini(&path);
    wr_free(folder);
}

/* In another program the reader process, modules and data are found from the library's own folder: beside it in a build
   folder, else where the installation puts them. Once, since documents of several threads may begin together. */
static void find_program(void)
{
    static WrMutex lock = WR_MUTEX_READY;
    static bool found;
    static const char here; /* any address of this library */
    char library[4096];
    wr_mutex_lock(&lock);
    const bool first = !found;
    found = true;
    if (first && wr_object_path(&here, library, sizeof library)) set_program(library);
    wr_mutex_unlock(&lock);
}

WrPool *wr_api_pool(const WrDoc *doc)
{
    return doc->threads ? doc->threads->pool : NULL;
}

bool wr_api_check_instruction_set(const char *isa, WrError *err)
{
    if (!isa) return true;
    WrRenderer *renderer = wr_renderer_new(NULL, isa, err);
    wr_renderer_free(renderer);
    return renderer;
}

WrDoc *wr_api_new(const WrSessionOptions *options, WrError *err)
{
    if (!wr_api_check_instruction_set(options->isa, err)) return NULL;
    WrDoc *doc = wr_alloc(1, sizeof *doc);
    doc->session = wr_session_new(options);
    return doc;
}

/* The caller's options; members that its version does not have are 0. */
static WrDocOptions complete(const WrDocOptions *options)
{
    WrDocOptions all = { 0 };
    if (options) memcpy(&all, options, options->size < sizeof all ? options->size : sizeof all);
    return all;
}

WrDoc *wr_doc_new(const WrDocOptions *options, WrDocError *error)
{
    const WrDocOptions all = complete(options);
    WrError err;
    find_program();
    const bool good =
        all.threads < 0 || all.threads > THREADS_MAX
            ? wr_fail(&err, "threads %d: must be 0..%d", (int)all.threads, THREADS_MAX)
            : wr_api_check_instruction_set(all.instruction_set, &err);
    if (!good) {
        wr_api_error(error, WR_DOC_FAILED, err.text);
        return NULL;
    }
    WrDoc *doc = wr_alloc(1, sizeof *doc);
    doc->note = all.note;
    doc->report = all.progress;
    doc->ctx = all.ctx;
    doc->threads = wr_alloc(1, sizeof *doc->threads);
    doc->threads->refs = 1;
    doc->threads->pool = wr_pool_new(all.threads);
    const WrSessionOptions session = { .pool = doc->threads->pool,
                                       .note = note,
                                       .note_ctx = doc,
                                       .outputs = all.outputs,
                                       .journal = all.journal,
                                       .isa = all.instruction_set,
                                       .picture_bytes = all.picture_bytes,
                                       .smooth = true };
    doc->session = wr_session_new(&session);
    return doc;
}

WrDoc *wr_doc_snapshot(const WrDoc *doc)
{
    WrDoc *copy = wr_alloc(1, sizeof *copy);
    copy->session = wr_session_snapshot(doc->session);
    copy->threads = doc->threads;
    if (copy->threads) atomic_fetch_add(&copy->threads->refs, 1);
    return copy;
}

bool wr_api_scratch(WrDoc *doc, WrText *path, WrError *err)
{
    if (!doc->scratch) doc->scratch = wr_scratch_new(err);
    if (doc->scratch) wr_text_add(path, doc->scratch);
    return doc->scratch != NULL;
}

void wr_doc_free(WrDoc *doc)
{
    if (!doc) return;
    wr_session_free(doc->session);
    if (doc->threads && atomic_fetch_sub(&doc->threads->refs, 1) == 1) {
        wr_pool_free(doc->threads->pool);
        wr_free(doc->threads);
    }
    wr_scratch_free(doc->scratch);
    wr_free(doc);
}

WrSession *wr_api_session(WrDoc *doc)
{
    return doc->session;
}

/* ---- commands and files ---- */

bool wr_doc_open(WrDoc *doc, const char *path, WrDocError *error)
{
    ApiCall call;
    wr_api_begin(&call, doc);
    return wr_api_end(&call, wr_session_open(doc->session, path, &call.err), error);
}

bool wr_doc_save(WrDoc *doc, const char *path, WrDocError *error)
{
    ApiCall call;
    wr_api_begin(&call, doc);
    return wr_api_end(&call, wr_session_save(doc->session, path, &call.err), error);
}

bool wr_doc_save_history(WrDoc *doc, const char *path, WrDocError *error)
{
    ApiCall call;
    wr_api_begin(&call, doc);
    return wr_api_end(&call, wr_session_save_history(doc->session, path, &call.err), error);
}

bool wr_doc_run(WrDoc *doc, const char *line, WrDocError *error)
{
    ApiCall call;
    wr_api_begin(&call, doc);
    return wr_api_end(&call, wr_session_run(doc->session, line, &call.err), error);
}

bool wr_doc_run_script(WrDoc *doc, const char *path, WrDocError *error)
{
    ApiCall call;
    wr_api_begin(&call, doc);
    const bool good = strcmp(path, "-") == 0
                          ? wr_session_run_stream(doc->session, stdin, "standard input", &call.err)
                          : wr_session_run_script(doc->session, path, &call.err);
    return wr_api_end(&call, good, error);
}

/* ---- facts ---- */

WrDocInfo wr_doc_info(const WrDoc *doc)
{
    const WrSession *session = doc->session;
    const WrDocument *document = wr_session_document(session);
    const WrField *field = document->layers[0].heights;
    const WrScene *scene = document->scene;
    return (WrDocInfo){ .width = wr_field_width(field),
                        .height = wr_field_height(field),
                        .periodic_u = wr_field_wrap_u(field) == WR_WRAP_PERIODIC,
                        .periodic_v = wr_field_wrap_v(field) == WR_WRAP_PERIODIC,
                        .changed =
                            wr_session_revision(session) != wr_session_saved_revision(session),
                        .layers = document->layer_count,
                        .active_layer = document->active,
                        .undo_steps = wr_session_undo_count(session),
                        .redo_steps = wr_session_redo_count(session),
                        .cell_width = scene->cell.w,
                        .cell_height = scene->cell.h,
                        .relief = scene->cell.mm ? scene->cell.height : scene->height,
                        .in_mm = scene->cell.mm };
}

bool wr_doc_layer(const WrDoc *doc, int32_t index, WrDocLayer *layer)
{
    const WrDocument *document = wr_session_document(doc->session);
    if (index < 0 || index >= document->layer_count) return false;
    const WrLayer *from = &document->layers[index];
    *layer = (WrDocLayer){ .blend = wr_blends[from->blend].name,
                           .line = from->line,
                           .opacity = from->opacity,
                           .visible = from->visible,
                           .locked = from->locked,
                           .filter = from->filter.op,
                           .group = from->is_group,
                           .depth = from->depth };
    snprintf(layer->name, sizeof layer->name, "%s", from->name);
    return true;
}

const char *wr_doc_history(const WrDoc *doc, int32_t index)
{
    const bool there = index >= 0 && index < wr_session_history_count(doc->session);
    return there ? wr_session_history_line(doc->session, index) : NULL;
}

void wr_doc_hash(const WrDoc *doc, char digits[33])
{
    wr_hash_print(wr_session_hash(doc->session), digits);
}

/* ---- strokes ---- */

bool wr_doc_stroke_begin(WrDoc *doc, const char *head, WrDocError *error)
{
    ApiCall call;
    wr_api_begin(&call, doc);
    return wr_api_end(&call, wr_session_stroke_begin(doc->session, head, &call.err), error);
}

bool wr_doc_stroke_add(WrDoc *doc, const WrDocSample *samples, size_t count, WrDocError *error)
{
    ApiCall call;
    bool good = true;
    wr_api_begin(&call, doc);
    for (size_t i = 0; i < count && good; i++) {
        const WrSample sample = { .u = samples[i].u,
                                  .v = samples[i].v,
                                  .pressure = samples[i].pressure,
                                  .tilt_x = samples[i].tilt_x,
                                  .tilt_y = samples[i].tilt_y,
                                  .seconds = samples[i].seconds };
        good = wr_session_stroke_add(doc->session, &sample, 1, &call.err);
    }
    return wr_api_end(&call, good, error);
}

bool wr_doc_stroke_end(WrDoc *doc, WrDocError *error)
{
    ApiCall call;
    wr_api_begin(&call, doc);
    return wr_api_end(&call, wr_session_stroke_end(doc->session, &call.err), error);
}

void wr_doc_stroke_cancel(WrDoc *doc)
{
    wr_session_stroke_cancel(doc->session);
}

/* ---- for bindings ---- */

char *wr_doc_commands_json(void)
{
    WrText text = { 0 };
    wr_help_json(&text);
    char *copy = wr_strdup(wr_text_get(&text));
    wr_text_fini(&text);
    return copy;
}

void wr_doc_free_text(char *text)
{
    wr_free(text);
}
