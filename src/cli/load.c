#include "cli/cli.h"

#include "api/doc.h"
#include "base/error.h"
#include "base/text.h"
#include "command/session.h"
#include "system/path.h"
#include "system/process.h"

#include <stdio.h>
#include <string.h>

static void print_note(void *ctx, const char *text)
{
    const WrCli *cli = ctx;
    WrText note = { 0 };
    if (cli->file_count > 1) wr_text_addf(&note, "%s: ", cli->file); /* of several inputs */
    wr_text_add(&note, text);
    wr_cli_note(wr_text_get(&note));
    wr_text_fini(&note);
}

bool wr_cli_find_word(const char *option, const char *word, WrWordList list, const void *ctx,
                      int *place, WrError *err)
{
    char what[100];
    for (int i = 0; list(ctx, i); i++)
        if (strcmp(word, list(ctx, i)) == 0) {
            *place = i;
            return true;
        }
    snprintf(what, sizeof what, "%s %.60s", option, word);
    return wr_fail_word(err, what, word, list, ctx);
}

static void print_receipt(void *ctx, const WrReceipt *receipt)
{
    const WrCli *cli = ctx;
    WrError err;
    WrText text = { 0 };
    const int status = wr_cli_add_receipt(cli, receipt, &text, &err)
                           ? wr_cli_report(cli, &text)
                           : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    if (status != WR_EXIT_DONE && cli->unprinted) *cli->unprinted = true;
    wr_text_fini(&text);
}

static WrSessionOptions session_options(const WrCli *cli, bool outputs)
{
    const bool receipts =
        cli->json && (cli->command->run == wr_cli_run || cli->command->run == wr_cli_render);
    return (WrSessionOptions){ .pool = cli->pool,
                               .note = print_note,
                               .note_ctx = (void *)cli,
                               .receipt = receipts ? print_receipt : NULL,
                               .receipt_ctx = (void *)cli,
                               .foretell = wr_process_has_terminal(),
                               .outputs = outputs,
                               .full = cli->full,
                               .isa = cli->isa,
                               .picture_bytes = (size_t)(cli->memory * (1 << 20)),
                               .smooth = true };
}

WrDoc *wr_cli_doc(const WrCli *cli, bool outputs, WrError *err)
{
    const WrSessionOptions options = session_options(cli, outputs);
    return wr_api_new(&options, err);
}

WrSession *wr_cli_session(const WrCli *cli, bool outputs, WrError *err)
{
    const WrSessionOptions options = session_options(cli, outputs);
    return wr_api_check_instruction_set(cli->isa, err) ? wr_session_new(&options) : NULL;
}

bool wr_cli_run_dos(const WrCli *cli, WrSession *session, WrError *err)
{
    for (int i = 0; i < cli->do_count; i++)
        if (!wr_session_run(session, cli->dos[i], err)) {
            if (cli->do_count > 1) wr_error_prefix(err, "--do %d of %d: ", i + 1, cli->do_count);
            else wr_error_prefix(err, "--do: ");
            return false;
        }
    return true;
}

const char *wr_cli_file_name(const WrCli *cli)
{
    const char *slash = cli->file ? strrchr(cli->file, '/') : NULL;
    return slash ? slash + 1 : cli->file ? cli->file : "";
}

bool wr_cli_open(const WrCli *cli, WrSession *session, WrError *err)
{
    WrFileInfo info;
    if (!cli->file || wr_session_open(session, cli->file, err)) return true;
    if (cli->do_count > 0 && !strchr(cli->dos[cli->do_count - 1], ' ') &&
        !wr_path_info(cli->file, &info))
        wr_fail(
            err,
            "%.200s: No such file or directory: a command with spaces goes in quotes: --do '%.60s "
            "%.60s'",
            cli->file, cli->dos[cli->do_count - 1], cli->file);
    return false;
}

WrSession *wr_cli_load(const WrCli *cli, bool outputs, WrError *err)
{
    WrSession *session = wr_cli_session(cli, outputs, err);
    if (!session) return NULL;
    if (!wr_cli_open(cli, session, err) || !wr_cli_run_dos(cli, session, err)) {
        wr_session_free(session);
        return NULL;
    }
    return session;
}
