#include "ui/app/jobs/edit_preview.h"
#include "ui/app/jobs/coarse_preview.h"
#include "ui/app/jobs/job.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "brush/brush.h"
#include "brush/tip.h"
#include "command/command_line.h"
#include "command/commands.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "field/ops.h"
#include "generate/generator.h"
#include "system/clock.h"
#include "system/thread.h"

#include <SDL.h>
#include <math.h>
#include <string.h>

/* ---- the edited table ---- */

#define PATIENCE_SECONDS 0.25 /* a rough result that is due this soon is awaited */
#define ROUGH_TEXELS 262144.0 /* approximate size of a rough table */
#define ROUGH_MIN 16          /* least texels along a side */

static void note(void *ctx, const char *text)
{
    wr_text_addf(ctx, "%s\n", text);
}

/* Reduction factor of a rough table. Generators with a position, files or text keep the full size: their heights or
   grain may depend on texels. */
static int rough_step(const WrGenerator *generator, const WrField *like)
{
    double texels = (double)wr_field_width(like) * wr_field_height(like);
    int least =
        wr_field_width(like) < wr_field_height(like) ? wr_field_width(like) : wr_field_height(like);
    for (const WrParam *p = generator->params; p->name; p++)
        if (p->kind == WR_PARAM_FILE || p->kind == WR_PARAM_TEXT || strcmp(p->name, "at") == 0)
            return 1;
    /* Reduction by step on both axes divides the number of texels by its square. */
    int step = (int)ceil(sqrt(texels / ROUGH_TEXELS));
    return step < 1 || least / step < ROUGH_MIN ? 1 : step;
}

/* Convert lengths in texels to a table that is `step` times smaller. */
static void shrink(const WrGenerator *generator, WrParamValue *values, int step)
{
    for (int i = 0; generator->params[i].name; i++) {
        const WrParam *p = &generator->params[i];
        bool length = p->unit && strcmp(p->unit, "texels") == 0;
        if (!length || (p->kind != WR_PARAM_NUMBER && p->kind != WR_PARAM_TUPLE)) continue;
        for (int k = 0; k < 3; k++) {
            double small = values[i].number[k] / step;
            if (small >= p->low && !(p->above && small == p->low)) values[i].number[k] = small;
        }
    }
}

static WrField *resized(const WrField *field, int width, int height, WrPool *pool,
                        const WrProgress *progress, WrError *err)
{
    const double param[] = { width, height, WR_RESIZE_LINEAR };
    const WrOpOptions options = { .pool = pool, .progress = progress };
    return wr_op_run(wr_op_find("resize"), field, param, &options, err);
}

static bool enlarge(WrField **field, const WrField *like, const WrGenerateJob *job, WrError *err)
{
    if (!*field) return true;
    WrField *large =
        resized(*field, wr_field_width(like), wr_field_height(like), job->pool, job->progress, err);
    if (!large) return false;
    wr_field_free(*field);
    *field = large;
    return true;
}

static bool make_small(const WrGenerator *generator, WrParamValue *values, WrGenerateJob *job,
                       int step, WrRelief *out, WrError *err)
{
    const WrField *like = job->like;
    WrField *small =
        resized(like, (wr_field_width(like) + step - 1) / step,
                (wr_field_height(like) + step - 1) / step, job->pool, job->progress, err);
    if (!small) return false;
    shrink(generator, values, step);
    job->like = small;
    WrRelief made = { NULL, NULL };
    bool good = wr_generator_make(generator, values, job, &made, err) &&
                enlarge(&made.heights, like, job, err) && enlarge(&made.cover, like, job, err);
    wr_field_free(small);
    job->like = like;
    if (good) *out = made;
    else wr_relief_fini(&made);
    return good;
}

/* shrunk: the table is that many times smaller than the one the line is for */
static bool make(const WrCall *call, WrGenerateJob *job, int shrunk, WrRelief *out, WrError *err)
{
    const WrGenerator *generator = wr_call_generator(call);
    WrParamValue values[WR_GENERATOR_PARAMS];
    char *owned[WR_GENERATOR_PARAMS] = { NULL };
    wr_call_values(call, generator, values);
    for (int i = 0; generator->params[i].name; i++)
        if (generator->params[i].kind == WR_PARAM_TEXT && values[i].text)
            values[i].text = owned[i] = wr_generator_text(values[i].text);
    if (shrunk > 1) shrink(generator, values, shrunk);
    int step = job->coarse && shrunk == 1 ? rough_step(generator, job->like) : 1;
    bool good = step > 1 ? make_small(generator, values, job, step, out, err)
                         : wr_generator_make(generator, values, job, out, err);
    for (int i = 0; i < WR_GENERATOR_PARAMS; i++) wr_free(owned[i]);
    return good;
}

static bool into_active(WrDocument *document, const WrCall *call, WrGenerateJob *job, WrError *err)
{
    WrRelief relief = { NULL, NULL };
    WrStandIn stand_in = { .index = 0 };
    WrLayer *layer = wr_document_edit_begin(document, &stand_in);
    WrLayersBelow layers = { document, document->active };
    job->layer = wr_layers_below_find;
    job->layer_ctx = &layers;
    job->like = layer->heights;
    job->selection = document->selection;
    job->mask = document->layers[document->active].mask;
    const bool good =
        make(call, job, 1, &relief, err) &&
        wr_call_join(call, &relief, document->selection, layer, job->pool, job->progress, err);
    wr_document_edit_end(document, &stand_in);
    wr_relief_fini(&relief);
    return good;
}

/* Above the active layer, with the selection as its mask. */
static void add_layer(WrDocument *document, const WrCall *call)
{
    WrLayer layer = wr_layer_make("", document->layers[0].heights);
    wr_call_begin_layer(call, document->selection, &layer);
    wr_document_insert(document, document->active + 1, layer);
    document->active++;
}

static bool as_layer(WrDocument *document, const WrCall *call, WrGenerateJob *job, int shrunk,
                     WrError *err)
{
    WrRelief relief = { NULL, NULL };
    WrLayer *layer = &document->layers[document->active];
    WrField *below = wr_call_generator(call)->reads
                         ? wr_document_below(document, document->active, job->pool)
                         : NULL;
    WrLayersBelow layers = { document, document->active };
    job->layer = wr_layers_below_find;
    job->layer_ctx = &layers;
    job->like = below ? below : layer->heights;
    job->mask = layer->mask;
    if (wr_family_find(call->command->name)->beyond) job->selection = document->selection;
    const bool good = make(call, job, shrunk, &relief, err) &&
                      wr_call_lay(call, &relief, layer, job->pool, job->progress, err);
    wr_field_free(below);
    wr_relief_fini(&relief);
    return good;
}

bool wr_edit_preview_generate(WrDocument *document, const char *line, WrLineTarget target,
                              bool rough, WrPool *pool, const WrProgress *progress, WrText *notes,
                              WrError *err)
{
    WrCall *call = NULL;
    if (!wr_call_parse(line, false, &call, err)) return false;
    WrGenerateJob job = {
        .pool = pool, .progress = progress, .coarse = rough, .note = note, .note_ctx = notes
    };
    bool good =
        wr_call_generator(call) || wr_fail(err, "%s: must be the command of a generator", line);
    if (good && target == WR_LINE_NEW_LAYER) add_layer(document, call);
    good = good && (target == WR_LINE_INTO_ACTIVE ? into_active(document, call, &job, err)
                                                  : as_layer(document, call, &job, 1, err));
    wr_call_free(call);
    return good;
}

/* Apply a `transform` line to the document. */
static bool edit_preview_transform(WrDocument *document, const char *line, WrPool *pool,
                                   const WrProgress *progress, WrError *err)
{
    WrCall *call = NULL;
    WrStandIn stand_in = { .index = 0 };
    if (!wr_call_parse(line, false, &call, err)) return false;
    WrLayer *layer =
        wr_call_transforms_one(call) ? wr_document_edit_begin(document, &stand_in) : NULL;
    bool good = wr_call_transform(call, document, layer, pool, progress, err);
    wr_document_edit_end(document, &stand_in);
    wr_call_free(call);
    return good;
}

/* ---- requests ---- */

/* The small copy of the layers, which following requests use again, even if the request that made it was cancelled. */
typedef struct Slot {
    WrMutex lock;
    WrCoarse *coarse; /* owned; NULL: none */
} Slot;

typedef struct Work {
    WrDocument *document; /* own snapshot, changed by the work */
    WrEditPreviewRequest ask;
    /* unchanged copy of the snapshot, for the exact result after a rough one; NULL: none */
    WrDocument *again;
    WrSession *session; /* copy of ask.session; owned; NULL: none */
    char *line;         /* generator line or command; ask.line or ask.command points to it */
    Slot *slot;         /* the preview's; borrowed */
    WrCoarse
        *coarse; /* small copy of the layers, used again by the next request; owned; NULL: none */
    WrText notes;
    double seconds;
    WrBrush brush;  /* brush of a dab; ask.dab points to it */
    WrField *field; /* the result; NULL: none */
    WrError err;
    bool cancelled;
} Work;

struct WrEditPreview {
    WrJob *job;
    WrField *field; /* newest result; owned */
    WrError err;
    bool failed;
    bool rough;         /* the field is a rough result */
    bool going_on;      /* the exact result after a rough one is being requested */
    bool running_rough; /* the last request that was started is a rough one */
    Work *next;         /* waits until that one is done; owned; NULL: none */
    Slot slot;
    /* document whose composite the field is; owned; NULL: not exact, or another size */
    WrDocument *made;
    WrText notes;
    double seconds;
};

static void drop(void *arg)
{
    Work *work = arg;
    wr_document_free(work->document);
    wr_document_free(work->again);
    wr_coarse_free(work->coarse);
    wr_free(work->line);
    wr_session_free(work->session);
    wr_text_fini(&work->notes);
    wr_field_free(work->field);
    if (work->ask.dab) wr_tip_free((WrTip *)work->brush.tip); /* a shared reference of its own */
    wr_free(work);
}

/* ---- on the worker thread ---- */

typedef WrField *Runner(const WrOpInfo *op, const WrField *in, const double *param,
                        const WrOpOptions *options, WrError *err);

static bool adjust_field(const Work *work, Runner *run, WrField **field, const WrOpOptions *options,
                         WrError *err)
{
    if (!*field) return true;
    WrField *made = run(work->ask.op, *field, work->ask.param, options, err);
    if (!made) return false;
    wr_field_free(*field);
    *field = made;
    return true;
}

/* Apply an operation as in the adjust command: if texels only move, the layer's coverage moves with them. */
static bool adjust_layer(const Work *work, WrLayer *layer, const WrOpOptions *options, WrError *err)
{
    if (wr_layer_holds(layer) && !adjust_field(work, wr_op_run, &layer->heights, options, err))
        return false;
    return !work->ask.op->moves ||
           (adjust_field(work, wr_op_run_unit, &layer->cover, options, err) &&
            adjust_field(work, wr_op_run_unit, &layer->mask, options, err));
}

/* A filter layer's result is computed with the composite. */
static bool filter(const Work *work, WrDocument *document, WrError *err)
{
    WrFilter made = { .op = work->ask.op };
    memcpy(made.param, work->ask.param, sizeof made.param);
    if (!wr_filter_check(&made, err)) return false;
    if (work->ask.layer >= 0) document->layers[work->ask.layer].filter = made;
    else wr_document_add_filter(document, "", &made);
    return true;
}

static bool adjust(Work *work, WrPool *pool, const WrProgress *progress, WrError *err)
{
    WrDocument *document = work->document;
    WrOpOptions options = { .pool = pool, .progress = progress };
    if (work->ask.op->reshapes) {
        work->field = wr_op_run(work->ask.op, wr_document_composite(document, pool),
                                work->ask.param, &options, err);
        return work->field != NULL;
    }
    if (work->ask.filters) return filter(work, document, err);
    options.mask = document->selection;
    const WrLayer *active = &document->layers[document->active];
    if (!work->ask.all_layers && active->is_group && !active->on_mask)
        return wr_fail(err, "the active layer is a group, which has no heights of its own");
    if (!work->ask.all_layers && active->filter.op && !active->on_mask)
        return wr_fail(err, "the active layer is a filter layer, which has no heights of its own");
    if (!work->ask.all_layers) {
        WrStandIn stand_in = { .index = 0 };
        bool good = adjust_layer(work, wr_document_edit_begin(document, &stand_in), &options, err);
        wr_document_edit_end(document, &stand_in);
        return good;
    }
    for (int i = 0; i < document->layer_count; i++)
        if (!adjust_layer(work, &document->layers[i], &options, err)) return false;
    return true;
}

static void dab(Work *work, WrPool *pool)
{
    WrDocument *document = work->document;
    WrStandIn stand_in = { .index = 0 };
    const WrLayer *layer = wr_document_edit_begin(document, &stand_in);
    WrBrushGround ground = { .field = layer->heights,
                             .mark = layer->cover,
                             .selection = document->selection,
                             .pool = pool };
    wr_brush_dab_on(&ground, &work->brush, work->ask.u, work->ask.v);
    wr_document_edit_end(document, &stand_in);
}

static void set_layer(const WrEditPreviewRequest *ask, WrLayer *layer)
{
    layer->blend = ask->blend;
    layer->opacity = ask->opacity;
    layer->radius = ask->radius;
}

static void set_layers(const Work *work)
{
    const WrEditPreviewRequest *ask = &work->ask;
    set_layer(ask, &work->document->layers[ask->layer]);
    for (int i = 0; i < work->document->layer_count; i++)
        if (ask->also[i]) work->document->layers[i].opacity = ask->opacity;
}

static bool generate(Work *work, WrPool *pool, const WrProgress *progress)
{
    const WrEditPreviewRequest *ask = &work->ask;
    if (ask->target == WR_LINE_OF_LAYER) {
        work->document->active = ask->layer;
        set_layers(work);
    }
    return wr_edit_preview_generate(work->document, ask->line, ask->target, ask->rough, pool,
                                    progress, &work->notes, &work->err);
}

static bool run_command(Work *work, WrPool *pool)
{
    WrSession *session = work->session ? work->session : wr_session_of(work->document, pool);
    if (work->session) wr_session_let_run(session, pool);
    work->session = NULL;
    const bool good = wr_session_run(session, work->ask.command, &work->err);
    wr_document_free(work->document);
    work->document = wr_document_share(wr_session_document(session));
    wr_session_free(session);
    return good;
}

/* ---- rough results of layers on a small copy of the document (coarse_preview.h) ---- */

static bool is_setting(const WrEditPreviewRequest *ask)
{
    return !ask->line && !ask->op && !ask->dab && !ask->command;
}

static bool is_filter_change(const WrEditPreviewRequest *ask)
{
    return !ask->line && ask->op && ask->filters && ask->layer >= 0;
}

/* Generate the line of the small document's changed layer. */
static bool generate_small(Work *work, WrDocument *small, WrPool *pool, const WrProgress *progress)
{
    const WrEditPreviewRequest *ask = &work->ask;
    WrCall *call = NULL;
    if (!wr_call_parse(ask->line, false, &call, &work->err)) return false;
    const int at = wr_coarse_layer(work->coarse);
    small->active = at - 1;
    small->selection = wr_coarse_reduce(work->coarse, work->document->selection, pool);
    if (ask->target == WR_LINE_NEW_LAYER) add_layer(small, call);
    else set_layer(ask, &small->layers[at]);
    small->active = at;
    WrGenerateJob job = {
        .pool = pool, .progress = progress, .coarse = true, .note = note, .note_ctx = &work->notes
    };
    const bool good = as_layer(small, call, &job, wr_coarse_factor(work->coarse), &work->err);
    wr_call_free(call);
    return good;
}

static bool change_small(Work *work, WrDocument *small, WrPool *pool, const WrProgress *progress)
{
    const WrEditPreviewRequest *ask = &work->ask;
    if (ask->line) return generate_small(work, small, pool, progress);
    WrLayer *changed = &small->layers[wr_coarse_layer(work->coarse)];
    if (is_setting(ask)) {
        set_layer(ask, changed);
        return true;
    }
    WrFilter made = { .op = ask->op };
    memcpy(made.param, ask->param, sizeof made.param);
    if (!wr_filter_check(&made, &work->err)) return false;
    changed->filter = wr_coarse_filter(work->coarse, &made);
    return true;
}

/* True if the request has a rough result of this kind. */
static bool is_coarse(const Work *work)
{
    const WrEditPreviewRequest *ask = &work->ask;
    for (int i = 0; i < WR_LAYERS_MAX; i++)
        if (ask->also[i]) return false; /* the small copy has one changed layer */
    if (!ask->rough || wr_coarse_step(work->document) == 1) return false;
    if (!ask->line) return true;
    WrCall *call = NULL;
    if (ask->target == WR_LINE_INTO_ACTIVE || !wr_call_parse(ask->line, false, &call, NULL))
        return false;
    const WrGenerator *generator = wr_call_generator(call);
    const bool any = generator && rough_step(generator, work->document->layers[0].heights) > 1;
    wr_call_free(call);
    return any;
}

/* Puts a share of `coarse` into the slot; NULL empties it. */
static void slot_put(Slot *slot, const WrCoarse *coarse)
{
    wr_mutex_lock(&slot->lock);
    wr_coarse_free(slot->coarse);
    slot->coarse = wr_coarse_share(coarse);
    wr_mutex_unlock(&slot->lock);
}

/* The small copy for changes of layer `index`. It is made whole though the request be cancelled: the next one needs it. */
static void find_coarse(Work *work, int index, bool is_new, WrPool *pool)
{
    wr_mutex_lock(&work->slot->lock);
    work->coarse = wr_coarse_share(work->slot->coarse);
    wr_mutex_unlock(&work->slot->lock);
    if (wr_coarse_fits(work->coarse, work->document, index, is_new, pool)) return;
    wr_coarse_free(work->coarse);
    const WrProgress *whole = wr_progress_set(NULL);
    work->coarse = wr_coarse_new(work->document, index, is_new, pool);
    wr_progress_set(whole);
    slot_put(work->slot, work->coarse);
}

static void run_coarse(Work *work, WrPool *pool, const WrProgress *progress)
{
    const WrEditPreviewRequest *ask = &work->ask;
    const bool is_new = ask->line && ask->target == WR_LINE_NEW_LAYER;
    const int index = is_new ? work->document->active + 1 : ask->layer;
    find_coarse(work, index, is_new, pool);
    WrDocument *small = wr_coarse_begin(work->coarse);
    if (change_small(work, small, pool, progress))
        work->field = wr_coarse_end(work->coarse, small, pool);
    wr_document_free(small);
    if (!wr_progress_cancelled(progress)) return;
    work->cancelled = true;
    wr_field_free(work->field);
    work->field = NULL;
}

static void run(void *arg, WrPool *pool, const WrProgress *progress)
{
    Work *work = arg;
    const WrEditPreviewRequest *ask = &work->ask;
    double began = wr_clock_seconds();
    if (is_coarse(work)) {
        run_coarse(work, pool, progress);
        return;
    }
    if (ask->line) {
        bool moves = strncmp(ask->line, "transform", 9) == 0;
        if (moves ? !edit_preview_transform(work->document, ask->line, pool, progress, &work->err)
                  : !generate(work, pool, progress)) {
            work->cancelled = wr_progress_cancelled(progress);
            return;
        }
    } else if (ask->op) {
        if (!adjust(work, pool, progress, &work->err)) {
            work->cancelled = wr_progress_cancelled(progress);
            return;
        }
    } else if (ask->command) {
        if (!run_command(work, pool)) {
            work->cancelled = wr_progress_cancelled(progress);
            return;
        }
    } else if (ask->dab) {
        dab(work, pool);
    } else {
        set_layers(work);
    }
    wr_filters_forget();
    if (!work->field) work->field = wr_field_share(wr_document_composite(work->document, pool));
    if (!wr_filters_carried(&work->err)) {
        wr_field_free(work->field);
        work->field = NULL;
    }
    work->seconds = wr_clock_seconds() - began;
}

/* ---- on the window's thread ---- */

WrEditPreview *wr_edit_preview_new(int threads, Uint32 done_event)
{
    static const WrJobKind kind = { run, drop };
    WrEditPreview *trial = wr_alloc(1, sizeof *trial);
    wr_mutex_init(&trial->slot.lock);
    trial->job = wr_job_new(&kind, threads, done_event);
    return trial;
}

static void forget_next(WrEditPreview *trial)
{
    if (trial->next) drop(trial->next);
    trial->next = NULL;
}

void wr_edit_preview_free(WrEditPreview *trial)
{
    if (!trial) return;
    forget_next(trial);
    wr_job_free(trial->job);
    wr_field_free(trial->field);
    wr_document_free(trial->made);
    wr_coarse_free(trial->slot.coarse);
    wr_mutex_fini(&trial->slot.lock);
    wr_text_fini(&trial->notes);
    wr_free(trial);
}

static void forget_made(WrEditPreview *trial)
{
    wr_document_free(trial->made);
    trial->made = NULL;
}

/* A rough result that is due soon is not cancelled, so that changes in quick succession do not suppress all of them. */
static void start(WrEditPreview *trial, Work *work)
{
    double seconds;
    forget_next(trial);
    if (trial->running_rough && wr_job_busy(trial->job, NULL, &seconds) &&
        seconds < PATIENCE_SECONDS) {
        trial->next = work;
        return;
    }
    trial->running_rough = work->ask.rough;
    wr_job_start(trial->job, work);
}

void wr_edit_preview_request(WrEditPreview *trial, const WrDocument *document,
                             const WrEditPreviewRequest *ask)
{
    Work *work = wr_alloc(1, sizeof *work);
    work->document = wr_document_share(document);
    work->ask = *ask;
    const bool changes = is_setting(ask) || is_filter_change(ask);
    work->ask.rough =
        (ask->line && ask->rough) || (changes && !trial->going_on && wr_coarse_step(document) > 1);
    work->slot = &trial->slot;
    if (work->ask.rough) work->again = wr_document_share(document);
    if (ask->line) work->ask.line = work->line = wr_strdup(ask->line);
    if (ask->command) work->ask.command = work->line = wr_strdup(ask->command);
    if (ask->session) work->session = wr_session_snapshot(ask->session);
    if (ask->dab) {
        work->brush = *ask->dab;
        work->brush.preset = NULL;
        work->brush.tip = ask->dab->tip ? wr_tip_share(ask->dab->tip) : NULL;
        work->ask.dab = &work->brush;
    }
    trial->failed = false;
    forget_made(trial);
    start(trial, work);
}

void wr_edit_preview_end(WrEditPreview *trial)
{
    forget_next(trial);
    trial->running_rough = false;
    wr_job_cancel(trial->job);
    wr_field_free(trial->field);
    trial->field = NULL;
    slot_put(&trial->slot, NULL);
    forget_made(trial);
    trial->failed = trial->rough = false;
    wr_text_clear(&trial->notes);
}

void wr_edit_preview_stop(WrEditPreview *trial)
{
    forget_next(trial);
    trial->running_rough = false;
    wr_job_interrupt(trial->job);
}

/* Start the exact computation after the rough result. */
static void go_on(WrEditPreview *trial, const Work *rough)
{
    WrEditPreviewRequest ask = rough->ask;
    ask.rough = false;
    trial->going_on = true;
    wr_edit_preview_request(trial, rough->again, &ask);
    trial->going_on = false;
}

static void take(WrEditPreview *trial)
{
    Work *work = wr_job_take(trial->job);
    if (!work) return;
    if (work->field) {
        wr_field_free(trial->field);
        trial->field = work->field;
        work->field = NULL;
        WrText notes = trial->notes;
        trial->notes = work->notes;
        work->notes = notes;
        trial->rough = work->ask.rough;
        bool whole = !trial->rough && !(work->ask.op && work->ask.op->reshapes);
        forget_made(trial);
        if (whole) trial->made = wr_document_share(work->document);
        if (trial->rough && !trial->next) go_on(trial, work);
        else if (!trial->rough) trial->seconds = work->seconds;
    } else if (!work->cancelled) {
        trial->failed = true;
        trial->err = work->err;
    }
    drop(work);
    if (!trial->next) return;
    Work *next = trial->next;
    trial->next = NULL;
    start(trial, next);
}

const WrField *wr_edit_preview_field(WrEditPreview *trial)
{
    take(trial);
    return trial->field;
}

const WrDocument *wr_edit_preview_made(WrEditPreview *trial)
{
    take(trial);
    return trial->made;
}

bool wr_edit_preview_busy(WrEditPreview *trial, double *fraction, double *seconds)
{
    return wr_job_busy(trial->job, fraction, seconds);
}

bool wr_edit_preview_is_rough(WrEditPreview *trial)
{
    take(trial);
    return trial->field && trial->rough;
}

const char *wr_edit_preview_notes(WrEditPreview *trial)
{
    take(trial);
    return wr_text_get(&trial->notes);
}

double wr_edit_preview_seconds(WrEditPreview *trial)
{
    take(trial);
    return trial->seconds;
}

bool wr_edit_preview_error(WrEditPreview *trial, WrError *err)
{
    take(trial);
    bool failed = trial->failed;
    if (failed) *err = trial->err;
    trial->failed = false;
    return failed;
}
