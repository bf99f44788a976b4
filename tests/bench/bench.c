/* The words of `wrinkle bench`, and the measurements behind each. */
#include "api/doc.h"
#include "base/error.h"
#include "base/text.h"
#include "bench/bench.h"
#include "bench/sections.h"
#include "cli/cli.h"

#include <stdio.h>
#include <string.h>

typedef struct Options {
    bool lines, exact, quick, made, brushes, edits, moments, promises, start, window;
    uint64_t sections; /* bit i: wr_bench_section_table[i] */
} Options;

/* Section names, then the other words that `bench` accepts. */
static const char *word_at(const void *ctx, int i)
{
    static const char *const others[] = { "generate", "brushes", "edits",   "moments",
                                          "promises", "start",   "window",  "all",
                                          "--lines",  "--exact", "--quick", NULL };
    (void)ctx;
    int parts = 0;
    while (wr_bench_section_table[parts].name) parts++;
    return i < parts ? wr_bench_section_table[i].name : others[i - parts];
}

static bool unknown_word(const char *word, WrError *err)
{
    char what[100];
    snprintf(what, sizeof what, "bench: unknown word %.60s", word);
    return wr_fail_word(err, what, word, word_at, NULL);
}

static int find_section(const char *word)
{
    for (int i = 0; wr_bench_section_table[i].name; i++)
        if (strcmp(wr_bench_section_table[i].name, word) == 0) return i;
    return -1;
}

static bool read_word(const char *word, Options *options, WrError *err)
{
    const int section = find_section(word);
    if (section >= 0) options->sections |= (uint64_t)1 << section;
    else if (strcmp(word, "all") == 0) options->sections = ~(uint64_t)0;
    else if (strcmp(word, "--lines") == 0) options->lines = true;
    else if (strcmp(word, "--exact") == 0) options->exact = true;
    else if (strcmp(word, "--quick") == 0) options->quick = true;
    else if (strcmp(word, "generate") == 0) options->made = true;
    else if (strcmp(word, "brushes") == 0) options->brushes = true;
    else if (strcmp(word, "edits") == 0) options->edits = true;
    else if (strcmp(word, "moments") == 0) options->moments = true;
    else if (strcmp(word, "promises") == 0) options->promises = true;
    else if (strcmp(word, "start") == 0) options->start = true;
    else if (strcmp(word, "window") == 0) options->window = true;
    else return unknown_word(word, err);
    return true;
}

static bool read_options(const WrCli *cli, Options *options, WrError *err)
{
    *options = (Options){ .sections = 0 };
    for (int i = 0; i < cli->word_count; i++)
        if (!read_word(cli->words[i], options, err)) return false;
    const int alone = options->made + options->brushes + options->edits + options->moments +
                      options->promises + options->start + options->window;
    if (cli->json && !options->sections && !alone)
        options->sections = ~(uint64_t)0, options->lines = true;
    if (alone + (options->sections != 0) > 1)
        return wr_fail(err, "bench: %s stands alone, without other parts",
                       options->made       ? "generate"
                       : options->brushes  ? "brushes"
                       : options->edits    ? "edits"
                       : options->moments  ? "moments"
                       : options->promises ? "promises"
                       : options->start    ? "start"
                                           : "window");
    if (cli->json && options->brushes)
        return wr_fail(err, "bench: brushes has no --json; --lines is for programs");
    if ((options->window || options->edits || options->moments || options->promises ||
         options->start) &&
        (cli->json || options->lines))
        return wr_fail(err, "bench: %s has neither --json nor --lines",
                       options->window    ? "window"
                       : options->start   ? "start"
                       : options->edits   ? "edits"
                       : options->moments ? "moments"
                                          : "promises");
    if ((cli->sized && !options->sections) || (options->sections && options->lines && !cli->json))
        return wr_fail(err, cli->sized ? "bench: --size is of the parts: name one, or all"
                                       : "bench: --lines beside parts needs --json");
    return wr_api_check_instruction_set(cli->isa, err);
}

static bool bench_sections(const WrCli *cli, const Options *options, WrText *text, WrError *err)
{
    return wr_bench_sections(cli, options->sections, options->quick, options->exact, text, err);
}

/* One line per measurement, for programs. */
static bool bench_lines(const WrCli *cli, const Options *options, WrText *text, WrError *err)
{
    return wr_bench_frame_lines(cli, options->quick, options->exact, text, err) &&
           wr_bench_brush_lines(cli, options->quick, text, err) &&
           wr_bench_generate(cli, options->quick, true, text, err);
}

static bool bench_edits(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    return wr_bench_live_layers(cli, quick, text, err) && wr_bench_edits(cli, quick, text, err);
}

static bool bench_table(const WrCli *cli, const Options *options, WrText *text, WrError *err)
{
    const bool quick = options->quick;
    if (!wr_bench_frame_table(cli, quick, options->exact, text, err)) return false;
    wr_text_add(text, "\n");
    return wr_bench_sections(cli, ~(uint64_t)0, quick, options->exact, text, err) &&
           wr_bench_strokes(cli, quick, text, err) && wr_bench_brush_table(cli, quick, text, err) &&
           wr_bench_generate(cli, quick, false, text, err) && bench_edits(cli, quick, text, err) &&
           wr_bench_files(quick, text, err) && wr_bench_start(cli, quick, text, err) &&
           wr_bench_window(cli, quick, text, err);
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
                : options.brushes  ? bench_brushes(cli, &options, &text, &err)
                : options.edits    ? bench_edits(cli, options.quick, &text, &err)
                : options.moments  ? wr_bench_moments(cli, options.quick, &text, &err)
                : options.promises ? wr_bench_promises(cli, options.quick, &text, &err)
                : options.start    ? wr_bench_start(cli, options.quick, &text, &err)
                : options.window   ? wr_bench_window(cli, options.quick, &text, &err)
                : options.lines    ? bench_lines(cli, &options, &text, &err)
                                   : bench_table(cli, &options, &text, &err);
    int status = good ? wr_cli_print(cli, &text) : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    wr_text_fini(&text);
    return status;
}
