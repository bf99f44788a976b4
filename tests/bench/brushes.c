/* Dab benchmark: one motion with libmypaint's default brush (hardness 0.8, two dabs per radius) is drawn three times: by
   the library's own MyPaintFixedTiledSurface (16-bit RGBA), by our engine into our tiles, and as our plain round dabs at
   the same distance. All on one thread, with all memory pages touched before. */
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "bench/bench.h"
#include "brush/brush.h"
#include "brush/mypaint_engine.h"
#include "brush/preset.h"
#include "cli/cli.h"
#include "field/field.h"
#include "system/clock.h"

#include <libmypaint/mypaint-brush.h>
#include <libmypaint/mypaint-fixed-tiled-surface.h>
#include <math.h>
#include <string.h>

#define STEP 16.0     /* texels between events */
#define SECONDS 0.008 /* between events */
#define HARDNESS 0.8  /* libmypaint's default */
#define ROUNDS_MAX 15

static const char preset_text[] =
    "{\"version\":3,\"settings\":{\"opaque_multiply\":{\"base_value\":0,"
    "\"inputs\":{\"pressure\":[[0,0],[1,1]]}}}}";

typedef struct Pace {
    double radius;                          /* texels */
    int table;                              /* texels along a side */
    int events;                             /* of the motion, 16 texels and 8 ms apart */
    int peer_dabs, engine_dabs, round_dabs; /* resulting number of dabs */
} Pace;

/* Tables and brushes, reused in all rounds. */
typedef struct Race {
    Pace pace;
    MyPaintFixedTiledSurface *surface;
    WrField *engine_field, *round_field;
    WrPreset *preset;
    WrSample *events, *places; /* of the motion; of the round dabs; owned */
} Race;

/* Event k: the path circles so that 1.5 radii stay within the table, or remains at its middle. */
static WrSample event(const Pace *pace, int k)
{
    double half = 0.5 * pace->table, room = half - 1.5 * pace->radius - 2.0;
    if (room < 0.1 * half) room = 0.1 * half;
    double turns = STEP * k / (2.0 * WR_PI * room), sine, cosine;
    wr_sincos_turns(turns, &sine, &cosine);
    double shrink = room * (1.0 - 0.3 * (turns - floor(turns)));
    return (WrSample){ .u = 0.5 + shrink * cosine / pace->table,
                       .v = 0.5 + shrink * sine / pace->table,
                       .pressure = 1.0,
                       .seconds = SECONDS * k };
}

static WrBrush engine_brush(const WrPreset *preset, double radius)
{
    WrBrush brush = wr_preset_brush(preset);
    brush.radius = radius;
    brush.hardness = HARDNESS;
    brush.mode = WR_BRUSH_RAISE;
    return brush;
}

/* ---- counting ---- */

typedef struct Counter {
    MyPaintSurface surface; /* first member: the callback receives its address */
    int dabs;
} Counter;

static int count_dab(MyPaintSurface *self, float x, float y, float radius, float r, float g,
                     float b, float opaque, float hardness, float alpha_eraser, float aspect,
                     float angle, float lock_alpha, float colorize)
{
    (void)x, (void)y, (void)radius, (void)r, (void)g, (void)b, (void)opaque, (void)hardness;
    (void)alpha_eraser, (void)aspect, (void)angle, (void)lock_alpha, (void)colorize;
    ((Counter *)self)->dabs++;
    return 1;
}

static void count_ours(void *ctx, const WrDab *dab)
{
    (void)dab;
    ++*(int *)ctx;
}

/* Draws the library's stroke; `surface` may be one that only counts. */
static void peer_stroke(const Pace *pace, const WrSample *events, MyPaintSurface *surface,
                        bool atomic)
{
    MyPaintBrush *brush = mypaint_brush_new();
    mypaint_brush_from_defaults(brush);
    float radius = (float)(wr_log2(pace->radius) * 0.69314718055994531);
    mypaint_brush_set_base_value(brush, MYPAINT_BRUSH_SETTING_RADIUS_LOGARITHMIC, radius);
    mypaint_brush_set_base_value(brush, MYPAINT_BRUSH_SETTING_HARDNESS, (float)HARDNESS);
    mypaint_brush_new_stroke(brush);
    for (int k = 0; k < pace->events; k++) {
        WrSample s = events[k];
        float x = (float)(s.u * pace->table), y = (float)((1.0 - s.v) * pace->table);
        if (k == 0) mypaint_brush_stroke_to(brush, surface, x, y, 0.0f, 0.0f, 0.0f, 10.0);
        if (atomic) mypaint_surface_begin_atomic(surface);
        mypaint_brush_stroke_to(brush, surface, x, y, 1.0f, 0.0f, 0.0f, SECONDS);
        MyPaintRectangle changed;
        if (atomic) mypaint_surface_end_atomic(surface, &changed);
    }
    mypaint_brush_unref(brush);
}

static int count_engine(const Pace *pace, const WrSample *events, const WrPreset *preset)
{
    int dabs = 0;
    WrBrush brush = engine_brush(preset, pace->radius);
    WrDabSink sink = { .ctx = &dabs, .dab = count_ours };
    WrEngine *engine = wr_engine_new(&brush, &sink);
    for (int k = 0; k < pace->events; k++) {
        WrSample s = events[k];
        WrEnginePoint point = { .x = s.u * pace->table,
                                .y = (1.0 - s.v) * pace->table,
                                .pressure = 1.0,
                                .seconds = s.seconds };
        wr_engine_push(engine, &point);
    }
    wr_engine_pen_up(engine);
    while (wr_engine_step(engine)) {
    }
    wr_engine_free(engine);
    return dabs;
}

static WrPreset *default_preset(WrError *err)
{
    return wr_preset_parse(preset_text, sizeof preset_text - 1, "default", NULL, err);
}

/* The length of the motion for about that many dabs, and their exact numbers. */
static bool find_pace(int table, double radius, int dabs, Pace *pace, WrError *err)
{
    WrPreset *preset = default_preset(err);
    if (!preset) return false;
    *pace = (Pace){ .radius = radius, .table = table };
    pace->events = (int)ceil(dabs * 0.5 * radius / STEP) + 1;
    WrSample *events = wr_alloc((size_t)pace->events, sizeof *events);
    for (int k = 0; k < pace->events; k++) events[k] = event(pace, k);
    Counter counter = { .dabs = 0 };
    mypaint_surface_init(&counter.surface);
    counter.surface.draw_dab = count_dab;
    peer_stroke(pace, events, &counter.surface, false);
    pace->peer_dabs = counter.dabs;
    pace->engine_dabs = count_engine(pace, events, preset);
    pace->round_dabs = (int)((pace->events - 1) * STEP / (0.5 * radius));
    wr_preset_free(preset);
    wr_free(events);
    return true;
}

/* ---- measurement ---- */

static void race_free(Race *race)
{
    if (!race) return;
    if (race->surface) mypaint_surface_unref(mypaint_fixed_tiled_surface_interface(race->surface));
    wr_field_free(race->engine_field);
    wr_field_free(race->round_field);
    wr_preset_free(race->preset);
    wr_free(race->events);
    wr_free(race->places);
    wr_free(race);
}

static Race *race_new(const Pace *pace, WrError *err)
{
    Race *race = wr_alloc(1, sizeof *race);
    race->pace = *pace;
    race->events = wr_alloc((size_t)pace->events, sizeof *race->events);
    race->places = wr_alloc((size_t)pace->round_dabs + 1, sizeof *race->places);
    for (int k = 0; k < pace->events; k++) race->events[k] = event(pace, k);
    for (int k = 0; k < pace->round_dabs; k++) {
        double at = k * 0.5 * pace->radius / STEP; /* in events */
        WrSample a = event(pace, (int)at), b = event(pace, (int)at + 1);
        double t = at - floor(at);
        race->places[k].u = a.u + t * (b.u - a.u);
        race->places[k].v = a.v + t * (b.v - a.v);
    }
    race->preset = default_preset(err);
    int n = pace->table;
    race->engine_field = wr_field_new(n, n, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, err);
    race->round_field = wr_field_new(n, n, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, err);
    if (race->preset && race->engine_field && race->round_field) {
        race->surface = mypaint_fixed_tiled_surface_new(n, n);
        return race;
    }
    race_free(race);
    return NULL;
}

/* Seconds of one round. */
static double time_peer(Race *race)
{
    double start = wr_clock_seconds();
    peer_stroke(&race->pace, race->events, mypaint_fixed_tiled_surface_interface(race->surface),
                true);
    return wr_clock_seconds() - start;
}

static double time_engine(Race *race)
{
    double start = wr_clock_seconds();
    WrBrush brush = engine_brush(race->preset, race->pace.radius);
    WrStroke *stroke = wr_stroke_new(race->engine_field, &brush);
    for (int k = 0; k < race->pace.events; k++) wr_stroke_add(stroke, race->events[k]);
    wr_stroke_finish(stroke);
    return wr_clock_seconds() - start;
}

static double time_round(Race *race)
{
    const Pace *pace = &race->pace;
    WrBrush brush = wr_brush_default();
    brush.radius = pace->radius;
    brush.hardness = HARDNESS;
    double start = wr_clock_seconds();
    for (int k = 0; k < pace->round_dabs; k++) {
        wr_brush_dab(race->round_field, &brush, race->places[k].u, race->places[k].v);
    }
    return wr_clock_seconds() - start;
}

/* ---- results ---- */

/* Dabs of one radius: medians in dabs per second on one thread. */
typedef struct Rates {
    int table;
    double radius;
    double peer;   /* libmypaint's own surface */
    double engine; /* its engine with the same brush and motion, on our tiles */
    double round;  /* our round brush, with the same spacing */
} Rates;

static double rate(double dabs, double seconds)
{
    return seconds > 0 ? dabs / seconds : 0;
}

static bool measure(const WrCli *cli, Rates *brush, int dabs, int rounds, WrError *err)
{
    Pace pace;
    if (!find_pace(brush->table, brush->radius, dabs, &pace, err)) return false;
    Race *race = race_new(&pace, err);
    if (!race) return false;
    rounds = rounds < ROUNDS_MAX ? rounds : ROUNDS_MAX;
    double times[3][ROUNDS_MAX];
    bool good = true;
    for (int k = -1; k < rounds && good;
         k++) { /* the first run warms the memory and is not counted */
        double seconds[] = { time_peer(race), time_engine(race), time_round(race) };
        for (int n = 0; n < 3 && k >= 0; n++) times[n][k] = seconds[n];
        if (wr_cancel_requested(cli->cancel)) good = wr_fail(err, "interrupted");
    }
    race_free(race);
    if (!good) return false;
    brush->peer = rate(pace.peer_dabs, wr_bench_median(times[0], rounds));
    brush->engine = rate(pace.engine_dabs, wr_bench_median(times[1], rounds));
    brush->round = rate(pace.round_dabs, wr_bench_median(times[2], rounds));
    return true;
}

static const Rates sizes[] = { { .radius = 4 }, { .radius = 32 }, { .radius = 256 } };
static const int dab_counts[] = { 60000, 6000, 300 };

/* 'brush radius who table threads ms', ms of one dab. */
bool wr_bench_brush_lines(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    for (int i = 0; i < 3; i++) {
        Rates b = sizes[i];
        b.table = 4096;
        if (!measure(cli, &b, dab_counts[i], quick ? 3 : 9, err)) return false;
        const double rates[] = { b.peer, b.engine, b.round };
        static const char *const names[] = { "libmypaint", "engine", "round" };
        for (int n = 0; n < 3; n++)
            wr_text_addf(text, "brush %g %s %d 1 %.6f\n", b.radius, names[n], b.table,
                         rates[n] > 0 ? 1e3 / rates[n] : 0);
    }
    return true;
}

/* Nanoseconds of one round dab; all dabs hit the same few tiles in the table's middle. */
static double time_dab(WrField *field)
{
    enum { DABS = 4000 };
    double side = wr_field_width(field), start = wr_clock_seconds();
    WrBrush brush = wr_brush_default();
    brush.radius = 32.0;
    for (int i = 0; i < DABS; i++)
        wr_brush_dab(field, &brush, 0.5 + i * 16 % 200 / side, 0.5 + i * 7 % 150 / side);
    return 1e9 * (wr_clock_seconds() - start) / DABS;
}

/* The same dabs on a small and on a large table, alternating. */
static bool add_sizes(bool quick, WrText *text, WrError *err)
{
    static const int sides[2] = { 512, 16384 };
    WrField *fields[2] = { NULL, NULL };
    double times[2][ROUNDS_MAX], median[2];
    int rounds = quick ? 5 : ROUNDS_MAX;
    bool good = true;
    for (int t = 0; t < 2 && good; t++) {
        fields[t] = wr_field_new(sides[t], sides[t], WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, err);
        good = fields[t] != NULL;
    }
    for (int k = -1; k < rounds && good; k++)
        for (int t = 0; t < 2; t++) {
            double ns = time_dab(fields[t]);
            if (k >= 0) times[t][k] = ns;
        }
    for (int t = 0; t < 2 && good; t++) median[t] = wr_bench_median(times[t], rounds);
    if (good)
        wr_text_addf(text,
                     "  a dab of radius 32: %.0f ns on a table of %dx%d, %.0f on %dx%d: %.2f "
                     "times as long\n",
                     median[0], sides[0], sides[0], median[1], sides[1], sides[1],
                     median[1] / median[0]);
    for (int t = 0; t < 2; t++) wr_field_free(fields[t]);
    return good;
}

bool wr_bench_brush_table(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    wr_text_addf(text, "\ndabs a second         %12s %8s %12s %8s %6s %12s %8s %6s\n", "libmypaint",
                 "Mpixel/s", "its engine", "Mpixel/s", "ratio", "round", "Mpixel/s", "ratio");
    for (int i = 0; i < 3; i++) {
        Rates b = sizes[i];
        b.table = 4096;
        if (!measure(cli, &b, dab_counts[i], quick ? 3 : 9, err)) return false;
        double mega = 3.14159265358979 * b.radius * b.radius * 1e-6;
        wr_text_addf(text, "  radius %-12g %12.0f %8.0f %12.0f %8.0f %6.2f %12.0f %8.0f %6.2f\n",
                     b.radius, b.peer, b.peer * mega, b.engine, b.engine * mega, b.engine / b.peer,
                     b.round, b.round * mega, b.round / b.peer);
    }
    return add_sizes(quick, text, err);
}
