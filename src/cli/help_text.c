#include "cli/cli.h"

#include "base/text.h"
#include "command/help.h"
#include "export/export.h"
#include "export/map_sets.h"
#include "render/plan/plan.h"

#include <stdio.h>
#include <string.h>

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
        wr_text_add(text, "wrinkle - an interactive paint program for bump functions\n\nusage:\n");
        for (const WrSubcommand *c = wr_subcommands; c->name; c++)
            wr_text_addf(text, "  wrinkle %-52s %s\n", c->usage, c->help);
        wr_text_add(
            text, "\nFILE is a document (*.exr), a script (*.wrinkle) or any picture with heights; "
                  "left out, it is an\nempty 512x512 table on a plane.\n\n"
                  "options of every subcommand:\n");
    }
    if (command) add_plain_options(text, command, false);
    add_plain_options(text, &wr_subcommands[0], true);
    if (!command)
        wr_text_add(text,
                    "\n`wrinkle help` lists the commands that scripts and --do take, "
                    "`wrinkle help VERB` tells\nmore of one, `wrinkle SUBCOMMAND --help` of a "
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

void wr_cli_markdown_subcommands(WrText *text)
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

void wr_cli_markdown_effects(WrText *text)
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
static void add_map(const WrSetMap *map, WrText *text)
{
    wr_text_addf(text, "`%sNAME%s` (%s", map->before, map->after, map->kind->name);
    for (int i = 0; i < WR_SET_SETTINGS && map->settings[i]; i++)
        wr_text_addf(text, " %s", map->settings[i]);
    wr_text_add(text, ")");
}

void wr_cli_markdown_sets(WrText *text)
{
    wr_text_add(text, "| set | is | files |\n| --- | --- | --- |\n");
    for (int i = 0; i < WR_SET_ROWS; i++) {
        const WrSetRow *row = &wr_set_rows[i];
        WrSet *set = wr_set_parse(row->name, row->maps, row->name, NULL);
        wr_text_addf(text, "| `%s` | ", row->name);
        wr_help_markdown_cell(text, row->about);
        wr_text_add(text, " | ");
        for (int k = 0; set && k < set->maps.count; k++) {
            wr_text_add(text, k ? ", " : "");
            add_map(&set->maps.data[k], text);
        }
        wr_text_add(text, " |\n");
        wr_set_free(set);
    }
}
