#include "cli/cli.h"

#include "base/error.h"
#include "command/session.h"
#include "render/frame.h"
#include "system/process.h"

static void print_note(void *ctx, const char *text)
{
    (void)ctx;
    wr_cli_note(text);
}

bool wr_cli_check_isa(const WrCli *cli, WrError *err)
{
    if (!cli->isa) return true;
    WrRenderer *renderer = wr_renderer_new(cli->pool, cli->isa, err);
    if (!renderer) return false;
    wr_renderer_free(renderer);
    return true;
}

WrSession *wr_cli_session(const WrCli *cli, bool outputs, WrError *err)
{
    if (!wr_cli_check_isa(cli, err)) return NULL;
    WrSessionOptions options = { .pool = cli->pool,
                                 .note = print_note,
                                 .foretell = wr_process_has_terminal(),
                                 .outputs = outputs,
                                 .full = cli->full,
                                 .isa = cli->isa,
                                 .picture_bytes = (size_t)(cli->memory * (1 << 20)),
                                 .smooth = true };
    return wr_session_new(&options);
}

bool wr_cli_run_dos(const WrCli *cli, WrSession *session, WrError *err)
{
    for (int i = 0; i < cli->do_count; i++)
        if (!wr_session_run(session, cli->dos[i], err)) {
            wr_error_prefix(err, "--do: ");
            return false;
        }
    return true;
}

WrSession *wr_cli_load(const WrCli *cli, bool outputs, WrError *err)
{
    WrSession *session = wr_cli_session(cli, outputs, err);
    if (!session) return NULL;
    if ((cli->file && !wr_session_open(session, cli->file, err)) ||
        !wr_cli_run_dos(cli, session, err)) {
        wr_session_free(session);
        return NULL;
    }
    return session;
}
