/* The words of `wrinkle bench`, and the measurements behind each. */
#include "api/doc.h"
#include "base/error.h"
#include "base/text.h"
#include "bench/bench.h"
#include "bench/sections.h"
#include "cli/cli.h"

#include <stdio.h>
#include <string.h>

/* A measurement that stands alone. */
typedef struct Part {
    const char *name;
    bool (*table)(const WrCli *cli, bool quick, WrText *text, WrError *err);
    bool (*lines)(const WrCli *cli, bool quick, WrText *text,
                  WrError *err); /* of --lines; NULL: none */
    bool json;                   /* --json holds the lines */
} Part;

static bool generate_table(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    return wr_bench_generate(cli, quick, false, text, err);
}

static bool generate_lines(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    return wr_bench_generate(cli, quick, true, text, err);
}

static bool edits_table(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    return wr_bench_live_layers(cli, quick, text, err) && wr_bench_edits(cli, quick, text, err);
}

static const Part parts[] = {
    { "generate", generate_table, generate_lines, true },
    { "brushes", wr_bench_brush_table, wr_bench_brush_lines, false },
    { "edits", edits_table, NULL, false },
    { "moments", wr_bench_moments, NULL, false },
    { "promises", wr_bench_promises, NULL, false },
    { "scale", wr_bench_scale, NULL, false },
    { "start", wr_bench_start, NULL, false },
    { "window", wr_bench_window, NULL, false },
};
#define PARTS ((int)(sizeof parts / sizeof *parts))

typedef struct Options {
    bool lines, exact, quick;
    const Part *part;  /* NULL: none stands alone */
    uint64_t sections; /* bit i: wr_bench_section_table[i] */
} Options;

/* Section names, parts, then the other words that `bench` accepts. */
static const char *word_at(const void *ctx, int i)
{
    static const char *const others[] = { "all", "--lines", "--exact", "--quick", NULL };
    (void)ctx;
    int sections = 0;
    while (wr_bench_section_table[sections].name) sections++;
    return i < sections           ? wr_bench_section_table[i].name
           : i < sections + PARTS ? parts[i - sections].name
                                  : others[i - sections - PARTS];
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

static const Part *find_part(const char *word)
{
    for (int i = 0; i < PARTS; i++)
        if (strcmp(parts[i].name, word) == 0) return &parts[i];
    return NULL;
}

static bool read_word(const char *word, Options *options, WrError *err)
{
    const int section = find_section(word);
    const Part *part = find_part(word);
    if (section >= 0) options->sections |= (uint64_t)1 << section;
    else if (strcmp(word, "all") == 0) options->sections = ~(uint64_t)0;
    else if (strcmp(word, "--lines") == 0) options->lines = true;
    else if (strcmp(word, "--exact") == 0) options->exact = true;
    else if (strcmp(word, "--quick") == 0) options->quick = true;
    else if (!part) return unknown_word(word, err);
    else if (options->part && options->part != part)
        return wr_fail(err, "bench: %s stands alone, without other parts", part->name);
    else options->part = part;
    return true;
}

static bool read_options(const WrCli *cli, Options *options, WrError *err)
{
    *options = (Options){ .sections = 0 };
    for (int i = 0; i < cli->word_count; i++)
        if (!read_word(cli->words[i], options, err)) return false;
    const Part *part = options->part;
    if (cli->json && !options->sections && !part)
        options->sections = ~(uint64_t)0, options->lines = true;
    if (part && options->sections)
        return wr_fail(err, "bench: %s stands alone, without other parts", part->name);
    if (part && !part->lines && (cli->json || options->lines))
        return wr_fail(err, "bench: %s has neither --json nor --lines", part->name);
    if (part && !part->json && cli->json)
        return wr_fail(err, "bench: %s has no --json; --lines is for programs", part->name);
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

static bool bench_table(const WrCli *cli, const Options *options, WrText *text, WrError *err)
{
    const bool quick = options->quick;
    if (!wr_bench_frame_table(cli, quick, options->exact, text, err)) return false;
    wr_text_add(text, "\n");
    return wr_bench_sections(cli, ~(uint64_t)0, quick, options->exact, text, err) &&
           wr_bench_strokes(cli, quick, text, err) && wr_bench_brush_table(cli, quick, text, err) &&
           wr_bench_generate(cli, quick, false, text, err) && edits_table(cli, quick, text, err) &&
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
    if (good && options->part) good = options->part->lines(cli, options->quick, &lines, err);
    else if (good && options->lines) good = bench_lines(cli, options, &lines, err);
    if (good && (options->part || options->lines)) {
        wr_text_addf(text, "%s\"lines\": ", options->sections ? ",\n" : "");
        wr_bench_lines_json(wr_text_get(&lines), text);
    }
    wr_text_add(text, "}\n");
    wr_text_fini(&lines);
    return good;
}

static bool bench_part(const WrCli *cli, const Options *options, WrText *text, WrError *err)
{
    const Part *part = options->part;
    return (options->lines ? part->lines : part->table)(cli, options->quick, text, err);
}

int wr_cli_bench(const WrCli *cli)
{
    WrError err = { "" };
    Options options;
    WrText text = { 0 };
    if (!read_options(cli, &options, &err)) return wr_cli_fail(cli, WR_EXIT_USAGE, &err);
    bool good = cli->json          ? bench_json(cli, &options, &text, &err)
                : options.sections ? bench_sections(cli, &options, &text, &err)
                : options.part     ? bench_part(cli, &options, &text, &err)
                : options.lines    ? bench_lines(cli, &options, &text, &err)
                                   : bench_table(cli, &options, &text, &err);
    int status = good ? wr_cli_print(cli, &text) : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    wr_text_fini(&text);
    return status;
}
