/* The window: how soon a motion of the pen is seen. */
#include "cli/bench.h"

#include "base/error.h"
#include "base/text.h"

#ifdef WR_HAVE_UI
#include "ui/app/app.h"

static bool measure(const WrCli *cli, double radius, bool turning, double seconds,
                    WrAppLatency *latency, WrError *err)
{
    WrSession *session = wr_cli_session(cli, true, err);
    WrAppOptions options = { .session = session, .threads = cli->threads, .isa = cli->isa };
    *latency = (WrAppLatency){ .radius = radius, .seconds = seconds, .turning = turning };
    bool good = session && wr_session_run(session, "table 4096x4096", err) &&
                wr_session_run(session, "grid cells=16x16 width=40 high=0.5", err) &&
                wr_session_run(session, "surface sphere", err) &&
                wr_app_latency(&options, latency, err);
    wr_session_free(session);
    return good;
}

static void print(WrText *text, const char *what, const WrAppDelays *ms)
{
    wr_text_addf(text, "    %-26s %9.1f %9.1f %9.1f %9.1f\n", what, ms->half, ms->most,
                 ms->nearly_all, ms->all);
}

bool wr_bench_window(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    static const struct {
        const char *what;
        double radius, seconds;
        bool turning;
    } rows[] = { { "brush of 32 texels, the patch rests", 16, 60, false },
                 { "brush of 32 texels, the patch turns", 16, 20, true },
                 { "brush of 1000 texels, the patch rests", 500, 20, false } };
    wr_text_addf(text,
                 "\npainting in the window, table 4096x4096: ms from an event until it is "
                 "seen\n%-30s %9s %9s %9s %9s\n",
                 "", "50 %", "95 %", "99 %", "100 %");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        WrAppLatency latency;
        double seconds = quick ? rows[i].seconds / 10 : rows[i].seconds;
        if (!measure(cli, rows[i].radius, rows[i].turning, seconds, &latency, err)) return false;
        wr_text_addf(text, "  %s: %lld events, %lld pictures\n", rows[i].what,
                     (long long)latency.events, (long long)latency.pictures);
        print(text, "the outline has moved", &latency.pointer);
        print(text, "the table shows the paint", &latency.canvas);
        print(text, "the patch shows it", &latency.preview);
    }
    return true;
}
#else
bool wr_bench_window(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    (void)cli, (void)quick, (void)text, (void)err;
    return true; /* built without a window */
}
#endif
