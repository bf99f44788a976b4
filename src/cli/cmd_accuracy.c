#include "accuracy/illusion.h"
#include "accuracy/accuracy_benchmark.h"
#include "accuracy/report.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "cli/cli.h"
#include "command/session.h"
#include "document/document.h"
#include "document/object_tables.h"
#include "hardcases/hardcases.h"
#include "image/image.h"
#include "scene/scene.h"
#include "system/path.h"
#include "system/process.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- illusion run ---- */

static bool illusion_check(const WrCli *cli, WrError *err)
{
    if (cli->map && !cli->illusion)
        return wr_fail(err, "--map: accuracy writes the map of --illusion alone");
    if (cli->illusion && (cli->hard_cases || cli->tolerance_count > 0 || cli->csv ||
                          cli->plot_count > 0 || cli->differences))
        return wr_fail(err, "--illusion: goes with --size, --turn, --map and --json alone");
    return !cli->map || wr_image_can_write(cli->map, WR_PIXEL_U8, 3, true, err);
}

static bool write_map(const WrIllusion *it, const char *path, WrError *err)
{
    const size_t pixels = (size_t)it->width * (size_t)it->height;
    uint8_t *rgb = wr_try_alloc(pixels, 3, "the map", err);
    if (!rgb) return false;
    for (size_t i = 0; i < pixels; i++) wr_illusion_colour(it, i, rgb + 3 * i);
    const bool good =
        wr_image_write_pixels(path, it->width, it->height, 3, WR_PIXEL_U8, true, rgb, err);
    wr_free(rgb);
    return good;
}

/* Measure the picture of that request, write the map and append the result to text. name: of the document. */
static bool illusion_run(const WrCli *cli, const WrAccuracyBenchmarkRequest *request,
                         const char *name, WrText *text, WrError *err)
{
    const WrIllusionRequest wanted = { .fields = request->fields,
                                       .field = request->field,
                                       .scene = request->scene,
                                       .width = request->width,
                                       .height = request->height,
                                       .turn_deg = request->turn_deg,
                                       .threads = cli->threads,
                                       .isa = cli->isa,
                                       .progress = request->progress };
    WrIllusion it = { 0 };
    const bool good =
        wr_illusion_measure(&wanted, &it, err) && (!cli->map || write_map(&it, cli->map, err));
    if (good && cli->json) wr_illusion_json(&it, name, text);
    else if (good) wr_illusion_text(&it, name, text);
    wr_illusion_fini(&it);
    return good;
}

#define FULL_SCALE 0.1 /* linear intensity shown as white in all difference pictures */
#define LARGEST 4096   /* largest side of the reference in pixels */

/* Words accepted by --axis: prefixes of the axis labels. */
static const char *const axis_words[] = { "derivative", "normal", "antialiasing",
                                          "visibility", "light",  "arithmetic",
                                          NULL };

/* The axis of a word ("antialiasing", "derivative"); WR_AXIS_COUNT for NULL; -1 for an unknown word. */
static int find_axis(const char *word)
{
    if (!word) return WR_AXIS_COUNT;
    const size_t length = strlen(word);
    for (int i = 0; i < WR_AXIS_COUNT; i++)
        if (length > 0 && strncmp(wr_axis_labels[i], word, length) == 0) return i;
    return -1;
}

/* ---- difference pictures ---- */

typedef struct Differences {
    const char *folder;
    int count;
    uint8_t *rgb; /* [height][width][3] */
} Differences;

/* FOLDER/07-aa-filter.png: the setting with a dash for everything except letters and digits. */
static void difference_name(const Differences *to, const WrRung *rung, WrText *path)
{
    WrText setting = { 0 };
    wr_setting_print(&rung->setting, &setting);
    for (char *c = setting.data; *c; c++)
        if (!strchr("abcdefghijklmnopqrstuvwxyz0123456789.", *c)) *c = '-';
    wr_text_addf(path, "%s/%02d-%s.png", to->folder, to->count, wr_text_get(&setting));
    wr_text_fini(&setting);
}

static bool write_difference(void *ctx, const WrRung *rung, const float *rgba,
                             const WrReference *reference, WrError *err)
{
    Differences *to = ctx;
    WrText path = { 0 };
    if (!to->rgb) to->rgb = wr_alloc((size_t)reference->width * (size_t)reference->height, 3);
    difference_name(to, rung, &path);
    wr_errors_picture(rgba, reference, FULL_SCALE, to->rgb);
    const bool good = wr_image_write_pixels(wr_text_get(&path), reference->width, reference->height,
                                            3, WR_PIXEL_U8, false, to->rgb, err);
    to->count++;
    wr_text_fini(&path);
    return good;
}

/* ---- the subcommand ---- */

static void report_progress(void *ctx, double fraction)
{
    const bool *terminal = ctx;
    if (*terminal) fprintf(stderr, "\rmeasuring, %3.0f %% ", 100 * fraction);
}

static bool check_line(const WrCli *cli, WrError *err)
{
    WrFileInfo info;
    int axis;
    if (find_axis(cli->axis) < 0)
        return wr_cli_find_word("--axis", cli->axis, wr_word_of_array, axis_words, &axis, err);
    if (cli->sized && (cli->width > LARGEST || cli->height > LARGEST))
        return wr_fail(err, "--size %dx%d: the reference takes at most %d along a side", cli->width,
                       cli->height, LARGEST);
    if (cli->differences && (!wr_path_info(cli->differences, &info) || info.kind != WR_KIND_FOLDER))
        return wr_fail(err, "--differences %.200s: is not a folder", cli->differences);
    return illusion_check(cli, err);
}

/* Write the table and its plots as one atomic set. */
static bool write_files(const WrCli *cli, const WrAccuracyBenchmark *benchmark, WrError *err)
{
    WrText csv = { 0 };
    bool good = true;
    WrFileGroup *group = wr_file_group_begin();
    if (cli->csv) {
        wr_report_csv(benchmark, &csv);
        good = wr_file_write(cli->csv, wr_text_get(&csv), csv.length, err);
    }
    for (int i = 0; good && i < cli->plot_count; i++)
        good = wr_report_plot(benchmark, wr_cli_file_name(cli), cli->plots[i], err);
    wr_text_fini(&csv);
    if (good) return wr_file_group_commit(group, err);
    wr_file_group_abort(group);
    return false;
}

/* ---- the measurements ---- */

typedef struct Work {
    WrAccuracyBenchmarkRequest request;
    WrProgress progress;
    Differences differences;
    bool terminal, faulty; /* faulty: a rung's result shows an error in the program */
    WrText text;           /* output */
    WrTables *tables;      /* prepared tables of the scene's objects; owned */
} Work;

static void prepare(const WrCli *cli, WrSession *session, Work *work)
{
    const WrDocument *document = wr_session_document(session);
    work->terminal = wr_process_has_terminal();
    work->differences.folder = cli->differences;
    work->progress = (WrProgress){ (volatile int *)cli->cancel, report_progress, &work->terminal };
    work->tables = wr_document_tables(document, document->scene, NULL, cli->pool);
    work->request =
        (WrAccuracyBenchmarkRequest){ .field = wr_document_composite(document, cli->pool),
                                      .fields = wr_tables_fields(work->tables),
                                      .scene = document->scene,
                                      .width = cli->sized ? cli->width : WR_ACCURACY_SIDE,
                                      .height = cli->sized ? cli->height : WR_ACCURACY_SIDE,
                                      .turn_deg = cli->turned ? cli->turn_deg : 0,
                                      .threads = cli->threads > 0 ? cli->threads : 1,
                                      .runs = cli->runs,
                                      .budget = cli->budget,
                                      .axis = (WrAxis)find_axis(cli->axis),
                                      .progress = &work->progress,
                                      .seen = cli->differences ? write_difference : NULL,
                                      .ctx = &work->differences };
}

static bool climb(const WrCli *cli, Work *work, WrError *err)
{
    WrAccuracyBenchmark benchmark = { 0 };
    const bool good = wr_accuracy_benchmark_measure(&work->request, &benchmark, err) &&
                      write_files(cli, &benchmark, err);
    if (good && cli->json) wr_report_json(&benchmark, wr_cli_file_name(cli), &work->text);
    else if (good) wr_report_text(&benchmark, wr_cli_file_name(cli), &work->text);
    for (int i = 0; i < benchmark.count; i++) work->faulty |= benchmark.rungs[i].fault;
    wr_accuracy_benchmark_fini(&benchmark);
    return good;
}

/* The hard cases need no document. A failing case sets exit status 1. */
static int hard_cases(const WrCli *cli)
{
    WrError err;
    WrText text = { 0 };
    WrHardReport *report = wr_alloc(1, sizeof *report);
    const WrProgress progress = { .cancel = (volatile int *)cli->cancel };
    const WrHardRequest request = { .isa = cli->isa, .pool = cli->pool, .progress = &progress };
    int status;
    if (wr_hardcases_run(&request, report, &err)) {
        if (cli->json) wr_hardcases_print_json(report, &text);
        else wr_hardcases_print(report, &text);
        status = wr_cli_print(cli, &text);
        if (report->count[WR_HARD_FAIL] > 0) status = WR_EXIT_FAILED;
    } else {
        status = wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    }
    wr_text_fini(&text);
    wr_free(report);
    return status;
}

int wr_cli_accuracy(const WrCli *cli)
{
    WrError err;
    Work work = { 0 };
    if (!check_line(cli, &err)) return wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    if (cli->hard_cases) return hard_cases(cli);
    if (cli->tolerance_count > 0) return wr_cli_contest(cli);
    WrSession *session = wr_cli_load(cli, false, &err);
    bool good = session != NULL;
    if (good) {
        wr_filters_forget();
        prepare(cli, session, &work);
        good = wr_filters_carried(&err) &&
               (cli->illusion
                    ? illusion_run(cli, &work.request, wr_cli_file_name(cli), &work.text, &err)
                    : climb(cli, &work, &err));
        if (work.terminal) fprintf(stderr, "\r                 \r");
    }
    int status = good ? wr_cli_print(cli, &work.text) : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    if (work.faulty) status = WR_EXIT_FAILED;
    wr_free(work.differences.rgb);
    wr_text_fini(&work.text);
    wr_tables_free(work.tables);
    wr_session_free(session);
    return status;
}
