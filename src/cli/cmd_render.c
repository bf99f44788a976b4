#include "cli/cli.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/session.h"
#include "system/process.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* OUT with its last run of # replaced by the number, zero-padded to the run's length. */
static void frame_name(const char *out, int number, WrText *name)
{
    const char *end = strrchr(out, '#') + 1, *start = end;
    while (start > out && start[-1] == '#') start--;
    wr_text_clear(name);
    wr_text_add_n(name, out, (size_t)(start - out));
    wr_text_addf(name, "%0*d%s", (int)(end - start), number, end);
}

/* Each frame's angle comes from its number alone: fmod is exact, so nothing adds up (HC87). */
static double angle_of(int frame, double turn)
{
    return fmod(frame * turn, 360);
}

/* Under a tolerance the dials are chosen once. */
static bool choose_for_all(const WrCli *cli, WrSession *session, double turn, WrError *err)
{
    const int count = cli->last - cli->first + 1;
    double *angles = wr_alloc((size_t)count, sizeof *angles);
    for (int i = 0; i < count; i++) angles[i] = angle_of(cli->first + i, turn);
    const bool good = wr_session_turn(session, cli->width, cli->height, angles, count, err);
    wr_free(angles);
    return good;
}

static bool render_frames(const WrCli *cli, WrSession *session, WrError *err)
{
    WrText name = { 0 };
    int count = cli->last - cli->first + 1;
    double turn = cli->turned ? cli->turn_deg : 360.0 / count;
    const bool terminal = wr_process_has_terminal();
    bool good = choose_for_all(cli, session, turn, err);
    for (int f = cli->first; good && f <= cli->last; f++) {
        frame_name(cli->out, f, &name);
        if (terminal) fprintf(stderr, "\rframe %d of %d ", f - cli->first + 1, count);
        good = wr_session_render(session, wr_text_get(&name), cli->width, cli->height,
                                 angle_of(f, turn), err);
        if (good && cli->cancel && *cli->cancel) good = wr_fail(err, "cancelled");
    }
    if (terminal) fputc('\n', stderr);
    wr_text_fini(&name);
    return good;
}

/* What is wrong with the shell line as a whole. */
static bool check_line(const WrCli *cli, WrError *err)
{
    if (!cli->out) return wr_fail(err, "render: needs -o OUT");
    if (cli->turned && !cli->framed) return wr_fail(err, "render: --turn needs --frames A-B");
    return true;
}

int wr_cli_render(const WrCli *cli)
{
    WrError err;
    if (!check_line(cli, &err)) return wr_cli_fail(cli, WR_EXIT_USAGE, &err);
    if (cli->framed && !strchr(cli->out, '#')) {
        wr_fail(&err, "-o %s: with --frames the name must hold #### for the frame's number",
                cli->out);
        return wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    }
    WrSession *session = wr_cli_load(cli, false, &err);
    if (!session) return wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    bool good = cli->framed
                    ? render_frames(cli, session, &err)
                    : wr_session_render(session, cli->out, cli->width, cli->height, 0, &err);
    wr_session_free(session);
    return good ? WR_EXIT_DONE : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
}
