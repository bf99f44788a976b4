/* action_list.h - names of all actions with their default keys: "Ctrl+Z Z". Menus, tools, buttons and the guide's
   page of keys refer to actions by WR_ACT(undo), so that the compiler checks each name. */
#pragma once

/* Actions of the table in app/actions.c. */
#define WR_ACTIONS(X)                                                                              \
    X(new, "Ctrl+N")                                                                               \
    X(starters, "Ctrl+Alt+N")                                                                      \
    X(open, "Ctrl+O")                                                                              \
    X(save, "Ctrl+S")                                                                              \
    X(save_as, "Ctrl+Shift+S")                                                                     \
    X(render, "")                                                                                  \
    X(film, "")                                                                                    \
    X(export, "Ctrl+E Ctrl+Shift+E")                                                               \
    X(maps, "Ctrl+Alt+M")                                                                          \
    X(save_history, "")                                                                            \
    X(run_macro, "")                                                                               \
    X(quit, "Ctrl+Q")                                                                              \
    X(undo, "Ctrl+Z Z")                                                                            \
    X(redo, "Ctrl+Shift+Z Ctrl+Y Y")                                                               \
    X(cut, "Ctrl+X")                                                                               \
    X(copy, "Ctrl+C")                                                                              \
    X(copy_shown, "Ctrl+Shift+C")                                                                  \
    X(paste, "Ctrl+V")                                                                             \
    X(preferences, "Ctrl+,")                                                                       \
    X(search, "Ctrl+Return")                                                                       \
    X(brush, "B")                                                                                  \
    X(smooth, "Shift+U")                                                                           \
    X(smear, "S")                                                                                  \
    X(clone, "C")                                                                                  \
    X(flood, "G F")                                                                                \
    X(ramp, "Shift+G")                                                                             \
    X(shape_rect, "R")                                                                             \
    X(shape_ellipse, "Q")                                                                          \
    X(shape_polygon, "Shift+Q")                                                                    \
    X(shape_path, "N")                                                                             \
    X(stamp, "Shift+S")                                                                            \
    X(stamp_open, "")                                                                              \
    X(generate, "Shift+T")                                                                         \
    X(select_rect, "Shift+R")                                                                      \
    X(select_ellipse, "Shift+E")                                                                   \
    X(select_lasso, "Shift+L")                                                                     \
    X(transform, "Ctrl+T")                                                                         \
    X(pick, "P")                                                                                   \
    X(pan, "H")                                                                                    \
    X(zoom, "Shift+Z")                                                                             \
    X(size_up, "]")                                                                                \
    X(size_down, "[")                                                                              \
    X(hardness_up, "Shift+]")                                                                      \
    X(hardness_down, "Shift+[")                                                                    \
    X(strength_up, "O")                                                                            \
    X(strength_down, "I")                                                                          \
    X(swap_mode, "X")                                                                              \
    X(level_mode, "")                                                                              \
    X(height_up, "L")                                                                              \
    X(height_down, "K")                                                                            \
    X(erase_mode, "E")                                                                             \
    X(reset_values, "D")                                                                           \
    X(brushes, "F5")                                                                               \
    X(round_brush, "")                                                                             \
    X(preset_last, "/")                                                                            \
    X(preset_next, ".")                                                                            \
    X(preset_previous, ",")                                                                        \
    X(favourite, "")                                                                               \
    X(brush_curves, "")                                                                            \
    X(preset_save, "")                                                                             \
    X(lock_size, "")                                                                               \
    X(symmetry, "U")                                                                               \
    X(symmetry_on, "Shift+M")                                                                      \
    X(theme_dark, "")                                                                              \
    X(theme_light, "")                                                                             \
    X(theme_contrast, "")                                                                          \
    X(keys_paint, "")                                                                              \
    X(keys_sculpt, "")                                                                             \
    X(straight_line, "V")                                                                          \
    X(paint_patch, "A")                                                                            \
    X(paint_round, "")                                                                             \
    X(projection_handle, "")                                                                       \
    X(pressure_up, "Alt+Shift+S")                                                                  \
    X(pressure_down, "Alt+Shift+A")                                                                \
    X(pressure_speed, "")                                                                          \
    X(steady_off, "")                                                                              \
    X(steady_smooth, "")                                                                           \
    X(steady_string, "")                                                                           \
    X(steady_catch_up, "")                                                                         \
    X(select_all, "Ctrl+A")                                                                        \
    X(select_none, "Ctrl+Shift+A")                                                                 \
    X(select_invert, "Ctrl+Shift+I")                                                               \
    X(select_grow, "")                                                                             \
    X(select_shrink, "")                                                                           \
    X(select_feather, "")                                                                          \
    X(select_height, "")                                                                           \
    X(select_slope, "")                                                                            \
    X(select_mask, "")                                                                             \
    X(layer_add, "Ctrl+Shift+N Insert")                                                            \
    X(layer_duplicate, "Ctrl+J")                                                                   \
    X(layer_link, "")                                                                              \
    X(layer_delete, "Shift+Delete")                                                                \
    X(layer_rename, "")                                                                            \
    X(filter_edit, "")                                                                             \
    X(layer_rasterize, "")                                                                         \
    X(layer_group, "Ctrl+G")                                                                       \
    X(layer_ungroup, "Ctrl+Shift+G")                                                               \
    X(layer_merge, "Ctrl+Alt+E")                                                                   \
    X(layer_flatten, "Ctrl+Shift+F")                                                               \
    X(layer_project, "")                                                                           \
    X(layer_clear, "Delete")                                                                       \
    X(layer_show, "")                                                                              \
    X(layer_lock, "")                                                                              \
    X(layer_solo, "")                                                                              \
    X(layer_raise, "Ctrl+PageUp")                                                                  \
    X(layer_lower, "Ctrl+PageDown")                                                                \
    X(layer_above, "PageUp")                                                                       \
    X(layer_below, "PageDown")                                                                     \
    X(layer_choose_all, "Ctrl+Alt+A")                                                              \
    X(variant_add, "")                                                                             \
    X(variant_set, "")                                                                             \
    X(variant_rename, "")                                                                          \
    X(variant_delete, "")                                                                          \
    X(mask_selection, "")                                                                          \
    X(mask_white, "")                                                                              \
    X(mask_black, "")                                                                              \
    X(mask_height, "")                                                                             \
    X(mask_slope, "")                                                                              \
    X(mask_live, "")                                                                               \
    X(mask_invert, "")                                                                             \
    X(mask_none, "")                                                                               \
    X(mask_edit, "Alt+M")                                                                          \
    X(mask_alone, "Alt+Shift+M")                                                                   \
    X(table_size, "")                                                                              \
    X(offset_half, "Ctrl+Shift+H")                                                                 \
    X(fill, "")                                                                                    \
    X(grid, "")                                                                                    \
    X(mesh, "")                                                                                    \
    X(gltf, "")                                                                                    \
    X(bake, "")                                                                                    \
    X(import, "")                                                                                  \
    X(zoom_in, "+ = Shift+= Ctrl++ Ctrl+= Keypad_+")                                               \
    X(zoom_out, "- Ctrl+- Keypad_-")                                                               \
    X(zoom_100, "1")                                                                               \
    X(fit, "2 Ctrl+0")                                                                             \
    X(mirror_view, "M")                                                                            \
    X(turn_left, "4 Ctrl+[")                                                                       \
    X(turn_right, "6 Ctrl+]")                                                                      \
    X(turn_none, "5")                                                                              \
    X(tiling_straight, "")                                                                         \
    X(tiling_half_drop, "")                                                                        \
    X(tiling_brick, "")                                                                            \
    X(pan_left, "Left")                                                                            \
    X(pan_right, "Right")                                                                          \
    X(pan_up, "Up")                                                                                \
    X(pan_down, "Down")                                                                            \
    X(panels, "Tab")                                                                               \
    X(side_left, "")                                                                               \
    X(hide_strip, "")                                                                              \
    X(hide_options, "")                                                                            \
    X(meters, "")                                                                                  \
    X(tab_float, "")                                                                               \
    X(dock_all, "")                                                                                \
    X(workspace_paint, "Ctrl+1")                                                                   \
    X(workspace_generate, "Ctrl+2")                                                                \
    X(workspace_light, "Ctrl+3")                                                                   \
    X(workspace_export, "Ctrl+4")                                                                  \
    X(workspace_study, "Ctrl+5")                                                                   \
    X(workspace_reset, "")                                                                         \
    X(part_next, "Ctrl+Tab")                                                                       \
    X(part_back, "Ctrl+Shift+Tab")                                                                 \
    X(menus, "F10")                                                                                \
    X(view_both, "F2")                                                                             \
    X(view_canvas, "F3")                                                                           \
    X(view_patch, "F4")                                                                            \
    X(look_grey, "Alt+1")                                                                          \
    X(look_signed, "Alt+2")                                                                        \
    X(look_occlusion, "Alt+3")                                                                     \
    X(look_curvature, "Alt+4")                                                                     \
    X(look_cavity, "Alt+Shift+3")                                                                  \
    X(look_slope, "Alt+Shift+4")                                                                   \
    X(look_roughness, "")                                                                          \
    X(look_contours, "Alt+Shift+2")                                                                \
    X(look_relief, "Alt+Shift+1")                                                                  \
    X(look_normals, "Alt+Shift+5")                                                                 \
    X(range_auto, "Alt+R")                                                                         \
    X(range_unit, "")                                                                              \
    X(range_marks, "")                                                                             \
    X(view_grid, "Alt+G")                                                                          \
    X(grid_finer, "")                                                                              \
    X(grid_coarser, "")                                                                            \
    X(ants, "")                                                                                    \
    X(accuracy, "F6")                                                                              \
    X(accuracy_measure, "")                                                                        \
    X(study, "")                                                                                   \
    X(inspector, "F7")                                                                             \
    X(inspector_pin, "Shift+F7")                                                                   \
    X(inspector_copy, "")                                                                          \
    X(hard_cases, "")                                                                              \
    X(look_plain, "Alt+5")                                                                         \
    X(look_split, "Alt+6")                                                                         \
    X(look_flicker, "Alt+7")                                                                       \
    X(compare_hold, "W")                                                                           \
    X(compare_take, "")                                                                            \
    X(compare_swap, "")                                                                            \
    X(look_error, "Alt+8")                                                                         \
    X(look_dropped, "Alt+9")                                                                       \
    X(look_tilt, "")                                                                               \
    X(look_level, "")                                                                              \
    X(look_height, "Alt+Shift+8")                                                                  \
    X(look_normal, "Alt+Shift+9")                                                                  \
    X(look_ran, "Alt+0")                                                                           \
    X(turn, "Ctrl+Space")                                                                          \
    X(view_back, "Alt+Left")                                                                       \
    X(view_forward, "Alt+Right")                                                                   \
    X(camera_reset, "")                                                                            \
    X(pose_reset, "")                                                                              \
    X(camera_fill, "Home Keypad_.")                                                                \
    X(camera_kind, "Keypad_5")                                                                     \
    X(from_front, "Keypad_1")                                                                      \
    X(from_back, "Ctrl+Keypad_1")                                                                  \
    X(from_right, "Keypad_3")                                                                      \
    X(from_left, "Ctrl+Keypad_3")                                                                  \
    X(from_top, "Keypad_7")                                                                        \
    X(from_bottom, "Ctrl+Keypad_7")                                                                \
    X(orbit_left, "Keypad_4")                                                                      \
    X(orbit_right, "Keypad_6")                                                                     \
    X(orbit_up, "Keypad_8")                                                                        \
    X(orbit_down, "Keypad_2")                                                                      \
    X(view_keep, "")                                                                               \
    X(ground, "")                                                                                  \
    X(fullscreen, "F11")                                                                           \
    X(tablet, "Ctrl+Shift+T")                                                                      \
    X(help, "F1")                                                                                  \
    X(tour, "")                                                                                    \
    X(about, "")

/* Modifier actions: keys that are held while the pointer works. */
#define WR_HELD_ACTIONS(X)                                                                         \
    X(hold_pick, "Ctrl")                                                                           \
    X(hold_size, "Shift")                                                                          \
    X(hold_invert, "Alt")                                                                          \
    X(hold_smooth, "Alt+Shift")

/* Actions of families, whose names come from other tables: adjust_OPERATION, generate_FAMILY. */
#define WR_FAMILY_ACTIONS(X)                                                                       \
    X(adjust_levels, "Ctrl+L")                                                                     \
    X(adjust_invert, "Ctrl+I")                                                                     \
    X(generate_text, "T")

#define WR_ACTION_ID(name, keys) WR_ACTION_##name,
enum { WR_ACTIONS(WR_ACTION_ID) WR_ACTION_COUNT };
enum { WR_HELD_ACTIONS(WR_ACTION_ID) WR_FAMILY_ACTIONS(WR_ACTION_ID) };
#undef WR_ACTION_ID

/* The name as a string; fails to compile for an unknown action. */
#define WR_ACT(name) (&#name[0 * WR_ACTION_##name])
