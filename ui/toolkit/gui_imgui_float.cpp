/* Floating panels. */
#include "ui/toolkit/gui_imgui.h"

#include <imgui_internal.h>
#include <math.h>
#include <stdio.h>

#define HEAD_UNITS 30
#define LEAST_WIDTH 230 /* units */
#define LEAST_HEIGHT 160
#define CORNER_UNITS 14

static float px(double units)
{
    return (float)wr_gui_px(units);
}

static int clamp_int(int x, int low, int high)
{
    return x > high && high >= low ? high : x < low ? low : x;
}

static void keep_inside(SDL_Rect *rect, const SDL_Rect *bounds)
{
    rect->w = clamp_int(rect->w, wr_gui_px(LEAST_WIDTH), bounds->w);
    rect->h = clamp_int(rect->h, wr_gui_px(LEAST_HEIGHT), bounds->h);
    rect->x = clamp_int(rect->x, bounds->x, bounds->x + bounds->w - rect->w);
    rect->y = clamp_int(rect->y, bounds->y, bounds->y + bounds->h - rect->h);
}

/* While the pointer holds the panel `id`: its new place. True in the frame of the release. */
static bool follow_pointer(WrGui *gui, ImGuiID id, SDL_Rect *rect)
{
    const ImGuiIO &io = ImGui::GetIO();
    if (gui->float_held != id) return false;
    if (!io.MouseDown[0]) {
        gui->float_held = 0;
        return !gui->float_resized;
    }
    const float x = io.MousePos.x - gui->float_from.x, y = io.MousePos.y - gui->float_from.y;
    if (gui->float_resized) rect->w = (int)x - rect->x, rect->h = (int)y - rect->y;
    else rect->x = (int)x, rect->y = (int)y;
    return false;
}

static void hold(WrGui *gui, ImGuiID id, const SDL_Rect *rect, bool resized)
{
    const ImVec2 at = ImGui::GetIO().MousePos;
    gui->float_held = id;
    gui->float_resized = resized;
    gui->float_from = ImVec2(at.x - (float)(rect->x + (resized ? rect->w : 0)),
                             at.y - (float)(rect->y + (resized ? rect->h : 0)));
}

/* The corner that resizes the panel, above its content. */
static void corner(WrGui *gui)
{
    const SDL_Rect *rect = &gui->float_rect;
    const float side = px(CORNER_UNITS);
    const ImVec2 end((float)(rect->x + rect->w), (float)(rect->y + rect->h));
    ImGui::SetCursorScreenPos(ImVec2(end.x - side, end.y - side));
    ImGui::PushStyleColor(ImGuiCol_ChildBg, 0);
    ImGui::BeginChild("##corner", ImVec2(side, side));
    ImGui::PopStyleColor();
    ImGui::InvisibleButton("##resize", ImVec2(side, side));
    const bool hot = ImGui::IsItemHovered() || ImGui::IsItemActive();
    if (ImGui::IsItemActivated()) hold(gui, gui->float_id, rect, true);
    ImGui::GetWindowDrawList()->AddTriangleFilled(
        ImVec2(end.x - px(2), end.y - px(9)), ImVec2(end.x - px(2), end.y - px(2)),
        ImVec2(end.x - px(9), end.y - px(2)),
        wr_gui_colour_u32(hot ? WR_COLOUR_ACCENT : WR_COLOUR_FAINT));
    ImGui::EndChild();
}

extern "C" WrFloat wr_gui_float_begin(const char *label, SDL_Rect *rect, SDL_Rect bounds, bool grab)
try {
    WrGui *gui = wr_gui_current();
    const ImGuiIO &io = ImGui::GetIO();
    char name[96];
    snprintf(name, sizeof name, "##float_%.80s", label);
    const ImGuiID id = ImHashStr(name);
    WrFloat out = {};
    if (grab) {
        gui->float_held = id;
        gui->float_resized = false;
        gui->float_from = ImVec2(px(40), px(HEAD_UNITS) / 2);
        ImGui::ClearActiveID(); /* of the tab */
    }
    out.dropped = follow_pointer(gui, id, rect);
    keep_inside(rect, &bounds);
    ImGui::SetNextWindowPos(ImVec2((float)rect->x, (float)rect->y));
    ImGui::SetNextWindowSize(ImVec2((float)rect->w, (float)rect->h));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
    ImGui::PushStyleColor(ImGuiCol_WindowBg, wr_gui_colour_u32(WR_COLOUR_BAR));
    ImGui::Begin(name, nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoScrollWithMouse);
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(2);
    const float head = px(HEAD_UNITS), icon = px(22);
    const ImVec2 at = ImGui::GetWindowPos();
    ImGui::SetCursorScreenPos(at);
    ImGui::InvisibleButton("##head", ImVec2((float)rect->w - icon - px(8), head));
    if (ImGui::IsItemActivated()) hold(gui, id, rect, false);
    if (ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    ImGui::SetCursorScreenPos(ImVec2(at.x + px(12), at.y + (head - ImGui::GetFrameHeight()) / 2));
    wr_gui_text(WR_FONT_BOLD, WR_COLOUR_STRONG, label);
    ImGui::SetCursorScreenPos(
        ImVec2(at.x + (float)rect->w - icon - px(6), at.y + (head - icon) / 2));
    out.docks = wr_gui_glyph("##dock", WR_ICON_CLOSE, 22, WR_COLOUR_LABEL);
    wr_gui_tip("Docks it among the tabs");
    gui->float_id = id;
    gui->float_rect = *rect;
    out.moving = gui->float_held == id && !gui->float_resized;
    out.room = SDL_Rect{ rect->x + 1, rect->y + (int)head, rect->w - 2, rect->h - (int)head - 1 };
    out.x = (int)io.MousePos.x, out.y = (int)io.MousePos.y;
    gui->floating = true;
    return out;
}
WR_CAUGHT(WrFloat{})

extern "C" void wr_gui_float_end(void)
try {
    wr_gui_current()->floating = false;
    corner(wr_gui_current());
    wr_gui_count_space();
    ImGui::End();
}
WR_CAUGHT()

extern "C" void wr_gui_drop_place(SDL_Rect rect)
{
    const ImVec2 low((float)rect.x, (float)rect.y);
    const ImVec2 high((float)(rect.x + rect.w), (float)(rect.y + rect.h));
    const ImU32 ink = wr_gui_colour_u32(WR_COLOUR_ACCENT);
    ImDrawList *list = ImGui::GetForegroundDrawList();
    const float w = px(2);
    list->AddRectFilled(low, ImVec2(high.x, low.y + w), ink);
    list->AddRectFilled(ImVec2(low.x, high.y - w), high, ink);
    list->AddRectFilled(low, ImVec2(low.x + w, high.y), ink);
    list->AddRectFilled(ImVec2(high.x - w, low.y), high, ink);
}
