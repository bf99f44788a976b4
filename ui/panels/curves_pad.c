/* Curve editor of the operation `curves`: the curve over the histogram of heights, with draggable points. */
#include "ui/state/app_state.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/panels/panel_adjust.h"
#include "ui/panels/points_pad.h"

#include "field/monotone_curve.h"

#include <math.h>

#define ROOM_UNITS 200

/* Height range of the pad, the same on both axes. */
static WrPointsSpan span_of(const WrHeightCounts *h, const double *value)
{
    double low = fmin(h->low, 0.0), high = fmax(h->high, 1.0);
    for (int i = 1; i <= 2 * (int)*value; i++) {
        low = fmin(low, value[i]);
        high = fmax(high, value[i]);
    }
    return (WrPointsSpan){ low, high, low, high };
}

static bool at(const void *ctx, double x, double *y)
{
    const WrCurve *curve = ctx;
    if (curve->count == 0) return false;
    *y = wr_curve_at(curve, x);
    return true;
}

bool wr_curves_pad(WrApp *app)
{
    static const WrPointsRules rules = { .least = 2, .most = WR_CURVE_POINTS };
    WrAdjust *adjust = app->adjust;
    const WrHeightCounts *h = wr_height_counts(app);
    double *value = adjust->param; /* the operation's only parameter */
    WrPad pad = wr_gui_pad_begin("curve", 0, wr_gui_px(ROOM_UNITS));
    const WrPointsSpan now = span_of(h, value);
    const bool changed = wr_points_move(&pad, &now, &rules, &adjust->points, value);
    const WrPointsSpan *span = &adjust->points.span;
    WrCurve curve = { .count = 0 };
    if (!wr_curve_make(value + 1, (int)*value, &curve, NULL)) curve.count = 0;
    wr_height_bars(&pad, (WrHeightSpan){ span->left, span->right }, h);
    wr_gui_draw_line(pad.x, pad.y + pad.h, pad.x + pad.w, pad.y, 0x40ffffffu, wr_gui_px(1));
    wr_points_draw(&pad, &adjust->points, value, at, &curve);
    wr_gui_pad_end();
    if (!pad.held && !adjust->points.chosen)
        wr_gui_tip("Old heights from left to right, new heights from bottom to top. Drag the "
                   "points; click to add one; drag one out, or press Delete, to remove it");
    return changed;
}
