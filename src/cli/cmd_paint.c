#include "cli/cli.h"

#include "api/doc.h"
#include "base/error.h"
#include "base/text.h"

#ifdef WR_HAVE_UI
#include "base/file.h"
#include "scene/export_settings.h"
#include "system/process.h"
#include "ui/app/app.h"

#include <string.h>

static void keep_note(void *ctx, const char *text)
{
    wr_text_addf(ctx, "%s\n", text);
}

static bool is_brush(const char *path)
{
    char buffer[16];
    return path && strcmp(wr_path_ending(path, buffer), "myb") == 0;
}

/* Runs on a worker thread of the window. Output commands among the --do lines are skipped, as in all subcommands except
   run; they work once the document is open. */
static bool open_asked(WrSession *session, void *ctx, WrError *err)
{
    const WrCli *cli = ctx;
    wr_session_set_outputs(session, false);
    const bool good =
        (!cli->file || is_brush(cli->file) || wr_session_open(session, cli->file, err)) &&
        wr_cli_run_dos(cli, session, err);
    wr_session_set_outputs(session, true);
    wr_session_set_journal(session, true);
    return good;
}

/* --live needs a document, whose name its maps have. */
static bool check_live(const WrCli *cli, WrError *err)
{
    if (cli->live && !cli->file) return wr_fail(err, "paint: --live needs FILE");
    if (cli->live && strlen(cli->live) >= WR_SHEET_FOLDER)
        return wr_fail(err, "--live %.60s...: must be shorter than %d bytes", cli->live,
                       WR_SHEET_FOLDER);
    if (cli->kind && !cli->live) return wr_fail(err, "paint: --as needs --live FOLDER");
    return !cli->kind || wr_cli_check_kind(cli->kind, err);
}

/* The window shows notes itself. */
int wr_cli_paint(const WrCli *cli)
{
    WrError err;
    WrText notes = { 0 };
    WrSessionOptions options = { .pool = cli->pool,
                                 .note = keep_note,
                                 .note_ctx = &notes,
                                 .note_messages = true,
                                 .outputs = true,
                                 .isa = cli->isa,
                                 .composites = true,
                                 .smooth = true };
    WrSession *session = wr_session_new(&options);
    const bool brush = is_brush(cli->file) && !cli->live;
    const bool given = (cli->file && !brush) || cli->do_count > 0;
    int status = WR_EXIT_FAILED;
    if (!check_live(cli, &err)) {
        wr_session_free(session);
        return wr_cli_fail(cli, cli->live && cli->file ? WR_EXIT_FAILED : WR_EXIT_USAGE, &err);
    }
    if (!given) wr_session_set_journal(session, true);
    if (wr_api_check_instruction_set(cli->isa, &err)) {
        WrAppOptions app = { .session = session,
                             .open = given ? open_asked : NULL,
                             .open_ctx = (void *)cli,
                             .file = cli->do_count == 0 && !brush ? cli->file : NULL,
                             .brush = brush ? cli->file : NULL,
                             .file_given = given,
                             .live_folder = cli->live,
                             .live_as = cli->kind,
                             .live_file = cli->file,
                             .threads = cli->threads,
                             .isa = cli->isa,
                             .notes = &notes };
        wr_process_drop_interrupts(); /* SDL turns an interrupt into a request to close */
        wr_cli_progress_stop();       /* the window reports from here on */
        status = wr_app_run(&app);
    } else {
        status = wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    }
    wr_session_free(session);
    wr_text_fini(&notes);
    return status;
}

#else

int wr_cli_paint(const WrCli *cli)
{
    WrError err;
    wr_fail(&err, "this build has no window: try `wrinkle --help`");
    return wr_cli_fail(cli, WR_EXIT_FAILED, &err);
}

#endif
