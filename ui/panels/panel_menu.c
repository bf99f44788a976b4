#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/document.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/app/state/workspace.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/gui_rows.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/panels/layer_choice.h"
#include "ui/panels/panels.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/enum_rows.h"
#include "field/ops.h"
#include "generate/generator.h"

#include <stdio.h>
#include <string.h>

#define FIND_UNITS 190 /* width of the search button */

/* Names of actions; "-" is a separator, ">LABEL" a menu of submenus[]; "recent", "scale", "operations" and "filters" are
   generated below. No menu is longer than about 14 rows. */
static const char *const file_menu[] = { WR_ACT(new),
                                         WR_ACT(starters),
                                         WR_ACT(open),
                                         "recent",
                                         "-",
                                         WR_ACT(save),
                                         WR_ACT(save_as),
                                         WR_ACT(save_history),
                                         "-",
                                         WR_ACT(import),
                                         WR_ACT(mesh),
                                         WR_ACT(gltf),
                                         WR_ACT(bake),
                                         WR_ACT(export),
                                         WR_ACT(maps),
                                         WR_ACT(render),
                                         WR_ACT(film),
                                         "-",
                                         WR_ACT(quit),
                                         NULL };
static const char *const edit_menu[] = {
    WR_ACT(undo),       WR_ACT(redo),        WR_ACT(run_macro),   "-", WR_ACT(cut),    WR_ACT(copy),
    WR_ACT(copy_shown), WR_ACT(paste),       WR_ACT(transform),   "-", WR_ACT(search), "-",
    WR_ACT(keys_paint), WR_ACT(keys_sculpt), WR_ACT(preferences), NULL
};
static const char *const brush_menu[] = { WR_ACT(brushes),
                                          WR_ACT(round_brush),
                                          ">Presets",
                                          "-",
                                          ">Size and strength",
                                          ">Mode and height",
                                          "-",
                                          ">Stabilizer",
                                          ">Pen pressure",
                                          "-",
                                          WR_ACT(symmetry),
                                          WR_ACT(symmetry_on),
                                          NULL };
static const char *const brush_presets[] = { WR_ACT(preset_last),
                                             WR_ACT(preset_next),
                                             WR_ACT(preset_previous),
                                             WR_ACT(favourite),
                                             "-",
                                             WR_ACT(brush_curves),
                                             WR_ACT(preset_save),
                                             NULL };
static const char *const brush_values[] = { WR_ACT(size_up),
                                            WR_ACT(size_down),
                                            WR_ACT(lock_size),
                                            "-",
                                            WR_ACT(hardness_up),
                                            WR_ACT(hardness_down),
                                            "-",
                                            WR_ACT(strength_up),
                                            WR_ACT(strength_down),
                                            "-",
                                            WR_ACT(reset_values),
                                            NULL };
static const char *const brush_modes[] = { WR_ACT(swap_mode),
                                           WR_ACT(erase_mode),
                                           WR_ACT(level_mode),
                                           "-",
                                           WR_ACT(height_up),
                                           WR_ACT(height_down),
                                           NULL };
static const char *const brush_steady[] = { WR_ACT(steady_off), WR_ACT(steady_smooth),
                                            WR_ACT(steady_string), WR_ACT(steady_catch_up), NULL };
static const char *const brush_pressure[] = { WR_ACT(pressure_up), WR_ACT(pressure_down),
                                              WR_ACT(pressure_speed), NULL };
static const char *const tool_menu[] = { WR_ACT(brush), WR_ACT(smooth),        WR_ACT(smear),
                                         WR_ACT(clone), WR_ACT(straight_line), ">On the patch",
                                         "-",           WR_ACT(flood),         WR_ACT(ramp),
                                         ">Shapes",     WR_ACT(stamp),         WR_ACT(stamp_open),
                                         "-",           ">Selection",          WR_ACT(transform),
                                         WR_ACT(pick),  WR_ACT(pan),           WR_ACT(zoom),
                                         NULL };
static const char *const tool_patch[] = { WR_ACT(paint_patch), WR_ACT(paint_round),
                                          WR_ACT(projection_handle), NULL };
static const char *const tool_shapes[] = { WR_ACT(shape_rect), WR_ACT(shape_ellipse),
                                           WR_ACT(shape_polygon), WR_ACT(shape_path), NULL };
static const char *const tool_selection[] = { WR_ACT(select_rect), WR_ACT(select_ellipse),
                                              WR_ACT(select_lasso), NULL };
static const char *const layer_menu[] = { WR_ACT(layer_add),
                                          "filters",
                                          WR_ACT(layer_duplicate),
                                          WR_ACT(layer_link),
                                          WR_ACT(layer_delete),
                                          "-",
                                          WR_ACT(layer_rename),
                                          WR_ACT(filter_edit),
                                          WR_ACT(layer_rasterize),
                                          "-",
                                          ">Order and groups",
                                          ">Visibility",
                                          ">Mask",
                                          ">Variants",
                                          ">Merge",
                                          NULL };
static const char *const layer_order[] = { WR_ACT(layer_raise),
                                           WR_ACT(layer_lower),
                                           "-",
                                           WR_ACT(layer_above),
                                           WR_ACT(layer_below),
                                           WR_ACT(layer_choose_all),
                                           "-",
                                           WR_ACT(layer_group),
                                           WR_ACT(layer_ungroup),
                                           NULL };
static const char *const layer_visibility[] = { WR_ACT(layer_show), WR_ACT(layer_lock),
                                                WR_ACT(layer_solo), NULL };
static const char *const layer_variants[] = { WR_ACT(variant_add), WR_ACT(variant_set),
                                              WR_ACT(variant_rename), WR_ACT(variant_delete),
                                              NULL };
static const char *const layer_mask[] = { WR_ACT(mask_selection),
                                          WR_ACT(mask_white),
                                          WR_ACT(mask_black),
                                          WR_ACT(mask_height),
                                          WR_ACT(mask_slope),
                                          WR_ACT(mask_live),
                                          "-",
                                          WR_ACT(mask_invert),
                                          WR_ACT(mask_none),
                                          "-",
                                          WR_ACT(mask_edit),
                                          WR_ACT(mask_alone),
                                          NULL };
static const char *const layer_merging[] = { WR_ACT(layer_merge),   WR_ACT(layer_project),
                                             WR_ACT(layer_flatten), "-",
                                             WR_ACT(layer_clear),   NULL };
static const char *const select_menu[] = { WR_ACT(select_all),
                                           WR_ACT(select_none),
                                           WR_ACT(select_invert),
                                           "-",
                                           WR_ACT(select_grow),
                                           WR_ACT(select_shrink),
                                           WR_ACT(select_feather),
                                           "-",
                                           WR_ACT(select_height),
                                           WR_ACT(select_slope),
                                           WR_ACT(select_mask),
                                           "-",
                                           ">Selection",
                                           WR_ACT(ants),
                                           NULL };
static const char *const table_menu[] = { WR_ACT(table_size), WR_ACT(fill), WR_ACT(grid),
                                          WR_ACT(import),     "-",          WR_ACT(offset_half),
                                          "operations",       NULL };
static const char *const view_menu[] = { ">Table shows",
                                         ">Zoom and turn",
                                         ">Copies beside it",
                                         ">Grid",
                                         "-",
                                         ">Patch shows",
                                         ">Camera",
                                         WR_ACT(turn),
                                         WR_ACT(ground),
                                         "-",
                                         ">Accuracy",
                                         "-",
                                         ">Panels",
                                         ">Workspace",
                                         ">Theme",
                                         "scale",
                                         WR_ACT(fullscreen),
                                         NULL };
static const char *const view_table[] = { WR_ACT(look_grey),
                                          WR_ACT(look_signed),
                                          WR_ACT(look_relief),
                                          WR_ACT(look_contours),
                                          WR_ACT(look_slope),
                                          WR_ACT(look_normals),
                                          WR_ACT(look_occlusion),
                                          WR_ACT(look_curvature),
                                          WR_ACT(look_cavity),
                                          WR_ACT(look_roughness),
                                          "-",
                                          WR_ACT(range_auto),
                                          WR_ACT(range_unit),
                                          WR_ACT(range_marks),
                                          NULL };
static const char *const view_zoom[] = {
    WR_ACT(zoom_in),     WR_ACT(zoom_out),  WR_ACT(zoom_100),   WR_ACT(fit),       "-",
    WR_ACT(pan_left),    WR_ACT(pan_right), WR_ACT(pan_up),     WR_ACT(pan_down),  "-",
    WR_ACT(mirror_view), WR_ACT(turn_left), WR_ACT(turn_right), WR_ACT(turn_none), NULL
};
static const char *const view_copies[] = { WR_ACT(tiling_straight), WR_ACT(tiling_half_drop),
                                           WR_ACT(tiling_brick), NULL };
static const char *const view_grids[] = { WR_ACT(view_grid), WR_ACT(grid_finer),
                                          WR_ACT(grid_coarser), NULL };
static const char *const view_patch[] = { WR_ACT(look_plain),
                                          WR_ACT(look_split),
                                          WR_ACT(look_flicker),
                                          WR_ACT(compare_hold),
                                          WR_ACT(compare_take),
                                          WR_ACT(compare_swap),
                                          "-",
                                          WR_ACT(look_height),
                                          WR_ACT(look_tilt),
                                          WR_ACT(look_normal),
                                          "-",
                                          WR_ACT(look_error),
                                          WR_ACT(look_dropped),
                                          WR_ACT(look_level),
                                          WR_ACT(look_ran),
                                          NULL };
static const char *const view_camera[] = { WR_ACT(camera_fill),
                                           WR_ACT(camera_kind),
                                           "-",
                                           ">From",
                                           ">Orbit",
                                           "-",
                                           WR_ACT(view_keep),
                                           WR_ACT(view_back),
                                           WR_ACT(view_forward),
                                           "-",
                                           WR_ACT(pose_reset),
                                           WR_ACT(camera_reset),
                                           NULL };
static const char *const view_from[] = { WR_ACT(from_front),
                                         WR_ACT(from_back),
                                         WR_ACT(from_left),
                                         WR_ACT(from_right),
                                         WR_ACT(from_top),
                                         WR_ACT(from_bottom),
                                         NULL };
static const char *const view_orbit[] = { WR_ACT(orbit_left), WR_ACT(orbit_right), WR_ACT(orbit_up),
                                          WR_ACT(orbit_down), NULL };
static const char *const view_accuracy[] = { WR_ACT(accuracy),
                                             WR_ACT(accuracy_measure),
                                             "-",
                                             WR_ACT(inspector),
                                             WR_ACT(inspector_pin),
                                             WR_ACT(inspector_copy),
                                             "-",
                                             WR_ACT(hard_cases),
                                             NULL };
static const char *const view_panels[] = { WR_ACT(view_both),
                                           WR_ACT(view_canvas),
                                           WR_ACT(view_patch),
                                           WR_ACT(panels),
                                           "-",
                                           WR_ACT(hide_strip),
                                           WR_ACT(hide_options),
                                           WR_ACT(meters),
                                           WR_ACT(side_left),
                                           "-",
                                           WR_ACT(tab_float),
                                           WR_ACT(dock_all),
                                           "-",
                                           WR_ACT(part_next),
                                           WR_ACT(part_back),
                                           WR_ACT(menus),
                                           NULL };
static const char *const view_workspaces[] = { WR_ACT(workspace_paint), WR_ACT(workspace_generate),
                                               WR_ACT(workspace_light), WR_ACT(workspace_export),
                                               WR_ACT(workspace_study), "-",
                                               WR_ACT(workspace_reset), NULL };
static const char *const view_theme[] = { WR_ACT(theme_dark), WR_ACT(theme_light),
                                          WR_ACT(theme_contrast), NULL };
static const char *const help_menu[] = { WR_ACT(help),   WR_ACT(tour),  WR_ACT(study),
                                         WR_ACT(tablet), WR_ACT(about), NULL };

static void recent(WrApp *app)
{
    if (!wr_gui_menu_begin("Open recent")) return;
    const char *chosen = NULL;
    for (int i = 0; i < WR_RECENT_MAX && app->settings->recent[i]; i++) {
        wr_gui_push_id(i);
        wr_gui_as_it_is(true);
        if (wr_gui_menu_item(app->settings->recent[i], NULL, false, !wr_busy_greys(app)))
            chosen = app->settings->recent[i];
        wr_gui_as_it_is(false);
        wr_gui_pop_id();
    }
    if (!app->settings->recent[0]) wr_gui_menu_item("No files yet", NULL, false, false);
    wr_gui_menu_end();
    if (!chosen) return;
    char *copy = wr_strdup(chosen); /* opening a file reorders the list */
    wr_app_open_path(app, copy);
    wr_free(copy);
}

static void scale(WrApp *app)
{
    static const int percents[] = { 75, 100, 125, 150, 175, 200, 250, 300 };
    if (!wr_gui_menu_begin("Size of everything")) return;
    if (wr_gui_menu_item("As the display", NULL, app->settings->scale == 0.0, true))
        wr_app_set_scale(app, 0.0);
    for (size_t i = 0; i < sizeof percents / sizeof *percents; i++) {
        char label[16];
        snprintf(label, sizeof label, "%d %%", percents[i]);
        if (wr_gui_menu_item(label, NULL, app->settings->scale == percents[i] / 100.0, true))
            wr_app_set_scale(app, percents[i] / 100.0);
    }
    wr_gui_menu_end();
}

void (*wr_menu_listed)(const char *action);

const char *wr_menu_label(const WrApp *app, const WrAction *action, char text[WR_ACTION_LABEL])
{
    const int chosen = action->several ? wr_chosen_count(wr_app_chosen(app)) : 1;
    if (chosen > 1) snprintf(text, WR_ACTION_LABEL, wr_words(action->several), chosen);
    else snprintf(text, WR_ACTION_LABEL, "%s", wr_words(action->label));
    return text;
}

void wr_menu_item(WrApp *app, const char *name)
{
    char keys[32], label[WR_ACTION_LABEL];
    if (wr_menu_listed) wr_menu_listed(name);
    wr_gui_name_row(name);
    const WrAction *action = wr_action_find(app, name);
    WR_ASSERT(action);
    if (!action) return;
    bool checked = action->checked && action->checked(app);
    if (action->several) wr_gui_next_id(name); /* its label changes with the chosen layers */
    if (wr_gui_menu_item(wr_menu_label(app, action, label), wr_keys_label(app->keys, name, keys),
                         checked, wr_action_can(app, action)))
        wr_action_run(app, name);
    wr_gui_tip(wr_action_help(app, action));
}

/* Groups of the table operations: the first of each. */
static const struct {
    const char *label, *first;
} operation_groups[] = { { "Move and resize", "offset" },
                         { "Seamless", "seamless" },
                         { "Heights", "levels" },
                         { "Smooth and distort", "blur" } };

static int group_of(const WrOpInfo *op, int group)
{
    while (group + 1 < WR_LENGTH(operation_groups) &&
           strcmp(op->name, operation_groups[group + 1].first) == 0)
        group++;
    return group;
}

static void operation(WrApp *app, const WrOpInfo *op, bool filter)
{
    char name[64], label[80], keys[32];
    snprintf(name, sizeof name, "%s_%.50s", filter ? "filter" : "adjust", op->name);
    snprintf(label, sizeof label, "%.60s...", wr_words(op->label));
    if (wr_gui_menu_item(label, wr_keys_label(app->keys, name, keys), false, !wr_busy_greys(app)))
        wr_action_run(app, name);
    wr_gui_tip(op->help);
}

/* Table operations in the order of their table, each group in a menu: all, or those usable as filter layers. */
static void list_operations(WrApp *app, bool filters)
{
    for (int group = 0; group < WR_LENGTH(operation_groups); group++) {
        if (!wr_gui_menu_begin(operation_groups[group].label)) continue;
        int at = 0;
        for (const WrOpInfo *op = wr_ops; op->name; op++) {
            at = group_of(op, at);
            if (at == group && !(filters && op->reshapes)) operation(app, op, filters);
        }
        wr_gui_menu_end();
    }
}

void wr_menu_filters(WrApp *app)
{
    list_operations(app, true);
}

static void filters(WrApp *app)
{
    if (!wr_gui_menu_begin("New filter layer")) return;
    wr_menu_filters(app);
    wr_gui_menu_end();
}

static void generator_item(WrApp *app, const WrGenerator *generator)
{
    char name[WR_GENERATE_ACTION], label[80], keys[32];
    wr_generate_action(generator, name);
    snprintf(label, sizeof label, "%.60s...", wr_words(generator->label));
    if (wr_gui_menu_item(label, wr_keys_label(app->keys, name, keys),
                         app->generate->generator == generator, true))
        wr_action_run(app, name);
    wr_gui_tip(generator->help);
}

/* All generators, by family. */
static void generators(WrApp *app)
{
    if (!wr_gui_menu_begin("Generate")) return;
    wr_menu_item(app, WR_ACT(generate));
    wr_gui_menu_separator();
    for (const WrFamily *f = wr_families; f->name; f++) {
        if (!f->rows->family) continue;
        bool alone = !f->rows[1].family;
        if (alone) {
            generator_item(app, f->rows);
        } else if (wr_gui_menu_begin(f->label)) {
            for (const WrGenerator *g = f->rows; g->family; g++) generator_item(app, g);
            wr_gui_menu_end();
        }
    }
    wr_gui_menu_end();
}

static void menu(WrApp *app, const char *label, const char *const *names);

/* Menus within menus. */
static const struct {
    const char *label;
    const char *const *names;
} submenus[] = { { "Presets", brush_presets },
                 { "Size and strength", brush_values },
                 { "Mode and height", brush_modes },
                 { "Stabilizer", brush_steady },
                 { "Pen pressure", brush_pressure },
                 { "On the patch", tool_patch },
                 { "Shapes", tool_shapes },
                 { "Selection", tool_selection },
                 { "Order and groups", layer_order },
                 { "Visibility", layer_visibility },
                 { "Mask", layer_mask },
                 { "Variants", layer_variants },
                 { "Merge", layer_merging },
                 { "Table shows", view_table },
                 { "Zoom and turn", view_zoom },
                 { "Copies beside it", view_copies },
                 { "Grid", view_grids },
                 { "Patch shows", view_patch },
                 { "Camera", view_camera },
                 { "From", view_from },
                 { "Orbit", view_orbit },
                 { "Accuracy", view_accuracy },
                 { "Panels", view_panels },
                 { "Workspace", view_workspaces },
                 { "Theme", view_theme } };

static void submenu(WrApp *app, const char *label)
{
    for (int i = 0; i < WR_LENGTH(submenus); i++)
        if (strcmp(submenus[i].label, label) == 0) {
            menu(app, submenus[i].label, submenus[i].names);
            return;
        }
    WR_ASSERT(false);
}

static void menu(WrApp *app, const char *label, const char *const *names)
{
    if (!wr_gui_menu_begin(label)) return;
    for (; *names; names++) {
        if (strcmp(*names, "-") == 0) wr_gui_menu_separator();
        else if (strcmp(*names, "recent") == 0) recent(app);
        else if (strcmp(*names, "scale") == 0) scale(app);
        else if (strcmp(*names, "operations") == 0) list_operations(app, false);
        else if (strcmp(*names, "filters") == 0) filters(app);
        else if (**names == '>') submenu(app, *names + 1);
        else wr_menu_item(app, *names);
    }
    wr_gui_menu_end();
}

/* Width of the search button at the right end; 0: no room. */
static double find_width(const WrApp *app)
{
    char keys[32];
    wr_keys_label(app->keys, WR_ACT(search), keys);
    const double words = wr_gui_text_width(WR_FONT_SMALL, "Search") +
                         wr_gui_text_width(WR_FONT_SMALL, keys) + wr_gui_px(26);
    const double least = wr_gui_px(FIND_UNITS);
    return app->width < wr_gui_px(900) ? 0.0 : words > least ? words : least;
}

static void find_field(WrApp *app, double wide)
{
    char keys[32];
    if (wide <= 0.0) return;
    wr_gui_move_to(app->width - wide - wr_gui_px(12));
    if (wr_gui_find_button("Search", wr_keys_label(app->keys, WR_ACT(search), keys), wide))
        wr_action_run(app, WR_ACT(search));
}

/* The workspaces as a choice beside the search. */
static void workspace_choice(WrApp *app, double from)
{
    const char *labels[WR_WORKSPACES];
    for (int i = 0; i < WR_WORKSPACES; i++) labels[i] = wr_workspaces[i].label;
    int now = app->settings->workspace;
    wr_gui_move_to(from);
    if (wr_gui_bar_segments("workspaces", labels, WR_WORKSPACES, &now)) {
        char action[48];
        wr_action_run(app, wr_workspace_action((WrWorkspaceKind)now, action));
    }
}

/* The document's name, centred if there is room; it is also in the window's title. */
static void title(const WrApp *app, double from, double to)
{
    char text[300];
    snprintf(text, sizeof text, "%.200s%s", wr_app_name(app),
             wr_app_unsaved(app) ? "  \xe2\x80\xa2" : "");
    double wide = wr_gui_text_width(WR_FONT_BOLD, text), at = (app->width - wide) / 2.0;
    at = at + wide < to ? at : to - wide;
    at = at > from ? at : from;
    if (to - at < wr_gui_px(60) && to - at < wide) return;
    wr_gui_move_to(at);
    wr_gui_as_it_is(true);
    wr_gui_text_cut(WR_FONT_BOLD, WR_COLOUR_TEXT, text, to - at);
    wr_gui_as_it_is(false);
}

static double workspaces_width(void)
{
    const char *labels[WR_WORKSPACES];
    for (int i = 0; i < WR_WORKSPACES; i++) labels[i] = wr_workspaces[i].label;
    return wr_gui_bar_segments_width(labels, WR_WORKSPACES);
}

/* True if the menu titles leave no room beside them. */
static bool is_tight(const WrApp *app)
{
    static const char *const titles[] = { "File",   "Edit",  "Brush",    "Tools", "Layer",
                                          "Select", "Table", "Generate", "View",  "Help" };
    double wide = find_width(app) + workspaces_width() + wr_gui_px(320);
    for (int i = 0; i < WR_LENGTH(titles); i++)
        wide += wr_gui_text_width(WR_FONT_TEXT, titles[i]) + wr_gui_px(14);
    return wide > app->width;
}

void wr_panel_menu(WrApp *app)
{
    app->menu_height = (int)wr_gui_menu_bar_begin(is_tight(app));
    menu(app, "File", file_menu);
    menu(app, "Edit", edit_menu);
    menu(app, "Brush", brush_menu);
    menu(app, "Tools", tool_menu);
    menu(app, "Layer", layer_menu);
    menu(app, "Select", select_menu);
    menu(app, "Table", table_menu);
    generators(app);
    menu(app, "View", view_menu);
    menu(app, "Help", help_menu);
    const double find = find_width(app), from = wr_gui_place() + wr_gui_px(16);
    const double end = app->width - wr_gui_px(find > 0.0 ? 28 : 12) - find;
    double choice = workspaces_width() + wr_gui_px(16);
    if (!app->settings->panels || choice > end - from) choice = 0.0;
    title(app, from, end - choice);
    if (choice > 0.0) workspace_choice(app, end - choice + wr_gui_px(16));
    find_field(app, find);
    wr_gui_menu_bar_end();
}
