#include "cli/cli.h"

#include "base/error.h"
#include "base/text.h"
#include "command/help.h"

#include <string.h>

/* Print source text for the guide's pages. */
static int print_markdown(const WrCli *cli)
{
    static const struct {
        const char *name;
        void (*add)(WrText *text);
    } parts[] = { { "verbs", wr_help_markdown_verbs },
                  { "subcommands", wr_cli_markdown_subcommands },
                  { "effects", wr_cli_markdown_effects },
                  { "sets", wr_cli_markdown_sets } };
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
        if (!wr_help_part(command, cli->words[*i + 1], text, err)) return false;
    return true;
}

int wr_cli_help_command(const WrCli *cli)
{
    if (cli->markdown) return print_markdown(cli);
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
    if (status == WR_EXIT_DONE && cli->json) { /* the words were only checked; the output is the
                                                  whole table */
        wr_text_clear(&text);
        wr_help_json(&text);
    } else if (status == WR_EXIT_DONE && cli->word_count == 0) {
        wr_help_overview(&text);
    }
    status = status == WR_EXIT_DONE ? wr_cli_print(cli, &text) : wr_cli_fail(cli, status, &err);
    wr_text_fini(&text);
    return status;
}
