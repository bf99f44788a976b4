/* Measurement of the rungs: interleaved times, errors against the reference.
   A rung is a setting of one dial (or a combination). Its time and error are measured with all other dials as
   in the scene; its own error (own_rms) with all other axes at their best, so that one approximation is seen
   alone. */
#include "accuracy/accuracy_benchmark.h"

#include "accuracy/accuracy_benchmark_internal.h"
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"
#include "field/scheme_list.h"
#include "image/image.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "system/clock.h"
#include "system/thread.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- fault ---- */

/* Detection of contradictory arithmetic rungs: more bits, but farther from the reference. That is never the cost
   of an approximation but a fault of the program, and is reported as one. */

/* A smaller excess of the error is attributed to chance: roundings that add to the samples' own error. */
#define FACTOR 1.25
#define FLOOR 1e-5 /* RMS of linear intensity */

/* Rank by cost; -1: not of this axis. Of 16 bits and half precision either may be closer, depending on the
   table's level and range. */
static int dearness(int dial, double value)
{
    WR_ROWS(heights);
    static const int heights[] = { [WR_ROW(WR_HEIGHTS_DOUBLE)] = 3,
                                   [WR_ROW(WR_HEIGHTS_FLOAT)] = 2,
                                   [WR_ROW(WR_HEIGHTS_HALF)] = 1,
                                   [WR_ROW(WR_HEIGHTS_16)] = 1,
                                   [WR_ROW(WR_HEIGHTS_8)] = 1 };
    WR_ROWS_END(heights, WR_HEIGHTS_COUNT);
    WR_ROWS(shadings);
    static const int shadings[] = { [WR_ROW(WR_SHADING_DOUBLE)] = 3,
                                    [WR_ROW(WR_SHADING_FLOAT)] = 2,
                                    [WR_ROW(WR_SHADING_HALF)] = 1 };
    WR_ROWS_END(shadings, WR_SHADING_COUNT);
    WR_ROWS(arithmetics);
    static const int arithmetics[] = { [WR_ROW(WR_ARITHMETIC_EXACT)] = 2,
                                       [WR_ROW(WR_ARITHMETIC_FAST)] = 1 };
    WR_ROWS_END(arithmetics, WR_ARITHMETIC_COUNT);
    const int rung = (int)value;
    if (dial == WR_DIAL_HEIGHTS) return heights[rung];
    if (dial == WR_DIAL_SHADING) return shadings[rung];
    return dial == WR_DIAL_ARITHMETIC ? arithmetics[rung] : -1;
}

/* True for a rung of one arithmetic dial that has an own_rms. */
static bool plain(const WrRung *rung)
{
    return rung->axis == WR_AXIS_ARITHMETIC && rung->setting.count == 1 && !rung->model &&
           !rung->note.text[0] && !isnan(rung->own_rms);
}

static bool farther(double rms, double than)
{
    return rms > FACTOR * than + FLOOR;
}

static void compare(WrRung *dear, int dial, double cheap_value, double cheap_rms)
{
    if (dearness(dial, dear->setting.value[0]) <= dearness(dial, cheap_value) ||
        !farther(dear->own_rms, cheap_rms))
        return;
    dear->fault = true;
    dear->fault_than = cheap_value;
    dear->fault_rms = cheap_rms;
}

void wr_accuracy_benchmark_faults(WrAccuracyBenchmark *benchmark, const WrScene *scene)
{
    for (int i = 0; i < benchmark->count; i++) {
        WrRung *rung = &benchmark->rungs[i];
        rung->fault = false;
        if (!plain(rung)) continue;
        const int dial = rung->setting.dial[0];
        if (!isnan(benchmark->arithmetic_rms))
            compare(rung, dial, wr_dials[dial].get(scene), benchmark->arithmetic_rms);
        for (int k = 0; k < benchmark->count; k++) {
            const WrRung *other = &benchmark->rungs[k];
            if (plain(other) && other->setting.dial[0] == dial)
                compare(rung, dial, other->setting.value[0], other->own_rms);
        }
    }
}

/* "heights=double is farther from the reference than heights=float" */
bool wr_accuracy_benchmark_fault_print(const WrRung *rung, WrText *text)
{
    if (!rung->fault) return false;
    const WrDial *dial = &wr_dials[rung->setting.dial[0]];
    wr_text_addf(text, "%s=%s is farther from the reference (%.1e) than %s=%s (%.1e)", dial->name,
                 dial->choice((int)rung->setting.value[0]), rung->own_rms, dial->name,
                 dial->choice((int)rung->fault_than), rung->fault_rms);
    return true;
}

/* ---- Settings that the benchmark tries ---- */

typedef struct RungList {
    const WrScene *scene;
    WrRung *out;
    int count, room;
} RungList;

/* Adds a setting, reduced to its differences from the scene.
   Values equal to the scene's are dropped; a setting that becomes empty is the scene itself and is not listed
   twice. */
static void add(RungList *list, WrAxis axis, const WrSetting *wanted)
{
    WrRung rung = { .axis = axis };
    for (int i = 0; i < wanted->count; i++) {
        const WrDial *dial = &wr_dials[wanted->dial[i]];
        if (dial->get(list->scene) == wanted->value[i]) continue;
        rung.setting.dial[rung.setting.count] = wanted->dial[i];
        rung.setting.value[rung.setting.count++] = wanted->value[i];
        rung.model |= wanted->dial[i] == WR_DIAL_NORMAL && wanted->value[i] == WR_BUMP_INVARIANT;
    }
    if (rung.setting.count == 0) return; /* the scene's own setting is already in the list */
    if (list->count < list->room) list->out[list->count] = rung;
    list->count++;
}

/* The values of one dial: its choices, or the numbers in its row. */
static int rungs_of(const WrDial *dial, double *out, int room)
{
    int count = 0;
    for (int i = 0; dial->choices > 0 ? i < dial->choices : dial->rungs && !isnan(dial->rungs[i]);
         i++)
        if (count < room) out[count++] = dial->choices > 0 ? (double)i : dial->rungs[i];
    return count;
}

#define RUNGS_MAX 16

/* Adds the dials of that axis that become relevant by that choice: each of their values, one at a time.
   `chosen` is the scene with the setting applied: relevance depends on it (contrast matters only with
   aa=adaptive). */
static void add_dependents(RungList *list, WrAxis axis, const WrScene *chosen, WrSetting setting)
{
    double rungs[RUNGS_MAX];
    for (int d = 0; d < WR_DIAL_COUNT; d++) {
        const WrDial *dial = &wr_dials[d];
        if (dial->axis != axis || !dial->matters || !dial->matters(chosen)) continue;
        setting.dial[setting.count] = d;
        const int count = rungs_of(dial, rungs, RUNGS_MAX);
        for (int r = 0; r < count; r++) {
            if (rungs[r] == dial->get(list->scene)) continue;
            WrSetting with = setting;
            with.value[with.count++] = rungs[r];
            add(list, axis, &with);
        }
    }
}

static void add_dial(RungList *list, int id)
{
    const WrDial *dial = &wr_dials[id];
    double rungs[RUNGS_MAX];
    const int count = rungs_of(dial, rungs, RUNGS_MAX);
    const bool antialiasing = id == WR_DIAL_AA; /* the dial that others of its axis depend on */
    if (dial->axis == WR_AXIS_ANTIALIASING && !antialiasing) return;
    if (dial->matters && !dial->matters(list->scene)) return;
    for (int r = 0; r < count; r++) {
        WrSetting setting = { 1, { id }, { rungs[r] } };
        add(list, dial->axis, &setting);
        if (!antialiasing) continue;
        WrScene *chosen = wr_setting_apply(&setting, list->scene);
        add_dependents(list, dial->axis, chosen, setting);
        wr_scene_free(chosen);
    }
}

/* Combinations of approximations: the cheapest of all, the paper's with more samples, and the better slopes with
   the anti-aliasing methods. */
static const WrSetting combinations[] = {
    { 2, { WR_DIAL_NORMAL, WR_DIAL_ARITHMETIC }, { WR_BUMP_BLINN, WR_ARITHMETIC_FAST } },
    { 3,
      { WR_DIAL_SCHEME, WR_DIAL_NORMAL, WR_DIAL_ARITHMETIC },
      { WR_SCHEME_NEAREST, WR_BUMP_BLINN, WR_ARITHMETIC_FAST } },
    { 3,
      { WR_DIAL_AA, WR_DIAL_MOMENTS, WR_DIAL_FOOTPRINT },
      { WR_AA_MOMENTS, WR_MOMENTS_LEAN, WR_FOOTPRINT_ANISOTROPIC } },
    { 4,
      { WR_DIAL_SCHEME, WR_DIAL_NORMAL, WR_DIAL_AA, WR_DIAL_SAMPLES },
      { WR_SCHEME_CENTRAL, WR_BUMP_BLINN, WR_AA_SUPERSAMPLE, 4 } },
    { 5,
      { WR_DIAL_SCHEME, WR_DIAL_NORMAL, WR_DIAL_AA, WR_DIAL_SAMPLES, WR_DIAL_ARITHMETIC },
      { WR_SCHEME_CENTRAL, WR_BUMP_BLINN, WR_AA_SUPERSAMPLE, 4, WR_ARITHMETIC_FAST } },
    { 4,
      { WR_DIAL_SCHEME, WR_DIAL_NORMAL, WR_DIAL_AA, WR_DIAL_SAMPLES },
      { WR_SCHEME_CATMULL, WR_BUMP_BLINN, WR_AA_SUPERSAMPLE, 4 } },
    { 4,
      { WR_DIAL_SCHEME, WR_DIAL_NORMAL, WR_DIAL_AA, WR_DIAL_SAMPLES },
      { WR_SCHEME_BSPLINE_FIT, WR_BUMP_EXACT, WR_AA_SUPERSAMPLE, 2 } },
    { 4,
      { WR_DIAL_SCHEME, WR_DIAL_NORMAL, WR_DIAL_AA, WR_DIAL_SAMPLES },
      { WR_SCHEME_BSPLINE_FIT, WR_BUMP_EXACT, WR_AA_SUPERSAMPLE, 4 } },
    { 4,
      { WR_DIAL_SCHEME, WR_DIAL_NORMAL, WR_DIAL_AA, WR_DIAL_SAMPLES },
      { WR_SCHEME_BSPLINE_FIT, WR_BUMP_EXACT, WR_AA_SUPERSAMPLE, 8 } },
    { 5,
      { WR_DIAL_SCHEME, WR_DIAL_NORMAL, WR_DIAL_AA, WR_DIAL_SAMPLES, WR_DIAL_CONTRAST },
      { WR_SCHEME_BSPLINE_FIT, WR_BUMP_EXACT, WR_AA_ADAPTIVE, 8, 0.002 } },
    { 4,
      { WR_DIAL_SCHEME, WR_DIAL_NORMAL, WR_DIAL_AA, WR_DIAL_SAMPLES },
      { WR_SCHEME_BSPLINE_FIT, WR_BUMP_EXACT, WR_AA_SUPERSAMPLE, 16 } },
};

int wr_accuracy_benchmark_settings(const WrScene *scene, WrAxis axis, WrRung *out, int room)
{
    RungList list = { .scene = scene, .out = out, .room = room };
    if (room > 0)
        out[0] = (WrRung){ .axis = WR_AXIS_COUNT,
                           .current = true,
                           .model = scene->bump == WR_BUMP_INVARIANT };
    list.count = 1;
    for (int d = 0; d < WR_DIAL_COUNT; d++)
        if (axis == WR_AXIS_COUNT || wr_dials[d].axis == axis) add_dial(&list, d);
    for (size_t i = 0; axis == WR_AXIS_COUNT && i < sizeof combinations / sizeof *combinations; i++)
        add(&list, WR_AXIS_COUNT, &combinations[i]);
    return list.count;
}

/* The axes other than `axis` get their most accurate rung, so that the remaining error is that axis' share. */
WrScene *wr_accuracy_benchmark_best_except_axis(const WrScene *scene, WrAxis axis)
{
    WrScene *best = wr_scene_clone(scene);
    if (axis != WR_AXIS_DERIVATIVE) best->scheme = WR_SCHEME_BSPLINE_FIT;
    if (axis != WR_AXIS_NORMAL && best->bump != WR_BUMP_INVARIANT) best->bump = WR_BUMP_EXACT;
    wr_scene_set_all_slopes(best, axis != WR_AXIS_DERIVATIVE, axis != WR_AXIS_NORMAL);
    if (axis != WR_AXIS_ANTIALIASING) {
        best->dials.aa = WR_AA_SUPERSAMPLE;
        best->dials.samples = 16;
        best->dials.spread = WR_SPREAD_REGULAR;
    }
    if (axis != WR_AXIS_VISIBILITY) {
        const WrDials dials = wr_dials_default();
        best->dials.mesh = dials.mesh;
        best->dials.newton = dials.newton;
        best->dials.texels = dials.texels;
    }
    if (axis != WR_AXIS_LIGHT) {
        best->dials.harmonics = 2;
        best->dials.gloss = 64;
    }
    if (axis != WR_AXIS_ARITHMETIC) {
        best->dials.heights = WR_HEIGHTS_FLOAT;
        best->dials.shading = WR_SHADING_FLOAT;
        best->dials.arithmetic = WR_ARITHMETIC_EXACT;
    }
    return best;
}

/* ---- Dial settings: differences from a scene, applied to a scene or printed as text ---- */

WrScene *wr_setting_apply(const WrSetting *setting, const WrScene *scene)
{
    WrScene *out = wr_scene_clone(scene);
    bool scheme = false, normals = false;
    for (int i = 0; i < setting->count; i++) {
        wr_dials[setting->dial[i]].set(out, setting->value[i]);
        scheme |= setting->dial[i] == WR_DIAL_SCHEME;
        normals |= setting->dial[i] == WR_DIAL_NORMAL;
    }
    if (scheme || normals) wr_scene_set_all_slopes(out, scheme, normals);
    return out;
}

static void print_dial(const WrDial *dial, double value, WrText *text)
{
    wr_text_addf(text, "%s%s=", text->length > 0 ? " " : "", dial->name);
    if (dial->choices > 0) wr_text_add(text, dial->choice((int)value));
    else wr_text_add_number(text, value);
}

/* The scene's own setting, only the relevant dials: "scheme=central mode=blinn aa=supersample samples=4". */
static void setting_present(const WrScene *scene, WrText *text)
{
    WrScene *usual = wr_scene_new();
    for (int d = 0; d < WR_DIAL_COUNT; d++) {
        const WrDial *dial = &wr_dials[d];
        const double value = dial->get(scene);
        const bool differs = dial->axis < WR_AXIS_VISIBILITY || value != dial->get(usual);
        if (differs && (!dial->matters || dial->matters(scene))) print_dial(dial, value, text);
    }
    wr_scene_free(usual);
}

void wr_setting_print(const WrSetting *setting, WrText *text)
{
    WrText words = { 0 };
    for (int i = 0; i < setting->count; i++)
        print_dial(&wr_dials[setting->dial[i]], setting->value[i], &words);
    wr_text_add(text, setting->count > 0 ? wr_text_get(&words) : "as it stands");
    wr_text_fini(&words);
}

#define RUNS_MIN 3
#define RUNS_MAX 64
#define NOISE 1.02 /* an error must be smaller by more than this factor to justify more time */

/* ---- frames ---- */

bool wr_bench_frame(const WrBench *bench, const WrScene *scene, float *normals, WrFrame *frame,
                    WrError *err)
{
    const WrAccuracyBenchmarkRequest *request = bench->request;
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
bool wr_bench_frame_seconds(const WrBench *bench, const WrScene *scene, double *seconds,
                            int64_t *shaded, WrError *err)
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

/* Linear interpolation between order statistics, as in most statistics packages (type 7). */
double wr_bench_quantile(const double *sorted, int count, double part)
{
    const double at = part * (count - 1);
    const int i = (int)at;
    const double next = sorted[i + 1 < count ? i + 1 : i];
    return sorted[i] + (at - i) * (next - sorted[i]);
}

/* Median and half the interquartile range: a frame interrupted by other processes moves neither. */
static void settle_times(WrRung *rung, double *times, int count)
{
    wr_bench_sort(times, count);
    rung->seconds = wr_bench_quantile(times, count, 0.5);
    rung->spread =
        0.5 * (wr_bench_quantile(times, count, 0.75) - wr_bench_quantile(times, count, 0.25));
    rung->runs = count;
}

/* ---- all rungs ---- */

/* Errors need one frame per rung, times several: errors are measured first, so that a rung that cannot be
   rendered costs no time. */

static bool tell(const WrAccuracyBenchmarkRequest *request, double fraction, WrError *err)
{
    if (wr_progress_step(request->progress, fraction)) return true;
    return wr_fail(err, "cancelled");
}

/* Rounds over all rungs, one after the other, so that drift of the machine affects all equally.
   times[i RUNS_MAX + run]. Three rounds are made in any case; then the budget ends the loop before the round
   that would exceed it. */
static bool time_rungs(const WrBench *bench, WrScene **scenes, WrAccuracyBenchmark *benchmark,
                       WrError *err)
{
    const WrAccuracyBenchmarkRequest *request = bench->request;
    const int wanted = request->runs > 0 ? request->runs : WR_ACCURACY_BENCHMARK_RUNS;
    const int runs = wanted < RUNS_MAX ? wanted : RUNS_MAX;
    double *times = wr_alloc((size_t)benchmark->count * RUNS_MAX, sizeof *times);
    const double start = wr_clock_seconds();
    int done = 0;
    bool good = true;
    for (; good && done < runs; done++) {
        const double spent = wr_clock_seconds() - start;
        if (request->budget > 0 && done >= RUNS_MIN && spent * (done + 1) / done > request->budget)
            break;
        for (int i = 0; good && i < benchmark->count; i++) {
            WrRung *rung = &benchmark->rungs[i];
            good = tell(request, 0.4 + 0.6 * (done + (double)i / benchmark->count) / runs, err);
            if (good && !rung->note.text[0])
                good = wr_bench_frame_seconds(bench, scenes[i], &times[i * RUNS_MAX + done],
                                              &rung->shaded, err);
        }
    }
    for (int i = 0; good && i < benchmark->count; i++)
        if (!benchmark->rungs[i].note.text[0])
            settle_times(&benchmark->rungs[i], times + i * RUNS_MAX, done);
    wr_free(times);
    return good;
}

/* The error with all axes except one at their best: that axis' own share.
   Otherwise the error of the coarsest axis would hide all others. */
static bool share_of(const WrBench *bench, const WrReference *reference, WrAxis axis,
                     const WrSetting *setting, double *rms, WrError *err)
{
    WrFrame frame;
    WrErrors errors;
    WrScene *best = wr_accuracy_benchmark_best_except_axis(bench->request->scene, axis);
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

static bool own_error(const WrBench *bench, const WrAccuracyBenchmark *benchmark, WrRung *rung,
                      WrError *err)
{
    rung->own_rms = NAN;
    if (rung->axis == WR_AXIS_COUNT || rung->model) return true;
    return share_of(bench, &benchmark->reference, rung->axis, &rung->setting, &rung->own_rms, err);
}

/* The error of the scene's own arithmetic. */
static bool arithmetic_as_it_stands(const WrBench *bench, WrAccuracyBenchmark *benchmark,
                                    WrError *err)
{
    const WrSetting none = { 0 };
    bool any = false;
    for (int i = 0; i < benchmark->count; i++)
        any |= benchmark->rungs[i].axis == WR_AXIS_ARITHMETIC;
    benchmark->arithmetic_rms = NAN;
    return !any || share_of(bench, &benchmark->reference, WR_AXIS_ARITHMETIC, &none,
                            &benchmark->arithmetic_rms, err);
}

/* The error of the rung's own picture, and of its normals if it has one sample a pixel.
   Two frames, because normals are captured in a frame of their own: capture switches effects that change the
   path. */
static bool error_of(const WrBench *bench, const WrScene *scene, WrAccuracyBenchmark *benchmark,
                     WrRung *rung, WrFrame *frame, WrError *err)
{
    if (!wr_bench_frame(bench, scene, bench->normals, frame, err) ||
        !wr_bench_frame(bench, scene, NULL, frame, err))
        return false;
    wr_errors_measure(frame->rgba, bench->normals, &benchmark->reference, NULL, &rung->errors);
    return true;
}

/* A rung that cannot be rendered stores the error and keeps its place. The first rung is the scene itself;
   without it there is no result. */
static bool measure_errors(const WrBench *bench, WrScene **scenes, WrAccuracyBenchmark *benchmark,
                           WrError *err)
{
    const WrAccuracyBenchmarkRequest *request = bench->request;
    for (int i = 0; i < benchmark->count; i++) {
        WrRung *rung = &benchmark->rungs[i];
        if (!tell(request, 0.3 + 0.1 * i / benchmark->count, err)) return false;
        WrFrame frame;
        WrError *why = &rung->note;
        bool good = error_of(bench, scenes[i], benchmark, rung, &frame, why);
        if (good && request->seen &&
            !request->seen(request->ctx, rung, frame.rgba, &benchmark->reference, err))
            return false;
        good = good && own_error(bench, benchmark, rung, why);
        if (!good && i == 0) {
            *err = *why;
            return false;
        }
    }
    return true;
}

/* ---- claim of the paper ---- */

/* Blinn states that bump mapping costs about 4 times Phong shading and 2 times a colour texture (B18). */

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
static bool measure_claim(const WrBench *bench, WrAccuracyBenchmark *benchmark, WrError *err)
{
    const WrScene *scene = bench->request->scene;
    WrImage *colour =
        scene->colour ? wr_image_share(scene->colour) : stand_in(bench->request->field, err);
    if (!colour) return false;
    WrScene *kinds[3];
    double times[3][WR_ACCURACY_BENCHMARK_RUNS];
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
    for (int run = 0; good && run < WR_ACCURACY_BENCHMARK_RUNS; run++)
        for (int k = 0; good && k < 3; k++)
            good = wr_bench_frame_seconds(bench, kinds[k], &times[k][run], &shaded, err);
    double median[3] = { 1, 1, 1 };
    for (int k = 0; k < 3; k++) {
        if (good)
            settle_times(&rung, times[k], WR_ACCURACY_BENCHMARK_RUNS), median[k] = rung.seconds;
        wr_scene_free(kinds[k]);
    }
    wr_image_free(colour);
    benchmark->blinn_phong = good ? median[2] / median[0] : NAN;
    benchmark->blinn_colour = good ? median[2] / median[1] : NAN;
    return good;
}

bool wr_bench_render_reference(const WrAccuracyBenchmarkRequest *request, WrPool *pool,
                               WrReference *out, WrError *err)
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
static void judge_reference(WrAccuracyBenchmark *benchmark)
{
    double smallest = INFINITY;
    for (int i = 0; i < benchmark->count; i++) {
        const WrRung *rung = &benchmark->rungs[i];
        if (!rung->note.text[0] && !rung->model && rung->errors.rms > 0)
            smallest = fmin(smallest, rung->errors.rms);
    }
    benchmark->reference.converged = benchmark->reference.last_rms <= 0.1 * smallest;
}

static bool measure_all(WrBench *bench, WrScene **scenes, WrAccuracyBenchmark *benchmark,
                        WrError *err)
{
    if (!measure_errors(bench, scenes, benchmark, err) ||
        !arithmetic_as_it_stands(bench, benchmark, err) ||
        !time_rungs(bench, scenes, benchmark, err) || !measure_claim(bench, benchmark, err))
        return false;
    judge_reference(benchmark);
    wr_accuracy_benchmark_front(benchmark);
    wr_accuracy_benchmark_faults(benchmark, bench->request->scene);
    return true;
}

static void name_whole(const WrScene *scene, WrRung *rung)
{
    WrText text = { 0 };
    WrScene *with = wr_setting_apply(&rung->setting, scene);
    setting_present(with, &text);
    snprintf(rung->full, sizeof rung->full, "%s", wr_text_get(&text));
    wr_scene_free(with);
    wr_text_fini(&text);
}

static void list_rungs(const WrAccuracyBenchmarkRequest *request, WrAccuracyBenchmark *benchmark)
{
    benchmark->count = wr_accuracy_benchmark_settings(request->scene, request->axis, NULL, 0);
    benchmark->rungs = wr_alloc((size_t)benchmark->count, sizeof *benchmark->rungs);
    wr_accuracy_benchmark_settings(request->scene, request->axis, benchmark->rungs,
                                   benchmark->count);
    for (int i = 0; i < benchmark->count; i++) name_whole(request->scene, &benchmark->rungs[i]);
    benchmark->width = request->width;
    benchmark->height = request->height;
}

/* The reference uses all threads; timing uses one, pinned to a processor, if the request has threads = 1. */
bool wr_accuracy_benchmark_measure(const WrAccuracyBenchmarkRequest *request,
                                   WrAccuracyBenchmark *out, WrError *err)
{
    WrAccuracyBenchmark benchmark = { 0 };
    WrPool *all = wr_pool_new(0), *one = wr_pool_new(1);
    WrPin pin;
    WrBench bench = { .request = request, .pool = request->threads == 1 ? one : all };
    bool good = wr_bench_render_reference(request, all, &benchmark.reference, err);
    bench.renderer = good ? wr_renderer_new(bench.pool, NULL, err) : NULL;
    good = bench.renderer != NULL;
    if (good) {
        list_rungs(request, &benchmark);
        benchmark.threads = wr_pool_threads(bench.pool);
        bench.normals = wr_try_alloc((size_t)request->width * (size_t)request->height,
                                     3 * sizeof(float), "normals", err);
        WrScene **scenes = wr_alloc((size_t)benchmark.count, sizeof *scenes);
        for (int i = 0; i < benchmark.count; i++)
            scenes[i] = wr_setting_apply(&benchmark.rungs[i].setting, request->scene);
        const bool pinned = request->threads == 1 && wr_thread_pin(&pin);
        good = bench.normals && measure_all(&bench, scenes, &benchmark, err);
        if (pinned) wr_thread_unpin(&pin);
        for (int i = 0; i < benchmark.count; i++) wr_scene_free(scenes[i]);
        wr_free(scenes);
    }
    wr_free(bench.normals);
    wr_renderer_free(bench.renderer);
    wr_pool_free(one);
    wr_pool_free(all);
    if (!good) {
        wr_accuracy_benchmark_fini(&benchmark);
        return false;
    }
    wr_accuracy_benchmark_fini(out);
    *out = benchmark;
    return true;
}

void wr_accuracy_benchmark_fini(WrAccuracyBenchmark *benchmark)
{
    wr_reference_fini(&benchmark->reference);
    wr_free(benchmark->rungs);
    *benchmark = (WrAccuracyBenchmark){ 0 };
}

/* A rung is on the front unless another has at most its error, within the measurement's noise, in less time.
   Equal rungs: the first one stays. */
static bool counts(const WrRung *rung)
{
    return !rung->model && !rung->note.text[0];
}

void wr_accuracy_benchmark_front(WrAccuracyBenchmark *benchmark)
{
    for (int i = 0; i < benchmark->count; i++) {
        WrRung *rung = &benchmark->rungs[i];
        rung->front = counts(rung);
        for (int k = 0; rung->front && k < benchmark->count; k++) {
            const WrRung *other = &benchmark->rungs[k];
            if (k == i || !counts(other)) continue;
            const bool as_near = other->errors.rms <= NOISE * rung->errors.rms;
            const bool faster =
                other->seconds < rung->seconds || (other->seconds == rung->seconds && k < i);
            rung->front = !(as_near && faster);
        }
    }
}
