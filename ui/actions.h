/* actions.h - actions of layers and selections, for the table in actions.c; nobody else includes it. */
#pragma once
#include "ui/state.h"

void wr_act_layer_add(WrApp *app);
void wr_act_layer_duplicate(WrApp *app);
void wr_act_layer_delete(WrApp *app);
void wr_act_layer_rename(WrApp *app);
void wr_act_layer_merge(WrApp *app);
void wr_act_layer_flatten(WrApp *app);
void wr_act_layer_clear(WrApp *app);
void wr_act_layer_solo(WrApp *app);
void wr_act_layer_raise(WrApp *app);
void wr_act_layer_lower(WrApp *app);
void wr_act_layer_above(WrApp *app);
void wr_act_layer_below(WrApp *app);
void wr_act_layer_show(WrApp *app);
void wr_act_layer_lock(WrApp *app);
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
bool wr_can_merge(const WrApp *app); /* there is a layer below */
bool wr_can_raise(const WrApp *app);
bool wr_can_mask_selection(const WrApp *app); /* something is selected */
bool wr_can_mask_none(const WrApp *app);
bool wr_is_solo(const WrApp *app);
bool wr_is_layer_shown(const WrApp *app);
bool wr_is_layer_locked(const WrApp *app);
