#include "cli/cli.h"

#include "command/help.h"

#include <string.h>

int wr_cli_help_command(const WrCli *cli)
{
    WrError err;
    WrText text = { 0 };
    int status = WR_EXIT_DONE;
    for (int i = 0; i < cli->word_count && status == WR_EXIT_DONE; i++) {
        const char *word = cli->words[i];
        if (word[0] == '-') {
            wr_fail(&err, "help: unknown option %.60s: see `wrinkle help --help`", word);
            status = WR_EXIT_USAGE;
        } else if (wr_command_find(word) || !wr_subcommand_find(word)) {
            if (i > 0) wr_text_add(&text, "\n");
            if (!wr_help_command(word, &text, &err)) status = WR_EXIT_FAILED;
            else if (wr_subcommand_find(word))
                wr_text_addf(&text, "\n  The subcommand: see `wrinkle %s --help`.\n", word);
        } else {
            wr_cli_help(wr_subcommand_find(word), &text);
        }
    }
    if (status == WR_EXIT_DONE && cli->json) { /* words are checked, then the whole table comes */
        wr_text_clear(&text);
        wr_help_json(&text);
    } else if (status == WR_EXIT_DONE && cli->word_count == 0) {
        wr_help_overview(&text);
    }
    status = status == WR_EXIT_DONE ? wr_cli_print(cli, &text) : wr_cli_fail(cli, status, &err);
    wr_text_fini(&text);
    return status;
}
