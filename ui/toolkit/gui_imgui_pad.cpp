/* Pads: areas for custom drawing and pointing. */
#include "ui/toolkit/gui_imgui.h"

#include <imgui_internal.h>

/* Pointer of the keyboard. */
static void draw_cross(ImDrawList *list, const WrFocus *focus)
{
    const float arm = (float)wr_gui_px(7), half = (float)wr_gui_px(1) / 2;
    const ImVec2 at = focus->pad_at;
    const ImU32 ink = wr_gui_colour_of(focus->pad_held ? WR_COLOUR_RAISE : WR_COLOUR_FOCUS);
    list->AddRectFilled(ImVec2(at.x - arm, at.y - half), ImVec2(at.x + arm, at.y + half), ink);
    list->AddRectFilled(ImVec2(at.x - half, at.y - arm), ImVec2(at.x + half, at.y + arm), ink);
}

extern "C" WrPad wr_gui_pad_begin(const char *id, double w, double h)
try {
    WrGui *gui = wr_gui_current();
    float wide = w > 0 ? (float)w : ImGui::GetContentRegionAvail().x;
    ImVec2 at = ImGui::GetCursorScreenPos(), end(at.x + wide, at.y + (float)h);
    ImVec2 pointer = gui->pointer;
    ImGui::InvisibleButton(id, ImVec2(wide, (float)h));
    const ImGuiID item = ImGui::GetItemID();
    wr_gui_stop(WR_STOP_PAD, false);
    WrFocus *focus = &gui->focus;
    const bool keys = wr_gui_focused(item), was = focus->pad_down == item;
    const bool down = keys && focus->pad_held;
    if (keys) pointer = ImVec2(at.x + focus->pad_x * wide, at.y + focus->pad_y * (float)h);
    if (down) focus->pad_down = item;
    else if (was) focus->pad_down = 0;
    focus->pad_cross = keys;
    focus->pad_at = pointer;
    ImDrawList *list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, end, wr_gui_colour_of(WR_COLOUR_FIELD));
    wr_gui_edge(list, at, end);
    list->PushClipRect(ImVec2(at.x + 1, at.y + 1), ImVec2(end.x - 1, end.y - 1), true);
    gui->pad = list;
    return WrPad{ (double)at.x,
                  (double)at.y,
                  (double)wide,
                  h,
                  (double)pointer.x,
                  (double)pointer.y,
                  keys || ImGui::IsItemHovered(),
                  (down && !was) || ImGui::IsItemActivated(),
                  down || ImGui::IsItemActive(),
                  (was && !down) || ImGui::IsItemDeactivated() };
}
WR_CAUGHT(WrPad{})

extern "C" void wr_gui_pad_end(void)
{
    WrGui *gui = wr_gui_current();
    if (gui->pad && gui->focus.pad_cross) draw_cross(gui->pad, &gui->focus);
    if (gui->pad) gui->pad->PopClipRect();
    gui->focus.pad_cross = false;
    gui->pad = NULL;
}

extern "C" void wr_gui_swatch(WrColour colour, double radius, double tall)
try {
    const float r = (float)radius, frame = ImGui::GetFrameHeight();
    ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::Dummy(ImVec2(2 * r, tall > (double)frame ? (float)tall : frame));
    ImGui::GetWindowDrawList()->AddCircleFilled(ImVec2(at.x + r, at.y + frame / 2), r,
                                                wr_gui_colour_of(colour));
}
WR_CAUGHT()

extern "C" void wr_gui_group_begin(void)
{
    ImGui::BeginGroup();
}

extern "C" void wr_gui_group_end(void)
{
    ImGui::EndGroup();
}
