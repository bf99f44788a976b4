/* SPDX-License-Identifier: MIT
   The one table of actions: menus, keys and buttons all go by it. */
#include "ui/actions.h"
#include "ui/line.h"

#include <math.h>
#include <string.h>

/* ---- edit ---- */

static void undo(WrApp *app)
{
    wr_app_run_line(app, "undo");
}

static void redo(WrApp *app)
{
    wr_app_run_line(app, "redo");
}

static bool can_undo(const WrApp *app)
{
    return wr_session_history_position(app->session) > wr_session_history_oldest(app->session);
}

static bool can_redo(const WrApp *app)
{
    return wr_session_history_position(app->session) < wr_session_history_count(app->session);
}

static bool has_history(const WrApp *app)
{
    return wr_session_history_position(app->session) > 0;
}

static void search(WrApp *app)
{
    wr_dialog_open(app, WR_DIALOG_SEARCH);
}

/* ---- brush ---- */

static double clamp(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

static void scale_radius(WrApp *app, double factor)
{
    double old = app->settings.brush.radius, r = old * factor;
    r = r < 10.0 ? rint(r * 10.0) / 10.0 : rint(r);
    if (r == old) r += factor > 1.0 ? 0.1 : -0.1;
    app->settings.brush.radius = clamp(r, 0.5, 16384.0);
}

static void size_up(WrApp *app)
{
    scale_radius(app, 1.15);
}

static void size_down(WrApp *app)
{
    scale_radius(app, 1.0 / 1.15);
}

static void add_hardness(WrApp *app, double step)
{
    app->settings.brush.hardness =
        clamp(rint((app->settings.brush.hardness + step) * 20.0) / 20.0, 0, 1);
}

static void hardness_up(WrApp *app)
{
    add_hardness(app, 0.05);
}

static void hardness_down(WrApp *app)
{
    add_hardness(app, -0.05);
}

/* Two digits: 0.1, 0.12, 0.14, 0.17 ... */
static void scale_strength(WrApp *app, double factor)
{
    double s = app->settings.brush.strength * factor;
    s = clamp(s, 1e-4, 1e6);
    double unit = pow(10.0, floor(log10(s)) - 1.0), digits = rint(s / unit);
    app->settings.brush.strength = unit < 1.0 ? digits / rint(1.0 / unit) : digits * unit;
}

static void strength_up(WrApp *app)
{
    scale_strength(app, 1.2);
}

static void strength_down(WrApp *app)
{
    scale_strength(app, 1.0 / 1.2);
}

static void swap_mode(WrApp *app)
{
    WrBrush *brush = &app->settings.brush;
    brush->mode = brush->mode == WR_BRUSH_RAISE ? WR_BRUSH_LOWER : WR_BRUSH_RAISE;
}

static void level_mode(WrApp *app)
{
    app->settings.brush.mode = WR_BRUSH_TO;
}

static void choose_tool(WrApp *app, const char *name)
{
    wr_hand_let_go(app);
    app->tool = wr_tool_find(name);
}

static void tool_brush(WrApp *app)
{
    choose_tool(app, "brush");
}

static void tool_pick(WrApp *app)
{
    choose_tool(app, "pick");
}

static void tool_select_rect(WrApp *app)
{
    choose_tool(app, "select_rect");
}

static void tool_select_ellipse(WrApp *app)
{
    choose_tool(app, "select_ellipse");
}

static void tool_select_lasso(WrApp *app)
{
    choose_tool(app, "select_lasso");
}

static void tool_pan(WrApp *app)
{
    choose_tool(app, "pan");
}

static void tool_zoom(WrApp *app)
{
    choose_tool(app, "zoom");
}

/* ---- table ---- */

static void table_size(WrApp *app)
{
    const WrField *field = wr_app_field(app);
    app->forms.width = wr_field_width(field);
    app->forms.height = wr_field_height(field);
    app->forms.wrap = (wr_field_wrap_u(field) == WR_WRAP_CLAMP ? 1 : 0) |
                      (wr_field_wrap_v(field) == WR_WRAP_CLAMP ? 2 : 0);
    wr_dialog_open(app, WR_DIALOG_TABLE);
}

static void fill(WrApp *app)
{
    wr_dialog_open(app, WR_DIALOG_FILL);
}

static void grid(WrApp *app)
{
    wr_dialog_open(app, WR_DIALOG_GRID);
}

static void import(WrApp *app)
{
    wr_dialog_open(app, WR_DIALOG_IMPORT);
}

static void export(WrApp *app)
{
    wr_dialog_open(app, WR_DIALOG_EXPORT);
}

/* ---- view ---- */

static void zoom_by(WrApp *app, double factor)
{
    const WrView *v = &app->view;
    bool here = app->hand.on_canvas;
    wr_view_zoom_at(&app->view, here ? app->hand.at.x : v->x + v->w / 2.0,
                    here ? app->hand.at.y : v->y + v->h / 2.0, v->zoom * factor);
}

static void zoom_in(WrApp *app)
{
    zoom_by(app, 1.41421356237309505);
}

static void zoom_out(WrApp *app)
{
    zoom_by(app, 0.70710678118654752);
}

static void zoom_100(WrApp *app)
{
    zoom_by(app, 1.0 / app->view.zoom);
}

static void fit(WrApp *app)
{
    wr_view_fit(&app->view, 0.06);
}

static void pan_by(WrApp *app, double x, double y)
{
    wr_view_pan(&app->view, x * app->view.w / 10.0, y * app->view.h / 10.0);
}

static void pan_left(WrApp *app)
{
    pan_by(app, 1, 0);
}

static void pan_right(WrApp *app)
{
    pan_by(app, -1, 0);
}

static void pan_up(WrApp *app)
{
    pan_by(app, 0, 1);
}

static void pan_down(WrApp *app)
{
    pan_by(app, 0, -1);
}

static void panels(WrApp *app)
{
    app->settings.panels = !app->settings.panels;
}

static bool panels_shown(const WrApp *app)
{
    return app->settings.panels;
}

static void view_both(WrApp *app)
{
    app->settings.views = WR_VIEWS_BOTH;
}

static void view_canvas(WrApp *app)
{
    app->settings.views = WR_VIEWS_CANVAS;
}

static void view_patch(WrApp *app)
{
    app->settings.views = WR_VIEWS_PATCH;
}

static bool is_both(const WrApp *app)
{
    return app->settings.views == WR_VIEWS_BOTH;
}

static bool is_canvas(const WrApp *app)
{
    return app->settings.views == WR_VIEWS_CANVAS;
}

static bool is_patch(const WrApp *app)
{
    return app->settings.views == WR_VIEWS_PATCH;
}

static void look_grey(WrApp *app)
{
    app->settings.look.colours = WR_CANVAS_GREY;
}

static void look_signed(WrApp *app)
{
    app->settings.look.colours = WR_CANVAS_SIGNED;
}

static bool is_grey(const WrApp *app)
{
    return app->settings.look.colours == WR_CANVAS_GREY;
}

static bool is_signed(const WrApp *app)
{
    return app->settings.look.colours == WR_CANVAS_SIGNED;
}

static void range_auto(WrApp *app)
{
    app->settings.look.automatic = !app->settings.look.automatic;
}

static bool is_auto(const WrApp *app)
{
    return app->settings.look.automatic;
}

static void ants(WrApp *app)
{
    app->settings.ants = !app->settings.ants;
}

static bool is_ants(const WrApp *app)
{
    return app->settings.ants;
}

static void turn(WrApp *app)
{
    app->settings.turning = !app->settings.turning;
}

static bool is_turning(const WrApp *app)
{
    return app->settings.turning;
}

static void fullscreen(WrApp *app)
{
    bool full = (SDL_GetWindowFlags(app->window) & SDL_WINDOW_FULLSCREEN_DESKTOP) != 0;
    SDL_SetWindowFullscreen(app->window, full ? 0 : SDL_WINDOW_FULLSCREEN_DESKTOP);
}

static void camera_reset(WrApp *app)
{
    wr_patch_commit_zoom(app, false);
    wr_app_run_line(app, "camera perspective eye=0,0,1 target=0,0,0 up=0,1,0 fov=35 fit=on");
}

static void pose_reset(WrApp *app)
{
    const double *pose = wr_surfaces[wr_app_scene(app)->shape.kind]->pose_deg;
    WrText line = { 0 };
    wr_text_add(&line, "rotate ");
    wr_line_plain_vec(&line, (WrVec3){ pose[0], pose[1], pose[2] });
    if (wr_app_run_line(app, wr_text_get(&line))) app->patch.turn_deg = 0.0;
    wr_text_fini(&line);
}

static void help(WrApp *app)
{
    wr_dialog_open(app, WR_DIALOG_HELP);
}

static void about(WrApp *app)
{
    wr_dialog_open(app, WR_DIALOG_ABOUT);
}

static void save(WrApp *app)
{
    wr_app_save(app);
}

const WrAction wr_actions[] = {
    { "new", "New", wr_app_new, NULL, NULL },
    { "open", "Open...", wr_app_open, NULL, NULL },
    { "save", "Save", save, NULL, NULL },
    { "save_as", "Save as...", wr_app_save_as, NULL, NULL },
    { "export", "Export...", export, NULL, NULL },
    { "save_history", "Save history as script...", wr_app_save_history, has_history, NULL },
    { "quit", "Quit", wr_app_quit, NULL, NULL },
    { "undo", "Undo", undo, can_undo, NULL },
    { "redo", "Redo", redo, can_redo, NULL },
    { "search", "Search actions...", search, NULL, NULL },
    { "brush", "Brush", tool_brush, NULL, NULL },
    { "select_rect", "Rectangle selection", tool_select_rect, NULL, NULL },
    { "select_ellipse", "Ellipse selection", tool_select_ellipse, NULL, NULL },
    { "select_lasso", "Lasso selection", tool_select_lasso, NULL, NULL },
    { "pick", "Pick height", tool_pick, NULL, NULL },
    { "pan", "Move the table", tool_pan, NULL, NULL },
    { "zoom", "Zoom", tool_zoom, NULL, NULL },
    { "size_up", "Larger brush", size_up, NULL, NULL },
    { "size_down", "Smaller brush", size_down, NULL, NULL },
    { "hardness_up", "Harder brush", hardness_up, NULL, NULL },
    { "hardness_down", "Softer brush", hardness_down, NULL, NULL },
    { "strength_up", "Stronger brush", strength_up, NULL, NULL },
    { "strength_down", "Weaker brush", strength_down, NULL, NULL },
    { "swap_mode", "Swap raise and lower", swap_mode, NULL, NULL },
    { "level_mode", "Paint to a height", level_mode, NULL, NULL },
    { "select_all", "Select all", wr_act_select_all, NULL, NULL },
    { "select_none", "Select none", wr_act_select_none, wr_can_mask_selection, NULL },
    { "select_invert", "Invert selection", wr_act_select_invert, NULL, NULL },
    { "select_grow", "Grow selection...", wr_act_select_grow, wr_can_mask_selection, NULL },
    { "select_shrink", "Shrink selection...", wr_act_select_shrink, wr_can_mask_selection, NULL },
    { "select_feather", "Feather selection...", wr_act_select_feather, wr_can_mask_selection,
      NULL },
    { "select_height", "Select by height...", wr_act_select_height, NULL, NULL },
    { "select_slope", "Select by slope...", wr_act_select_slope, NULL, NULL },
    { "layer_add", "New layer", wr_act_layer_add, NULL, NULL },
    { "layer_duplicate", "Duplicate layer", wr_act_layer_duplicate, NULL, NULL },
    { "layer_delete", "Delete layer", wr_act_layer_delete, wr_can_several_layers, NULL },
    { "layer_rename", "Rename layer", wr_act_layer_rename, NULL, NULL },
    { "layer_merge", "Merge layer down", wr_act_layer_merge, wr_can_merge, NULL },
    { "layer_flatten", "Flatten all layers", wr_act_layer_flatten, wr_can_several_layers, NULL },
    { "layer_clear", "Clear layer", wr_act_layer_clear, NULL, NULL },
    { "layer_show", "Layer is shown", wr_act_layer_show, NULL, wr_is_layer_shown },
    { "layer_lock", "Layer is locked", wr_act_layer_lock, NULL, wr_is_layer_locked },
    { "layer_solo", "Show layer alone", wr_act_layer_solo, NULL, wr_is_solo },
    { "layer_raise", "Raise layer", wr_act_layer_raise, wr_can_raise, NULL },
    { "layer_lower", "Lower layer", wr_act_layer_lower, wr_can_merge, NULL },
    { "layer_above", "Layer above", wr_act_layer_above, wr_can_raise, NULL },
    { "layer_below", "Layer below", wr_act_layer_below, wr_can_merge, NULL },
    { "mask_selection", "Mask from selection", wr_act_mask_selection, wr_can_mask_selection, NULL },
    { "mask_white", "Mask that shows all", wr_act_mask_white, NULL, NULL },
    { "mask_black", "Mask that hides all", wr_act_mask_black, NULL, NULL },
    { "mask_none", "Remove mask", wr_act_mask_none, wr_can_mask_none, NULL },
    { "table_size", "New table...", table_size, NULL, NULL },
    { "offset_half", "Offset by half a cell", wr_act_offset_half, NULL, NULL },
    { "fill", "Fill...", fill, NULL, NULL },
    { "grid", "Grid...", grid, NULL, NULL },
    { "import", "Import heights...", import, NULL, NULL },
    { "zoom_in", "Zoom in", zoom_in, NULL, NULL },
    { "zoom_out", "Zoom out", zoom_out, NULL, NULL },
    { "zoom_100", "100 %", zoom_100, NULL, NULL },
    { "fit", "Fit the cell", fit, NULL, NULL },
    { "pan_left", "Look left", pan_left, NULL, NULL },
    { "pan_right", "Look right", pan_right, NULL, NULL },
    { "pan_up", "Look up", pan_up, NULL, NULL },
    { "pan_down", "Look down", pan_down, NULL, NULL },
    { "panels", "Panels", panels, NULL, panels_shown },
    { "view_both", "Table and patch", view_both, NULL, is_both },
    { "view_canvas", "Table alone", view_canvas, NULL, is_canvas },
    { "view_patch", "Patch alone", view_patch, NULL, is_patch },
    { "look_grey", "Grey", look_grey, NULL, is_grey },
    { "look_signed", "Blue below zero, orange above", look_signed, NULL, is_signed },
    { "range_auto", "Range follows the table", range_auto, NULL, is_auto },
    { "ants", "Selection's outline moves", ants, NULL, is_ants },
    { "turn", "Turning patch", turn, NULL, is_turning },
    { "camera_reset", "Reset the camera", camera_reset, NULL, NULL },
    { "pose_reset", "Reset the patch's pose", pose_reset, NULL, NULL },
    { "fullscreen", "Full screen", fullscreen, NULL, NULL },
    { "help", "Short guide", help, NULL, NULL },
    { "about", "About Wrinkle", about, NULL, NULL },
    { NULL, NULL, NULL, NULL, NULL }
};

const WrAction *wr_action_find(const char *name)
{
    for (const WrAction *a = wr_actions; a->name; a++)
        if (strcmp(a->name, name) == 0) return a;
    return NULL;
}

void wr_action_run(WrApp *app, const char *name)
{
    const WrAction *action = wr_action_find(name);
    const WrOpInfo *op = action ? NULL : wr_action_op(name);
    if (op) wr_dialog_adjust_open(app, op);
    if (!action || (action->enabled && !action->enabled(app))) return;
    if (app->in_frame) wr_later_action(app, name); /* it may take long */
    else action->run(app);
    wr_app_redraw(app);
}
