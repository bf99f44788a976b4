/* Areas, text, menus and widgets. */
#include "ui/toolkit/gui_imgui.h"
#include "ui/toolkit/words.h"

#include <imgui_internal.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

extern "C" {
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
    snprintf(wr_gui_current()->scope, WR_GUI_SCOPE, "%s", name);
    wr_gui_current()->section[0] = '\0';
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
    ImGui::PushStyleColor(wr_gui_current()->floating ? ImGuiCol_ChildBg : ImGuiCol_WindowBg,
                          wr_gui_colour_u32(background));
    if (wr_gui_current()->floating) {
        ImGui::SetCursorScreenPos(ImVec2((float)rect.x, (float)rect.y));
        wr_gui_begin_part(name, (float)rect.w, (float)rect.h, flags);
    } else {
        ImGui::Begin(name, nullptr, flags);
    }
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(2);
}
WR_CAUGHT()

extern "C" void wr_gui_area_end(void)
try {
    wr_gui_stop_scrolled();
    wr_gui_pin_menu();
    wr_gui_count_space();
    if (wr_gui_current()->floating) ImGui::EndChild();
    else ImGui::End();
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
    wr_gui_count_space();
    ImGui::End();
}
WR_CAUGHT()

/* ---- layout ---- */

extern "C" void wr_gui_same_line(double gap_units)
{
    ImGui::SameLine(0.0f, px(gap_units));
}

extern "C" double wr_gui_content_height(void)
{
    const ImGuiWindow *window = ImGui::GetCurrentWindow();
    return (double)(window->DC.CursorMaxPos.y - window->DC.CursorStartPos.y +
                    2 * window->WindowPadding.y);
}

extern "C" void wr_gui_space(double units)
{
    wr_gui_pin_step();
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

extern "C" void wr_gui_disable_end(void)
{
    ImGui::EndDisabled();
}

/* ---- text ---- */

static void text_in(WrFont font, WrColour colour, const char *text, bool wrapped)
{
    ImGui::PushFont(wr_gui_current()->fonts[font]);
    ImGui::PushStyleColor(ImGuiCol_Text, wr_gui_colour_u32(colour));
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
    ImGui::GetWindowDrawList()->AddText(small, size, ImVec2(at.x, top), wr_gui_colour_u32(colour),
                                        said, nullptr, room);
    return true;
}

extern "C" void wr_gui_text(WrFont font, WrColour colour, const char *text)
try {
    wr_gui_pin_step();
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
    wr_gui_pin_step();
    char said[WR_WORDS_MESSAGE];
    const bool wrong = colour == WR_COLOUR_BAD && !wr_gui_current()->as_it_is;
    text_in(font, colour, wrong ? wr_words_message(text, said, sizeof said) : text, true);
}
WR_CAUGHT()

extern "C" void wr_gui_note(WrColour colour, const char *text, int lines)
try {
    const float from = ImGui::GetCursorPosY();
    const float room = (float)(lines * wr_gui_line_height(WR_FONT_SMALL));
    if (text[0]) wr_gui_text_wrapped(WR_FONT_SMALL, colour, text);
    const float left = from + room + ImGui::GetStyle().ItemSpacing.y - ImGui::GetCursorPosY();
    if (left > 0.0f) ImGui::SetCursorPosY(ImGui::GetCursorPosY() + left);
}
WR_CAUGHT()

extern "C" void wr_gui_heading(const char *text)
try {
    wr_gui_pin_step();
    wr_gui_row_section(text);
    text_in(WR_FONT_SMALL, WR_COLOUR_LABEL, text, false);
}
WR_CAUGHT()

/* A label too long even in the small font is placed above its field. */
extern "C" void wr_gui_label(const char *text)
try {
    if (!wr_gui_current()->pinning) wr_gui_row_label(text);
    float column = roundf(ImGui::GetWindowContentRegionMax().x * 0.41f);
    float room = column - ImGui::GetCursorPosX() - px(4);
    wr_gui_pin_row(text, wr_gui_text_width(WR_FONT_SMALL, text) > (double)room);
    ImGui::AlignTextToFramePadding();
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
    wr_gui_row_tip(text);
    if (wr_gui_item_disabled() && wr_gui_current()->grey_why)
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
    if (!why || !wr_gui_disabled_hovered() ||
        !ImGui::IsWindowHovered(ImGuiHoveredFlags_ChildWindows))
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
    wr_gui_pin_step();
    bool changed = false;
    wr_gui_row_choices(items, count);
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
    ImFont *small = wr_gui_current()->fonts[WR_FONT_SMALL];
    if (tight) said_wide = small->CalcTextSizeA(wr_gui_size_of(small), FLT_MAX, 0.0f, now).x;
    wr_gui_fits(now, said_wide, tight ? room + padding.x : room);
    const float lower = (ImGui::GetFontSize() - wr_gui_size_of(small)) / 2;
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
        list->AddText(small, wr_gui_size_of(small), place, ImGui::GetColorU32(ImGuiCol_Text), now,
                      nullptr, 0.0f, &clip);
    wr_gui_edge(list, at, ImVec2(right + px(13), at.y + ImGui::GetFrameHeight()));
    if (!tight || place.x + said_wide < right - arrow)
        list->AddTriangleFilled(ImVec2(right - arrow, middle), ImVec2(right + arrow, middle),
                                ImVec2(right, middle + arrow), wr_gui_colour_u32(WR_COLOUR_LABEL));
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
    if (label[0] != '#') wr_gui_pin_row(label, false);
    wr_gui_pin_step();
    float side = ImGui::GetFrameHeight(), gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const char *shown = wr_gui_labelled(label, said), *id = strstr(shown, "##");
    float wide = ImGui::CalcTextSize(shown, nullptr, true).x + side + gap;
    bool wraps = wide > wr_gui_row_room(wide);
    ImVec2 at = ImGui::GetCursorScreenPos();
    snprintf(box, sizeof box, "##box%s", id ? id : label);
    bool changed = ImGui::Checkbox(wraps ? box : shown, value);
    wr_gui_stop(WR_STOP_PRESS, false);
    wr_gui_name_row(label);
    wr_gui_name_item(label);
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
    wr_gui_pin_step();
    if (primary) {
        ImGui::PushStyleColor(ImGuiCol_Button, wr_gui_colour_u32(WR_COLOUR_SELECTED));
        ImGui::PushStyleColor(ImGuiCol_ButtonHovered, wr_gui_colour_u32(WR_COLOUR_ACCENT));
    }
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(14), px(5)));
    ImGui::PushStyleVar(ImGuiStyleVar_FrameRounding, px(3));
    char said[320];
    const bool named = !wr_gui_current()->next_id; /* else the label is a value */
    const char *shown = wr_gui_labelled(label, said);
    wr_gui_row_room(ImGui::CalcTextSize(shown, nullptr, true).x + px(28));
    bool pressed = ImGui::Button(shown);
    wr_gui_stop(WR_STOP_PRESS, false);
    if (named) wr_gui_row_button(label);
    wr_gui_fits_window(label);
    ImGui::PopStyleVar(2);
    if (primary) ImGui::PopStyleColor(2);
    return pressed;
}
WR_CAUGHT(false)

extern "C" bool wr_gui_icon_button(const char *id, const char *icon, double units, bool selected)
try {
    wr_gui_pin_step();
    float side = px(units);
    ImVec2 at = ImGui::GetCursorScreenPos();
    bool pressed = ImGui::InvisibleButton(id, ImVec2(side, side));
    wr_gui_stop(WR_STOP_PRESS, false);
    ImDrawList *list = ImGui::GetWindowDrawList();
    ImVec2 end(at.x + side, at.y + side);
    if (selected) list->AddRectFilled(at, end, wr_gui_colour_u32(WR_COLOUR_SELECTED), px(3));
    else if (ImGui::IsItemHovered())
        list->AddRectFilled(at, end, wr_gui_colour_u32(WR_COLOUR_BUTTON), px(3));
    ImFont *font = wr_gui_current()->fonts[WR_FONT_ICON];
    const ImU32 ink = ImGui::GetColorU32(wr_gui_colour_u32(
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
    wr_gui_pin_step();
    char text[400], said[320];
    const bool named = !wr_gui_current()->next_id;
    snprintf(text, sizeof text, "%s%s%s", icon ? wr_gui_icon(icon) : "",
             icon && label[0] ? "  " : "", wr_gui_labelled(label, said));
    ImGui::PushStyleColor(ImGuiCol_Button, wr_gui_colour_u32(WR_COLOUR_CHIP));
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, wr_gui_colour_u32(WR_COLOUR_CHIP_HOT));
    ImGui::PushStyleVar(ImGuiStyleVar_FrameRounding, px(3));
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(8), px(3)));
    wr_gui_row_room(ImGui::CalcTextSize(text, nullptr, true).x + px(16));
    bool pressed = ImGui::Button(text);
    wr_gui_stop(WR_STOP_PRESS, false);
    if (named) wr_gui_row_button(label);
    wr_gui_fits_window(label);
    ImGui::PopStyleVar(2);
    ImGui::PopStyleColor(2);
    return pressed;
}
WR_CAUGHT(false)

/* ---- rows that contain widgets, pictures, bars ---- */

/* Full width of the window, including its padding. */
static void full_width(float *left, float *right)
{
    const ImGuiWindow *window = ImGui::GetCurrentWindow();
    *left = window->Pos.x;
    *right = window->Pos.x + window->Size.x - window->ScrollbarSizes.x;
}

/* While a row is dragged near the area's upper or lower edge, or beyond it, the area scrolls. */
static void scroll_at_edges()
{
    ImGuiWindow *window = ImGui::GetCurrentWindow();
    const ImGuiIO &io = ImGui::GetIO();
    const float margin = px(20), y = io.MousePos.y;
    float beyond = 0;
    if (y < window->InnerRect.Min.y + margin) beyond = y - window->InnerRect.Min.y - margin;
    if (y > window->InnerRect.Max.y - margin) beyond = y - window->InnerRect.Max.y + margin;
    if (beyond == 0 || window->ScrollMax.y <= 0) return;
    const bool at_end =
        beyond < 0 ? window->Scroll.y <= 0 : window->Scroll.y >= window->ScrollMax.y;
    if (at_end) return;
    WrGui *gui = wr_gui_current();
    const float pace = fminf(fmaxf(beyond / margin, -2), 2) * px(300); /* pixels in a second */
    gui->scroll_rest += pace * io.DeltaTime;
    const float step = truncf(gui->scroll_rest); /* fractions would be lost */
    gui->scroll_rest -= step;
    ImGui::SetScrollY(fminf(fmaxf(window->Scroll.y + step, 0), window->ScrollMax.y));
    gui->drag_scrolls = true;
}

static WrColour ground_of(WrRowLook look, bool hovered)
{
    if (look == WR_ROW_SELECTED) return WR_COLOUR_ROW_SELECTED;
    if (look == WR_ROW_CHOSEN) return WR_COLOUR_ROW_CHOSEN;
    return hovered ? WR_COLOUR_ROW_HOT : 0;
}

extern "C" WrRow wr_gui_row_begin(int id, double height_units, WrRowLook look)
try {
    wr_gui_pin_step();
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
    ImGui::PushClipRect(ImVec2(left, inner.Min.y), ImVec2(right, inner.Max.y), gui->pin_skips);
    ImGui::SetCursorScreenPos(ImVec2(left, at.y));
    bool hovered, released = wr_gui_button_below("row", ImVec2(right - left, height), &hovered);
    bool held = ImGui::IsItemActive();
    wr_gui_stop(WR_STOP_ROW, false);
    bool menu = (hovered && ImGui::IsMouseClicked(1)) || wr_gui_focus_menu(ImGui::GetItemID());
    bool moved = ImGui::IsMouseDragPastThreshold(0, px(5));
    const ImGuiID own = ImGui::GetItemID();
    const WrColour ground = ground_of(look, hovered);
    if (ground)
        list->AddRectFilled(ImVec2(left, at.y), ImVec2(right, at.y + height),
                            wr_gui_colour_u32(ground));
    list->AddRectFilled(ImVec2(left, at.y + height - 1), ImVec2(right, at.y + height),
                        wr_gui_colour_u32(WR_COLOUR_POPUP));
    if (hovered && ImGui::IsMouseClicked(0))
        gui->row_double =
            gui->clicks == 2 || ImGui::IsMouseDoubleClicked(0) ? own : 0; /* a drag may follow */
    const bool was = gui->row_drag == own;
    if (held && moved) gui->row_drag = own;
    bool dragging = held && gui->row_drag == own, dropped = was && !held;
    if (dragging && wr_gui_escape_pressed()) {
        ImGui::ClearActiveID();
        gui->row_drag = 0;
        dragging = false;
    }
    if (dragging) scroll_at_edges();
    if (dropped) gui->row_drag = 0;
    WrRow row = {};
    row.top = (double)at.y;
    row.height = (double)height;
    row.pointer_y = (double)ImGui::GetIO().MousePos.y;
    row.clicked = released && !was;
    row.doubled = released && !was && gui->row_double == own;
    row.menu = menu;
    row.dragging = dragging;
    row.dropped = dropped;
    row.ringed = wr_gui_focused(own);
    row.reached = row.ringed && gui->focus.stepped_rows;
    row.extends = row.reached && (gui->focus.key.mod & KMOD_SHIFT);
    return row;
}
WR_CAUGHT(WrRow{})

extern "C" void wr_gui_row_set_cursor(double x, double tall)
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

extern "C" void wr_gui_drop_line(double x, double y)
{
    float left, right, at = roundf((float)y);
    const ImRect &inner = ImGui::GetCurrentWindow()->InnerRect;
    full_width(&left, &right);
    left += (float)x;
    at = fminf(fmaxf(at, inner.Min.y + px(1)), inner.Max.y - px(1));
    ImGui::GetForegroundDrawList()->AddRectFilled(
        ImVec2(left, at - px(1)), ImVec2(right, at + px(1)), wr_gui_colour_u32(WR_COLOUR_ACCENT));
}

extern "C" void wr_gui_drop_frame(double y, double height)
{
    float left, right;
    const ImGuiWindow *window = ImGui::GetCurrentWindow();
    full_width(&left, &right);
    ImDrawList *list = ImGui::GetForegroundDrawList();
    list->PushClipRect(window->InnerRect.Min, window->InnerRect.Max, true);
    const float w = px(2), top = roundf((float)y), low = roundf((float)(y + height)) - 1;
    const ImU32 ink = wr_gui_colour_u32(WR_COLOUR_ACCENT);
    list->AddRectFilled(ImVec2(left, top), ImVec2(right, top + w), ink);
    list->AddRectFilled(ImVec2(left, low - w), ImVec2(right, low), ink);
    list->AddRectFilled(ImVec2(left, top + w), ImVec2(left + w, low - w), ink);
    list->AddRectFilled(ImVec2(right - w, top + w), ImVec2(right, low - w), ink);
    list->PopClipRect();
}

extern "C" void wr_gui_spotlight(const SDL_Rect *part)
{
    const float x = (float)part->x, y = (float)part->y, w = px(3);
    ImGui::GetForegroundDrawList()->AddRect(
        ImVec2(x + w / 2, y + w / 2),
        ImVec2(x + (float)part->w - w / 2, y + (float)part->h - w / 2),
        wr_gui_colour_u32(WR_COLOUR_ACCENT), 0, 0, w);
}

extern "C" bool wr_gui_held(void)
{
    return ImGui::IsItemActive() && ImGui::GetIO().MouseDown[0];
}

extern "C" void wr_gui_let_go(void)
{
    ImGui::ClearActiveID();
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
    wr_gui_pin_step();
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
    ImGui::PushStyleColor(ImGuiCol_Text, wr_gui_colour_u32(colour));
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + (float)width);
    ImGui::TextUnformatted(said);
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    ImGui::PopFont();
}
WR_CAUGHT()

extern "C" void wr_gui_image(SDL_Texture *texture, double w, double h)
try {
    wr_gui_pin_step();
    ImVec2 at = ImGui::GetCursorScreenPos(), end(at.x + (float)w, at.y + (float)h);
    ImGui::Dummy(ImVec2((float)w, (float)h));
    ImDrawList *list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, end, wr_gui_colour_u32(WR_COLOUR_FIELD));
    if (texture) list->AddImage(wr_gui_texture_id(texture), at, end);
    wr_gui_edge(list, at, end);
}
WR_CAUGHT()

extern "C" void wr_gui_ink(SDL_Texture *texture, double w, double h, WrColour colour)
try {
    wr_gui_pin_step();
    ImVec2 at = ImGui::GetCursorScreenPos(), end(at.x + (float)w, at.y + (float)h);
    ImGui::Dummy(ImVec2((float)w, (float)h));
    if (texture)
        ImGui::GetWindowDrawList()->AddImage(wr_gui_texture_id(texture), at, end, ImVec2(0, 0),
                                             ImVec2(1, 1), wr_gui_colour_u32(colour));
}
WR_CAUGHT()

extern "C" bool wr_gui_list_button(const char *id, const char *label, double width)
try {
    wr_gui_pin_step();
    ImVec2 at = ImGui::GetCursorScreenPos();
    float h = ImGui::GetFrameHeight(), pad = ImGui::GetStyle().FramePadding.x, arrow = px(4);
    ImVec2 end(at.x + (float)width, at.y + h);
    ImGui::PushStyleColor(ImGuiCol_Button, wr_gui_colour_u32(WR_COLOUR_FIELD));
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
                  wr_gui_colour_u32(WR_COLOUR_TEXT), said, nullptr, 0.0f, &clip);
    list->AddTriangleFilled(ImVec2(right - arrow, middle), ImVec2(right + arrow, middle),
                            ImVec2(right, middle + arrow), wr_gui_colour_u32(WR_COLOUR_LABEL));
    return pressed;
}
WR_CAUGHT(false)

extern "C" bool wr_gui_image_button(const char *id, SDL_Texture *texture, double w, double h,
                                    bool chosen)
try {
    wr_gui_pin_step();
    ImVec2 at = ImGui::GetCursorScreenPos(), end(at.x + (float)w, at.y + (float)h);
    bool pressed = ImGui::InvisibleButton(id, ImVec2((float)w, (float)h));
    wr_gui_stop(WR_STOP_PRESS, false);
    ImDrawList *list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, end, wr_gui_colour_u32(WR_COLOUR_FIELD));
    if (texture) list->AddImage(wr_gui_texture_id(texture), at, end);
    wr_gui_edge(list, at, end);
    if (chosen) {
        float out = px(2);
        list->AddRect(ImVec2(at.x - out, at.y - out), ImVec2(end.x + out, end.y + out),
                      wr_gui_colour_u32(WR_COLOUR_ACCENT), 0, 0, px(2));
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
    list->AddRectFilled(at, end, wr_gui_colour_u32(WR_COLOUR_FIELD));
    wr_gui_edge(list, at, end);
    ImU32 ink = wr_gui_colour_u32(ImGui::IsItemHovered() ? WR_COLOUR_TEXT : WR_COLOUR_LABEL);
    ImVec2 size = small->CalcTextSizeA(wr_gui_size_of(small), FLT_MAX, 0, keys);
    float y = at.y + floorf((h - wr_gui_size_of(small)) / 2);
    wr_gui_fits(label, small->CalcTextSizeA(wr_gui_size_of(small), FLT_MAX, 0, label).x + size.x,
                (float)width - 3 * pad);
    list->AddText(small, wr_gui_size_of(small), ImVec2(at.x + pad, y), ink, label);
    list->AddText(small, wr_gui_size_of(small), ImVec2(end.x - pad - size.x, y),
                  wr_gui_colour_u32(WR_COLOUR_FAINT), keys);
    return pressed;
}
WR_CAUGHT(false)

extern "C" bool wr_gui_glyph(const char *id, const char *icon, double units, WrColour colour)
try {
    wr_gui_pin_step();
    float side = px(units);
    ImVec2 at = ImGui::GetCursorScreenPos();
    bool pressed = ImGui::InvisibleButton(id, ImVec2(side, side));
    wr_gui_stop(WR_STOP_PRESS, false);
    bool hovered = ImGui::IsItemHovered();
    icon = wr_gui_icon(icon);
    ImVec2 size = ImGui::CalcTextSize(icon);
    ImGui::GetWindowDrawList()->AddText(
        ImVec2(at.x + roundf((side - size.x) / 2), at.y + roundf((side - size.y) / 2)),
        ImGui::GetColorU32(wr_gui_colour_u32(hovered ? WR_COLOUR_STRONG : colour)), icon);
    return pressed;
}
WR_CAUGHT(false)

extern "C" void wr_gui_progress(double width, double fraction)
try {
    wr_gui_pin_step();
    double f = fraction < 0 ? 0.25 : fraction > 1 ? 1 : fraction;
    float w = width > 0 ? (float)width : ImGui::GetContentRegionAvail().x;
    float h = ImGui::GetFrameHeight(), bar = px(8);
    ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::Dummy(ImVec2(w, h));
    at.y += floorf((h - bar) / 2);
    ImDrawList *list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, ImVec2(at.x + w, at.y + bar), wr_gui_colour_u32(WR_COLOUR_FIELD));
    double t = fmod(ImGui::GetTime(), 1.6) / 0.8; /* back and forth */
    float from = fraction < 0 ? (float)(0.75 * (t < 1 ? t : 2 - t)) : 0.0f, long_way = w - 2;
    list->AddRectFilled(ImVec2(at.x + 1 + roundf(long_way * from), at.y + 1),
                        ImVec2(at.x + 1 + roundf(long_way * (from + (float)f)), at.y + bar - 1),
                        wr_gui_colour_u32(WR_COLOUR_ACCENT));
    wr_gui_edge(list, at, ImVec2(at.x + w, at.y + bar));
}
WR_CAUGHT()

extern "C" void wr_gui_bar(double fraction)
try {
    wr_gui_pin_step();
    const float w = ImGui::GetContentRegionAvail().x, h = px(4);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float filled = fmaxf(px(1), roundf(w * (float)fmin(fmax(fraction, 0), 1)));
    ImGui::Dummy(ImVec2(w, h));
    ImDrawList *list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, ImVec2(at.x + w, at.y + h), wr_gui_colour_u32(WR_COLOUR_FIELD));
    list->AddRectFilled(at, ImVec2(at.x + filled, at.y + h), wr_gui_colour_u32(WR_COLOUR_ACCENT));
}
WR_CAUGHT()

extern "C" void wr_gui_edge_colours_square(const char *id, double units, const WrColour sides[4])
try {
    wr_gui_pin_step();
    float side = px(units), gap = px(6), line = px(2);
    ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton(id, ImVec2(side, side));
    wr_gui_stop(WR_STOP_PRESS, false);
    ImDrawList *list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, ImVec2(at.x + side, at.y + side), wr_gui_colour_u32(WR_COLOUR_CHIP),
                        px(3));
    float x0 = at.x + gap, y0 = at.y + gap, x1 = at.x + side - gap, y1 = at.y + side - gap;
    list->AddRectFilled(ImVec2(x0, y0), ImVec2(x0 + line, y1), wr_gui_colour_u32(sides[0]));
    list->AddRectFilled(ImVec2(x1 - line, y0), ImVec2(x1, y1), wr_gui_colour_u32(sides[1]));
    list->AddRectFilled(ImVec2(x0 + line, y0), ImVec2(x1 - line, y0 + line),
                        wr_gui_colour_u32(sides[2]));
    list->AddRectFilled(ImVec2(x0 + line, y1 - line), ImVec2(x1 - line, y1),
                        wr_gui_colour_u32(sides[3]));
}
WR_CAUGHT()

/* ---- pads ---- */

/* Areas for custom drawing and pointing. */

/* Pointer of the keyboard. */
static void draw_cross(ImDrawList *list, const WrFocus *focus)
{
    const float arm = (float)wr_gui_px(7), half = (float)wr_gui_px(1) / 2;
    const ImVec2 at = focus->pad_at;
    const ImU32 ink = wr_gui_colour_u32(focus->pad_held ? WR_COLOUR_RAISE : WR_COLOUR_FOCUS);
    list->AddRectFilled(ImVec2(at.x - arm, at.y - half), ImVec2(at.x + arm, at.y + half), ink);
    list->AddRectFilled(ImVec2(at.x - half, at.y - arm), ImVec2(at.x + half, at.y + arm), ink);
}

extern "C" WrPad wr_gui_pad_begin(const char *id, double w, double h)
try {
    wr_gui_pin_step();
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
    list->AddRectFilled(at, end, wr_gui_colour_u32(WR_COLOUR_FIELD));
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
    wr_gui_pin_step();
    const float r = (float)radius, frame = ImGui::GetFrameHeight();
    ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::Dummy(ImVec2(2 * r, tall > (double)frame ? (float)tall : frame));
    ImGui::GetWindowDrawList()->AddCircleFilled(ImVec2(at.x + r, at.y + frame / 2), r,
                                                wr_gui_colour_u32(colour));
}
WR_CAUGHT()

extern "C" void wr_gui_group_begin(void)
{
    ImGui::BeginGroup();
}

extern "C" void wr_gui_group_end(void)
{
    wr_gui_count_space();
    ImGui::EndGroup();
}

/* ---- picture tiles, fields with a hint, foldable headings ---- */

static void put_picture(ImDrawList *list, SDL_Texture *texture, ImVec2 at, ImVec2 end)
{
    list->AddRectFilled(at, end, wr_gui_colour_u32(WR_COLOUR_FIELD));
    if (texture) list->AddImage(wr_gui_texture_id(texture), at, end);
}

extern "C" int wr_gui_tile(const char *id, SDL_Texture *texture, double side, bool selected,
                           bool marked)
try {
    wr_gui_pin_step();
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
        ImU32 ink = wr_gui_colour_u32(WR_COLOUR_ACCENT);
        list->AddRectFilled(at, ImVec2(end.x, at.y + w), ink);
        list->AddRectFilled(ImVec2(at.x, end.y - w), end, ink);
        list->AddRectFilled(at, ImVec2(at.x + w, end.y), ink);
        list->AddRectFilled(ImVec2(end.x - w, at.y), end, ink);
    } else {
        wr_gui_edge(list, at, end);
        if (hovered) list->AddRectFilled(at, end, wr_gui_colour_u32(0x28ffffffu));
    }
    if (marked) {
        ImFont *font = ImGui::GetFont();
        float size = wr_gui_size_of(font) * 0.8f;
        ImVec2 wide = font->CalcTextSizeA(size, FLT_MAX, 0, wr_gui_icon(WR_ICON_STAR));
        ImVec2 where(end.x - wide.x - px(2), at.y + px(2));
        list->AddText(font, size, ImVec2(where.x + 1, where.y + 1), wr_gui_colour_u32(0xc0000000u),
                      wr_gui_icon(WR_ICON_STAR));
        list->AddText(font, size, where, wr_gui_colour_u32(WR_COLOUR_CELL),
                      wr_gui_icon(WR_ICON_STAR));
    }
    return menu ? 2 : pressed ? 1 : 0;
}
WR_CAUGHT(0)

extern "C" void wr_gui_carry(SDL_Texture *texture, double side, double *x, double *y)
{
    const ImVec2 at = ImGui::GetIO().MousePos;
    const float gap = px(12);
    const ImVec2 corner(at.x + gap, at.y + gap);
    if (texture)
        ImGui::GetForegroundDrawList()->AddImage(
            wr_gui_texture_id(texture), corner,
            ImVec2(corner.x + (float)side, corner.y + (float)side));
    *x = (double)at.x;
    *y = (double)at.y;
}

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
    return !wr_gui_lists_rows() && ImGui::IsRectVisible(ImVec2((float)side, (float)side));
}

extern "C" bool wr_gui_hint_field(const char *id, const char *hint, double width, char *text,
                                  size_t size)
try {
    wr_gui_pin_step();
    ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::SetNextItemWidth(width > 0 ? (float)width : -1.0f);
    float wide = ImGui::CalcItemWidth();
    if (wr_gui_focus_pressed(ImGui::GetID(id))) wr_gui_keyboard_here();
    bool changed = ImGui::InputTextWithHint(id, wr_gui_said(hint), text, size);
    wr_gui_stop(WR_STOP_TEXT, false);
    wr_gui_edge(ImGui::GetWindowDrawList(), at,
                ImVec2(at.x + wide, at.y + ImGui::GetFrameHeight()));
    return changed;
}
WR_CAUGHT(false)

void wr_gui_area_name(const char *scope, char (&name)[WR_GUI_SCOPE])
{
    scope += strspn(scope, "#");
    snprintf(name, sizeof name, "%.*s", (int)strcspn(scope, "#0123456789"), scope);
}

/* Name for the list of folds: the area, and the label's identifier. */
static void fold_name(const WrGui *gui, const char *label, char (&name)[160])
{
    char area[WR_GUI_SCOPE];
    const char *id = strstr(label, "##");
    wr_gui_area_name(gui->scope, area);
    snprintf(name, sizeof name, "%s/%.100s", area, id ? id + strspn(id, "#") : label);
}

/* The heading: a chevron and the label in small letters. True if it was clicked. */
static bool fold_heading(const char *label, bool open)
{
    char said[320];
    const char *shown = wr_gui_labelled(label, said),
               *icon = open ? WR_ICON_OPENED : WR_ICON_CLOSED;
    const float tall = px(22), wide = ImGui::GetContentRegionAvail().x, out = px(6);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool clicked = ImGui::InvisibleButton(shown, ImVec2(wide, tall));
    wr_gui_stop(WR_STOP_PRESS, false);
    const bool hovered = ImGui::IsItemHovered();
    ImDrawList *list = ImGui::GetWindowDrawList();
    if (hovered)
        list->AddRectFilled(ImVec2(at.x - out, at.y), ImVec2(at.x + wide + out, at.y + tall),
                            wr_gui_colour_u32(WR_COLOUR_BUTTON), px(3));
    const ImU32 ink = wr_gui_colour_u32(hovered ? WR_COLOUR_STRONG : WR_COLOUR_LABEL);
    ImFont *font = ImGui::GetFont(), *small = wr_gui_current()->fonts[WR_FONT_SMALL];
    const float size = wr_gui_size_of(small), middle = at.y + floorf((tall - size) / 2);
    list->AddText(font, size, ImVec2(at.x - px(3), middle), ink, wr_gui_icon(icon));
    const char *end = strstr(shown, "##");
    list->AddText(small, size, ImVec2(at.x + px(14), middle), ink, shown, end);
    wr_gui_fits(label, small->CalcTextSizeA(size, FLT_MAX, 0, shown, end).x, wide - px(14));
    return clicked;
}

/* The fold was clicked, or another one of its area with Ctrl or Alt. */
static bool fold_changed(WrGui *gui, bool clicked, bool *open)
{
    const ImGuiIO &io = ImGui::GetIO();
    const int frame = ImGui::GetFrameCount();
    const bool was = *open;
    if (clicked) *open = !*open;
    if (clicked && (io.KeyCtrl || io.KeyAlt)) {
        snprintf(gui->fold_scope, sizeof gui->fold_scope, "%s", gui->scope);
        gui->fold_frame = frame + 1;
        gui->fold_open = *open;
    }
    if (gui->fold_frame == frame && strcmp(gui->fold_scope, gui->scope) == 0)
        *open = gui->fold_open;
    return *open != was;
}

bool wr_gui_folds_open;

extern "C" bool wr_gui_fold(const char *label, bool open_at_first)
try {
    WrGui *gui = wr_gui_current();
    char name[160];
    fold_name(gui, label, name);
    snprintf(gui->section, sizeof gui->section, "%s", strchr(name, '/') + 1);
    if (gui->pinning) return true; /* its rows decide for themselves */
    if (ImGui::GetCurrentWindow()->SkipItems) return false;
    ImGuiStorage *own = ImGui::GetStateStorage();
    const ImGuiID id = ImGui::GetID(name);
    bool open = gui->folds ? wr_folds_is_open(gui->folds, name, open_at_first)
                           : own->GetBool(id, open_at_first);
    const bool all = wr_gui_row_section(label) || wr_gui_reports_all || wr_gui_folds_open;
    const bool clicked = fold_heading(label, open || all);
    if (!fold_changed(gui, clicked, &open)) return open || all;
    if (gui->folds) wr_folds_set(gui->folds, name, open_at_first, open);
    else own->SetBool(id, open);
    return open || all;
}
WR_CAUGHT(false)

extern "C" void wr_gui_mark(WrColour colour)
try {
    wr_gui_pin_step();
    ImVec2 at = ImGui::GetCursorScreenPos();
    float h = ImGui::GetFrameHeight();
    ImGui::Dummy(ImVec2(px(7), h));
    ImGui::GetWindowDrawList()->AddRectFilled(ImVec2(at.x, at.y + px(2)),
                                              ImVec2(at.x + px(6), at.y + h - px(2)),
                                              wr_gui_colour_u32(colour), px(2));
}
WR_CAUGHT()

extern "C" void wr_gui_width_at_least(double units)
try {
    ImGui::Dummy(ImVec2(px(units), 0));
}
WR_CAUGHT()
