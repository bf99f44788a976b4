/* Parser of the shell line: options and words. */
#include "cli/cli.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/command_line.h"
#include "export/export.h"
#include "system/path.h"

#include <limits.h>
#include <stddef.h>
#include <string.h>

typedef bool (*SetOption)(WrCli *cli, const char *value, WrError *err);

/* ---- values ---- */

static bool parse_whole(const char *text, size_t length, int low, int high, int *out)
{
    double value;
    if (!wr_number_parse(text, length, &value)) return false;
    if (!(value >= low && value <= high) || value != (double)(int)value) return false;
    *out = (int)value;
    return true;
}

static bool set_threads(WrCli *cli, const char *value, WrError *err)
{
    if (parse_whole(value, strlen(value), 1, 256, &cli->threads)) return true;
    return wr_fail(err, "--threads %.40s: must be a whole number, 1..256", value);
}

static bool set_do(WrCli *cli, const char *value, WrError *err)
{
    (void)err;
    cli->dos[cli->do_count++] = value;
    return true;
}

static bool set_out(WrCli *cli, const char *value, WrError *err)
{
    if (!*value) return wr_fail(err, "-o: the file name is empty");
    cli->out = value;
    return true;
}

static bool set_live(WrCli *cli, const char *value, WrError *err)
{
    if (!*value) return wr_fail(err, "--live: the folder's name is empty");
    cli->live = value;
    return true;
}

/* The ending of a file's name, with or without its dot. */
static bool set_format(WrCli *cli, const char *value, WrError *err)
{
    cli->format = value + (*value == '.');
    const size_t length =
        strspn(cli->format, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789");
    if (length > 0 && length < 16 && !cli->format[length]) return true;
    return wr_fail(err, "--format %.40s: must be the ending of a file's name, as png or exr",
                   value);
}

static bool set_jobs(WrCli *cli, const char *value, WrError *err)
{
    if (parse_whole(value, strlen(value), 1, 256, &cli->jobs)) return true;
    return wr_fail(err, "--jobs %.40s: must be a whole number, 1..256", value);
}

static bool set_size(WrCli *cli, const char *value, WrError *err)
{
    const char *x = strchr(value, 'x');
    cli->sized = true;
    if (x && parse_whole(value, (size_t)(x - value), 1, 16384, &cli->width) &&
        parse_whole(x + 1, strlen(x + 1), 1, 16384, &cli->height))
        return true;
    return wr_fail(err, "--size %.40s: must be WxH, two whole numbers of pixels, each 1..16384",
                   value);
}

/* "A-B" */
static bool parse_span(const char *option, const char *value, int most, int *first, int *last,
                       WrError *err)
{
    const char *dash = strchr(value, '-');
    if (dash && parse_whole(value, (size_t)(dash - value), 0, most, first) &&
        parse_whole(dash + 1, strlen(dash + 1), 0, most, last) && *first <= *last)
        return true;
    return wr_fail(err, "%s %.40s: must be A-B, two whole numbers, 0 <= A <= B <= %d", option,
                   value, most);
}

static bool set_frames(WrCli *cli, const char *value, WrError *err)
{
    cli->framed = true;
    return parse_span("--frames", value, 999999, &cli->first, &cli->last, err);
}

static bool set_rows(WrCli *cli, const char *value, WrError *err)
{
    cli->banded = true;
    return parse_span("--rows", value, 65535, &cli->first_row, &cli->last_row, err);
}

static bool set_of(WrCli *cli, const char *value, WrError *err)
{
    if (parse_whole(value, strlen(value), 1, 1000000, &cli->of)) return true;
    return wr_fail(err, "--of %.40s: must be a whole number, 1..1000000", value);
}

static bool set_fps(WrCli *cli, const char *value, WrError *err)
{
    if (wr_number_parse(value, strlen(value), &cli->fps) && cli->fps >= 0.1 && cli->fps <= 240)
        return true;
    return wr_fail(err, "--fps %.40s: must be frames a second, 0.1..240", value);
}

static bool set_loop(WrCli *cli, const char *value, WrError *err)
{
    cli->looped = true;
    if (parse_whole(value, strlen(value), 0, 65535, &cli->loop)) return true;
    return wr_fail(err, "--loop %.40s: must be how often it is played, 0 (for ever) to 65535",
                   value);
}

static bool set_memory(WrCli *cli, const char *value, WrError *err)
{
    if (wr_number_parse(value, strlen(value), &cli->memory) && cli->memory >= 1 &&
        cli->memory <= 1e6)
        return true;
    return wr_fail(err, "--memory %.40s: must be MB, 1..1e6", value);
}

/* Angle of a single picture. */
static bool set_angle(WrCli *cli, const char *value, WrError *err)
{
    cli->turned = true;
    if (wr_number_parse(value, strlen(value), &cli->turn_deg) && cli->turn_deg >= -1e6 &&
        cli->turn_deg <= 1e6)
        return true;
    return wr_fail(err, "--turn %.40s: must be degrees, -1e6..1e6", value);
}

static bool set_turn(WrCli *cli, const char *value, WrError *err)
{
    cli->turned = true;
    if (wr_number_parse(value, strlen(value), &cli->turn_deg) && cli->turn_deg >= -1e6 &&
        cli->turn_deg <= 1e6)
        return true;
    return wr_fail(err, "--turn %.40s: must be degrees a frame, -1e6..1e6", value);
}

static bool set_at(WrCli *cli, const char *value, WrError *err)
{
    (void)err;
    cli->ats[cli->at_count++] = value;
    return true;
}

static bool set_face(WrCli *cli, const char *value, WrError *err)
{
    if (parse_whole(value, strlen(value), 0, 5, &cli->face)) return true;
    return wr_fail(err, "--face %.40s: must be a whole number, 0..5", value);
}

static bool set_sheet(WrCli *cli, const char *value, WrError *err)
{
    if (!*value) return wr_fail(err, "--sheet: the file name is empty");
    cli->sheet = value;
    return true;
}

static bool set_thumbnails(WrCli *cli, const char *value, WrError *err)
{
    if (!*value) return wr_fail(err, "--thumbnails: the folder's name is empty");
    cli->thumbnails = value;
    return true;
}

static bool set_map(WrCli *cli, const char *value, WrError *err)
{
    if (!*value) return wr_fail(err, "--map: the file name is empty");
    cli->map = value;
    return true;
}

static bool set_runs(WrCli *cli, const char *value, WrError *err)
{
    if (parse_whole(value, strlen(value), 3, 64, &cli->runs)) return true;
    return wr_fail(err, "--runs %.40s: must be a whole number, 3..64", value);
}

static bool set_budget(WrCli *cli, const char *value, WrError *err)
{
    if (wr_number_parse(value, strlen(value), &cli->budget) && cli->budget > 0 &&
        cli->budget <= 86400)
        return true;
    return wr_fail(err, "--budget %.40s: must be seconds, above 0, at most 86400", value);
}

static bool set_csv(WrCli *cli, const char *value, WrError *err)
{
    if (!*value) return wr_fail(err, "--csv: the file name is empty");
    cli->csv = value;
    return true;
}

static bool set_plot(WrCli *cli, const char *value, WrError *err)
{
    if (!*value) return wr_fail(err, "--plot: the file name is empty");
    cli->plots[cli->plot_count++] = value;
    return true;
}

static bool set_differences(WrCli *cli, const char *value, WrError *err)
{
    if (!*value) return wr_fail(err, "--differences: the folder's name is empty");
    cli->differences = value;
    return true;
}

static bool set_tolerance(WrCli *cli, const char *value, WrError *err)
{
    (void)err;
    cli->tolerances[cli->tolerance_count++] = value;
    return true;
}

/* ---- the options ---- */

static const struct Option {
    const char *name, *other; /* other spelling, or NULL */
    const char *value;        /* name of the value in help; NULL: no value */
    WrOption bit;
    const char *help;
    SetOption set;
    /* where set is NULL: offset of the text that becomes the value, or of the flag that becomes
       true */
    size_t member;
} options[] = {
    { "-o", "--output", "OUT", WR_OPTION_OUT, "output file; - is standard output", .set = set_out },
    { "--format", NULL, "ENDING", WR_OPTION_FORMAT,
      "file format for -o - and -o FOLDER: png, exr, ... (png; exr for floats)",
      .set = set_format },
    { "-j", "--jobs", "N", WR_OPTION_FILES,
      "number of inputs processed at once; they share the threads (1)", .set = set_jobs },
    { "--as", NULL, "KIND", WR_OPTION_AS, "kind of export; `wrinkle help export` lists the kinds",
      .member = offsetof(WrCli, kind) },
    { "--watch", NULL, NULL, WR_OPTION_AS,
      "keep running, and write again when FILE or a file that it reads changes",
      .member = offsetof(WrCli, watch) },
    { "--live", NULL, "FOLDER", WR_OPTION_LIVE,
      "write the maps of FILE into FOLDER, and again after each change, like *Live* in *Export "
      "maps*",
      .set = set_live },
    { "--as", NULL, "KIND", WR_OPTION_LIVE,
      "maps for --live: a set, or a kind of export (default: the last choice for FILE, or blender)",
      .member = offsetof(WrCli, kind) },
    { "--as", NULL, "KIND", WR_OPTION_CHECK,
      "content of the files: height, normal, slopes or colour (default: detected)",
      .member = offsetof(WrCli, kind) },
    { "--coding", NULL, "CODING", WR_OPTION_CHECK,
      "coding of float normals: unit (0..1 stands for -1..1), signed or auto",
      .member = offsetof(WrCli, coding) },
    { "--size", NULL, "WxH", WR_OPTION_SIZE, "size of the picture in pixels (512x512)",
      .set = set_size },
    { "--size", NULL, "WxH", WR_OPTION_ACCURACY, "size of the pictures in pixels (256x256)",
      .set = set_size },
    { "--turn", NULL, "DEGREES", WR_OPTION_ACCURACY,
      "rotation of the object about the world's y axis (0)", .set = set_angle },
    { "--full", NULL, NULL, WR_OPTION_FULL,
      "also run the effects that the plan leaves out, for comparison",
      .member = offsetof(WrCli, full) },
    { "--measure", NULL, NULL, WR_OPTION_EXPLAIN,
      "also render with each effect switched, and print its cost or saving",
      .member = offsetof(WrCli, measure) },
    { "--layers", NULL, NULL, WR_OPTION_EXPLAIN,
      "print the plan of the layers instead: whether and why each was computed, time and memory",
      .member = offsetof(WrCli, layers) },
    { "--map", NULL, "FILE", WR_OPTION_MAP,
      "write a picture that shows where each effect ran; with --illusion: outline red, shading "
      "green, shadow blue",
      .set = set_map },
    { "--rows", NULL, "A-B", WR_OPTION_RENDER,
      "render only these rows, from 0 at the top, with the same pixels as in the whole picture",
      .set = set_rows },
    { "--frames", NULL, "A-B", WR_OPTION_RENDER,
      "render a turntable: #### in OUT is replaced by the frame number, or OUT is a film: gif, "
      "apng, webp, mp4",
      .set = set_frames },
    { "--of", NULL, "N", WR_OPTION_RENDER,
      "total number of frames, of which A-B are a part (default: A-B are all): the files do not "
      "depend on the division",
      .set = set_of },
    { "--turn", NULL, "DEGREES", WR_OPTION_RENDER,
      "turn per frame about the world's y axis (360 over all frames)", .set = set_turn },
    { "--fps", NULL, "N", WR_OPTION_RENDER, "frames per second of a film (25)", .set = set_fps },
    { "--loop", NULL, "N", WR_OPTION_RENDER, "number of repetitions of a film, 0: endless (0)",
      .set = set_loop },
    { "--missing", NULL, NULL, WR_OPTION_RENDER,
      "skip frames that already exist, complete and with that size and format",
      .member = offsetof(WrCli, missing) },
    { "--memory", NULL, "MB", WR_OPTION_RENDER,
      "memory for the rows of a picture, at least 64 rows (64)", .set = set_memory },
    { "--at", NULL, "U,V", WR_OPTION_AT,
      "point of the table; repeatable; - reads points from standard input", .set = set_at },
    { "--noise", NULL, "COMMAND", WR_OPTION_NOISE,
      "print the noise of that command at the points instead", .member = offsetof(WrCli, noise) },
    { "--face", NULL, "N", WR_OPTION_FACE, "face of the cube, 0..5", .set = set_face },
    { "--collection", NULL, "NAME", WR_OPTION_SHEET,
      "only presets of this collection: user, wrinkle, mypaint2, mypaint1, or mypaint for both",
      .member = offsetof(WrCli, collection) },
    { "--sheet", NULL, "FILE", WR_OPTION_SHEET, "write a picture with a stroke of each preset",
      .set = set_sheet },
    { "--thumbnails", NULL, "FOLDER", WR_OPTION_SHEET,
      "write a small picture of each preset, NAME_prev.png; without names, of the program's own "
      "presets",
      .set = set_thumbnails },
    { "--settings", NULL, NULL, WR_OPTION_SHEET,
      "print a table: the meaning of each setting of MyPaint's presets for heights",
      .member = offsetof(WrCli, settings) },
    { "--axis", NULL, "NAME", WR_OPTION_ACCURACY,
      "measure only this axis: derivative, normal, antialiasing, visibility, light or arithmetic",
      .member = offsetof(WrCli, axis) },
    { "--runs", NULL, "N", WR_OPTION_ACCURACY, "timed runs of each setting, 3..64 (9)",
      .set = set_runs },
    { "--budget", NULL, "SECONDS", WR_OPTION_ACCURACY,
      "time limit for all timed runs, of which at least 3 are made", .set = set_budget },
    { "--csv", NULL, "FILE", WR_OPTION_ACCURACY, "write the table for spreadsheets",
      .set = set_csv },
    { "--plot", NULL, "FILE", WR_OPTION_ACCURACY,
      "write error against time as a .pdf, .png or .svg; repeatable", .set = set_plot },
    { "--differences", NULL, "FOLDER", WR_OPTION_ACCURACY,
      "write a picture of the error of each setting into the folder", .set = set_differences },
    { "--tolerance", NULL, "KIND=VALUE", WR_OPTION_ACCURACY,
      "print instead: the choice for rms=VALUE or max=VALUE, and the best of all settings; "
      "repeatable",
      .set = set_tolerance },
    { "--illusion", NULL, NULL, WR_OPTION_ACCURACY,
      "measure instead: the difference of bump mapping and displacement in outline, shading and "
      "shadow",
      .member = offsetof(WrCli, illusion) },
    { "--hard-cases", NULL, NULL, WR_OPTION_ACCURACY,
      "measure instead: every hard case, with its required result and the worst value",
      .member = offsetof(WrCli, hard_cases) },
    { "--beyond", NULL, NULL, WR_OPTION_RECOVER,
      "continue after damaged or failing lines; without it, recovery stops there",
      .member = offsetof(WrCli, beyond) },
    { "--script", NULL, NULL, WR_OPTION_RECOVER,
      "write all readable commands as text instead, to OUT or standard output",
      .member = offsetof(WrCli, script) },
    { "--in-place", NULL, NULL, WR_OPTION_RECOVER,
      "save to the document's own file, if it is unchanged", .member = offsetof(WrCli, in_place) },
    { "--markdown", NULL, NULL, WR_OPTION_MARKDOWN,
      "print as Markdown for the guide: a VERB, all verbs, subcommands or effects",
      .member = offsetof(WrCli, markdown) },
    { "--completion", NULL, "SHELL", WR_OPTION_MARKDOWN,
      "print a completion script for bash, zsh or fish", .member = offsetof(WrCli, completion) },
    { "--json", NULL, NULL, WR_OPTION_JSON, "print JSON, for programs",
      .member = offsetof(WrCli, json) },
    { "--do", NULL, "COMMAND", WR_OPTION_COMMON,
      "run a command after FILE is loaded; repeatable, in order", .set = set_do },
    { "--threads", NULL, "N", WR_OPTION_COMMON, "number of threads (one per processor)",
      .set = set_threads },
    { "--isa", NULL, "NAME", WR_OPTION_COMMON, "instruction set for pictures: ref v1 v2 v3 v4 auto",
      .member = offsetof(WrCli, isa) },
    { "--help", "-h", NULL, WR_OPTION_COMMON, "print this text", .member = offsetof(WrCli, help) },
    { "--version", NULL, NULL, WR_OPTION_COMMON, "print the version",
      .member = offsetof(WrCli, version) },
};
#define OPTION_COUNT ((int)(sizeof options / sizeof *options))

/* The option that a word names: "--size", or "--size=4x4" with its value in *value. bits: accepted options. If
   several rows have the name, for different subcommands, the accepted row has priority. */
static const struct Option *find_row(const char *word, unsigned bits, const char **value)
{
    size_t length = strcspn(word, "=");
    *value = NULL;
    for (int i = 0; i < OPTION_COUNT; i++) {
        const struct Option *o = &options[i];
        if (o->bit != WR_OPTION_COMMON && !(bits >> o->bit & 1)) continue;
        if (strcmp(word, o->name) == 0 || (o->other && strcmp(word, o->other) == 0)) return o;
        if (o->value && strncmp(word, "--", 2) == 0 && word[length] == '=' &&
            strlen(o->name) == length && strncmp(word, o->name, length) == 0) {
            *value = word + length + 1;
            return o;
        }
    }
    return NULL;
}

static const struct Option *find_option(const char *word, unsigned bits, const char **value)
{
    const struct Option *row = find_row(word, bits, value);
    return row ? row : find_row(word, ~0u, value);
}

/* Spelling i of a subcommand's options: the name of each, then its other name; *row: the option. */
static const char *find_spelling(const WrSubcommand *command, int i, const struct Option **row)
{
    for (int k = 0; k < OPTION_COUNT; k++) {
        const struct Option *o = *row = &options[k];
        if (o->bit != WR_OPTION_COMMON && !(command->options >> o->bit & 1)) continue;
        if (i-- == 0) return o->name;
        if (o->other && i-- == 0) return o->other;
    }
    return NULL;
}

static const char *option_spelling(const void *ctx, int i)
{
    const struct Option *row;
    return find_spelling(ctx, i, &row);
}

/* Suggest "--size", or both spellings "-o, --output". */
static bool suggest_option(const WrSubcommand *command, const char *word, WrText *text)
{
    const struct Option *row;
    char name[64];
    int places[WR_NEAREST_MAX];
    /* part before = of --name=value */
    snprintf(name, sizeof name, "%.*s", (int)strcspn(word, "="), word);
    int count = wr_nearest(name, option_spelling, command, places);
    for (int k = 0; k < count; k++) {
        find_spelling(command, places[k], &row);
        wr_text_addf(text, "%s%s%s%s", k ? " or " : "", row->name, row->other ? ", " : "",
                     row->other ? row->other : "");
    }
    return count > 0;
}

/* The subcommands that have this option: "render or accuracy". */
static void add_takers(const char *word, WrText *text)
{
    const struct Option *row;
    const size_t length = strcspn(word, "=");
    for (const WrSubcommand *c = wr_subcommands; c->name; c++)
        for (int i = 0;; i++) {
            const char *name = find_spelling(c, i, &row);
            if (!name) break;
            if (strlen(name) == length && strncmp(name, word, length) == 0)
                wr_text_addf(text, "%s%s", text->length ? ", " : "", c->name);
        }
}

/* True if "--depth" or "--depth=16" is a setting of an export kind, which is written depth=16. */
static bool is_kind_setting(const char *word)
{
    const char *name = word + strspn(word, "-");
    const size_t length = strcspn(name, "=");
    for (int i = 0; i < WR_EXPORT_KIND_COUNT; i++)
        for (const WrExportOptionInfo *o = wr_export_kinds[i].options; o->name; o++)
            if (strlen(o->name) == length && strncmp(o->name, name, length) == 0) return true;
    return false;
}

#define ALIKE 3 /* suggestions, at most */

/* Suggest "--do 'dials samples=...' or --do '...'": the commands with an argument of the option's name, if they are few. */
static bool add_commands_of_argument(const char *word, WrText *text)
{
    const char *name = word + strspn(word, "-");
    const size_t length = strcspn(name, "=");
    WrArgSpec specs[WR_ARGS_MAX];
    int found = 0;
    for (int i = 0; i < wr_command_count; i++) {
        if (wr_commands[i]->form || wr_commands[i]->kind == WR_CLASS_OUTPUT) continue;
        const int count = wr_command_specs(wr_commands[i], -1, specs);
        for (int k = 0; k < count; k++)
            if (!specs[k].positional && strlen(specs[k].name) == length &&
                strncmp(specs[k].name, name, length) == 0)
                wr_text_addf(text, "%s--do '%s %s=...'", found++ > 0 ? " or " : "",
                             wr_commands[i]->name, specs[k].name);
    }
    return found >= 1 && found <= ALIKE;
}

static bool fail_option(const WrSubcommand *command, const char *word, WrError *err)
{
    WrText near = { 0 }, takers = { 0 };
    add_takers(word, &takers);
    if (takers.length)
        wr_fail(err, "%s: has no option %.60s (only: %s): see `wrinkle %s --help`", command->name,
                word, wr_text_get(&takers), command->name);
    else if (suggest_option(command, word, &near))
        wr_fail(err, "%s: unknown option %.60s: did you mean %s? See `wrinkle %s --help`",
                command->name, word, wr_text_get(&near), command->name);
    else if (command->options >> WR_OPTION_AS & 1 && is_kind_setting(word))
        wr_fail(err, "%s: unknown option %.60s: did you mean %.*s=VALUE, without dashes?",
                command->name, word, (int)strcspn(word + strspn(word, "-"), "="),
                word + strspn(word, "-"));
    else if (add_commands_of_argument(word, &near))
        wr_fail(err, "%s: unknown option %.60s: did you mean %s?", command->name, word,
                wr_text_get(&near));
    else
        wr_fail(err, "%s: unknown option %.60s: see `wrinkle %s --help`", command->name, word,
                command->name);
    wr_text_fini(&takers);
    wr_text_fini(&near);
    return false;
}

static const char *subcommand_name(const void *ctx, int i)
{
    (void)ctx;
    return wr_subcommands[i].name;
}

/* ---- words ---- */

/* Index in argv of the first word that is no option and may name the subcommand, or 0. */
static int find_first_word(int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        const char *value;
        if (argv[i][0] != '-' || !argv[i][1]) return i;
        if (strcmp(argv[i], "--") == 0) return 0;
        const struct Option *o = find_option(argv[i], ~0u, &value);
        if (o && o->value && !value) i++;
    }
    return 0;
}

/* name=value, a setting for export. */
static bool is_setting(const char *word)
{
    size_t n = strspn(word, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_-0123456789");
    return n > 0 && word[n] == '=';
}

static bool take_word(WrCli *cli, const char *word, WrError *err)
{
    unsigned bits = cli->command->options;
    if (bits >> WR_OPTION_ALL_WORDS & 1 || (bits >> WR_OPTION_AS & 1 && is_setting(word))) {
        cli->words[cli->word_count++] = word;
        return true;
    }
    if (bits >> WR_OPTION_FILES & 1) {
        cli->files[cli->file_count++] = word;
        cli->file = cli->files[0];
        return true;
    }
    if (cli->file && bits >> WR_OPTION_OUT & 1 && !cli->out)
        return wr_fail(err, "%.100s: one file at a time, after %.100s: did you mean -o %.100s?",
                       word, cli->file, word);
    if (cli->file && cli->do_count > 0)
        return wr_fail(err,
                       "%.100s: one file at a time, after %.100s: a command with spaces goes in "
                       "quotes, as --do 'dab 0.5,0.5'",
                       word, cli->file);
    if (cli->file) return wr_fail(err, "%.100s: one file at a time, after %.100s", word, cli->file);
    cli->file = word;
    return true;
}

static bool take_option(WrCli *cli, int argc, char **argv, int *i, int *status, WrError *err)
{
    const char *word = argv[*i], *value;
    unsigned bits = cli->command->options;
    const struct Option *o = find_option(word, bits, &value);
    bool taken = o && (o->bit == WR_OPTION_COMMON || bits >> o->bit & 1);
    if (!taken && bits >> WR_OPTION_OWN & 1) return take_word(cli, word, err);
    if (!taken) return fail_option(cli->command, word, err);
    if (o->value && !value && *i + 1 >= argc)
        return wr_fail(err, "%s: needs a value, %s: %s", o->name, o->value, o->help);
    if (o->value && !value) value = argv[++*i];
    *status = WR_EXIT_FAILED; /* invalid value */
    if (o->set) return o->set(cli, value, err);
    if (!o->value) return *(bool *)((char *)cli + o->member) = true;
    *(const char **)((char *)cli + o->member) = value;
    return true;
}

/* True if the word is a common option without its dashes. */
static bool option_of_word(const char *word)
{
    for (int i = 0; i < OPTION_COUNT; i++)
        if (options[i].bit == WR_OPTION_COMMON && strcmp(options[i].name + 2, word) == 0)
            return true;
    return false;
}

/* A first word that is neither a subcommand nor similar to a file name is a mistyped subcommand, or a verb of a
   script. */
static bool check_first_word(const char *word, WrError *err)
{
    WrFileInfo info;
    WrText near = { 0 };
    if (wr_subcommand_find(word) || strpbrk(word, "./") || wr_path_info(word, &info)) return true;
    if (wr_command_find(word))
        wr_fail(
            err,
            "unknown subcommand \"%.60s\": it is a command of scripts: `wrinkle render --do '%s "
            "...' -o OUT`, or see `wrinkle help %s`",
            word, word, word);
    else if (option_of_word(word))
        wr_fail(err, "unknown subcommand \"%.60s\": did you mean --%.60s?", word, word);
    else if (wr_suggest(word, subcommand_name, NULL, &near))
        wr_fail(err, "unknown subcommand \"%.60s\": did you mean %s? See `wrinkle --help`", word,
                wr_text_get(&near));
    else wr_fail(err, "unknown subcommand \"%.60s\": see `wrinkle --help`", word);
    wr_text_fini(&near);
    return false;
}

bool wr_cli_parse(int argc, char **argv, WrCli *cli, int *status, WrError *err)
{
    const int first = find_first_word(argc, argv);
    const int verb = first && wr_subcommand_find(argv[first]) ? first : 0;
    size_t room = (size_t)argc + 1;
    bool only_words = false, good = true;
    cli->command = verb ? wr_subcommand_find(argv[verb]) : &wr_subcommands[0];
    cli->width = cli->height = 512;
    cli->words = wr_alloc(room, sizeof *cli->words);
    cli->files = wr_alloc(room, sizeof *cli->files);
    cli->dos = wr_alloc(room, sizeof *cli->dos);
    cli->ats = wr_alloc(room, sizeof *cli->ats);
    cli->plots = wr_alloc(room, sizeof *cli->plots);
    cli->tolerances = wr_alloc(room, sizeof *cli->tolerances);
    *status = WR_EXIT_USAGE;
    good = !first || check_first_word(argv[first], err);
    for (int i = 1; i < argc && good; i++) {
        *status = WR_EXIT_USAGE;
        if (i == verb) continue;
        if (!only_words && strcmp(argv[i], "--") == 0) only_words = true;
        else if (!only_words && argv[i][0] == '-' && argv[i][1])
            good = take_option(cli, argc, argv, &i, status, err);
        else good = take_word(cli, argv[i], err);
    }
    if (!good) return false;
    *status = WR_EXIT_USAGE;
    if (!verb) cli->command = cli->help ? NULL : cli->command;
    return true;
}

void wr_cli_fini(WrCli *cli)
{
    wr_free(cli->words);
    wr_free(cli->files);
    wr_free(cli->dos);
    wr_free(cli->ats);
    wr_free(cli->plots);
    wr_free(cli->tolerances);
}

/* ---- help ---- */

bool wr_cli_option(const WrSubcommand *command, bool common, int i, const char *out[4])
{
    for (int k = 0; k < OPTION_COUNT; k++) {
        const struct Option *o = &options[k];
        bool taken =
            o->bit == WR_OPTION_COMMON ? common : !common && command->options >> o->bit & 1;
        if (!taken || i-- > 0) continue;
        out[0] = o->name;
        out[1] = o->other;
        out[2] = o->value;
        out[3] = o->help;
        return true;
    }
    return false;
}
