/* The one table of actions: menus, keys and buttons all go by it. */
#include "ui/app/actions.h"
#include "ui/accuracy/accuracy.h"
#include "ui/app/roster_list.h"
#include "ui/canvas/canvas.h"
#include "ui/canvas/view.h"
#include "ui/desk/action.h"
#include "ui/desk/busy.h"
#include "ui/desk/desk.h"
#include "ui/desk/dialog.h"
#include "ui/desk/document.h"
#include "ui/desk/hand.h"
#include "ui/desk/layout.h"
#include "ui/desk/line.h"
#include "ui/desk/roster.h"
#include "ui/desk/session_view.h"
#include "ui/desk/settings.h"
#include "ui/generate/generate_hand.h"
#include "ui/panels/panel_tablet.h"
#include "ui/patch/patch.h"
#include "ui/tools/shelf.h"
#include "ui/tools/stroke_hand.h"
#include "ui/tools/tool.h"

#include "base/text.h"
#include "base/vec.h"
#include "command/session.h"
#include "field/field.h"
#include "scene/scene.h"
#include "surface/surface.h"

#include <SDL.h>
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
    return wr_strokes_under_way(app) ||
           wr_session_history_position(app->session) > wr_session_history_oldest(app->session);
}

static bool can_redo(const WrApp *app)
{
    return wr_session_history_position(app->session) < wr_session_history_count(app->session);
}

static bool has_history(const WrApp *app)
{
    return wr_strokes_under_way(app) || wr_session_history_position(app->session) > 0;
}

static void search(WrApp *app)
{
    wr_dialog_open(app, WR_DIALOG_SEARCH);
}

/* ---- tools ---- */

static void choose_tool(WrApp *app, const char *name)
{
    wr_tool_choose(app, wr_tool_find(app, name));
}

#define TOOL(name)                                                                                 \
    static void tool_##name(WrApp *app)                                                            \
    {                                                                                              \
        choose_tool(app, #name);                                                                   \
    }
TOOL(brush)
TOOL(smooth)
TOOL(smear)
TOOL(clone)
TOOL(flood)
TOOL(ramp)
TOOL(shape_rect)
TOOL(shape_ellipse)
TOOL(shape_polygon)
TOOL(shape_path)
TOOL(stamp)
TOOL(pick)
TOOL(select_rect)
TOOL(select_ellipse)
TOOL(select_lasso)
TOOL(pan)
TOOL(zoom)
#undef TOOL

/* ---- table ---- */

static void table_size(WrApp *app)
{
    const WrField *field = wr_app_field(app);
    app->forms->width = wr_field_width(field);
    app->forms->height = wr_field_height(field);
    app->forms->wrap = (wr_field_wrap_u(field) == WR_WRAP_CLAMP ? 1 : 0) |
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
    const WrCanvasView *v = app->view;
    bool here = app->hand->on_canvas;
    wr_view_zoom_at(app->view, here ? app->hand->at.x : v->x + v->w / 2.0,
                    here ? app->hand->at.y : v->y + v->h / 2.0, v->zoom * factor);
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
    zoom_by(app, 1.0 / app->view->zoom);
}

static void fit(WrApp *app)
{
    wr_view_fit(app->view, 0.06);
}

static void pan_by(WrApp *app, double x, double y)
{
    wr_view_pan(app->view, x * app->view->w / 10.0, y * app->view->h / 10.0);
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
    app->settings->panels = !app->settings->panels;
}

static bool panels_shown(const WrApp *app)
{
    return app->settings->panels;
}

static void view_both(WrApp *app)
{
    app->settings->views = WR_VIEWS_BOTH;
}

static void view_canvas(WrApp *app)
{
    app->settings->views = WR_VIEWS_CANVAS;
}

static void view_patch(WrApp *app)
{
    app->settings->views = WR_VIEWS_PATCH;
}

static bool is_both(const WrApp *app)
{
    return app->settings->views == WR_VIEWS_BOTH;
}

static bool is_canvas(const WrApp *app)
{
    return app->settings->views == WR_VIEWS_CANVAS;
}

static bool is_patch(const WrApp *app)
{
    return app->settings->views == WR_VIEWS_PATCH;
}

static void look_grey(WrApp *app)
{
    app->settings->look.colours = WR_CANVAS_GREY;
}

static void look_signed(WrApp *app)
{
    app->settings->look.colours = WR_CANVAS_SIGNED;
}

static bool is_grey(const WrApp *app)
{
    return app->settings->look.colours == WR_CANVAS_GREY;
}

static bool is_signed(const WrApp *app)
{
    return app->settings->look.colours == WR_CANVAS_SIGNED;
}

static void range_auto(WrApp *app)
{
    app->settings->look.automatic = !app->settings->look.automatic;
}

static void range_unit(WrApp *app)
{
    WrCanvasLook *look = &app->settings->look;
    look->automatic = false;
    look->low = 0.0;
    look->high = 1.0;
}

static void range_marks(WrApp *app)
{
    app->settings->look.marks = !app->settings->look.marks;
}

static bool is_marks(const WrApp *app)
{
    return app->settings->look.marks;
}

static bool is_auto(const WrApp *app)
{
    return app->settings->look.automatic;
}

static void ants(WrApp *app)
{
    app->settings->ants = !app->settings->ants;
}

static bool is_ants(const WrApp *app)
{
    return app->settings->ants;
}

static void turn(WrApp *app)
{
    app->settings->turning = !app->settings->turning;
}

static bool is_turning(const WrApp *app)
{
    return app->settings->turning;
}

static void fullscreen(WrApp *app)
{
    bool full = (SDL_GetWindowFlags(app->window) & SDL_WINDOW_FULLSCREEN_DESKTOP) != 0;
    SDL_SetWindowFullscreen(app->window, full ? 0 : SDL_WINDOW_FULLSCREEN_DESKTOP);
}

static void view_back(WrApp *app)
{
    wr_app_settle(app);
    wr_app_run_line(app, "view back");
}

/* A zoom that is not a view yet can be gone back from too. */
static bool can_view_back(const WrApp *app)
{
    return wr_session_views_back(app->session) > 0 || app->patch->zoom_commit_at > 0.0;
}

static bool can_view_forward(const WrApp *app)
{
    return wr_session_views_forward(app->session) > 0;
}

static void view_forward(WrApp *app)
{
    wr_app_settle(app); /* which leaves none to go forward to */
    if (can_view_forward(app)) wr_app_run_line(app, "view forward");
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
    if (wr_app_run_line(app, wr_text_get(&line))) app->patch->turn_deg = 0.0;
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
    { "smooth", "Smooth", tool_smooth, NULL, NULL },
    { "smear", "Smear", tool_smear, NULL, NULL },
    { "clone", "Clone", tool_clone, NULL, NULL },
    { "flood", "Fill an area", tool_flood, NULL, NULL },
    { "ramp", "Ramp", tool_ramp, NULL, NULL },
    { "shape_rect", "Rectangle", tool_shape_rect, NULL, NULL },
    { "shape_ellipse", "Ellipse", tool_shape_ellipse, NULL, NULL },
    { "shape_polygon", "Polygon", tool_shape_polygon, NULL, NULL },
    { "shape_path", "Bezier path", tool_shape_path, NULL, NULL },
    { "stamp", "Stamp", tool_stamp, NULL, NULL },
    { "stamp_open", "Open a picture as a stamp...", wr_act_stamp_open, NULL, NULL },
    { "generate", "Generate", wr_generate_open_last, NULL, NULL },
    { "select_rect", "Rectangle selection", tool_select_rect, NULL, NULL },
    { "select_ellipse", "Ellipse selection", tool_select_ellipse, NULL, NULL },
    { "select_lasso", "Lasso selection", tool_select_lasso, NULL, NULL },
    { "pick", "Pick height", tool_pick, NULL, NULL },
    { "pan", "Move the table", tool_pan, NULL, NULL },
    { "zoom", "Zoom", tool_zoom, NULL, NULL },
    { "size_up", "Larger brush", wr_act_size_up, NULL, NULL },
    { "size_down", "Smaller brush", wr_act_size_down, NULL, NULL },
    { "hardness_up", "Harder brush", wr_act_hardness_up, NULL, NULL },
    { "hardness_down", "Softer brush", wr_act_hardness_down, NULL, NULL },
    { "strength_up", "Stronger brush", wr_act_strength_up, NULL, NULL },
    { "strength_down", "Weaker brush", wr_act_strength_down, NULL, NULL },
    { "swap_mode", "Swap raise and lower", wr_act_swap_mode, NULL, NULL },
    { "level_mode", "Paint to a height", wr_act_level_mode, NULL, NULL },
    { "height_up", "Raise the height that is painted to", wr_act_height_up, NULL, NULL },
    { "height_down", "Lower the height that is painted to", wr_act_height_down, NULL, NULL },
    { "erase_mode", "Erase", wr_act_erase_mode, NULL, wr_is_erase_mode },
    { "reset_values", "Reset the brush's values", wr_act_reset_values, NULL, NULL },
    { "brushes", "Brushes", wr_act_brushes, NULL, NULL },
    { "round_brush", "Round brush", wr_act_round_brush, NULL, wr_is_round_brush },
    { "preset_last", "Brush used before", wr_shelf_last, NULL, NULL },
    { "preset_next", "Next favourite brush", wr_act_preset_next, NULL, NULL },
    { "preset_previous", "Favourite brush before", wr_act_preset_previous, NULL, NULL },
    { "favourite", "Brush is a favourite", wr_act_favourite, NULL, wr_is_favourite },
    { "preset_save", "Save brush as a preset...", wr_act_preset_save, NULL, NULL },
    { "lock_size", "Keep the size when brushes change", wr_act_lock_size, NULL, wr_is_lock_size },
    { "symmetry", "Symmetry...", wr_act_symmetry, NULL, wr_is_symmetry },
    { "symmetry_on", "Symmetry is on", wr_act_symmetry_on, NULL, wr_is_symmetry_on },
    { "keys_paint", "Keys for painters: Ctrl picks, Shift sizes", wr_act_keys_paint, NULL,
      wr_is_keys_paint },
    { "keys_sculpt", "Keys for sculptors: Ctrl inverts, Shift smooths", wr_act_keys_sculpt, NULL,
      wr_is_keys_sculpt },
    { "straight_line", "Straight lines", wr_act_straight_line, NULL, wr_is_straight_line },
    { "paint_patch", "Paint on the patch", wr_act_paint_patch, NULL, wr_is_painting_patch },
    { "pressure_up", "Press the mouse harder", wr_act_pressure_up, NULL, NULL },
    { "pressure_down", "Press the mouse less", wr_act_pressure_down, NULL, NULL },
    { "pressure_speed", "Mouse presses by its speed", wr_act_pressure_speed, NULL,
      wr_is_pressure_speed },
    { "steady_off", "Hand as it is", wr_act_steady_off, NULL, wr_is_steady_off },
    { "steady_smooth", "Smoothed hand", wr_act_steady_smooth, NULL, wr_is_steady_smooth },
    { "steady_string", "Brush on a string", wr_act_steady_string, NULL, wr_is_steady_string },
    { "steady_catch_up", "Strokes end at the pointer", wr_act_steady_catch_up, NULL,
      wr_is_steady_catch_up },
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
    { "range_unit", "Range from 0 to 1", range_unit, NULL, NULL },
    { "range_marks", "Mark what lies beyond the range", range_marks, NULL, is_marks },
    { "ants", "Selection's outline moves", ants, NULL, is_ants },
    { "accuracy", "Accuracy", wr_act_accuracy, NULL, wr_is_accuracy },
    { "accuracy_measure", "Measure what accuracy costs", wr_act_accuracy_measure, NULL, NULL },
    { "inspector", "Inspector", wr_act_inspector, NULL, wr_is_inspector },
    { "inspector_pin", "Pin the inspector", wr_act_inspector_pin, NULL, wr_is_inspector_pinned },
    { "inspector_copy", "Copy what the inspector shows", wr_act_inspector_copy, NULL, NULL },
    { "hard_cases", "Hard cases...", wr_dialog_cases_open, NULL, NULL },
    { "look_plain", "Patch as it is", wr_act_look_plain, NULL, wr_is_look_plain },
    { "look_split", "Compare A and B, split", wr_act_look_split, NULL, wr_is_look_split },
    { "look_flicker", "Compare A and B, flickering", wr_act_look_flicker, NULL,
      wr_is_look_flicker },
    { "compare_hold", "Show B while held", wr_act_compare_hold, NULL, wr_is_compare_hold },
    { "compare_take", "B takes A's dials", wr_act_compare_take, NULL, NULL },
    { "compare_swap", "Swap A and B", wr_act_compare_swap, NULL, NULL },
    { "look_error", "Map of the error", wr_act_look_error, NULL, wr_is_look_error },
    { "look_dropped", "Map of the dropped term", wr_act_look_dropped, NULL, wr_is_look_dropped },
    { "look_tilt", "Map of the tilt", wr_act_look_tilt, NULL, wr_is_look_tilt },
    { "look_level", "Map of the mip level", wr_act_look_level, NULL, wr_is_look_level },
    { "turn", "Turning patch", turn, NULL, is_turning },
    { "view_back", "Patch as it was looked at before", view_back, can_view_back, NULL },
    { "view_forward", "Patch as it was looked at after", view_forward, can_view_forward, NULL },
    { "camera_reset", "Reset the camera", camera_reset, NULL, NULL },
    { "pose_reset", "Reset the patch's pose", pose_reset, NULL, NULL },
    { "fullscreen", "Full screen", fullscreen, NULL, NULL },
    { "tablet", "Tablet tester...", wr_dialog_tablet_open, NULL, NULL },
    { "help", "Guide", help, NULL, NULL },
    { "about", "About Wrinkle", about, NULL, NULL },
    { NULL, NULL, NULL, NULL, NULL }
};
