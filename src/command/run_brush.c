/* dab, stroke. */
#include "command/inner.h"

#include "base/progress.h"

#define SLICE 0.05 /* seconds between two looks at whether somebody wants it to stop */

bool wr_run_dab(WrSession *session, WrCall *call, WrError *err)
{
    WrPainting painting;
    if (!wr_painting_begin(session, call, &painting, err)) return false;
    const WrArg *at = wr_call_arg(call, "u,v");
    wr_brush_dab_on(&painting.ground, &painting.held.brush, at->numbers[0], at->numbers[1]);
    wr_painting_end(session, &painting);
    return true;
}

bool wr_session_draw(const WrPainting *painting, WrSampleAt *sample, const void *ctx, int count,
                     WrError *err)
{
    WrStroke *stroke = wr_stroke_new_on(&painting->ground, &painting->held.brush);
    bool more = true;
    for (int i = 0; i < count; i++) {
        wr_stroke_push(stroke, sample(ctx, i));
        do {
            if (!wr_progress_tell((double)i / count)) {
                wr_stroke_abandon(stroke);
                return wr_fail(err, "cancelled");
            }
            more = wr_stroke_work(stroke, SLICE);
        } while (more);
    }
    wr_stroke_free(stroke);
    return true;
}

static WrSample sample_of(const void *ctx, int i)
{
    const WrArg *points = ctx;
    const double *row = points->numbers + (size_t)6 * (size_t)i;
    return (WrSample){ row[0], row[1], points->counts[i] > 2 ? row[2] : 1, row[3], row[4], row[5] };
}

bool wr_run_stroke(WrSession *session, WrCall *call, WrError *err)
{
    WrPainting painting;
    if (!wr_painting_begin(session, call, &painting, err)) return false;
    const WrArg *points = wr_call_arg(call, "points");
    bool good = wr_session_draw(&painting, sample_of, points, points->rows, err);
    wr_painting_end(session, &painting);
    return good;
}
