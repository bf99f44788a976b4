#include "cli/cli.h"

#include "base/error.h"
#include "command/session.h"
#include "export/film.h"
#include "image/image.h"

static bool is_there(const WrCli *cli, const WrSession *session, const char *path)
{
    return cli->missing && wr_session_has_rendered(session, path, cli->width, cli->height);
}

static WrTurntable turntable_of(const WrCli *cli)
{
    WrTurntable turntable = wr_turntable_default();
    turntable.width = cli->width;
    turntable.height = cli->height;
    turntable.first = cli->first;
    turntable.last = cli->last;
    turntable.of = cli->of;
    turntable.stepped = cli->turned;
    turntable.step_deg = cli->turn_deg;
    turntable.missing = cli->missing;
    turntable.fps = cli->fps;
    turntable.loop = cli->looped ? cli->loop : turntable.loop;
    return turntable;
}

static bool render_frames(const WrCli *cli, WrSession *session, WrError *err)
{
    const WrTurntable turntable = turntable_of(cli);
    return wr_session_turntable(session, cli->out, &turntable, err);
}

static bool render_one(const WrCli *cli, WrSession *session, WrError *err)
{
    if (!is_there(cli, session, cli->out))
        return wr_session_render(session, cli->out, cli->width, cli->height, 0, err);
    wr_cli_note("the picture was there");
    return true;
}

/* Check the combination of options. */
static bool check_line(const WrCli *cli, WrError *err)
{
    if (!cli->out) return wr_fail(err, "render: needs -o OUT");
    if (cli->turned && !cli->framed) return wr_fail(err, "render: --turn needs --frames A-B");
    if (cli->of && !cli->framed) return wr_fail(err, "render: --of needs --frames A-B");
    if (cli->fps > 0 && !cli->framed) return wr_fail(err, "render: --fps needs --frames A-B");
    if (cli->looped && !cli->framed) return wr_fail(err, "render: --loop needs --frames A-B");
    return true;
}

/* Check the frames before a document is loaded. */
static bool check_frames(const WrCli *cli, WrError *err)
{
    const WrTurntable turntable = turntable_of(cli);
    if (cli->framed) return wr_turntable_check(&turntable, cli->out, err);
    if (!wr_film_kind(cli->out) || wr_image_can_write(cli->out, WR_PIXEL_U8, 3, false, NULL))
        return true;
    return wr_fail(err, "%s: a film needs --frames A-B", cli->out);
}

int wr_cli_render(const WrCli *cli)
{
    WrError err;
    if (!check_line(cli, &err)) return wr_cli_fail(cli, WR_EXIT_USAGE, &err);
    if (!check_frames(cli, &err)) {
        wr_error_prefix(&err, "-o ");
        return wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    }
    WrSession *session = wr_cli_load(cli, false, &err);
    if (!session) return wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    wr_cli_progress_resume();
    bool good = (cli->framed ? render_frames : render_one)(cli, session, &err);
    wr_session_free(session);
    return good ? WR_EXIT_DONE : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
}
