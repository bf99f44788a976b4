/* `wrinkle accuracy --tolerance`: the dials that a tolerance chooses, compared with the best of all settings. */
#include "accuracy/accuracy_benchmark.h"
#include "accuracy/accuracy_benchmark_internal.h"
#include "accuracy/tolerance.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "bench/bench.h"
#include "cli/cli.h"
#include "command/session.h"
#include "document/document.h"
#include "document/object_tables.h"
#include "field/analytic.h"
#include "field/scheme_list.h"
#include "scene/scene.h"
#include "system/process.h"
#include "system/thread.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Row {
    WrTolerance tolerance;
    bool claimed;    /* the choice claimed to meet the tolerance */
    double rms, max; /* measured on the whole picture */
    bool held;       /* the measured error is within the tolerance */
    /* the last doubling of samples changed the reference by less than half of the tolerance;
       otherwise `held` is not reliable */
    bool resolved;
    double choosing;    /* seconds for choosing, first picture included */
    double seconds;     /* one more picture with the chosen dials */
    double top_seconds; /* the best setting, measured */
    /* number of pictures from which choosing is faster than the cheapest single setting; 0:
       never */
    int pays_from;
    bool found;                              /* a tested setting meets the tolerance */
    WrSetting cheapest;                      /* the cheapest such setting ... */
    double best_seconds, best_rms, best_max; /* ... its time and its errors */
} Row;

typedef struct Contest {
    Row *rows; /* [count], owned */
    int count;
    int settings; /* schemes x normals x anti-aliasing methods */
    /* Number of tested settings, from cheap to expensive. The others are expected to be slower than the cheapest one
       that meets the finest tolerance, so they cannot win. */
    int tried;
    WrReference reference;
} Contest;

#define RUNS 3       /* runs per setting, at least ... */
#define RUNS_SHORT 9 /* ... and per setting below SHORT seconds */
#define SHORT 0.02
#define TOP_SAMPLES 16 /* samples along a pixel's side in the best setting */

/* ---- all settings ---- */

typedef struct Tried {
    WrSetting setting;
    int way;         /* index of the anti-aliasing method */
    double expected; /* seconds, from one sample with its slopes and normal */
    bool known;      /* the errors are measured */
    bool timed;      /* the time is measured */
    double seconds, rms, max;
} Tried;

/* Anti-aliasing methods: number of dials, the dials, and their place. */
static const WrSetting ways[] = {
    { 1, { WR_DIAL_AA }, { WR_AA_POINT } },
    { 2, { WR_DIAL_AA, WR_DIAL_FOOTPRINT }, { WR_AA_FILTER, WR_FOOTPRINT_ANISOTROPIC } },
    { 3,
      { WR_DIAL_AA, WR_DIAL_FOOTPRINT, WR_DIAL_MOMENTS },
      { WR_AA_MOMENTS, WR_FOOTPRINT_ANISOTROPIC, WR_MOMENTS_LEAN } },
    { 2, { WR_DIAL_AA, WR_DIAL_SAMPLES }, { WR_AA_SUPERSAMPLE, 2 } },
    { 2, { WR_DIAL_AA, WR_DIAL_SAMPLES }, { WR_AA_SUPERSAMPLE, 3 } },
    { 2, { WR_DIAL_AA, WR_DIAL_SAMPLES }, { WR_AA_SUPERSAMPLE, 4 } },
    { 2, { WR_DIAL_AA, WR_DIAL_SAMPLES }, { WR_AA_SUPERSAMPLE, 6 } },
    { 2, { WR_DIAL_AA, WR_DIAL_SAMPLES }, { WR_AA_SUPERSAMPLE, 8 } },
    { 2, { WR_DIAL_AA, WR_DIAL_SAMPLES }, { WR_AA_SUPERSAMPLE, 12 } },
    { 2, { WR_DIAL_AA, WR_DIAL_SAMPLES }, { WR_AA_SUPERSAMPLE, 16 } },
    { 3, { WR_DIAL_AA, WR_DIAL_SAMPLES, WR_DIAL_CONTRAST }, { WR_AA_ADAPTIVE, 4, 0.005 } },
    { 3, { WR_DIAL_AA, WR_DIAL_SAMPLES, WR_DIAL_CONTRAST }, { WR_AA_ADAPTIVE, 8, 0.002 } },
    { 3, { WR_DIAL_AA, WR_DIAL_SAMPLES, WR_DIAL_CONTRAST }, { WR_AA_ADAPTIVE, 16, 0.002 } },
};
#define WAY_COUNT ((int)(sizeof ways / sizeof *ways))

static void put(WrSetting *setting, int dial, double value)
{
    setting->dial[setting->count] = dial;
    setting->value[setting->count++] = value;
}

/* All combinations of schemes, normals and methods, in the caller's memory; models that do not approximate the
   scene's model are left out. */
static int list_all(const WrScene *scene, Tried *out)
{
    const bool table = scene->analytic.kind == WR_ANALYTIC_OFF;
    const bool invariant = scene->bump == WR_BUMP_INVARIANT;
    int count = 0;
    for (int scheme = 0; scheme < (table ? WR_SCHEME_COUNT : 1); scheme++)
        for (int mode = 0; mode < WR_BUMP_COUNT; mode++) {
            if ((mode == WR_BUMP_INVARIANT) != invariant) continue;
            for (int way = 0; way < WAY_COUNT; way++) {
                Tried tried = { .setting = ways[way], .way = way };
                if (table) put(&tried.setting, WR_DIAL_SCHEME, scheme);
                put(&tried.setting, WR_DIAL_NORMAL, mode);
                if (out) out[count] = tried;
                count++;
            }
        }
    return count;
}

/* True if a measurement needs more runs. */
static bool wanted(const double *times, int done)
{
    return done < RUNS || (done < RUNS_SHORT && times[0] < SHORT);
}

static bool time_one(const WrBench *bench, Tried *tried, WrError *err)
{
    double times[RUNS_SHORT];
    int64_t shaded;
    int run = 0;
    bool good = true;
    if (tried->timed) return true;
    WrScene *scene = wr_setting_apply(&tried->setting, bench->request->scene);
    for (; good && wanted(times, run); run++)
        good = wr_bench_frame_seconds(bench, scene, &times[run], &shaded, err);
    wr_scene_free(scene);
    if (good) tried->seconds = wr_bench_median(times, run);
    return tried->timed = good;
}

static bool measure_one(const WrBench *bench, const WrReference *reference, Tried *tried,
                        WrError *err)
{
    WrFrame frame;
    WrErrors errors;
    if (tried->known) return true;
    WrScene *scene = wr_setting_apply(&tried->setting, bench->request->scene);
    const bool good = wr_bench_frame(bench, scene, NULL, &frame, err);
    wr_scene_free(scene);
    if (!good) return false;
    wr_errors_measure(frame.rgba, NULL, reference, NULL, &errors);
    tried->rms = errors.rms;
    tried->max = errors.max;
    return tried->known = true;
}

/* Samples per pixel of plain supersampling; 0 for other methods. */
static double samples_of(const WrSetting *way)
{
    double grid = 1;
    bool plain = true;
    for (int i = 0; i < way->count; i++) {
        if (way->dial[i] == WR_DIAL_SAMPLES) grid = way->value[i];
        if (way->dial[i] == WR_DIAL_AA)
            plain = way->value[i] == WR_AA_POINT || way->value[i] == WR_AA_SUPERSAMPLE;
    }
    return plain ? grid * grid : 0;
}

/* Expected time of each setting: a multiple of one sample per pixel with its slopes and normal. For methods other
   than plain supersampling, the factor is measured with the last scheme and normal. */
static bool expect(const WrBench *bench, Tried *tried, int count, WrError *err)
{
    double factor[WAY_COUNT], one = 0;
    const int last = count - WAY_COUNT;
    for (int way = 0; way < WAY_COUNT; way++) {
        factor[way] = samples_of(&ways[way]);
        if (way > 0 && factor[way] > 0) continue;
        if (!time_one(bench, &tried[last + way], err)) return false;
        factor[way] = tried[last + way].seconds / tried[last].seconds;
    }
    for (int i = 0; i < count; i++) {
        if (tried[i].way == 0) {
            if (!time_one(bench, &tried[i], err)) return false;
            one = tried[i].seconds;
        }
        tried[i].expected = one * factor[tried[i].way];
    }
    return true;
}

static int by_expected(const void *a, const void *b)
{
    const Tried *x = a, *y = b;
    if (x->expected != y->expected) return x->expected < y->expected ? -1 : 1;
    return (x->way > y->way) - (x->way < y->way);
}

/* ---- one tolerance ---- */

static bool within(const WrTolerance *tolerance, double rms, double max)
{
    return tolerance->kind == WR_TOLERANCE_RMS ? rms <= tolerance->value : max <= tolerance->value;
}

static bool find_cheapest(const Tried *tried, int count, Row *row)
{
    row->found = false;
    for (int i = 0; i < count; i++) {
        if (!tried[i].timed || !tried[i].known) continue;
        if (!within(&row->tolerance, tried[i].rms, tried[i].max)) continue;
        if (row->found && tried[i].seconds >= row->best_seconds) continue;
        row->found = true;
        row->cheapest = tried[i].setting;
        row->best_seconds = tried[i].seconds;
        row->best_rms = tried[i].rms;
        row->best_max = tried[i].max;
    }
    return row->found;
}

#define SLACK 1.3 /* allowed overestimate of an expected time */

/* True if the setting `at` is expected to be cheaper than the best so far, or if there is none. */
static bool may_win(const Tried *tried, int at, Row *row)
{
    return !find_cheapest(tried, at, row) || tried[at].expected < SLACK * row->best_seconds;
}

/* Test from cheap to expensive until every tolerance is met and the rest is expected to take longer: none of those
   can be the cheapest. */
static bool try_all(const WrBench *bench, const WrReference *reference, Tried *tried, int count,
                    Contest *contest, WrError *err)
{
    bool good = expect(bench, tried, count, err);
    if (good) qsort(tried, (size_t)count, sizeof *tried, by_expected);
    for (int i = 0; good && i < count; i++) {
        bool open = false, contends = false;
        for (int r = 0; r < contest->count; r++) open |= may_win(tried, i, &contest->rows[r]);
        if (!open) break;
        good = wr_progress_step(bench->request->progress, 0.1 + 0.8 * i / count) ||
               wr_fail(err, "cancelled");
        good = good && measure_one(bench, reference, &tried[i], err);
        for (int r = 0; good && r < contest->count; r++)
            contends |= within(&contest->rows[r].tolerance, tried[i].rms, tried[i].max) &&
                        may_win(tried, i, &contest->rows[r]);
        if (good && contends) good = time_one(bench, &tried[i], err);
        contest->tried = i + 1;
    }
    for (int r = 0; r < contest->count; r++) find_cheapest(tried, count, &contest->rows[r]);
    return good;
}

/* Time of the best setting, the base of the savings. */
static bool time_top(const WrBench *bench, Contest *contest, WrError *err)
{
    const WrScene *scene = bench->request->scene;
    Tried top = { .setting = {
                      2, { WR_DIAL_AA, WR_DIAL_SAMPLES }, { WR_AA_SUPERSAMPLE, TOP_SAMPLES } } };
    put(&top.setting, WR_DIAL_SCHEME, WR_SCHEME_BSPLINE_FIT);
    if (scene->bump != WR_BUMP_INVARIANT) put(&top.setting, WR_DIAL_NORMAL, WR_BUMP_EXACT);
    if (!time_one(bench, &top, err)) return false;
    for (int r = 0; r < contest->count; r++) contest->rows[r].top_seconds = top.seconds;
    return true;
}

/* Smallest number of pictures n for which choosing plus n - 1 pictures is faster than n pictures with the cheapest
   setting. */
static int pays_from(const Row *row)
{
    if (!row->found || row->choosing <= row->best_seconds) return 1;
    if (row->seconds >= row->best_seconds) return 0;
    const double count = (row->choosing - row->seconds) / (row->best_seconds - row->seconds);
    return count < 1e6 ? (int)ceil(count) : 0;
}

/* Time the chosen and the cheapest setting alternately, so that drift affects both equally. Tables built for a
   setting are paid once, before its time is measured. *frame: the chosen picture. */
static bool time_in_turn(const WrBench *bench, const WrFrameRequest *wish, const WrChoice *choice,
                         Row *row, WrFrame *frame, WrError *err)
{
    double times[RUNS_SHORT], best[RUNS_SHORT];
    int64_t shaded;
    int run = 0;
    bool good = true;
    WrScene *cheapest = row->found ? wr_setting_apply(&row->cheapest, bench->request->scene) : NULL;
    for (; good && wanted(times, run); run++) {
        if (cheapest) good = wr_bench_frame_seconds(bench, cheapest, &best[run], &shaded, err);
        good = good && wr_choice_frame(bench->renderer, wish, choice, frame, err);
        const double from = wr_bench_now(bench);
        good = good && wr_choice_frame(bench->renderer, wish, choice, frame, err);
        times[run] = wr_bench_now(bench) - from;
    }
    if (good) row->seconds = wr_bench_median(times, run);
    if (good && cheapest) row->best_seconds = wr_bench_median(best, run);
    wr_scene_free(cheapest);
    return good;
}

static bool measure_choice(const WrBench *bench, const WrReference *reference, Row *row,
                           WrError *err)
{
    const WrAccuracyBenchmarkRequest *request = bench->request;
    WrScene *scene = wr_scene_clone(request->scene);
    scene->tolerance = row->tolerance;
    WrFrameRequest wish = { .field = request->field,
                            .scene = scene,
                            .width = request->width,
                            .height = request->height,
                            .turn_deg = request->turn_deg };
    WrChoice choice = { 0 };
    WrFrame frame;
    /* Run once to build the tables, which the times of single settings do not include either. */
    bool good = wr_tolerance_choose(bench->renderer, &wish, &choice, &frame, err);
    const double start = wr_bench_now(bench);
    good = good && wr_tolerance_choose(bench->renderer, &wish, &choice, &frame, err);
    row->choosing = wr_bench_now(bench) - start;
    good = good && time_in_turn(bench, &wish, &choice, row, &frame, err);
    if (good) {
        WrErrors errors;
        wr_errors_measure(frame.rgba, NULL, reference, NULL, &errors);
        row->rms = errors.rms;
        row->max = errors.max;
        row->held = within(&row->tolerance, errors.rms, errors.max);
        row->resolved = within(&(WrTolerance){ row->tolerance.kind, 0.5 * row->tolerance.value },
                               reference->last_rms, reference->last_max);
        row->claimed = choice.met;
        row->pays_from = pays_from(row);
    }
    wr_choice_fini(&choice);
    wr_scene_free(scene);
    return good;
}

/* ---- whole contest ---- */

static bool run(const WrBench *bench, Contest *contest, WrError *err)
{
    const WrScene *scene = bench->request->scene;
    const int count = list_all(scene, NULL);
    Tried *tried = wr_alloc((size_t)count, sizeof *tried);
    list_all(scene, tried);
    contest->settings = count;
    bool good = try_all(bench, &contest->reference, tried, count, contest, err) &&
                time_top(bench, contest, err);
    for (int i = 0; good && i < contest->count; i++)
        good = measure_choice(bench, &contest->reference, &contest->rows[i], err);
    wr_free(tried);
    return good;
}

static void contest_fini(Contest *contest)
{
    wr_reference_fini(&contest->reference);
    wr_free(contest->rows);
    *contest = (Contest){ 0 };
}

/* Run on the request's scene (its own tolerance is ignored) with each of the tolerances, of kind rms or max.
   Zero-initialise *out. May test all settings: needs minutes. */
static bool contest_run(const WrAccuracyBenchmarkRequest *request, const WrTolerance *tolerances,
                        int count, Contest *out, WrError *err)
{
    Contest contest = { .count = count };
    WrPool *all = wr_pool_new(0), *one = wr_pool_new(1);
    WrBench bench = { .request = request, .pool = request->threads == 1 ? one : all };
    WrPin pin;
    contest.rows = wr_alloc((size_t)count + 1, sizeof *contest.rows);
    for (int i = 0; i < count; i++) contest.rows[i].tolerance = tolerances[i];
    bool good = wr_bench_render_reference(request, all, &contest.reference, err);
    bench.renderer = good ? wr_renderer_new(bench.pool, NULL, err) : NULL;
    good = bench.renderer != NULL;
    const bool pinned = good && request->threads == 1 && wr_thread_pin(&pin);
    good = good && run(&bench, &contest, err);
    if (pinned) wr_thread_unpin(&pin);
    wr_renderer_free(bench.renderer);
    wr_pool_free(one);
    wr_pool_free(all);
    if (!good) {
        contest_fini(&contest);
        return false;
    }
    contest_fini(out);
    *out = contest;
    return true;
}

/* ---- output ---- */

static const char *verdict(const Row *row)
{
    if (!row->claimed) return row->held ? "held, not promised" : "not promised";
    if (!row->resolved) return "unresolved";
    return row->held ? "held" : "BROKEN";
}

/* Print one line for each tolerance; JSON: one object. */
static void contest_text(const Contest *contest, const char *name, WrText *text)
{
    WrText setting = { 0 };
    wr_text_addf(text,
                 "%s: %d of %d settings tried, from cheap to dear\n%-10s %9s %9s %-18s %8s %8s %8s "
                 "%6s %9s %8s  %s\n",
                 name, contest->tried, contest->settings, "tolerance", "rms", "max", "verdict",
                 "first ms", "more ms", "best ms", "ratio", "pays from", "top ms",
                 "the cheapest single setting that meets it");
    for (int i = 0; i < contest->count; i++) {
        const Row *row = &contest->rows[i];
        char number[WR_NUMBER_SIZE];
        wr_text_clear(&setting);
        if (row->found) wr_setting_print(&row->cheapest, &setting);
        wr_text_addf(text, "%s=%-6s %9.2e %9.2e %-18s %8.2f %8.2f ",
                     wr_tolerance_names[row->tolerance.kind],
                     wr_number_print(row->tolerance.value, number), row->rms, row->max,
                     verdict(row), 1e3 * row->choosing, 1e3 * row->seconds);
        if (row->found)
            wr_text_addf(text, "%8.2f %6.2f", 1e3 * row->best_seconds,
                         row->seconds / row->best_seconds);
        else wr_text_addf(text, "%8s %6s", "-", "-");
        if (row->pays_from > 0) wr_text_addf(text, " %9d", row->pays_from);
        else wr_text_addf(text, " %9s", "never");
        wr_text_addf(text, " %8.2f  %s\n", 1e3 * row->top_seconds,
                     row->found ? wr_text_get(&setting) : "none");
    }
    wr_text_fini(&setting);
}

static void contest_json(const Contest *contest, const char *name, WrText *text)
{
    WrText setting = { 0 };
    wr_text_add(text, "{\"document\":");
    wr_text_add_json_string(text, name);
    wr_text_addf(text, ",\"settings\":%d,\"tried\":%d,\"rows\":[", contest->settings,
                 contest->tried);
    for (int i = 0; i < contest->count; i++) {
        const Row *row = &contest->rows[i];
        const struct {
            const char *name;
            double value;
        } numbers[] = { { "value", row->tolerance.value },
                        { "rms", row->rms },
                        { "max", row->max },
                        { "seconds", row->seconds },
                        { "choosing_seconds", row->choosing },
                        { "top_seconds", row->top_seconds },
                        { "pays_from", row->pays_from > 0 ? row->pays_from : NAN },
                        { "best_seconds", row->found ? row->best_seconds : NAN },
                        { "best_rms", row->found ? row->best_rms : NAN },
                        { "best_max", row->found ? row->best_max : NAN } };
        wr_text_addf(
            text,
            "%s{\"kind\":\"%s\",\"claimed\":%s,\"held\":%s,\"resolved\":%s,\"verdict\":\"%s\"",
            i > 0 ? ",\n" : "", wr_tolerance_names[row->tolerance.kind],
            row->claimed ? "true" : "false", row->held ? "true" : "false",
            row->resolved ? "true" : "false", verdict(row));
        for (size_t n = 0; n < sizeof numbers / sizeof *numbers; n++) {
            wr_text_addf(text, ",\"%s\":", numbers[n].name);
            wr_text_add_json_number(text, numbers[n].value);
        }
        wr_text_clear(&setting);
        if (row->found) wr_setting_print(&row->cheapest, &setting);
        wr_text_add(text, ",\"cheapest\":");
        wr_text_add_json_string(text, wr_text_get(&setting));
        wr_text_add(text, "}");
    }
    wr_text_add(text, "]}\n");
    wr_text_fini(&setting);
}

/* "rms=0.004" */
static bool parse_tolerance(const char *word, WrTolerance *out, WrError *err)
{
    const bool rms = strncmp(word, "rms=", 4) == 0, max = strncmp(word, "max=", 4) == 0;
    out->kind = rms ? WR_TOLERANCE_RMS : WR_TOLERANCE_MAX;
    if ((rms || max) && wr_number_parse(word + 4, strlen(word + 4), &out->value) &&
        out->value > 0 && out->value <= 1e6)
        return true;
    return wr_fail(err, "--tolerance %.40s: must be rms=VALUE or max=VALUE, above 0", word);
}

static void report_progress(void *ctx, double fraction)
{
    const bool *terminal = ctx;
    if (*terminal) fprintf(stderr, "\rmeasuring, %3.0f %% ", 100 * fraction);
}

static bool compete(const WrCli *cli, const WrDocument *document, WrText *text, WrError *err)
{
    bool terminal = wr_process_has_terminal();
    WrProgress progress = { (volatile int *)cli->cancel, report_progress, &terminal };
    WrTables *tables = wr_document_tables(document, document->scene, NULL, cli->pool);
    const WrAccuracyBenchmarkRequest request = {
        .field = wr_document_composite(document, cli->pool),
        .fields = wr_tables_fields(tables),
        .scene = document->scene,
        .width = cli->sized ? cli->width : WR_ACCURACY_SIDE,
        .height = cli->sized ? cli->height : WR_ACCURACY_SIDE,
        .turn_deg = cli->turned ? cli->turn_deg : 0,
        .threads = cli->threads > 0 ? cli->threads : 1,
        .progress = &progress
    };
    Contest contest = { 0 };
    WrTolerance *tolerances = wr_alloc((size_t)cli->tolerance_count, sizeof *tolerances);
    bool good = wr_filters_carried(err);
    for (int i = 0; good && i < cli->tolerance_count; i++)
        good = parse_tolerance(cli->tolerances[i], &tolerances[i], err);
    good = good && contest_run(&request, tolerances, cli->tolerance_count, &contest, err);
    if (terminal) fprintf(stderr, "\r                 \r");
    if (good && cli->json) contest_json(&contest, wr_cli_file_name(cli), text);
    else if (good) contest_text(&contest, wr_cli_file_name(cli), text);
    contest_fini(&contest);
    wr_free(tolerances);
    wr_tables_free(tables);
    return good;
}

int wr_cli_contest(const WrCli *cli)
{
    WrError err;
    WrText text = { 0 };
    WrSession *session = wr_cli_load(cli, false, &err);
    wr_filters_forget();
    const bool good = session && compete(cli, wr_session_document(session), &text, &err);
    const int status = good ? wr_cli_print(cli, &text) : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    wr_text_fini(&text);
    wr_session_free(session);
    return status;
}
