#include "base/error.h"
#include "base/file.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "cli/cli.h"
#include "system/process.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#define GRACE_SECONDS 5 /* time for work to stop cleanly */

/* The only variable that the signal handler accesses. */
static volatile int interrupted;

static void on_interrupt(void)
{
    __atomic_store_n(&interrupted, 1, __ATOMIC_RELAXED);
}

int wr_cli_fail(const WrCli *cli, int status, const WrError *err)
{
    bool stopped = wr_cancel_requested(cli->cancel) && status == WR_EXIT_FAILED;
    wr_cli_progress_clear();
    fprintf(stderr, "wrinkle: %s\n", stopped ? "interrupted" : err->text);
    return stopped ? WR_EXIT_INTERRUPTED : status;
}

void wr_cli_note(const char *text)
{
    wr_cli_progress_clear();
    fprintf(stderr, "wrinkle: note: %s\n", text);
}

int wr_cli_print(const WrCli *cli, const WrText *text)
{
    WrError err;
    if (fwrite(wr_text_get(text), 1, text->length, stdout) == text->length && fflush(stdout) == 0)
        return WR_EXIT_DONE;
    char why[WR_FILE_WHY];
    wr_fail(&err, "standard output: could not be written (%s)", wr_file_why(errno, why));
    return wr_cli_fail(cli, WR_EXIT_FAILED, &err);
}

static int run(WrCli *cli)
{
    WrText text = { 0 };
    if (cli->version || cli->help) {
        if (cli->version) wr_text_add(&text, "wrinkle " WR_VERSION "\n");
        else wr_cli_help(cli->command, &text);
        int status = wr_cli_print(cli, &text);
        wr_text_fini(&text);
        return status;
    }
    static WrProgress progress = { .cancel = &interrupted };
    if (cli->command->run == wr_cli_run || cli->command->run == wr_cli_export ||
        cli->command->run == wr_cli_render || cli->command->run == wr_cli_recover ||
        cli->command->run == wr_cli_paint)
        wr_cli_progress_begin(&progress);
    bool unprinted = false;
    cli->unprinted = &unprinted;
    cli->pool = wr_pool_new(cli->threads);
    wr_progress_set(&progress);
    int status = cli->command->run(cli);
    wr_progress_set(NULL);
    wr_cli_progress_clear();
    wr_pool_free(cli->pool);
    return status == WR_EXIT_DONE && unprinted ? WR_EXIT_FAILED : status;
}

int main(int argc, char **argv)
{
    WrCli cli = { .argv = argv, .cancel = &interrupted };
    WrError err;
    int status = WR_EXIT_USAGE;
    /* If work ignores the cancellation, the process ends anyway; the journal has the finished commands. */
    wr_process_called(argv[0]);
    wr_process_catch_interrupts(on_interrupt, GRACE_SECONDS);
    if (wr_cli_parse(argc, argv, &cli, &status, &err)) status = run(&cli);
    else status = wr_cli_fail(&cli, status, &err);
    wr_cli_fini(&cli);
    return status;
}
