/* The registry: all dialogs, tabs, components and file purposes. */
#include "ui/app/registry_list.h"
#include "ui/panels/accuracy/accuracy.h"
#include "ui/app/canvas_view.h"
#include "ui/app/input_router.h"
#include "ui/app/loop.h"
#include "ui/app/idle_probe.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/document.h"
#include "ui/app/state/overwrite_question.h"
#include "ui/app/state/registry.h"
#include "ui/panels/generate/font_choice.h"
#include "ui/panels/generate/generate_presets.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/panels/help/guide.h"
#include "ui/panels/panel_adjust.h"
#include "ui/panels/panel_dynamics.h"
#include "ui/panels/panel_history.h"
#include "ui/panels/panel_layers.h"
#include "ui/panels/panel_preferences.h"
#include "ui/panels/panel_search.h"
#include "ui/panels/panel_tablet.h"
#include "ui/panels/panel_objects.h"
#include "ui/panels/missing_files.h"
#include "ui/panels/panels.h"
#include "ui/panels/stock.h"
#include "ui/panels/panel_sheet.h"
#include "ui/patch/patch.h"
#include "ui/canvas/tools/preset_browser.h"
#include "ui/canvas/tools/stroke_input.h"
#include "ui/canvas/tools/thumbs.h"
#include "ui/canvas/tools/tool.h"
#include "ui/canvas/tools/tool_clone.h"
#include "ui/canvas/tools/tool_select.h"
#include "ui/canvas/tools/tool_stamp.h"
#include "ui/canvas/overlays/marks.h"
#include "ui/canvas/overlays/panel_seam.h"
#include "ui/app/jobs/files.h"
#include "ui/canvas/tools/tool_rows.h"

#include "base/enum_rows.h"

WR_ROWS(dialogs);
static const WrDialogRow dialogs[] = {
    [WR_ROW(WR_DIALOG_NONE)] = { NULL, false },
    [WR_ROW(WR_DIALOG_UNSAVED)] = { wr_dialog_unsaved, false },
    [WR_ROW(WR_DIALOG_NEW)] = { wr_dialog_new, false, WR_ACT(new) },
    [WR_ROW(WR_DIALOG_STARTERS)] = { wr_dialog_starters, false, WR_ACT(starters) },
    [WR_ROW(WR_DIALOG_TABLE)] = { wr_dialog_table, false, WR_ACT(table_size) },
    [WR_ROW(WR_DIALOG_FILL)] = { wr_dialog_fill, false, WR_ACT(fill) },
    [WR_ROW(WR_DIALOG_GRID)] = { wr_dialog_grid, false, WR_ACT(grid) },
    [WR_ROW(WR_DIALOG_IMPORT)] = { wr_dialog_import, false, WR_ACT(import) },
    [WR_ROW(WR_DIALOG_EXPORT)] = { wr_dialog_export, false, WR_ACT(export) },
    [WR_ROW(WR_DIALOG_SHEET)] = { wr_dialog_sheet, false, WR_ACT(maps) },
    [WR_ROW(WR_DIALOG_RENDER)] = { wr_dialog_render, false, WR_ACT(render) },
    [WR_ROW(WR_DIALOG_FILM)] = { wr_dialog_film, false, WR_ACT(film) },
    [WR_ROW(WR_DIALOG_FILE)] = { wr_dialog_file, false },
    [WR_ROW(WR_DIALOG_ADJUST)] = { wr_dialog_adjust, true },
    [WR_ROW(WR_DIALOG_SELECT)] = { wr_dialog_select, true },
    [WR_ROW(WR_DIALOG_SEARCH)] = { wr_dialog_search, false },
    [WR_ROW(WR_DIALOG_PREFERENCES)] = { wr_dialog_preferences, false, WR_ACT(preferences) },
    [WR_ROW(WR_DIALOG_RECOVER)] = { wr_dialog_recover, false },
    [WR_ROW(WR_DIALOG_PRESET)] = { wr_dialog_preset, false },
    [WR_ROW(WR_DIALOG_DYNAMICS)] = { wr_dialog_dynamics, true },
    [WR_ROW(WR_DIALOG_REPLACE)] = { wr_dialog_replace, false },
    [WR_ROW(WR_DIALOG_RASTERIZE)] = { wr_dialog_rasterize, false },
    [WR_ROW(WR_DIALOG_MASK)] = { wr_dialog_mask, true },
    [WR_ROW(WR_DIALOG_LINK)] = { wr_dialog_link, true },
    [WR_ROW(WR_DIALOG_VARIANT)] = { wr_dialog_variant, false },
    [WR_ROW(WR_DIALOG_STEP)] = { wr_dialog_step, true },
    [WR_ROW(WR_DIALOG_MACRO)] = { wr_dialog_macro, true },
    [WR_ROW(WR_DIALOG_TABLET)] = { wr_dialog_tablet, false },
    [WR_ROW(WR_DIALOG_BAKE)] = { wr_dialog_bake, false, WR_ACT(bake) },
    [WR_ROW(WR_DIALOG_CASES)] = { wr_dialog_cases, false },
    [WR_ROW(WR_DIALOG_DROP)] = { wr_dialog_drop, false },
    [WR_ROW(WR_DIALOG_WELCOME)] = { wr_dialog_welcome, false },
    [WR_ROW(WR_DIALOG_TOUR)] = { wr_dialog_tour, true },
    [WR_ROW(WR_DIALOG_HELP)] = { wr_dialog_help, false },
    [WR_ROW(WR_DIALOG_ABOUT)] = { wr_dialog_help, false },
};
WR_ROWS_END(dialogs, WR_DIALOG_COUNT);

static const WrTab tabs[] = {
    { "Brushes", .fill = wr_panel_brushes, .rows_area = "brush_values", .rows = wr_panel_brush },
    { "Scene", .draw = wr_panel_scene, .second = wr_panel_scene_second, .edits = true },
    { "Plan", .draw = wr_panel_plan },
    { "History", .draw = wr_panel_history, .unlisted = true },
    { "Generate", .fill = wr_panel_generate, .is_long = true, .unlisted = true,
      .rows_area = "generate_values", .rows = wr_panel_generate_values },
    { "Accuracy", .draw = wr_panel_accuracy, .is_long = true },
    { "Export", .draw = wr_panel_export },
    { "Layers", .fill = wr_panel_layers, .below = true },
    { "Inspector", .draw = wr_panel_inspector, .below = true },
};

/* In the order of update and drawing. */
static const WrPart *const parts[] = { &wr_part_hand,        &wr_part_tools,      &wr_part_strokes,
                                       &wr_part_select,      &wr_part_clone,      &wr_part_canvas,
                                       &wr_part_marks,       &wr_part_seam_meter, &wr_part_stamp,
                                       &wr_part_generate,    &wr_part_patch,      &wr_part_accuracy,
                                       &wr_part_layers,      &wr_part_thumbs,     &wr_part_stock,
                                       &wr_part_font_choice, &wr_part_sheet,      &wr_part_adjust,
                                       &wr_part_thrift,      &wr_part_search,     NULL };

static WrActionFamily *const families[] = { wr_adjust_dialog_of_action, wr_filter_dialog_of_action,
                                            wr_generate_tab_of_action, NULL };

WR_ROWS(takes);
static WrFileTake *const takes[] = {
    [WR_ROW(WR_FILE_OPEN)] = wr_file_take_open,
    [WR_ROW(WR_FILE_SAVE)] = wr_file_take_save,
    [WR_ROW(WR_FILE_EXPORT)] = wr_file_take_export,
    [WR_ROW(WR_FILE_RENDER)] = wr_file_take_render,
    [WR_ROW(WR_FILE_FILM)] = wr_file_take_film,
    [WR_ROW(WR_FILE_IMPORT)] = wr_file_take_import,
    [WR_ROW(WR_FILE_HISTORY)] = wr_file_take_history,
    [WR_ROW(WR_FILE_MACRO_SAVE)] = wr_macro_save_chosen,
    [WR_ROW(WR_FILE_MACRO)] = wr_macro_chosen,
    [WR_ROW(WR_FILE_STAMP)] = wr_stamp_file_chosen,
    [WR_ROW(WR_FILE_GENERATE)] = wr_generate_file,
    [WR_ROW(WR_FILE_LOCATE)] = wr_missing_file_chosen,
    [WR_ROW(WR_FILE_TABLE)] = wr_object_table_file_chosen,
    [WR_ROW(WR_FILE_COLOUR)] = wr_map_take_colour,
    [WR_ROW(WR_FILE_NORMALS)] = wr_map_take_normals,
    [WR_ROW(WR_FILE_ROUGHNESS)] = wr_map_take_roughness,
    [WR_ROW(WR_FILE_METALNESS)] = wr_map_take_metalness,
    [WR_ROW(WR_FILE_SURROUND)] = wr_light_take_surround,
    [WR_ROW(WR_FILE_MESH)] = wr_surface_take_mesh,
    [WR_ROW(WR_FILE_PATCHES)] = wr_surface_take_patches,
    [WR_ROW(WR_FILE_TERRAIN)] = wr_surface_terrain_file_chosen,
    [WR_ROW(WR_FILE_GLTF)] = wr_file_take_gltf,
    [WR_ROW(WR_FILE_BAKE)] = wr_file_take_bake,
    [WR_ROW(WR_FILE_BRUSH)] = wr_preset_browser_take_file,
    [WR_ROW(WR_FILE_PRESET)] = wr_preset_browser_overwrite,
};
WR_ROWS_END(takes, WR_FILE_PURPOSES);

/* Tools in the order of the tool strip. */
static const WrTool *const tools[] = {
    &wr_tool_brush,         &wr_tool_smooth,      &wr_tool_smear,          &wr_tool_clone,
    &wr_tool_flood,         &wr_tool_ramp,        &wr_tool_shape_rect,     &wr_tool_shape_ellipse,
    &wr_tool_shape_polygon, &wr_tool_shape_path,  &wr_tool_stamp,          &wr_tool_generate,
    &wr_tool_pick,          &wr_tool_select_rect, &wr_tool_select_ellipse, &wr_tool_select_lasso,
    &wr_tool_transform,     &wr_tool_pan,         &wr_tool_zoom,
};

const WrRegistry wr_registry = { .tools = tools,
                                 .tool_count = WR_LENGTH(tools),
                                 .actions = wr_actions,
                                 .helps = wr_action_helps,
                                 .families = families,
                                 .dialogs = dialogs,
                                 .tabs = tabs,
                                 .tab_count = WR_LENGTH(tabs),
                                 .parts = parts,
                                 .takes = takes,
                                 .step = wr_app_step };
