/* actions_display.h - handlers of display actions: table colours and maps on the canvas, themes of the window. */
#pragma once
#include <stdbool.h>

typedef struct WrApp WrApp;

void wr_act_turn_left(WrApp *app);
void wr_act_turn_right(WrApp *app);
void wr_act_turn_none(WrApp *app);
bool wr_is_turned(const WrApp *app);
void wr_act_tiling_straight(WrApp *app);
bool wr_is_tiling_straight(const WrApp *app);
void wr_act_tiling_half_drop(WrApp *app);
bool wr_is_tiling_half_drop(const WrApp *app);
void wr_act_tiling_brick(WrApp *app);
bool wr_is_tiling_brick(const WrApp *app);
void wr_act_grid(WrApp *app);
void wr_act_grid_finer(WrApp *app);
void wr_act_grid_coarser(WrApp *app);
bool wr_is_grid(const WrApp *app);
void wr_act_display_grey(WrApp *app);
void wr_act_display_signed(WrApp *app);
bool wr_is_grey(const WrApp *app);
bool wr_is_signed(const WrApp *app);
void wr_act_display_contours(WrApp *app);
bool wr_is_contours(const WrApp *app);
void wr_act_display_relief(WrApp *app);
bool wr_is_relief(const WrApp *app);
void wr_act_display_normals(WrApp *app);
bool wr_canvas_shows_normals(const WrApp *app);
void wr_act_display_occlusion(WrApp *app);
bool wr_is_occlusion(const WrApp *app);
void wr_act_display_curvature(WrApp *app);
bool wr_is_curvature(const WrApp *app);
void wr_act_display_cavity(WrApp *app);
bool wr_is_cavity(const WrApp *app);
void wr_act_display_slope(WrApp *app);
bool wr_is_slope(const WrApp *app);
void wr_act_display_roughness(WrApp *app);
bool wr_is_roughness(const WrApp *app);
void wr_act_theme_dark(WrApp *app);
bool wr_is_theme_dark(const WrApp *app);
void wr_act_theme_light(WrApp *app);
bool wr_is_theme_light(const WrApp *app);
void wr_act_theme_contrast(WrApp *app);
bool wr_is_theme_contrast(const WrApp *app);

void wr_act_view_both(WrApp *app);
void wr_act_view_canvas(WrApp *app);
void wr_act_view_patch(WrApp *app);
void wr_act_part_next(WrApp *app);
void wr_act_part_back(WrApp *app);
void wr_act_menus(WrApp *app);

bool wr_is_both(const WrApp *app);
bool wr_is_canvas(const WrApp *app);
bool wr_is_patch(const WrApp *app);
