/* Choice of one of several side by side: segments and tabs. */
#include "ui/toolkit/gui_imgui.h"

#include <imgui_internal.h>

#include <math.h>

static float px(double units)
{
    return (float)wr_gui_px(units);
}

static bool segment(const char *id, const char *said, ImVec2 size, WrColour ground, bool on)
{
    ImDrawList *list = ImGui::GetWindowDrawList();
    const ImVec2 at = ImGui::GetCursorScreenPos(), end(at.x + size.x, at.y + size.y);
    const ImVec2 text = ImGui::CalcTextSize(said);
    bool pressed = ImGui::InvisibleButton(id, size);
    wr_gui_stop(WR_STOP_SEGMENT, on);
    list->AddRectFilled(at, end, wr_gui_colour_of(WR_COLOUR_FIELD));
    if (on)
        list->AddRectFilled(ImVec2(at.x + 1, at.y + 1), ImVec2(end.x - 1, end.y - 1),
                            wr_gui_colour_of(ground));
    WrColour ink = on                       ? WR_COLOUR_STRONG
                   : ImGui::IsItemHovered() ? WR_COLOUR_TEXT
                                            : WR_COLOUR_LABEL;
    list->AddText(
        ImVec2(at.x + roundf((size.x - text.x) / 2), at.y + roundf((size.y - text.y) / 2)),
        wr_gui_colour_of(ink), said);
    wr_gui_fits_window(said);
    return pressed;
}

/* In one row; more tightly if there is little room, and in several rows if there is less. */
extern "C" bool wr_gui_segments(const char *id, const char *const *items, const WrColour *colours,
                                int count, int *index)
try {
    bool changed = false;
    ImGui::PushID(id);
    float h = ImGui::GetFrameHeight(), pad = px(10), width = 0;
    for (int i = 0; i < count; i++) width += ImGui::CalcTextSize(wr_gui_said(items[i])).x;
    float room = wr_gui_row_room(width + 2 * pad * (float)count);
    if (width + 2 * pad * (float)count > room) pad = floorf((room - width) / (2 * (float)count));
    if (pad < px(4)) pad = px(4);
    ImVec2 start = ImGui::GetCursorScreenPos(), end = start;
    for (int i = 0; i < count; i++) {
        const char *said = wr_gui_said(items[i]);
        float w = ImGui::CalcTextSize(said).x + 2 * pad;
        bool next = i > 0 && end.x + w > start.x + room + 1;
        if (next) wr_gui_edge(ImGui::GetWindowDrawList(), start, end);
        if (next) start = end = ImGui::GetCursorScreenPos();
        else if (i) ImGui::SameLine(0.0f, 0.0f);
        if (segment(items[i], said, ImVec2(w, h), colours ? colours[i] : WR_COLOUR_SELECTED,
                    i == *index)) {
            changed = i != *index;
            *index = i;
        }
        end = ImVec2(end.x + w, start.y + h);
    }
    wr_gui_edge(ImGui::GetWindowDrawList(), start, end);
    ImGui::PopID();
    return changed;
}
WR_CAUGHT(false)

static float tabs_wide(const char *const *items, int count)
{
    float wide = 0;
    for (int i = 0; i < count; i++) wide += ImGui::CalcTextSize(wr_gui_said(items[i])).x;
    return wide;
}

/* Two rows if even the small font leaves hardly a gap. */
extern "C" int wr_gui_tab_rows(const char *const *items, int count, double width)
try {
    ImGui::PushFont(wr_gui_current()->fonts[WR_FONT_SMALL]);
    bool tight = tabs_wide(items, count) + px(8) * (float)count > (float)width;
    ImGui::PopFont();
    return tight && count > 2 ? 2 : 1;
}
WR_CAUGHT(1)

static bool tab(const char *label, ImVec2 place, ImVec2 size, bool on)
{
    ImDrawList *list = ImGui::GetWindowDrawList();
    ImGui::SetCursorPos(place);
    ImVec2 at = ImGui::GetCursorScreenPos();
    bool pressed = ImGui::InvisibleButton(label, size);
    wr_gui_stop(WR_STOP_TAB, on);
    if (on) {
        ImVec2 end(at.x + size.x, at.y + size.y);
        list->AddRectFilled(at, end, wr_gui_colour_of(WR_COLOUR_PANEL));
        list->AddRectFilled(at, ImVec2(end.x, at.y + px(2)), wr_gui_colour_of(WR_COLOUR_ACCENT));
    }
    const char *said = wr_gui_said(label);
    ImVec2 text = ImGui::CalcTextSize(said);
    wr_gui_fits(said, text.x, size.x);
    bool bright = on || ImGui::IsItemHovered();
    list->AddText(
        ImVec2(at.x + roundf((size.x - text.x) / 2), at.y + roundf((size.y - text.y) / 2)),
        wr_gui_colour_of(bright ? WR_COLOUR_STRONG : WR_COLOUR_LABEL), said);
    return pressed;
}

extern "C" bool wr_gui_tabs(const char *id, const char *const *items, int count, int *index)
try {
    bool changed = false;
    ImGui::PushID(id);
    ImDrawList *list = ImGui::GetWindowDrawList();
    ImVec2 origin = ImGui::GetWindowPos();
    float width = ImGui::GetWindowWidth(), h = px(32);
    int rows = wr_gui_tab_rows(items, count, (double)width), each = (count + rows - 1) / rows;
    /* over the padding */
    list->PushClipRect(origin, ImVec2(origin.x + width, origin.y + h * (float)rows));
    bool small = rows > 1 || tabs_wide(items, count) + px(6) * (float)count > width;
    if (small) ImGui::PushFont(wr_gui_current()->fonts[WR_FONT_SMALL]);
    for (int row = 0; row < rows; row++) {
        const char *const *first = items + row * each;
        int n = count - row * each < each ? count - row * each : each;
        float gap = (width - tabs_wide(first, n)) / (float)n, end = 0;
        for (int i = 0; i < n; i++) {
            float x0 = roundf(end);
            end += ImGui::CalcTextSize(wr_gui_said(first[i])).x + gap;
            ImVec2 place(x0, h * (float)row), size(roundf(end) - x0, h);
            if (!tab(first[i], place, size, row * each + i == *index)) continue;
            changed = row * each + i != *index;
            *index = row * each + i;
        }
    }
    if (small) ImGui::PopFont();
    list->PopClipRect();
    ImGui::SetCursorPosY(h * (float)rows + px(12));
    ImGui::PopID();
    return changed;
}
WR_CAUGHT(false)
