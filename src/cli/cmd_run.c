#include "api/doc.h"
#include "base/error.h"
#include "cli/cli.h"
#include "command/session.h"

int wr_cli_run(const WrCli *cli)
{
    WrError err;
    WrDocError error;
    if (!cli->file) {
        wr_fail(&err, "run: needs a SCRIPT (- reads standard input)");
        return wr_cli_fail(cli, WR_EXIT_USAGE, &err);
    }
    WrDoc *doc = wr_cli_doc(cli, true, &err);
    if (!doc) return wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    wr_session_set_journal(wr_api_session(doc), true);
    const bool ran = wr_doc_run_script(doc, cli->file, &error) || wr_fail(&err, "%s", error.text);
    const bool good = ran && wr_cli_run_dos(cli, wr_api_session(doc), &err);
    wr_doc_free(doc);
    return good ? WR_EXIT_DONE : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
}
