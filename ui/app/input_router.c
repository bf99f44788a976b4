/* Pointer and keys: routing of events, and the target of a drag. */
#include "ui/panels/accuracy/accuracy.h"
#include "ui/app/input_router.h"
#include "ui/app/input.h"
#include "ui/canvas/view.h"
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/settings.h"
#include "ui/app/state/session_view.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/toolkit/focus.h"
#include "ui/toolkit/gui.h"
#include "ui/panels/panel_dynamics.h"
#include "ui/panels/panel_layers.h"
#include "ui/panels/panel_preferences.h"
#include "ui/patch/patch.h"
#include "ui/patch/patch_objects.h"
#include "ui/patch/patch_paint.h"
#include "ui/input/pen.h"
#include "ui/input/pen_curve.h"
#include "ui/canvas/tools/stroke_input.h"
#include "ui/canvas/tools/layer_points.h"
#include "ui/canvas/tools/symmetry.h"
#include "ui/canvas/tools/tool.h"
#include "ui/canvas/tools/tool_brush.h"
#include "ui/canvas/tools/tool_select.h"
#include "ui/canvas/tools/tool_view.h"
#include "ui/canvas/overlays/marks.h"

#include "system/clock.h"

#include <SDL.h>
#include <math.h>
#include <string.h>

#define MOUSE (-1) /* in place of a pen's device */
#define WHEEL_DEG 5.0
#define DOUBLE_SECONDS 0.4 /* between the presses of a double click */

static WrPointer pointer_at(const WrApp *app, double x, double y, int button)
{
    WrPointer at = { .x = x, .y = y, .pressure = 1.0, .button = button, .mods = app->hand->mods };
    wr_view_to_uv(app->view, x, y, &at.u, &at.v);
    return at;
}

/* Mouse positions are whole pixels, taken at their centres. A mouse has no pressure; it is simulated if the setting
   is on. */
static WrPointer mouse_at(WrApp *app, int x, int y, int button, Uint32 milliseconds, bool pressed)
{
    WrPointer at = pointer_at(app, x + 0.5, y + 0.5, button);
    WrFakePressure *fake = &app->settings->fake;
    at.seconds = milliseconds / 1e3;
    if (pressed) fake->now = fake->held;
    else if (app->hand->grab == WR_GRAB_NONE) return at;
    double way = pressed ? 0.0 : hypot(at.x - app->hand->at.x, at.y - app->hand->at.y);
    at.pressure = wr_fake_pressure(fake, way, pressed ? 0.0 : at.seconds - app->hand->fake_at);
    app->hand->fake_at = at.seconds;
    return at;
}

static bool blocked(const WrApp *app)
{
    return app->dialog->now != WR_DIALOG_NONE;
}

/* True if the open dialog has a visible effect on the canvas: the views may then be panned and rotated. */
static bool shows_effect(const WrApp *app)
{
    return blocked(app) && app->registry->dialogs[app->dialog->now].shows_effect;
}

static bool can_look(const WrApp *app, int button)
{
    return shows_effect(app) && button == SDL_BUTTON_MIDDLE;
}

/* ---- buttons ---- */

static void press_canvas(WrApp *app, const WrPointer *at)
{
    WrInputRouter *hand = app->hand;
    const WrTool *tool = wr_tool_now(app);
    if (at->button == SDL_BUTTON_MIDDLE || (at->button == SDL_BUTTON_LEFT && hand->space)) {
        hand->grab = at->mods & WR_MOD_SHIFT ? WR_GRAB_TURN : WR_GRAB_PAN;
        hand->turn_from = app->view->turn;
        hand->space_used = true;
        return;
    }
    if (at->button != SDL_BUTTON_LEFT) return;
    if (wr_symmetry_press(app, at)) {
        hand->grab = WR_GRAB_SYMMETRY;
        return;
    }
    const bool needs_idle = tool->paints ? app->busy && !wr_busy_lets_wait(app) : !tool->meanwhile;
    if (needs_idle && wr_busy_refuse(app)) return;
    if (!app->busy && wr_layer_points_press(app, at)) {
        hand->grab = WR_GRAB_POINT;
        return;
    }
    if (tool->paints && !app->busy && wr_rasterize_ask(app)) return;
    hand->grab = WR_GRAB_TOOL;
    if (tool->paints && !hand->line && wr_keys_hold(app->keys, WR_ACT(hold_size), at->mods)) {
        /* a drag resizes the brush, a click draws a line: decided at the first motion or the release */
        hand->grab = WR_GRAB_RESIZE;
        app->brush->resize_radius = app->settings->brush.radius;
        return;
    }
    if (tool->press) tool->press(app, at);
}

static void press_patch(WrApp *app, const WrPointer *at)
{
    if (at->button == SDL_BUTTON_LEFT && wr_accuracy_on_line(app, at->x, at->y)) {
        app->hand->grab = WR_GRAB_SPLIT;
    } else if (at->button == SDL_BUTTON_LEFT && wr_patch_paints(app) &&
               !wr_patch_control_under(app, at)) {
        if (app->busy && !wr_busy_lets_wait(app) && wr_busy_refuse(app)) return;
        if (!app->busy && wr_rasterize_ask(app)) return;
        if (!app->busy && !wr_keys_hold(app->keys, WR_ACT(hold_pick), at->mods))
            wr_patch_choose(app, at); /* a command, which ends a drag */
        app->hand->grab = WR_GRAB_PATCH_PAINT;
        wr_patch_paint_press(app, at);
    } else if (!wr_busy_refuse(app)) {
        wr_patch_press(app, at);
    }
}

WrGrab wr_divider_under(const WrApp *app, const WrPointer *at)
{
    const int x = (int)at->x, y = (int)at->y;
    if (wr_layout_inside(&app->layout->divider, x, y)) return WR_GRAB_DIVIDER;
    if (wr_layout_inside(&app->layout->panel_divider, x, y)) return WR_GRAB_PANELS;
    return wr_layout_inside(&app->layout->side, x, y) ? WR_GRAB_SIDE : WR_GRAB_NONE;
}

/* A drag moves the divider, a double click resets it. */
static void press_divider(WrApp *app, WrGrab divider)
{
    WrInputRouter *hand = app->hand;
    const double now = wr_clock_seconds();
    const bool twice = divider == hand->last_divider && now - hand->divider_at < DOUBLE_SECONDS;
    const WrSettings plain = wr_settings_default();
    hand->last_divider = twice ? WR_GRAB_NONE : divider;
    hand->divider_at = now;
    if (!twice) hand->grab = divider;
    else if (divider == WR_GRAB_DIVIDER) app->settings->divider = plain.divider;
    else if (divider == WR_GRAB_PANELS) app->settings->lower = plain.lower;
    else app->settings->side_width = plain.side_width;
    wr_app_redraw(app);
}

/* Handle a press outside the widgets. */
static void press(WrApp *app, const WrPointer *at, int device)
{
    WrInputRouter *hand = app->hand;
    int x = (int)at->x, y = (int)at->y;
    if (hand->grab != WR_GRAB_NONE || (blocked(app) && !can_look(app, at->button))) return;
    if (wr_gui_owns_point(app->gui, x, y)) return;
    hand->at = hand->start = *at;
    hand->button = at->button;
    hand->device = device;
    const WrGrab divider = wr_divider_under(app, at);
    if (divider != WR_GRAB_NONE) {
        if (at->button == SDL_BUTTON_LEFT) press_divider(app, divider);
    } else if (wr_layout_inside(&app->layout->canvas, x, y)) {
        press_canvas(app, at);
    } else if (!blocked(app) && wr_layout_inside(&app->layout->patch, x, y)) {
        press_patch(app, at);
    }
}

/* Shift and a click without motion: a straight line from the last stroke. */
static void finish_resize(WrApp *app, const WrPointer *at)
{
    if (fabs(at->x - app->hand->start.x) > 3.0) return;
    app->settings->brush.radius = app->brush->resize_radius;
    wr_brush_press(app, at);
    wr_brush_release(app, at);
}

static void release(WrApp *app, const WrPointer *at)
{
    WrGrab grab = app->hand->grab;
    const WrTool *tool = wr_tool_now(app);
    app->hand->grab = WR_GRAB_NONE;
    if (grab == WR_GRAB_TOOL && tool->release) tool->release(app, at);
    if (grab == WR_GRAB_PATCH_PAINT) wr_patch_paint_release(app, at);
    if (grab == WR_GRAB_RESIZE) finish_resize(app, at);
    if (grab == WR_GRAB_POINT) wr_layer_points_release(app, at);
    if (wr_grab_on_patch(grab)) {
        app->hand->grab = grab;
        wr_patch_release(app);
        app->hand->grab = WR_GRAB_NONE;
    }
    wr_app_redraw(app);
}

static void let_go(WrApp *app, const WrPointer *at, int device)
{
    const WrInputRouter *hand = app->hand;
    if (hand->grab != WR_GRAB_NONE && at->button == hand->button && device == hand->device)
        release(app, at);
}

/* End a drag, keeping its result. */
static void end_held(WrApp *app)
{
    if (app->hand->grab == WR_GRAB_RESIZE) {
        app->settings->brush.radius = app->brush->resize_radius;
        app->hand->grab = WR_GRAB_NONE;
    }
    app->brush->straight = false; /* not drawn yet */
    if (app->hand->grab != WR_GRAB_NONE) release(app, &app->hand->at);
    wr_strokes_finish(app);
}

/* End a drag, discarding its result. */
static void cancel_held(WrApp *app)
{
    if (app->hand->grab == WR_GRAB_POINT) {
        wr_layer_points_cancel(app);
        app->hand->grab = WR_GRAB_NONE;
    }
    if (app->select->active) {
        wr_select_cancel(app);
        app->hand->grab = WR_GRAB_NONE;
        return;
    }
    bool drew = app->brush->drawing || app->brush->jobs.count > 0;
    bool aimed = app->brush->straight;
    app->brush->straight = false;
    wr_strokes_cancel(app);
    if (!drew && !aimed) wr_input_router_let_go(app);
    else app->hand->grab = WR_GRAB_NONE;
}

/* ---- motion and wheel ---- */

/* Pick a height from the canvas, or from the table under the patch. */
static void pick(WrApp *app, const WrPointer *at)
{
    WrPointer there = *at;
    bool on_patch = wr_layout_inside(&app->layout->patch, (int)at->x, (int)at->y);
    if (on_patch && !wr_patch_paint_uv(app, at, &there.u, &there.v)) return;
    wr_brush_pick(app, &there);
}

static void drag(WrApp *app, const WrPointer *at)
{
    const WrTool *tool = wr_tool_now(app);
    switch (app->hand->grab) {
    case WR_GRAB_TOOL:
        if (tool->drag) tool->drag(app, at);
        break;
    case WR_GRAB_PATCH_PAINT: wr_patch_paint_drag(app, at); break;
    case WR_GRAB_SYMMETRY: wr_symmetry_drag(app, at); break;
    case WR_GRAB_POINT: wr_layer_points_drag(app, at); break;
    case WR_GRAB_PICK: pick(app, at); break;
    case WR_GRAB_PAN: wr_tool_pan_drag(app, at); break;
    case WR_GRAB_TURN: wr_tool_turn_drag(app, at); break;
    case WR_GRAB_RESIZE: wr_brush_resize(app, at); break;
    case WR_GRAB_DIVIDER:
        app->settings->divider = wr_layout_divider_at(app->layout, (int)at->x, (int)at->y);
        break;
    case WR_GRAB_SPLIT: wr_accuracy_drag_line(app, at->x); break;
    case WR_GRAB_PANELS: app->settings->lower = wr_layout_lower_at(app->layout, (int)at->y); break;
    case WR_GRAB_SIDE:
        app->settings->side_width =
            wr_layout_side_at(app->layout, app->width, wr_gui_scale(), (int)at->x);
        break;
    case WR_GRAB_ORBIT:
    case WR_GRAB_LIGHT:
    case WR_GRAB_SURROUND:
    case WR_GRAB_HANDLE: wr_patch_drag(app, at); break;
    case WR_GRAB_NONE: break;
    }
}

/* Update the view under the pointer at that pixel, if no widget is there. */
static void look(WrApp *app, int x, int y)
{
    WrInputRouter *hand = app->hand;
    bool free = hand->grab == WR_GRAB_NONE && !blocked(app) && !wr_gui_owns_point(app->gui, x, y) &&
                !wr_gui_holds_mouse(app->gui);
    bool held = hand->grab != WR_GRAB_NONE;
    hand->on_canvas = (held || free) && wr_layout_inside(&app->layout->canvas, x, y);
    hand->on_patch = (held || free) && wr_layout_inside(&app->layout->patch, x, y);
}

static void move(WrApp *app, const WrPointer *at)
{
    WrInputRouter *hand = app->hand;
    int x = (int)at->x, y = (int)at->y;
    if (hand->grab != WR_GRAB_NONE) drag(app, at);
    hand->at = *at;
    wr_view_to_uv(app->view, at->x, at->y, &hand->at.u, &hand->at.v); /* the view may have moved */
    look(app, x, y);
}

void wr_input_router_update_hover(WrApp *app)
{
    WrInputRouter *hand = app->hand;
    bool canvas = hand->on_canvas, patch = hand->on_patch;
    /* The view may have appeared or moved since the last pointer motion. */
    if (hand->grab == WR_GRAB_NONE)
        wr_view_to_uv(app->view, hand->at.x, hand->at.y, &hand->at.u, &hand->at.v);
    if (hand->grab != WR_GRAB_NONE || SDL_GetMouseFocus() != app->window) return;
    look(app, (int)hand->at.x, (int)hand->at.y);
    if (canvas != hand->on_canvas || patch != hand->on_patch) wr_app_redraw(app);
}

/* ---- the mouse ---- */

/* True for a mouse event that only duplicates a pen or finger event, which contains more. A drag started by the mouse
 * stays with the mouse: the press of a pen that did not hover before may arrive as a mouse press. */
static bool is_echo(const WrApp *app, Uint32 which)
{
    if (which == SDL_TOUCH_MOUSEID || which == WR_PEN_MOUSEID) return true;
    if (app->hand->grab != WR_GRAB_NONE) return app->hand->device != MOUSE;
    return wr_pen_moves_mouse(app->pen);
}

static void mouse_moved(WrApp *app, const SDL_MouseMotionEvent *event)
{
    if (is_echo(app, event->which)) return;
    WrPointer at = mouse_at(app, event->x, event->y, app->hand->button, event->timestamp, false);
    app->hand->events++;
    move(app, &at);
}

static void mouse_button(WrApp *app, const SDL_MouseButtonEvent *event, bool down)
{
    if (is_echo(app, event->which)) return;
    WrPointer at = mouse_at(app, event->x, event->y, event->button, event->timestamp, down);
    app->hand->events++;
    if (down) press(app, &at, MOUSE);
    else let_go(app, &at, MOUSE);
}

static void wheel(WrApp *app, const SDL_MouseWheelEvent *event)
{
    const int x = app->hand->x, y = app->hand->y;
    if ((blocked(app) && !shows_effect(app)) || wr_gui_owns_point(app->gui, x, y)) return;
    double steps =
        (double)event->preciseY * (event->direction == SDL_MOUSEWHEEL_FLIPPED ? -1.0 : 1.0);
    const WrTool *tool = wr_tool_now(app);
    if (wr_layout_inside(&app->layout->canvas, x, y)) {
        if (!blocked(app) && tool->wheel && tool->wheel(app, steps)) return;
        if (app->hand->mods & WR_MOD_SHIFT)
            wr_view_turn_at(app->view, x, y, app->view->turn + WHEEL_DEG * steps);
        else wr_view_zoom_at(app->view, x, y, app->view->zoom * exp2(steps / 3.0));
        app->hand->at = pointer_at(app, x + 0.5, y + 0.5, app->hand->button);
    } else if (!blocked(app) && wr_layout_inside(&app->layout->patch, x, y)) {
        if (app->hand->mods & WR_MOD_CTRL) wr_patch_wheel_angle(app, steps);
        else wr_patch_wheel(app, steps);
    }
}

/* ---- pens and fingers ---- */

/* The tip is the left button; the second barrel button picks a height, the third pans. */
static int pen_button(int button)
{
    return button == 1   ? SDL_BUTTON_LEFT
           : button == 2 ? SDL_BUTTON_RIGHT
           : button == 3 ? SDL_BUTTON_MIDDLE
                         : button;
}

static void pen_down(WrApp *app, const WrPointer *at, int device)
{
    WrInputRouter *hand = app->hand;
    bool over = wr_layout_inside(&app->layout->canvas, (int)at->x, (int)at->y) ||
                wr_layout_inside(&app->layout->patch, (int)at->x, (int)at->y);
    if (at->button != SDL_BUTTON_RIGHT || !over) {
        press(app, at, device);
        return;
    }
    if (hand->grab != WR_GRAB_NONE || blocked(app) ||
        wr_gui_owns_point(app->gui, (int)at->x, (int)at->y))
        return;
    hand->at = hand->start = *at;
    hand->button = at->button;
    hand->device = device;
    hand->grab = WR_GRAB_PICK;
    pick(app, at);
}

/* A second finger came: discard the begun stroke, or drag of the patch. Other drags keep their result. */
static void cancel_press(WrApp *app)
{
    const WrGrab grab = app->hand->grab;
    if (wr_grab_on_patch(grab)) {
        app->hand->grab = WR_GRAB_NONE;
        wr_app_live_end(app);
    } else if (grab == WR_GRAB_PATCH_PAINT || (grab == WR_GRAB_TOOL && wr_tool_now(app)->paints)) {
        cancel_held(app);
    } else {
        wr_input_router_let_go(app);
    }
}

/* The view that two fingers at a position work on; NULL: none. */
static const SDL_Rect *view_under(const WrApp *app, const WrPenEvent *event)
{
    const int x = (int)event->x, y = (int)event->y;
    if (wr_gui_owns_point(app->gui, x, y) || wr_gui_popup_open_now(app->gui)) return NULL;
    if (wr_layout_inside(&app->layout->canvas, x, y))
        return blocked(app) && !shows_effect(app) ? NULL : &app->layout->canvas;
    return wr_layout_inside(&app->layout->patch, x, y) && !blocked(app) ? &app->layout->patch
                                                                        : NULL;
}

/* Two fingers pan, zoom and turn the view in which they began. */
static void grip(WrApp *app, const WrPenEvent *event)
{
    WrInputRouter *hand = app->hand;
    const WrGrip *by = &event->grip;
    if (hand->grab != WR_GRAB_NONE) return;
    if (event->button == 1) hand->gripped = view_under(app, event);
    if (hand->gripped == &app->layout->canvas) {
        WrCanvasView *view = app->view;
        wr_view_pan(view, by->dx, by->dy);
        wr_view_zoom_at(view, event->x, event->y, view->zoom * by->scale);
        if (by->turn_deg != 0.0)
            wr_view_turn_at(view, event->x, event->y, view->turn + by->turn_deg);
        hand->at = pointer_at(app, event->x, event->y, hand->button);
    } else if (hand->gripped) {
        wr_patch_grip(app, by);
    }
}

/* Two fingers undo, three redo. */
static void tap(WrApp *app, const WrPenEvent *event)
{
    if (app->hand->grab != WR_GRAB_NONE || blocked(app) || !view_under(app, event)) return;
    if (event->button == 2) wr_action_run(app, WR_ACT(undo));
    if (event->button == 3) wr_action_run(app, WR_ACT(redo));
}

void wr_input_router_pen(WrApp *app, const WrPenEvent *event)
{
    WrInputRouter *hand = app->hand;
    bool holds = hand->grab != WR_GRAB_NONE && hand->device == event->device;
    app->input_at = wr_clock_seconds();
    wr_app_redraw(app);
    switch (event->kind) {
    case WR_PEN_LOST:
        if (holds) {
            end_held(app); /* also a stroke that is queued */
            wr_input_router_let_go(app);
        }
        return;
    case WR_PEN_CANCEL:
        if (holds) cancel_press(app);
        return;
    case WR_PEN_GRIP: grip(app, event); return;
    case WR_PEN_TAP: tap(app, event); return;
    default: break;
    }
    if (hand->grab != WR_GRAB_NONE && !holds) return;                 /* one pointer at a time */
    if (event->finger && !holds && wr_pen_in_range(app->pen)) return; /* a palm */
    int button = event->kind == WR_PEN_MOTION ? hand->button : pen_button(event->button);
    WrPointer at = pointer_at(app, event->x, event->y, button);
    at.pen = true;
    at.eraser = event->eraser;
    at.pressure = event->pressure;
    at.tilt_x = event->tilt_x;
    at.tilt_y = event->tilt_y;
    at.turn_deg = event->turn_deg;
    at.seconds = event->seconds;
    hand->events++;
    if (event->kind == WR_PEN_DOWN) pen_down(app, &at, event->device);
    else if (event->kind == WR_PEN_UP) let_go(app, &at, event->device);
    else move(app, &at);
}

/* ---- keys ---- */

static void space(WrApp *app, bool down)
{
    WrInputRouter *hand = app->hand;
    if (down && hand->on_patch) {
        wr_action_run(app, WR_ACT(turn));
        return;
    }
    if (down && !hand->space) hand->space_used = false;
    hand->space = down;
    /* Space may be released before the button: the drag continues. */
    wr_app_redraw(app);
}

/* Handle modifier actions. True if `action` is one of them. */
static bool hold(WrApp *app, const char *action, const SDL_KeyboardEvent *event)
{
    WrInputRouter *hand = app->hand;
    if (strcmp(action, WR_ACT(straight_line)) == 0) {
        if (hand->grab == WR_GRAB_NONE) hand->line = true;
        hand->line_key = event->keysym.sym;
        return true;
    }
    if (strcmp(action, WR_ACT(compare_hold)) == 0) {
        app->accuracy->hold_key = event->keysym.sym;
        app->accuracy->hold_b = true;
        wr_app_redraw(app);
        return true;
    }
    if (strcmp(action, WR_ACT(paint_patch)) == 0) {
        if (event->repeat) return true;
        hand->quick_key = event->keysym.sym;
        hand->quick_at = wr_clock_seconds();
        hand->quick_events = app->brush->strokes;
        wr_action_run(app, action);
        return true;
    }
    return false;
}

#define TAP_SECONDS 0.4

/* After a long press, or after painting during it, the release of the key for painting on the patch switches back. */
static void key_up(WrApp *app, const SDL_KeyboardEvent *event)
{
    WrInputRouter *hand = app->hand;
    SDL_Keycode key = event->keysym.sym;
    if (key == SDLK_SPACE) space(app, false);
    if (hand->line && key == hand->line_key) hand->line = false;
    if (key == app->accuracy->hold_key) app->accuracy->hold_b = false;
    if (hand->quick_at > 0.0 && key == hand->quick_key) {
        bool was_held = wr_clock_seconds() - hand->quick_at > TAP_SECONDS ||
                        app->brush->strokes != hand->quick_events;
        hand->quick_at = 0.0;
        if (was_held) wr_action_run(app, WR_ACT(paint_patch));
    }
}

/* Keys for other areas of the window, also while a text is typed. */
static bool leaves_text(const WrApp *app, const SDL_KeyboardEvent *event)
{
    const char *action = wr_keys_find(app->keys, event->keysym);
    return action && (strcmp(action, WR_ACT(part_next)) == 0 ||
                      strcmp(action, WR_ACT(part_back)) == 0 || strcmp(action, WR_ACT(menus)) == 0);
}

/* After the frame in which Escape restored a dragged value: the views show the document again. */
static void end_live(WrApp *app, const char *text)
{
    (void)text;
    if (!app->generate->active) wr_app_try_end(app);
    wr_app_live_end(app);
}

static void key_down(WrApp *app, const SDL_KeyboardEvent *event)
{
    app->hand->key_is_free = false;
    if (wr_preferences_take_key(app, event) || wr_gui_took_key(app->gui)) return;
    if (wr_dynamics_undo_key(app, event)) return;
    if (blocked(app) || wr_gui_popup_open_now(app->gui)) return;
    if (wr_gui_wants_text(app->gui) && !leaves_text(app, event)) return;
    /* A dragged widget runs its command at the release: an undo before it would cost the steps that redo has. */
    if (wr_gui_holds_mouse(app->gui)) {
        if (event->keysym.sym == SDLK_ESCAPE) wr_deferred(app, end_live, "");
        return;
    }
    int mods = wr_key_mods((SDL_Keymod)event->keysym.mod);
    if (event->keysym.sym == SDLK_SPACE &&
        (mods == 0 || (mods == WR_MOD_SHIFT && app->hand->on_canvas))) {
        if (!event->repeat) space(app, true);
        return;
    }
    const WrTool *tool = wr_tool_now(app);
    if (mods == 0 && tool->key && tool->key(app, event->keysym.sym)) return;
    if (event->keysym.sym == SDLK_ESCAPE) {
        cancel_held(app);
        return;
    }
    const bool enters = event->keysym.sym == SDLK_RETURN || event->keysym.sym == SDLK_KP_ENTER;
    if (enters && mods == WR_MOD_CTRL && wr_generate_writes(app)) { /* as in its text field */
        wr_generate_commit(app);
        return;
    }
    const char *action = wr_keys_find(app->keys, event->keysym);
    if (action && !hold(app, action, event)) wr_action_run(app, action);
    app->hand->key_is_free = !action;
}

/* Text follows the key that typed it. */
static void typed(WrApp *app, const SDL_TextInputEvent *event)
{
    const char *action = app->hand->key_is_free ? wr_keys_find_typed(app->keys, event->text) : NULL;
    app->hand->key_is_free = false;
    if (action) wr_action_run(app, action);
}

void wr_input_router_event(WrApp *app, const SDL_Event *event)
{
    switch (event->type) {
    case SDL_MOUSEMOTION: mouse_moved(app, &event->motion); break;
    case SDL_MOUSEBUTTONDOWN: mouse_button(app, &event->button, true); break;
    case SDL_MOUSEBUTTONUP: mouse_button(app, &event->button, false); break;
    case SDL_MOUSEWHEEL: wheel(app, &event->wheel); break;
    case SDL_KEYDOWN: key_down(app, &event->key); break;
    case SDL_KEYUP: key_up(app, &event->key); break;
    case SDL_TEXTINPUT: typed(app, &event->text); break;
    default: break;
    }
}

/* A queued action does not end the stroke that was begun after it. */
static void let_go_for_action(WrApp *app)
{
    if (!wr_busy_runs_queue(app) || !wr_strokes_newest_is_queued(app)) end_held(app);
}

const WrPart wr_part_hand = { .let_go = let_go_for_action };
