/* Benchmark of growth: doubles one quantity at a time and compares processor time with the work. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "bench/bench.h"
#include "cli/cli.h"
#include "command/session.h"
#include "document/document.h"
#include "export/export.h"
#include "export/preview.h"
#include "render/frame/frame.h"
#include "system/clock.h"

#include <math.h>
#include <string.h>

#define SIZES 4
#define ROUNDS_MAX 15
#define DABS 20         /* of a round */
#define LIMIT 1.1       /* exponent of work that grows linearly */
#define LIMIT_NONE 0.2  /* of work that does not grow: noise alone reaches 0.1 */
#define NEGLIGIBLE 0.02 /* milliseconds: less has no exponent */

typedef struct Bench {
    const WrCli *cli;
    WrSession *session;
    int size;  /* value of the quantity that is doubled */
    int round; /* counts up, so that no round repeats the one before it */
} Bench;

/* ---- scenes: command lines, separated by line ends ---- */

static void table(int side, WrText *script)
{
    wr_text_addf(script, "table %dx%d\nnoise gradient cells=8 octaves=3\n", side, side);
}

static void picture(int side, WrText *script)
{
    (void)side;
    table(512, script);
    wr_text_add(script, "surface sphere\ndials aa=point\n");
}

static void add_layers(int count, bool hidden, WrText *script)
{
    for (int i = 0; i < count; i++) {
        wr_text_addf(script, "layer add blend=add\nnoise gradient cells=%d\n", 4 + i);
        if (hidden) wr_text_addf(script, "layer set %d visible=off\n", i + 2);
    }
}

static void layers(int count, WrText *script)
{
    table(1024, script);
    add_layers(count - 1, false, script);
}

static void hidden_layers(int count, WrText *script)
{
    table(1024, script);
    add_layers(count, true, script);
    wr_text_add(script, "layer use 1\n");
}

/* The object uses the first layer alone. */
static void unread_layers(int count, WrText *script)
{
    table(1024, script);
    add_layers(count, false, script);
    wr_text_add(script, "surface sphere\nobject set layer=1\nlayer use 1\n");
}

static void brush(int radius, WrText *script)
{
    (void)radius;
    table(4096, script);
}

static void add_objects(int count, const char *options, WrText *script)
{
    for (int i = 0; i < count; i++)
        wr_text_addf(script, "object add o%d at=%g,%g,0 size=0.15 %s\nsurface sphere\n", i,
                     0.35 * (i % 4) - 0.5, 0.35 * (i / 4 % 4) - 0.5, options);
}

static void objects(int count, WrText *script)
{
    picture(0, script);
    wr_text_add(script, "object set size=0.15 at=0,0.9,0\n");
    add_objects(count - 1, "", script);
}

static void hidden_objects(int count, WrText *script)
{
    picture(0, script);
    add_objects(count, "hidden=on", script);
}

static void lights(int count, WrText *script)
{
    picture(0, script);
    wr_text_add(script, "light clear\n");
    for (int i = 0; i < count; i++)
        wr_text_addf(script, "light directional to=%g,%g,1 strength=0.1\n", 0.1 * i,
                     0.3 - 0.05 * i);
}

/* ---- work ---- */

static bool run(const Bench *b, const char *line, WrError *err)
{
    if (!wr_session_run(b->session, line, err)) return false;
    wr_document_composite(wr_session_document(b->session), b->cli->pool);
    return true;
}

static bool invert(const Bench *b, WrError *err)
{
    return run(b, "adjust invert", err);
}

static bool map(const Bench *b, const char *kind, WrError *err)
{
    WrExportOptions options = wr_export_default();
    WrExportPreview preview;
    options.directions = 8;
    if (!wr_export_preview(wr_export_find(kind), wr_session_document(b->session), &options,
                           b->cli->pool, &preview, err))
        return false;
    wr_export_preview_fini(&preview);
    return true;
}

static bool normals(const Bench *b, WrError *err)
{
    return map(b, "normal+y", err);
}

static bool occlusion(const Bench *b, WrError *err)
{
    return map(b, "occlusion", err);
}

static bool change_layer(const Bench *b, WrError *err)
{
    return run(b, b->round % 2 ? "layer set 1 opacity=0.5" : "layer set 1 opacity=0.6", err);
}

static bool dab_of(const Bench *b, int radius, WrError *err)
{
    char line[64];
    snprintf(line, sizeof line, "dab %.3f,%.3f radius=%d", 0.3 + 0.017 * b->round,
             0.6 - 0.011 * b->round, radius);
    return run(b, line, err);
}

static bool wide_dab(const Bench *b, WrError *err)
{
    return dab_of(b, b->size, err);
}

static bool dabs(const Bench *b, WrError *err)
{
    for (int i = 0; i < DABS; i++)
        if (!dab_of(b, 32, err)) return false;
    return true;
}

static bool frame_of(const Bench *b, int side, WrError *err)
{
    WrFrame frame;
    return wr_session_frame(b->session, side, side, 7.3 * b->round, &frame, err);
}

static bool large_frame(const Bench *b, WrError *err)
{
    return frame_of(b, b->size, err);
}

static bool frame(const Bench *b, WrError *err)
{
    return frame_of(b, 512, err);
}

static bool invert_frame(const Bench *b, WrError *err)
{
    return wr_session_run(b->session, "adjust invert", err) && frame_of(b, 64, err);
}

/* ---- rows ---- */

typedef struct Row {
    const char *work, *doubled;
    int from;  /* the first size; each further one is twice as large */
    int power; /* the work is proportional to this power of the size; 0: it does not depend on it */
    void (*scene)(int size, WrText *script);
    bool (*once)(const Bench *b, WrError *err);
    int steps; /* of each round, which are undone: new memory for the history would be counted too */
} Row;

static const Row rows[] = {
    { "inverting a table", "side", 512, 2, table, invert, 1 },
    { "normal map", "side of the table", 512, 2, table, normals, 0 },
    { "occlusion map", "side of the table", 512, 2, table, occlusion, 0 },
    { "picture of a sphere", "side", 256, 2, picture, large_frame, 0 },
    { "all of a table of layers", "layers", 2, 1, layers, change_layer, 0 },
    { "dab on 4096 x 4096", "radius", 64, 2, brush, wide_dab, 1 },
    { "picture of spheres", "objects", 2, 1, objects, frame, 0 },
    { "picture under lamps", "lights", 2, 1, lights, frame, 0 },
    { "20 dabs of radius 32", "side of the table", 1024, 0, table, dabs, DABS },
    { "20 dabs of radius 32", "hidden layers", 2, 0, hidden_layers, dabs, DABS },
    { "edit of a layer, picture", "layers that no object uses", 2, 0, unread_layers, invert_frame,
      1 },
    { "picture of a sphere", "hidden objects", 2, 0, hidden_objects, frame, 0 },
};

static bool run_script(WrSession *session, char *script, WrError *err)
{
    for (char *line = script, *end; *line; line = end + 1) {
        end = strchr(line, '\n');
        *end = '\0';
        if (!wr_session_run(session, line, err)) return false;
    }
    return true;
}

/* Least processor time of one size, in milliseconds: other work on the machine only adds to it. */
static bool time_size(const WrCli *cli, const Row *row, int size, int rounds, double *ms,
                      WrError *err)
{
    Bench b = { .cli = cli, .session = wr_cli_session(cli, false, err), .size = size };
    WrText script = { 0 };
    double times[ROUNDS_MAX];
    row->scene(size, &script);
    bool good = b.session && run_script(b.session, script.data, err);
    for (int i = -2; i < rounds && good; i++, b.round++) { /* two rounds fill caches */
        const double start = wr_clock_process_seconds();
        good = row->once(&b, err);
        if (i >= 0) times[i] = 1e3 * (wr_clock_process_seconds() - start);
        for (int k = 0; k < row->steps && good; k++) good = wr_session_run(b.session, "undo", err);
        if (good && wr_cancel_requested(cli->cancel)) good = wr_fail(err, "interrupted");
    }
    if (good) wr_bench_median(times, rounds); /* sorts them */
    if (good) *ms = times[0];
    wr_text_fini(&script);
    wr_session_free(b.session);
    return good;
}

/* Slope of the line of least squares through the logarithms: the power of the work that the time grows with. Sizes are
   equally spaced there, at -1.5, -0.5, 0.5 and 1.5 doublings about their middle. */
static double exponent(const double ms[SIZES], int power)
{
    double sum = 0, squares = 0;
    for (int k = 0; k < SIZES; k++) {
        const double x = k - 0.5 * (SIZES - 1);
        sum += x * log2(fmax(ms[k], NEGLIGIBLE));
        squares += x * x;
    }
    return sum / squares / (power ? power : 1);
}

static bool add_row(const WrCli *cli, const Row *row, int rounds, WrText *text, WrError *err)
{
    double ms[SIZES];
    char name[80];
    for (int k = 0; k < SIZES; k++)
        if (!time_size(cli, row, row->from << k, rounds, &ms[k], err)) return false;
    const double grows = exponent(ms, row->power),
                 last = log2(fmax(ms[SIZES - 1], NEGLIGIBLE) / fmax(ms[SIZES - 2], NEGLIGIBLE));
    snprintf(name, sizeof name, "%s: %s", row->work, row->doubled);
    wr_text_addf(text, "  %-52s %4d", name, row->from);
    for (int k = 0; k < SIZES; k++) wr_text_addf(text, " %9.3f", ms[k]);
    wr_text_addf(text, " %9.2f %6.2f", grows, last / (row->power ? row->power : 1));
    wr_text_add(text, grows > (row->power ? LIMIT : LIMIT_NONE) ? "  above its limit\n" : "\n");
    return true;
}

bool wr_bench_scale(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    wr_text_addf(text, "\n%-54s %4s %9s %9s %9s %9s %9s %6s\n",
                 "growth, least ms of processor time", "from", "1", "x 2", "x 4", "x 8", "exponent",
                 "last");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (!add_row(cli, &rows[i], quick ? 5 : ROUNDS_MAX, text, err)) return false;
    wr_text_addf(text,
                 "  exponent of the time in the work: at most %g, or %g where the work stays\n",
                 LIMIT, LIMIT_NONE);
    return true;
}
