/* Latency benchmark of the window: from a pen motion to its display. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "bench/bench.h"
#include "cli/cli.h"
#include "system/clock.h"
#include "system/large_pages.h"
#include "system/path.h"
#include "system/process.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef WR_HAVE_UI
#include "ui/app/app.h"

static const char *const one_sphere[] = { "table 4096x4096", "grid cells=16x16 width=40 high=0.5",
                                          "surface sphere", NULL };

/* As on the cover of the proceedings with Blinn's paper; each object has its own layer. */
static const char *const three_objects[] = {
    "table 1024x512",
    "grid cells=16x16 width=12 high=0.5",
    "layer rename 1 bricks",
    "layer add rivets",
    "solid sphere radius=32 sink=6 across=10 rows=5 height=1",
    "layer add title",
    "text \"SIGGRAPH\" size=192 letters=14 at=0.5,0.68",
    "object set name=sphere at=0.75,0.6,-0.4 layer=bricks",
    "surface sphere",
    "bump height=0.05",
    "object add cube at=-0.9,0.55,-0.2 size=0.95 turn=28,-38,0 layer=rivets",
    "surface cube",
    "bump height=0.042",
    "object add ribbon at=0,-0.6,0.7 size=1.5 turn=-34,12,7 layer=title",
    "surface ribbon L=2.1 A=0.18 k=1 W=0.95",
    "bump height=0.02",
    "layer use 1",
    "camera perspective eye=0,0.25,6.9 target=0,0,0 fov=35 fit=on",
    NULL
};

/* Tables of 1 MB and of 1 GB of heights. */
static const char *const small_table[] = { "table 512x512", "grid cells=16x16 width=6 high=0.5",
                                           "surface sphere", NULL };
static const char *const huge_table[] = { "table 16384x16384", "grid cells=64x64 width=40 high=0.5",
                                          "surface sphere", NULL };
/* Bytes: heights, their composite, displayed values, rendered values, slopes. */
#define HUGE_NEEDS ((uint64_t)10 << 30)

static bool run_all(WrSession *session, const char *const *lines, WrError *err)
{
    for (int i = 0; lines[i]; i++)
        if (!wr_session_run(session, lines[i], err)) return false;
    return true;
}

static bool measure(const WrCli *cli, const char *const *scene, WrAppLatency *latency, WrError *err)
{
    WrSession *session = wr_cli_session(cli, true, err);
    WrAppOptions options = { .session = session, .threads = cli->threads, .isa = cli->isa };
    bool good = session && run_all(session, scene, err) && wr_app_latency(&options, latency, err);
    wr_session_free(session);
    return good;
}

static void print(WrText *text, const char *what, const WrAppDelays *ms)
{
    wr_text_addf(text, "    %-26s %9.1f %9.1f %9.1f %9.1f\n", what, ms->half, ms->most,
                 ms->nearly_all, ms->all);
}

/* Documents of two sizes in windows of two sizes: idle processor load, and latency. */
static bool add_sizes(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    static const struct {
        const char *what;
        const char *const *scene;
        int width, height;
        bool huge;
    } rows[] = { { "1 MB of heights, window of 1280x800", small_table, 1280, 800, false },
                 { "1 MB of heights, window of 2560x1440", small_table, 2560, 1440, false },
                 { "1 GB of heights, window of 1280x800", huge_table, 1280, 800, true },
                 { "1 GB of heights, window of 2560x1440", huge_table, 2560, 1440, true } };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (rows[i].huge && (quick || wr_pages_free_bytes() < HUGE_NEEDS)) {
            if (!quick)
                wr_text_addf(text, "  %s: left out, for want of %.0f GB of memory\n", rows[i].what,
                             (double)HUGE_NEEDS / 1073741824.0);
            continue;
        }
        WrAppLatency latency = { .radius = 16,
                                 .seconds = quick ? 2 : 20,
                                 .width = rows[i].width,
                                 .height = rows[i].height,
                                 .idle_seconds = quick ? 1 : 10 };
        if (!measure(cli, rows[i].scene, &latency, err)) return false;
        wr_text_addf(text, "  %s: at rest %.2f %% of a processor\n", rows[i].what,
                     100.0 * latency.idle);
        print(text, "the outline has moved", &latency.pointer);
        print(text, "the table shows the paint", &latency.canvas);
        print(text, "the patch shows it", &latency.preview);
    }
    return true;
}

#define STARTS 15 /* odd, for a median */

/* Milliseconds from the start command to the first picture of a hidden window, with its own settings in the folder;
   negative: no report. */
static double time_start(const char *program, const char *folder)
{
    WrText line = { 0 };
    double ms = -1;
    wr_text_addf(&line,
                 "cd '%s' && XDG_CONFIG_HOME='%s' WRINKLE_STATE='%s' SDL_VIDEODRIVER=dummy "
                 "WRINKLE_RENDERER=software WRINKLE_TIMING=%.6f '%s' paint >out 2>told </dev/null",
                 folder, folder, folder, wr_clock_seconds(), program);
    const bool ran = system(wr_text_get(&line)) == 0;
    wr_text_clear(&line);
    wr_text_addf(&line, "%s/told", folder);
    char *output = NULL;
    size_t length;
    WrError err;
    if (!ran || !wr_file_read(wr_text_get(&line), 65536, &output, &length, &err) ||
        sscanf(output, "first picture after %lf", &ms) != 1)
        ms = -1;
    wr_free(output);
    wr_text_fini(&line);
    return ms;
}

static void add_start(bool quick, WrText *text)
{
    char program[4096], folder[] = "/tmp/wrinkle-bench-XXXXXX", *beside = wr_program_folder();
    double ms[STARTS];
    const int count = quick ? 3 : STARTS;
    snprintf(program, sizeof program, "%s/wrinkle", beside);
    wr_free(beside);
    if (strchr(program, '\'') || !wr_folder_make_temporary(folder)) return;
    bool started = time_start(program, folder) > 0; /* the first start loads files into memory */
    for (int i = 0; i < count && started; i++) started = (ms[i] = time_start(program, folder)) > 0;
    if (started)
        wr_text_addf(
            text, "\nfrom the command to the window's first picture, without a display: %.0f ms\n",
            wr_bench_median(ms, count));
    else wr_text_add(text, "\nthe window's first picture: none\n");
    /* files that the window stores there */
    snprintf(program, sizeof program, "rm -r '%s'", folder);
    if (system(program) != 0) wr_text_addf(text, "%s: cannot be removed\n", folder);
}

bool wr_bench_window(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    static const struct {
        const char *what;
        const char *const *scene;
        double radius, seconds;
        bool turning;
    } rows[] = {
        { "table 4096x4096, brush of 32 texels, the patch rests", one_sphere, 16, 60, false },
        { "table 4096x4096, brush of 32 texels, the patch turns", one_sphere, 16, 20, true },
        { "table 4096x4096, brush of 1000 texels, the patch rests", one_sphere, 500, 20, false },
        { "three objects, brush of 32 texels, the patch rests", three_objects, 16, 20, false },
        { "three objects, brush of 32 texels, the patch turns", three_objects, 16, 20, true },
    };
    add_start(quick, text);
    wr_text_addf(
        text,
        "\npainting in the window: ms from an event until it is seen\n%-30s %9s %9s %9s %9s\n", "",
        "50 %", "95 %", "99 %", "100 %");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        WrAppLatency latency = { .radius = rows[i].radius,
                                 .seconds = quick ? rows[i].seconds / 10 : rows[i].seconds,
                                 .turning = rows[i].turning };
        if (!measure(cli, rows[i].scene, &latency, err)) return false;
        wr_text_addf(text, "  %s: %lld events, %lld pictures\n", rows[i].what,
                     (long long)latency.events, (long long)latency.pictures);
        print(text, "the outline has moved", &latency.pointer);
        print(text, "the table shows the paint", &latency.canvas);
        print(text, "the patch shows it", &latency.preview);
    }
    return add_sizes(cli, quick, text, err);
}
#else
bool wr_bench_window(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    (void)cli, (void)quick, (void)text, (void)err;
    return true; /* build without a window */
}
#endif
