/* Tools for panning and zooming the canvas. */
#include "ui/canvas/tools/tool_view.h"
#include "ui/canvas/view.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/toolkit/gui.h"
#include "ui/canvas/tools/tool.h"
#include "ui/canvas/tools/tool_rows.h"

#include "base/exactmath.h"

#include <math.h>

void wr_tool_pan_drag(WrApp *app, const WrPointer *at)
{
    wr_view_pan(app->view, at->x - app->hand->at.x, at->y - app->hand->at.y);
    wr_app_redraw(app);
}

#define SNAP_DEG 15.0

void wr_tool_turn_drag(WrApp *app, const WrPointer *at)
{
    WrCanvasView *view = app->view;
    double x = view->x + view->w / 2.0, y = view->y + view->h / 2.0;
    const WrPointer *from = &app->hand->start;
    double turn = atan2(at->y - y, at->x - x) - atan2(from->y - y, from->x - x);
    double degrees = app->hand->turn_from + turn * WR_DEG_PER_RAD;
    if (at->mods & WR_MOD_CTRL) degrees = SNAP_DEG * rint(degrees / SNAP_DEG);
    wr_view_turn_at(view, x, y, degrees);
    wr_app_redraw(app);
}

static void zoom_press(WrApp *app, const WrPointer *at)
{
    double factor = at->mods & WR_MOD_CTRL ? 0.5 : 2.0;
    wr_view_zoom_at(app->view, at->x, at->y, app->view->zoom * factor);
    wr_app_redraw(app);
}

static void zoom_drag(WrApp *app, const WrPointer *at)
{
    double steps = (app->hand->at.y - at->y) / (100.0 * wr_gui_scale());
    wr_view_zoom_at(app->view, app->hand->start.x, app->hand->start.y,
                    app->view->zoom * exp2(steps));
    wr_app_redraw(app);
}

/* ---- the rows ---- */

const WrTool wr_tool_pan = {
    .action = WR_ACT(pan),
    .icon = WR_ICON_HAND,
    .help = "Move the table. Space and dragging, or the middle button, does it in any tool.",
    .drag = wr_tool_pan_drag,
    .meanwhile = true
};

const WrTool wr_tool_zoom = {
    .action = WR_ACT(zoom),
    .icon = WR_ICON_ZOOM,
    .help = "Click to zoom in, with Ctrl out; drag up and down to zoom smoothly. The wheel does "
            "it in "
            "any tool.",
    .press = zoom_press,
    .drag = zoom_drag,
    .meanwhile = true
};
