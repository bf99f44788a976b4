#include "ui/accuracy/accuracy_work.h"
#include "ui/accuracy/accuracy_plan.h"
#include "ui/accuracy/accuracy_probe.h"
#include "ui/jobs/job.h"

#include "hardcases/hardcases.h"
#include "accuracy/illusion.h"
#include "accuracy/ladder.h"
#include "accuracy/metrics.h"
#include "accuracy/tolerance_search.h"
#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/command_table.h"
#include "document/object_tables.h"
#include "field/field.h"
#include "render/frame/frame.h"
#include "render/reference/reference.h"
#include "scene/dials.h"
#include "scene/objects.h"
#include "scene/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define REFERENCE_SAMPLES 8 /* along a side, for the error of the static view */
#define LADDER_SAMPLES 16   /* along a side, for the ladder's reference */
#define LADDER_RUNS 3
#define LADDER_BUDGET 6.0 /* seconds for timed runs */

char *wr_accuracy_base(const WrScene *scene)
{
    WrScene *bare = wr_scene_clone(scene);
    WrScene *plain = wr_scene_new();
    WrText text = { 0 };
    for (int d = 0; d < WR_DIAL_COUNT; d++) wr_dials[d].set(bare, wr_dials[d].get(plain));
    bare->tolerance = plain->tolerance;
    for (const WrCommand *const *row = wr_commands, *c; (c = *row) != NULL; row++)
        if (c->print) c->print(bare, &text);
    wr_scene_free(plain);
    wr_scene_free(bare);
    char *out = wr_strdup(wr_text_get(&text));
    wr_text_fini(&text);
    return out;
}

void wr_work_tools_fini(WrWorkTools *tools)
{
    for (int i = 0; i < 2; i++) wr_renderer_free(tools->renderer[i]);
    wr_reference_fini(&tools->kept);
    wr_free(tools->kept_of);
    *tools = (WrWorkTools){ 0 };
}

WrWork *wr_work_new(WrWorkKind kind, WrWorkTools *tools, const WrField *field, const WrScene *scene,
                    double turn_deg, int width, int height)
{
    WrWork *work = wr_alloc(1, sizeof *work);
    work->kind = kind;
    work->tools = tools;
    work->field = field ? wr_field_share(field) : NULL;
    work->scene = scene ? wr_scene_share(scene) : NULL;
    work->turn_deg = turn_deg;
    work->width = width;
    work->height = height;
    return work;
}

void wr_work_free(WrWork *work)
{
    if (!work) return;
    wr_field_free(work->field);
    wr_tables_free(work->tables);
    if (work->scene) wr_scene_free(work->scene);
    if (work->other) wr_scene_free(work->other);
    wr_free(work->values);
    wr_ladder_fini(&work->ladder);
    wr_free(work->report);
    wr_illusion_fini(&work->illusion);
    for (int i = 0; i < 2; i++) wr_free(work->bgra[i]);
    wr_free(work);
}

/* ---- pictures ---- */

static WrRenderer *renderer(WrWorkTools *tools, int i, WrPool *pool, WrError *err)
{
    if (!tools->renderer[i]) tools->renderer[i] = wr_renderer_new(pool, tools->isa, err);
    return tools->renderer[i];
}

/* Render with the dials, or with those chosen by the tolerance. */
static bool render(WrWork *work, int i, WrPool *pool, const WrFrameRequest *request, WrFrame *frame)
{
    WrRenderer *r = renderer(work->tools, i, pool, &work->err);
    if (!r) return false;
    if (i == 1 || request->normals || request->scene->tolerance.kind == WR_TOLERANCE_NONE)
        return wr_renderer_frame(r, request, frame, &work->err);
    WrChoice choice = { 0 };
    bool good = wr_tolerance_choose(r, request, &choice, frame, &work->err);
    wr_choice_fini(&choice);
    frame->plan = NULL; /* it was borrowed from the choice */
    return good;
}

static WrFrameRequest request_of(const WrWork *work, const WrProgress *progress)
{
    return (WrFrameRequest){ .field = work->field,
                             .fields = wr_tables_fields(work->tables),
                             .scene = work->scene,
                             .width = work->width,
                             .height = work->height,
                             .turn_deg = work->turn_deg,
                             .cancel = progress->cancel };
}

static bool pair(WrWork *work, WrPool *pool, const WrProgress *progress)
{
    for (int i = 0; i < 2; i++) {
        WrFrame frame;
        WrFrameRequest request = request_of(work, progress);
        if (i == 1) request.scene = work->other;
        if (!render(work, i, pool, &request, &frame)) return false;
        work->bgra[i] = wr_try_alloc((size_t)frame.width * (size_t)frame.height, 4,
                                     "the pictures to compare", &work->err);
        if (!work->bgra[i]) return false;
        const WrFrameCodes codes = wr_frame_codes_of(request.scene, false);
        wr_frame_to_srgb8(&frame, &codes, true, work->bgra[i], pool);
    }
    return true;
}

/* ---- the error ---- */

/* Largest error of R, G and B in each pixel; NAN where both pictures are empty. */
static bool keep_errors(WrWork *work, const float *rgba, const WrReference *reference)
{
    const size_t count = (size_t)reference->width * (size_t)reference->height;
    work->values = wr_try_alloc(count, sizeof *work->values, "the map of errors", &work->err);
    if (!work->values) return false;
    for (size_t i = 0; i < count; i++) {
        const float *a = rgba + 4 * i;
        const double *b = reference->rgba + 4 * i;
        double most = 0;
        for (int c = 0; c < 3; c++) most = fmax(most, fabs((double)a[c] - b[c]));
        work->values[i] = a[3] > 0 || b[3] > 0 ? (float)most : NAN;
    }
    return true;
}

/* Text of all inputs of the reference picture: the scene without dials, except dials that change the model; tables,
   rotation, size. The caller frees it. */
static char *reference_key(const WrWork *work, const WrReferenceRequest *wanted)
{
    WrText text = { 0 };
    char *base = wr_accuracy_base(work->scene);
    const WrField *field = wanted->fields ? wanted->fields[0] : work->field;
    wr_text_addf(&text, "%d %d %d %d %d %llu ", wanted->width, wanted->height, wanted->most,
                 work->scene->bump == WR_BUMP_INVARIANT, (int)work->scene->material.energy,
                 field ? (unsigned long long)wr_field_key(field) : 0ULL);
    wr_text_add_number(&text, wanted->turn_deg);
    wr_text_addf(&text, "\n%s", base);
    wr_free(base);
    return text.data;
}

/* The reference picture: the cached one if its inputs are unchanged, as when dials are varied on a static scene. With
   several objects there is no cache, since its key would be incomplete. */
static bool bring_reference(WrWork *work, const WrReferenceRequest *wanted, WrPool *pool)
{
    WrWorkTools *tools = work->tools;
    char *key = wr_scene_object_count(work->scene) == 1 ? reference_key(work, wanted) : NULL;
    if (key && tools->kept_of && strcmp(tools->kept_of, key) == 0) {
        wr_free(key);
        return true;
    }
    wr_free(tools->kept_of);
    tools->kept_of = NULL;
    if (!wr_reference_render(wanted, pool, &tools->kept, &work->err)) {
        wr_free(key);
        return false;
    }
    tools->kept_of = key;
    return true;
}

static bool compare(WrWork *work, WrPool *pool, const WrFrameRequest *request, const float *normals)
{
    WrFrame frame;
    const WrReference *reference = &work->tools->kept;
    WrReferenceRequest wanted = { .field = work->field,
                                  .fields = wr_tables_fields(work->tables),
                                  .scene = work->scene,
                                  .width = request->width,
                                  .height = request->height,
                                  .turn_deg = work->turn_deg,
                                  .first = REFERENCE_SAMPLES / 2,
                                  .most = REFERENCE_SAMPLES,
                                  .cancel = request->cancel };
    bool good = bring_reference(work, &wanted, pool) && render(work, 0, pool, request, &frame);
    if (good) {
        wr_errors_measure(frame.rgba, normals, reference, NULL, &work->errors);
        work->samples = reference->samples;
        work->change = reference->last_rms;
        good = keep_errors(work, frame.rgba, reference);
    }
    return good;
}

static bool measure_error(WrWork *work, WrPool *pool, const WrProgress *progress)
{
    WrFrame frame;
    WrFrameRequest request = request_of(work, progress);
    wr_accuracy_picture_size(work->width, work->height, WR_ERROR_SIDE, &request.width,
                             &request.height);
    work->measured_w = request.width;
    work->measured_h = request.height;
    float *normals = wr_alloc((size_t)request.width * (size_t)request.height, 3 * sizeof *normals);
    const bool chosen = work->scene->tolerance.kind != WR_TOLERANCE_NONE;
    WrFrameRequest shown = request;
    shown.normals = normals;
    bool good = (chosen || render(work, 0, pool, &shown, &frame)) &&
                compare(work, pool, &request, chosen ? NULL : normals);
    wr_free(normals);
    return good;
}

static bool climb(WrWork *work, const WrProgress *progress)
{
    WrLadderRequest request = { .field = work->field,
                                .fields = wr_tables_fields(work->tables),
                                .scene = work->scene,
                                .turn_deg = work->turn_deg,
                                .threads = 1,
                                .runs = LADDER_RUNS,
                                .most = LADDER_SAMPLES,
                                .budget = LADDER_BUDGET,
                                .axis = WR_AXIS_COUNT,
                                .progress = (WrProgress *)progress };
    wr_accuracy_picture_size(work->width, work->height, WR_LADDER_SIDE, &request.width,
                             &request.height);
    return wr_ladder_measure(&request, &work->ladder, &work->err);
}

static bool beside(WrWork *work, const WrProgress *progress)
{
    WrIllusionRequest request = { .field = work->field,
                                  .fields = wr_tables_fields(work->tables),
                                  .scene = work->scene,
                                  .turn_deg = work->turn_deg,
                                  .threads = 1,
                                  .isa = work->tools->isa,
                                  .progress = progress };
    wr_accuracy_picture_size(work->width, work->height, WR_ERROR_SIDE, &request.width,
                             &request.height);
    return wr_illusion_measure(&request, &work->illusion, &work->err);
}

static bool draw_map(WrWork *work, WrPool *pool, const WrProgress *progress)
{
    wr_accuracy_picture_size(work->width, work->height, WR_MAP_SIDE, &work->measured_w,
                             &work->measured_h);
    work->values = wr_alloc((size_t)work->measured_w * (size_t)work->measured_h, sizeof(float));
    return wr_reference_map(wr_tables_at_hand(work->tables, work->scene, work->field), work->scene,
                            work->measured_w, work->measured_h, work->turn_deg, work->map, pool,
                            progress->cancel, work->values, &work->err);
}

static bool try_cases(WrWork *work, WrPool *pool, const WrProgress *progress)
{
    WrHardRequest request = { .isa = work->tools->isa, .pool = pool, .progress = progress };
    work->report = wr_alloc(1, sizeof *work->report);
    return wr_hardcases_run(&request, work->report, &work->err);
}

static int ascending(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Percentiles limit the scale, so that silhouettes and poles do not darken the rest of a map. */
static void find_ends(WrWork *work)
{
    const size_t count = work->values ? (size_t)work->measured_w * (size_t)work->measured_h : 0;
    float *sorted = wr_alloc(count + 1, sizeof *sorted);
    size_t n = 0;
    for (size_t i = 0; i < count; i++)
        if (isfinite(work->values[i])) sorted[n++] = work->values[i];
    qsort(sorted, n, sizeof *sorted, ascending);
    if (n > 0) work->low = (double)sorted[(size_t)(0.005 * (double)(n - 1))];
    if (n > 0) work->high = (double)sorted[(size_t)(0.995 * (double)(n - 1))];
    wr_free(sorted);
}

static void run(void *arg, WrPool *pool, const WrProgress *progress)
{
    WrWork *work = arg;
    switch (work->kind) {
    case WR_WORK_ERROR: work->done = measure_error(work, pool, progress); break;
    case WR_WORK_LADDER: work->done = climb(work, progress); break;
    case WR_WORK_CASES: work->done = try_cases(work, pool, progress); break;
    case WR_WORK_ILLUSION: work->done = beside(work, progress); break;
    case WR_WORK_PAIR: work->done = pair(work, pool, progress); break;
    case WR_WORK_MAP: work->done = draw_map(work, pool, progress); break;
    case WR_WORK_PROBE: work->done = wr_accuracy_probe(work); break;
    }
    if (work->done) find_ends(work);
}

static void drop(void *arg)
{
    wr_work_free(arg);
}

const WrJobKind wr_work_jobs = { run, drop };
