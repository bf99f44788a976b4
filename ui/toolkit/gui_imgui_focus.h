/* gui_imgui_focus.h - what the files of the focus share: where the keys are, and what stands there. */
#pragma once
#include "ui/toolkit/gui_imgui.h"

#include <imgui_internal.h>

/* How many popups are open, the dialog counted; and the window of the last of them, NULL where there is none. */
int wr_gui_levels_open(const ImGuiContext &g);
const ImGuiWindow *wr_gui_top_of(const ImGuiContext &g);
bool wr_gui_is_dialog(const ImGuiWindow *window);
bool wr_gui_is_list(const ImGuiWindow *window); /* within a part */
/* Can the keys come to it now? While a popup is open only to what is in it. */
bool wr_gui_reachable(const ImGuiContext &g, const WrKeyStop *stop);
/* Of the last frame; NULL: it was not there. */
const WrKeyStop *wr_gui_find_stop(const WrFocus *focus, ImGuiID id);

/* ---- gui_imgui_focus_keys.cpp ---- */
/* The ring comes to a stop of the last frame. */
void wr_gui_go_to(WrFocus *focus, const WrKeyStop *stop);
/* Of a group Tab comes to the chosen one, or to the first. */
const WrKeyStop *wr_gui_entrance(const ImGuiContext &g, const WrFocus *focus,
                                 const WrKeyStop *stop);
/* The first key that waits is settled. */
void wr_gui_take_key(WrFocus *focus);
