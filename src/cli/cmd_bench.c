#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/suggest.h"
#include "base/text.h"
#include "cli/bench.h"
#include "cli/bench_sections.h"

#include <string.h>

#define ROWS_MAX 128

typedef struct Options {
    bool lines, exact, quick, made, brushes, window;
    uint64_t sections; /* bit i: wr_bench_sections[i] */
} Options;

/* Section names, then the other words that `bench` accepts. */
static const char *word_at(const void *ctx, int i)
{
    static const char *const others[] = { "generate", "brushes", "window",  "all",
                                          "--lines",  "--exact", "--quick", NULL };
    (void)ctx;
    int parts = 0;
    while (wr_bench_sections[parts].name) parts++;
    return i < parts ? wr_bench_sections[i].name : others[i - parts];
}

static bool unknown_word(const char *word, WrError *err)
{
    char what[100];
    snprintf(what, sizeof what, "bench: unknown word %.60s", word);
    return wr_fail_word(err, what, word, word_at, NULL);
}

static bool read_word(const char *word, Options *options, WrError *err)
{
    const int section = wr_bench_section_find(word);
    if (section >= 0) options->sections |= (uint64_t)1 << section;
    else if (strcmp(word, "all") == 0) options->sections = ~(uint64_t)0;
    else if (strcmp(word, "--lines") == 0) options->lines = true;
    else if (strcmp(word, "--exact") == 0) options->exact = true;
    else if (strcmp(word, "--quick") == 0) options->quick = true;
    else if (strcmp(word, "generate") == 0) options->made = true;
    else if (strcmp(word, "brushes") == 0) options->brushes = true;
    else if (strcmp(word, "window") == 0) options->window = true;
    else return unknown_word(word, err);
    return true;
}

static bool read_options(const WrCli *cli, Options *options, WrError *err)
{
    *options = (Options){ .sections = 0 };
    for (int i = 0; i < cli->word_count; i++)
        if (!read_word(cli->words[i], options, err)) return false;
    const int alone = options->made + options->brushes + options->window;
    if (cli->json && !options->sections && !alone)
        options->sections = ~(uint64_t)0, options->lines = true;
    if (alone + (options->sections != 0) > 1)
        return wr_fail(err, "bench: %s stands alone, without other parts",
                       options->made      ? "generate"
                       : options->brushes ? "brushes"
                                          : "window");
    if (cli->json && options->brushes)
        return wr_fail(err, "bench: brushes has no --json; --lines is for programs");
    if (options->window && (cli->json || options->lines))
        return wr_fail(err, "bench: window has neither --json nor --lines");
    if ((cli->sized && !options->sections) || (options->sections && options->lines && !cli->json))
        return wr_fail(err, cli->sized ? "bench: --size is of the parts: name one, or all"
                                       : "bench: --lines beside parts needs --json");
    return wr_cli_check_isa(cli, err);
}

static int all_threads(const WrCli *cli)
{
    return cli->threads > 0 ? cli->threads : wr_pool_threads(cli->pool);
}

static int add_rows(WrBenchRow *rows, int count, const char *surface, int size, int table,
                    int threads, const WrBenchMode *modes, int mode_count)
{
    for (int m = 0; m < mode_count; m++)
        rows[count++] = (WrBenchRow){ .surface = surface,
                                      .size = size,
                                      .mode = modes[m],
                                      .table = modes[m] == WR_BENCH_PHONG ? 0 : table,
                                      .threads = threads };
    return count;
}

/* Print 'surface view mode table threads ms', one line per measurement, for comparison with other renderers. */
static bool bench_lines(const WrCli *cli, const Options *options, WrText *text, WrError *err)
{
    static const WrBenchMode modes[] = { WR_BENCH_PHONG,        WR_BENCH_TEXTURE, WR_BENCH_BUMP,
                                         WR_BENCH_BUMP_TEXTURE, WR_BENCH_MIP,     WR_BENCH_SS16,
                                         WR_BENCH_ADAPTIVE };
    const int all = (int)(sizeof modes / sizeof *modes);
    static const char *const surfaces[] = { "sphere", "bezier" };
    static const int sizes[] = { 512, 1024, 2048 }, tables[] = { 512, 4096 };
    const int threads[] = { 1, all_threads(cli) };
    const int size_count = options->quick ? 1 : 3, table_count = options->quick ? 1 : 2;
    for (int s = 0; s < 2; s++)
        for (int z = 0; z < size_count; z++) {
            WrBenchRow rows[ROWS_MAX];
            int count = 0;
            for (int t = 0; t < (threads[1] > 1 ? 2 : 1); t++)
                for (int k = 0; k < table_count; k++)
                    count = add_rows(rows, count, surfaces[s], sizes[z], tables[k], threads[t],
                                     modes + (k > 0), k > 0 ? 4 : all);
            if (!wr_bench_run(cli, rows, count, options->quick ? 5 : 9, !options->exact, err))
                return false;
            for (int i = 0; i < count; i++)
                wr_text_addf(text, "%s %d %s %d %d %.4f\n", rows[i].surface, rows[i].size,
                             wr_bench_modes[rows[i].mode], rows[i].table, rows[i].threads,
                             rows[i].ms);
        }
    return wr_bench_brush_lines(cli, options->quick, text, err) &&
           wr_bench_generate(cli, options->quick, true, text, err);
}

static void print_frames(WrText *text, const WrBenchRow *rows, int count)
{
    wr_text_addf(text, "%-8s %-10s %-8s %7s %9s %9s %9s\n", "surface", "view", "mode", "threads",
                 "ms", "frames/s", "ns/pixel");
    for (int i = 0; i < count; i++) {
        const WrBenchRow *r = &rows[i];
        char view[32];
        snprintf(view, sizeof view, "%dx%d", r->size, r->size);
        wr_text_addf(text, "%-8s %-10s %-8s %7d %9.2f %9.0f %9.2f\n", r->surface, view,
                     r->mode == WR_BENCH_PHONG ? "smooth" : wr_bench_modes[r->mode], r->threads,
                     r->ms, 1e3 / r->ms, 1e6 * r->ms / (double)(r->covered > 0 ? r->covered : 1));
    }
}

/* Ratios to compare with the paper, section 6: bump mapping needs about 4 times as long as smooth shading and about 2
   times as long as a colour texture. */
static void print_ratios(WrText *text, const WrBenchRow *rows, int count)
{
    wr_text_addf(text, "\n%-8s %-10s %7s %12s %13s   (the paper: about 4 and 2)\n", "surface",
                 "view", "threads", "bump/smooth", "bump/texture");
    for (int i = 0; i + 2 < count; i += 3) {
        char view[32];
        snprintf(view, sizeof view, "%dx%d", rows[i].size, rows[i].size);
        wr_text_addf(text, "%-8s %-10s %7d %12.2f %13.2f\n", rows[i].surface, view, rows[i].threads,
                     rows[i + 2].ms / rows[i].ms, rows[i + 2].ms / rows[i + 1].ms);
    }
}

static bool bench_strokes(const WrCli *cli, const Options *options, WrText *text, WrError *err)
{
    static const int tables[] = { 512, 4096 };
    wr_text_addf(text, "\nstroke of radius 32   %12s %12s %14s %14s\n", "event ms", "worst ms",
                 "preview ms", "event+preview");
    for (int i = 0; i < 2; i++) {
        WrBenchStroke stroke = { .table = tables[i] };
        char table[32];
        if (!wr_bench_stroke(cli, &stroke, options->quick ? 40 : 200, err)) return false;
        snprintf(table, sizeof table, "%dx%d", stroke.table, stroke.table);
        wr_text_addf(text, "  table %-13s %12.3f %12.3f %14.2f %14.2f\n", table, stroke.apply_ms,
                     stroke.apply_worst_ms, stroke.preview_ms, stroke.apply_ms + stroke.preview_ms);
    }
    return true;
}

static bool bench_edits(const WrCli *cli, const Options *options, WrText *text, WrError *err)
{
    static const int tables[] = { 512, 4096, 16384 }, layers[] = { 1, 20 };
    wr_text_addf(text, "\ndab of 64 texels       layers %9s %12s %9s %12s %9s\n", "dab ms",
                 "composite ms", "undo ms", "composite ms", "bytes");
    static const char *const filters[] = { "filter blur sigma=3", "filter median radius=3",
                                           "filter warp", "filter curves points=0,0;0.3,0.1;1,1" };
    for (int i = 0; i < 10; i++) {
        WrBenchEdit edit = { .table = i < 6 ? tables[i / 2] : 4096,
                             .layers = i < 6 ? layers[i % 2] : 1,
                             .filter = i < 6 ? NULL : filters[i - 6] };
        char table[32];
        if (edit.filter) wr_text_addf(text, "    below %s\n", edit.filter);
        if (!wr_bench_edit(cli, &edit, options->quick ? 21 : 101, err)) return false;
        snprintf(table, sizeof table, "%dx%d", edit.table, edit.table);
        wr_text_addf(text, "  table %-13s %8d %9.3f %12.3f %9.3f %12.3f %9.0f\n", table,
                     edit.layers, edit.dab_ms, edit.composite_ms, edit.undo_ms,
                     edit.undo_composite_ms, edit.bytes);
    }
    return true;
}

static bool bench_files(const Options *options, WrText *text, WrError *err)
{
    WrBenchFile file = { .table = options->quick ? 1024 : 4096, .layers = 5 };
    if (!wr_bench_file(&file, err)) return false;
    wr_text_addf(text, "\ndocument %dx%d, %d layers: save %.2f s, load %.2f s\n", file.table,
                 file.table, file.layers, file.save_seconds, file.load_seconds);
    if (file.copy_seconds > 0)
        wr_text_addf(text, "oiiotool reading and writing the same file: %.2f s (ours %.2f s)\n",
                     file.copy_seconds, file.save_seconds + file.load_seconds);
    return true;
}

/* Run the requested sections one after another. */
static bool bench_sections(const WrCli *cli, const Options *options, WrText *text, WrError *err)
{
    WrBenchSections *all = wr_alloc(1, sizeof *all);
    all->cli = cli;
    all->width = cli->width;
    all->height = cli->height;
    all->rounds = options->quick ? 5 : 15;
    all->fast = !options->exact;
    bool good = wr_peaks_measure(cli->pool, options->quick, &all->peaks, err), any = false;
    if (good && cli->json) wr_bench_head_json(all, text);
    else if (good) wr_bench_peaks_print(all, text);
    for (int i = 0; wr_bench_sections[i].name && good; i++) {
        if (!(options->sections >> i & 1)) continue;
        good = wr_bench_section_measure(all, &wr_bench_sections[i], err);
        if (good && cli->json) wr_text_add(text, any ? ",\n" : ",\n\"sections\": [\n");
        if (good && cli->json) wr_bench_section_json(all, text);
        else if (good) wr_bench_section_print(all, text);
        any = true;
        wr_bench_section_clear(all);
    }
    if (cli->json && any) wr_text_add(text, "]");
    wr_free(all);
    return good;
}

static bool bench_table(const WrCli *cli, const Options *options, WrText *text, WrError *err)
{
    static const WrBenchMode modes[] = { WR_BENCH_PHONG, WR_BENCH_TEXTURE, WR_BENCH_BUMP };
    static const char *const surfaces[] = { "sphere", "bezier", "torus" };
    const int threads[] = { 1, all_threads(cli) };
    WrBenchRow rows[ROWS_MAX];
    int count = 0;
    for (int s = 0; s < 3; s++)
        for (int size = 512; size <= (options->quick ? 512 : 1024); size *= 2)
            for (int t = 0; t < (threads[1] > 1 ? 2 : 1); t++)
                count = add_rows(rows, count, surfaces[s], size, 512, threads[t], modes, 3);
    wr_text_addf(text, "table 512x512, %s arithmetic, medians of interleaved runs\n\n",
                 options->exact ? "exact" : "fast");
    if (!wr_bench_run(cli, rows, count, options->quick ? 5 : 15, !options->exact, err))
        return false;
    print_frames(text, rows, count);
    print_ratios(text, rows, count);
    const Options parts = { .sections = ~(uint64_t)0,
                            .quick = options->quick,
                            .exact = options->exact };
    wr_text_add(text, "\n");
    return bench_sections(cli, &parts, text, err) && bench_strokes(cli, options, text, err) &&
           wr_bench_brush_table(cli, options->quick, text, err) &&
           wr_bench_generate(cli, options->quick, false, text, err) &&
           bench_edits(cli, options, text, err) && bench_files(options, text, err) &&
           wr_bench_window(cli, options->quick, text, err);
}

/* Print one object: sections, and the output of --lines. */
static bool bench_json(const WrCli *cli, const Options *options, WrText *text, WrError *err)
{
    WrText lines = { 0 };
    bool good = true;
    wr_text_add(text, "{");
    if (options->sections) good = bench_sections(cli, options, text, err);
    if (good && options->made) good = wr_bench_generate(cli, options->quick, true, &lines, err);
    else if (good && options->lines) good = bench_lines(cli, options, &lines, err);
    if (good && (options->made || options->lines)) {
        wr_text_addf(text, "%s\"lines\": ", options->sections ? ",\n" : "");
        wr_bench_lines_json(wr_text_get(&lines), text);
    }
    wr_text_add(text, "}\n");
    wr_text_fini(&lines);
    return good;
}

static bool bench_brushes(const WrCli *cli, const Options *options, WrText *text, WrError *err)
{
    return options->lines ? wr_bench_brush_lines(cli, options->quick, text, err)
                          : wr_bench_brush_table(cli, options->quick, text, err);
}

int wr_cli_bench(const WrCli *cli)
{
    WrError err = { "" };
    Options options;
    WrText text = { 0 };
    if (!read_options(cli, &options, &err)) return wr_cli_fail(cli, WR_EXIT_USAGE, &err);
    bool good = cli->json          ? bench_json(cli, &options, &text, &err)
                : options.sections ? bench_sections(cli, &options, &text, &err)
                : options.made ? wr_bench_generate(cli, options.quick, options.lines, &text, &err)
                : options.brushes ? bench_brushes(cli, &options, &text, &err)
                : options.window  ? wr_bench_window(cli, options.quick, &text, &err)
                : options.lines   ? bench_lines(cli, &options, &text, &err)
                                  : bench_table(cli, &options, &text, &err);
    int status = good ? wr_cli_print(cli, &text) : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    wr_text_fini(&text);
    return status;
}
