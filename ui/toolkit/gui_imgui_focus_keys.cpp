/* Handling of keys by the focus: movement of the ring, presses, and the keys withheld from the canvas. */
#include "ui/toolkit/gui_imgui_focus.h"

extern "C" {
#include "system/clock.h"
}

#include <math.h>
#include <string.h>

#define TAP_SECONDS 0.4 /* longest press of Alt that opens the menus */

/* True for menus and lists of entries; not for dialogs. */
static bool is_menu(const ImGuiWindow *window)
{
    return window && !wr_gui_is_dialog(window);
}

/* ---- movement ---- */

void wr_gui_go_to(WrFocus *focus, const WrKeyStop *stop)
{
    if (focus->stepped && focus->at != stop->id) focus->step_ends = true;
    focus->at = stop->id;
    focus->index = (int)(stop - focus->stops);
    focus->shown = focus->moved = true;
    focus->pad_held = false;
    focus->pad_x = focus->pad_y = 0.5f;
}

const WrKeyStop *wr_gui_entrance(const ImGuiContext &g, const WrFocus *focus, const WrKeyStop *stop)
{
    if (!stop->group) return stop;
    const WrKeyStop *first = nullptr;
    for (int i = 0; i < focus->count; i++) {
        const WrKeyStop *s = &focus->stops[i];
        if (s->group != stop->group || !wr_gui_reachable(g, s)) continue;
        if (s->chosen) return s;
        if (!first) first = s;
    }
    return first ? first : stop;
}

/* The next stop outside the group; wraps at the ends. */
static const WrKeyStop *next_of(const WrFocus *focus, int way, bool groups)
{
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    const WrKeyStop *now = wr_gui_find_stop(focus, focus->at);
    int at = now ? (int)(now - focus->stops) : focus->index - (way > 0);
    if (!now && !focus->at) at = way > 0 ? -1 : focus->count;
    for (int n = 0, i = at; n < focus->count; n++) {
        i = (i + way + 2 * focus->count) % focus->count;
        const WrKeyStop *s = &focus->stops[i];
        if (!wr_gui_reachable(g, s) || (groups && now && now->group && s->group == now->group))
            continue;
        return groups ? wr_gui_entrance(g, focus, s) : s;
    }
    return nullptr;
}

static void move_by(WrFocus *focus, int way, bool groups)
{
    const WrKeyStop *to = focus->count > 0 ? next_of(focus, way, groups) : nullptr;
    if (to) wr_gui_go_to(focus, to);
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
    ImGui::ActivateItem(id);
}

/* Open the neighbouring menu in place of the open one. */
static bool other_menu(WrFocus *focus, int way)
{
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    if (wr_gui_levels_open(g) != 1) return false;
    const WrKeyStop *from = wr_gui_find_stop(focus, focus->openers[0]);
    if (!from || from->kind != WR_STOP_MENU) return false;
    const WrKeyStop *to = beside(focus, from, way);
    for (const WrKeyStop *s = from; !to && s; s = beside(focus, s, -way)) /* wraps */
        if (!beside(focus, s, -way)) to = s;
    if (!to) return false;
    focus->close_to = 0;
    focus->beside = true;
    wr_gui_go_to(focus, to);
    ImGui::ActivateItem(to->id);
    return true;
}

/* Keys in a menu: along it, into a submenu, back, or to the neighbouring menu. True if handled. */
static bool key_in_menu(WrFocus *focus, const WrKeyStop *now, SDL_Scancode key)
{
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    if (key == SDL_SCANCODE_RIGHT && now && now->kind == WR_STOP_MENU) press(focus, now->id);
    else if (key == SDL_SCANCODE_LEFT && wr_gui_levels_open(g) > 1 &&
             (wr_gui_top_of(g)->Flags & ImGuiWindowFlags_ChildMenu))
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
    const WrKeyStop *now = wr_gui_find_stop(focus, focus->at);
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
    if (to) wr_gui_go_to(focus, to);
    /* more of them may be beyond the visible part */
    else if (!across) scroll(focus, 0.3 * way_of(key));
    if (to && (now->kind == WR_STOP_SEGMENT || now->kind == WR_STOP_TAB)) press(focus, to->id);
}

static void arrow(WrFocus *focus, const WrKeyStop *now, SDL_Scancode key, bool fine)
{
    const float step = fine ? 1.0f / 256 : 1.0f / 32;
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
    wr_gui_go_to(focus, to);
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
    const WrKeyStop *now = wr_gui_find_stop(focus, focus->at);
    const SDL_Scancode code = key->scancode;
    if (now && !wr_gui_reachable(g, now)) now = nullptr;
    if (code == SDL_SCANCODE_TAB) {
        focus->stop_typing = ImGui::GetIO().WantTextInput;
        move_by(focus, key->mod & KMOD_SHIFT ? -1 : 1, true);
        now = wr_gui_find_stop(focus, focus->at);
        focus->pressed = now && now->kind == WR_STOP_TEXT; /* so that typing can start at once */
    } else if (code == SDL_SCANCODE_ESCAPE) {
        focus->shown = focus->in_menus = false;
        focus->at = 0;
    } else if (is_menu(wr_gui_top_of(g)) && key_in_menu(focus, now, code)) {
        return;
    } else if (is_menu(wr_gui_top_of(g)) && is_arrow(code) &&
               (!now || now->kind == WR_STOP_ITEM || now->kind == WR_STOP_MENU)) {
        move_by(focus, way_of(code), false);
    } else if (now) {
        key_on(focus, now, key);
    }
}

void wr_gui_take_key(WrFocus *focus)
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
    const ImGuiWindow *top = wr_gui_top_of(g);
    const WrKeyStop *now = wr_gui_find_stop(focus, focus->at);
    if (is_menu(top)) { /* a list without stops handles keys itself */
        bool any = false;
        for (int i = 0; i < focus->count && !any; i++) any = wr_gui_reachable(g, &focus->stops[i]);
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
