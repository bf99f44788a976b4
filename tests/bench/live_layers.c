/* Benchmark of 40 live layers: a value of one layer is dragged, then released. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "bench/bench.h"
#include "cli/cli.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "render/frame/frame.h"
#include "scene/scene.h"
#include "system/clock.h"
#include "system/thread.h"

#include <stdio.h>

#ifdef WR_HAVE_UI
#include "ui/app/jobs/edit_preview.h"
#endif

#define ROUNDS 20

/* Generators, filters, live masks of every kind, edges and terraces, as a wall with letters has them. */
static const char *const lines[] = {
    "table 2048x2048",
    "layer add ground from=\"noise perlin cells=6 amplitude=0.1 blend=add\"",
    "layer add wall from=\"pattern bricks rows=10 height=0.2 blend=max\"",
    "layer add grain from=\"noise perlin cells=40 amplitude=0.02 blend=add\"",
    "layer mask grain live=\"slope low=0 high=30 soft=10\"",
    "layer add weave from=\"pattern knurl height=0.05 blend=add\"",
    "layer add chips from=\"noise perlin cells=24 amplitude=0.05 seed=5 blend=add\"",
    "layer mask chips live=\"curvature side=convex scale=2\"",
    "layer add dots from=\"pattern dots height=0.05 blend=add\"",
    "filter blur sigma=1.5",
    "layer add title1 from=\"text WRINKLE size=200 height=0.2 at=0.5,0.20\"",
    "layer add cord1 from=\"rim kind=outline layer=title1 width=9 height=0.05\"",
    "layer add title2 from=\"text WRINKLE size=220 height=0.2 at=0.5,0.35\"",
    "layer add cord2 from=\"rim kind=outline layer=title2 width=9 height=0.05\"",
    "layer add title3 from=\"text WRINKLE size=240 height=0.2 at=0.5,0.50\"",
    "layer add cord3 from=\"rim kind=outline layer=title3 width=9 height=0.05\"",
    "layer add title4 from=\"text WRINKLE size=260 height=0.2 at=0.5,0.65\"",
    "layer add cord4 from=\"rim kind=outline layer=title4 width=9 height=0.05\"",
    "layer add dirt from=\"noise perlin cells=10 amplitude=0.05 level=-0.05 blend=add\"",
    "layer mask dirt live=\"occlusion reach=16; noise cells=6\"",
    "layer add ball1 from=\"solid sphere at=0.2,0.1 radius=60 height=0.3\"",
    "layer add ball2 from=\"solid sphere at=0.3,0.4 radius=70 height=0.3\"",
    "layer add ball3 from=\"solid sphere at=0.4,0.7 radius=80 height=0.3\"",
    "layer add ball4 from=\"solid sphere at=0.5,0.3 radius=90 height=0.3\"",
    "layer add ball5 from=\"solid sphere at=0.6,0.6 radius=100 height=0.3\"",
    "layer add ball6 from=\"solid sphere at=0.7,0.2 radius=110 height=0.3\"",
    "layer add stripes from=\"pattern stripes height=0.03 blend=add\"",
    "layer mask stripes live=\"height low=0.2 high=2 soft=0.1\"",
    "filter curves points=0,0;0.5,0.45;1,1",
    "layer add rock from=\"noise perlin cells=16 amplitude=0.05 seed=8 blend=add\"",
    "layer mask rock live=\"direction angle=90; mask of=grain op=max\"",
    "layer add date1 from=\"text 2021 size=120 height=0.1 at=0.2,0.9\"",
    "layer add date2 from=\"text 2022 size=120 height=0.1 at=0.4,0.9\"",
    "layer add date3 from=\"text 2023 size=120 height=0.1 at=0.6,0.9\"",
    "layer add date4 from=\"text 2024 size=120 height=0.1 at=0.8,0.9\"",
    "layer add steps from=\"terrain terraces\"",
    "layer set steps opacity=0.3",
    "layer add worn from=\"noise perlin cells=12 amplitude=-0.03 seed=9 blend=add\"",
    "layer mask worn live=wear",
    "layer add edge from=\"rim of=heights level=0.4 width=5 height=0.02\"",
    "layer add plate1 from=\"solid cylinder at=0.2,0.5 radius=70 height=0.1\"",
    "layer add plate2 from=\"solid cylinder at=0.5,0.5 radius=70 height=0.1\"",
    "layer add plate3 from=\"solid cylinder at=0.8,0.5 radius=70 height=0.1\"",
    "layer add seal from=\"text S size=90 height=0.1 at=0.1,0.9\"",
    "layer add fuzz from=\"noise perlin cells=60 amplitude=0.01 seed=11 blend=add\"",
    "layer mask fuzz live=\"curvature side=concave scale=3; noise\"",
    "layer add crest from=\"text C size=90 height=0.1 at=0.9,0.1\"",
    "layer add last from=\"noise perlin cells=30 amplitude=0.02 seed=12 blend=add\"",
};

/* A dragged value: value k of a drag is from + k step. */
static const struct Drag {
    const char *layer, *label;
    const char *line, *name; /* without the value, and its name */
    double from, step;
} drags[] = {
    { "ground", "noise at the bottom", "noise perlin cells=6", "amplitude", 0.08, 0.001 },
    { "title1", "letters near the bottom", "text WRINKLE size=200 at=0.5,0.2", "height", 0.1,
      0.004 },
    { "dirt", "noise in the middle", "noise perlin cells=10 level=-0.05", "amplitude", 0.04,
      0.001 },
    { "ball6", "a sphere in the middle", "solid sphere at=0.7,0.2 radius=110", "height", 0.2,
      0.004 },
    { "last", "noise at the top", "noise perlin cells=30 seed=12", "amplitude", 0.01, 0.001 },
    { "crest", "a letter near the top", "text C size=90 at=0.9,0.1", "height", 0.05, 0.004 },
};

static double since(double start)
{
    return 1e3 * (wr_clock_seconds() - start);
}

typedef struct Times {
    double half, most; /* medians and 95 % */
} Times;

static Times times_of(double *ms, int count)
{
    const double half = wr_bench_median(ms, count); /* sorts */
    return (Times){ half, ms[(95 * count + 99) / 100 - 1] };
}

static void line_of(int drag, int k, char *line, size_t size)
{
    snprintf(line, size, "%s %s=%g", drags[drag].line, drags[drag].name,
             drags[drag].from + drags[drag].step * k);
}

/* Milliseconds of one value until the command and all that follows it are done, and processor time of all threads. */
static bool release(const WrCli *cli, WrSession *session, int drag, int k, double *ms,
                    double *cpu_ms, WrError *err)
{
    char line[160], command[256];
    line_of(drag, k, line, sizeof line);
    snprintf(command, sizeof command, "layer set %s from=\"%s\"", drags[drag].layer, line);
    const double start = wr_clock_seconds(), used = wr_clock_process_seconds();
    const bool good = wr_session_run(session, command, err);
    if (good) wr_document_composite(wr_session_document(session), cli->pool);
    *ms = since(start);
    *cpu_ms = 1e3 * (wr_clock_process_seconds() - used);
    return good;
}

#ifdef WR_HAVE_UI
static uint64_t key_of(const WrField *field)
{
    return field ? wr_field_key(field) : 0;
}

/* Milliseconds of one value until the table has its first form, and until the patch has. */
static bool drag_to(WrEditPreview *trial, WrRenderer *renderer, const WrDocument *document,
                    int drag, int k, double *table_ms, double *patch_ms, WrError *err)
{
    char line[160];
    WrFrame frame;
    const int index = wr_document_find_below(document, document->layer_count, drags[drag].layer);
    const WrLayer *layer = &document->layers[index];
    const WrEditPreviewRequest request = { .line = line,
                                           .target = WR_LINE_OF_LAYER,
                                           .rough = true,
                                           .layer = index,
                                           .blend = layer->blend,
                                           .opacity = layer->opacity,
                                           .radius = layer->radius };
    line_of(drag, k, line, sizeof line);
    const uint64_t before = key_of(wr_edit_preview_field(trial));
    const double start = wr_clock_seconds();
    wr_edit_preview_request(trial, document, &request);
    const WrField *field = NULL;
    while (key_of(field = wr_edit_preview_field(trial)) == before) {
        if (wr_edit_preview_error(trial, err)) return false;
        if (!wr_edit_preview_busy(trial, NULL, NULL)) break; /* the same heights */
        wr_thread_sleep_ms(1);
    }
    *table_ms = since(start);
    const WrFrameRequest picture = { .field = field,
                                     .scene = document->scene,
                                     .width = 512,
                                     .height = 512,
                                     .keep = true,
                                     .codes = { .wanted = true } };
    const bool good = wr_renderer_frame(renderer, &picture, &frame, err);
    *patch_ms = since(start);
    return good;
}

static bool time_drag(const WrCli *cli, const WrDocument *document, int drag, int rounds,
                      WrText *text, WrError *err)
{
    double table[ROUNDS + 1], patch[ROUNDS + 1];
    WrEditPreview *trial = wr_edit_preview_new(wr_bench_threads(cli), SDL_USEREVENT);
    WrRenderer *renderer = wr_renderer_new(cli->pool, cli->isa, err);
    bool good = renderer;
    for (int k = 0; good && k <= rounds; k++) {
        good = drag_to(trial, renderer, document, drag, k, &table[k], &patch[k], err);
        if (good && wr_cancel_requested(cli->cancel)) good = wr_fail(err, "interrupted");
    }
    wr_edit_preview_free(trial);
    wr_renderer_free(renderer);
    if (!good) return false;
    /* the first value of a drag makes the small copies too */
    const double begin = patch[0];
    const Times tables = times_of(table + 1, rounds), patches = times_of(patch + 1, rounds);
    wr_text_addf(text, " %8.1f %8.1f %8.1f %8.1f %8.1f", begin, tables.half, tables.most,
                 patches.half, patches.most);
    return true;
}
#else
static bool time_drag(const WrCli *cli, const WrDocument *document, int drag, int rounds,
                      WrText *text, WrError *err)
{
    (void)cli, (void)document, (void)drag, (void)rounds, (void)err;
    wr_text_addf(text, " %8s %8s %8s %8s %8s", "-", "-", "-", "-", "-");
    return true;
}
#endif

static bool time_release(const WrCli *cli, WrSession *session, int drag, int rounds, WrText *text,
                         WrError *err)
{
    double ms[ROUNDS], cpu_ms[ROUNDS];
    for (int k = 0; k < rounds; k++) {
        if (!release(cli, session, drag, k, &ms[k], &cpu_ms[k], err)) return false;
        if (wr_cancel_requested(cli->cancel)) return wr_fail(err, "interrupted");
    }
    const Times times = times_of(ms, rounds);
    wr_text_addf(text, " %8.0f %8.0f %8.0f\n", times.half, times.most,
                 wr_bench_median(cpu_ms, rounds));
    return true;
}

bool wr_bench_live_layers(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    const int dragged = quick ? 10 : ROUNDS, released = quick ? 3 : 9;
    WrSession *session = wr_cli_session(cli, false, err);
    bool good = session;
    for (size_t i = 0; good && i < sizeof lines / sizeof *lines; i++)
        good = wr_session_run(session, lines[i], err);
    if (good) wr_document_composite(wr_session_document(session), cli->pool);
    wr_text_addf(text, "\n%d live layers, 2048x2048; ms          %8s %8s %8s %8s %8s %8s %8s %8s\n",
                 good ? wr_session_document(session)->layer_count : 0, "begin", "table", "95 %",
                 "patch", "95 %", "exact", "95 %", "cpu");
    for (size_t i = 0; good && i < sizeof drags / sizeof *drags; i++) {
        wr_text_addf(text, "  %-36s", drags[i].label);
        good = time_drag(cli, wr_session_document(session), (int)i, dragged, text, err) &&
               time_release(cli, session, (int)i, released, text, err);
    }
    wr_session_free(session);
    return good;
}
