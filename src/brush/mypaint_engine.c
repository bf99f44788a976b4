/* Driving libmypaint 1.6, with workarounds:

   - It computes in float; so positions are relative to an origin that moves by multiples of REBASE,
     radii above LARGE are halved together with all lengths (`unit`), and its output is checked.
   - Its current values are not set before its first step (and its v2 interface reads them): prime()
     makes steps without drawing.
   - Its random numbers always start equally, and cannot be seeded: a number of resets, each of which
     consumes one, selects another position in their sequence.
   - It prints on standard output that time runs backwards if a call ends exactly with a dab and float
     rounds to the wrong side: such a call is ended slightly earlier (nudge()).
   - The number of dabs per step depends on values that curves can make arbitrarily large: after
     DABS_PER_STEP the callback reduces its count (a radius of 1000 pixels, one dab per radius), which
     ends the step. */
#include "brush/mypaint_engine.h"

#include "base/array.h"
#include "base/exactmath.h"
#include "base/hash.h"
#include "brush/preset_internal.h"

#include <float.h>
#include <libmypaint/mypaint-brush.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

typedef struct WrKnot {
    WrEnginePoint point;
    bool jump; /* the pen jumps here from the previous knot without drawing */
} WrKnot;

struct WrEngine {
    MyPaintSurface2 surface; /* first member: the callbacks receive its address */
    MyPaintBrush *brush;
    WrPreset *preset; /* shared */
    WrDabSink sink;
    double unit;           /* texels per pixel of the library */
    WrBrush look;          /* the brush, for the properties it adds to dabs; its preset and tip are
                              shared */
    uint64_t number;       /* of the next dab */
    bool angles;           /* the preset determines the rotation of its dabs */
    double radius, flow;   /* texels; 0..1 */
    bool erases, smudges;  /* of the preset */
    bool begun, finished;  /* positioned; pen lifted */
    bool ended;            /* stepped to the last point */
    bool muted;            /* steps without drawing: dabs are ignored */
    int dabs;              /* of the present step */
    bool drew, touched;    /* a dab was ever made; the library made one, even if empty */
    double last_x, last_y; /* of the previous dab, texels */
    double origin_x, origin_y; /* texels */
    WR_ARRAY(WrKnot) knots;    /* `seconds` is the engine's own monotonic time */
    int at;                    /* `now` is between samples at and at + 1 */
    double given;              /* original time of the last point */
    double now;                /* engine time of the last step */
    double left;               /* time not yet passed to the library */
    double steps;              /* number of whole steps in it */
    WrEnginePoint pen;         /* its position in the library */
};

static inline double clamp(double x, double low, double high)
{
    return x > low ? (x < high ? x : high) : low; /* NaN becomes low */
}

/* Starts at a stroke's first point, with its pressure and tilt, and the height there for dragging. */
static void engine_begin(WrEngine *engine, const WrEnginePoint *first);
/* Moves to a point, which makes dabs. */
static void engine_go(WrEngine *engine, const WrEnginePoint *to, double seconds);
/* The library's own estimate of the number of dabs on that segment, for its present states. */
static double engine_count(const WrEngine *engine, const WrEnginePoint *to, double seconds);
/* The accumulated fraction of the next dab, 0..1. */
static double engine_due(const WrEngine *engine);
/* Makes one dab at the pen, if the brush makes any. */
static void engine_tap(WrEngine *engine);

/* ---- path ---- */

/* The path is a list of samples with times of the engine's own clock, which never runs backwards and skips long pauses. A step
   hands the library one straight piece of it; pieces end at corners, since the library draws its dabs on straight lines
   between two positions. */
#define STRIDE 8.0      /* radii and dabs: maximum motion of one call, ... */
#define NEAR_DAB 4e-6   /* dabs: distances too small for float */
#define STRIDES 65536   /* ... unless this many calls are not enough for a step */
#define CORNER 0.25     /* texels; largest deviation of a step from a corner */
#define FARTHEST 1e15   /* texels from the table's corner; halves are exact there */
#define LONGEST 65536.0 /* texels: the middle of a longer segment between two points is skipped */
/* texels per second: a slower motion is treated as this fast, after the rest */
#define SLOWEST 4.0

/* ---- the path ---- */

static void add_knot(WrEngine *engine, WrEnginePoint point, bool jump)
{
    if (engine->at > 1024) { /* earlier samples are no longer needed */
        engine->knots.count -= engine->at;
        memmove(engine->knots.data, engine->knots.data + engine->at,
                (size_t)engine->knots.count * sizeof *engine->knots.data);
        engine->at = 0;
    }
    wr_array_push(&engine->knots, ((WrKnot){ point, jump }));
}

/* Interpolates the pen between two points. */
static WrEnginePoint between(const WrEnginePoint *a, const WrEnginePoint *b, double seconds)
{
    double length = b->seconds - a->seconds;
    double t = length > 0.0 ? (seconds - a->seconds) / length : 1.0;
    return (WrEnginePoint){ .x = a->x + t * (b->x - a->x),
                            .y = a->y + t * (b->y - a->y),
                            .pressure = a->pressure + t * (b->pressure - a->pressure),
                            .tilt_x = a->tilt_x + t * (b->tilt_x - a->tilt_x),
                            .tilt_y = a->tilt_y + t * (b->tilt_y - a->tilt_y),
                            .turn_deg =
                                a->turn_deg + t * wr_signed_degrees(b->turn_deg - a->turn_deg),
                            .seconds = seconds };
}

/* The two ends of a segment that is too long: up to half of LONGEST from each end. */
static void add_jump(WrEngine *engine, const WrEnginePoint *to, double length)
{
    WrEnginePoint from = engine->knots.data[engine->knots.count - 1].point;
    double seconds = (to->seconds - from.seconds) * (LONGEST / length),
           part = 0.5 * LONGEST / length;
    WrEnginePoint halt = between(&from, to, from.seconds + (to->seconds - from.seconds) * part);
    WrEnginePoint go = halt, end = *to;
    go.x = to->x - part * (to->x - from.x);
    go.y = to->y - part * (to->y - from.y);
    halt.seconds = go.seconds = from.seconds + 0.5 * seconds;
    end.seconds = from.seconds + seconds;
    add_knot(engine, halt, false);
    add_knot(engine, go, true);
    add_knot(engine, end, false);
}

void wr_engine_push(WrEngine *engine, const WrEnginePoint *point)
{
    WrEnginePoint next = *point;
    if (!isfinite(next.x) || !isfinite(next.y)) return;
    next.x = clamp(next.x, -FARTHEST, FARTHEST);
    next.y = clamp(next.y, -FARTHEST, FARTHEST);
    next.pressure = clamp(next.pressure, 0.0, 1.0);
    next.tilt_x = isnan(next.tilt_x) ? 0.0 : clamp(next.tilt_x, -1.0, 1.0);
    next.tilt_y = isnan(next.tilt_y) ? 0.0 : clamp(next.tilt_y, -1.0, 1.0);
    next.turn_deg = isfinite(next.turn_deg) ? wr_signed_degrees(next.turn_deg) : 0.0;
    next.seconds = 0.0;
    double given = isfinite(point->seconds) ? point->seconds : engine->given, length = 0.0;
    if (engine->knots.count > 0) {
        const WrEnginePoint *last = &engine->knots.data[engine->knots.count - 1].point;
        double dx = next.x - last->x, dy = next.y - last->y;
        length = sqrt(dx * dx + dy * dy);
        double slowest = WR_ENGINE_REST + length / SLOWEST, seconds = given - engine->given;
        if (!(seconds > 0.0)) seconds = length / WR_ENGINE_SPEED;
        next.seconds = last->seconds + (seconds < slowest ? seconds : slowest);
    }
    engine->given = given;
    if (length > LONGEST) {
        add_jump(engine, &next, length);
    } else {
        add_knot(engine, next, false);
    }
}

void wr_engine_pen_up(WrEngine *engine)
{
    engine->finished = true;
}

/* ---- steps ---- */

/* The pen at a time within the samples. */
static WrEnginePoint pen(const WrEngine *engine, double seconds)
{
    const WrKnot *knots = engine->knots.data;
    int i = engine->at;
    while (i + 2 < engine->knots.count && knots[i + 1].point.seconds < seconds) i++;
    if (i + 1 >= engine->knots.count) return knots[i].point;
    return between(&knots[i].point, &knots[i + 1].point, seconds);
}

/* Squared distance of p from the segment a..b. */
static double off_way(const WrEnginePoint *a, const WrEnginePoint *b, const WrEnginePoint *p)
{
    double dx = b->x - a->x, dy = b->y - a->y, px = p->x - a->x, py = p->y - a->y;
    double length2 = dx * dx + dy * dy;
    double t = length2 > 0.0 ? clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0.0;
    px -= t * dx;
    py -= t * dy;
    return px * px + py * py;
}

/* The step's end: at most `latest`, but a step ends at a corner or a jump on the way. *knot: that
 * corner or jump; 0 if none. */
static double step_end(const WrEngine *engine, double latest, int *knot)
{
    WrEnginePoint from = pen(engine, engine->now), to = pen(engine, latest);
    *knot = 0;
    for (int i = engine->at + 1; i < engine->knots.count; i++) {
        const WrKnot *k = &engine->knots.data[i];
        if (k->point.seconds > latest) break;
        bool jumps = i + 1 < engine->knots.count && k[1].jump;
        if (k->point.seconds < engine->now) continue;
        if (!jumps && (k->point.seconds <= engine->now || k->point.seconds >= latest ||
                       off_way(&from, &to, &k->point) <= CORNER * CORNER))
            continue;
        *knot = i;
        return k->point.seconds;
    }
    return latest;
}

/* The fraction of a call to make, so that it does not end exactly with a dab: all except some
   thousandths of a dab's distance, a power of two. */
static double nudge(const WrEngine *engine, const WrEnginePoint *to, double seconds)
{
    double more = engine_count(engine, to, seconds), all = engine_due(engine) + more;
    bool close = all > 0.5 && fabs(all - rint(all)) < NEAR_DAB * (1.0 + all);
    if (!close) return 1.0;
    if (!(more > 64.0 * NEAR_DAB)) return 0.0;
    double part = 1.0 / 16.0;
    while (part > 1.0 / 4096.0 && more * part > 0.008) part *= 0.5;
    return 1.0 - part;
}

/* Moves to a point in `seconds`, in parts. The parts of a second are exact in binary if the step is. */
static void stride(WrEngine *engine, const WrEnginePoint *to, double seconds)
{
    WrEnginePoint a = engine->pen, b = *to;
    double dx = b.x - a.x, dy = b.y - a.y, length = sqrt(dx * dx + dy * dy);
    double dabs = engine_count(engine, to, seconds), whole = seconds + engine->left;
    int parts = 1;
    while (parts < STRIDES && (length > STRIDE * engine->radius * parts || dabs > STRIDE * parts))
        parts *= 2;
    a.seconds = 0.0;
    b.seconds = parts;
    engine->left = 0.0;
    engine->dabs = 0;
    for (int i = 1; i <= parts; i++) {
        double piece = whole / parts + engine->left;
        WrEnginePoint next = between(&a, &b, i);
        double part = nudge(engine, &next, piece);
        engine->left = piece - piece * part;
        if (part > 0.0) {
            WrEnginePoint from = engine->pen;
            from.seconds = 0.0;
            next.seconds = 1.0;
            if (part < 1.0) next = between(&from, &next, part);
            engine_go(engine, &next, piece * part);
            engine->pen = next;
        }
    }
}

static void pass_jump(WrEngine *engine, int knot)
{
    const WrEnginePoint *halt = &engine->knots.data[knot].point;
    const WrEnginePoint *go = &engine->knots.data[knot + 1].point;
    engine->origin_x += go->x - halt->x;
    engine->origin_y += go->y - halt->y;
    engine->last_x += go->x - halt->x;
    engine->last_y += go->y - halt->y;
    engine->pen.x += go->x - halt->x;
    engine->pen.y += go->y - halt->y;
    engine->at = knot + 1;
}

bool wr_engine_step(WrEngine *engine)
{
    if (engine->knots.count == 0) return false;
    if (!engine->begun) {
        WrEnginePoint first = engine->knots.data[0].point;
        engine_begin(engine, &first);
        return true;
    }
    double last = engine->knots.data[engine->knots.count - 1].point.seconds;
    double latest = (engine->steps + 1) * WR_ENGINE_STEP;
    if (latest > last) {
        if (!engine->finished) return false;
        if (engine->ended) {
            if (engine->touched) return false;
            engine_tap(engine);
            return true;
        }
        latest = last;
    }
    int knot;
    double end = step_end(engine, latest, &knot);
    WrEnginePoint to = knot > 0 ? engine->knots.data[knot].point : pen(engine, end);
    if (end > engine->now) stride(engine, &to, end - engine->now);
    engine->now = end;
    engine->ended = engine->finished && end >= last;
    if (end >= (engine->steps + 1) * WR_ENGINE_STEP) engine->steps++;
    while (engine->at + 1 < engine->knots.count &&
           engine->knots.data[engine->at + 1].point.seconds < engine->now)
        engine->at++;
    if (knot > 0 && knot + 1 < engine->knots.count && engine->knots.data[knot + 1].jump)
        pass_jump(engine, knot);
    return true;
}

#define LN2 0.69314718055994530942
/* texels: larger radii are scaled down; the library is limited to 1000 */
#define LARGE 512.0
#define SMALLEST 0.2        /* the library's smallest radius */
#define REBASE 65536.0      /* texels in units; a multiple of the library's grids of 256 */
#define OFF 100000.0        /* distance from the origin that triggers a move */
#define DABS_PER_STEP 65536 /* about */
#define SEEDS 16384         /* start positions in the sequence of random numbers */

/* ---- the surface passed to the library ---- */

static bool all_finite(const float *values, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(values[i])) return false;
    return true;
}

/* Ends a step that would take too long. */
static void rein_in(WrEngine *engine)
{
    mypaint_brush_set_state(engine->brush, MYPAINT_BRUSH_STATE_ACTUAL_RADIUS, 1000.0f);
    mypaint_brush_set_state(engine->brush, MYPAINT_BRUSH_STATE_ACTUAL_ELLIPTICAL_DAB_RATIO, 1.0f);
    mypaint_brush_set_state(engine->brush, MYPAINT_BRUSH_STATE_DABS_PER_ACTUAL_RADIUS, 1e-6f);
    mypaint_brush_set_state(engine->brush, MYPAINT_BRUSH_STATE_DABS_PER_BASIC_RADIUS, 1e-6f);
    mypaint_brush_set_state(engine->brush, MYPAINT_BRUSH_STATE_DABS_PER_SECOND, 0.0f);
}

/* 0 <= x < 1, for one purpose of one dab. */
static double chance(const WrEngine *engine, uint32_t use)
{
    uint32_t x = (uint32_t)engine->look.seed ^ wr_mix32((uint32_t)(engine->look.seed >> 32) + use);
    x = wr_mix32(x + wr_mix32((uint32_t)engine->number + 0x9e3779b9U * use));
    return (x >> 8) * 0x1p-24;
}

/* Applies the brush's own settings to the preset's dab: angle, aspect, following the path, jitter, and
 * the tip. */
static void dress(const WrEngine *engine, WrDab *dab, double pressure)
{
    const WrBrush *look = &engine->look;
    double across = mypaint_brush_get_state(engine->brush, MYPAINT_BRUSH_STATE_DIRECTION_ANGLE_DX);
    double down = mypaint_brush_get_state(engine->brush, MYPAINT_BRUSH_STATE_DIRECTION_ANGLE_DY);
    bool moves = isfinite(across) && isfinite(down) && (across != 0.0 || down != 0.0);
    double way_rad = moves ? wr_atan2(-down, across) : 0.0;
    if (!engine->angles) dab->angle_rad = 0.0;
    dab->angle_rad += look->angle_deg * WR_RAD_PER_DEG;
    if (look->follow) dab->angle_rad += way_rad;
    if (look->jitter_angle_deg > 0.0)
        dab->angle_rad += (2.0 * chance(engine, 2) - 1.0) * look->jitter_angle_deg * WR_RAD_PER_DEG;
    if (look->aspect > 1.0) dab->aspect *= look->aspect;
    if (look->jitter_size > 0.0) dab->radius *= 1.0 - look->jitter_size * chance(engine, 3);
    if (look->jitter_place > 0.0) { /* uniformly over a disc */
        double sine, cosine, far = look->jitter_place * engine->radius * sqrt(chance(engine, 0));
        wr_sincos_turns(chance(engine, 1), &sine, &cosine);
        dab->x += far * cosine;
        dab->y += far * sine;
    }
    if (look->tip)
        dab->tip_cell =
            wr_tip_pick(look->tip, engine->number, way_rad, pressure, chance(engine, 4));
}

static int draw_dab(MyPaintSurface2 *self, float x, float y, float radius, float r, float g,
                    float b, float opaque, float hardness, float alpha_eraser, float aspect,
                    float angle, float lock_alpha, float colorize, float posterize,
                    float posterize_num, float paint)
{
    (void)r, (void)b, (void)lock_alpha, (void)colorize;
    (void)posterize, (void)posterize_num, (void)paint;
    WrEngine *engine = (WrEngine *)self;
    if (++engine->dabs > DABS_PER_STEP) rein_in(engine);
    if (engine->muted) return 1;
    engine->touched = true;
    const float values[] = { x, y, radius, opaque, hardness, aspect, angle };
    if (!all_finite(values, 7) || !(radius > 0.0f) || !(hardness > 0.0f)) return 0;
    double erased = 1.0 - clamp(alpha_eraser, 0.0, 1.0);
    WrDab dab = { .x = x * engine->unit - 0.5 + engine->origin_x,
                  .y = y * engine->unit - 0.5 + engine->origin_y,
                  .radius = radius * engine->unit,
                  .hardness = clamp(hardness, 0.0, 1.0),
                  .alpha = clamp(opaque, 0.0, 1.0) * engine->flow *
                           (engine->erases ? erased : 1.0 - erased),
                  .aspect = clamp(aspect, 1.0, 1e6),
                  .angle_rad = -angle * WR_RAD_PER_DEG,
                  .falloff = WR_FALLOFF_MYPAINT };
    if (!(dab.alpha > 0.0)) return 0;
    float dragged = mypaint_brush_get_state(engine->brush, MYPAINT_BRUSH_STATE_SMUDGE_RA);
    if (engine->smudges && g > 0.0f && isfinite(dragged)) {
        dab.drag = clamp(g, 0.0, 1.0);
        dab.dragged = dragged;
    }
    dress(engine, &dab, mypaint_brush_get_state(engine->brush, MYPAINT_BRUSH_STATE_PRESSURE));
    if (!(dab.radius > 0.0)) return 0;
    if (engine->drew) {
        dab.dx = dab.x - engine->last_x;
        dab.dy = dab.y - engine->last_y;
    }
    engine->drew = true;
    engine->number++;
    engine->last_x = dab.x;
    engine->last_y = dab.y;
    engine->sink.dab(engine->sink.ctx, &dab);
    return 1;
}

/* Limits a height to the range that the library can mix. */
static float carried(double height)
{
    return isnan(height) ? 0.0f : (float)clamp(height, -FLT_MAX / 4.0, FLT_MAX / 4.0);
}

static void get_colour(MyPaintSurface2 *self, float x, float y, float radius, float *r, float *g,
                       float *b, float *a, float paint)
{
    (void)paint;
    WrEngine *engine = (WrEngine *)self;
    double height = 0.0;
    if (!engine->muted && isfinite(x) && isfinite(y) && isfinite(radius))
        height =
            engine->sink.height(engine->sink.ctx, x * engine->unit - 0.5 + engine->origin_x,
                                y * engine->unit - 0.5 + engine->origin_y, radius * engine->unit);
    *r = carried(height);
    *g = *b = *a = 1.0f;
}

/* The callback of the library's older interface, which it does not use on such a surface. */
static int draw_dab_1(MyPaintSurface *self, float x, float y, float radius, float r, float g,
                      float b, float opaque, float hardness, float alpha_eraser, float aspect,
                      float angle, float lock_alpha, float colorize)
{
    return draw_dab((MyPaintSurface2 *)self, x, y, radius, r, g, b, opaque, hardness, alpha_eraser,
                    aspect, angle, lock_alpha, colorize, 0.0f, 1.0f, 0.0f);
}

static void get_colour_1(MyPaintSurface *self, float x, float y, float radius, float *r, float *g,
                         float *b, float *a)
{
    get_colour((MyPaintSurface2 *)self, x, y, radius, r, g, b, a, 0.0f);
}

/* ---- creation ---- */

static void set_value(WrEngine *engine, int setting, double value)
{
    mypaint_brush_set_base_value(engine->brush, (MyPaintBrushSetting)setting, (float)value);
}

static void set_settings(WrEngine *engine, const WrBrush *brush)
{
    const WrPreset *preset = engine->preset;
    for (int i = 0; i < MYPAINT_BRUSH_SETTINGS_COUNT; i++)
        if (wr_preset_setting(i)->use != WR_SETTING_IGNORED) set_value(engine, i, preset->base[i]);
    for (int i = 0; i < preset->curves.count; i++) {
        const WrCurve *curve = &preset->curves.data[i];
        MyPaintBrushSetting setting = (MyPaintBrushSetting)curve->setting;
        MyPaintBrushInput input = (MyPaintBrushInput)curve->input;
        if (wr_preset_setting(curve->setting)->use == WR_SETTING_IGNORED) continue;
        mypaint_brush_set_mapping_n(engine->brush, setting, input, curve->count);
        for (int k = 0; k < curve->count; k++)
            mypaint_brush_set_mapping_point(engine->brush, setting, input, k, curve->points[k][0],
                                            curve->points[k][1]);
    }
    double hardness = clamp(brush->hardness, 0.01, 1.0);
    set_value(engine, MYPAINT_BRUSH_SETTING_HARDNESS, hardness);
    set_value(engine, MYPAINT_BRUSH_SETTING_RADIUS_LOGARITHMIC,
              wr_log2(engine->radius / engine->unit) * LN2);
}

/* Black, without colour settings: the library's colour computations cost time. */
static void set_plain(WrEngine *engine)
{
    mypaint_brush_from_defaults(engine->brush);
    set_value(engine, MYPAINT_BRUSH_SETTING_COLOR_V, 0.0);
    set_value(engine, MYPAINT_BRUSH_SETTING_PAINT_MODE, 0.0);
    mypaint_brush_set_mapping_n(engine->brush, MYPAINT_BRUSH_SETTING_OPAQUE_MULTIPLY,
                                MYPAINT_BRUSH_INPUT_PRESSURE, 0);
}

/* The library counts the pen's turn in whole turns. */
static void call(WrEngine *engine, double x, double y, double pressure, double tilt_x,
                 double tilt_y, double turn_deg, double seconds)
{
    mypaint_brush_stroke_to_2(engine->brush, &engine->surface, (float)x, (float)y, (float)pressure,
                              (float)tilt_x, (float)tilt_y, seconds, 1.0f, 0.0f,
                              (float)(turn_deg / 360.0));
}

/* Resets the brush at a position; a pause above 5 s starts a new stroke in the library. */
static void place(WrEngine *engine, double x, double y)
{
    mypaint_brush_reset(engine->brush);
    call(engine, x, y, 0.0, 0.0, 0.0, 0.0, 10.0);
}

/* A step with the older interface, which initialises the library's current values instead of reading
 * them. */
static void settle(WrEngine *engine)
{
    place(engine, 0.0, 0.0);
    mypaint_brush_stroke_to(engine->brush, &engine->surface.parent, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
                            WR_ENGINE_STEP);
}

static void prime(WrEngine *engine, const WrBrush *brush)
{
    engine->muted = true;
    set_plain(engine);
    settle(engine);
    if (wr_preset_is_random(engine->preset)) {
        uint32_t seed = (uint32_t)brush->seed ^ wr_mix32((uint32_t)(brush->seed >> 32));
        int resets = (int)(wr_mix32(seed) % SEEDS);
        for (int i = 0; i < resets; i++) place(engine, 0.0, 0.0);
    }
    set_settings(engine, brush);
    settle(engine);
    engine->muted = false;
}

WrEngine *wr_engine_new(const WrBrush *brush, const WrDabSink *sink)
{
    WrEngine *engine = wr_alloc(1, sizeof *engine);
    engine->brush = mypaint_brush_new();
    engine->preset = wr_preset_share(brush->preset);
    engine->look = *brush;
    engine->look.tip = brush->tip ? wr_tip_share(brush->tip) : NULL;
    engine->angles =
        !wr_preset_is_constant(brush->preset, MYPAINT_BRUSH_SETTING_ELLIPTICAL_DAB_ANGLE) ||
        wr_preset_peak(brush->preset, MYPAINT_BRUSH_SETTING_ELLIPTICAL_DAB_RATIO) > 1.0;
    engine->sink = *sink;
    mypaint_surface_init(&engine->surface.parent);
    engine->surface.parent.draw_dab = draw_dab_1;
    engine->surface.parent.get_color = get_colour_1;
    engine->surface.draw_dab_pigment = draw_dab;
    engine->surface.get_color_pigment = get_colour;
    engine->radius = clamp(brush->radius, SMALLEST, 1e9);
    engine->unit = 1.0;
    while (engine->radius / engine->unit > LARGE) engine->unit *= 2.0;
    engine->flow = brush->radius > 0.0 ? clamp(brush->flow, 0.0, 1.0) : 0.0;
    engine->erases = engine->preset->base[MYPAINT_BRUSH_SETTING_ERASER] >= 0.5;
    engine->smudges = wr_preset_smudges(engine->preset);
    prime(engine, brush);
    return engine;
}

void wr_engine_free(WrEngine *engine)
{
    if (!engine) return;
    mypaint_brush_unref(engine->brush);
    wr_preset_free(engine->preset);
    wr_tip_free((WrTip *)(uintptr_t)engine->look.tip); /* our own reference */
    wr_array_free(&engine->knots);
    wr_free(engine);
}

/* ---- steps ---- */

/* Moves the origin, in the library's states too, so that floats stay accurate. */
static void move_origin(WrEngine *engine, double dx, double dy)
{
    static const MyPaintBrushState across[] = { MYPAINT_BRUSH_STATE_X,
                                                MYPAINT_BRUSH_STATE_ACTUAL_X };
    static const MyPaintBrushState down[] = { MYPAINT_BRUSH_STATE_Y, MYPAINT_BRUSH_STATE_ACTUAL_Y };
    engine->origin_x += dx;
    engine->origin_y += dy;
    for (int i = 0; i < 2; i++) {
        float x = mypaint_brush_get_state(engine->brush, across[i]);
        float y = mypaint_brush_get_state(engine->brush, down[i]);
        mypaint_brush_set_state(engine->brush, across[i], (float)(x - dx / engine->unit));
        mypaint_brush_set_state(engine->brush, down[i], (float)(y - dy / engine->unit));
    }
}

/* Converts texels to the library's pixels, whose centres are at one half. */
static double across(const WrEngine *engine, double x)
{
    return (x + 0.5 - engine->origin_x) / engine->unit;
}

static double down(const WrEngine *engine, double y)
{
    return (y + 0.5 - engine->origin_y) / engine->unit;
}

static void engine_go(WrEngine *engine, const WrEnginePoint *point, double seconds)
{
    double base = REBASE * engine->unit, x = across(engine, point->x), y = down(engine, point->y);
    if (fabs(x) > OFF || fabs(y) > OFF)
        move_origin(engine, rint(x / REBASE) * base, rint(y / REBASE) * base);
    call(engine, across(engine, point->x), down(engine, point->y), point->pressure, point->tilt_x,
         point->tilt_y, point->turn_deg, seconds);
}

static double state(const WrEngine *engine, MyPaintBrushState which)
{
    return mypaint_brush_get_state(engine->brush, which);
}

static double base_value(const WrEngine *engine, MyPaintBrushSetting which)
{
    return mypaint_brush_get_base_value(engine->brush, which);
}

static double engine_count(const WrEngine *engine, const WrEnginePoint *to, double seconds)
{
    double follow = base_value(engine, MYPAINT_BRUSH_SETTING_SLOW_TRACKING);
    double part = follow > 0.001 ? 1.0 - wr_exp2(-100.0 * seconds / follow / LN2) : 1.0;
    /* as passed to the library */
    float x = (float)across(engine, to->x), y = (float)down(engine, to->y);
    double dx = part * (x - state(engine, MYPAINT_BRUSH_STATE_X));
    double dy = part * (y - state(engine, MYPAINT_BRUSH_STATE_Y));
    double aspect = state(engine, MYPAINT_BRUSH_STATE_ACTUAL_ELLIPTICAL_DAB_RATIO);
    if (aspect > 1.0) {
        double angle = state(engine, MYPAINT_BRUSH_STATE_ACTUAL_ELLIPTICAL_DAB_ANGLE), sine, cosine;
        wr_sincos_turns(angle / 360.0, &sine, &cosine);
        double along = dy * sine + dx * cosine;
        dy = (dy * cosine - dx * sine) * aspect;
        dx = along;
    }
    double length = sqrt(dx * dx + dy * dy);
    double actual = state(engine, MYPAINT_BRUSH_STATE_ACTUAL_RADIUS);
    double basic = engine->radius / engine->unit;
    double by_actual = state(engine, MYPAINT_BRUSH_STATE_DABS_PER_ACTUAL_RADIUS);
    double by_basic = state(engine, MYPAINT_BRUSH_STATE_DABS_PER_BASIC_RADIUS);
    if (by_actual == 0.0 || isnan(by_actual))
        by_actual = base_value(engine, MYPAINT_BRUSH_SETTING_DABS_PER_ACTUAL_RADIUS);
    if (by_basic == 0.0 || isnan(by_basic))
        by_basic = base_value(engine, MYPAINT_BRUSH_SETTING_DABS_PER_BASIC_RADIUS);
    return length * (by_actual / (actual > 0.0 ? actual : basic) + by_basic / basic) +
           seconds * state(engine, MYPAINT_BRUSH_STATE_DABS_PER_SECOND);
}

static double engine_due(const WrEngine *engine)
{
    return state(engine, MYPAINT_BRUSH_STATE_PARTIAL_DABS);
}

/* The dragged height is that under the first sample, even if the preset never reads it. */
static void pick_up(WrEngine *engine, const WrEnginePoint *first)
{
    static const MyPaintBrushState ones[] = { MYPAINT_BRUSH_STATE_SMUDGE_GA,
                                              MYPAINT_BRUSH_STATE_SMUDGE_BA,
                                              MYPAINT_BRUSH_STATE_SMUDGE_A };
    double height = engine->sink.height(engine->sink.ctx, first->x, first->y, engine->radius);
    mypaint_brush_set_state(engine->brush, MYPAINT_BRUSH_STATE_SMUDGE_RA, carried(height));
    for (int i = 0; i < 3; i++) mypaint_brush_set_state(engine->brush, ones[i], 1.0f);
}

static void engine_begin(WrEngine *engine, const WrEnginePoint *first)
{
    double base = REBASE * engine->unit;
    engine->origin_x = rint(first->x / base) * base;
    engine->origin_y = rint(first->y / base) * base;
    mypaint_brush_new_stroke(engine->brush);
    place(engine, across(engine, first->x), down(engine, first->y));
    if (engine->smudges) pick_up(engine, first);
    engine_go(engine, first, WR_ENGINE_STEP); /* pressure and tilt are effective at once */
    engine->pen = *first;
    engine->begun = true;
}

/* A tap of the pen makes one dab, although the library requires motion. */
static void engine_tap(WrEngine *engine)
{
    WrEnginePoint to = engine->pen;
    double length = engine->radius / 64.0;
    for (int i = 0; i < 8 && !engine->touched; i++, length *= 4.0) {
        mypaint_brush_set_state(engine->brush, MYPAINT_BRUSH_STATE_PARTIAL_DABS, 0.999f);
        to.x += length;
        engine->dabs = 0;
        engine_go(engine, &to, WR_ENGINE_STEP);
    }
    engine->touched = true;
}
