/* Scrolling areas for custom text drawing. */
#include "ui/toolkit/gui_imgui.h"
#include "ui/toolkit/gui_page.h"

extern "C" WrGuiPage wr_gui_page_begin(const char *id, double wide, double tall)
try {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::PushStyleColor(ImGuiCol_ChildBg, wr_gui_colour_u32(WR_COLOUR_FIELD));
    ImGui::BeginChild(id, ImVec2(wide > 0 ? (float)wide : 0, (float)tall), true,
                      ImGuiWindowFlags_AlwaysVerticalScrollbar);
    ImGui::PopStyleColor();
    ImGui::PopStyleVar();
    wr_gui_current()->pad = ImGui::GetWindowDrawList();
    ImVec2 at = ImGui::GetCursorScreenPos(), pointer = ImGui::GetIO().MousePos;
    ImVec2 window = ImGui::GetWindowPos();
    bool hovered = ImGui::IsWindowHovered();
    return WrGuiPage{ (double)at.x,
                      (double)at.y,
                      (double)ImGui::GetContentRegionAvail().x,
                      (double)window.y,
                      (double)(window.y + ImGui::GetWindowHeight()),
                      (double)ImGui::GetScrollY(),
                      (double)pointer.x,
                      (double)pointer.y,
                      hovered,
                      hovered && ImGui::IsMouseClicked(0) };
}
WR_CAUGHT(WrGuiPage{})

extern "C" bool wr_gui_page_stop(int index, double x, double y, double w, double h)
try {
    ImGui::PushID(index);
    const ImGuiID id = ImGui::GetID("place");
    ImGui::PopID();
    wr_gui_stop_at(WR_STOP_PRESS, id, false, ImVec2((float)x, (float)y),
                   ImVec2((float)(x + w), (float)(y + h)));
    return wr_gui_focus_pressed(id);
}
WR_CAUGHT(false)

extern "C" void wr_gui_page_image(SDL_Texture *texture, double x, double y, double w, double h)
{
    ImVec2 low((float)x, (float)y), high((float)(x + w), (float)(y + h));
    ImDrawList *list = wr_gui_current()->pad;
    if (texture) list->AddImage(wr_gui_texture_id(texture), low, high);
    wr_gui_edge(list, low, high);
}

extern "C" void wr_gui_page_end(double height, double scroll)
{
    wr_gui_current()->pad = nullptr;
    ImGui::Dummy(ImVec2(1, (float)height));
    if (scroll >= 0) ImGui::SetScrollY((float)scroll);
    wr_gui_stop_scrolled();
    wr_gui_count_space();
    ImGui::EndChild();
}

extern "C" void wr_gui_column_begin(const char *id, double wide, double tall)
try {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding,
                        ImVec2((float)wr_gui_px(8), (float)wr_gui_px(8)));
    ImGui::BeginChild(id, ImVec2((float)wide, (float)tall), true);
    ImGui::PopStyleVar();
}
WR_CAUGHT()
