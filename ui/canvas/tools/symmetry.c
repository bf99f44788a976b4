/* Symmetry: parameters in a small panel over the canvas; axes and draggable centre on the table. */
#include "ui/canvas/tools/symmetry.h"
#include "ui/canvas/view.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"

#include "base/error.h"
#include "brush/symmetry.h"

#include <SDL.h>
#include <math.h>

#define AXIS 0xb04a8fdcu
#define WIDE_UNITS 262
#define TALL_UNITS 261

void wr_symmetry_apply(WrApp *app)
{
    WrSettings *s = app->settings;
    WrError err;
    bool good = wr_symmetry_check(&s->symmetry, &err);
    s->brush.symmetry = s->symmetric && good ? s->symmetry : (WrSymmetry){ 0 };
    if (s->symmetric && !good) wr_app_fail(app, &err);
    wr_app_redraw(app);
}

static bool is_shown(const WrApp *app)
{
    return app->settings->symmetric || app->settings->symmetry_panel;
}

/* ---- drawing on the canvas ---- */

/* A line across the whole view: vertical at u, or horizontal at v. */
static void axis_line(const WrApp *app, int axis, double texel)
{
    double low[2], high[2], x0, y0, x1, y1;
    wr_view_bounds(app->view, low, high);
    wr_view_place(app->view, axis ? low[0] : texel, axis ? texel : low[1], &x0, &y0);
    wr_view_place(app->view, axis ? high[0] : texel, axis ? texel : high[1], &x1, &y1);
    wr_gui_draw_line(x0, y0, x1, y1, AXIS, wr_gui_scale());
}

/* Spokes of half a cell's length: rotation is about the centre of each cell. Spoke i has the angle pi/2 + 2 pi i / n in the
   texel plane, with v up and rows down: hence 1 - v and the minus at the sine. */
static void spokes(const WrApp *app, const WrSymmetry *s)
{
    const WrCanvasView *view = app->view;
    double x = s->centre_u * view->table_w, y = (1.0 - s->centre_v) * view->table_h;
    double reach = 0.5 * (view->table_w < view->table_h ? view->table_w : view->table_h);
    if (s->radial > 72) return;
    for (int i = 0; i < s->radial; i++) {
        double a = 1.5707963267948966 + 6.283185307179586 * i / s->radial;
        double x0, y0, x1, y1;
        wr_view_to_pixel(view, x, y, &x0, &y0);
        wr_view_to_pixel(view, x + reach * cos(a), y - reach * sin(a), &x1, &y1);
        wr_gui_draw_line(x0, y0, x1, y1, AXIS, wr_gui_scale());
    }
}

/* Copies of the centre in the lattice.
       u = c_u + i / M,   v = c_v + (j + i * stagger) / N,   i < M, j < N, both modulo 1
   The same lattice is evaluated for dabs in src/brush/symmetry.c. Beyond 256 points the discs would hide the table. */
static void lattice(const WrApp *app, const WrSymmetry *s)
{
    if (s->repeat_u * s->repeat_v > 256) return;
    for (int i = 0; i < s->repeat_u; i++)
        for (int j = 0; j < s->repeat_v; j++) {
            double u = s->centre_u + (double)i / s->repeat_u;
            double v = s->centre_v + (double)j / s->repeat_v + i * s->stagger / s->repeat_v;
            double x, y, r = 3.0 * wr_gui_scale();
            wr_view_to_pixel(app->view, (u - floor(u)) * app->view->table_w,
                             (1.0 - (v - floor(v))) * app->view->table_h, &x, &y);
            wr_gui_draw_disc(x, y, r + 1.0, 0x90000000u);
            wr_gui_draw_disc(x, y, r, WR_COLOUR_ACCENT);
        }
}

void wr_symmetry_marks(WrApp *app)
{
    const WrSymmetry *s = &app->settings->symmetry;
    if (!is_shown(app)) return;
    if (app->settings->symmetric && s->mirror_u)
        axis_line(app, 0, s->centre_u * app->view->table_w);
    if (app->settings->symmetric && s->mirror_v)
        axis_line(app, 1, (1.0 - s->centre_v) * app->view->table_h);
    if (app->settings->symmetric && s->radial > 1) spokes(app, s);
    if (app->settings->symmetric && s->repeat_u * s->repeat_v > 1) lattice(app, s);
    if (!app->settings->symmetry_panel) return;
    double x, y;
    wr_view_to_pixel(app->view, s->centre_u * app->view->table_w,
                     (1.0 - s->centre_v) * app->view->table_h, &x, &y);
    double r = 6.0 * wr_gui_scale();
    wr_gui_draw_disc(x, y, r + 1.5, 0xb0000000u);
    wr_gui_draw_disc(x, y, r, app->hand->grab == WR_GRAB_SYMMETRY ? WR_COLOUR_CELL : 0xfff4f4f4u);
    wr_gui_draw_disc(x, y, r * 0.45, WR_COLOUR_ACCENT);
}

bool wr_symmetry_press(WrApp *app, const WrPointer *at)
{
    const WrSymmetry *s = &app->settings->symmetry;
    double x, y;
    if (!app->settings->symmetry_panel || at->button != SDL_BUTTON_LEFT) return false;
    wr_view_to_pixel(app->view, s->centre_u * app->view->table_w,
                     (1.0 - s->centre_v) * app->view->table_h, &x, &y);
    return hypot(at->x - x, at->y - y) <= 9.0 * wr_gui_scale();
}

/* Snap to whole and half texels, so that mirroring can be exact; with Shift to eighths of the cell. The mirrored texel of i
   about a centre c in texels is 2 c - 1 - i, an integer exactly if c is a multiple of 1/2; only then are the copies of a dab
   the same texels mirrored, without resampling. */
static double snapped(double u, int size, bool shift)
{
    double steps = shift ? 8.0 : 2.0 * size, at = rint(u * steps) / steps;
    return at < 0.0 ? 0.0 : at > 1.0 ? 1.0 : at;
}

void wr_symmetry_drag(WrApp *app, const WrPointer *at)
{
    WrSymmetry *s = &app->settings->symmetry;
    bool shift = (at->mods & WR_MOD_SHIFT) != 0;
    s->centre_u = snapped(at->u, app->view->table_w, shift);
    s->centre_v = snapped(at->v, app->view->table_h, shift);
    wr_symmetry_apply(app);
}

/* ---- the panel ---- */

static bool whole(const char *id, double width, double low, double high, const char *tip,
                  int *value)
{
    WrNumber spec = { .low = low, .high = high, .reset = low, .tip = tip };
    double number = *value;
    if (wr_gui_number(id, width, &spec, &number) == WR_EDIT_NONE) return false;
    *value = (int)number;
    return true;
}

static bool mirrors(WrSymmetry *s)
{
    wr_gui_label("Mirror");
    bool changed = wr_gui_check("u", &s->mirror_u);
    wr_gui_tip("Mirrors strokes left and right about a vertical axis through the centre");
    wr_gui_same_line(12);
    changed |= wr_gui_check("v", &s->mirror_v);
    wr_gui_tip("Mirrors strokes above and below a horizontal axis through the centre");
    return changed;
}

static bool mesh_mirrors(bool mirror[3])
{
    static const char *const labels[] = { "x", "y", "z" };
    bool changed = false;
    wr_gui_label("On meshes");
    for (int k = 0; k < 3; k++) {
        if (k > 0) wr_gui_same_line(12);
        changed |= wr_gui_check(labels[k], &mirror[k]);
        wr_gui_tip("Repeats strokes on a mesh mirrored across its axes");
    }
    return changed;
}

static bool numbers(WrSymmetry *s)
{
    static const WrNumber place = { .low = 0,
                                    .high = 1,
                                    .reset = 0.5,
                                    .decimals = 3,
                                    .tip = "Drag the white knob on the table; Shift snaps it" };
    WrNumber stagger = { .low = 0,
                         .high = 0.99,
                         .reset = 0,
                         .decimals = 3,
                         .tip = "Upward shift of each column relative to the one before, in rows: "
                                "0.5 and an even number of columns is a half-drop" };
    wr_gui_label("Turns");
    bool changed = whole("radial", 0, 1, 24, "Number of copies around the centre", &s->radial);
    wr_gui_label("Centre");
    double half = wr_gui_available() / 2.0 - wr_gui_px(3);
    changed |= wr_gui_number("cu", half, &place, &s->centre_u) != WR_EDIT_NONE;
    wr_gui_same_line(6);
    changed |= wr_gui_number("cv", half, &place, &s->centre_v) != WR_EDIT_NONE;
    wr_gui_label("Repeat");
    changed |=
        whole("ru", half, 1, 16, "Number of columns of the lattice in the cell", &s->repeat_u);
    wr_gui_same_line(6);
    changed |= whole("rv", half, 1, 16, "Number of rows of the lattice in the cell", &s->repeat_v);
    wr_gui_label("Stagger");
    changed |= wr_gui_number("stagger", 0, &stagger, &s->stagger) != WR_EDIT_NONE;
    return changed;
}

/* Allow only offsets k/M, with which the lattice closes around the cell. Column i is raised by i * stagger rows; after M
   columns the table repeats, so M * stagger must be a whole number of rows. The offset M/M would equal offset 0 and is
   excluded. */
static void close_lattice(WrSymmetry *s)
{
    double steps = s->repeat_u, k = rint(s->stagger * steps);
    s->stagger = k >= steps ? (steps - 1.0) / steps : k / steps;
}

void wr_panel_symmetry(WrApp *app)
{
    WrSettings *settings = app->settings;
    const SDL_Rect *room = &app->layout->canvas;
    int gap = wr_gui_px(12), w = wr_gui_px(WIDE_UNITS), h = wr_gui_px(TALL_UNITS);
    if (!settings->symmetry_panel || room->w <= 0) return;
    h = h < room->h - 2 * gap ? h : room->h - 2 * gap;
    SDL_Rect place = { room->x + gap, room->y + room->h - gap - h, w, h };
    wr_gui_area_begin("##symmetry", WR_AREA_PANEL, place, WR_COLOUR_PANEL);
    bool on = settings->symmetric;
    bool changed = wr_gui_check("Symmetry", &on);
    wr_gui_tip("Paints strokes, shapes and stamps with all copies");
    wr_gui_same_line(0);
    wr_gui_move_to(wr_gui_width() - wr_gui_px(36));
    if (wr_gui_glyph("close", WR_ICON_CLOSE, 24, WR_COLOUR_LABEL)) settings->symmetry_panel = false;
    wr_gui_tip("Close, and keep the symmetry");
    bool moved = mirrors(&settings->symmetry);
    moved |= mesh_mirrors(settings->mesh_mirror);
    moved |= numbers(&settings->symmetry);
    if (moved) close_lattice(&settings->symmetry);
    if (moved) on = true; /* a change of the parameters makes the symmetry visible */
    wr_gui_label("");
    if (wr_gui_chip(NULL, "Reset")) {
        settings->symmetry = wr_settings_default().symmetry;
        settings->symmetry.mirror_u = false;
        moved = true;
        on = false;
    }
    changed |= moved || on != settings->symmetric;
    settings->symmetric = on;
    if (changed) wr_symmetry_apply(app);
    wr_gui_area_end();
}
