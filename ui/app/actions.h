/* actions.h - handlers of brush, layer and selection actions for the table in actions.c. Private to actions*.c. */
#pragma once
#include "ui/app/state/app_state.h"

#include <stdbool.h>

void wr_act_straight_line(WrApp *app);
void wr_act_paint_patch(WrApp *app);
void wr_act_paint_round(WrApp *app);
void wr_act_pressure_up(WrApp *app);
void wr_act_pressure_down(WrApp *app);
void wr_act_pressure_speed(WrApp *app);
void wr_act_steady_off(WrApp *app);
void wr_act_steady_smooth(WrApp *app);
void wr_act_steady_string(WrApp *app);
void wr_act_steady_catch_up(WrApp *app);

bool wr_is_straight_line(const WrApp *app);
bool wr_is_painting_patch(const WrApp *app);
bool wr_is_painting_round(const WrApp *app);
bool wr_is_pressure_speed(const WrApp *app);
bool wr_is_steady_off(const WrApp *app);
bool wr_is_steady_smooth(const WrApp *app);
bool wr_is_steady_string(const WrApp *app);
bool wr_is_steady_catch_up(const WrApp *app);

/* actions_brush.c */
void wr_act_size_up(WrApp *app);
void wr_act_size_down(WrApp *app);
void wr_act_hardness_up(WrApp *app);
void wr_act_hardness_down(WrApp *app);
void wr_act_strength_up(WrApp *app);
void wr_act_strength_down(WrApp *app);
void wr_act_swap_mode(WrApp *app);
void wr_act_level_mode(WrApp *app);
void wr_act_reset_values(WrApp *app);
void wr_act_target_height_up(WrApp *app);
void wr_act_target_height_down(WrApp *app);
void wr_act_erase_mode(WrApp *app);
void wr_act_preset_next(WrApp *app);
void wr_act_preset_previous(WrApp *app);
void wr_act_favourite(WrApp *app);
void wr_act_round_brush(WrApp *app);
void wr_act_lock_size(WrApp *app);
void wr_act_brush_curves(WrApp *app);
void wr_act_preset_save(WrApp *app);
void wr_act_brushes(WrApp *app);
void wr_act_symmetry(WrApp *app);
void wr_act_symmetry_toggle(WrApp *app);
void wr_act_keys_paint(WrApp *app);
void wr_act_keys_sculpt(WrApp *app);
void wr_act_stamp_open(WrApp *app);
bool wr_is_erase_mode(const WrApp *app);
bool wr_is_favourite(const WrApp *app);
bool wr_is_round_brush(const WrApp *app);
bool wr_is_lock_size(const WrApp *app);
bool wr_is_symmetry(const WrApp *app);
bool wr_is_symmetry_on(const WrApp *app);
bool wr_is_keys_paint(const WrApp *app);
bool wr_is_keys_sculpt(const WrApp *app);

void wr_act_layer_add(WrApp *app);
void wr_act_layer_duplicate(WrApp *app);
void wr_act_layer_link(WrApp *app);
void wr_act_layer_delete(WrApp *app);
void wr_act_layer_rename(WrApp *app);
void wr_act_layer_merge(WrApp *app);
void wr_act_filter_edit(WrApp *app);
void wr_act_layer_rasterize(WrApp *app);
void wr_act_layer_group(WrApp *app);
void wr_act_layer_ungroup(WrApp *app);
bool wr_has_values(const WrApp *app); /* it is a filter or a generator layer */
void wr_act_layer_flatten(WrApp *app);
void wr_act_layer_clear(WrApp *app);
void wr_act_layer_solo(WrApp *app);
void wr_act_layer_raise(WrApp *app);
void wr_act_layer_lower(WrApp *app);
void wr_act_layer_above(WrApp *app);
void wr_act_layer_below(WrApp *app);
void wr_act_layer_show(WrApp *app);
void wr_act_layer_lock(WrApp *app);
void wr_act_layer_choose_all(WrApp *app);
void wr_act_mask_selection(WrApp *app);
void wr_act_mask_white(WrApp *app);
void wr_act_mask_black(WrApp *app);
void wr_act_mask_none(WrApp *app);
void wr_act_select_all(WrApp *app);
void wr_act_select_none(WrApp *app);
void wr_act_select_invert(WrApp *app);
void wr_act_select_grow(WrApp *app);
void wr_act_select_shrink(WrApp *app);
void wr_act_select_feather(WrApp *app);
void wr_act_select_height(WrApp *app);
void wr_act_select_slope(WrApp *app);
void wr_act_offset_half(WrApp *app);

bool wr_can_several_layers(const WrApp *app);
bool wr_can_delete(const WrApp *app);
bool wr_can_rasterize(const WrApp *app);
bool wr_can_clear(const WrApp *app);
bool wr_can_ungroup(const WrApp *app);
bool wr_has_above(const WrApp *app); /* there is a layer above the active one */
bool wr_has_below(const WrApp *app);
bool wr_can_lower(const WrApp *app); /* there is a layer below the chosen ones */
bool wr_can_merge(const WrApp *app);
bool wr_can_flatten(const WrApp *app);
bool wr_can_change_all(const WrApp *app); /* no layer is locked */
bool wr_can_link(const WrApp *app);       /* the active layer is no filter */
bool wr_has_heights(const WrApp *app);    /* the active layer is neither a filter nor a group */
bool wr_can_raise(const WrApp *app);
bool wr_can_mask_selection(const WrApp *app); /* the selection is not empty */
void wr_act_copy(WrApp *app);
void wr_act_copy_shown(WrApp *app);
void wr_act_cut(WrApp *app);
void wr_act_paste(WrApp *app);
void wr_act_mask_height(WrApp *app);
void wr_act_mask_slope(WrApp *app);
void wr_act_mask_live(WrApp *app);
void wr_act_mask_invert(WrApp *app);
void wr_act_mask_edit(WrApp *app);
void wr_act_mask_alone(WrApp *app);
void wr_act_select_mask(WrApp *app);
bool wr_can_mask_live(const WrApp *app); /* there are layers below */
bool wr_has_mask(const WrApp *app);
bool wr_is_mask_edited(const WrApp *app);
bool wr_is_solo(const WrApp *app);
bool wr_is_layer_shown(const WrApp *app);
bool wr_is_layer_locked(const WrApp *app);

/* actions_camera.c */
void wr_act_view_back(WrApp *app);
void wr_act_view_forward(WrApp *app);
void wr_act_camera_reset(WrApp *app);
void wr_act_pose_reset(WrApp *app);
void wr_act_camera_fill(WrApp *app);
void wr_act_camera_kind(WrApp *app);
void wr_act_view_from_front(WrApp *app);
void wr_act_view_from_back(WrApp *app);
void wr_act_view_from_left(WrApp *app);
void wr_act_view_from_right(WrApp *app);
void wr_act_view_from_top(WrApp *app);
void wr_act_view_from_bottom(WrApp *app);
void wr_act_orbit_left(WrApp *app);
void wr_act_orbit_right(WrApp *app);
void wr_act_orbit_up(WrApp *app);
void wr_act_orbit_down(WrApp *app);
void wr_act_view_keep(WrApp *app);
void wr_act_ground(WrApp *app);
bool wr_can_view_back(const WrApp *app);
bool wr_can_view_forward(const WrApp *app);
bool wr_is_perspective(const WrApp *app);
bool wr_is_ground(const WrApp *app);
