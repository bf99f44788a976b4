/* Menus, popups, dialogs, lists and text fields. */
#include "ui/toolkit/gui_imgui.h"

#include <imgui_internal.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static float px(double units)
{
    return (float)wr_gui_px(units);
}

extern "C" double wr_gui_menu_bar_begin(bool tight)
try {
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(8), px(6)));
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(tight ? 7 : 14), px(6)));
    ImGui::PushStyleColor(ImGuiCol_MenuBarBg, wr_gui_colour_u32(WR_COLOUR_BAR));
    ImGui::BeginMainMenuBar();
    ImGui::SetCursorPosX(px(5)); /* aligns its first word with the row below */
    return (double)ImGui::GetWindowHeight();
}
WR_CAUGHT(0.0)

extern "C" void wr_gui_menu_bar_end(void)
try {
    wr_gui_count_space();
    ImGui::EndMainMenuBar();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(2);
}
WR_CAUGHT()

/* A long menu scrolls. If it covered its own title, the click that opens it would also choose an entry. */
static void keep_below(const ImGuiWindow *bar)
{
    const float low = ImGui::GetIO().DisplaySize.y - px(8);
    ImGui::SetNextWindowSizeConstraints(
        ImVec2(0, 0), ImVec2(FLT_MAX, low - bar->DC.CursorPos.y - ImGui::GetFrameHeight()));
}

extern "C" bool wr_gui_menu_begin(const char *label)
try {
    wr_gui_row_menu(label);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(10), px(8)));
    char said[320];
    const char *shown = wr_gui_labelled(label, said);
    const ImGuiID id = ImGui::GetID(shown);
    ImGuiWindow *window = ImGui::GetCurrentWindow();
    if (!wr_gui_reports_all && window->DC.LayoutType == ImGuiLayoutType_Horizontal)
        keep_below(window);
    bool open = !wr_gui_reports_all && ImGui::BeginMenu(shown);
    /* While a menu is open, its own window is the current one. */
    if (!open) wr_gui_stop(WR_STOP_MENU, false);
    else wr_gui_stop_open(window, id);
    if (wr_gui_reports_all) ImGui::MenuItem(shown);
    if (!wr_gui_reports_all) wr_gui_fits_window(label);
    ImGui::PopStyleVar();
    return open || wr_gui_popup_stand_in(label);
}
WR_CAUGHT(false)

extern "C" void wr_gui_menu_end(void)
{
    wr_gui_row_menu(nullptr);
    wr_gui_count_space();
    if (wr_gui_reports_all) ImGui::End();
    else ImGui::EndMenu();
}

extern "C" bool wr_gui_menu_item(const char *label, const char *keys, bool checked, bool enabled)
try {
    char said[320];
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 end(at.x + ImGui::GetContentRegionAvail().x, at.y + ImGui::GetTextLineHeight());
    /* The grey of key names is too dark on the colour of the entry under the pointer. */
    const bool lit = enabled && ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(at, end);
    if (lit) ImGui::PushStyleColor(ImGuiCol_TextDisabled, wr_gui_colour_u32(WR_COLOUR_TEXT));
    bool pressed = ImGui::MenuItem(wr_gui_labelled(label, said), keys, checked, enabled);
    if (lit) ImGui::PopStyleColor();
    if (enabled) wr_gui_stop(WR_STOP_ITEM, false);
    return pressed;
}
WR_CAUGHT(false)

extern "C" void wr_gui_menu_separator(void)
{
    ImGui::Separator();
}

extern "C" void wr_gui_popup_open(const char *id)
{
    ImGui::OpenPopup(id);
}

extern "C" bool wr_gui_popup_begin(const char *id)
try {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(12), px(10)));
    bool open = wr_gui_reports_all ? wr_gui_popup_stand_in(id) : ImGui::BeginPopup(id);
    ImGui::PopStyleVar();
    return open;
}
WR_CAUGHT(false)

extern "C" void wr_gui_popup_close(void)
{
    if (!wr_gui_reports_all) ImGui::CloseCurrentPopup();
}

extern "C" void wr_gui_popup_end(void)
{
    wr_gui_count_space();
    if (wr_gui_reports_all) ImGui::End();
    else ImGui::EndPopup();
}

/* title up to ## is the heading. */
static bool dialog(const char *title, ImVec2 at, ImVec2 pivot, float width, float least, bool dim)
{
    ImGui::GetStyle().Colors[ImGuiCol_ModalWindowDimBg] =
        wr_gui_colour_vec4(dim ? 0x60000000u : 0x00000000u);
    ImGui::SetNextWindowPos(at, ImGuiCond_Always, pivot);
    ImGui::SetNextWindowSize(ImVec2(width, 0));
    if (least > 0)
        ImGui::SetNextWindowSizeConstraints(ImVec2(width, least), ImVec2(width, FLT_MAX));
    if (!ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
    float side = px(dim ? 20 : 14);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(side, px(dim ? 18 : 14)));
    bool open = ImGui::BeginPopupModal(title, nullptr,
                                       ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                           ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNav |
                                           ImGuiWindowFlags_NoSavedSettings);
    ImGui::PopStyleVar();
    if (!open) return false;
    char heading[128];
    const bool named = strchr(title, '#') != nullptr;
    if (named) snprintf(heading, sizeof heading, "%.*s", (int)strcspn(title, "#"), title);
    wr_gui_text_wrapped(WR_FONT_BOLD, WR_COLOUR_STRONG, named ? heading : title);
    wr_gui_space(4);
    return true;
}

extern "C" bool wr_gui_dialog_begin(const char *title, double width_units)
try {
    ImVec2 size = ImGui::GetIO().DisplaySize;
    float width = px(width_units);
    if (width > size.x - px(32)) width = size.x - px(32);
    return dialog(title, ImVec2(size.x / 2, size.y * 0.46f), ImVec2(0.5f, 0.5f), width, 0, true);
}
WR_CAUGHT(false)

extern "C" bool wr_gui_dialog_begin_at(const char *title, SDL_Rect place)
try {
    return dialog(title, ImVec2((float)place.x, (float)place.y), ImVec2(0, 0), (float)place.w,
                  (float)place.h, false);
}
WR_CAUGHT(false)

extern "C" void wr_gui_dialog_end(void)
{
    wr_gui_count_space();
    ImGui::EndPopup();
}

extern "C" bool wr_gui_escape_pressed(void)
{
    return !wr_gui_current()->list_open && wr_gui_went_down(SDL_SCANCODE_ESCAPE);
}

bool wr_gui_return_for_list()
{
    return !ImGui::GetIO().WantTextInput &&
           (wr_gui_went_down(SDL_SCANCODE_RETURN) || wr_gui_went_down(SDL_SCANCODE_KP_ENTER));
}

extern "C" bool wr_gui_return_pressed(void)
{
    return !wr_gui_current()->list_open && wr_gui_return_for_list();
}

extern "C" bool wr_gui_letter_pressed(SDL_Scancode key)
{
    return !wr_gui_current()->list_open && !ImGui::GetIO().WantTextInput && wr_gui_went_down(key);
}

extern "C" bool wr_gui_key_pressed(SDL_Scancode key)
{
    return wr_gui_key_repeats(key);
}

extern "C" bool wr_gui_field_left(void)
{
    return ImGui::IsItemDeactivated();
}

extern "C" bool wr_gui_text_field(const char *id, double width, char *text, size_t size, bool focus)
try {
    wr_gui_pin_step();
    ImGui::SetNextItemWidth(width > 0 ? (float)width : -1.0f);
    if (focus || wr_gui_focus_pressed(ImGui::GetID(id))) wr_gui_keyboard_here();
    bool done = ImGui::InputText(
        id, text, size, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    wr_gui_stop(WR_STOP_TEXT, false);
    wr_gui_edge(ImGui::GetWindowDrawList(), ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
    return done;
}
WR_CAUGHT(false)

/* Typing replaces the whole text, as in single-line fields. */
static int select_all(ImGuiInputTextCallbackData *data)
{
    data->SelectAll();
    static_cast<WrGui *>(data->UserData)->selecting = 0;
    return 0;
}

extern "C" bool wr_gui_text_area(const char *id, int lines, char *text, size_t size, bool focus)
try {
    wr_gui_pin_step();
    WrGui *gui = wr_gui_current();
    float tall = ImGui::GetTextLineHeight() * (float)lines + 2 * ImGui::GetStyle().FramePadding.y;
    if (focus || wr_gui_focus_pressed(ImGui::GetID(id))) {
        wr_gui_keyboard_here();
        gui->selecting = ImGui::GetID(id);
    }
    bool pending = gui->selecting == ImGui::GetID(id);
    bool changed = ImGui::InputTextMultiline(id, text, size, ImVec2(-1.0f, tall),
                                             pending ? ImGuiInputTextFlags_CallbackAlways : 0,
                                             pending ? select_all : nullptr, gui);
    wr_gui_stop_at(WR_STOP_TEXT, ImGui::GetID(id), false, ImGui::GetItemRectMin(),
                   ImGui::GetItemRectMax());
    wr_gui_edge(ImGui::GetWindowDrawList(), ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
    return changed;
}
WR_CAUGHT(false)

extern "C" int wr_gui_list_row(const char *icon, const char *label, bool selected)
try {
    wr_gui_pin_step();
    char text[1100];
    char said[320];
    snprintf(text, sizeof text, "%s%s%s", icon ? wr_gui_icon(icon) : "", icon ? "  " : "",
             wr_gui_labelled(label, said));
    bool pressed = ImGui::Selectable(text, selected, ImGuiSelectableFlags_AllowDoubleClick);
    wr_gui_stop(WR_STOP_LIST, selected);
    if (!pressed) return 0;
    const ImGuiID id = ImGui::GetItemID();
    const bool enter =
        wr_gui_focus_key(id, SDL_SCANCODE_RETURN) || wr_gui_focus_key(id, SDL_SCANCODE_KP_ENTER);
    return enter || wr_gui_current()->clicks == 2 || ImGui::IsMouseDoubleClicked(0) ? 2 : 1;
}
WR_CAUGHT(0)

extern "C" void wr_gui_list_begin(const char *id, double height)
try {
    wr_gui_pin_step();
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(8), px(8)));
    ImGui::BeginChild(id, ImVec2(0, (float)height), true);
    ImGui::PopStyleVar();
}
WR_CAUGHT()

extern "C" void wr_gui_list_end(void)
{
    wr_gui_stop_scrolled();
    wr_gui_count_space();
    ImGui::EndChild();
}

/* ---- choice of one of several side by side ---- */

/* Segments and tabs. */

static bool segment(const char *id, const char *said, ImVec2 size, WrColour ground, bool on)
{
    ImDrawList *list = ImGui::GetWindowDrawList();
    const ImVec2 at = ImGui::GetCursorScreenPos(), end(at.x + size.x, at.y + size.y);
    const ImVec2 text = ImGui::CalcTextSize(said);
    bool pressed = ImGui::InvisibleButton(id, size);
    wr_gui_stop(WR_STOP_SEGMENT, on);
    list->AddRectFilled(at, end, wr_gui_colour_u32(WR_COLOUR_FIELD));
    if (on)
        list->AddRectFilled(ImVec2(at.x + 1, at.y + 1), ImVec2(end.x - 1, end.y - 1),
                            wr_gui_colour_u32(ground));
    WrColour ink = on                       ? WR_COLOUR_STRONG
                   : ImGui::IsItemHovered() ? WR_COLOUR_TEXT
                                            : WR_COLOUR_LABEL;
    list->AddText(
        ImVec2(at.x + roundf((size.x - text.x) / 2), at.y + roundf((size.y - text.y) / 2)),
        wr_gui_colour_u32(ink), said);
    wr_gui_fits_window(said);
    return pressed;
}

/* In one row; more tightly if there is little room, and in several rows if there is less. */
extern "C" bool wr_gui_segments(const char *id, const char *const *items, const WrColour *colours,
                                int count, int *index)
try {
    wr_gui_pin_step();
    bool changed = false;
    wr_gui_row_choices(items, count);
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

#define BAR_PAD 9 /* beside each text of segments in the menu bar, units */

extern "C" double wr_gui_bar_segments_width(const char *const *items, int count)
try {
    float wide = 2 * px(BAR_PAD) * (float)count;
    for (int i = 0; i < count; i++) wide += ImGui::CalcTextSize(wr_gui_said(items[i])).x;
    return (double)wide;
}
WR_CAUGHT(0.0)

extern "C" bool wr_gui_bar_segments(const char *id, const char *const *items, int count, int *index)
try {
    bool changed = false;
    ImGui::PushID(id);
    const float bar = ImGui::GetWindowHeight(), h = roundf(ImGui::GetTextLineHeight() + px(8));
    ImGui::SetCursorPosY(roundf((bar - h) / 2));
    ImVec2 start = ImGui::GetCursorScreenPos(), end = start;
    for (int i = 0; i < count; i++) {
        const char *said = wr_gui_said(items[i]);
        const float w = ImGui::CalcTextSize(said).x + 2 * px(BAR_PAD);
        if (i) ImGui::SetCursorScreenPos(ImVec2(end.x, start.y));
        if (segment(items[i], said, ImVec2(w, h), WR_COLOUR_SELECTED, i == *index)) {
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

#define TAB_GAP 14 /* least distance of two labels, units */

/* Tabs from `first` that fit into a row, at least one; their widths in *wide. */
static int tabs_in_row(const char *const *items, int first, int count, float width, float *wide)
{
    int n = 0;
    *wide = 0;
    while (first + n < count) {
        const float more = ImGui::CalcTextSize(wr_gui_said(items[first + n])).x;
        if (n > 0 && *wide + more + px(TAB_GAP) * (float)(n + 1) > width) break;
        *wide += more;
        n++;
    }
    return n;
}

static int rows_of_tabs(const char *const *items, int count, float width)
{
    float wide;
    int rows = 0;
    for (int i = 0; i < count; rows++) i += tabs_in_row(items, i, count, width, &wide);
    return rows;
}

static bool small_tabs(const char *const *items, int count, float width)
{
    return rows_of_tabs(items, count, width) > 1;
}

static int rows_in_font(const char *const *items, int count, float width, bool small)
{
    if (small) ImGui::PushFont(wr_gui_current()->fonts[WR_FONT_SMALL]);
    const int rows = rows_of_tabs(items, count, width);
    if (small) ImGui::PopFont();
    return rows;
}

extern "C" int wr_gui_tab_rows(const char *const *items, int count, double width)
try {
    const bool small = small_tabs(items, count, (float)width);
    const int rows = rows_in_font(items, count, (float)width, small);
    return rows > 0 ? rows : 1;
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
        list->AddRectFilled(at, end, wr_gui_colour_u32(WR_COLOUR_PANEL));
        list->AddRectFilled(at, ImVec2(end.x, at.y + px(2)), wr_gui_colour_u32(WR_COLOUR_ACCENT));
    }
    const char *said = wr_gui_said(label);
    ImVec2 text = ImGui::CalcTextSize(said);
    wr_gui_fits(said, text.x, size.x - px(TAB_GAP) + 2);
    bool bright = on || ImGui::IsItemHovered();
    list->AddText(
        ImVec2(at.x + roundf((size.x - text.x) / 2), at.y + roundf((size.y - text.y) / 2)),
        wr_gui_colour_u32(bright ? WR_COLOUR_STRONG : WR_COLOUR_LABEL), said);
    return pressed;
}

/* The last tab was dragged out of the bar, or pressed with the right button. */
static void note_tab(int index, float bar_height)
{
    WrGui *gui = wr_gui_current();
    const float y = ImGui::GetIO().MousePos.y - ImGui::GetWindowPos().y;
    const bool out = y < -px(16) || y > bar_height + px(16);
    if (ImGui::IsItemActive() && out && ImGui::IsMouseDragPastThreshold(0, px(5)))
        gui->tab_torn = index;
    if ((ImGui::IsItemHovered() && ImGui::IsMouseClicked(1)) ||
        wr_gui_focus_menu(ImGui::GetItemID()))
        gui->tab_menu = index;
}

/* Rows are filled evenly: each has the width that the last one would need too. */
extern "C" bool wr_gui_tabs(const char *id, const char *const *items, int count, int *index)
try {
    WrGui *gui = wr_gui_current();
    bool changed = false;
    ImGui::PushID(id);
    ImDrawList *list = ImGui::GetWindowDrawList();
    ImVec2 origin = ImGui::GetWindowPos();
    const float width = ImGui::GetWindowWidth(), h = px(32);
    const bool small = small_tabs(items, count, width);
    const int rows = rows_in_font(items, count, width, small);
    gui->tab_torn = gui->tab_menu = -1;
    /* over the padding */
    list->PushClipRect(origin, ImVec2(origin.x + width, origin.y + h * (float)rows));
    if (small) ImGui::PushFont(gui->fonts[WR_FONT_SMALL]);
    for (int row = 0, first = 0; first < count; row++) {
        float wide, end = 0;
        int n = tabs_in_row(items, first, count, width, &wide);
        const int left = count - first, rows_left = rows > row + 1 ? rows - row : 1;
        const int even = (left + rows_left - 1) / rows_left;
        /* as long as the rest fits into the other rows */
        while (n > even && rows_of_tabs(items + first + n - 1, left - n + 1, width) < rows_left)
            wide -= ImGui::CalcTextSize(wr_gui_said(items[first + --n])).x;
        const float gap = (width - wide) / (float)n;
        for (int i = first; i < first + n; i++) {
            float x0 = roundf(end);
            end += ImGui::CalcTextSize(wr_gui_said(items[i])).x + gap;
            ImVec2 place(x0, h * (float)row), size(roundf(end) - x0, h);
            if (tab(items[i], place, size, i == *index)) {
                changed = i != *index;
                *index = i;
            }
            note_tab(i, h * (float)rows);
        }
        first += n;
    }
    if (small) ImGui::PopFont();
    list->PopClipRect();
    ImGui::SetCursorPosY(h * (float)rows + px(12));
    ImGui::PopID();
    return changed;
}
WR_CAUGHT(false)

extern "C" int wr_gui_tab_torn(void)
{
    return wr_gui_current()->tab_torn;
}

extern "C" int wr_gui_tab_menu(void)
{
    return wr_gui_current()->tab_menu;
}
