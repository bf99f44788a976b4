/* Benchmark of time promises: the time left of a long command by wr_time_left, as the window and the terminal show it, beside the
 * time that the rest needed. Ratios, so that they do not depend on the machine's speed. */
#include "base/array.h"
#include "base/error.h"
#include "base/enum_rows.h"
#include "base/progress.h"
#include "base/text.h"
#include "bench/bench.h"
#include "cli/cli.h"
#include "command/session.h"
#include "system/clock.h"

#include <math.h>

#define POLL_SECONDS 0.1 /* interval at which the window reads the progress */

static const struct {
    const char *label, *line;
} rows[] = { { "rain", "terrain hydraulic" },
             { "rain, long lived", "terrain hydraulic rain=0.5 life=1024 radius=5" },
             { "landslides", "terrain thermal rounds=400" },
             { "fractal terrain", "terrain fractal octaves=14" },
             { "seamless, patches", "adjust seamless how=patches" },
             { "even light", "adjust even-light sigma=60" },
             { "median", "adjust median radius=14" },
             { "slope limit", "adjust slope-limit limit=0.001" },
             { "dilate", "adjust dilate radius=60" },
             { "warp", "adjust warp octaves=8" },
             { "noise", "noise simplex octaves=16" },
             { "cracks", "pattern cracks across=40 rows=40 jagged=1" },
             { "scratches", "pattern scratches count=2000" },
             { "rivets", "solid sphere radius=9 across=100 rows=100" } };

/* The progress of one command as the window sees it. */
typedef struct Watch {
    const WrCli *cli;
    volatile int stop;              /* the benchmark is interrupted */
    double began, polled, furthest; /* clock; fraction */
    WrTimeLeft left;
    WR_ARRAY(double)
    times, wholes; /* seconds at which something was promised, and the whole time by that promise */
    int polls;
} Watch;

static void poll_until(Watch *watch, double now)
{
    for (; watch->polled + POLL_SECONDS <= now; watch->polls++) {
        watch->polled += POLL_SECONDS;
        const double took = watch->polled - watch->began;
        const double left = wr_time_left(&watch->left, watch->furthest, took);
        if (isnan(left)) continue;
        wr_array_push(&watch->times, took);
        wr_array_push(&watch->wholes, took + left);
    }
}

static void note(void *ctx, double fraction)
{
    Watch *watch = ctx;
    poll_until(watch, wr_clock_seconds());
    watch->furthest = fmax(watch->furthest, fraction);
    watch->stop = wr_cancel_requested(watch->cli->cancel);
}

static void add_row(const Watch *watch, const char *label, int size, double took, WrText *text)
{
    double worst = 1.0;
    const int count = watch->times.count;
    for (int i = 0; i < count; i++) {
        const double ratio = watch->wholes.data[i] / took;
        if (fabs(log(ratio)) > fabs(log(worst))) worst = ratio;
    }
    wr_text_addf(text, "  %-22s %6d %9.2f", label, size, took);
    if (count == 0) wr_text_addf(text, " %9s %9s %9s %8d %%\n", "-", "-", "-", 0);
    else
        wr_text_addf(text, " %7.2f s %9.2f %9.2f %8.0f %%\n", watch->times.data[0],
                     watch->wholes.data[0] / took, worst, 100.0 * count / fmax(watch->polls, 1));
}

static bool run_row(const WrCli *cli, int row, int size, WrText *text, WrError *err)
{
    WrSession *session = wr_session_new(&(WrSessionOptions){ .pool = cli->pool });
    Watch watch = { .cli = cli };
    char table[64];
    snprintf(table, sizeof table, "table %dx%d", size, size);
    bool good = wr_session_run(session, table, err) &&
                wr_session_run(session, "noise perlin cells=6 octaves=5", err);
    const WrProgress progress = { .cancel = &watch.stop, .report = note, .ctx = &watch };
    const WrProgress *before = wr_progress_set(&progress);
    watch.began = watch.polled = wr_clock_seconds();
    good = good && wr_session_run(session, rows[row].line, err);
    const double now = wr_clock_seconds();
    wr_progress_set(before);
    poll_until(&watch, now);
    if (good) add_row(&watch, rows[row].label, size, now - watch.began, text);
    wr_array_free(&watch.times);
    wr_array_free(&watch.wholes);
    wr_session_free(session);
    return good;
}

bool wr_bench_promises(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    const int sizes[] = { quick ? 64 : 512, quick ? 96 : 1024 };
    wr_text_addf(text, "\ntime promised / needed   table    needed     first     first     worst  "
                       "promised\n");
    for (int i = 0; i < WR_LENGTH(rows); i++)
        for (int k = 0; k < 2; k++)
            if (!run_row(cli, i, sizes[k], text, err)) return false;
    return true;
}
