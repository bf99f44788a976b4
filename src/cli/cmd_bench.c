/* `wrinkle bench` and `wrinkle accuracy --tolerance` continue as the program wrinkle-bench, which stands beside this one
   and is built from tests/bench/. Its subcommands have the same words, output and exit status. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "cli/cli.h"
#include "system/path.h"
#include "system/process.h"

#include <string.h>

static int start(const WrCli *cli)
{
    WrError err;
    WrText path = { 0 };
    char *folder = wr_program_folder();
    wr_text_addf(&path, "%s/wrinkle-bench", folder);
    cli->argv[0] = path.data;
    if (!wr_path_can_run(path.data))
        wr_fail(&err,
                "%s needs the program wrinkle-bench, which was not found at: %.200s; build it with "
                "`cmake "
                "--build BUILD-FOLDER --target wrinkle-bench`, install it with `cmake --install "
                "BUILD-FOLDER --component bench`",
                cli->command->name, path.data);
    else
        wr_fail(&err, "%s: %.200s cannot be started: %s", cli->command->name, path.data,
                strerror(wr_process_become(path.data, cli->argv)));
    const int status = wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    wr_text_fini(&path);
    wr_free(folder);
    return status;
}

int wr_cli_bench(const WrCli *cli)
{
    return start(cli);
}

int wr_cli_contest(const WrCli *cli)
{
    return start(cli);
}
