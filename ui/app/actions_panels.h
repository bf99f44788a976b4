/* actions_panels.h - handlers of actions that arrange panels, and of workspaces. */
#pragma once
#include <stdbool.h>

typedef struct WrApp WrApp;

void wr_act_side_left(WrApp *app);
bool wr_is_side_left(const WrApp *app);
void wr_act_hide_strip(WrApp *app);
bool wr_is_hide_strip(const WrApp *app);
void wr_act_hide_options(WrApp *app);
bool wr_is_hide_options(const WrApp *app);
void wr_act_meters(WrApp *app);
bool wr_is_meters(const WrApp *app);
void wr_act_tab_float(WrApp *app);
void wr_act_dock_all(WrApp *app);
void wr_act_workspace_paint(WrApp *app);
bool wr_is_workspace_paint(const WrApp *app);
void wr_act_workspace_generate(WrApp *app);
bool wr_is_workspace_generate(const WrApp *app);
void wr_act_workspace_light(WrApp *app);
bool wr_is_workspace_light(const WrApp *app);
void wr_act_workspace_export(WrApp *app);
bool wr_is_workspace_export(const WrApp *app);
void wr_act_workspace_study(WrApp *app);
bool wr_is_workspace_study(const WrApp *app);
void wr_act_workspace_reset(WrApp *app);
