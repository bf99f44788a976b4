/* Profile editor of a surface of revolution: a curve with draggable points; each drag is one command. */
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/panels/panel_scene.h"

#include "base/text.h"
#include "scene/scene.h"
#include "surface/data.h"

#include <SDL.h>
#include <math.h>
#include <string.h>

#define STEPS 160  /* segments of the drawn curve */
#define REACH 10.0 /* units: hit radius of a point */
#define AXIS 4.0   /* units from the axis that snap to it */
#define ROOM 1.15  /* margin around the profile */

/* ---- geometry ---- */

/* Map from profile lengths to the pad: the axis in the middle, z up. Fixed while a point is dragged. */
static void fit(WrProfileState *hand, const WrPad *pad)
{
    double most = 1e-9, low = INFINITY, high = -INFINITY;
    for (int i = 0; i < hand->edit.count; i++) {
        const WrProfilePlace *p = &hand->edit.place[i];
        most = fmax(most, p->r), low = fmin(low, p->z), high = fmax(high, p->z);
    }
    hand->scale = fmin(pad->w / (2 * most * ROOM), pad->h / (fmax(high - low, most) * ROOM));
    hand->middle = (low + high) / 2;
}

static double x_of(const WrProfileState *hand, const WrPad *pad, double r)
{
    return pad->x + pad->w / 2 + r * hand->scale;
}

static double y_of(const WrProfileState *hand, const WrPad *pad, double z)
{
    return pad->y + pad->h / 2 - (z - hand->middle) * hand->scale;
}

/* ---- drawing ---- */

static void draw_curve(const WrProfileState *hand, const WrPad *pad, const WrShape *shape)
{
    const double s = wr_gui_scale();
    WrSurfacePoint last = { 0 };
    const double axis = x_of(hand, pad, 0);
    for (int i = 0; i * 8 * s < pad->h; i++)
        wr_gui_draw_fill(axis - 0.5 * s, pad->y + i * 8 * s, s, 4 * s, 0x60909090u, 0);
    for (int i = 0; i <= STEPS; i++) {
        WrSurfacePoint at;
        wr_surface_at(shape, 0, 0, (double)i / STEPS, &at);
        if (i > 0) {
            const double y0 = y_of(hand, pad, last.p.z), y1 = y_of(hand, pad, at.p.z);
            wr_gui_draw_line(x_of(hand, pad, -last.p.x), y0, x_of(hand, pad, -at.p.x), y1,
                             0x50a0a0a0u, 1.3 * s);
            wr_gui_draw_line(x_of(hand, pad, last.p.x), y0, x_of(hand, pad, at.p.x), y1,
                             WR_COLOUR_TEXT, 1.6 * s);
        }
        last = at;
    }
}

static void draw_points(const WrProfileState *hand, const WrPad *pad, int over)
{
    const double s = wr_gui_scale();
    for (int i = 0; i < hand->edit.count; i++) {
        const WrProfilePlace *p = &hand->edit.place[i];
        const double x = x_of(hand, pad, p->r), y = y_of(hand, pad, p->z), half = 4 * s;
        const bool held = i == hand->held - 1;
        const WrColour colour = held && hand->wrong ? WR_COLOUR_RAISE
                                : held || i == over ? WR_COLOUR_ACCENT
                                                    : WR_COLOUR_STRONG;
        wr_gui_draw_disc(x, y, half + 1.5 * s, 0xb0000000u);
        if (p->corner) wr_gui_draw_fill(x - half, y - half, 2 * half, 2 * half, colour, 0);
        else wr_gui_draw_disc(x, y, half, colour);
    }
}

/* ---- dragging ---- */

/* Show the surface of the present points in the preview; invalid profiles are not shown. */
static void show(WrApp *app, WrProfileState *hand)
{
    WrText text = { 0 };
    wr_profile_edit_write(&hand->edit, &text);
    const char *texts[WR_SURFACE_TEXTS] = { wr_text_get(&text) };
    WrSurfaceData *data = wr_surface_data_make(WR_SURFACE_revolution, texts, NULL);
    hand->wrong = !data;
    if (data) {
        WrScene *live = wr_app_live_begin(app);
        WrShape shape = live->shape;
        wr_shape_borrow_data(&shape, data);
        wr_scene_set_shape(live, &shape);
        wr_surface_data_free(data);
    }
    wr_text_fini(&text);
}

static void run(WrApp *app, WrProfileState *hand)
{
    WrText text = { 0 };
    wr_profile_edit_write(&hand->edit, &text);
    const char *texts[WR_SURFACE_TEXTS] = { wr_text_get(&text) };
    wr_surface_run(app, &wr_app_scene(app)->shape, texts);
    wr_text_fini(&text);
    hand->key = 0; /* read again, also after a refusal */
}

static void press(WrApp *app, WrProfileState *hand, int over, double r, double z)
{
    const int mods = app->hand->mods;
    if (over >= 0 && (mods & (WR_MOD_CTRL | WR_MOD_SHIFT))) {
        if (mods & WR_MOD_CTRL ? wr_profile_edit_remove(&hand->edit, over)
                               : wr_profile_edit_corner(&hand->edit, over))
            run(app, hand);
        return;
    }
    hand->moved = over < 0;
    hand->held = 1 + (over >= 0 ? over : wr_profile_edit_add(&hand->edit, fmax(r, 0), z));
}

static void drag(WrApp *app, WrProfileState *hand, double r, double z)
{
    const WrProfilePlace *p = &hand->edit.place[hand->held - 1];
    const double axis = AXIS * wr_gui_scale() / hand->scale;
    if (!hand->moved && hypot(p->r - r, p->z - z) < axis / 2) return; /* a click moves nothing */
    hand->moved = true;
    wr_profile_edit_move(&hand->edit, hand->held - 1, r, z, axis);
    show(app, hand);
}

void wr_profile_row(WrApp *app)
{
    WrProfileState *hand = &app->surface->profile;
    const WrShape *shape = &wr_app_scene(app)->shape;
    const double wide = wr_gui_available();
    if (hand->held == 0 && hand->key != shape->key) {
        if (!wr_profile_edit_read(&hand->edit, shape->data->text[0])) return;
        hand->key = shape->key;
    }
    const WrPad pad = wr_gui_pad_begin("profile", wide, wide);
    if (hand->held == 0) fit(hand, &pad);
    const double r = (pad.pointer_x - pad.x - pad.w / 2) / hand->scale;
    const double z = hand->middle - (pad.pointer_y - pad.y - pad.h / 2) / hand->scale;
    const int over =
        pad.hovered || pad.held
            ? wr_profile_edit_near(&hand->edit, r, z, REACH * wr_gui_scale() / hand->scale)
            : -1;
    draw_curve(hand, &pad, shape);
    draw_points(hand, &pad, over);
    wr_gui_pad_end();
    wr_gui_tip("The profile and its mirror image. Drag its points, click beside them to add one. "
               "Ctrl+click removes one, Shift+click makes it a corner or smooth.");
    if (pad.pressed) press(app, hand, over, r, z);
    if (hand->held > 0 && (pad.held || pad.released)) drag(app, hand, r, z);
    if (hand->held == 0 || (!pad.released && pad.held)) return;
    hand->held = 0;
    if (hand->moved) run(app, hand);
}
