/* Strokes by the pointer. Samples are passed to the session at once, which journals them; they are drawn for a few
   milliseconds per frame, so that a large brush never blocks the pointer. A stroke released before it is fully drawn
   continues to be drawn; the next one waits. */
#include "ui/canvas/tools/stroke_input.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/line.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/canvas/tools/brush_command_text.h"
#include "ui/toolkit/words.h"
#include "ui/canvas/tools/preset_browser.h"
#include "ui/canvas/overlays/marks.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "brush/brush.h"
#include "brush/preset.h"
#include "command/session.h"
#include "document/document.h"
#include "system/clock.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Drawing time per frame: as long as the last frame took, so that a busy machine does not fall behind, within these. */
#define WORK_SECONDS 0.020
#define MOST_SECONDS 0.200

/* Append a stroke command without points for a brush, with the files in *app->brush_files. */
static void strokes_head(const WrApp *app, const char *verb, const WrBrush *brush, WrText *line)
{
    const WrBrushSources *files = app->brush_files;
    WrBrushNames names = { files->preset, files->set, files->tip };
    WrBrush base = brush->preset ? wr_preset_brush(brush->preset) : wr_brush_default();
    wr_text_add(line, verb);
    wr_brush_line(line, brush, &base, &names);
}

/* An integer below 1e9, which is short in a line; different for each stroke. A multiplicative hash spreads consecutive clock
   values over the whole range. */
static uint64_t new_seed(WrApp *app)
{
    uint64_t x = (uint64_t)(wr_clock_seconds() * 1e6) + 0x9e3779b97f4a7c15u * ++app->brush->seeds;
    x = (x ^ (x >> 31)) * 0xbf58476d1ce4e5b9u;
    return 1 + (x >> 20) % 999999999u;
}

/* Swap raising and lowering, with the strength last used for the other. */
static void invert(const WrApp *app, WrBrush *brush)
{
    const double other = app->settings->other_strength;
    if (brush->mode != WR_BRUSH_RAISE && brush->mode != WR_BRUSH_LOWER) return;
    brush->mode = brush->mode == WR_BRUSH_RAISE ? WR_BRUSH_LOWER : WR_BRUSH_RAISE;
    if (other != 0.0 && !wr_paints_mask(app)) brush->strength = other;
}

WrBrush wr_strokes_brush(WrApp *app, const WrPointer *at)
{
    WrBrush brush = wr_brush_now(app);
    if (at->eraser) brush.mode = WR_BRUSH_ERASE;
    else if (wr_keys_hold(app->keys, WR_ACT(hold_smooth), at->mods)) brush.mode = WR_BRUSH_SMOOTH;
    else if (wr_keys_hold(app->keys, WR_ACT(hold_invert), at->mods)) invert(app, &brush);
    brush.seed = wr_brush_chances(&brush) ? new_seed(app) : 0;
    return brush;
}

/* jobs[0] is the stroke that the session draws (`opened`); later ones wait, each with its own brush line and samples. Samples
   leave a job when they are pushed into the session, whose journal then holds them. The session draws all samples of a stroke
   only after further calls (`unfinished`), a few milliseconds per frame. */
/* ---- queued strokes ---- */

static void drop_job(WrBrushState *hand, int index)
{
    wr_free(hand->jobs.data[index].head);
    wr_array_free(&hand->jobs.data[index].samples);
    hand->jobs.count--;
    for (int i = index; i < hand->jobs.count; i++) hand->jobs.data[i] = hand->jobs.data[i + 1];
}

/* Begin the oldest stroke in the session; dropped, with a message, if that fails. */
static bool open_first(WrApp *app)
{
    WrBrushState *hand = app->brush;
    WrStrokeJob *job = &hand->jobs.data[0];
    WrError err;
    if (wr_session_stroke_begin(app->session, job->head, &err)) {
        hand->opened = true;
        hand->unfinished = false;
        hand->pushed = 0;
        hand->marks.count = 0;
        return true;
    }
    wr_app_fail(app, &err);
    if (hand->drawing && hand->jobs.count == 1) hand->drawing = false;
    drop_job(hand, 0);
    return false;
}

static void push_samples(WrApp *app)
{
    WrBrushState *hand = app->brush;
    WrStrokeJob *job = &hand->jobs.data[0];
    WrError err;
    if (job->samples.count == 0) return;
    if (!wr_session_stroke_push(app->session, job->samples.data, job->samples.count, &err))
        wr_app_fail(app, &err);
    hand->pushed += job->samples.count;
    wr_array_push(&hand->marks, ((WrDrawnMark){ hand->pushed, hand->taken }));
    job->samples.count = 0;
    hand->unfinished = true;
}

/* Note the events that are drawn, while others wait. */
static void note_drawn(WrApp *app)
{
    WrBrushState *hand = app->brush;
    const int64_t drawn = wr_session_stroke_drawn(app->session);
    int done = 0;
    while (done < hand->marks.count && hand->marks.data[done].samples <= drawn)
        hand->shown = hand->marks.data[done++].events;
    for (int i = done; i < hand->marks.count; i++) hand->marks.data[i - done] = hand->marks.data[i];
    hand->marks.count -= done;
}

static void close_first(WrApp *app)
{
    WrError err;
    if (!wr_session_stroke_end(app->session, &err)) wr_app_fail(app, &err);
    app->brush->opened = app->brush->unfinished = false;
    drop_job(app->brush, 0);
    wr_app_take_notes(app);
    wr_app_title(app);
}

/* Draw until the clock reads `end`. */
static void work_until(WrApp *app, double end)
{
    WrBrushState *hand = app->brush;
    while (!app->busy && hand->jobs.count > 0 && !hand->jobs.data[0].waits) {
        if (!hand->opened && !open_first(app)) continue;
        push_samples(app);
        if (hand->unfinished) {
            double left = end - wr_clock_seconds();
            hand->unfinished = wr_session_stroke_work(app->session, left > 0.0 ? left : 0.0);
            note_drawn(app);
            wr_app_redraw(app);
        }
        if (hand->unfinished && wr_clock_seconds() >= end) return;
        if (hand->unfinished) continue;
        if (!hand->jobs.data[0].released) break;
        close_first(app);
    }
    hand->shown = hand->taken;
}

/* The background command has ended or was cancelled: draw or drop the stroke of this number. */
static void draw_late(WrApp *app, const char *text, bool dropped)
{
    WrBrushState *hand = app->brush;
    int i = 0;
    while (i < hand->jobs.count && hand->jobs.data[i].waits != atoi(text)) i++;
    if (i == hand->jobs.count) return; /* cancelled by the user */
    hand->jobs.data[i].waits = 0;
    if (!dropped) {
        work_until(app, 1e300);
        return;
    }
    if (hand->drawing && i == hand->jobs.count - 1) hand->drawing = false;
    drop_job(hand, i);
}

static bool begin(WrApp *app, const char *head, const WrBrush *brush, const WrPointer *at)
{
    WrBrushState *hand = app->brush;
    wr_array_push(&hand->jobs, ((WrStrokeJob){ .head = wr_strdup(head) }));
    hand->now = *brush;
    hand->began = at->seconds;
    hand->drawing = true;
    hand->strokes++;
    app->hints = false;
    wr_app_redraw(app);
    if (!app->busy) return hand->jobs.count > 1 || open_first(app);
    char number[24];
    hand->jobs.data[hand->jobs.count - 1].waits = hand->strokes;
    snprintf(number, sizeof number, "%d", hand->strokes);
    wr_busy_put_off(app, wr_words("Stroke"), draw_late, number, true);
    return true;
}

bool wr_strokes_begin(WrApp *app, const WrBrush *brush, const WrPointer *at)
{
    WrText head = { 0 };
    strokes_head(app, "stroke", brush, &head);
    const bool good = begin(app, wr_text_get(&head), brush, at);
    wr_text_fini(&head);
    return good;
}

void wr_strokes_mesh_line(const WrApp *app, const WrVec3 *eye, WrText *line)
{
    const bool *mirror = app->settings->mesh_mirror;
    if (eye) wr_line_vec(line, "eye", *eye);
    if (app->settings->symmetric && (mirror[0] || mirror[1] || mirror[2]))
        wr_text_addf(line, " mirror_axes=%s%s%s", mirror[0] ? "x" : "", mirror[1] ? "y" : "",
                     mirror[2] ? "z" : "");
}

bool wr_strokes_begin_on_mesh(WrApp *app, const WrBrush *brush, const WrPointer *at,
                              const WrVec3 *eye)
{
    WrText head = { 0 };
    strokes_head(app, "sculpt", brush, &head);
    wr_strokes_mesh_line(app, eye, &head);
    const bool good = begin(app, wr_text_get(&head), brush, at);
    wr_text_fini(&head);
    return good;
}

/* place: only with its position. */
static void add_sample(WrApp *app, const WrPointer *at, WrSample place)
{
    WrBrushState *hand = app->brush;
    const WrBrush *brush = &hand->now;
    bool presses = brush->preset || brush->pressure != WR_PRESSURE_NONE;
    /* Only presets use tilt, turn and time; without them lines stay short. */
    WrSample sample = place;
    sample.pressure = presses ? at->pressure : 1.0;
    if (brush->preset) {
        sample.tilt_x = at->tilt_x;
        sample.tilt_y = at->tilt_y;
        sample.turn_deg = at->turn_deg;
        sample.seconds = fmax(0.0, at->seconds - hand->began);
    }
    WrStrokeJob *job = &hand->jobs.data[hand->jobs.count - 1];
    wr_array_push(&job->samples, sample);
    hand->pressure = sample.pressure;
    wr_app_redraw(app);
}

void wr_strokes_sample(WrApp *app, const WrPointer *at, double u, double v)
{
    WrBrushState *hand = app->brush;
    if (!hand->drawing || hand->jobs.count == 0) return;
    add_sample(app, at, (WrSample){ .u = u, .v = v });
    hand->last_u = u;
    hand->last_v = v;
    hand->have_last = true;
}

void wr_strokes_sample_on_mesh(WrApp *app, const WrPointer *at, WrVec3 p)
{
    if (!app->brush->drawing || app->brush->jobs.count == 0) return;
    add_sample(app, at, (WrSample){ .p = p });
    app->brush->have_last = false; /* no straight line of the table leads from here */
}

void wr_strokes_end(WrApp *app)
{
    WrBrushState *hand = app->brush;
    if (!hand->drawing) return;
    hand->drawing = false;
    if (hand->jobs.count > 0) hand->jobs.data[hand->jobs.count - 1].released = true;
    wr_app_redraw(app);
}

void wr_strokes_work(WrApp *app)
{
    app->brush->taken = app->hand->events;
    if (app->brush->jobs.count == 0) app->brush->shown = app->brush->taken;
    else
        work_until(app,
                   wr_clock_seconds() + fmin(MOST_SECONDS, fmax(WORK_SECONDS, app->draw_seconds)));
}

bool wr_strokes_waits(const WrApp *app)
{
    const WrBrushState *hand = app->brush;
    if (hand->jobs.count > 0 && hand->jobs.data[0].waits) return false;
    return hand->unfinished || hand->jobs.count > (hand->drawing ? 1 : 0);
}

bool wr_strokes_under_way(const WrApp *app)
{
    return app->brush->jobs.count > 0;
}

bool wr_strokes_newest_is_queued(const WrApp *app)
{
    const WrBrushState *hand = app->brush;
    return hand->jobs.count > 0 && hand->jobs.data[hand->jobs.count - 1].waits;
}

void wr_strokes_finish(WrApp *app)
{
    wr_strokes_end(app);
    work_until(app, 1e300);
}

void wr_strokes_cancel(WrApp *app)
{
    WrBrushState *hand = app->brush;
    hand->drawing = false;
    if (hand->jobs.count == 0) return;
    if (hand->jobs.count == 1 && hand->opened) {
        wr_session_stroke_cancel(app->session);
        hand->opened = hand->unfinished = false;
    }
    char number[24];
    snprintf(number, sizeof number, "%d", hand->jobs.data[hand->jobs.count - 1].waits);
    wr_busy_take_back(app, draw_late, number);
    drop_job(hand, hand->jobs.count - 1);
    wr_app_take_notes(app);
    wr_app_title(app);
    wr_app_redraw(app);
}

void wr_strokes_marks(const WrApp *app)
{
    const WrBrushState *hand = app->brush;
    WR_ARRAY(WrSelectPoint) points = { 0 };
    for (int i = 0; i < hand->jobs.count; i++) {
        const WrStrokeJob *job = &hand->jobs.data[i];
        if (!job->waits) continue;
        points.count = 0;
        for (int k = 0; k < job->samples.count; k++)
            wr_array_push(&points,
                          ((WrSelectPoint){ job->samples.data[k].u, job->samples.data[k].v }));
        wr_overlay_lines(app, points.data, points.count, false, WR_COLOUR_CELL);
    }
    wr_array_free(&points);
}

void wr_strokes_free(WrApp *app)
{
    while (app->brush->jobs.count > 0) drop_job(app->brush, 0);
    wr_array_free(&app->brush->jobs);
    wr_array_free(&app->brush->marks);
}

static void another(WrApp *app)
{
    app->brush->have_last = false;
}

const WrPart wr_part_strokes = { .another = another };

/* ---- strength of strokes ---- */

bool wr_paints_mask(const WrApp *app)
{
    const WrDocument *document = wr_app_document(app);
    return document->layers[document->active].on_mask;
}

double *wr_strength_setting(WrApp *app)
{
    WrSettings *settings = app->settings;
    return wr_paints_mask(app) ? &settings->mask_strength : &settings->brush.strength;
}

void wr_strength_number(WrApp *app, const char *id, double width)
{
    const bool mask = wr_paints_mask(app);
    const WrNumber percent = {
        .low = 0,
        .high = 100,
        .reset = 100,
        .decimals = 0,
        .unit = "%",
        .tip =
            "Change of the mask at the centre of a stroke: 100 % shows or hides the layer in full"
    };
    const WrNumber height = {
        .low = 0.001,
        .high = 1,
        .hard_low = -1e30,
        .hard_high = 1e30,
        .reset = wr_preset_browser_own(app).strength,
        .decimals = -1,
        .logarithmic = true,
        .tip = "Change of the height at the centre of a stroke, in units of the table."
    };
    double *strength = wr_strength_setting(app), value = mask ? *strength * 100.0 : *strength;
    if (wr_gui_number(id, width, mask ? &percent : &height, &value))
        *strength = mask ? rint(value * 100.0) / 1e4 : value;
}

WrBrush wr_brush_now(const WrApp *app)
{
    WrBrush brush = app->settings->brush;
    if (wr_paints_mask(app)) brush.strength = app->settings->mask_strength;
    return brush;
}
