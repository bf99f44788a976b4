#include "cli/cli.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/session.h"
#include "command/variants.h"
#include "export/film.h"
#include "image/image.h"

static bool is_there(const WrCli *cli, const WrSession *session, const char *path)
{
    const int rows = cli->banded ? cli->last_row - cli->first_row + 1 : cli->height;
    return cli->missing && wr_session_has_rendered(session, path, cli->width, rows);
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

typedef struct Render {
    const WrCli *cli;
    WrSession *session;
} Render;

static bool render_frames(void *ctx, const char *variant, WrError *err)
{
    const Render *render = ctx;
    const WrTurntable turntable = turntable_of(render->cli);
    char *out = wr_variant_fill(render->cli->out, variant);
    const bool good = wr_session_turntable(render->session, out, &turntable, err);
    wr_free(out);
    return good;
}

static bool render_one(void *ctx, const char *variant, WrError *err)
{
    const Render *render = ctx;
    const WrCli *cli = render->cli;
    char *out = wr_variant_fill(cli->out, variant);
    const bool there = is_there(cli, render->session, out);
    const WrPictureRows rows = { cli->first_row, cli->last_row - cli->first_row + 1 };
    const bool good = there || wr_session_render(render->session, out, cli->width, cli->height,
                                                 cli->banded ? &rows : NULL, 0, err);
    if (there) wr_cli_note("the picture was there");
    wr_free(out);
    return good;
}

/* Check the combination of options. */
static bool check_line(const WrCli *cli, WrError *err)
{
    const bool to_stdout = wr_cli_to_stdout(cli);
    if (!cli->out) return wr_fail(err, "render: needs -o OUT");
    if (cli->format && !to_stdout)
        return wr_fail(err,
                       "render: --format goes with -o -; the format of %.100s goes by its ending",
                       cli->out);
    if (to_stdout && cli->missing)
        return wr_fail(err, "render: --missing needs names of files, not -o -");
    if (cli->banded && cli->framed)
        return wr_fail(err, "render: --rows is of one picture; --frames A-B makes several");
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

static int render(const WrCli *cli)
{
    WrError err;
    if (!check_frames(cli, &err)) {
        wr_error_prefix(&err, "-o ");
        return wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    }
    WrSession *session = wr_cli_load(cli, false, &err);
    if (!session) return wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    wr_cli_progress_resume();
    Render render = { cli, session };
    const bool good = wr_session_for_variants(
        session, cli->out, cli->framed ? render_frames : render_one, &render, &err);
    wr_session_free(session);
    return good ? WR_EXIT_DONE : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
}

int wr_cli_render(const WrCli *cli)
{
    WrError err;
    WrText name = { 0 };
    const char *ending = cli->format ? cli->format : "png";
    wr_text_addf(&name, "out.%s", ending);
    bool good = check_line(cli, &err);
    if (good && wr_cli_to_stdout(cli) && cli->framed && !wr_film_kind(wr_text_get(&name)))
        good = wr_fail(&err, "render: -o - holds one file, and these are frames: name the files "
                             "with ####, or a film: --format gif, apng, webp or mp4");
    wr_text_fini(&name);
    if (!good) return wr_cli_fail(cli, WR_EXIT_USAGE, &err);
    return wr_cli_to_stdout(cli) ? wr_cli_pipe(cli, ending, render) : render(cli);
}
