/* Keyboard navigation: the widget with the ring, movement by keys, and keys passed to the widget. Each widget
   registers in every frame (wr_gui_stop); a key is handled before the next frame with the stops of the last one. */
#include "ui/toolkit/gui_imgui.h"

#include <imgui_internal.h>

/* ---- registration ---- */

static void gui_go_to(WrFocus *focus, const WrKeyStop *stop);
static const WrKeyStop *gui_entrance(const ImGuiContext &g, const WrFocus *focus,
                                     const WrKeyStop *stop);
static void gui_take_key(WrFocus *focus);

bool wr_gui_is_list(const ImGuiWindow *window)
{
    const ImGuiWindowFlags own = ImGuiWindowFlags_Popup | ImGuiWindowFlags_ChildMenu;
    return (window->Flags & ImGuiWindowFlags_ChildWindow) && !(window->Flags & own);
}

static const ImGuiWindow *part_of(const ImGuiWindow *window)
{
    while (wr_gui_is_list(window) && window->ParentWindow) window = window->ParentWindow;
    return window;
}

/* Number of open popups, dialogs included; and the topmost one's window, NULL if there is none. */
static int gui_levels_open(const ImGuiContext &g)
{
    return g.OpenPopupStack.Size < WR_GUI_LEVELS ? g.OpenPopupStack.Size : WR_GUI_LEVELS;
}

static const ImGuiWindow *gui_top_of(const ImGuiContext &g)
{
    return g.OpenPopupStack.Size > 0 ? g.OpenPopupStack.back().Window : nullptr;
}

static bool gui_is_dialog(const ImGuiWindow *window)
{
    return window && (window->Flags & ImGuiWindowFlags_Modal);
}

/* True if the keys can reach it now: while a popup is open, only its content. */
static bool gui_reachable(const ImGuiContext &g, const WrKeyStop *stop)
{
    const ImGuiWindow *top = gui_top_of(g);
    return g.OpenPopupStack.Size == 0 || (top && stop->part == top->ID);
}

/* The stop of the last frame; NULL: not there. */
static const WrKeyStop *gui_find_stop(const WrFocus *focus, ImGuiID id)
{
    for (int i = 0; id && i < focus->count; i++)
        if (focus->stops[i].id == id) return &focus->stops[i];
    return nullptr;
}

static bool grouped(WrKeyStopKind kind)
{
    return kind == WR_STOP_MENU || kind == WR_STOP_SEGMENT || kind == WR_STOP_TAB ||
           kind == WR_STOP_TILE || kind == WR_STOP_LIST;
}

/* Neighbours of a kind form a group; segments and tabs only within one set. */
static int group_of(const WrFocus *focus, const WrKeyStop *stop, ImGuiID set)
{
    static int newest;
    static ImGuiID newest_set;
    /* last one of its window: entries of an open menu come between */
    const WrKeyStop *last = nullptr;
    if (focus->coming_count == 0) newest = 0;
    if (!grouped(stop->kind)) return 0;
    for (int i = focus->coming_count - 1; i >= 0 && !last; i--)
        if (focus->coming[i].window == stop->window) last = &focus->coming[i];
    bool same = last && last->kind == stop->kind;
    if (stop->kind == WR_STOP_SEGMENT || stop->kind == WR_STOP_TAB) same &= newest_set == set;
    newest_set = set;
    return same ? last->group : ++newest;
}

static void add(ImGuiWindow *window, WrKeyStopKind kind, ImGuiID id, bool chosen, ImVec2 low,
                ImVec2 high)
{
    WrGui *gui = wr_gui_current();
    WrFocus *focus = &gui->focus;
    ImGuiContext &g = *ImGui::GetCurrentContext();
    if (&g != gui->context || focus->coming_count >= WR_GUI_STOPS || !id) return;
    if (window->SkipItems || (g.CurrentItemFlags & ImGuiItemFlags_Disabled)) return;
    WrKeyStop stop = {
        id, part_of(window)->ID, window->ID, 0, kind, chosen, low.x, low.y, high.x, high.y
    };
    stop.group = group_of(focus, &stop, window->IDStack.back());
    if (focus->first && focus->shown && g.OpenPopupStack.Size > 0 && gui_reachable(g, &stop)) {
        focus->at = id;
        focus->first = false;
        focus->moved = true;
    }
    if (id == focus->at) {
        focus->index = focus->coming_count;
        if (focus->moved) {
            const float around = kind == WR_STOP_TILE || kind == WR_STOP_ROW || kind == WR_STOP_LIST
                                     ? high.y - low.y
                                     : ImGui::GetFrameHeight() / 2;
            ImRect room(ImVec2(low.x, low.y - around), ImVec2(high.x, high.y + around));
            ImGui::ScrollToBringRectIntoView(window, room);
            focus->moved = false;
        }
    }
    focus->coming[focus->coming_count++] = stop;
}

void wr_gui_stop_at(WrKeyStopKind kind, ImGuiID id, bool chosen, ImVec2 low, ImVec2 high)
{
    add(ImGui::GetCurrentWindow(), kind, id, chosen, low, high);
}

void wr_gui_stop_open(ImGuiWindow *window, ImGuiID id)
{
    const WrKeyStop *was = gui_find_stop(&wr_gui_current()->focus, id);
    if (!was) return;
    add(window, WR_STOP_MENU, id, false, ImVec2(was->x0, was->y0), ImVec2(was->x1, was->y1));
}

void wr_gui_stop(WrKeyStopKind kind, bool chosen)
{
    WrFocus *focus = &wr_gui_current()->focus;
    wr_gui_stop_at(kind, ImGui::GetItemID(), chosen, ImGui::GetItemRectMin(),
                   ImGui::GetItemRectMax());
    if (ImGui::IsItemActive() && !focus->shown) focus->at = ImGui::GetItemID();
}

void wr_gui_stop_scrolled()
{
    const WrFocus *focus = &wr_gui_current()->focus;
    const ImGuiWindow *window = ImGui::GetCurrentWindow();
    if (window->ScrollMax.y <= 0) return;
    for (int i = focus->coming_count - 1; i >= 0; i--)
        if (focus->coming[i].window == window->ID) return;
    wr_gui_stop_at(WR_STOP_SCROLL, window->ID, false, window->InnerRect.Min, window->InnerRect.Max);
}

/* ---- queries by widgets ---- */

bool wr_gui_focused(ImGuiID id)
{
    const WrFocus *focus = &wr_gui_current()->focus;
    return focus->shown && focus->at == id && id;
}

bool wr_gui_focus_pressed(ImGuiID id)
{
    return wr_gui_focused(id) && wr_gui_current()->focus.pressed;
}

bool wr_gui_focus_key(ImGuiID id, SDL_Scancode key)
{
    return wr_gui_focused(id) && wr_gui_current()->focus.key.scancode == key;
}

bool wr_gui_focus_menu(ImGuiID id)
{
    return wr_gui_focus_key(id, SDL_SCANCODE_APPLICATION) || wr_gui_focus_key(id, SDL_SCANCODE_F10);
}

int wr_gui_focus_arrows(ImGuiID id, bool both)
{
    int step = wr_gui_focus_key(id, SDL_SCANCODE_UP) - wr_gui_focus_key(id, SDL_SCANCODE_DOWN);
    if (both)
        step += wr_gui_focus_key(id, SDL_SCANCODE_RIGHT) - wr_gui_focus_key(id, SDL_SCANCODE_LEFT);
    return step;
}

/* ---- frames ---- */

/* Number of the last frame's popups that are still open. */
static int levels_kept(const WrFocus *focus)
{
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    int kept = 0;
    while (kept < focus->levels && kept < gui_levels_open(g) &&
           focus->popups[kept] == g.OpenPopupStack[kept].PopupId)
        kept++;
    return kept;
}

/* Closed popups restore the earlier focus; opened ones get the focus. */
static void follow_popups(WrFocus *focus)
{
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    const int levels = gui_levels_open(g), kept = levels_kept(focus);
    for (int i = focus->levels - 1; i >= kept && !focus->beside; i--) {
        focus->first = false;
        if (!focus->shown && !focus->before[i]) continue;
        focus->at = focus->openers[i];
        focus->shown = focus->at != 0;
        focus->moved = true;
    }
    for (int i = kept; i < levels; i++) {
        focus->popups[i] = g.OpenPopupStack[i].PopupId;
        focus->openers[i] = focus->at;
        focus->before[i] = focus->shown;
        const bool dialog = gui_is_dialog(g.OpenPopupStack[i].Window);
        focus->first = focus->shown && !dialog;
        focus->at = 0;
        focus->index = 0;
        if (dialog) focus->shown = false;
    }
    focus->levels = levels;
    focus->beside = false;
}

void wr_gui_focus_before(WrGui *gui)
{
    WrFocus *focus = &gui->focus;
    if (ImGui::GetCurrentContext() != gui->context) return;
    focus->key = SDL_Keysym{};
    focus->pressed = focus->stepped_rows = false;
    focus->close_to = -1;
    follow_popups(focus);
    if (focus->waiting_count > 0) {
        gui_take_key(focus);
    } else if (focus->arrow_let_go) {
        focus->arrow_let_go = false;
        if (focus->stepped) focus->step_ends = true;
    }
    focus->coming_count = 0;
}

void wr_gui_focus_begun(WrGui *gui)
{
    WrFocus *focus = &gui->focus;
    ImGuiContext &g = *ImGui::GetCurrentContext();
    if (&g != gui->context) return;
    if (focus->stop_typing) ImGui::ClearActiveID();
    focus->stop_typing = false;
    if (focus->close_to >= 0 && g.OpenPopupStack.Size > focus->close_to)
        ImGui::ClosePopupToLevel(focus->close_to, false);
    if (focus->shown && g.IO.MouseDelta.x == 0 && g.IO.MouseDelta.y == 0)
        wr_gui_ignore_hover(); /* the widget under the pointer is not the target */
}

static void draw_ring(const WrKeyStop *stop)
{
    const ImGuiWindow *window = ImGui::FindWindowByID(stop->window);
    if (!window) return;
    const float w = (float)wr_gui_px(2), out = w;
    ImRect ring(stop->x0 - out, stop->y0 - out, stop->x1 + out, stop->y1 + out);
    ring.ClipWith(window->OuterRectClipped);
    if (ring.GetWidth() < 3 * w || ring.GetHeight() < 3 * w) return;
    ImDrawList *list = ImGui::GetForegroundDrawList();
    const ImU32 ink = wr_gui_colour_u32(WR_COLOUR_FOCUS);
    list->AddRectFilled(ring.Min, ImVec2(ring.Max.x, ring.Min.y + w), ink);
    list->AddRectFilled(ImVec2(ring.Min.x, ring.Max.y - w), ring.Max, ink);
    list->AddRectFilled(ring.Min, ImVec2(ring.Min.x + w, ring.Max.y), ink);
    list->AddRectFilled(ImVec2(ring.Max.x - w, ring.Min.y), ring.Max, ink);
}

/* The focused widget has vanished: focus the one now at its position. */
static void keep_place(WrFocus *focus)
{
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    if (!focus->shown || focus->first || focus->count == 0 || !focus->at) return;
    if (gui_find_stop(focus, focus->at)) return;
    for (int i = focus->index < focus->count ? focus->index : focus->count - 1; i >= 0; i--)
        if (gui_reachable(g, &focus->stops[i])) {
            gui_go_to(focus, &focus->stops[i]);
            return;
        }
}

void wr_gui_focus_end(WrGui *gui)
{
    WrFocus *focus = &gui->focus;
    if (ImGui::GetCurrentContext() != gui->context) return;
    WrKeyStop *old = focus->stops;
    focus->stops = focus->coming;
    focus->coming = old;
    focus->count = focus->coming_count;
    focus->step_ends = false;
    if (focus->levels == gui_levels_open(*ImGui::GetCurrentContext())) keep_place(focus);
    const WrKeyStop *now = gui_find_stop(focus, focus->at);
    if (focus->shown && now) draw_ring(now);
    if (!now) focus->moved = false; /* input must not wait for a frame that scrolls to it */
    if (focus->stepped && !gui_find_stop(focus, focus->stepped)) focus->stepped = 0;
}

/* ---- calls from other modules ---- */

extern "C" void wr_gui_focus_part(WrGui *gui, int way)
{
    WrFocus *focus = &gui->focus;
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    if (g.OpenPopupStack.Size > 0 || focus->count == 0) return;
    const WrKeyStop *now = gui_find_stop(focus, focus->at);
    int i = now && focus->shown ? (int)(now - focus->stops) : way > 0 ? -1 : focus->count;
    const unsigned part = now && focus->shown ? now->part : 0;
    for (i += way; i >= 0 && i < focus->count && focus->stops[i].part == part;) i += way;
    if (i < 0 || i >= focus->count) { /* the canvas */
        focus->shown = false;
        focus->at = 0;
        return;
    }
    while (way < 0 && i > 0 && focus->stops[i - 1].part == focus->stops[i].part) i--;
    focus->stop_typing = g.IO.WantTextInput;
    gui_go_to(focus, gui_entrance(g, focus, &focus->stops[i]));
}

extern "C" void wr_gui_focus_menus(WrGui *gui, bool opened)
{
    WrFocus *focus = &gui->focus;
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    if (g.OpenPopupStack.Size > 0) return;
    for (int i = 0; i < focus->count; i++) {
        if (focus->stops[i].kind != WR_STOP_MENU) continue;
        focus->home = focus->shown ? focus->at : 0;
        focus->in_menus = true;
        gui_go_to(focus, &focus->stops[i]);
        if (opened) wr_gui_activate(focus->at);
        return;
    }
}

extern "C" const WrKeyStop *wr_gui_stops(const WrGui *gui, int *count)
{
    *count = gui->focus.count;
    return gui->focus.stops;
}

extern "C" bool wr_gui_focus_on(WrGui *gui, unsigned id)
{
    const WrKeyStop *stop = gui_find_stop(&gui->focus, id);
    if (!stop || !gui_reachable(*ImGui::GetCurrentContext(), stop)) return false;
    gui_go_to(&gui->focus, stop);
    return true;
}

extern "C" unsigned wr_gui_focus_now(const WrGui *gui)
{
    return gui->focus.shown ? gui->focus.at : 0;
}

extern "C" unsigned wr_gui_under_pointer(void)
{
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    ImGuiWindow *window = g.HoveredWindow;
    if (wr_gui_disabled_hovered() || !window) return 0;
    if (g.HoveredId == ImGui::GetWindowScrollbarID(window, ImGuiAxis_X) ||
        g.HoveredId == ImGui::GetWindowScrollbarID(window, ImGuiAxis_Y))
        return 0; /* keys scroll its content */
    return g.HoveredId;
}

/* ---- handling of keys by the focus ---- */

/* Movement of the ring, presses, and the keys withheld from the canvas. */

extern "C" {
#include "system/clock.h"
}

#include <math.h>
#include <string.h>

#define TAP_SECONDS 0.4 /* longest press of Alt that opens the menus */

/* True for menus and lists of entries; not for dialogs. */
static bool is_menu(const ImGuiWindow *window)
{
    return window && !gui_is_dialog(window);
}

/* ---- movement ---- */

/* Move the ring to a stop of the last frame. */
static void gui_go_to(WrFocus *focus, const WrKeyStop *stop)
{
    if (focus->stepped && focus->at != stop->id) focus->step_ends = true;
    focus->at = stop->id;
    focus->index = (int)(stop - focus->stops);
    focus->shown = focus->moved = true;
    focus->pad_held = false;
    focus->pad_x = focus->pad_y = 0.5f;
}

/* The stop of a group that Tab reaches: the chosen one, or the first. */
static const WrKeyStop *gui_entrance(const ImGuiContext &g, const WrFocus *focus,
                                     const WrKeyStop *stop)
{
    if (!stop->group) return stop;
    const WrKeyStop *first = nullptr;
    for (int i = 0; i < focus->count; i++) {
        const WrKeyStop *s = &focus->stops[i];
        if (s->group != stop->group || !gui_reachable(g, s)) continue;
        if (s->chosen) return s;
        if (!first) first = s;
    }
    return first ? first : stop;
}

/* The next stop outside the group; wraps at the ends. */
static const WrKeyStop *next_of(const WrFocus *focus, int way, bool groups)
{
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    const WrKeyStop *now = gui_find_stop(focus, focus->at);
    int at = now ? (int)(now - focus->stops) : focus->index - (way > 0);
    if (!now && !focus->at) at = way > 0 ? -1 : focus->count;
    for (int n = 0, i = at; n < focus->count; n++) {
        i = (i + way + 2 * focus->count) % focus->count;
        const WrKeyStop *s = &focus->stops[i];
        if (!gui_reachable(g, s) || (groups && now && now->group && s->group == now->group))
            continue;
        return groups ? gui_entrance(g, focus, s) : s;
    }
    return nullptr;
}

static void move_by(WrFocus *focus, int way, bool groups)
{
    const WrKeyStop *to = focus->count > 0 ? next_of(focus, way, groups) : nullptr;
    if (to) gui_go_to(focus, to);
}

/* The nearest stop of the group above or below: tiles are in rows. */
static const WrKeyStop *beyond(const WrFocus *focus, const WrKeyStop *now, int way)
{
    const WrKeyStop *best = nullptr;
    float least = FLT_MAX;
    for (int i = 0; i < focus->count; i++) {
        const WrKeyStop *s = &focus->stops[i];
        const float down = (s->y0 - now->y0) * (float)way;
        if (s->group != now->group || down < (now->y1 - now->y0) / 2) continue;
        const float far = down * 4 + fabsf(s->x0 - now->x0);
        if (far < least) least = far, best = s;
    }
    return best;
}

static const WrKeyStop *beside(const WrFocus *focus, const WrKeyStop *now, int way)
{
    const WrKeyStop *end = focus->stops + focus->count;
    for (const WrKeyStop *to = now + way; to >= focus->stops && to < end; to += way)
        if (to->group == now->group) return to;
    return nullptr;
}

/* ---- menus ---- */

static void press(WrFocus *focus, ImGuiID id)
{
    focus->pressed = true;
    wr_gui_activate(id);
}

/* Open the neighbouring menu in place of the open one. */
static bool other_menu(WrFocus *focus, int way)
{
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    if (gui_levels_open(g) != 1) return false;
    const WrKeyStop *from = gui_find_stop(focus, focus->openers[0]);
    if (!from || from->kind != WR_STOP_MENU) return false;
    const WrKeyStop *to = beside(focus, from, way);
    for (const WrKeyStop *s = from; !to && s; s = beside(focus, s, -way)) /* wraps */
        if (!beside(focus, s, -way)) to = s;
    if (!to) return false;
    focus->close_to = 0;
    focus->beside = true;
    gui_go_to(focus, to);
    wr_gui_activate(to->id);
    return true;
}

/* Keys in a menu: along it, into a submenu, back, or to the neighbouring menu. True if handled. */
static bool key_in_menu(WrFocus *focus, const WrKeyStop *now, SDL_Scancode key)
{
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    if (key == SDL_SCANCODE_RIGHT && now && now->kind == WR_STOP_MENU) press(focus, now->id);
    else if (key == SDL_SCANCODE_LEFT && gui_levels_open(g) > 1 &&
             (gui_top_of(g)->Flags & ImGuiWindowFlags_ChildMenu))
        focus->close_to = g.OpenPopupStack.Size - 1;
    else if (key == SDL_SCANCODE_RIGHT || key == SDL_SCANCODE_LEFT)
        return other_menu(focus, key == SDL_SCANCODE_RIGHT ? 1 : -1);
    else return false;
    return true;
}

/* ---- key handling ---- */

static int way_of(SDL_Scancode key)
{
    return key == SDL_SCANCODE_DOWN || key == SDL_SCANCODE_RIGHT ? 1 : -1;
}

static bool is_arrow(SDL_Scancode key)
{
    return key == SDL_SCANCODE_UP || key == SDL_SCANCODE_DOWN || key == SDL_SCANCODE_LEFT ||
           key == SDL_SCANCODE_RIGHT;
}

static bool is_press(SDL_Scancode key)
{
    return key == SDL_SCANCODE_SPACE || key == SDL_SCANCODE_RETURN || key == SDL_SCANCODE_KP_ENTER;
}

static ImGuiWindow *scrolling(const WrFocus *focus)
{
    const WrKeyStop *now = gui_find_stop(focus, focus->at);
    ImGuiWindow *window = now ? ImGui::FindWindowByID(now->window) : nullptr;
    while (window && window->ScrollMax.y <= 0 && wr_gui_is_list(window))
        window = window->ParentWindow;
    return window && window->ScrollMax.y > 0 ? window : nullptr;
}

static void scroll(const WrFocus *focus, double pages)
{
    ImGuiWindow *window = scrolling(focus);
    if (!window) return;
    float to = window->Scroll.y + (float)pages * window->InnerRect.GetHeight();
    to = to < 0 ? 0 : to > window->ScrollMax.y ? window->ScrollMax.y : to;
    window->ScrollTarget.y = to;
    window->ScrollTargetCenterRatio.y = 0;
}

/* Move along a group; if one of it is chosen, the choice moves too. */
static void arrow_in_group(WrFocus *focus, const WrKeyStop *now, SDL_Scancode key)
{
    const bool across = key == SDL_SCANCODE_LEFT || key == SDL_SCANCODE_RIGHT;
    const WrKeyStop *to = now->kind == WR_STOP_TILE && !across ? beyond(focus, now, way_of(key))
                                                               : beside(focus, now, way_of(key));
    if (to) gui_go_to(focus, to);
    /* more of them may be beyond the visible part */
    else if (!across) scroll(focus, 0.3 * way_of(key));
    if (to && (now->kind == WR_STOP_SEGMENT || now->kind == WR_STOP_TAB)) press(focus, to->id);
}

/* Up and Down lead from row to row, past the widgets inside; the last row keeps the ring. */
static bool arrow_to_row(WrFocus *focus, const WrKeyStop *now, SDL_Scancode key)
{
    if (now->kind != WR_STOP_ROW || (key != SDL_SCANCODE_UP && key != SDL_SCANCODE_DOWN))
        return false;
    const WrKeyStop *end = focus->stops + focus->count;
    for (const WrKeyStop *to = now + way_of(key); to >= focus->stops && to < end; to += way_of(key))
        if (to->window == now->window && to->kind == WR_STOP_ROW) {
            gui_go_to(focus, to);
            focus->stepped_rows = true;
            break;
        }
    return true;
}

static void arrow(WrFocus *focus, const WrKeyStop *now, SDL_Scancode key, bool fine)
{
    const float step = fine ? 1.0f / 256 : 1.0f / 32;
    if (arrow_to_row(focus, now, key)) return;
    if (now->kind == WR_STOP_MENU && key == SDL_SCANCODE_DOWN) press(focus, now->id);
    else if (now->group) arrow_in_group(focus, now, key);
    else if (now->kind == WR_STOP_SCROLL) scroll(focus, 0.1 * way_of(key));
    else if (now->kind == WR_STOP_PAD && (key == SDL_SCANCODE_LEFT || key == SDL_SCANCODE_RIGHT))
        focus->pad_x = fminf(fmaxf(focus->pad_x + step * (float)way_of(key), 0), 1);
    else if (now->kind == WR_STOP_PAD)
        focus->pad_y = fminf(fmaxf(focus->pad_y + step * (float)way_of(key), 0), 1);
    else if (now->kind == WR_STOP_PRESS || now->kind == WR_STOP_ROW || now->kind == WR_STOP_TEXT)
        move_by(focus, way_of(key), false);
}

static void end_of_group(WrFocus *focus, const WrKeyStop *now, bool last)
{
    const WrKeyStop *to = now;
    for (const WrKeyStop *s = now; s; s = beside(focus, s, last ? 1 : -1)) to = s;
    gui_go_to(focus, to);
}

/* Text fields, number fields and widgets that open a list handle keys themselves (focus->key). */
static void key_on(WrFocus *focus, const WrKeyStop *now, const SDL_Keysym *key)
{
    const SDL_Scancode code = key->scancode;
    focus->key = *key;
    if (is_press(code) && now->kind == WR_STOP_PAD) focus->pad_held = !focus->pad_held;
    else if (is_press(code) && (now->kind == WR_STOP_TEXT || now->kind == WR_STOP_NUMBER))
        focus->pressed = true;
    else if (is_press(code)) {
        if (now->kind == WR_STOP_ITEM && focus->in_menus) focus->openers[0] = focus->home;
        press(focus, now->id);
    } else if (is_arrow(code)) arrow(focus, now, code, (key->mod & KMOD_SHIFT) != 0);
    else if (code == SDL_SCANCODE_HOME || code == SDL_SCANCODE_END)
        end_of_group(focus, now, code == SDL_SCANCODE_END);
    else if (code == SDL_SCANCODE_PAGEUP || code == SDL_SCANCODE_PAGEDOWN)
        scroll(focus, code == SDL_SCANCODE_PAGEDOWN ? 0.9 : -0.9);
}

static void take(WrFocus *focus, const SDL_Keysym *key)
{
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    const WrKeyStop *now = gui_find_stop(focus, focus->at);
    const SDL_Scancode code = key->scancode;
    if (now && !gui_reachable(g, now)) now = nullptr;
    if (code == SDL_SCANCODE_TAB) {
        focus->stop_typing = ImGui::GetIO().WantTextInput;
        move_by(focus, key->mod & KMOD_SHIFT ? -1 : 1, true);
        now = gui_find_stop(focus, focus->at);
        focus->pressed = now && now->kind == WR_STOP_TEXT; /* so that typing can start at once */
    } else if (code == SDL_SCANCODE_ESCAPE) {
        focus->shown = focus->in_menus = false;
        focus->at = 0;
    } else if (is_menu(gui_top_of(g)) && key_in_menu(focus, now, code)) {
        return;
    } else if (is_menu(gui_top_of(g)) && is_arrow(code) &&
               (!now || now->kind == WR_STOP_ITEM || now->kind == WR_STOP_MENU)) {
        move_by(focus, way_of(code), false);
    } else if (now) {
        key_on(focus, now, key);
    }
}

/* Handle the first queued key. */
static void gui_take_key(WrFocus *focus)
{
    const SDL_Keysym key = focus->waiting[0];
    focus->waiting_count--;
    memmove(focus->waiting, focus->waiting + 1,
            (size_t)focus->waiting_count * sizeof *focus->waiting);
    take(focus, &key);
}

/* ---- events ---- */

/* True for keys used by the widget with the ring. */
static bool is_for(const WrGui *gui, const WrKeyStop *now, const SDL_Keysym *key)
{
    const SDL_Scancode code = key->scancode;
    if (is_arrow(code) || is_press(code)) return true;
    if (code == SDL_SCANCODE_HOME || code == SDL_SCANCODE_END) return now && now->group;
    if (code == SDL_SCANCODE_PAGEUP || code == SDL_SCANCODE_PAGEDOWN)
        return scrolling(&gui->focus) != nullptr;
    if (code == SDL_SCANCODE_BACKSPACE || code == SDL_SCANCODE_DELETE)
        return now && now->kind == WR_STOP_NUMBER;
    if (code == SDL_SCANCODE_F10) return (key->mod & KMOD_SHIFT) != 0;
    return code == SDL_SCANCODE_APPLICATION;
}

static bool wants(const WrGui *gui, const SDL_Keysym *key)
{
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    const WrFocus *focus = &gui->focus;
    const bool typing = wr_gui_wants_text(gui), shown = focus->shown || focus->waiting_count > 0;
    if (key->mod & (KMOD_CTRL | KMOD_ALT | KMOD_GUI)) return false;
    if (key->scancode == SDL_SCANCODE_TAB) return shown || typing || g.OpenPopupStack.Size > 0;
    if (typing) return false;
    const ImGuiWindow *top = gui_top_of(g);
    const WrKeyStop *now = gui_find_stop(focus, focus->at);
    if (is_menu(top)) { /* a list without stops handles keys itself */
        bool any = false;
        for (int i = 0; i < focus->count && !any; i++) any = gui_reachable(g, &focus->stops[i]);
        if (!any || key->scancode == SDL_SCANCODE_ESCAPE) return false;
        return is_arrow(key->scancode) || (shown && is_for(gui, now, key));
    }
    if (!shown) return false;
    if (key->scancode == SDL_SCANCODE_ESCAPE) return !top; /* of the dialog itself */
    return is_for(gui, now, key);
}

/* True for Alt alone, without other keys in between. */
static bool alt_tapped(WrFocus *focus, const SDL_Event *event)
{
    const bool key = event->type == SDL_KEYDOWN || event->type == SDL_KEYUP;
    const bool alt = key && event->key.keysym.scancode == SDL_SCANCODE_LALT;
    if (alt && event->type == SDL_KEYDOWN && event->key.repeat) return false;
    const double since = wr_clock_seconds() - focus->alt_at;
    const bool tapped = alt && event->type == SDL_KEYUP && focus->alt_at > 0 && since < TAP_SECONDS;
    const bool alone = alt && event->type == SDL_KEYDOWN &&
                       !(event->key.keysym.mod & (KMOD_CTRL | KMOD_SHIFT | KMOD_GUI));
    if (event->type == SDL_TEXTINPUT) return false;
    focus->alt_at = alone ? wr_clock_seconds() : 0;
    return tapped;
}

bool wr_gui_focus_event(WrGui *gui, const SDL_Event *event)
{
    WrFocus *focus = &gui->focus;
    if (ImGui::GetCurrentContext() != gui->context) return false;
    if (event->type == SDL_MOUSEBUTTONDOWN) {
        focus->shown = focus->pad_held = focus->in_menus = false;
        focus->at = 0;
        if (focus->stepped) focus->step_ends = true;
    }
    if (alt_tapped(focus, event)) wr_gui_focus_menus(gui, false);
    if (event->type == SDL_KEYUP && is_arrow(event->key.keysym.scancode))
        focus->arrow_let_go = true;
    if (event->type != SDL_KEYDOWN) return false;
    focus->took = wants(gui, &event->key.keysym);
    if (!focus->took) return false;
    if (event->key.repeat && focus->waiting_count > 1)
        return true; /* the window is slower than the key
                                                                       repeat */
    if (focus->waiting_count < WR_GUI_WAITING)
        focus->waiting[focus->waiting_count++] = event->key.keysym;
    return true;
}

extern "C" bool wr_gui_took_key(const WrGui *gui)
{
    return gui->focus.took;
}
