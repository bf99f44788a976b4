/* Areas, text, menus and widgets. */
#include "ui/toolkit/gui_imgui.h"
#include "ui/toolkit/words.h"

extern "C" {
#include "system/clock.h"
}

#include <imgui_internal.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#define TIP_SECONDS 0.4f /* pointer rest time before a tip */

static float px(double units)
{
    return (float)wr_gui_px(units);
}

/* ---- areas ---- */

extern "C" void wr_gui_area_begin(const char *name, WrAreaKind kind, SDL_Rect rect,
                                  WrColour background)
try {
    ImGui::SetNextWindowPos(ImVec2((float)rect.x, (float)rect.y));
    ImGui::SetNextWindowSize(ImVec2((float)rect.w, (float)rect.h));
    /* it would end a drag */
    ImGuiWindowFlags flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                             ImGuiWindowFlags_NoSavedSettings |
                             ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav |
                             ImGuiWindowFlags_NoFocusOnAppearing;
    ImVec2 padding(px(12), px(12));
    if (kind == WR_AREA_PANEL) {
        flags &= ~ImGuiWindowFlags_NoScrollbar;
    } else {
        flags |= ImGuiWindowFlags_NoScrollWithMouse;
        float row = ImGui::GetFrameHeight();
        float side = rect.w < rect.h ? roundf(((float)rect.w - px(36)) / 2) : px(12);
        padding = ImVec2(side, rect.w < rect.h ? px(8) : floorf(((float)rect.h - row) / 2));
        if (padding.y < 0) padding.y = 0;
    }
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, padding);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, wr_gui_colour_of(background));
    ImGui::Begin(name, nullptr, flags);
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(2);
}
WR_CAUGHT()

extern "C" void wr_gui_area_end(void)
try {
    wr_gui_stop_scrolled();
    ImGui::End();
}
WR_CAUGHT()

extern "C" void wr_gui_overlay_begin(const char *name, int x, int y, double ax, double ay)
try {
    ImGui::SetNextWindowPos(ImVec2((float)x, (float)y), 0, ImVec2((float)ax, (float)ay));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    ImGui::Begin(name, nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoBackground);
    ImGui::PopStyleVar(2);
}
WR_CAUGHT()

extern "C" void wr_gui_overlay_end(void)
try {
    ImGui::End();
}
WR_CAUGHT()

/* ---- layout ---- */

extern "C" void wr_gui_same_line(double gap_units)
{
    ImGui::SameLine(0.0f, px(gap_units));
}

extern "C" void wr_gui_space(double units)
{
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() + px(units));
}

extern "C" double wr_gui_available(void)
{
    return (double)ImGui::GetContentRegionAvail().x;
}

extern "C" void wr_gui_move_to(double x)
{
    ImGui::SetCursorPosX((float)x);
}

extern "C" double wr_gui_place(void)
{
    return (double)ImGui::GetCursorPosX();
}

extern "C" double wr_gui_width(void)
{
    return (double)ImGui::GetWindowWidth();
}

extern "C" void wr_gui_push_id(int id)
{
    ImGui::PushID(id);
}

extern "C" void wr_gui_pop_id(void)
{
    ImGui::PopID();
}

extern "C" void wr_gui_disable(bool disabled)
{
    ImGui::BeginDisabled(disabled);
}

extern "C" void wr_gui_enable(void)
{
    ImGui::EndDisabled();
}

/* ---- text ---- */

static void text_in(WrFont font, WrColour colour, const char *text, bool wrapped)
{
    ImGui::PushFont(wr_gui_current()->fonts[font]);
    ImGui::PushStyleColor(ImGuiCol_Text, wr_gui_colour_of(colour));
    if (wrapped) ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(wr_gui_icon(wr_gui_said(text)));
    if (wrapped) ImGui::PopTextWrapPos();
    else wr_gui_fits_window(text);
    ImGui::PopStyleColor();
    ImGui::PopFont();
}

/* In a bar without enough room: small, in two lines. */
static bool text_in_lines(WrColour colour, const char *text, float room)
{
    ImFont *small = wr_gui_current()->fonts[WR_FONT_SMALL];
    const char *said = wr_gui_said(text);
    const float size = wr_gui_size_of(small);
    const float tall = small->CalcTextSizeA(size, FLT_MAX, room, said).y;
    if (room < px(60) || tall > ImGui::GetFrameHeight() + px(12)) return false;
    ImVec2 at = ImGui::GetCursorScreenPos();
    float top = at.y + floorf((ImGui::GetFrameHeight() - tall) / 2);
    ImGui::Dummy(ImVec2(room, ImGui::GetFrameHeight()));
    ImGui::GetWindowDrawList()->AddText(small, size, ImVec2(at.x, top), wr_gui_colour_of(colour),
                                        said, nullptr, room);
    return true;
}

extern "C" void wr_gui_text(WrFont font, WrColour colour, const char *text)
try {
    const bool bar = (ImGui::GetCurrentWindow()->Flags & ImGuiWindowFlags_NoScrollWithMouse) != 0;
    const float room = ImGui::GetContentRegionAvail().x;
    if (bar && strchr(text, ' ') && wr_gui_text_width(font, text) > (double)room &&
        text_in_lines(colour, text, room))
        return;
    ImGui::AlignTextToFramePadding();
    text_in(font, colour, text, false);
}
WR_CAUGHT()

extern "C" void wr_gui_text_wrapped(WrFont font, WrColour colour, const char *text)
try {
    char said[WR_WORDS_MESSAGE];
    const bool wrong = colour == WR_COLOUR_BAD && !wr_gui_current()->as_it_is;
    text_in(font, colour, wrong ? wr_words_message(text, said, sizeof said) : text, true);
}
WR_CAUGHT()

extern "C" void wr_gui_heading(const char *text)
try {
    text_in(WR_FONT_SMALL, WR_COLOUR_LABEL, text, false);
}
WR_CAUGHT()

/* A label too long even in the small font is placed above its field. */
extern "C" void wr_gui_label(const char *text)
try {
    ImGui::AlignTextToFramePadding();
    float column = roundf(ImGui::GetWindowContentRegionMax().x * 0.41f);
    float room = column - ImGui::GetCursorPosX() - px(4);
    if (wr_gui_text_width(WR_FONT_TEXT, text) < (double)room) {
        text_in(WR_FONT_TEXT, WR_COLOUR_LABEL, text, false);
    } else {
        ImGui::SetCursorPosY(ImGui::GetCursorPosY() + px(1)); /* onto the line of the others */
        bool fits = wr_gui_text_width(WR_FONT_SMALL, text) <= (double)room;
        text_in(WR_FONT_SMALL, WR_COLOUR_LABEL, text, !fits);
        if (!fits) return;
    }
    ImGui::SameLine(column);
}
WR_CAUGHT()

extern "C" double wr_gui_text_width(WrFont font, const char *text)
{
    ImFont *face = wr_gui_current()->fonts[font];
    return (double)face->CalcTextSizeA(wr_gui_size_of(face), FLT_MAX, 0.0f, wr_gui_said(text)).x;
}

extern "C" double wr_gui_line_height(WrFont font)
{
    return (double)wr_gui_size_of(wr_gui_current()->fonts[font]);
}

/* Seconds the pointer has been on the last item. ImGui's own timer restarts in each frame on an item that overlaps
 * another, such as icons in rows. */
static double rested()
{
    WrGui *gui = wr_gui_current();
    const ImVec2 at = ImGui::GetItemRectMin();
    const int frame = ImGui::GetFrameCount();
    const bool same = at.x == gui->tip_at.x && at.y == gui->tip_at.y && frame - gui->tip_frame <= 1;
    if (!same) gui->tip_since = ImGui::GetTime();
    gui->tip_at = at, gui->tip_frame = frame;
    return ImGui::GetTime() - gui->tip_since;
}

/* True if the pointer has rested on the last item long enough for its tip, or if the ring is on the item with that
   identifier. */
static bool wants_tip(ImGuiID id, const char *text)
{
    if (text && wr_gui_reports_all) wr_gui_said(text);
    if (!text || !text[0] ||
        !(wr_gui_focused(id) || ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)))
        return false;
    if (ImGui::IsMouseDown(0)) return false;
    const bool rests = rested() >= (double)TIP_SECONDS;
    if (!rests) wr_gui_current()->tip_waits = true;
    return rests;
}

/* Position of the tip: beside a menu, so that it covers no entry; left of the right panel, so that it covers no
   neighbouring fields; below the item with the ring, since the pointer is elsewhere. */
static void place_tip(bool focused)
{
    const ImGuiWindow *window = ImGui::GetCurrentWindow();
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const ImVec2 whole = ImGui::GetIO().DisplaySize;
    const bool menu = window->Flags & (ImGuiWindowFlags_Popup | ImGuiWindowFlags_ChildMenu) &&
                      !(window->Flags & ImGuiWindowFlags_Modal);
    const float end = window->Pos.x + window->Size.x, right = end + px(6);
    const bool fits = right + px(320) < whole.x;
    const bool lower = low.y > 0.5f * whole.y;
    if (menu)
        ImGui::SetNextWindowPos(ImVec2(fits ? right : window->Pos.x - px(6), low.y), 0,
                                ImVec2(fits ? 0.0f : 1.0f, 0));
    else if (window->Pos.x > 0.5f * whole.x && end > whole.x - px(24))
        ImGui::SetNextWindowPos(ImVec2(window->Pos.x - px(4), lower ? high.y : low.y), 0,
                                ImVec2(1.0f, lower ? 1.0f : 0.0f));
    else if (focused) ImGui::SetNextWindowPos(ImVec2(low.x, high.y + px(6)));
}

static void show_tip(const char *text)
{
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(10), px(8)));
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(px(300));
    ImGui::TextUnformatted(wr_gui_said(text));
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
    ImGui::PopStyleVar();
}

void wr_gui_tip_of(ImGuiID id, const char *text)
try {
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    const bool grey = g.LastItemData.InFlags & ImGuiItemFlags_Disabled;
    if (grey && wr_gui_current()->grey_why)
        return; /* the common tip of the disabled group is
                                                       shown */
    if (!wants_tip(id, text)) return;
    place_tip(wr_gui_focused(id));
    show_tip(text);
}
WR_CAUGHT()

extern "C" void wr_gui_tip(const char *text)
{
    wr_gui_tip_of(ImGui::GetItemID(), text);
}

/* ---- disabled widgets and their tip ---- */

extern "C" void wr_gui_hold(const char *why)
{
    wr_gui_current()->grey_why = why;
    ImGui::BeginDisabled(why != nullptr);
}

extern "C" void wr_gui_hold_end(void)
try {
    WrGui *gui = wr_gui_current();
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    ImGui::EndDisabled();
    const char *why = gui->grey_why;
    gui->grey_why = nullptr;
    if (why && wr_gui_reports_all) wr_gui_said(why);
    if (!why || !g.HoveredIdDisabled || !ImGui::IsWindowHovered(ImGuiHoveredFlags_ChildWindows))
        return;
    if (g.HoveredIdTimer < TIP_SECONDS) {
        gui->tip_waits = true;
        return;
    }
    const ImGuiWindow *window = ImGui::GetCurrentWindow();
    if (window->Pos.x > 0.5f * g.IO.DisplaySize.x) /* beside the panel, as in place_tip */
        ImGui::SetNextWindowPos(ImVec2(window->Pos.x - px(4), g.IO.MousePos.y), 0,
                                ImVec2(1.0f, 0.5f));
    show_tip(why);
}
WR_CAUGHT()

/* ---- choices and buttons ---- */

static bool chooser_moved()
{
    return wr_gui_key_pressed(SDL_SCANCODE_UP) || wr_gui_key_pressed(SDL_SCANCODE_DOWN) ||
           ImGui::IsWindowAppearing();
}

/* Arrow keys move along an open list, Return accepts: the accepted row, or -1. */
static int choose_by_key(ImGuiID list, int count, int index)
{
    WrGui *gui = wr_gui_current();
    bool appears = ImGui::IsWindowAppearing();
    if (appears || gui->chooser != list) gui->chooser_row = index;
    gui->chooser = list;
    if (wr_gui_key_pressed(SDL_SCANCODE_DOWN) && gui->chooser_row < count - 1) gui->chooser_row++;
    if (wr_gui_key_pressed(SDL_SCANCODE_UP) && gui->chooser_row > 0) gui->chooser_row--;
    bool takes = !appears && wr_gui_return_for_list();
    return takes && gui->chooser_row >= 0 && gui->chooser_row < count ? gui->chooser_row : -1;
}

extern "C" bool wr_gui_choice(const char *id, double width, const char *const *items, int count,
                              int *index)
try {
    bool changed = false;
    ImGui::PushID(id);
    ImGui::SetNextItemWidth(width > 0 ? (float)width : -1.0f);
    ImDrawList *list = ImGui::GetWindowDrawList();
    ImVec2 at = ImGui::GetCursorScreenPos();
    float right = at.x + ImGui::CalcItemWidth() - px(13), arrow = px(4);
    float middle = roundf(at.y + ImGui::GetFrameHeight() / 2 - arrow / 2);
    const char *now = *index >= 0 && *index < count ? wr_gui_said(items[*index]) : "";
    const ImVec2 padding = ImGui::GetStyle().FramePadding;
    const float room = ImGui::CalcItemWidth() - 2 * padding.x;
    float said_wide = ImGui::CalcTextSize(now).x;
    const bool tight = said_wide > room; /* shown in the small font */
    /* Drawn here: a font pushed across BeginCombo would be popped in the list's own window. */
    const ImFont *small = wr_gui_current()->fonts[WR_FONT_SMALL];
    if (tight) said_wide = small->CalcTextSizeA(small->FontSize, FLT_MAX, 0.0f, now).x;
    wr_gui_fits(now, said_wide, tight ? room + padding.x : room);
    const float lower = (ImGui::GetFontSize() - small->FontSize) / 2;
    const ImVec2 place(at.x + padding.x * 0.5f, at.y + padding.y + lower);
    const ImVec4 clip(at.x, at.y, right + px(13), at.y + ImGui::GetFrameHeight());
    const ImGuiID item = ImGui::GetID("##choice");
    wr_gui_stop_at(WR_STOP_CHOICE, item, false, at,
                   ImVec2(right + px(13), at.y + ImGui::GetFrameHeight()));
    const int step = -wr_gui_focus_arrows(item, false);
    if (*index + step >= 0 && *index + step < count && step) {
        *index += step;
        changed = true;
    }
    bool open = ImGui::BeginCombo("##choice", tight ? "" : now,
                                  ImGuiComboFlags_HeightLarge | ImGuiComboFlags_NoArrowButton);
    if (tight)
        list->AddText(small, small->FontSize, place, ImGui::GetColorU32(ImGuiCol_Text), now,
                      nullptr, 0.0f, &clip);
    wr_gui_edge(list, at, ImVec2(right + px(13), at.y + ImGui::GetFrameHeight()));
    if (!tight || place.x + said_wide < right - arrow)
        list->AddTriangleFilled(ImVec2(right - arrow, middle), ImVec2(right + arrow, middle),
                                ImVec2(right, middle + arrow), wr_gui_colour_of(WR_COLOUR_LABEL));
    if (wr_gui_reports_all)
        for (int i = 0; i < count; i++) wr_gui_said(items[i]);
    if (open) {
        int chosen = choose_by_key(ImGui::GetID("rows"), count, *index);
        for (int i = 0; i < count; i++) {
            char label[320];
            const char *row = wr_gui_labelled(items[i], label);
            if (ImGui::Selectable(row, i == wr_gui_current()->chooser_row)) chosen = i;
            if (i == wr_gui_current()->chooser_row && chooser_moved()) ImGui::SetScrollHereY();
        }
        if (chosen >= 0) {
            changed = chosen != *index;
            *index = chosen;
            ImGui::CloseCurrentPopup();
        }
        ImGui::EndCombo();
    }
    ImGui::PopID();
    return changed;
}
WR_CAUGHT(false)

/* The text wraps to further lines below. */
extern "C" bool wr_gui_check(const char *label, bool *value)
try {
    char said[320], box[340];
    float side = ImGui::GetFrameHeight(), gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const char *shown = wr_gui_labelled(label, said), *id = strstr(shown, "##");
    float wide = ImGui::CalcTextSize(shown, nullptr, true).x + side + gap;
    bool wraps = wide > wr_gui_row_room(wide);
    ImVec2 at = ImGui::GetCursorScreenPos();
    snprintf(box, sizeof box, "##box%s", id ? id : label);
    bool changed = ImGui::Checkbox(wraps ? box : shown, value);
    wr_gui_stop(WR_STOP_PRESS, false);
    wr_gui_edge(ImGui::GetWindowDrawList(), at, ImVec2(at.x + side, at.y + side));
    if (!wraps) {
        wr_gui_fits_window(label);
        return changed;
    }
    ImGui::SameLine(0.0f, gap);
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(shown, id);
    ImGui::PopTextWrapPos();
    if (ImGui::IsItemClicked()) *value = !*value, changed = true;
    return changed;
}
WR_CAUGHT(false)

extern "C" bool wr_gui_button(const char *label, bool primary)
try {
    if (primary) {
        ImGui::PushStyleColor(ImGuiCol_Button, wr_gui_colour_of(WR_COLOUR_SELECTED));
        ImGui::PushStyleColor(ImGuiCol_ButtonHovered, wr_gui_colour_of(WR_COLOUR_ACCENT));
    }
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(14), px(5)));
    ImGui::PushStyleVar(ImGuiStyleVar_FrameRounding, px(3));
    char said[320];
    const char *shown = wr_gui_labelled(label, said);
    wr_gui_row_room(ImGui::CalcTextSize(shown, nullptr, true).x + px(28));
    bool pressed = ImGui::Button(shown);
    wr_gui_stop(WR_STOP_PRESS, false);
    wr_gui_fits_window(label);
    ImGui::PopStyleVar(2);
    if (primary) ImGui::PopStyleColor(2);
    return pressed;
}
WR_CAUGHT(false)

extern "C" bool wr_gui_icon_button(const char *id, const char *icon, double units, bool selected)
try {
    float side = px(units);
    ImVec2 at = ImGui::GetCursorScreenPos();
    bool pressed = ImGui::InvisibleButton(id, ImVec2(side, side));
    wr_gui_stop(WR_STOP_PRESS, false);
    ImDrawList *list = ImGui::GetWindowDrawList();
    ImVec2 end(at.x + side, at.y + side);
    if (selected) list->AddRectFilled(at, end, wr_gui_colour_of(WR_COLOUR_SELECTED), px(3));
    else if (ImGui::IsItemHovered())
        list->AddRectFilled(at, end, wr_gui_colour_of(WR_COLOUR_BUTTON), px(3));
    ImFont *font = wr_gui_current()->fonts[WR_FONT_ICON];
    const ImU32 ink = ImGui::GetColorU32(wr_gui_colour_of(
        selected ? WR_COLOUR_STRONG : WR_COLOUR_TEXT)); /* grey where it is disabled */
    const float drawn = roundf(wr_gui_size_of(font)), edge = roundf((side - drawn) / 2);
    if (wr_gui_draw_icon(list, icon, ImVec2(at.x + edge, at.y + edge), drawn, ink)) return pressed;
    icon = wr_gui_icon(icon);
    ImVec2 size = font->CalcTextSizeA(wr_gui_size_of(font), FLT_MAX, 0, icon);
    list->AddText(font, wr_gui_size_of(font),
                  ImVec2(at.x + roundf((side - size.x) / 2), at.y + roundf((side - size.y) / 2)),
                  ink, icon);
    return pressed;
}
WR_CAUGHT(false)

extern "C" bool wr_gui_chip(const char *icon, const char *label)
try {
    char text[400], said[320];
    snprintf(text, sizeof text, "%s%s%s", icon ? wr_gui_icon(icon) : "",
             icon && label[0] ? "  " : "", wr_gui_labelled(label, said));
    ImGui::PushStyleColor(ImGuiCol_Button, wr_gui_colour_of(WR_COLOUR_CHIP));
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, wr_gui_colour_of(WR_COLOUR_CHIP_HOT));
    ImGui::PushStyleVar(ImGuiStyleVar_FrameRounding, px(3));
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(8), px(3)));
    wr_gui_row_room(ImGui::CalcTextSize(text, nullptr, true).x + px(16));
    bool pressed = ImGui::Button(text);
    wr_gui_stop(WR_STOP_PRESS, false);
    wr_gui_fits_window(label);
    ImGui::PopStyleVar(2);
    ImGui::PopStyleColor(2);
    return pressed;
}
WR_CAUGHT(false)
