/* Overlays of the brush on the canvas: its outline in two tones with the rotation and size of the next dab, and its
   copies; the string of the stabilizer; the straight line being aimed. */
#include "ui/canvas/tools/brush_outline.h"
#include "ui/canvas/view.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/input/stroke_smoothing.h"
#include "ui/canvas/tools/stroke_input.h"
#include "ui/toolkit/words.h"

#include "base/array.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "brush/brush.h"
#include "brush/symmetry.h"
#include "field/field.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>

#define SIDES WR_BRUSH_MARK_POINTS
#define COPIES_SHOWN 64

static void cross(double x, double y)
{
    double s = wr_gui_scale(), from = 3.0 * s, to = 9.0 * s;
    for (int pass = 0; pass < 2; pass++) {
        WrColour colour = pass ? 0xfff4f4f4u : 0xb0000000u;
        double w = pass ? 1.2 : 3.0;
        wr_gui_draw_line(x - to, y, x - from, y, colour, w);
        wr_gui_draw_line(x + from, y, x + to, y, colour, w);
        wr_gui_draw_line(x, y - to, x, y - from, colour, w);
        wr_gui_draw_line(x, y + from, x, y + to, colour, w);
    }
}

WrBrushMark wr_brush_mark(const WrApp *app)
{
    const WrBrushState *hand = app->brush;
    const WrBrush *brush = hand->drawing ? &hand->now : &app->settings->brush;
    WrBrushMark mark = { .radius = brush->radius,
                         .aspect = brush->aspect > 1.0 ? brush->aspect : 1.0,
                         .turn = brush->angle_deg * WR_RAD_PER_DEG,
                         .square = brush->tip != NULL,
                         .erases = brush->mode == WR_BRUSH_ERASE };
    bool sized = brush->pressure == WR_PRESSURE_SIZE || brush->pressure == WR_PRESSURE_BOTH;
    if (hand->drawing && sized && !brush->preset) mark.radius *= hand->pressure;
    if (app->hand->grab == WR_GRAB_NONE && app->hand->at.eraser) mark.erases = true;
    if (brush->follow && (hand->way_x != 0.0 || hand->way_y != 0.0))
        mark.turn += atan2(-hand->way_y, hand->way_x);
    return mark;
}

/*     ellipse: (r cos a, r sin a / aspect) rotated by `turn`,   a = 2 pi i / n
       picture: corners at a = pi/4 + i pi/2 of the circle of radius sqrt(2) r, hence of the square of half side r
   In texels relative to the centre, y down. */
int wr_brush_mark_points(const WrBrushMark *mark, double points[][2])
{
    double c = cos(mark->turn), s = sin(mark->turn);
    int count = mark->square ? 4 : SIDES;
    for (int i = 0; i < count; i++) {
        double a = 6.28318530717958648 * (mark->square ? (i + 0.5) / 4.0 : (double)i / count);
        double long_way = mark->radius * cos(a), across = mark->radius * sin(a);
        if (mark->square) { /* the square's corners are on the outline's circle times sqrt(2) */
            long_way *= 1.41421356237309505;
            across *= 1.41421356237309505;
        }
        across /= mark->aspect;
        points[i][0] = long_way * c - across * s;
        points[i][1] = -(long_way * s + across * c); /* y points down */
    }
    return count;
}

/* One outline about (x, y) in pixels; `copy` rotates or mirrors it (NULL: unchanged). Every line is drawn twice, dark and
   wide below light and thin, so it is visible on any height. The offsets are transformed as vectors (wr_view_step), which
   includes zoom, rotation and the mirror of the view. */
static void outline(const WrBrushMark *mark, const WrCanvasView *view, double x, double y,
                    const WrCopy *copy, WrColour dark, WrColour light)
{
    bool round = !mark->square && mark->aspect == 1.0;
    const double zoom = view->zoom;
    double points[SIDES][2], x0, y0, x1, y1;
    if (round && !mark->erases) {
        wr_gui_draw_circle(x, y, mark->radius * zoom + 1.0, dark, 1.5);
        wr_gui_draw_circle(x, y, mark->radius * zoom, light, 1.2);
        return;
    }
    int count = wr_brush_mark_points(mark, points);
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < count; i++) {
            const double *p = points[i], *q = points[(i + 1) % count];
            if (mark->erases && pass == 1 && !mark->square && i % 4 >= 2) continue; /* dashes */
            double a = 1, b = 0, c = 0, d = 1;
            if (copy) a = copy->a, b = copy->b, c = copy->c, d = copy->d;
            wr_view_step(view, a * p[0] + b * p[1], c * p[0] + d * p[1], &x0, &y0);
            wr_view_step(view, a * q[0] + b * q[1], c * q[0] + d * q[1], &x1, &y1);
            wr_gui_draw_line(x + x0, y + y0, x + x1, y + y1, pass ? light : dark, pass ? 1.2 : 2.6);
        }
    }
    if (mark->erases && mark->square) {
        for (int i = 0; i < 2; i++) {
            wr_view_step(view, points[i][0], points[i][1], &x0, &y0);
            wr_view_step(view, points[i + 2][0], points[i + 2][1], &x1, &y1);
            wr_gui_draw_line(x + x0, y + y0, x + x1, y + y1, light, 1.0);
        }
    }
}

/* Rectangle of the cell, or its bounding box in a rotated view. */
static SDL_Rect cell_box(const WrCanvasView *view)
{
    double x0 = INFINITY, y0 = INFINITY, x1 = -INFINITY, y1 = -INFINITY, x, y;
    for (int k = 0; k < 4; k++) {
        wr_view_place(view, k & 1 ? view->table_w : 0, k & 2 ? view->table_h : 0, &x, &y);
        x0 = fmin(x0, x), x1 = fmax(x1, x);
        y0 = fmin(y0, y), y1 = fmax(y1, y);
    }
    return (SDL_Rect){ (int)x0, (int)y0, (int)(x1 - x0), (int)(y1 - y0) };
}

/* Inside the cell: the areas that the stroke touches across an edge, or by a copy. */
static void outline_in_cell(const WrApp *app, const WrBrushMark *mark, double x, double y)
{
    const WrField *field = wr_app_field(app);
    WrShift copies[WR_VIEW_COPIES];
    int count = wr_view_outline_copies(app->view, wr_field_wrap_u(field) == WR_WRAP_PERIODIC,
                                       wr_field_wrap_v(field) == WR_WRAP_PERIODIC, x, y,
                                       mark->radius, copies);
    wr_gui_draw_clip(cell_box(app->view));
    for (int i = 0; i < count; i++) {
        if (copies[i].dx == 0.0 && copies[i].dy == 0.0) continue;
        double px, py;
        wr_view_to_pixel(app->view, x + copies[i].dx, y + copies[i].dy, &px, &py);
        outline(mark, app->view, px, py, NULL, 0x60000000u, 0x90f4f4f4u);
    }
    wr_gui_draw_unclip();
}

/* Faint outlines at the symmetry's copies of the dab, in the cell under the pointer. The copies are affine maps of the cell
   at the origin. The pointer may be in any repetition, so it is reduced to that cell, mapped, reduced again, and moved back
   to the cell under the pointer. Entry 0 is the dab itself. */
static void outline_copies(const WrApp *app, const WrBrushMark *mark, double x, double y)
{
    const WrField *field = wr_app_field(app);
    const WrSymmetry *symmetry = &app->settings->brush.symmetry;
    bool any = symmetry->mirror_u || symmetry->mirror_v || symmetry->radial > 1 ||
               symmetry->repeat_u > 1 || symmetry->repeat_v > 1;
    if (!any) return;
    WrCopy *copies = wr_alloc(WR_COPIES_MAX, sizeof *copies);
    int count = wr_symmetry_copies(symmetry, field, copies);
    double w = app->view->table_w, h = app->view->table_h, px, py;
    double cell_x = floor(x / w) * w, cell_y = floor(y / h) * h;
    bool wraps_u = wr_field_wrap_u(field) == WR_WRAP_PERIODIC;
    bool wraps_v = wr_field_wrap_v(field) == WR_WRAP_PERIODIC;
    if (!wraps_u) cell_x = 0.0;
    if (!wraps_v) cell_y = 0.0;
    for (int i = 1; i < count && i <= COPIES_SHOWN; i++) {
        const WrCopy *c = &copies[i];
        double lx = x - cell_x, ly = y - cell_y;
        double tx = c->a * lx + c->b * ly + c->dx, ty = c->c * lx + c->d * ly + c->dy;
        if (wraps_u) tx -= floor(tx / w) * w;
        if (wraps_v) ty -= floor(ty / h) * h;
        wr_view_to_pixel(app->view, tx + cell_x, ty + cell_y, &px, &py);
        outline(mark, app->view, px, py, c, 0x48000000u, 0x70f4f4f4u);
    }
    wr_free(copies);
}

static void show_line(const WrApp *app, const WrBrushMark *mark)
{
    const WrBrushState *hand = app->brush;
    double w = app->view->table_w, h = app->view->table_h, x0, y0, x1, y1;
    wr_view_to_pixel(app->view, hand->line_u * w, (1.0 - hand->line_v) * h, &x0, &y0);
    wr_view_to_pixel(app->view, hand->to_u * w, (1.0 - hand->to_v) * h, &x1, &y1);
    double dx = x1 - x0, dy = y1 - y0, way = hypot(dx, dy), r = mark->radius * app->view->zoom;
    for (int pass = 0; pass < 2; pass++) {
        WrColour colour = pass ? 0xfff4f4f4u : 0xb0000000u;
        double width = pass ? 1.2 : 2.6;
        wr_gui_draw_line(x0, y0, x1, y1, colour, width);
        if (way < 1.0) continue;
        double nx = -dy / way * r, ny = dx / way * r;
        wr_gui_draw_line(x0 + nx, y0 + ny, x1 + nx, y1 + ny, pass ? 0x90f4f4f4u : colour, width);
        wr_gui_draw_line(x0 - nx, y0 - ny, x1 - nx, y1 - ny, pass ? 0x90f4f4f4u : colour, width);
    }
    outline(mark, app->view, x0, y0, NULL, 0xb0000000u, 0xfff4f4f4u);
    outline(mark, app->view, x1, y1, NULL, 0xb0000000u, 0xfff4f4f4u);
}

void wr_brush_show_string(const WrApp *app)
{
    const WrSmoothing *s = &app->brush->steady;
    if (!app->brush->drawing || s->kind == WR_SMOOTHING_OFF) return;
    wr_gui_draw_line(s->follower.x, s->follower.y, s->pointer.x, s->pointer.y, 0xb0000000u, 3.0);
    wr_gui_draw_line(s->follower.x, s->follower.y, s->pointer.x, s->pointer.y, WR_COLOUR_ACCENT,
                     1.4);
    wr_gui_draw_disc(s->pointer.x, s->pointer.y, 2.5 * wr_gui_scale(), WR_COLOUR_ACCENT);
}

static void show_size(const WrApp *app, const WrPointer *at)
{
    char text[48];
    wr_words_print(text, sizeof text, "%.4g px", 2.0 * app->settings->brush.radius);
    double w = wr_gui_text_width(WR_FONT_TEXT, text), h = wr_gui_line_height(WR_FONT_TEXT);
    double pad = 6.0 * wr_gui_scale();
    wr_gui_draw_fill(at->x - w / 2 - pad, at->y - h / 2 - pad, w + 2 * pad, h + 2 * pad,
                     WR_COLOUR_CHIP, 3.0);
    wr_gui_draw_text(at->x - w / 2, at->y - h / 2, WR_FONT_TEXT, WR_COLOUR_STRONG, text);
}

void wr_brush_overlay(WrApp *app)
{
    const WrPointer *at = app->hand->grab == WR_GRAB_RESIZE ? &app->hand->start : &app->hand->at;
    const WrSmoothing *steady = &app->brush->steady;
    WrBrushMark mark = wr_brush_mark(app);
    double x, y, px = at->x, py = at->y;
    if (app->brush->straight) {
        show_line(app, &mark);
        return;
    }
    if (app->brush->drawing && steady->kind != WR_SMOOTHING_OFF) {
        px = steady->follower.x; /* the outline is at the drawn position, not at the pointer */
        py = steady->follower.y;
    }
    wr_brush_show_string(app);
    wr_view_to_texel(app->view, px, py, &x, &y);
    outline_copies(app, &mark, x, y);
    if (mark.radius * app->view->zoom < 3.0 * wr_gui_scale()) {
        cross(px, py);
        return;
    }
    outline_in_cell(app, &mark, x, y);
    outline(&mark, app->view, px, py, NULL, 0xb0000000u, 0xfff4f4f4u);
    if (app->hand->grab == WR_GRAB_RESIZE) show_size(app, at);
}
