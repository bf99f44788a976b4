/* Cancellable drawing of a whole stroke. */
#include "command/session_internal.h"

#include "base/error.h"
#include "base/progress.h"

#define SLICE 0.05 /* seconds between two checks for cancellation */

bool wr_session_draw(const WrPainting *painting, WrSampleAt *sample, const void *ctx, int count,
                     WrError *err)
{
    WrStroke *stroke = wr_stroke_new_on(&painting->ground, &painting->held.brush);
    bool more = true;
    for (int i = 0; i < count; i++) {
        wr_stroke_push(stroke, sample(ctx, i));
        do {
            if (!wr_progress_report((double)i / count)) {
                wr_stroke_abandon(stroke);
                return wr_fail(err, "cancelled");
            }
            more = wr_stroke_work(stroke, SLICE);
        } while (more);
    }
    wr_stroke_free(stroke);
    return true;
}
