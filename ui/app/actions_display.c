#include "ui/app/actions_display.h"
#include "ui/canvas/canvas.h"
#include "ui/canvas/view.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/focus.h"

void wr_act_display_grey(WrApp *app)
{
    app->settings->look.shown = WR_CANVAS_HEIGHTS;
    app->settings->look.colours = WR_CANVAS_GREY;
}

void wr_act_display_signed(WrApp *app)
{
    app->settings->look.shown = WR_CANVAS_HEIGHTS;
    app->settings->look.colours = WR_CANVAS_SIGNED;
}

bool wr_is_grey(const WrApp *app)
{
    const WrCanvasDisplay *look = &app->settings->look;
    return look->shown == WR_CANVAS_HEIGHTS && look->colours == WR_CANVAS_GREY;
}

bool wr_is_signed(const WrApp *app)
{
    const WrCanvasDisplay *look = &app->settings->look;
    return look->shown == WR_CANVAS_HEIGHTS && look->colours == WR_CANVAS_SIGNED;
}

void wr_act_display_contours(WrApp *app)
{
    app->settings->look.shown = WR_CANVAS_HEIGHTS;
    app->settings->look.colours = WR_CANVAS_CONTOURS;
}

bool wr_is_contours(const WrApp *app)
{
    const WrCanvasDisplay *look = &app->settings->look;
    return look->shown == WR_CANVAS_HEIGHTS && look->colours == WR_CANVAS_CONTOURS;
}

void wr_act_display_relief(WrApp *app)
{
    WrCanvasShown *shown = &app->settings->look.shown;
    *shown = *shown == WR_CANVAS_LIT ? WR_CANVAS_HEIGHTS : WR_CANVAS_LIT;
}

bool wr_is_relief(const WrApp *app)
{
    return app->settings->look.shown == WR_CANVAS_LIT;
}

void wr_act_display_normals(WrApp *app)
{
    app->settings->look.shown = WR_CANVAS_BENT;
}

bool wr_canvas_shows_normals(const WrApp *app)
{
    return app->settings->look.shown == WR_CANVAS_BENT;
}

void wr_act_display_occlusion(WrApp *app)
{
    app->settings->look.shown = WR_CANVAS_OCCLUSION;
}

bool wr_is_occlusion(const WrApp *app)
{
    return app->settings->look.shown == WR_CANVAS_OCCLUSION;
}

void wr_act_display_curvature(WrApp *app)
{
    app->settings->look.shown = WR_CANVAS_CURVATURE;
}

bool wr_is_curvature(const WrApp *app)
{
    return app->settings->look.shown == WR_CANVAS_CURVATURE;
}

void wr_act_display_cavity(WrApp *app)
{
    app->settings->look.shown = WR_CANVAS_CAVITY;
}

bool wr_is_cavity(const WrApp *app)
{
    return app->settings->look.shown == WR_CANVAS_CAVITY;
}

void wr_act_display_slope(WrApp *app)
{
    app->settings->look.shown = WR_CANVAS_SLOPE;
}

bool wr_is_slope(const WrApp *app)
{
    return app->settings->look.shown == WR_CANVAS_SLOPE;
}

void wr_act_display_roughness(WrApp *app)
{
    app->settings->look.shown = WR_CANVAS_ROUGHNESS;
}

bool wr_is_roughness(const WrApp *app)
{
    return app->settings->look.shown == WR_CANVAS_ROUGHNESS;
}

void wr_act_theme_dark(WrApp *app)
{
    app->settings->theme = WR_THEME_DARK;
}

bool wr_is_theme_dark(const WrApp *app)
{
    return app->settings->theme == WR_THEME_DARK;
}

void wr_act_theme_light(WrApp *app)
{
    app->settings->theme = WR_THEME_LIGHT;
}

bool wr_is_theme_light(const WrApp *app)
{
    return app->settings->theme == WR_THEME_LIGHT;
}

void wr_act_theme_contrast(WrApp *app)
{
    app->settings->theme = WR_THEME_CONTRAST;
}

bool wr_is_theme_contrast(const WrApp *app)
{
    return app->settings->theme == WR_THEME_CONTRAST;
}

/* ---- the grid ---- */

void wr_act_grid(WrApp *app)
{
    app->settings->grid = !app->settings->grid;
    wr_app_redraw(app);
}

bool wr_is_grid(const WrApp *app)
{
    return app->settings->grid;
}

static void parts(WrApp *app, int count)
{
    app->settings->grid = true;
    app->settings->grid_parts = count < 1 ? 1 : count > 256 ? 256 : count;
    wr_app_redraw(app);
}

void wr_act_grid_finer(WrApp *app)
{
    parts(app, app->settings->grid_parts * 2);
}

void wr_act_grid_coarser(WrApp *app)
{
    parts(app, app->settings->grid_parts / 2);
}

/* ---- tiling of the table ---- */

#define TURN_DEG 15.0

static void turn_to(WrApp *app, double degrees)
{
    WrCanvasView *view = app->view;
    wr_view_turn_at(view, view->x + view->w / 2.0, view->y + view->h / 2.0, degrees);
    wr_app_redraw(app);
}

void wr_act_turn_left(WrApp *app)
{
    turn_to(app, app->view->turn - TURN_DEG);
}

void wr_act_turn_right(WrApp *app)
{
    turn_to(app, app->view->turn + TURN_DEG);
}

void wr_act_turn_none(WrApp *app)
{
    turn_to(app, 0.0);
}

bool wr_is_turned(const WrApp *app)
{
    return app->view->turn != 0.0;
}

#define TILING(name, value)                                                                        \
    void wr_act_tiling_##name(WrApp *app)                                                          \
    {                                                                                              \
        app->settings->tiling = value;                                                             \
        wr_app_redraw(app);                                                                        \
    }                                                                                              \
    bool wr_is_tiling_##name(const WrApp *app)                                                     \
    {                                                                                              \
        return app->settings->tiling == value;                                                     \
    }
TILING(straight, WR_TILING_STRAIGHT)
TILING(half_drop, WR_TILING_HALF_DROP)
TILING(brick, WR_TILING_BRICK)
#undef TILING

/* ---- areas of the window ---- */

void wr_act_view_both(WrApp *app)
{
    const double d = app->settings->divider;
    if (d <= 0.0 || d >= 1.0) app->settings->divider = 0.5; /* one of them was closed */
    app->settings->views = WR_VIEWS_BOTH;
}

void wr_act_view_canvas(WrApp *app)
{
    app->settings->views = WR_VIEWS_CANVAS;
}

void wr_act_view_patch(WrApp *app)
{
    app->settings->views = WR_VIEWS_PATCH;
}

bool wr_is_both(const WrApp *app)
{
    return app->settings->views == WR_VIEWS_BOTH;
}

bool wr_is_canvas(const WrApp *app)
{
    return app->settings->views == WR_VIEWS_CANVAS;
}

bool wr_is_patch(const WrApp *app)
{
    return app->settings->views == WR_VIEWS_PATCH;
}

void wr_act_part_next(WrApp *app)
{
    wr_gui_focus_part(app->gui, 1);
}

void wr_act_part_back(WrApp *app)
{
    wr_gui_focus_part(app->gui, -1);
}

void wr_act_menus(WrApp *app)
{
    wr_gui_focus_menus(app->gui, true);
}
