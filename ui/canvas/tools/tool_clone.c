/* Clone tool: Ctrl or Alt and a click sets the source. The first stroke afterwards fixes the offset between source
   and pointer, which later strokes keep. */
#include "ui/app/state/action_list.h"
#include "ui/canvas/tools/tool_clone.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/canvas/tools/brush_outline.h"
#include "ui/canvas/tools/stroke_input.h"
#include "ui/canvas/tools/tool.h"
#include "ui/canvas/tools/tool_brush.h"
#include "ui/canvas/tools/tool_rows.h"
#include "ui/canvas/overlays/marks.h"

#include "brush/brush.h"
#include "field/field.h"

#include <math.h>

static bool sets_source(const WrPointer *at)
{
    return (at->mods & (WR_MOD_CTRL | WR_MOD_ALT)) != 0;
}

static void set_source(WrApp *app, const WrPointer *at)
{
    WrCloneState *draw = app->clone;
    draw->source = true;
    draw->anchored = false;
    draw->source_u = at->u;
    draw->source_v = at->v;
    wr_app_redraw(app);
}

/* The shortest difference on periodic axes, rounded as in lines. */
static double short_way(double d, bool wraps)
{
    double shortest = wraps ? d - floor(d + 0.5) : d;
    return rint(shortest * 1e7) / 1e7 + 0.0;
}

static void press(WrApp *app, const WrPointer *at)
{
    WrCloneState *draw = app->clone;
    const WrField *field = wr_app_field(app);
    if (sets_source(at)) {
        set_source(app, at);
        return;
    }
    if (!draw->source) {
        wr_app_say(app, "First set the source of the heights by Ctrl+click");
        return;
    }
    if (!draw->anchored) {
        draw->anchored = true;
        app->settings->brush.source_u =
            short_way(draw->source_u - at->u, wr_field_wrap_u(field) == WR_WRAP_PERIODIC);
        app->settings->brush.source_v =
            short_way(draw->source_v - at->v, wr_field_wrap_v(field) == WR_WRAP_PERIODIC);
    }
    WrPointer plain = *at;
    plain.mods &= WR_MOD_SHIFT; /* other modifiers would pick a height */
    wr_brush_press(app, &plain);
}

static void drag(WrApp *app, const WrPointer *at)
{
    if (sets_source(at) && !app->brush->drawing) {
        set_source(app, at);
        return;
    }
    WrPointer plain = *at;
    plain.mods &= WR_MOD_SHIFT;
    if (app->brush->drawing) wr_brush_drag(app, &plain);
}

static void marks(WrApp *app)
{
    const WrCloneState *draw = app->clone;
    const WrBrush *brush = &app->settings->brush;
    if (!draw->source) return;
    double u = draw->source_u, v = draw->source_v;
    if (draw->anchored && app->hand->on_canvas) {
        u = app->hand->at.u + brush->source_u;
        v = app->hand->at.v + brush->source_v;
    }
    wr_overlay_cross(app, u, v, WR_COLOUR_CELL);
}

/* ---- the row ---- */

const WrTool wr_tool_clone = { .action = WR_ACT(clone),
                               .icon = WR_ICON_CLONE,
                               .help =
                                   "Paint with heights from elsewhere: Ctrl+click sets the source.",
                               .press = press,
                               .drag = drag,
                               .release = wr_brush_release,
                               .overlay = wr_brush_overlay,
                               .marks = marks,
                               .options = wr_brush_options,
                               .paints = true,
                               .mode = 1 + WR_BRUSH_CLONE };

static void another(WrApp *app)
{
    app->clone->source = app->clone->anchored = false;
}

const WrPart wr_part_clone = { .another = another };
