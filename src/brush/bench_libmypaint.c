#include "brush/bench_libmypaint.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "brush/engine.h"
#include "brush/preset.h"
#include "field/field.h"
#include "system/clock.h"

#include <libmypaint/mypaint-brush.h>
#include <libmypaint/mypaint-fixed-tiled-surface.h>
#include <math.h>
#include <string.h>

#define STEP 16.0     /* texels between events */
#define SECONDS 0.008 /* between events */
#define HARDNESS 0.8  /* libmypaint's default */

static const char preset_text[] =
    "{\"version\":3,\"settings\":{\"opaque_multiply\":{\"base_value\":0,"
    "\"inputs\":{\"pressure\":[[0,0],[1,1]]}}}}";

struct WrBrushRace {
    WrBrushPace pace;
    MyPaintFixedTiledSurface *surface;
    WrField *engine_field, *round_field;
    WrPreset *preset;
    WrSample *events, *places; /* of the motion; of the round dabs; owned */
};

/* Event k: the path circles so that 1.5 radii stay within the table, or remains at its middle. */
static WrSample event(const WrBrushPace *pace, int k)
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
static void peer_stroke(const WrBrushPace *pace, const WrSample *events, MyPaintSurface *surface,
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

static int count_engine(const WrBrushPace *pace, const WrSample *events, const WrPreset *preset)
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
    wr_engine_finish(engine);
    while (wr_engine_step(engine)) {
    }
    wr_engine_free(engine);
    return dabs;
}

static WrPreset *default_preset(WrError *err)
{
    return wr_preset_parse(preset_text, sizeof preset_text - 1, "default", NULL, err);
}

bool wr_brush_pace(int table, double radius, int dabs, WrBrushPace *pace, WrError *err)
{
    WrPreset *preset = default_preset(err);
    if (!preset) return false;
    *pace = (WrBrushPace){ .radius = radius, .table = table };
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

WrBrushRace *wr_brush_race_new(const WrBrushPace *pace, WrError *err)
{
    WrBrushRace *race = wr_alloc(1, sizeof *race);
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
    wr_brush_race_free(race);
    return NULL;
}

void wr_brush_race_free(WrBrushRace *race)
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

double wr_brush_race_peer(WrBrushRace *race)
{
    double start = wr_clock_seconds();
    peer_stroke(&race->pace, race->events, mypaint_fixed_tiled_surface_interface(race->surface),
                true);
    return wr_clock_seconds() - start;
}

double wr_brush_race_engine(WrBrushRace *race)
{
    double start = wr_clock_seconds();
    WrBrush brush = engine_brush(race->preset, race->pace.radius);
    WrStroke *stroke = wr_stroke_new(race->engine_field, &brush);
    for (int k = 0; k < race->pace.events; k++) wr_stroke_add(stroke, race->events[k]);
    wr_stroke_free(stroke);
    return wr_clock_seconds() - start;
}

double wr_brush_race_round(WrBrushRace *race)
{
    const WrBrushPace *pace = &race->pace;
    WrBrush brush = wr_brush_default();
    brush.radius = pace->radius;
    brush.hardness = HARDNESS;
    double start = wr_clock_seconds();
    for (int k = 0; k < pace->round_dabs; k++) {
        wr_brush_dab(race->round_field, &brush, race->places[k].u, race->places[k].v);
    }
    return wr_clock_seconds() - start;
}
