/* Keyboard navigation: the widget with the ring, movement by keys, and keys passed to the widget. Each widget
   registers in every frame (wr_gui_stop); a key is handled before the next frame with the stops of the last one. */
#include "ui/toolkit/gui_imgui_focus.h"

/* ---- registration ---- */

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

int wr_gui_levels_open(const ImGuiContext &g)
{
    return g.OpenPopupStack.Size < WR_GUI_LEVELS ? g.OpenPopupStack.Size : WR_GUI_LEVELS;
}

const ImGuiWindow *wr_gui_top_of(const ImGuiContext &g)
{
    return g.OpenPopupStack.Size > 0 ? g.OpenPopupStack.back().Window : nullptr;
}

bool wr_gui_is_dialog(const ImGuiWindow *window)
{
    return window && (window->Flags & ImGuiWindowFlags_Modal);
}

bool wr_gui_reachable(const ImGuiContext &g, const WrKeyStop *stop)
{
    const ImGuiWindow *top = wr_gui_top_of(g);
    return g.OpenPopupStack.Size == 0 || (top && stop->part == top->ID);
}

const WrKeyStop *wr_gui_find_stop(const WrFocus *focus, ImGuiID id)
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
    if (focus->first && focus->shown && g.OpenPopupStack.Size > 0 && wr_gui_reachable(g, &stop)) {
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
    const WrKeyStop *was = wr_gui_find_stop(&wr_gui_current()->focus, id);
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
    while (kept < focus->levels && kept < wr_gui_levels_open(g) &&
           focus->popups[kept] == g.OpenPopupStack[kept].PopupId)
        kept++;
    return kept;
}

/* Closed popups restore the earlier focus; opened ones get the focus. */
static void follow_popups(WrFocus *focus)
{
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    const int levels = wr_gui_levels_open(g), kept = levels_kept(focus);
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
        const bool dialog = wr_gui_is_dialog(g.OpenPopupStack[i].Window);
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
    focus->pressed = false;
    focus->close_to = -1;
    follow_popups(focus);
    if (focus->waiting_count > 0) {
        wr_gui_take_key(focus);
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
        g.NavDisableMouseHover = true; /* the widget under the pointer is not the target */
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
    const ImU32 ink = wr_gui_colour_of(WR_COLOUR_FOCUS);
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
    if (wr_gui_find_stop(focus, focus->at)) return;
    for (int i = focus->index < focus->count ? focus->index : focus->count - 1; i >= 0; i--)
        if (wr_gui_reachable(g, &focus->stops[i])) {
            wr_gui_go_to(focus, &focus->stops[i]);
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
    if (focus->levels == wr_gui_levels_open(*ImGui::GetCurrentContext())) keep_place(focus);
    const WrKeyStop *now = wr_gui_find_stop(focus, focus->at);
    if (focus->shown && now) draw_ring(now);
    if (!now) focus->moved = false; /* input must not wait for a frame that scrolls to it */
    if (focus->stepped && !wr_gui_find_stop(focus, focus->stepped)) focus->stepped = 0;
}

/* ---- calls from other modules ---- */

extern "C" void wr_gui_focus_part(WrGui *gui, int way)
{
    WrFocus *focus = &gui->focus;
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    if (g.OpenPopupStack.Size > 0 || focus->count == 0) return;
    const WrKeyStop *now = wr_gui_find_stop(focus, focus->at);
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
    wr_gui_go_to(focus, wr_gui_entrance(g, focus, &focus->stops[i]));
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
        wr_gui_go_to(focus, &focus->stops[i]);
        if (opened) ImGui::ActivateItem(focus->at);
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
    const WrKeyStop *stop = wr_gui_find_stop(&gui->focus, id);
    if (!stop || !wr_gui_reachable(*ImGui::GetCurrentContext(), stop)) return false;
    wr_gui_go_to(&gui->focus, stop);
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
    if (g.HoveredIdDisabled || !window) return 0;
    if (g.HoveredId == ImGui::GetWindowScrollbarID(window, ImGuiAxis_X) ||
        g.HoveredId == ImGui::GetWindowScrollbarID(window, ImGuiAxis_Y))
        return 0; /* keys scroll its content */
    return g.HoveredId;
}
