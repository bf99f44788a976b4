/* dab, stroke. */
#include "command/inner.h"

WrBrush wr_call_brush(const WrCall *call)
{
    return (WrBrush){ .radius = wr_call_number(call, "radius"),
                      .hardness = wr_call_number(call, "hardness"),
                      .strength = wr_call_number(call, "strength"),
                      .mode = (WrBrushMode)wr_call_choice(call, "mode"),
                      .to = wr_call_number(call, "to") };
}

bool wr_run_dab(WrSession *session, WrCall *call, WrError *err)
{
    WrBrush brush = wr_call_brush(call);
    WrBrushGround ground;
    if (!wr_session_ground(session, &ground, err)) return false;
    const WrArg *at = wr_call_arg(call, "u,v");
    wr_brush_dab_on(&ground, &brush, at->numbers[0], at->numbers[1]);
    return true;
}

bool wr_run_stroke(WrSession *session, WrCall *call, WrError *err)
{
    const volatile int *cancel = session->options.cancel;
    WrBrush brush = wr_call_brush(call);
    const WrArg *points = wr_call_arg(call, "points");
    WrBrushGround ground;
    if (!wr_session_ground(session, &ground, err)) return false;
    WrStroke *stroke = wr_stroke_new_on(&ground, &brush);
    bool good = true;
    for (int i = 0; good && i < points->rows; i++) {
        const double *row = points->numbers + (size_t)6 * (size_t)i;
        WrSample sample = { row[0], row[1], points->counts[i] > 2 ? row[2] : 1,
                            row[3], row[4], row[5] };
        wr_stroke_add(stroke, sample);
        if (cancel && *cancel) good = wr_fail(err, "cancelled");
    }
    wr_stroke_free(stroke);
    return good;
}
