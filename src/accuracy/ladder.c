/* Measurement of the rungs: interleaved times, errors against the reference. */
#include "accuracy/ladder_internal.h"

#include "base/error.h"
#include "field/scheme_list.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/scene.h"
#include "system/clock.h"
#include "system/thread.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define RUNS_LEAST 3
#define RUNS_MAX 64
#define NOISE 1.02 /* an error must be smaller by more than this factor to justify more time */

/* ---- frames ---- */

bool wr_bench_frame(const WrBench *bench, const WrScene *scene, float *normals, WrFrame *frame,
                    WrError *err)
{
    const WrLadderRequest *request = bench->request;
    WrFrameRequest wanted = { .field = request->field,
                              .fields = request->fields,
                              .scene = scene,
                              .width = request->width,
                              .height = request->height,
                              .turn_deg = request->turn_deg,
                              .normals = normals };
    return wr_renderer_frame(bench->renderer, &wanted, frame, err);
}

/* On one thread the frame's time is the thread's own work, independent of other load; on several threads it is
   wall time. */
double wr_bench_now(const WrBench *bench)
{
    return wr_pool_threads(bench->pool) == 1 ? wr_clock_thread_seconds() : wr_clock_seconds();
}

/* The first frame after a change of setting builds the data that it needs (tables, meshes, pyramids). It is not
   timed, because a user pays it only once. */
bool wr_bench_time(const WrBench *bench, const WrScene *scene, double *seconds, int64_t *shaded,
                   WrError *err)
{
    WrFrame frame;
    if (!wr_bench_frame(bench, scene, NULL, &frame, err)) return false;
    const double start = wr_bench_now(bench);
    if (!wr_bench_frame(bench, scene, NULL, &frame, err)) return false;
    *seconds = wr_bench_now(bench) - start;
    *shaded = frame.shaded;
    return true;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void wr_bench_sort(double *times, int count)
{
    qsort(times, (size_t)count, sizeof *times, ascending);
}

double wr_bench_quantile(const double *sorted, int count, double part)
{
    const double at = part * (count - 1);
    const int i = (int)at;
    const double next = sorted[i + 1 < count ? i + 1 : i];
    return sorted[i] + (at - i) * (next - sorted[i]);
}

static void settle_times(WrRung *rung, double *times, int count)
{
    wr_bench_sort(times, count);
    rung->seconds = wr_bench_quantile(times, count, 0.5);
    rung->spread =
        0.5 * (wr_bench_quantile(times, count, 0.75) - wr_bench_quantile(times, count, 0.25));
    rung->runs = count;
}

/* ---- all rungs ---- */

static bool tell(const WrLadderRequest *request, double fraction, WrError *err)
{
    if (wr_progress_step(request->progress, fraction)) return true;
    return wr_fail(err, "cancelled");
}

/* Rounds over all rungs, one after the other, so that drift of the machine affects all equally. */
static bool time_rungs(const WrBench *bench, WrScene **scenes, WrLadder *ladder, WrError *err)
{
    const WrLadderRequest *request = bench->request;
    const int wanted = request->runs > 0 ? request->runs : WR_LADDER_RUNS;
    const int runs = wanted < RUNS_MAX ? wanted : RUNS_MAX;
    double *times = wr_alloc((size_t)ladder->count * RUNS_MAX, sizeof *times);
    const double start = wr_clock_seconds();
    int done = 0;
    bool good = true;
    for (; good && done < runs; done++) {
        const double spent = wr_clock_seconds() - start;
        if (request->budget > 0 && done >= RUNS_LEAST &&
            spent * (done + 1) / done > request->budget)
            break;
        for (int i = 0; good && i < ladder->count; i++) {
            WrRung *rung = &ladder->rungs[i];
            good = tell(request, 0.4 + 0.6 * (done + (double)i / ladder->count) / runs, err);
            if (good && !rung->note.text[0])
                good = wr_bench_time(bench, scenes[i], &times[i * RUNS_MAX + done], &rung->shaded,
                                     err);
        }
    }
    for (int i = 0; good && i < ladder->count; i++)
        if (!ladder->rungs[i].note.text[0])
            settle_times(&ladder->rungs[i], times + i * RUNS_MAX, done);
    wr_free(times);
    return good;
}

/* The error with all axes except one at their best: that axis' own share. */
static bool share_of(const WrBench *bench, const WrReference *reference, WrAxis axis,
                     const WrSetting *setting, double *rms, WrError *err)
{
    WrFrame frame;
    WrErrors errors;
    WrScene *best = wr_ladder_best_but(bench->request->scene, axis);
    WrScene *scene = wr_setting_apply(setting, best);
    const bool good = wr_bench_frame(bench, scene, NULL, &frame, err);
    if (good) {
        wr_errors_measure(frame.rgba, NULL, reference, NULL, &errors);
        *rms = errors.rms;
    }
    wr_scene_free(scene);
    wr_scene_free(best);
    return good;
}

static bool own_error(const WrBench *bench, const WrLadder *ladder, WrRung *rung, WrError *err)
{
    rung->own_rms = NAN;
    if (rung->axis == WR_AXIS_COUNT || rung->model) return true;
    return share_of(bench, &ladder->reference, rung->axis, &rung->setting, &rung->own_rms, err);
}

/* The error of the scene's own arithmetic. */
static bool arithmetic_as_it_stands(const WrBench *bench, WrLadder *ladder, WrError *err)
{
    const WrSetting none = { 0 };
    bool any = false;
    for (int i = 0; i < ladder->count; i++) any |= ladder->rungs[i].axis == WR_AXIS_ARITHMETIC;
    ladder->arithmetic_rms = NAN;
    return !any || share_of(bench, &ladder->reference, WR_AXIS_ARITHMETIC, &none,
                            &ladder->arithmetic_rms, err);
}

/* The error of the rung's own picture, and of its normals if it has one sample a pixel. */
static bool error_of(const WrBench *bench, const WrScene *scene, WrLadder *ladder, WrRung *rung,
                     WrFrame *frame, WrError *err)
{
    if (!wr_bench_frame(bench, scene, bench->normals, frame, err) ||
        !wr_bench_frame(bench, scene, NULL, frame, err))
        return false;
    wr_errors_measure(frame->rgba, bench->normals, &ladder->reference, NULL, &rung->errors);
    return true;
}

/* A rung that cannot be rendered stores the error and keeps its place. The first rung is the scene itself;
   without it there is no result. */
static bool measure_errors(const WrBench *bench, WrScene **scenes, WrLadder *ladder, WrError *err)
{
    const WrLadderRequest *request = bench->request;
    for (int i = 0; i < ladder->count; i++) {
        WrRung *rung = &ladder->rungs[i];
        if (!tell(request, 0.3 + 0.1 * i / ladder->count, err)) return false;
        WrFrame frame;
        WrError *why = &rung->note;
        bool good = error_of(bench, scenes[i], ladder, rung, &frame, why);
        if (good && request->seen &&
            !request->seen(request->ctx, rung, frame.rgba, &ladder->reference, err))
            return false;
        good = good && own_error(bench, ladder, rung, why);
        if (!good && i == 0) {
            *err = *why;
            return false;
        }
    }
    return true;
}

/* ---- claim of the paper ---- */

/* Noise in place of the colour picture of a scene that has none: fetches from it cost the same. */
static WrImage *stand_in(const WrField *field, WrError *err)
{
    const int width = wr_field_width(field), height = wr_field_height(field);
    WrImage *image = wr_image_new(width, height, 3, err);
    uint32_t state = 1;
    for (int64_t i = 0; image && i < (int64_t)width * height * 3; i++) {
        state = state * 1664525u + 1013904223u;
        image->data[i] = (float)(state >> 8) * 0x1p-24f;
    }
    return image;
}

/* Median frame times of the scene without bump and picture, with the picture, and with the bump. */
static bool measure_claim(const WrBench *bench, WrLadder *ladder, WrError *err)
{
    const WrScene *scene = bench->request->scene;
    WrImage *colour =
        scene->colour ? wr_image_share(scene->colour) : stand_in(bench->request->field, err);
    if (!colour) return false;
    WrScene *kinds[3];
    double times[3][WR_LADDER_RUNS];
    WrRung rung;
    int64_t shaded;
    bool good = true;
    for (int k = 0; k < 3; k++) {
        kinds[k] = wr_scene_clone(scene);
        if (kinds[k]->colour) wr_image_free(kinds[k]->colour);
        kinds[k]->colour = k == 1 ? wr_image_share(colour) : NULL;
        kinds[k]->bump = k == 2 ? WR_BUMP_BLINN : WR_BUMP_NONE;
        kinds[k]->scheme = WR_SCHEME_CENTRAL;
    }
    for (int run = 0; good && run < WR_LADDER_RUNS; run++)
        for (int k = 0; good && k < 3; k++)
            good = wr_bench_time(bench, kinds[k], &times[k][run], &shaded, err);
    double median[3] = { 1, 1, 1 };
    for (int k = 0; k < 3; k++) {
        if (good) settle_times(&rung, times[k], WR_LADDER_RUNS), median[k] = rung.seconds;
        wr_scene_free(kinds[k]);
    }
    wr_image_free(colour);
    ladder->blinn_phong = good ? median[2] / median[0] : NAN;
    ladder->blinn_colour = good ? median[2] / median[1] : NAN;
    return good;
}

bool wr_bench_reference(const WrLadderRequest *request, WrPool *pool, WrReference *out,
                        WrError *err)
{
    WrReferenceRequest wanted = { .field = request->field,
                                  .fields = request->fields,
                                  .scene = request->scene,
                                  .width = request->width,
                                  .height = request->height,
                                  .turn_deg = request->turn_deg,
                                  .most = request->most,
                                  .cancel = request->progress ? request->progress->cancel : NULL };
    return tell(request, 0, err) && wr_reference_render(&wanted, pool, out, err);
}

/* The reference must be converged to a tenth of the smallest reported error; else it is reported as not
   converged. */
static void judge_reference(WrLadder *ladder)
{
    double smallest = INFINITY;
    for (int i = 0; i < ladder->count; i++) {
        const WrRung *rung = &ladder->rungs[i];
        if (!rung->note.text[0] && !rung->model && rung->errors.rms > 0)
            smallest = fmin(smallest, rung->errors.rms);
    }
    ladder->reference.converged = ladder->reference.last_rms <= 0.1 * smallest;
}

static bool measure_all(WrBench *bench, WrScene **scenes, WrLadder *ladder, WrError *err)
{
    if (!measure_errors(bench, scenes, ladder, err) ||
        !arithmetic_as_it_stands(bench, ladder, err) || !time_rungs(bench, scenes, ladder, err) ||
        !measure_claim(bench, ladder, err))
        return false;
    judge_reference(ladder);
    wr_ladder_front(ladder);
    wr_ladder_faults(ladder, bench->request->scene);
    return true;
}

static void name_whole(const WrScene *scene, WrRung *rung)
{
    WrText text = { 0 };
    WrScene *with = wr_setting_apply(&rung->setting, scene);
    wr_setting_present(with, &text);
    snprintf(rung->full, sizeof rung->full, "%s", wr_text_get(&text));
    wr_scene_free(with);
    wr_text_fini(&text);
}

static void list_rungs(const WrLadderRequest *request, WrLadder *ladder)
{
    ladder->count = wr_ladder_settings(request->scene, request->axis, NULL, 0);
    ladder->rungs = wr_alloc((size_t)ladder->count, sizeof *ladder->rungs);
    wr_ladder_settings(request->scene, request->axis, ladder->rungs, ladder->count);
    for (int i = 0; i < ladder->count; i++) name_whole(request->scene, &ladder->rungs[i]);
    ladder->width = request->width;
    ladder->height = request->height;
}

bool wr_ladder_measure(const WrLadderRequest *request, WrLadder *out, WrError *err)
{
    WrLadder ladder = { 0 };
    WrPool *all = wr_pool_new(0), *one = wr_pool_new(1);
    WrPin pin;
    WrBench bench = { .request = request, .pool = request->threads == 1 ? one : all };
    bool good = wr_bench_reference(request, all, &ladder.reference, err);
    bench.renderer = good ? wr_renderer_new(bench.pool, NULL, err) : NULL;
    good = bench.renderer != NULL;
    if (good) {
        list_rungs(request, &ladder);
        ladder.threads = wr_pool_threads(bench.pool);
        bench.normals = wr_try_alloc((size_t)request->width * (size_t)request->height,
                                     3 * sizeof(float), "normals", err);
        WrScene **scenes = wr_alloc((size_t)ladder.count, sizeof *scenes);
        for (int i = 0; i < ladder.count; i++)
            scenes[i] = wr_setting_apply(&ladder.rungs[i].setting, request->scene);
        const bool pinned = request->threads == 1 && wr_thread_pin(&pin);
        good = bench.normals && measure_all(&bench, scenes, &ladder, err);
        if (pinned) wr_thread_unpin(&pin);
        for (int i = 0; i < ladder.count; i++) wr_scene_free(scenes[i]);
        wr_free(scenes);
    }
    wr_free(bench.normals);
    wr_renderer_free(bench.renderer);
    wr_pool_free(one);
    wr_pool_free(all);
    if (!good) {
        wr_ladder_fini(&ladder);
        return false;
    }
    wr_ladder_fini(out);
    *out = ladder;
    return true;
}

void wr_ladder_fini(WrLadder *ladder)
{
    wr_reference_fini(&ladder->reference);
    wr_free(ladder->rungs);
    *ladder = (WrLadder){ 0 };
}

static bool counts(const WrRung *rung)
{
    return !rung->model && !rung->note.text[0];
}

void wr_ladder_front(WrLadder *ladder)
{
    for (int i = 0; i < ladder->count; i++) {
        WrRung *rung = &ladder->rungs[i];
        rung->front = counts(rung);
        for (int k = 0; rung->front && k < ladder->count; k++) {
            const WrRung *other = &ladder->rungs[k];
            if (k == i || !counts(other)) continue;
            const bool as_near = other->errors.rms <= NOISE * rung->errors.rms;
            const bool faster =
                other->seconds < rung->seconds || (other->seconds == rung->seconds && k < i);
            rung->front = !(as_near && faster);
        }
    }
}
