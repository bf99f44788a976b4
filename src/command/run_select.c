/* select: where edits act. */
#include "command/inner.h"

#include "base/memory.h"
#include "field/select.h"

#include <math.h>

/* A form's work: the new selection, or NULL and an error. */
typedef WrField *Maker(WrSession *session, const WrCall *call, WrError *err);

static const WrField *like(const WrSession *session)
{
    return session->state.document->layers[0].heights;
}

static WrField *uniform(const WrSession *session, float level)
{
    const WrField *field = like(session);
    return wr_field_new(wr_field_width(field), wr_field_height(field), wr_field_wrap_u(field),
                        wr_field_wrap_v(field), level, NULL);
}

static WrField *select_all(WrSession *session, const WrCall *call, WrError *err)
{
    (void)call;
    (void)err;
    return uniform(session, 1.0f);
}

static WrField *select_invert(WrSession *session, const WrCall *call, WrError *err)
{
    (void)call;
    (void)err;
    const WrField *selection = session->state.document->selection;
    return selection ? wr_select_invert(selection) : uniform(session, 1.0f);
}

/* ---- shapes ---- */

static WrSelectPoint point(const WrCall *call, const char *name)
{
    const double *numbers = wr_call_arg(call, name)->numbers;
    return (WrSelectPoint){ numbers[0], numbers[1] };
}

static WrField *select_rect(WrSession *session, const WrCall *call, WrError *err)
{
    return wr_select_rectangle(like(session), point(call, "from"), point(call, "to"),
                               session->options.pool, err);
}

static WrField *select_ellipse(WrSession *session, const WrCall *call, WrError *err)
{
    WrSelectPoint c = point(call, "centre"), r = point(call, "radii");
    WrSelectPoint a = { c.u - r.u, c.v - r.v }, b = { c.u + r.u, c.v + r.v };
    return wr_select_ellipse(like(session), a, b, session->options.pool, err);
}

static WrField *select_lasso(WrSession *session, const WrCall *call, WrError *err)
{
    const WrArg *points = wr_call_arg(call, "points");
    WrSelectPoint *corners =
        wr_try_alloc((size_t)points->rows, sizeof *corners, "points of a lasso", err);
    if (!corners) return NULL;
    for (int i = 0; i < points->rows; i++)
        corners[i] = (WrSelectPoint){ points->numbers[2 * i], points->numbers[2 * i + 1] };
    WrField *made =
        wr_select_lasso(like(session), corners, points->rows, session->options.pool, err);
    wr_free(corners);
    return made;
}

static WrField *select_height(WrSession *session, const WrCall *call, WrError *err)
{
    const WrField *f = wr_document_composite(session->state.document, session->options.pool);
    return wr_select_height(f, wr_call_number(call, "low"), wr_call_number(call, "high"),
                            wr_call_number(call, "soft"), session->options.pool, err);
}

/* Left out, relief is that of the unit cell as the scene shows it: its height over the width of a texel. */
static WrField *select_slope(WrSession *session, const WrCall *call, WrError *err)
{
    const WrDocument *document = session->state.document;
    const WrField *f = wr_document_composite(document, session->options.pool);
    double relief = fabs(document->scene->height) * wr_field_width(f);
    if (wr_call_given(call, "relief")) relief = wr_call_number(call, "relief");
    return wr_select_slope(f, relief, wr_call_number(call, "low"), wr_call_number(call, "high"),
                           wr_call_number(call, "soft"), session->options.pool, err);
}

static WrField *select_flood(WrSession *session, const WrCall *call, WrError *err)
{
    const WrField *f = wr_document_composite(session->state.document, session->options.pool);
    WrSelectPoint at = point(call, "u,v");
    return wr_select_flood(f, at.u, at.v, wr_call_number(call, "tolerance"),
                           wr_call_choice(call, "diagonal") == 1, session->options.pool,
                           wr_progress_here(), err);
}

/* ---- changes of the present one ---- */

static const WrField *present(const WrSession *session, const WrCall *call, WrError *err)
{
    const WrField *selection = session->state.document->selection;
    if (!selection) wr_fail(err, "nothing is selected that could %s", call->form_name);
    return selection;
}

static WrField *select_grow(WrSession *session, const WrCall *call, WrError *err)
{
    const WrField *a = present(session, call, err);
    return a ? wr_select_grow(a, wr_call_number(call, "by"), session->options.pool, err) : NULL;
}

static WrField *select_shrink(WrSession *session, const WrCall *call, WrError *err)
{
    const WrField *a = present(session, call, err);
    return a ? wr_select_shrink(a, wr_call_number(call, "by"), session->options.pool, err) : NULL;
}

static WrField *select_feather(WrSession *session, const WrCall *call, WrError *err)
{
    const WrField *a = present(session, call, err);
    return a ? wr_select_feather(a, wr_call_number(call, "by"), session->options.pool, err) : NULL;
}

/* In the order of wr_form_select. */
static const struct {
    Maker *make; /* NULL: nothing selected, so edits act everywhere */
    bool joins;  /* has mode= */
} makers[] = { { select_all, false },   { NULL, false },          { select_invert, false },
               { select_rect, true },   { select_ellipse, true }, { select_lasso, true },
               { select_height, true }, { select_slope, true },   { select_flood, true },
               { select_grow, false },  { select_shrink, false }, { select_feather, false } };

/* Join what was made (taken) to the present selection. */
static WrField *join(WrSession *session, const WrCall *call, WrField *made, WrError *err)
{
    WrSelectMode mode = (WrSelectMode)wr_call_choice(call, "mode");
    if (mode == WR_SELECT_REPLACE) return made;
    WrField *joined = wr_select_combine(session->state.document->selection, made, mode, err);
    wr_field_free(made);
    return joined;
}

bool wr_run_select(WrSession *session, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    WrField *made = NULL;
    if (makers[call->form].make) {
        made = makers[call->form].make(session, call, err);
        if (made && makers[call->form].joins) made = join(session, call, made, err);
        if (!made) return false;
        float low, high;
        wr_field_range(made, &low, &high);
        if (!(high > 0.0f))
            wr_session_note(session, "nothing is inside the selection: edits will change nothing");
    }
    wr_field_free(document->selection);
    document->selection = made;
    return true;
}
