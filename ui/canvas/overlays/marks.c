/* Outline of the selection on every copy of the cell, as an animated dashed line. */
#include "ui/canvas/overlays/marks.h"
#include "ui/canvas/marching_ants.h"
#include "ui/canvas/outline.h"
#include "ui/canvas/view.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/retained_frame.h"
#include "ui/toolkit/theme.h"

#include "base/array.h"
#include "document/document.h"
#include "field/field.h"
#include "field/select.h"
#include "system/clock.h"

#include <SDL.h>
#include <math.h>

#define STEP_SECONDS 0.2 /* period of the animation */
#define IDLE_SECONDS 20  /* the animation stops after this time without user input */
#define DASH 4           /* length of a dash, pixels at scale 1 */

static void marks_update(WrApp *app)
{
    WrMarks *marks = app->marks;
    const WrField *selection = wr_app_document(app)->selection;
    uint64_t key = selection ? wr_field_key(selection) : 0;
    if (marks->trying || key == marks->asked_key) return;
    marks->asked_key = key;
    if (selection)
        wr_outliner_request(marks->outliner, wr_app_document(app), &(WrOutlineRequest){ 0 });
    else wr_outliner_clear(marks->outliner);
    wr_app_redraw(app);
}

void wr_marks_try(WrApp *app, const WrOutlineRequest *ask)
{
    WrMarks *marks = app->marks;
    marks->trying = ask != NULL;
    marks->asked_key = 0;
    if (ask) wr_outliner_request(marks->outliner, wr_app_document(app), ask);
    else wr_outliner_clear(marks->outliner);
    wr_app_redraw(app);
}

/* Draw the pixels, alternately white and black along the line. */
static void draw_ants(const WrApp *app, const WrMarchingAnts *ants, int phase)
{
    static const uint32_t colours[2] = { 0xfffafafau, 0xff101010u };
    WrRetainedFrame *kept = wr_gui_kept(app->gui);
    SDL_Point chunk[512];
    double dash = DASH * wr_gui_scale();
    for (int pass = 0; pass < 2; pass++) {
        int count = 0;
        for (int i = 0; i < ants->pixels.count; i++) {
            const WrAnt *ant = &ants->pixels.data[i];
            double place = (double)ant->along / dash - phase / 4.0;
            if (((int)floor(place) & 1) != pass) continue;
            chunk[count++] = ant->at;
            if (count < 512) continue;
            wr_retained_frame_points(kept, chunk, count, colours[pass]);
            count = 0;
        }
        wr_retained_frame_points(kept, chunk, count, colours[pass]);
    }
}

void wr_marks_draw(WrApp *app)
{
    WrMarks *marks = app->marks;
    uint64_t serial;
    const WrField *field = wr_app_field(app);
    bool wraps_u = wr_field_wrap_u(field) == WR_WRAP_PERIODIC;
    bool wraps_v = wr_field_wrap_v(field) == WR_WRAP_PERIODIC;
    const WrOutline *outline = wr_outliner_get(marks->outliner, &serial);
    int phase = (int)fmod(marks->stepped_at / STEP_SECONDS, 8.0);
    if (outline) {
        if (serial != marks->traced || !wr_view_same(app->view, &marks->traced_view))
            wr_marching_ants_trace(&marks->ants, outline, app->view, wraps_u, wraps_v);
        marks->traced = serial;
        marks->traced_view = *app->view;
        draw_ants(app, &marks->ants, phase);
    } else {
        marks->ants.pixels.count = 0;
    }
    if (!app->select->active) return;
    marks->shape.pixels.count = 0;
    marks->shape.cut = false;
    wr_marching_ants_add(&marks->shape, app->select->points.data, app->select->points.count, 0, 0,
                         app->view, wraps_u, wraps_v);
    draw_ants(app, &marks->shape, phase);
}

/* clock of the next animation step; 0: none */
static double marks_next_time(const WrApp *app)
{
    const WrMarks *marks = app->marks;
    bool there = marks->ants.pixels.count > 0;
    bool focus = (SDL_GetWindowFlags(app->window) & SDL_WINDOW_INPUT_FOCUS) != 0;
    if (!there || !focus || !app->visible || !app->settings->ants || app->layout->canvas.w <= 0)
        return 0.0;
    if (wr_clock_seconds() - app->input_at > IDLE_SECONDS) return 0.0;
    return marks->stepped_at + STEP_SECONDS;
}

void wr_marks_free(WrApp *app)
{
    wr_outliner_free(app->marks->outliner);
    wr_marching_ants_free(&app->marks->ants);
    wr_marching_ants_free(&app->marks->shape);
    wr_array_free(&app->select->points);
}

static bool works(WrApp *app)
{
    return wr_outliner_busy(app->marks->outliner, NULL, NULL);
}

/* Advance the animation. */
static void update(WrApp *app)
{
    double now = wr_clock_seconds(), due = marks_next_time(app);
    if (due != 0.0 && now >= due) {
        app->marks->stepped_at = now;
        if (app->redraw == 0) app->redraw = 1;
    }
    marks_update(app);
}

const WrPart wr_part_marks = { .update = update, .next_time = marks_next_time, .works = works };

/* ---- lines and marks on the canvas, on every visible copy of the cell ---- */

#define COPIES_MAX 49 /* limit of drawn copies; beyond it, only the nearest */

WrSelectPoint wr_overlay_uv(const WrApp *app, double x, double y)
{
    return (WrSelectPoint){ x / app->view->table_w, 1.0 - y / app->view->table_h };
}

WrSelectPoint wr_overlay_wrap_offset(const WrApp *app, double u, double v)
{
    const WrField *field = wr_app_field(app);
    return (WrSelectPoint){ wr_field_wrap_u(field) == WR_WRAP_PERIODIC ? -floor(u) : 0.0,
                            wr_field_wrap_v(field) == WR_WRAP_PERIODIC ? -floor(v) : 0.0 };
}

/* Pixel of a point in the copy i cells to the right and j up. */
static void pixel_of(const WrApp *app, WrSelectPoint p, int i, int j, double *x, double *y)
{
    const WrCanvasView *view = app->view;
    double dx, dy;
    wr_view_tiling_shift(view, i, -j, &dx, &dy);
    wr_view_place(view, (p.u + i) * view->table_w + dx, (1.0 - p.v - j) * view->table_h + dy, x, y);
}

/* Shifts by whole cells, *from .. *to, at which content in low..high (u and v) is visible. */
typedef struct Shifts {
    int from_u, to_u, from_v, to_v;
} Shifts;

static Shifts shifts_of(const WrApp *app, WrSelectPoint low, WrSelectPoint high)
{
    const WrCanvasView *view = app->view;
    const WrField *field = wr_app_field(app);
    double from[2], to[2];
    wr_view_bounds(view, from, to);
    if (view->tiling == WR_TILING_BRICK) from[0] -= view->table_w / 2.0;
    if (view->tiling == WR_TILING_HALF_DROP) from[1] -= view->table_h / 2.0;
    Shifts s = { 0, 0, 0, 0 };
    if (wr_field_wrap_u(field) == WR_WRAP_PERIODIC) {
        s.from_u = (int)ceil(from[0] / view->table_w - high.u);
        s.to_u = (int)floor(to[0] / view->table_w - low.u);
    }
    if (wr_field_wrap_v(field) == WR_WRAP_PERIODIC) {
        s.from_v = (int)ceil(1.0 - to[1] / view->table_h - high.v);
        s.to_v = (int)floor(1.0 - from[1] / view->table_h - low.v);
    }
    int64_t count = (int64_t)(s.to_u - s.from_u + 1) * (s.to_v - s.from_v + 1);
    if (count > COPIES_MAX) s = (Shifts){ -1, 1, -1, 1 };
    return s;
}

static void lines(const WrApp *app, const WrSelectPoint *points, int count, bool closed, int du,
                  int dv, WrColour colour, double width)
{
    double x0, y0, x1, y1;
    for (int i = closed ? 0 : 1; i < count; i++) {
        pixel_of(app, points[i == 0 ? count - 1 : i - 1], du, dv, &x0, &y0);
        pixel_of(app, points[i], du, dv, &x1, &y1);
        wr_gui_draw_line(x0, y0, x1, y1, colour, width);
    }
}

void wr_overlay_lines(const WrApp *app, const WrSelectPoint *points, int count, bool closed,
                      WrColour colour)
{
    if (count < 2) return;
    WrSelectPoint low = points[0], high = points[0];
    for (int i = 1; i < count; i++) {
        low = (WrSelectPoint){ fmin(low.u, points[i].u), fmin(low.v, points[i].v) };
        high = (WrSelectPoint){ fmax(high.u, points[i].u), fmax(high.v, points[i].v) };
    }
    double s = wr_gui_scale();
    Shifts shifts = shifts_of(app, low, high);
    for (int j = shifts.from_v; j <= shifts.to_v; j++)
        for (int i = shifts.from_u; i <= shifts.to_u; i++) {
            lines(app, points, count, closed, i, j, 0x90000000u, 3.0 * s);
            lines(app, points, count, closed, i, j, colour, 1.3 * s);
        }
}

/* Call `draw` for each visible copy, in pixels. */
static void at_copies(const WrApp *app, double u, double v, WrColour colour,
                      void (*draw)(double x, double y, WrColour colour))
{
    WrSelectPoint p = { u, v };
    Shifts shifts = shifts_of(app, p, p);
    for (int j = shifts.from_v; j <= shifts.to_v; j++)
        for (int i = shifts.from_u; i <= shifts.to_u; i++) {
            double x, y;
            pixel_of(app, p, i, j, &x, &y);
            draw(x, y, colour);
        }
}

static void draw_cross(double x, double y, WrColour colour)
{
    double s = wr_gui_scale(), arm = 7.0 * s;
    for (int pass = 0; pass < 2; pass++) {
        WrColour ink = pass ? colour : 0xa0000000u;
        double wide = (pass ? 1.5 : 3.5) * s;
        wr_gui_draw_line(x - arm, y, x + arm, y, ink, wide);
        wr_gui_draw_line(x, y - arm, x, y + arm, ink, wide);
        wr_gui_draw_circle(x, y, arm * 0.6, ink, wide);
    }
}

void wr_overlay_cross(const WrApp *app, double u, double v, WrColour colour)
{
    at_copies(app, u, v, colour, draw_cross);
}

static void draw_square(double x, double y, WrColour colour)
{
    double r = 4.0 * wr_gui_scale();
    wr_gui_draw_fill(x - r - 1, y - r - 1, 2 * r + 2, 2 * r + 2, 0xd0000000u, 0);
    wr_gui_draw_fill(x - r, y - r, 2 * r, 2 * r, colour, 0);
}

static void draw_knob(double x, double y, WrColour colour)
{
    double r = 4.0 * wr_gui_scale();
    wr_gui_draw_disc(x, y, r + 1.0, 0xd0000000u);
    wr_gui_draw_disc(x, y, r, colour);
}

void wr_overlay_handle(const WrApp *app, double u, double v, bool round, bool hot)
{
    at_copies(app, u, v, hot ? WR_COLOUR_CELL : 0xfff4f4f4u, round ? draw_knob : draw_square);
}

void wr_overlay_label(double x, double y, const char *text)
{
    double w = wr_gui_text_width(WR_FONT_SMALL, text), h = wr_gui_line_height(WR_FONT_SMALL);
    double pad = 4.0 * wr_gui_scale();
    wr_gui_draw_fill(x - w / 2 - pad, y - h / 2 - pad, w + 2 * pad, h + 2 * pad, WR_COLOUR_CHIP,
                     3.0);
    wr_gui_draw_text(x - w / 2, y - h / 2, WR_FONT_SMALL, WR_COLOUR_STRONG, text);
}
