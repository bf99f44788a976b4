#include "cli/cli.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/session.h"

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

/* What --frames asks for. */
typedef struct Turn {
    int total;   /* frames of the whole turn */
    double turn; /* degrees a frame */
    bool chosen; /* the dials, for all of them */
    int there;   /* frames that were left out */
} Turn;

static Turn turn_of(const WrCli *cli)
{
    Turn turn = { .total = cli->of ? cli->of : cli->last - cli->first + 1 };
    turn.turn = cli->turned ? cli->turn_deg : 360.0 / turn.total;
    return turn;
}

/* Under a tolerance the dials are chosen once for the whole turn, whichever of its frames are asked for here. */
static bool choose_for_all(const WrCli *cli, Turn *turn, WrSession *session, WrError *err)
{
    const int first = cli->turned && !cli->of ? cli->first : 1;
    double *angles = wr_alloc((size_t)turn->total, sizeof *angles);
    for (int i = 0; i < turn->total; i++) angles[i] = angle_of(first + i, turn->turn);
    turn->chosen = wr_session_turn(session, cli->width, cli->height, angles, turn->total, err);
    wr_free(angles);
    return turn->chosen;
}

static bool is_there(const WrCli *cli, const WrSession *session, const char *path)
{
    return cli->missing && wr_session_has_rendered(session, path, cli->width, cli->height);
}

static bool render_frame(const WrCli *cli, Turn *turn, WrSession *session, int frame, WrError *err)
{
    WrText name = { 0 };
    frame_name(cli->out, frame, &name);
    const char *path = wr_text_get(&name);
    bool good = true;
    if (is_there(cli, session, path)) turn->there++;
    else
        good = (turn->chosen || choose_for_all(cli, turn, session, err)) &&
               wr_session_render(session, path, cli->width, cli->height,
                                 angle_of(frame, turn->turn), err);
    wr_text_fini(&name);
    if (good && cli->cancel && *cli->cancel) good = wr_fail(err, "cancelled");
    return good;
}

static bool render_frames(const WrCli *cli, WrSession *session, WrError *err)
{
    const int count = cli->last - cli->first + 1;
    Turn turn = turn_of(cli);
    bool good = true;
    for (int i = 0; good && i < count; i++) {
        WrProgressPart part;
        const WrProgress *whole =
            wr_progress_enter(&part, (double)i / count, (double)(i + 1) / count);
        good = render_frame(cli, &turn, session, cli->first + i, err);
        wr_progress_set(whole);
    }
    if (turn.there > 0) {
        char text[80];
        snprintf(text, sizeof text, "%d of %d frames were there", turn.there, count);
        wr_cli_note(text);
    }
    return good;
}

static bool render_one(const WrCli *cli, WrSession *session, WrError *err)
{
    if (!is_there(cli, session, cli->out))
        return wr_session_render(session, cli->out, cli->width, cli->height, 0, err);
    wr_cli_note("the picture was there");
    return true;
}

/* What is wrong with the shell line as a whole. */
static bool check_line(const WrCli *cli, WrError *err)
{
    if (!cli->out) return wr_fail(err, "render: needs -o OUT");
    if (cli->turned && !cli->framed) return wr_fail(err, "render: --turn needs --frames A-B");
    if (cli->of && !cli->framed) return wr_fail(err, "render: --of needs --frames A-B");
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
    wr_cli_tell_again();
    bool good = (cli->framed ? render_frames : render_one)(cli, session, &err);
    wr_session_free(session);
    return good ? WR_EXIT_DONE : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
}
