/* The table of actions, used by menus, keys and buttons. */
#include "ui/app/actions.h"
#include "ui/app/actions_display.h"
#include "ui/panels/panel_history.h"
#include "ui/app/actions_panels.h"
#include "ui/panels/accuracy/accuracy.h"
#include "ui/app/registry_list.h"
#include "ui/canvas/canvas.h"
#include "ui/canvas/view.h"
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/document.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/line.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/panels/panel_search.h"
#include "ui/panels/panel_tablet.h"
#include "ui/panels/panels.h"
#include "ui/patch/patch.h"
#include "ui/patch/patch_paint.h"
#include "ui/patch/patch_projection.h"
#include "ui/canvas/tools/preset_browser.h"
#include "ui/canvas/tools/stroke_input.h"
#include "ui/canvas/tools/tool.h"

#include "base/enum_rows.h"
#include "base/text.h"
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

static bool can_undo(const WrApp *app)
{
    return wr_strokes_under_way(app) || wr_session_undo_count(app->session) > 0;
}

static bool can_redo(const WrApp *app)
{
    return wr_session_redo_count(app->session) > 0;
}

/* A drag that this ends may have made a step: then there is nothing to redo. */
static void redo(WrApp *app)
{
    wr_app_settle(app);
    if (can_redo(app)) wr_app_run_line(app, "redo");
}

static bool has_history(const WrApp *app)
{
    return wr_strokes_under_way(app) || wr_session_history_position(app->session) > 0;
}

/* ---- dialogs ---- */

#define DIALOG(name, dialog)                                                                       \
    static void name(WrApp *app)                                                                   \
    {                                                                                              \
        wr_dialog_open(app, dialog);                                                               \
    }
DIALOG(starters, WR_DIALOG_STARTERS)
DIALOG(preferences, WR_DIALOG_PREFERENCES)
DIALOG(fill, WR_DIALOG_FILL)
DIALOG(grid, WR_DIALOG_GRID)
DIALOG(import, WR_DIALOG_IMPORT)
DIALOG(export, WR_DIALOG_EXPORT)
DIALOG(maps, WR_DIALOG_SHEET)
DIALOG(bake, WR_DIALOG_BAKE)
DIALOG(render, WR_DIALOG_RENDER)
DIALOG(film, WR_DIALOG_FILM)
DIALOG(help, WR_DIALOG_HELP)
DIALOG(about, WR_DIALOG_ABOUT)
DIALOG(tour, WR_DIALOG_TOUR)
#undef DIALOG

/* ---- tools ---- */

#define TOOL(name)                                                                                 \
    static void tool_##name(WrApp *app)                                                            \
    {                                                                                              \
        wr_tool_choose(app, wr_tool_find(app, WR_ACT(name)));                                      \
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
TOOL(transform)
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

static void mirror_view(WrApp *app)
{
    app->view->mirrored = !app->view->mirrored;
    wr_app_redraw(app);
}

static bool is_mirrored(const WrApp *app)
{
    return app->view->mirrored;
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

static void range_auto(WrApp *app)
{
    bool *automatic = app->settings->look.automatic;
    const bool both = automatic[0] && automatic[1];
    for (int k = 0; k < 2; k++) automatic[k] = !both;
}

static void range_unit(WrApp *app)
{
    WrCanvasDisplay *look = &app->settings->look;
    look->automatic[0] = look->automatic[1] = false;
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
    return app->settings->look.automatic[0] && app->settings->look.automatic[1];
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

static void save(WrApp *app)
{
    wr_app_save(app);
}

#define ROW(name, ...) [WR_ROW(WR_ACTION_##name)] = { #name, __VA_ARGS__ }
#define EDIT(name, ...)                                                                            \
    [WR_ROW(WR_ACTION_##name)] = { #name, __VA_ARGS__, .edits = true, .layer = WR_ACTION_ANY_LAYER }
#define LAYER(name, ...)                                                                           \
    [WR_ROW(WR_ACTION_##name)] = { #name, __VA_ARGS__, .edits = true, .layer = WR_ACTION_UNLOCKED }
#define PAINT(name, ...)                                                                           \
    [WR_ROW(WR_ACTION_##name)] = { #name, __VA_ARGS__, .edits = true, .layer = WR_ACTION_PAINTABLE }
WR_ROWS(wr_actions);
const WrAction wr_actions[] = {
    EDIT(new, "New", wr_app_new_document, NULL, NULL),
    EDIT(starters, "New from a starter...", starters, NULL, NULL),
    EDIT(open, "Open...", wr_app_open, NULL, NULL),
    EDIT(save, "Save", save, NULL, NULL),
    EDIT(save_as, "Save as...", wr_app_save_as, NULL, NULL),
    EDIT(export, "Export...", export, NULL, NULL),
    EDIT(maps, "Export maps...", maps, NULL, NULL),
    EDIT(render, "Render a picture...", render, NULL, NULL),
    EDIT(film, "Save a turntable as a film...", film, NULL, NULL),
    EDIT(save_history, "Save history as script...", wr_app_save_history, has_history, NULL),
    ROW(quit, "Quit", wr_app_quit, NULL, NULL),
    EDIT(run_macro, "Run a macro...", wr_macro_open, NULL, NULL),
    EDIT(undo, "Undo", undo, can_undo, NULL, .waits = true),
    EDIT(redo, "Redo", redo, can_redo, NULL, .waits = true),
    LAYER(cut, "Cut", wr_act_cut, wr_has_heights, NULL),
    ROW(copy, "Copy", wr_act_copy, NULL, NULL),
    ROW(copy_shown, "Copy the visible result", wr_act_copy_shown, NULL, NULL),
    EDIT(paste, "Paste", wr_act_paste, NULL, NULL),
    ROW(search, "Search...", wr_search_open, NULL, NULL),
    ROW(preferences, "Preferences...", preferences, NULL, NULL),
    ROW(brush, "Brush", tool_brush, NULL, NULL),
    ROW(smooth, "Smooth", tool_smooth, NULL, NULL),
    ROW(smear, "Smear", tool_smear, NULL, NULL),
    ROW(clone, "Clone", tool_clone, NULL, NULL),
    ROW(flood, "Fill an area", tool_flood, NULL, NULL),
    ROW(ramp, "Ramp", tool_ramp, NULL, NULL),
    ROW(shape_rect, "Rectangle", tool_shape_rect, NULL, NULL),
    ROW(shape_ellipse, "Ellipse", tool_shape_ellipse, NULL, NULL),
    ROW(shape_polygon, "Polygon", tool_shape_polygon, NULL, NULL),
    ROW(shape_path, "Bezier path", tool_shape_path, NULL, NULL),
    ROW(stamp, "Stamp", tool_stamp, NULL, NULL),
    ROW(stamp_open, "Open a picture as a stamp...", wr_act_stamp_open, NULL, NULL),
    ROW(generate, "Generate", wr_generate_open_last, NULL, NULL),
    ROW(select_rect, "Rectangle selection", tool_select_rect, NULL, NULL),
    ROW(select_ellipse, "Ellipse selection", tool_select_ellipse, NULL, NULL),
    ROW(select_lasso, "Lasso selection", tool_select_lasso, NULL, NULL),
    ROW(transform, "Free transform", tool_transform, NULL, NULL),
    ROW(pick, "Pick height", tool_pick, NULL, NULL),
    ROW(pan, "Move the table", tool_pan, NULL, NULL),
    ROW(zoom, "Zoom", tool_zoom, NULL, NULL),
    ROW(size_up, "Larger brush", wr_act_size_up, NULL, NULL),
    ROW(size_down, "Smaller brush", wr_act_size_down, NULL, NULL),
    ROW(hardness_up, "Harder brush", wr_act_hardness_up, NULL, NULL),
    ROW(hardness_down, "Softer brush", wr_act_hardness_down, NULL, NULL),
    ROW(strength_up, "Stronger brush", wr_act_strength_up, NULL, NULL),
    ROW(strength_down, "Weaker brush", wr_act_strength_down, NULL, NULL),
    ROW(swap_mode, "Swap raise and lower", wr_act_swap_mode, NULL, NULL),
    ROW(level_mode, "Paint to a height", wr_act_level_mode, NULL, NULL),
    ROW(height_up, "Raise the target height", wr_act_target_height_up, NULL, NULL),
    ROW(height_down, "Lower the target height", wr_act_target_height_down, NULL, NULL),
    ROW(erase_mode, "Erase", wr_act_erase_mode, NULL, wr_is_erase_mode),
    ROW(reset_values, "Reset the brush's values", wr_act_reset_values, NULL, NULL),
    ROW(brushes, "Brushes", wr_act_brushes, NULL, NULL),
    ROW(round_brush, "Round brush", wr_act_round_brush, NULL, wr_is_round_brush),
    ROW(preset_last, "Brush used before", wr_preset_browser_last, NULL, NULL),
    ROW(preset_next, "Next favourite brush", wr_act_preset_next, NULL, NULL),
    ROW(preset_previous, "Favourite brush before", wr_act_preset_previous, NULL, NULL),
    ROW(favourite, "Brush is a favourite", wr_act_favourite, NULL, wr_is_favourite),
    ROW(brush_curves, "Curves of the brush...", wr_act_brush_curves, NULL, NULL),
    ROW(preset_save, "Save brush as a preset...", wr_act_preset_save, NULL, NULL),
    ROW(lock_size, "Keep the size when brushes change", wr_act_lock_size, NULL, wr_is_lock_size),
    ROW(symmetry, "Symmetry...", wr_act_symmetry, NULL, wr_is_symmetry),
    ROW(symmetry_on, "Symmetry is on", wr_act_symmetry_toggle, NULL, wr_is_symmetry_on),
    ROW(keys_paint, "Keys for painters: Ctrl picks, Shift sizes", wr_act_keys_paint, NULL,
        wr_is_keys_paint),
    ROW(keys_sculpt, "Keys for sculptors: Ctrl inverts, Shift smooths", wr_act_keys_sculpt, NULL,
        wr_is_keys_sculpt),
    ROW(straight_line, "Straight lines", wr_act_straight_line, NULL, wr_is_straight_line),
    ROW(paint_patch, "Paint on the patch", wr_act_paint_patch, NULL, wr_is_painting_patch),
    ROW(paint_round, "Paint faces turned away too", wr_act_paint_round, NULL, wr_is_painting_round),
    ROW(projection_handle, "Projection handle", wr_act_projection_handle, wr_can_project,
        wr_is_projecting),
    ROW(pressure_up, "Press the mouse harder", wr_act_pressure_up, NULL, NULL),
    ROW(pressure_down, "Press the mouse less", wr_act_pressure_down, NULL, NULL),
    ROW(pressure_speed, "Mouse pressure from speed", wr_act_pressure_speed, NULL,
        wr_is_pressure_speed),
    ROW(steady_off, "Stabilizer off", wr_act_steady_off, NULL, wr_is_steady_off),
    ROW(steady_smooth, "Stabilizer: smoothed", wr_act_steady_smooth, NULL, wr_is_steady_smooth),
    ROW(steady_string, "Stabilizer: pulled string", wr_act_steady_string, NULL,
        wr_is_steady_string),
    ROW(steady_catch_up, "Strokes end at the pointer", wr_act_steady_catch_up, NULL,
        wr_is_steady_catch_up),
    EDIT(select_all, "Select all", wr_act_select_all, NULL, NULL),
    EDIT(select_none, "Select none", wr_act_select_none, wr_can_mask_selection, NULL),
    EDIT(select_invert, "Invert selection", wr_act_select_invert, NULL, NULL),
    EDIT(select_grow, "Grow selection...", wr_act_select_grow, wr_can_mask_selection, NULL),
    EDIT(select_shrink, "Shrink selection...", wr_act_select_shrink, wr_can_mask_selection, NULL),
    EDIT(select_feather, "Feather selection...", wr_act_select_feather, wr_can_mask_selection,
         NULL),
    EDIT(select_height, "Select by height...", wr_act_select_height, NULL, NULL),
    EDIT(select_slope, "Select by slope...", wr_act_select_slope, NULL, NULL),
    EDIT(select_mask, "Select by the mask", wr_act_select_mask, wr_has_mask, NULL, .row_menu = 4),
    EDIT(layer_add, "New layer", wr_act_layer_add, NULL, NULL),
    EDIT(layer_duplicate, "Duplicate layer", wr_act_layer_duplicate, NULL, NULL, .row_menu = 1,
         .several = "Duplicate %d layers"),
    EDIT(layer_link, "Linked copy", wr_act_layer_link, wr_can_link, NULL, .row_menu = 1),
    LAYER(layer_delete, "Delete layer", wr_act_layer_delete, wr_can_delete, NULL, .row_menu = 1,
          .several = "Delete %d layers"),
    EDIT(layer_rename, "Rename layer", wr_act_layer_rename, NULL, NULL, .row_menu = 1),
    EDIT(filter_edit, "Edit filter or generator...", wr_act_filter_edit, wr_has_values, NULL,
         .row_menu = 1),
    LAYER(layer_rasterize, "Rasterize layer", wr_act_layer_rasterize, wr_can_rasterize, NULL,
          .row_menu = 1),
    EDIT(layer_group, "Group layers", wr_act_layer_group, NULL, NULL, .row_menu = 1,
         .several = "Group %d layers"),
    LAYER(layer_ungroup, "Ungroup layers", wr_act_layer_ungroup, wr_can_ungroup, NULL,
          .row_menu = 1),
    LAYER(layer_merge, "Merge layer down", wr_act_layer_merge, wr_can_merge, NULL, .row_menu = 2,
          .several = "Merge %d layers"),
    EDIT(layer_flatten, "Flatten all layers", wr_act_layer_flatten, wr_can_flatten, NULL,
         .row_menu = 2),
    EDIT(layer_project, "Project layer onto the mesh", wr_patch_project_layer, wr_app_can_bake,
         NULL),
    LAYER(layer_clear, "Clear layer", wr_act_layer_clear, wr_can_clear, NULL, .row_menu = 2),
    ROW(layer_show, "Layer is shown", wr_act_layer_show, NULL, wr_is_layer_shown),
    ROW(layer_lock, "Layer is locked", wr_act_layer_lock, NULL, wr_is_layer_locked),
    ROW(layer_solo, "Show layer alone", wr_act_layer_solo, NULL, wr_is_solo, .row_menu = 2),
    EDIT(layer_raise, "Raise layer", wr_act_layer_raise, wr_can_raise, NULL,
         .several = "Raise %d layers"),
    EDIT(layer_lower, "Lower layer", wr_act_layer_lower, wr_can_lower, NULL,
         .several = "Lower %d layers"),
    ROW(layer_above, "Layer above", wr_act_layer_above, wr_has_above, NULL),
    ROW(layer_below, "Layer below", wr_act_layer_below, wr_has_below, NULL),
    ROW(layer_choose_all, "Choose all layers", wr_act_layer_choose_all, wr_can_several_layers,
        NULL),
    EDIT(variant_add, "New variant...", wr_act_variant_add, NULL, NULL),
    EDIT(variant_set, "Update variant", wr_act_variant_set, wr_is_variant_changed, NULL),
    EDIT(variant_rename, "Rename variant...", wr_act_variant_rename, wr_is_variant, NULL),
    EDIT(variant_delete, "Delete variant", wr_act_variant_delete, wr_is_variant, NULL),
    LAYER(mask_selection, "Mask from selection", wr_act_mask_selection, wr_can_mask_selection, NULL,
          .row_menu = 3),
    LAYER(mask_white, "Mask that shows all", wr_act_mask_white, NULL, NULL, .row_menu = 3),
    LAYER(mask_black, "Mask that hides all", wr_act_mask_black, NULL, NULL, .row_menu = 3),
    LAYER(mask_height, "Mask by height...", wr_act_mask_height, NULL, NULL, .row_menu = 3),
    LAYER(mask_slope, "Mask by slope...", wr_act_mask_slope, NULL, NULL, .row_menu = 3),
    LAYER(mask_live, "Live mask...", wr_act_mask_live, wr_can_mask_live, NULL, .row_menu = 3),
    LAYER(mask_invert, "Invert mask", wr_act_mask_invert, wr_has_mask, NULL, .row_menu = 3),
    LAYER(mask_none, "Remove mask", wr_act_mask_none, wr_has_mask, NULL, .row_menu = 3),
    ROW(mask_edit, "Paint on the mask", wr_act_mask_edit, wr_has_mask, wr_is_mask_edited,
        .row_menu = 4),
    ROW(mask_alone, "Show the mask alone", wr_act_mask_alone, wr_has_mask, wr_app_shows_mask,
        .row_menu = 4),
    EDIT(table_size, "New table...", table_size, NULL, NULL),
    EDIT(offset_half, "Offset by half a cell", wr_act_offset_half, wr_can_change_all, NULL),
    PAINT(fill, "Fill...", fill, NULL, NULL),
    PAINT(grid, "Grid...", grid, NULL, NULL),
    EDIT(import, "Import heights...", import, NULL, NULL),
    EDIT(mesh, "Import mesh...", wr_app_choose_mesh, NULL, NULL),
    EDIT(gltf, "Materials of a glTF...", wr_app_choose_gltf, NULL, NULL),
    EDIT(bake, "Bake a detailed mesh...", bake, wr_app_can_bake, NULL),
    ROW(zoom_in, "Zoom in", zoom_in, NULL, NULL),
    ROW(zoom_out, "Zoom out", zoom_out, NULL, NULL),
    ROW(zoom_100, "100 %", zoom_100, NULL, NULL),
    ROW(fit, "Fit the cell", fit, NULL, NULL),
    ROW(mirror_view, "Mirror the view", mirror_view, NULL, is_mirrored),
    ROW(turn_left, "Turn the table left", wr_act_turn_left, NULL, NULL),
    ROW(turn_right, "Turn the table right", wr_act_turn_right, NULL, NULL),
    ROW(turn_none, "Table upright", wr_act_turn_none, wr_is_turned, NULL),
    ROW(tiling_straight, "Copies in rows and columns", wr_act_tiling_straight, NULL,
        wr_is_tiling_straight),
    ROW(tiling_half_drop, "Copies in a half-drop", wr_act_tiling_half_drop, NULL,
        wr_is_tiling_half_drop),
    ROW(tiling_brick, "Copies like bricks", wr_act_tiling_brick, NULL, wr_is_tiling_brick),
    ROW(pan_left, "Look left", pan_left, NULL, NULL),
    ROW(pan_right, "Look right", pan_right, NULL, NULL),
    ROW(pan_up, "Look up", pan_up, NULL, NULL),
    ROW(pan_down, "Look down", pan_down, NULL, NULL),
    ROW(panels, "Panels", panels, NULL, panels_shown),
    ROW(side_left, "Panels on the left", wr_act_side_left, NULL, wr_is_side_left),
    ROW(hide_strip, "Hide the tool strip", wr_act_hide_strip, NULL, wr_is_hide_strip),
    ROW(hide_options, "Hide the option row", wr_act_hide_options, NULL, wr_is_hide_options),
    ROW(meters, "Times and memory in the status line", wr_act_meters, NULL, wr_is_meters),
    ROW(tab_float, "Float the tab", wr_act_tab_float, NULL, NULL),
    ROW(dock_all, "Dock all tabs", wr_act_dock_all, NULL, NULL),
    ROW(workspace_paint, "Workspace Paint", wr_act_workspace_paint, NULL, wr_is_workspace_paint),
    ROW(workspace_generate, "Workspace Generate", wr_act_workspace_generate, NULL,
        wr_is_workspace_generate),
    ROW(workspace_light, "Workspace Lighting", wr_act_workspace_light, NULL, wr_is_workspace_light),
    ROW(workspace_export, "Workspace Export", wr_act_workspace_export, NULL,
        wr_is_workspace_export),
    ROW(workspace_study, "Workspace Study", wr_act_workspace_study, NULL, wr_is_workspace_study),
    ROW(workspace_reset, "Reset the workspace", wr_act_workspace_reset, NULL, NULL),
    ROW(part_next, "Keys: next part of the window", wr_act_part_next, NULL, NULL),
    ROW(part_back, "Keys: previous part of the window", wr_act_part_back, NULL, NULL),
    ROW(menus, "Keys to the menus", wr_act_menus, NULL, NULL),
    ROW(view_both, "Table and patch", wr_act_view_both, NULL, wr_is_both),
    ROW(view_canvas, "Table alone", wr_act_view_canvas, NULL, wr_is_canvas),
    ROW(view_patch, "Patch alone", wr_act_view_patch, NULL, wr_is_patch),
    ROW(look_grey, "Grey", wr_act_display_grey, NULL, wr_is_grey),
    ROW(look_signed, "Blue below zero, orange above", wr_act_display_signed, NULL, wr_is_signed),
    ROW(look_contours, "Contour lines", wr_act_display_contours, NULL, wr_is_contours),
    ROW(look_relief, "Relief, lit", wr_act_display_relief, NULL, wr_is_relief),
    ROW(look_normals, "Normals of the table", wr_act_display_normals, NULL,
        wr_canvas_shows_normals),
    ROW(look_occlusion, "Occlusion of the table", wr_act_display_occlusion, NULL, wr_is_occlusion),
    ROW(look_curvature, "Curvature: grooves blue, ridges orange", wr_act_display_curvature, NULL,
        wr_is_curvature),
    ROW(look_cavity, "Cavity", wr_act_display_cavity, NULL, wr_is_cavity),
    ROW(look_slope, "Steepness", wr_act_display_slope, NULL, wr_is_slope),
    ROW(look_roughness, "Roughness", wr_act_display_roughness, NULL, wr_is_roughness),
    ROW(theme_dark, "Dark colours of the window", wr_act_theme_dark, NULL, wr_is_theme_dark),
    ROW(theme_light, "Light colours of the window", wr_act_theme_light, NULL, wr_is_theme_light),
    ROW(theme_contrast, "High contrast", wr_act_theme_contrast, NULL, wr_is_theme_contrast),
    ROW(range_auto, "Range follows the table", range_auto, NULL, is_auto),
    ROW(range_unit, "Range from 0 to 1", range_unit, NULL, NULL),
    ROW(range_marks, "Mark heights beyond the range", range_marks, NULL, is_marks),
    ROW(view_grid, "Grid over the table", wr_act_grid, NULL, wr_is_grid),
    ROW(grid_finer, "Finer grid", wr_act_grid_finer, NULL, NULL),
    ROW(grid_coarser, "Coarser grid", wr_act_grid_coarser, NULL, NULL),
    ROW(ants, "Selection's outline moves", ants, NULL, is_ants),
    ROW(accuracy, "Accuracy", wr_act_accuracy, NULL, wr_is_accuracy),
    ROW(accuracy_measure, "Measure the cost of accuracy", wr_act_accuracy_measure, NULL, NULL),
    ROW(study, "Tour: cost of accuracy", wr_act_study, NULL, wr_is_study),
    ROW(inspector, "Inspector", wr_act_inspector, NULL, wr_is_inspector),
    ROW(inspector_pin, "Pin the inspector", wr_act_inspector_pin, NULL, wr_is_inspector_pinned),
    ROW(inspector_copy, "Copy the inspector's values", wr_act_inspector_copy, NULL, NULL),
    ROW(hard_cases, "Hard cases...", wr_dialog_cases_open, NULL, NULL),
    ROW(look_plain, "Patch as it is", wr_act_display_plain, NULL, wr_is_display_plain),
    ROW(look_split, "Compare A and B, split", wr_act_display_split, NULL, wr_is_display_split),
    ROW(look_flicker, "Compare A and B, flickering", wr_act_display_flicker, NULL,
        wr_is_display_flicker),
    ROW(compare_hold, "Show B while held", wr_act_compare_hold, NULL, wr_is_compare_hold),
    ROW(compare_take, "Copy A's dials to B", wr_act_compare_take, NULL, NULL),
    EDIT(compare_swap, "Swap A and B", wr_act_compare_swap, NULL, NULL),
    ROW(look_error, "Map of the error", wr_act_display_error, NULL, wr_is_display_error),
    ROW(look_dropped, "Map of the dropped term", wr_act_display_dropped, NULL,
        wr_is_display_dropped),
    ROW(look_height, "Heights on the patch", wr_act_display_height, NULL, wr_is_display_height),
    ROW(look_normal, "Normals on the patch", wr_act_display_normal, NULL, wr_is_display_normal),
    ROW(look_tilt, "Slope of the bump on the patch", wr_act_display_tilt, NULL, wr_is_display_tilt),
    ROW(look_level, "Map of the mip level", wr_act_display_level, NULL, wr_is_display_level),
    ROW(look_ran, "Map of effects that ran", wr_act_display_ran, NULL, wr_is_display_ran),
    ROW(turn, "Turning patch", turn, NULL, is_turning),
    EDIT(view_back, "Previous view of the patch", wr_act_view_back, wr_can_view_back, NULL),
    EDIT(view_forward, "Next view of the patch", wr_act_view_forward, wr_can_view_forward, NULL),
    EDIT(camera_reset, "Reset the camera", wr_act_camera_reset, NULL, NULL),
    EDIT(pose_reset, "Reset the patch's pose", wr_act_pose_reset, NULL, NULL),
    EDIT(camera_fill, "Fill the picture", wr_act_camera_fill, NULL, NULL),
    EDIT(camera_kind, "Perspective", wr_act_camera_kind, NULL, wr_is_perspective),
    EDIT(from_front, "From the front", wr_act_view_from_front, NULL, NULL),
    EDIT(from_back, "From the back", wr_act_view_from_back, NULL, NULL),
    EDIT(from_left, "From the left", wr_act_view_from_left, NULL, NULL),
    EDIT(from_right, "From the right", wr_act_view_from_right, NULL, NULL),
    EDIT(from_top, "From above", wr_act_view_from_top, NULL, NULL),
    EDIT(from_bottom, "From below", wr_act_view_from_bottom, NULL, NULL),
    EDIT(orbit_left, "Camera to the left", wr_act_orbit_left, NULL, NULL),
    EDIT(orbit_right, "Camera to the right", wr_act_orbit_right, NULL, NULL),
    EDIT(orbit_up, "Camera up", wr_act_orbit_up, NULL, NULL),
    EDIT(orbit_down, "Camera down", wr_act_orbit_down, NULL, NULL),
    EDIT(view_keep, "Keep this view", wr_act_view_keep, NULL, NULL),
    EDIT(ground, "Ground", wr_act_ground, NULL, wr_is_ground),
    ROW(fullscreen, "Full screen", fullscreen, NULL, NULL),
    ROW(tablet, "Tablet tester...", wr_dialog_tablet_open, NULL, NULL),
    ROW(help, "Guide", help, NULL, NULL),
    ROW(tour, "Tour of the window", tour, NULL, NULL),
    ROW(about, "About Wrinkle", about, NULL, NULL),
    [WR_ACTION_COUNT] = { NULL }
};
WR_ROWS_END(wr_actions, WR_ACTION_COUNT);
#undef ROW
#undef EDIT
#undef LAYER
#undef PAINT
