/* gui_imgui_focus.h - shared helpers of the gui_imgui_focus*.cpp files. */
#pragma once
#include "ui/toolkit/gui_imgui.h"

#include <imgui_internal.h>

/* Number of open popups, dialogs included; and the topmost one's window, NULL if there is none. */
int wr_gui_levels_open(const ImGuiContext &g);
const ImGuiWindow *wr_gui_top_of(const ImGuiContext &g);
bool wr_gui_is_dialog(const ImGuiWindow *window);
bool wr_gui_is_list(const ImGuiWindow *window); /* a list within a part */
/* True if the keys can reach it now: while a popup is open, only its content. */
bool wr_gui_reachable(const ImGuiContext &g, const WrKeyStop *stop);
/* The stop of the last frame; NULL: not there. */
const WrKeyStop *wr_gui_find_stop(const WrFocus *focus, ImGuiID id);

/* ---- gui_imgui_focus_keys.cpp ---- */
/* Move the ring to a stop of the last frame. */
void wr_gui_go_to(WrFocus *focus, const WrKeyStop *stop);
/* The stop of a group that Tab reaches: the chosen one, or the first. */
const WrKeyStop *wr_gui_entrance(const ImGuiContext &g, const WrFocus *focus,
                                 const WrKeyStop *stop);
/* Handle the first queued key. */
void wr_gui_take_key(WrFocus *focus);
