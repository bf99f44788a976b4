#include "base/error.h"
#include "base/text.h"
#include "cli/cli.h"
#include "command/help.h"
#include "export/export.h"
#include "export/map_sets.h"
#include "export/material_files.h"
#include "render/plan/plan.h"

#include <stdio.h>
#include <string.h>

/* ---- help text ---- */

/* Print option i as one line. */
static void add_option(WrText *text, const char *const o[4])
{
    char left[40];
    snprintf(left, sizeof left, "%s%s%s%s%s", o[0], o[1] ? ", " : "", o[1] ? o[1] : "",
             o[2] ? " " : "", o[2] ? o[2] : "");
    wr_text_addf(text, "  %-20s %s\n", left, o[3]);
}

static void add_plain_options(WrText *text, const WrSubcommand *command, bool common)
{
    const char *o[4];
    for (int i = 0; wr_cli_option(command, common, i, o); i++) add_option(text, o);
}

void wr_cli_help(const WrSubcommand *command, WrText *text)
{
    if (command) {
        wr_text_addf(text, "usage: wrinkle %s\n\n%s\n\n", command->usage, command->help);
        if (command->details) wr_text_addf(text, "%s\n\n", command->details);
        wr_text_add(text, "options:\n");
    } else {
        wr_text_add(text, "wrinkle - an interactive paint program for bump functions\n\n"
                          "usage: wrinkle [FILE]\n       wrinkle SUBCOMMAND ...\n\nsubcommands:\n");
        for (const WrSubcommand *c = wr_subcommands; c->name; c++)
            wr_text_addf(text, "  %-9s %s\n", c->name, c->help);
        wr_text_add(
            text, "\nFILE is a document (*.exr), a script (*.wrinkle) or any picture with heights; "
                  "left out, it is an\nempty 512x512 table on a plane.\n\n"
                  "options of every subcommand:\n");
    }
    if (command) add_plain_options(text, command, false);
    add_plain_options(text, &wr_subcommands[0], true);
    if (!command)
        wr_text_add(text, "\n`wrinkle help` lists the commands that scripts and --do take, "
                          "`wrinkle help VERB` describes\none, `wrinkle SUBCOMMAND --help` a "
                          "subcommand.\n\n"
                          "Exit status: 0 done, 1 failed, 2 the shell line was wrong, 130 "
                          "interrupted.\n");
}

/* ---- for the guide ---- */

static void add_options(WrText *text, const WrSubcommand *command, bool common)
{
    const char *o[4];
    for (int i = 0; wr_cli_option(command, common, i, o); i++) {
        if (i == 0) wr_text_add(text, "\n| option | |\n| --- | --- |\n");
        wr_text_addf(text, "| `%s%s%s%s%s` | ", o[0], o[1] ? ", " : "", o[1] ? o[1] : "",
                     o[2] ? " " : "", o[2] ? o[2] : "");
        wr_help_markdown_cell(text, o[3]);
        wr_text_add(text, " |\n");
    }
}

/* Join sentences that are broken into lines for terminals. */
static void add_joined(WrText *text, const char *lines)
{
    for (const char *p = lines; *p; p++) {
        char c[2] = { *p == '\n' ? ' ' : *p, '\0' };
        wr_help_markdown_cell(text, c);
    }
}

/* Markdown tables: every subcommand with its options; the effects that a plan may skip; the sets of maps. */
static void cli_markdown_subcommands(WrText *text)
{
    for (const WrSubcommand *c = wr_subcommands; c->name; c++) {
        wr_text_addf(text, "## wrinkle %s\n\n", c->name);
        wr_help_markdown_cell(text, c->help);
        wr_text_addf(text, ".\n\n    usage: wrinkle %s\n", c->usage);
        if (c->details) wr_text_add(text, "\n");
        if (c->details) add_joined(text, c->details);
        if (c->details) wr_text_add(text, "\n");
        add_options(text, c, false);
        wr_text_add(text, "\n");
    }
    wr_text_add(text, "## Options of every subcommand\n");
    add_options(text, &wr_subcommands[0], true);
}

static void cli_markdown_effects(WrText *text)
{
    wr_text_add(text, "| rule | effect | is left out when | proof |\n| --- | --- | --- | --- |\n");
    for (int i = 0; i < WR_EFFECT_COUNT; i++) {
        const WrEffectInfo *e = &wr_effects[i];
        wr_text_addf(text, "| %s | %s | ", e->rule, e->name);
        wr_help_markdown_cell(text, e->left_out);
        wr_text_addf(text, " | %s%s", wr_proof_letter(e->proof), e->bound ? ": " : "");
        if (e->bound) wr_help_markdown_cell(text, e->bound);
        wr_text_add(text, " |\n");
    }
}

/* Print a kind of map and its settings as in a line of a set. */
static void add_map(const WrMapSetEntry *map, WrText *text)
{
    wr_text_addf(text, "`%sNAME%s` (%s", map->before, map->after, map->kind->name);
    for (int i = 0; i < WR_MAP_SET_SETTINGS_MAX && map->settings[i]; i++)
        wr_text_addf(text, " %s", map->settings[i]);
    wr_text_add(text, ")");
}

static void cli_markdown_sets(WrText *text)
{
    wr_text_add(text, "| set | is | files |\n| --- | --- | --- |\n");
    for (int i = 0; i < WR_MAP_SET_ROWS; i++) {
        const WrMapSetRow *row = &wr_map_set_rows[i];
        WrMapSet *set = wr_map_set_parse(row->name, row->maps, row->name, NULL);
        wr_text_addf(text, "| `%s` | ", row->name);
        wr_help_markdown_cell(text, row->about);
        wr_text_add(text, " | ");
        for (int k = 0; set && k < set->maps.count; k++) {
            wr_text_add(text, k ? ", " : "");
            add_map(&set->maps.data[k], text);
        }
        for (int k = 0; set && k < WR_MATERIAL_FORMATS; k++)
            if (set->materials >> k & 1)
                wr_text_addf(text, ", `NAME.%s` (material)", wr_material_formats[k].name);
        wr_text_add(text, " |\n");
        wr_map_set_free(set);
    }
}

/* Print source text for the guide's pages. */
static int print_markdown(const WrCli *cli)
{
    static const struct {
        const char *name;
        void (*add)(WrText *text);
    } parts[] = { { "verbs", wr_help_markdown_verbs },
                  { "subcommands", cli_markdown_subcommands },
                  { "effects", cli_markdown_effects },
                  { "sets", cli_markdown_sets } };
    WrText text = { 0 };
    WrError err;
    bool good = true;
    for (int i = 0; i < cli->word_count && good; i++) {
        size_t k = 0;
        while (k < sizeof parts / sizeof *parts && strcmp(parts[k].name, cli->words[i]) != 0) k++;
        if (i > 0) wr_text_add(&text, "\n");
        if (k < sizeof parts / sizeof *parts) parts[k].add(&text);
        else good = wr_help_markdown(cli->words[i], &text, &err);
    }
    if (cli->word_count == 0) wr_help_markdown_verbs(&text);
    int status = good ? wr_cli_print(cli, &text) : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    wr_text_fini(&text);
    return status;
}

/* True if word i is a form or an argument of the previous command, rather than a verb or a subcommand. */
static bool is_part(const WrCli *cli, const WrCommand *command, int i)
{
    if (!command || i >= cli->word_count) return false;
    const char *word = cli->words[i];
    return wr_help_has_part(command, word) || (!wr_command_find(word) && !wr_subcommand_find(word));
}

/* Print a verb and the following words that are parts of it; *i moves past them. */
static bool add_verb(const WrCli *cli, int *i, WrText *text, WrError *err)
{
    const char *verb = cli->words[*i];
    const WrCommand *command = wr_command_find(verb);
    if (!is_part(cli, command, *i + 1)) {
        if (!wr_help_command(verb, text, err)) return false;
        if (wr_subcommand_find(verb))
            wr_text_addf(text, "\n  The subcommand: see `wrinkle %s --help`.\n", verb);
        return true;
    }
    for (; is_part(cli, command, *i + 1); ++*i)
        if (!wr_help_command_part(command, cli->words[*i + 1], text, err)) return false;
    return true;
}

/* Print the table, or the commands named, a line each. */
static int print_json(const WrCli *cli)
{
    WrText text = { 0 };
    WrError err;
    bool good = true;
    if (cli->word_count == 0) wr_help_json(&text);
    for (int i = 0; i < cli->word_count && good; i++) {
        const WrCommand *command = wr_command_find(cli->words[i]);
        good = command || wr_help_command(cli->words[i], &text, &err);
        if (good) wr_help_json_command(command, &text);
    }
    const int status = good ? wr_cli_print(cli, &text) : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    wr_text_fini(&text);
    return status;
}

int wr_cli_help_command(const WrCli *cli)
{
    if (cli->completion) return wr_cli_print_completion(cli);
    if (cli->markdown) return print_markdown(cli);
    if (cli->json) return print_json(cli);
    WrError err;
    WrText text = { 0 };
    int status = WR_EXIT_DONE;
    for (int i = 0; i < cli->word_count && status == WR_EXIT_DONE; i++) {
        const char *word = cli->words[i];
        if (i > 0) wr_text_add(&text, "\n");
        if (!wr_command_find(word) && wr_subcommand_find(word))
            wr_cli_help(wr_subcommand_find(word), &text);
        else if (!add_verb(cli, &i, &text, &err)) status = WR_EXIT_FAILED;
    }
    if (status == WR_EXIT_DONE && cli->word_count == 0) wr_help_overview(&text);
    status = status == WR_EXIT_DONE ? wr_cli_print(cli, &text) : wr_cli_fail(cli, status, &err);
    wr_text_fini(&text);
    return status;
}
