/* Rows that contain widgets, pictures, bars. */
#include "ui/toolkit/gui_imgui.h"

#include <imgui_internal.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

static float px(double units)
{
    return (float)wr_gui_px(units);
}

/* Full width of the window, including its padding. */
static void full_width(float *left, float *right)
{
    const ImGuiWindow *window = ImGui::GetCurrentWindow();
    *left = window->Pos.x;
    *right = window->Pos.x + window->Size.x - window->ScrollbarSizes.x;
}

extern "C" WrRow wr_gui_row_begin(int id, double height_units, bool selected)
try {
    WrGui *gui = wr_gui_current();
    ImGui::PushID(id);
    float left, right, height = px(height_units);
    full_width(&left, &right);
    ImVec2 at = ImGui::GetCursorScreenPos();
    gui->row_left = left;
    gui->row_right = right;
    gui->row_top = at.y;
    gui->row_height = height;
    ImDrawList *list = ImGui::GetWindowDrawList();
    const ImRect &inner = ImGui::GetCurrentWindow()->InnerRect;
    ImGui::PushClipRect(ImVec2(left, inner.Min.y), ImVec2(right, inner.Max.y), false);
    ImGui::SetCursorScreenPos(ImVec2(left, at.y));
    bool released = ImGui::InvisibleButton("row", ImVec2(right - left, height));
    bool hovered = ImGui::IsItemHovered(), held = ImGui::IsItemActive();
    bool doubled = hovered && ImGui::IsMouseDoubleClicked(0);
    wr_gui_stop(WR_STOP_ROW, false);
    bool menu = (hovered && ImGui::IsMouseClicked(1)) || wr_gui_focus_menu(ImGui::GetItemID());
    bool moved = ImGui::IsMouseDragPastThreshold(0, px(5));
    ImGui::SetItemAllowOverlap();
    WrColour ground = selected ? WR_COLOUR_ROW_SELECTED : hovered ? WR_COLOUR_ROW_HOT : 0;
    if (ground)
        list->AddRectFilled(ImVec2(left, at.y), ImVec2(right, at.y + height),
                            wr_gui_colour_of(ground));
    list->AddRectFilled(ImVec2(left, at.y + height - 1), ImVec2(right, at.y + height),
                        wr_gui_colour_of(WR_COLOUR_POPUP));
    bool was = gui->row_drag != 0 && gui->row_drag == ImGui::GetID("row");
    if (held && moved) gui->row_drag = ImGui::GetID("row");
    bool dropped = was && !held;
    if (dropped) gui->row_drag = 0;
    return WrRow{ (double)at.y, (double)height, (double)ImGui::GetIO().MousePos.y, released && !was,
                  doubled,      menu,           held && gui->row_drag != 0,        dropped };
}
WR_CAUGHT(WrRow{})

extern "C" void wr_gui_row_at(double x, double tall)
{
    const WrGui *gui = wr_gui_current();
    float h = tall > 0 ? (float)tall : ImGui::GetFrameHeight();
    ImGui::SetCursorScreenPos(
        ImVec2(gui->row_left + (float)x, gui->row_top + floorf((gui->row_height - 1 - h) / 2)));
}

extern "C" void wr_gui_row_see(void)
try {
    ImGui::ScrollToItem(ImGuiScrollFlags_KeepVisibleEdgeY);
}
WR_CAUGHT()

extern "C" double wr_gui_row_width(void)
{
    return (double)(wr_gui_current()->row_right - wr_gui_current()->row_left);
}

extern "C" void wr_gui_row_end(void)
try {
    const WrGui *gui = wr_gui_current();
    const ImGuiWindow *window = ImGui::GetCurrentWindow();
    ImGui::PopClipRect();
    ImGui::SetCursorScreenPos(
        ImVec2(window->Pos.x + window->WindowPadding.x, gui->row_top + gui->row_height));
    ImGui::PopID();
}
WR_CAUGHT()

extern "C" void wr_gui_drop_line(double y)
{
    float left, right, at = roundf((float)y);
    full_width(&left, &right);
    ImGui::GetForegroundDrawList()->AddRectFilled(
        ImVec2(left, at - px(1)), ImVec2(right, at + px(1)), wr_gui_colour_of(WR_COLOUR_ACCENT));
}

extern "C" void wr_gui_text_cut(WrFont font, WrColour colour, const char *text, double width)
try {
    ImFont *face = wr_gui_current()->fonts[font];
    float size = wr_gui_size_of(face);
    char cut[300];
    snprintf(cut, sizeof cut, "%s", wr_gui_said(text));
    wr_gui_fits(text, face->CalcTextSizeA(size, FLT_MAX, 0, cut).x, (float)width);
    if ((double)face->CalcTextSizeA(size, FLT_MAX, 0, cut).x > width) {
        const char *rest = cut;
        float room = (float)width - face->CalcTextSizeA(size, FLT_MAX, 0, "...").x;
        face->CalcTextSizeA(size, room > 0 ? room : 1, 0, cut, nullptr, &rest);
        size_t length = (size_t)(rest - cut);
        if (length > sizeof cut - 4) length = sizeof cut - 4;
        memcpy(cut + length, "...", 4);
    }
    WrGui *gui = wr_gui_current();
    const bool was = gui->as_it_is;
    gui->as_it_is = true; /* already translated */
    wr_gui_text(font, colour, cut);
    gui->as_it_is = was;
}
WR_CAUGHT()

/* The longest word must fit. */
extern "C" void wr_gui_text_within(WrFont font, WrColour colour, const char *text, double width)
try {
    ImFont *face = wr_gui_current()->fonts[font];
    const char *said = wr_gui_said(text);
    for (const char *at = said; *at;) {
        const char *end = at + strcspn(at, " -");
        if (*end == '-') end++;
        wr_gui_fits(text, face->CalcTextSizeA(wr_gui_size_of(face), FLT_MAX, 0, at, end).x,
                    (float)width);
        at = end + strspn(end, " ");
    }
    ImGui::PushFont(face);
    ImGui::PushStyleColor(ImGuiCol_Text, wr_gui_colour_of(colour));
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + (float)width);
    ImGui::TextUnformatted(said);
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    ImGui::PopFont();
}
WR_CAUGHT()

extern "C" void wr_gui_image(SDL_Texture *texture, double w, double h)
try {
    ImVec2 at = ImGui::GetCursorScreenPos(), end(at.x + (float)w, at.y + (float)h);
    ImGui::Dummy(ImVec2((float)w, (float)h));
    ImDrawList *list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, end, wr_gui_colour_of(WR_COLOUR_FIELD));
    if (texture) list->AddImage(wr_gui_texture_id(texture), at, end);
    wr_gui_edge(list, at, end);
}
WR_CAUGHT()

extern "C" void wr_gui_ink(SDL_Texture *texture, double w, double h, WrColour colour)
try {
    ImVec2 at = ImGui::GetCursorScreenPos(), end(at.x + (float)w, at.y + (float)h);
    ImGui::Dummy(ImVec2((float)w, (float)h));
    if (texture)
        ImGui::GetWindowDrawList()->AddImage(wr_gui_texture_id(texture), at, end, ImVec2(0, 0),
                                             ImVec2(1, 1), wr_gui_colour_of(colour));
}
WR_CAUGHT()

extern "C" bool wr_gui_list_button(const char *id, const char *label, double width)
try {
    ImVec2 at = ImGui::GetCursorScreenPos();
    float h = ImGui::GetFrameHeight(), pad = ImGui::GetStyle().FramePadding.x, arrow = px(4);
    ImVec2 end(at.x + (float)width, at.y + h);
    ImGui::PushStyleColor(ImGuiCol_Button, wr_gui_colour_of(WR_COLOUR_FIELD));
    ImGui::PushID(id);
    bool pressed = ImGui::Button("##list", ImVec2((float)width, h));
    wr_gui_stop(WR_STOP_PRESS, false);
    ImGui::PopID();
    ImGui::PopStyleColor();
    ImDrawList *list = ImGui::GetWindowDrawList();
    wr_gui_edge(list, at, end);
    float right = end.x - px(13), middle = roundf(at.y + h / 2 - arrow / 2);
    const ImVec4 clip(at.x, at.y, right - arrow - px(2), end.y);
    const char *said = wr_gui_said(label);
    list->AddText(ImGui::GetFont(), ImGui::GetFontSize(),
                  ImVec2(at.x + pad, at.y + ImGui::GetStyle().FramePadding.y),
                  wr_gui_colour_of(WR_COLOUR_TEXT), said, nullptr, 0.0f, &clip);
    list->AddTriangleFilled(ImVec2(right - arrow, middle), ImVec2(right + arrow, middle),
                            ImVec2(right, middle + arrow), wr_gui_colour_of(WR_COLOUR_LABEL));
    return pressed;
}
WR_CAUGHT(false)

extern "C" bool wr_gui_image_button(const char *id, SDL_Texture *texture, double w, double h,
                                    bool chosen)
try {
    ImVec2 at = ImGui::GetCursorScreenPos(), end(at.x + (float)w, at.y + (float)h);
    bool pressed = ImGui::InvisibleButton(id, ImVec2((float)w, (float)h));
    wr_gui_stop(WR_STOP_PRESS, false);
    ImDrawList *list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, end, wr_gui_colour_of(WR_COLOUR_FIELD));
    if (texture) list->AddImage(wr_gui_texture_id(texture), at, end);
    wr_gui_edge(list, at, end);
    if (chosen) {
        float out = px(2);
        list->AddRect(ImVec2(at.x - out, at.y - out), ImVec2(end.x + out, end.y + out),
                      wr_gui_colour_of(WR_COLOUR_ACCENT), 0, 0, px(2));
    }
    return pressed;
}
WR_CAUGHT(false)

extern "C" bool wr_gui_find_button(const char *label, const char *keys, double width)
try {
    ImFont *small = wr_gui_current()->fonts[WR_FONT_SMALL];
    float h = roundf(ImGui::GetTextLineHeight() + px(8)), pad = px(8);
    ImVec2 bar = ImGui::GetWindowSize(), where = ImGui::GetWindowPos();
    ImVec2 at(ImGui::GetCursorScreenPos().x, where.y + roundf((bar.y - h) / 2));
    ImGui::SetCursorScreenPos(at);
    bool pressed = ImGui::InvisibleButton(label, ImVec2((float)width, h));
    wr_gui_stop(WR_STOP_PRESS, false);
    label = wr_gui_said(label);
    ImVec2 end(at.x + (float)width, at.y + h);
    ImDrawList *list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, end, wr_gui_colour_of(WR_COLOUR_FIELD));
    wr_gui_edge(list, at, end);
    ImU32 ink = wr_gui_colour_of(ImGui::IsItemHovered() ? WR_COLOUR_TEXT : WR_COLOUR_LABEL);
    ImVec2 size = small->CalcTextSizeA(wr_gui_size_of(small), FLT_MAX, 0, keys);
    float y = at.y + floorf((h - wr_gui_size_of(small)) / 2);
    wr_gui_fits(label, small->CalcTextSizeA(wr_gui_size_of(small), FLT_MAX, 0, label).x + size.x,
                (float)width - 3 * pad);
    list->AddText(small, wr_gui_size_of(small), ImVec2(at.x + pad, y), ink, label);
    list->AddText(small, wr_gui_size_of(small), ImVec2(end.x - pad - size.x, y),
                  wr_gui_colour_of(WR_COLOUR_FAINT), keys);
    return pressed;
}
WR_CAUGHT(false)

extern "C" bool wr_gui_glyph(const char *id, const char *icon, double units, WrColour colour)
try {
    float side = px(units);
    ImVec2 at = ImGui::GetCursorScreenPos();
    bool pressed = ImGui::InvisibleButton(id, ImVec2(side, side));
    wr_gui_stop(WR_STOP_PRESS, false);
    bool hovered = ImGui::IsItemHovered();
    icon = wr_gui_icon(icon);
    ImVec2 size = ImGui::CalcTextSize(icon);
    ImGui::GetWindowDrawList()->AddText(
        ImVec2(at.x + roundf((side - size.x) / 2), at.y + roundf((side - size.y) / 2)),
        ImGui::GetColorU32(wr_gui_colour_of(hovered ? WR_COLOUR_STRONG : colour)), icon);
    return pressed;
}
WR_CAUGHT(false)

extern "C" void wr_gui_progress(double width, double fraction)
try {
    double f = fraction < 0 ? 0.25 : fraction > 1 ? 1 : fraction;
    float w = width > 0 ? (float)width : ImGui::GetContentRegionAvail().x;
    float h = ImGui::GetFrameHeight(), bar = px(8);
    ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::Dummy(ImVec2(w, h));
    at.y += floorf((h - bar) / 2);
    ImDrawList *list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, ImVec2(at.x + w, at.y + bar), wr_gui_colour_of(WR_COLOUR_FIELD));
    double t = fmod(ImGui::GetTime(), 1.6) / 0.8; /* back and forth */
    float from = fraction < 0 ? (float)(0.75 * (t < 1 ? t : 2 - t)) : 0.0f, long_way = w - 2;
    list->AddRectFilled(ImVec2(at.x + 1 + roundf(long_way * from), at.y + 1),
                        ImVec2(at.x + 1 + roundf(long_way * (from + (float)f)), at.y + bar - 1),
                        wr_gui_colour_of(WR_COLOUR_ACCENT));
    wr_gui_edge(list, at, ImVec2(at.x + w, at.y + bar));
}
WR_CAUGHT()

extern "C" void wr_gui_square(const char *id, double units, const WrColour sides[4])
try {
    float side = px(units), gap = px(6), line = px(2);
    ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton(id, ImVec2(side, side));
    wr_gui_stop(WR_STOP_PRESS, false);
    ImDrawList *list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, ImVec2(at.x + side, at.y + side), wr_gui_colour_of(WR_COLOUR_CHIP),
                        px(3));
    float x0 = at.x + gap, y0 = at.y + gap, x1 = at.x + side - gap, y1 = at.y + side - gap;
    list->AddRectFilled(ImVec2(x0, y0), ImVec2(x0 + line, y1), wr_gui_colour_of(sides[0]));
    list->AddRectFilled(ImVec2(x1 - line, y0), ImVec2(x1, y1), wr_gui_colour_of(sides[1]));
    list->AddRectFilled(ImVec2(x0 + line, y0), ImVec2(x1 - line, y0 + line),
                        wr_gui_colour_of(sides[2]));
    list->AddRectFilled(ImVec2(x0 + line, y1 - line), ImVec2(x1 - line, y1),
                        wr_gui_colour_of(sides[3]));
}
WR_CAUGHT()
