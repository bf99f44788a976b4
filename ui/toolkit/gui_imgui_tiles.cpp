/* Picture tiles, fields with a hint, foldable headings. */
#include "ui/toolkit/gui_imgui.h"

#include <imgui_internal.h>

#include <math.h>

static float px(double units)
{
    return (float)wr_gui_px(units);
}

static void put_picture(ImDrawList *list, SDL_Texture *texture, ImVec2 at, ImVec2 end)
{
    list->AddRectFilled(at, end, wr_gui_colour_of(WR_COLOUR_FIELD));
    if (texture) list->AddImage(wr_gui_texture_id(texture), at, end);
}

extern "C" int wr_gui_tile(const char *id, SDL_Texture *texture, double side, bool selected,
                           bool marked)
try {
    float s = (float)side;
    ImVec2 at = ImGui::GetCursorScreenPos(), end(at.x + s, at.y + s);
    bool pressed = ImGui::InvisibleButton(id, ImVec2(s, s));
    wr_gui_stop(WR_STOP_TILE, selected);
    bool hovered = ImGui::IsItemHovered();
    bool menu = (hovered && ImGui::IsMouseClicked(1)) || wr_gui_focus_menu(ImGui::GetItemID());
    ImDrawList *list = ImGui::GetWindowDrawList();
    put_picture(list, texture, at, end);
    if (selected) {
        float w = px(2);
        ImU32 ink = wr_gui_colour_of(WR_COLOUR_ACCENT);
        list->AddRectFilled(at, ImVec2(end.x, at.y + w), ink);
        list->AddRectFilled(ImVec2(at.x, end.y - w), end, ink);
        list->AddRectFilled(at, ImVec2(at.x + w, end.y), ink);
        list->AddRectFilled(ImVec2(end.x - w, at.y), end, ink);
    } else {
        wr_gui_edge(list, at, end);
        if (hovered) list->AddRectFilled(at, end, wr_gui_colour_of(0x28ffffffu));
    }
    if (marked) {
        ImFont *font = ImGui::GetFont();
        float size = wr_gui_size_of(font) * 0.8f;
        ImVec2 wide = font->CalcTextSizeA(size, FLT_MAX, 0, wr_gui_icon(WR_ICON_STAR));
        ImVec2 where(end.x - wide.x - px(2), at.y + px(2));
        list->AddText(font, size, ImVec2(where.x + 1, where.y + 1), wr_gui_colour_of(0xc0000000u),
                      wr_gui_icon(WR_ICON_STAR));
        list->AddText(font, size, where, wr_gui_colour_of(WR_COLOUR_CELL),
                      wr_gui_icon(WR_ICON_STAR));
    }
    return menu ? 2 : pressed ? 1 : 0;
}
WR_CAUGHT(0)

extern "C" void wr_gui_centre(double side)
{
    float up = roundf(((float)side - ImGui::GetFrameHeight()) / 2.0f);
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() - up);
}

extern "C" void wr_gui_centre_end(double side)
{
    float up = roundf(((float)side - ImGui::GetFrameHeight()) / 2.0f);
    ImGui::GetCurrentWindow()->DC.CursorPosPrevLine.y += up; /* for content in the same line */
}

extern "C" bool wr_gui_will_see(double side)
{
    return ImGui::IsRectVisible(ImVec2((float)side, (float)side));
}

extern "C" bool wr_gui_hint_field(const char *id, const char *hint, double width, char *text,
                                  size_t size)
try {
    ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::SetNextItemWidth(width > 0 ? (float)width : -1.0f);
    float wide = ImGui::CalcItemWidth();
    if (wr_gui_focus_pressed(ImGui::GetID(id))) ImGui::SetKeyboardFocusHere();
    bool changed = ImGui::InputTextWithHint(id, wr_gui_said(hint), text, size);
    wr_gui_stop(WR_STOP_TEXT, false);
    wr_gui_edge(ImGui::GetWindowDrawList(), at,
                ImVec2(at.x + wide, at.y + ImGui::GetFrameHeight()));
    return changed;
}
WR_CAUGHT(false)

extern "C" bool wr_gui_fold(const char *label, bool open)
try {
    ImGui::PushStyleColor(ImGuiCol_Header, wr_gui_colour_of(0));
    ImGui::PushStyleColor(ImGuiCol_HeaderHovered, wr_gui_colour_of(WR_COLOUR_BUTTON));
    ImGui::PushStyleColor(ImGuiCol_HeaderActive, wr_gui_colour_of(WR_COLOUR_BUTTON));
    ImGui::PushStyleColor(ImGuiCol_Text, wr_gui_colour_of(WR_COLOUR_LABEL));
    ImGui::PushFont(wr_gui_current()->fonts[WR_FONT_SMALL]);
    char said[320];
    if (wr_gui_reports_all) ImGui::SetNextItemOpen(true);
    bool shown = ImGui::CollapsingHeader(wr_gui_labelled(label, said),
                                         open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    wr_gui_stop(WR_STOP_PRESS, false);
    ImGui::PopFont();
    ImGui::PopStyleColor(4);
    return shown;
}
WR_CAUGHT(false)

extern "C" void wr_gui_mark(WrColour colour)
try {
    ImVec2 at = ImGui::GetCursorScreenPos();
    float h = ImGui::GetFrameHeight();
    ImGui::Dummy(ImVec2(px(7), h));
    ImGui::GetWindowDrawList()->AddRectFilled(ImVec2(at.x, at.y + px(2)),
                                              ImVec2(at.x + px(6), at.y + h - px(2)),
                                              wr_gui_colour_of(colour), px(2));
}
WR_CAUGHT()

extern "C" void wr_gui_width_at_least(double units)
try {
    ImGui::Dummy(ImVec2(px(units), 0));
}
WR_CAUGHT()
