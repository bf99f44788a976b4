/* A stroke in progress: an open command. */
#include "command/session_internal.h"

#include "base/error.h"

#include <math.h>
#include <string.h>

bool wr_session_stroke_begin(WrSession *session, const char *head, WrError *err)
{
    WrCall *call;
    if (!wr_session_refuse_in_stroke(session, err)) return false;
    if (!wr_call_parse(head, true, &call, err)) return false;
    if (!call->command || !call->command->streams || wr_call_given(call, "points")) {
        wr_call_free(call);
        return wr_fail(err, "a stroke begins with a stroke command without points");
    }
    WrPainting painting;
    if (!wr_painting_begin(session, call, &painting, err)) {
        wr_document_edit_end(session->state.document, &session->stand_in);
        wr_call_free(call);
        wr_error_prefix(err, "stroke: ");
        return false;
    }
    wr_session_journal_stroke_begin(session, call);
    session->stroke_call = call;
    session->painting = painting;
    session->stroke = wr_stroke_new_on(&session->painting.ground, &session->painting.held.brush);
    return true;
}

/* The double that the text of `value` with n decimals reads back as. k / 10^n is correctly rounded because both are
   integers below 2^53. */
static double round_decimals(double value, double ten_to_n)
{
    double k = rint(value * ten_to_n);
    return fabs(k) < 0x1p53 ? k / ten_to_n + 0.0 : value;
}

static double clamp_finite(double value, double low, double high)
{
    if (!(value >= low)) return isnan(value) ? 0 : low;
    return value > high ? high : value;
}

static WrSample round_sample(WrSample s)
{
    return (WrSample){ .u = round_decimals(s.u, 1e7),
                       .v = round_decimals(s.v, 1e7),
                       .pressure = round_decimals(clamp_finite(s.pressure, 0, 1), 1e4),
                       .tilt_x = round_decimals(clamp_finite(s.tilt_x, -1, 1), 1e4),
                       .tilt_y = round_decimals(clamp_finite(s.tilt_y, -1, 1), 1e4),
                       .seconds = round_decimals(clamp_finite(s.seconds, 0, 1e9), 1e4) };
}

bool wr_session_stroke_push(WrSession *session, const WrSample *samples, int count, WrError *err)
{
    if (!session->stroke) return wr_fail(err, "no stroke is being drawn");
    for (int i = 0; i < count; i++)
        if (!(fabs(samples[i].u) <= 1e9) || !(fabs(samples[i].v) <= 1e9))
            return wr_fail(err, "stroke: sample %d is at %g,%g: must be within 1e9 of 0", i + 1,
                           samples[i].u, samples[i].v);
    if (count > WR_POINTS_MAX - wr_call_arg(session->stroke_call, "points")->rows)
        return wr_fail(err, "stroke: more than %d samples", WR_POINTS_MAX);
    for (int i = 0; i < count; i++) {
        WrSample s = round_sample(samples[i]);
        double row[1][6] = { { s.u, s.v, s.pressure, s.tilt_x, s.tilt_y, s.seconds } };
        int n = s.seconds != 0 ? 6 : s.tilt_x != 0 || s.tilt_y != 0 ? 5 : s.pressure != 1 ? 3 : 2;
        wr_session_journal_stroke_add(session, (const double(*)[6])row, &n, 1);
        wr_call_add_row(session->stroke_call, "points", row[0], n);
        wr_stroke_push(session->stroke, s);
    }
    return true;
}

bool wr_session_stroke_work(WrSession *session, double seconds)
{
    return session->stroke && wr_stroke_work(session->stroke, seconds);
}

bool wr_session_stroke_add(WrSession *session, const WrSample *samples, int count, WrError *err)
{
    if (!wr_session_stroke_push(session, samples, count, err)) return false;
    while (wr_session_stroke_work(session, 1.0)) {
    }
    return true;
}

/* End the open stroke and return its line. */
static WrCall *take_call(WrSession *session)
{
    WrCall *call = session->stroke_call;
    session->stroke = NULL;
    session->stroke_call = NULL;
    return call;
}

/* Queued and delayed samples are drawn when the stroke is freed. */
bool wr_session_stroke_end(WrSession *session, WrError *err)
{
    if (!session->stroke) return wr_fail(err, "no stroke is being drawn");
    wr_stroke_free(session->stroke);
    wr_painting_end(session, &session->painting);
    wr_document_edit_end(session->state.document, &session->stand_in);
    WrCall *call = take_call(session);
    bool drawn = wr_call_given(call, "points");
    const bool good = !drawn || wr_session_follow(session, err);
    drawn = drawn && good;
    if (drawn) wr_session_remember(session, call);
    else wr_session_restore(session);
    wr_session_journal_stroke_end(session, drawn);
    wr_call_free(call);
    return good;
}

void wr_session_stroke_cancel(WrSession *session)
{
    if (!session->stroke) return;
    wr_stroke_abandon(session->stroke);
    wr_painting_end(session, &session->painting);
    wr_document_edit_end(session->state.document, &session->stand_in);
    wr_call_free(take_call(session));
    wr_session_journal_stroke_end(session, false);
    wr_session_restore(session);
}

bool wr_session_in_stroke(const WrSession *session)
{
    return session->stroke != NULL;
}
