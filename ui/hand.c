/* SPDX-License-Identifier: MIT
   Pointer and keys: who gets an event, and what the pointer holds meanwhile. */
#include "ui/state.h"

#include <math.h>

static WrPointer pointer_at(const WrApp *app, int x, int y, int button)
{
    WrPointer at = { .x = x, .y = y, .button = button, .mods = wr_key_mods(SDL_GetModState()) };
    /* Motion has whole pixels: their middles. */
    wr_view_to_uv(&app->view, x + 0.5, y + 0.5, &at.u, &at.v);
    return at;
}

static bool blocked(const WrApp *app)
{
    return app->dialog != WR_DIALOG_NONE;
}

/* A dialog is open whose effect the canvas shows: it may be looked at from all sides. */
static bool shows_effect(const WrApp *app)
{
    return app->dialog == WR_DIALOG_ADJUST || app->dialog == WR_DIALOG_SELECT;
}

static bool can_look(const WrApp *app, int button)
{
    return shows_effect(app) && button == SDL_BUTTON_MIDDLE;
}

/* ---- buttons ---- */

static void press_canvas(WrApp *app, const WrPointer *at)
{
    WrHand *hand = &app->hand;
    const WrTool *tool = &wr_tools[app->tool];
    if (at->button == SDL_BUTTON_MIDDLE || (at->button == SDL_BUTTON_LEFT && hand->space)) {
        hand->grab = WR_GRAB_PAN;
        hand->space_used = true;
        return;
    }
    if (at->button != SDL_BUTTON_LEFT) return;
    hand->grab = WR_GRAB_TOOL;
    bool brush = tool->press == wr_brush_press;
    if (brush && (at->mods & WR_MOD_SHIFT)) {
        /* a drag sizes the brush, a click draws a line: known when it moves, or is let go */
        hand->grab = WR_GRAB_RESIZE;
        app->brush.resize_radius = app->settings.brush.radius;
        return;
    }
    if (tool->press) tool->press(app, at);
}

static void button_down(WrApp *app, const SDL_MouseButtonEvent *event)
{
    WrHand *hand = &app->hand;
    if (hand->grab != WR_GRAB_NONE || (blocked(app) && !can_look(app, event->button))) return;
    if (wr_gui_owns_point(app->gui, event->x, event->y)) return;
    WrPointer at = pointer_at(app, event->x, event->y, event->button);
    hand->at = hand->start = at;
    hand->button = event->button;
    if (wr_layout_inside(&app->layout.divider, event->x, event->y)) {
        if (event->button == SDL_BUTTON_LEFT) hand->grab = WR_GRAB_DIVIDER;
    } else if (wr_layout_inside(&app->layout.panel_divider, event->x, event->y)) {
        if (event->button == SDL_BUTTON_LEFT) hand->grab = WR_GRAB_PANELS;
    } else if (wr_layout_inside(&app->layout.canvas, event->x, event->y)) {
        press_canvas(app, &at);
    } else if (!blocked(app) && wr_layout_inside(&app->layout.patch, event->x, event->y)) {
        wr_patch_press(app, &at);
    }
}

/* Shift and a click without moving: a straight line from the last stroke. */
static void finish_resize(WrApp *app, const WrPointer *at)
{
    if (fabs(at->x - app->hand.start.x) > 3.0) return;
    app->settings.brush.radius = app->brush.resize_radius;
    wr_brush_press(app, at);
    wr_brush_release(app, at);
}

static void release(WrApp *app, const WrPointer *at)
{
    WrGrab grab = app->hand.grab;
    const WrTool *tool = &wr_tools[app->tool];
    app->hand.grab = WR_GRAB_NONE;
    if (grab == WR_GRAB_TOOL && tool->release) tool->release(app, at);
    if (grab == WR_GRAB_RESIZE) finish_resize(app, at);
    if (grab == WR_GRAB_ORBIT || grab == WR_GRAB_LIGHT) {
        app->hand.grab = grab;
        wr_patch_release(app);
        app->hand.grab = WR_GRAB_NONE;
    }
    wr_app_redraw(app);
}

static void button_up(WrApp *app, const SDL_MouseButtonEvent *event)
{
    if (app->hand.grab == WR_GRAB_NONE || event->button != app->hand.button) return;
    WrPointer at = pointer_at(app, event->x, event->y, event->button);
    release(app, &at);
}

void wr_hand_let_go(WrApp *app)
{
    if (app->hand.grab == WR_GRAB_RESIZE) {
        app->settings.brush.radius = app->brush.resize_radius;
        app->hand.grab = WR_GRAB_NONE;
    }
    if (app->hand.grab != WR_GRAB_NONE) release(app, &app->hand.at);
    if (wr_session_in_stroke(app->session)) wr_brush_release(app, &app->hand.at);
}

/* ---- motion and wheel ---- */

static void drag(WrApp *app, const WrPointer *at)
{
    const WrTool *tool = &wr_tools[app->tool];
    switch (app->hand.grab) {
    case WR_GRAB_TOOL:
        if (tool->drag) tool->drag(app, at);
        break;
    case WR_GRAB_PAN: wr_tool_pan_drag(app, at); break;
    case WR_GRAB_RESIZE: wr_brush_resize(app, at); break;
    case WR_GRAB_DIVIDER:
        app->settings.divider = wr_layout_divider_at(&app->layout, (int)at->x, (int)at->y);
        break;
    case WR_GRAB_PANELS: app->settings.lower = wr_layout_lower_at(&app->layout, (int)at->y); break;
    case WR_GRAB_ORBIT:
    case WR_GRAB_LIGHT: wr_patch_drag(app, at); break;
    case WR_GRAB_NONE: break;
    }
}

static void motion(WrApp *app, const SDL_MouseMotionEvent *event)
{
    WrHand *hand = &app->hand;
    WrPointer at = pointer_at(app, event->x, event->y, hand->button);
    if (hand->grab != WR_GRAB_NONE) drag(app, &at);
    hand->at = pointer_at(app, event->x, event->y, hand->button); /* the view may have moved */
    bool free = hand->grab == WR_GRAB_NONE && !blocked(app) &&
                !wr_gui_owns_point(app->gui, event->x, event->y) && !wr_gui_holds_mouse(app->gui);
    bool held = hand->grab != WR_GRAB_NONE;
    hand->on_canvas = (held || free) && wr_layout_inside(&app->layout.canvas, event->x, event->y);
    hand->on_patch = (held || free) && wr_layout_inside(&app->layout.patch, event->x, event->y);
}

static void wheel(WrApp *app, const SDL_MouseWheelEvent *event)
{
    int x, y;
    SDL_GetMouseState(&x, &y);
    if ((blocked(app) && !shows_effect(app)) || wr_gui_owns_point(app->gui, x, y)) return;
    double steps =
        (double)event->preciseY * (event->direction == SDL_MOUSEWHEEL_FLIPPED ? -1.0 : 1.0);
    if (wr_layout_inside(&app->layout.canvas, x, y)) {
        wr_view_zoom_at(&app->view, x, y, app->view.zoom * exp2(steps / 3.0));
        app->hand.at = pointer_at(app, x, y, app->hand.button);
    } else if (!blocked(app) && wr_layout_inside(&app->layout.patch, x, y)) {
        wr_patch_wheel(app, steps);
    }
}

/* ---- keys ---- */

static void space(WrApp *app, bool down)
{
    WrHand *hand = &app->hand;
    if (down && hand->on_patch) {
        wr_action_run(app, "turn");
        return;
    }
    if (down && !hand->space) hand->space_used = false;
    hand->space = down;
    /* Space may be let go before the button: the drag goes on. */
    wr_app_redraw(app);
}

static void key_down(WrApp *app, const SDL_KeyboardEvent *event)
{
    if (blocked(app) || wr_gui_wants_text(app->gui)) return;
    int mods = wr_key_mods((SDL_Keymod)event->keysym.mod);
    if (event->keysym.sym == SDLK_SPACE && mods == 0) {
        if (!event->repeat) space(app, true);
        return;
    }
    if (event->keysym.sym == SDLK_ESCAPE && app->select.active) {
        wr_select_cancel(app);
        app->hand.grab = WR_GRAB_NONE;
        return;
    }
    if (event->keysym.sym == SDLK_ESCAPE) {
        wr_hand_let_go(app);
        return;
    }
    const char *action = wr_keys_find(app->keys, event->keysym);
    if (action) wr_action_run(app, action);
}

void wr_hand_event(WrApp *app, const SDL_Event *event)
{
    switch (event->type) {
    case SDL_MOUSEMOTION: motion(app, &event->motion); break;
    case SDL_MOUSEBUTTONDOWN: button_down(app, &event->button); break;
    case SDL_MOUSEBUTTONUP: button_up(app, &event->button); break;
    case SDL_MOUSEWHEEL: wheel(app, &event->wheel); break;
    case SDL_KEYDOWN: key_down(app, &event->key); break;
    case SDL_KEYUP:
        if (event->key.keysym.sym == SDLK_SPACE) space(app, false);
        break;
    default: break;
    }
}

/* ---- the view ---- */

void wr_app_place_view(WrApp *app)
{
    WrView *view = &app->view;
    const SDL_Rect *room = &app->layout.canvas;
    const WrField *field = wr_app_field(app);
    int w = wr_field_width(field), h = wr_field_height(field);
    if (w != view->table_w || h != view->table_h) app->view_placed = false;
    view->x = room->x;
    view->y = room->y;
    view->w = room->w > 0 ? room->w : 1;
    view->h = room->h > 0 ? room->h : 1;
    view->table_w = w;
    view->table_h = h;
    if (app->view_placed || room->w == 0) return;
    wr_view_fit(view, 0.36); /* with enough of the copies around it that seams are seen */
    app->view_placed = true;
}
