/* Fields to draw on and to point at. */
#include "ui/gui/gui_imgui.h"

extern "C" WrPad wr_gui_pad_begin(const char *id, double w, double h)
try {
    WrGui *gui = wr_gui_current();
    float wide = w > 0 ? (float)w : ImGui::GetContentRegionAvail().x;
    ImVec2 at = ImGui::GetCursorScreenPos(), end(at.x + wide, at.y + (float)h);
    ImVec2 pointer = gui->pointer;
    ImGui::InvisibleButton(id, ImVec2(wide, (float)h));
    ImDrawList *list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, end, wr_gui_colour_of(WR_COLOUR_FIELD));
    wr_gui_edge(list, at, end);
    list->PushClipRect(ImVec2(at.x + 1, at.y + 1), ImVec2(end.x - 1, end.y - 1), true);
    gui->pad = list;
    return WrPad{ (double)at.x,           (double)at.y,
                  (double)wide,           h,
                  (double)pointer.x,      (double)pointer.y,
                  ImGui::IsItemHovered(), ImGui::IsItemActivated(),
                  ImGui::IsItemActive(),  ImGui::IsItemDeactivated() };
}
WR_CAUGHT(WrPad{})

extern "C" void wr_gui_pad_end(void)
{
    WrGui *gui = wr_gui_current();
    if (gui->pad) gui->pad->PopClipRect();
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
