/* Benchmark of moments in which a user waits, on large tables: brushes of a large radius, whole tables at once, views, memory
   and start. One line each: median and 95th percentile. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "bench/bench.h"
#include "cli/cli.h"
#include "system/clock.h"
#include "system/path.h"
#include "system/process.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef WR_HAVE_UI
#include "ui/app/app.h"

static const char *const relief_4096[] = { "table 4096x4096", "noise perlin cells=24 octaves=6",
                                           "surface sphere", NULL };
static const char *const layers_4096[] = {
    "table 4096x4096", "noise perlin cells=24 octaves=6",    "surface sphere",
    "layer add",       "noise perlin cells=7 amplitude=0.2", NULL
};
static const char *const relief_16384[] = { "table 16384x16384",
                                            "grid cells=64x64 width=40 high=0.5", "surface sphere",
                                            NULL };

static WrSession *open_session(const WrCli *cli, const char *const *lines, WrError *err)
{
    /* as `wrinkle paint` opens one */
    const WrSessionOptions options = {
        .pool = cli->pool, .outputs = true, .isa = cli->isa, .composites = true, .smooth = true
    };
    WrSession *session = wr_session_new(&options);
    for (int i = 0; session && lines[i]; i++)
        if (!wr_session_run(session, lines[i], err)) {
            wr_session_free(session);
            return NULL;
        }
    return session;
}

static void add_delays(WrText *text, const char *label, const WrAppDelays *ms)
{
    wr_text_addf(text, "  %-62s %8.1f %8.1f ms\n", label, ms->half, ms->most);
}

/* A brush of radius 1000 on 4096 x 4096. */
static bool add_brush(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    WrAppLatency latency = { .radius = 1000, .seconds = quick ? 4 : 20 };
    WrSession *session = open_session(cli, relief_4096, err);
    const WrAppOptions options = { .session = session, .threads = cli->threads, .isa = cli->isa };
    const bool good = session && wr_app_latency(&options, &latency, err);
    wr_session_free(session);
    if (!good) return false;
    add_delays(text, "brush of radius 1000 on 4096x4096, to the table", &latency.canvas);
    add_delays(text, "  to the patch", &latency.preview);
    return true;
}

typedef struct Row {
    const char *label;
    const char *const *scene;
    const char *lines[5]; /* run in turns */
    int rounds, width, height;
} Row;

static const Row rows[] = {
    { "layer on and off, 4096x4096, to the first frame of the table",
      layers_4096,
      { "layer set 2 visible=off", "layer set 2 visible=on" },
      24,
      0,
      0 },
    { "undo and redo of a whole 4096x4096, to the first frame",
      relief_4096,
      { "adjust invert", "undo", "redo", "undo" },
      24,
      0,
      0 },
    { "pan and zoom of 16384x16384, window 2560x1440", relief_16384, { NULL }, 400, 2560, 1440 },
};

static bool add_row(const WrCli *cli, const Row *row, bool quick, WrText *text, WrError *err)
{
    WrAppMoments moments = { .lines = row->lines[0] ? row->lines : NULL,
                             .rounds = quick ? row->rounds / 4 : row->rounds,
                             .width = row->width,
                             .height = row->height };
    WrSession *session = open_session(cli, row->scene, err);
    const WrAppOptions options = { .session = session, .threads = cli->threads, .isa = cli->isa };
    const bool good = session && wr_app_moments(&options, &moments, err);
    wr_session_free(session);
    if (!good) return false;
    add_delays(text, row->label, &moments.first);
    add_delays(text, "  to the exact table", &moments.exact);
    if (row->lines[0]) add_delays(text, "  to the patch", &moments.preview);
    return true;
}

/* A new document painted on in one corner: memory beyond that of a small one, and a dab's time. */
static bool add_memory(const WrCli *cli, WrText *text, WrError *err)
{
    static const int sizes[2] = { 512, 16384 };
    WrAppMoments moments[2];
    for (int i = 0; i < 2; i++) {
        char table[40], strokes[2][100];
        const double low = 100.0 / sizes[i], high = 400.0 / sizes[i]; /* the same texels */
        snprintf(table, sizeof table, "table %dx%d", sizes[i], sizes[i]);
        for (int k = 0; k < 2; k++)
            snprintf(strokes[k], sizeof strokes[k],
                     "stroke radius=40 strength=0.1 points=%.7f,%.7f;%.7f,%.7f", low,
                     k ? low : high, high, k ? high : low);
        const char *const scene[] = { table, "surface sphere", NULL };
        const char *const lines[] = { strokes[0], strokes[1], NULL };
        moments[i] = (WrAppMoments){ .lines = lines, .rounds = 8 };
        WrSession *session = open_session(cli, scene, err);
        const WrAppOptions options = { .session = session,
                                       .threads = cli->threads,
                                       .isa = cli->isa };
        const bool good = session && wr_app_moments(&options, &moments[i], err);
        wr_session_free(session);
        if (!good) return false;
    }
    wr_text_addf(text, "  %-62s %8.1f MB\n",
                 "a corner painted on a new 16384x16384, beyond 512x512",
                 ((double)moments[1].resident - (double)moments[0].resident) / 1e6);
    add_delays(text, "  a stroke there, to the table", &moments[1].exact);
    add_delays(text, "  to the patch", &moments[1].preview);
    add_delays(text, "  the same on 512x512, to the table", &moments[0].exact);
    return true;
}

bool wr_bench_moments(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    wr_text_addf(text, "\nmoments in the window %51s %8s\n", "50 %", "95 %");
    /* first: memory of the others stays with the process for a while */
    if (!add_memory(cli, text, err) || !add_brush(cli, quick, text, err)) return false;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (!add_row(cli, &rows[i], quick, text, err)) return false;
    return true;
}
#else
bool wr_bench_moments(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    (void)cli, (void)quick, (void)text, (void)err;
    return true; /* build without a window */
}
#endif
