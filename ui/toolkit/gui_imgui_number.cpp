/* Number fields and colour fields, and drawing on the views. */
#include "ui/toolkit/gui_imgui.h"

extern "C" {
#include "base/text.h"
}

#include <imgui_internal.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- value <-> position in the field ---- */

/* The nearest value of the hard range. */
static double allowed(const WrNumber *spec, double value)
{
    const bool hard = spec->hard_low != 0 || spec->hard_high != 0;
    const double low = hard ? spec->hard_low : spec->low;
    const double high = hard ? spec->hard_high : spec->high;
    return value < low ? low : value > high ? high : value;
}

static double place_of(const WrNumber *spec, double value)
{
    double t = spec->logarithmic ? log((value > spec->low ? value : spec->low) / spec->low) /
                                       log(spec->high / spec->low)
                                 : (value - spec->low) / (spec->high - spec->low);
    return t < 0 ? 0 : t > 1 ? 1 : t;
}

/* In the C locale. */
static void print_value(const WrNumber *spec, double value, char *text, size_t size)
{
    if (spec->decimals >= 0) snprintf(text, size, "%.*f", spec->decimals, value);
    else snprintf(text, size, "%.4g", value);
}

/* Round to the displayed digits: a drag yields 0.3, not 0.30000000000000004. */
static double round_as_shown(const WrNumber *spec, double value)
{
    char text[64];
    double rounded;
    print_value(spec, value, text, sizeof text);
    return wr_number_parse(text, strlen(text), &rounded) ? rounded : value;
}

static double value_at(const WrNumber *spec, double t)
{
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    double value = spec->logarithmic ? spec->low * pow(spec->high / spec->low, t)
                                     : spec->low + t * (spec->high - spec->low);
    return allowed(spec, round_as_shown(spec, value));
}

static bool read_value(const WrNumber *spec, const char *text, double *value)
{
    char plain[64];
    while (*text == ' ') text++;
    size_t length = strspn(text, "0123456789.,+-eE");
    if (length > 0 && (text[length - 1] == 'e' || text[length - 1] == 'E')) length--;
    if (length >= sizeof plain) return false;
    for (size_t i = 0; i < length; i++) plain[i] = text[i] == ',' ? '.' : text[i];
    double typed;
    if (!wr_number_parse(plain, length, &typed)) return false;
    *value = allowed(spec, typed);
    return true;
}

/* ---- the field ---- */

static WrEdit type_into(WrGui *gui, ImGuiID item, float width, const WrNumber *spec, double *value)
{
    ImGui::SetNextItemWidth(width);
    bool first = gui->typing_focus;
    gui->typing_frame = ImGui::GetFrameCount();
    if (first) wr_gui_keyboard_here();
    bool done =
        ImGui::InputText("##typed", gui->typed, sizeof gui->typed,
                         ImGuiInputTextFlags_AutoSelectAll | ImGuiInputTextFlags_EnterReturnsTrue);
    wr_gui_edge(ImGui::GetWindowDrawList(), ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
    bool active = ImGui::IsItemActive();
    ImGuiInputTextState *typed = ImGui::GetInputTextState(ImGui::GetItemID());
    if (typed && active && ImGui::IsMouseDoubleClicked(0)) typed->SelectAll();
    if (first && active) gui->typing_focus = false;
    bool escape = wr_gui_went_down(SDL_SCANCODE_ESCAPE);
    if (!done && (active || gui->typing_focus) && !escape) return WR_EDIT_NONE;
    if (gui->typing == item) gui->typing = 0;
    if (escape) return WR_EDIT_NONE;
    double before = *value;
    if (!read_value(spec, gui->typed, value)) return WR_EDIT_NONE;
    return *value != before ? WR_EDIT_DONE : WR_EDIT_NONE;
}

static void start_typing(WrGui *gui, ImGuiID item, const WrNumber *spec, double value)
{
    gui->typing = item;
    gui->typing_frame = ImGui::GetFrameCount();
    gui->typing_focus = true;
    if (spec->decimals >= 0) print_value(spec, value, gui->typed, sizeof gui->typed);
    else wr_number_print(value, gui->typed);
    wr_words_number(gui->typed);
}

static void print_field(const WrNumber *spec, double value, char *text, size_t size)
{
    print_value(spec, value, text, size - 24);
    wr_words_number(text);
    const size_t used = strlen(text);
    if (spec->unit) snprintf(text + used, size - used, " %s", wr_gui_said(spec->unit));
}

static void draw_field(const WrNumber *spec, ImVec2 at, ImVec2 end, double value, bool hovered)
{
    ImDrawList *list = ImGui::GetWindowDrawList();
    float pad = ImGui::GetStyle().FramePadding.x;
    list->AddRectFilled(at, end,
                        wr_gui_colour_u32(hovered ? WR_COLOUR_FIELD_HOT : WR_COLOUR_FIELD));
    float fill = roundf((end.x - at.x) * (float)place_of(spec, value));
    if (fill >= 2)
        list->AddRectFilled(
            ImVec2(at.x + 1, at.y + 1), ImVec2(at.x + fill, end.y - 1),
            ImGui::GetColorU32(wr_gui_colour_u32(hovered ? WR_COLOUR_FILL_HOT : WR_COLOUR_FILL)));
    wr_gui_edge(list, at, end);
    char text[96];
    print_field(spec, value, text, sizeof text);
    ImVec2 size = ImGui::CalcTextSize(text);
    const bool tight = size.x > end.x - at.x - 2 * pad;
    if (tight) {
        ImGui::PushFont(wr_gui_current()->fonts[WR_FONT_SMALL]);
        size = ImGui::CalcTextSize(text);
        pad = floorf(pad / 2);
    }
    /* A number without its first digits would be another one: decimals go first. */
    for (WrNumber shown = *spec; size.x > end.x - at.x - pad && shown.decimals-- > 0;) {
        print_field(&shown, value, text, sizeof text);
        size = ImGui::CalcTextSize(text);
    }
    wr_gui_fits(text, size.x, end.x - at.x - pad);
    list->PushClipRect(at, end, true);
    list->AddText(ImVec2(end.x - pad - size.x, at.y + floorf((end.y - at.y - size.y) / 2)),
                  ImGui::GetColorU32(ImGuiCol_Text), text);
    list->PopClipRect();
    if (tight) ImGui::PopFont();
}

static WrEdit reset(const WrNumber *spec, double *value)
{
    const double before = *value;
    *value = allowed(spec, spec->reset);
    return *value != before ? WR_EDIT_DONE : WR_EDIT_NONE;
}

/* The field while no text is typed. */
static WrEdit drag_field(WrGui *gui, ImGuiID item, float width, const WrNumber *spec, double *value)
{
    ImVec2 at = ImGui::GetCursorScreenPos();
    ImVec2 size(width, ImGui::GetFrameHeight());
    ImGui::InvisibleButton("##field", size);
    WrEdit edit = WR_EDIT_NONE;
    ImGuiIO &io = ImGui::GetIO();
    if (ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (ImGui::IsItemActivated()) {
        gui->dragging = item;
        gui->drag_x = gui->pointer.x;
        gui->drag_from = place_of(spec, *value);
        gui->drag_value = gui->drag_start = *value;
        gui->moved = false;
        if (io.KeyCtrl) {
            gui->dragging = 0;
            edit = reset(spec, value);
        }
    }
    if (gui->dragging == item) {
        float dx = gui->pointer.x - gui->drag_x;
        if (fabsf(dx) > 2) gui->moved = true;
        if (gui->moved && (ImGui::IsItemActive() || ImGui::IsItemDeactivated()))
            gui->drag_value =
                value_at(spec, gui->drag_from + (double)(dx / width) * (io.KeyShift ? 0.1 : 1.0));
        /* Without a motion there is no change: the caller has the value already. */
        edit = gui->moved && *value != gui->drag_value ? WR_EDIT_LIVE : WR_EDIT_NONE;
        if (gui->moved) *value = gui->drag_value;
        if (!ImGui::IsItemActive()) {
            gui->dragging = 0;
            edit = gui->moved ? WR_EDIT_DONE : WR_EDIT_NONE;
            if (!gui->moved) start_typing(gui, item, spec, *value);
        }
    }
    if (gui->dragging == item && wr_gui_went_down(SDL_SCANCODE_ESCAPE)) {
        gui->dragging = 0;
        ImGui::ClearActiveID();
        *value = gui->drag_start;
        edit = gui->moved ? WR_EDIT_LIVE : WR_EDIT_NONE;
    }
    draw_field(spec, at, ImVec2(at.x + size.x, at.y + size.y), *value,
               ImGui::IsItemHovered() || gui->dragging == item);
    wr_gui_tip_of(item, spec->tip);
    return edit;
}

/* ---- keys ---- */

/* Step of 1/100 or 1/1000 of the range, but at least the last displayed digit. */
static double stepped(const WrNumber *spec, double value, int way, bool fine)
{
    const double share = (double)way * (fine ? 0.001 : 0.01);
    double next = spec->logarithmic ? value * pow(spec->high / spec->low, share)
                                    : value + share * (spec->high - spec->low);
    next = round_as_shown(spec, next);
    if (next == round_as_shown(spec, value) && spec->decimals >= 0)
        next = round_as_shown(spec, value + (double)way * pow(10.0, -spec->decimals));
    const double low = fmin(spec->low, value), high = fmax(spec->high, value);
    return allowed(spec, next < low ? low : next > high ? high : next);
}

/* Arrow keys change the value, live while held; Enter starts typing; Backspace and Delete reset. */
static WrEdit by_keys(WrGui *gui, ImGuiID item, const WrNumber *spec, double *value)
{
    WrFocus *focus = &gui->focus;
    const int way = wr_gui_focus_arrows(item, true);
    if (wr_gui_focus_pressed(item)) start_typing(gui, item, spec, *value);
    if (wr_gui_focus_key(item, SDL_SCANCODE_BACKSPACE) ||
        wr_gui_focus_key(item, SDL_SCANCODE_DELETE)) {
        return reset(spec, value);
    }
    if (way) {
        const double from = focus->stepped == item ? gui->drag_value : *value;
        focus->stepped = item;
        gui->drag_value = stepped(spec, from, way, (focus->key.mod & KMOD_SHIFT) != 0);
    }
    if (focus->stepped != item) return WR_EDIT_NONE;
    const bool live = *value != gui->drag_value;
    *value = gui->drag_value;
    if (!focus->step_ends) return live ? WR_EDIT_LIVE : WR_EDIT_NONE;
    focus->stepped = 0;
    return WR_EDIT_DONE;
}

extern "C" WrEdit wr_gui_number(const char *id, double width, const WrNumber *spec, double *value)
try {
    wr_gui_pin_step();
    WrGui *gui = wr_gui_current();
    ImGui::PushID(id);
    ImGuiID item = ImGui::GetID("##field");
    float w = width > 0 ? (float)width : ImGui::GetContentRegionAvail().x;
    if (w < 8) w = 8;
    const ImVec2 at = ImGui::GetCursorScreenPos(), end(at.x + w, at.y + ImGui::GetFrameHeight());
    const WrEdit keyed = gui->typing == item ? WR_EDIT_NONE : by_keys(gui, item, spec, value);
    WrEdit edit = gui->typing == item ? type_into(gui, item, w, spec, value)
                                      : drag_field(gui, item, w, spec, value);
    if (keyed != WR_EDIT_NONE) edit = keyed;
    wr_gui_stop_at(WR_STOP_NUMBER, item, false, at, end);
    if (gui->typing == item && !gui->focus.shown) gui->focus.at = item;
    ImGui::PopID();
    return edit;
}
WR_CAUGHT(WR_EDIT_NONE)

/* ---- colours: linear in the document, sRGB in the picker ---- */

static double encode(double c)
{
    return c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1 / 2.4) - 0.055;
}

static double decode(double c)
{
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

extern "C" WrEdit wr_gui_colour(const char *id, double width, double rgb[3])
try {
    wr_gui_pin_step();
    float code[3];
    for (int k = 0; k < 3; k++) code[k] = (float)encode(rgb[k] < 0 ? 0 : rgb[k]);
    ImGui::PushID(id);
    float w = width > 0 ? (float)width : ImGui::GetContentRegionAvail().x;
    WrEdit edit = WR_EDIT_NONE;
    if (ImGui::ColorButton("##swatch", ImVec4(code[0], code[1], code[2], 1),
                           ImGuiColorEditFlags_NoTooltip, ImVec2(w, ImGui::GetFrameHeight())))
        ImGui::OpenPopup("picker");
    wr_gui_stop(WR_STOP_PRESS, false);
    if (ImGui::BeginPopup("picker")) {
        ImGui::SetNextItemWidth((float)wr_gui_px(220));
        if (ImGui::ColorPicker3("##picker", code,
                                ImGuiColorEditFlags_NoSidePreview | ImGuiColorEditFlags_NoLabel |
                                    ImGuiColorEditFlags_DisplayRGB |
                                    ImGuiColorEditFlags_DisplayHex)) {
            for (int k = 0; k < 3; k++) /* four digits are finer than any display */
                rgb[k] = round(decode((double)code[k]) * 1e4) / 1e4;
            edit = WR_EDIT_LIVE;
        }
        if (ImGui::IsItemDeactivatedAfterEdit()) edit = WR_EDIT_DONE;
        ImGui::EndPopup();
    }
    ImGui::PopID();
    return edit;
}
WR_CAUGHT(WR_EDIT_NONE)

/* ---- drawing ---- */

static ImDrawList *views(void)
{
    ImDrawList *pad = wr_gui_current()->pad;
    return pad ? pad : ImGui::GetBackgroundDrawList();
}

static ImVec2 at(double x, double y)
{
    return ImVec2((float)x, (float)y);
}

extern "C" void wr_gui_draw_clip(SDL_Rect r)
{
    views()->PushClipRect(at(r.x, r.y), at(r.x + r.w, r.y + r.h), true);
}

extern "C" void wr_gui_draw_unclip(void)
{
    views()->PopClipRect();
}

extern "C" void wr_gui_draw_line(double x0, double y0, double x1, double y1, WrColour colour,
                                 double width)
{
    views()->AddLine(at(x0, y0), at(x1, y1), wr_gui_colour_u32(colour), (float)width);
}

extern "C" void wr_gui_draw_rect(double x, double y, double w, double h, WrColour colour,
                                 double width)
{
    views()->AddRect(at(x, y), at(x + w, y + h), wr_gui_colour_u32(colour), 0, 0, (float)width);
}

extern "C" void wr_gui_draw_fill(double x, double y, double w, double h, WrColour colour,
                                 double rounding)
{
    views()->AddRectFilled(at(x, y), at(x + w, y + h), wr_gui_colour_u32(colour), (float)rounding);
}

extern "C" void wr_gui_draw_circle(double x, double y, double radius, WrColour colour, double width)
{
    views()->AddCircle(at(x, y), (float)radius, wr_gui_colour_u32(colour), 0, (float)width);
}

extern "C" void wr_gui_draw_quad(const double x[4], const double y[4], WrColour colour)
{
    views()->AddQuadFilled(at(x[0], y[0]), at(x[1], y[1]), at(x[2], y[2]), at(x[3], y[3]),
                           wr_gui_colour_u32(colour));
}

extern "C" void wr_gui_draw_disc(double x, double y, double radius, WrColour colour)
{
    views()->AddCircleFilled(at(x, y), (float)radius, wr_gui_colour_u32(colour));
}

extern "C" void wr_gui_draw_arc(double x, double y, double radius, double turns, WrColour colour,
                                double width)
{
    const double top = -1.57079632679489662;
    views()->PathArcTo(at(x, y), (float)radius, (float)top,
                       (float)(top + turns * 6.28318530717958648), 24);
    views()->PathStroke(wr_gui_colour_u32(colour), 0, (float)width);
}

extern "C" void wr_gui_draw_text(double x, double y, WrFont font, WrColour colour, const char *text)
{
    ImFont *face = wr_gui_current()->fonts[font];
    views()->AddText(face, wr_gui_size_of(face), at(x, y), wr_gui_colour_u32(colour),
                     wr_gui_said(text));
}
