#include "cli/cli.h"

#include "base/error.h"
#include "command/session.h"

#include <string.h>

int wr_cli_run(const WrCli *cli)
{
    WrError err;
    if (!cli->file) {
        wr_fail(&err, "run: needs a SCRIPT (- reads standard input)");
        return wr_cli_fail(cli, WR_EXIT_USAGE, &err);
    }
    WrSession *session = wr_cli_session(cli, true, &err);
    if (!session) return wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    bool good;
    wr_session_set_journal(session, true);
    if (strcmp(cli->file, "-") == 0)
        good = wr_session_run_stream(session, stdin, "standard input", &err);
    else good = wr_session_run_script(session, cli->file, &err);
    good = good && wr_cli_run_dos(cli, session, &err);
    wr_session_free(session);
    return good ? WR_EXIT_DONE : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
}
