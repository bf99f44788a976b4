/* The command select. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/enum_rows.h"
#include "command/args.h"
#include "command/commands.h"
#include "document/document.h"
#include "field/field.h"
#include "field/ops.h"
#include "field/select.h"
#include "scene/scene.h"

#include <math.h>

/* ---- select ---- */

#define POINT(name_, help_)                                                                        \
    {                                                                                              \
        .name = name_, .type = WR_ARG_TUPLE, .required = true, .components = 2, .shape = "u,v",    \
        .low = -WR_SELECT_REACH, .high = WR_SELECT_REACH, .help = help_                            \
    }

/* Handler of a form: returns the new selection, or NULL and an error. */
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
    WrSelectPoint c = point(call, "at"), r = point(call, "radii");
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

/* Without relief=, the height scale is that of the unit cell in the scene: height divided by texel width. */
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

static WrField *select_mask(WrSession *session, const WrCall *call, WrError *err)
{
    int index;
    if (!wr_session_find_layer(session, wr_call_arg(call, "N")->text, &index, err)) return NULL;
    const WrField *mask = session->state.document->layers[index].mask;
    if (mask) return wr_field_share(mask);
    wr_fail(err, "layer %d has no mask", index + 1);
    return NULL;
}

/* ---- changes of the present selection ---- */

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

enum {
    SELECT_ALL,
    SELECT_NONE,
    SELECT_INVERT,
    SELECT_RECT,
    SELECT_ELLIPSE,
    SELECT_LASSO,
    SELECT_HEIGHT,
    SELECT_SLOPE,
    SELECT_FLOOD,
    SELECT_MASK,
    SELECT_GROW,
    SELECT_SHRINK,
    SELECT_FEATHER,
    SELECT_FORMS
};

WR_ROWS(makers);
static const struct {
    Maker *make; /* NULL: no selection, so edits apply everywhere */
    bool joins;  /* has mode= */
} makers[] = {
    [WR_ROW(SELECT_ALL)] = { select_all, false },
    [WR_ROW(SELECT_NONE)] = { NULL, false },
    [WR_ROW(SELECT_INVERT)] = { select_invert, false },
    [WR_ROW(SELECT_RECT)] = { select_rect, true },
    [WR_ROW(SELECT_ELLIPSE)] = { select_ellipse, true },
    [WR_ROW(SELECT_LASSO)] = { select_lasso, true },
    [WR_ROW(SELECT_HEIGHT)] = { select_height, true },
    [WR_ROW(SELECT_SLOPE)] = { select_slope, true },
    [WR_ROW(SELECT_FLOOD)] = { select_flood, true },
    [WR_ROW(SELECT_MASK)] = { select_mask, true },
    [WR_ROW(SELECT_GROW)] = { select_grow, false },
    [WR_ROW(SELECT_SHRINK)] = { select_shrink, false },
    [WR_ROW(SELECT_FEATHER)] = { select_feather, false },
};
WR_ROWS_END(makers, SELECT_FORMS);

/* Combine a new selection (ownership passes) with the present one. */
static WrField *join(WrSession *session, const WrCall *call, WrField *made, WrError *err)
{
    WrSelectMode mode = (WrSelectMode)wr_call_choice(call, "mode");
    if (mode == WR_SELECT_REPLACE) return made;
    WrField *joined = wr_select_combine(session->state.document->selection, made, mode, err);
    wr_field_free(made);
    return joined;
}

static bool run_select(WrSession *session, WrCall *call, WrError *err)
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

#define JOIN                                                                                       \
    {                                                                                              \
        .name = "mode", .type = WR_ARG_CHOICE, .words = wr_select_modes,                           \
        .fallback_text = "replace", .help = "how it joins what is selected already"                \
    }

#define TEXELS(most, help_)                                                                        \
    {                                                                                              \
        .name = "by", .type = WR_ARG_NUMBER, .required = true, .low = 0, .high = most,             \
        .unit = "texels", .help = help_                                                            \
    }

#define HEIGHT(name_, help_)                                                                       \
    {                                                                                              \
        .name = name_, .type = WR_ARG_NUMBER, .required = true, .low = -WR_BIG_HEIGHT,             \
        .high = WR_BIG_HEIGHT, .help = help_                                                       \
    }

#define ANGLE(name_, default_, help_)                                                              \
    {                                                                                              \
        .name = name_, .type = WR_ARG_NUMBER, .low = 0, .high = 90, .fallback = NUMBERS(default_), \
        .unit = "degrees", .help = help_                                                           \
    }

WR_ROWS(select_forms);
static const WrForm select_forms[] = {
    [WR_ROW(SELECT_ALL)] = { .name = "all",
                             .help = "everything, as a selection that can be changed" },
    [WR_ROW(SELECT_NONE)] = { .name = "none", .help = "no selection: edits act everywhere" },
    [WR_ROW(SELECT_INVERT)] = { .name = "invert",
                                .help = "what is not selected; without a selection, all" },
    [WR_ROW(SELECT_RECT)] = { .name = "rect",
                              .help =
                                  "a rectangle; a corner beyond 0 or 1 crosses the table's edge",
                              .args = { POINT("from", "a corner"), POINT("to", "the corner across"),
                                        JOIN } },
    [WR_ROW(
        SELECT_ELLIPSE)] = { .name = "ellipse",
                             .help = "an ellipse, its sides along u and v",
                             .args = { { WR_ARG_MIDDLE, .also = "centre" }, WR_ARG_RADII, JOIN } },
    [WR_ROW(SELECT_LASSO)] = { .name = "lasso",
                               .help = "a polygon",
                               .args = { { .name = "points",
                                           .type = WR_ARG_LIST,
                                           .required = true,
                                           .components = 2,
                                           .shape = "u,v;...",
                                           .rows_low = 3,
                                           .rows_high = WR_SELECT_POINTS,
                                           .low = -WR_SELECT_REACH,
                                           .high = WR_SELECT_REACH,
                                           .help = "its corners in order" },
                                         JOIN } },
    [WR_ROW(SELECT_HEIGHT)] = { .name = "height",
                                .help = "where the composited height lies in a range",
                                .args = { HEIGHT("low", "lower end"),
                                          HEIGHT("high", "upper end"),
                                          { .name = "soft",
                                            .type = WR_ARG_NUMBER,
                                            .low = 0,
                                            .high = WR_BIG_HEIGHT,
                                            .fallback = NUMBERS(0),
                                            .unit = "height units",
                                            .help = "over how much it fades beyond the ends" },
                                          JOIN } },
    [WR_ROW(SELECT_SLOPE)] = { .name = "slope",
                               .help = "where the composite's slope lies in a range",
                               .args = { ANGLE("low", 0, "lower end"),
                                         ANGLE("high", 90, "upper end"),
                                         ANGLE("soft", 0, "over how much it fades beyond the ends"),
                                         { .name = "relief",
                                           .type = WR_ARG_NUMBER,
                                           .low = 0,
                                           .above = true,
                                           .high = 1e30,
                                           .unit = "texels",
                                           .help = "how tall a height of 1 is; left out, as the "
                                                   "scene's height makes it "
                                                   "on a cell that is one scene unit wide" },
                                         JOIN } },
    [WR_ROW(SELECT_FLOOD)] = { .name = "flood",
                               .help =
                                   "a connected part of the composite that is of about one height, "
                                   "without soft edge",
                               .args = { WR_ARGS_FLOOD("heights"), JOIN } },
    [WR_ROW(SELECT_MASK)] = { .name = "mask",
                              .help = "what a layer's mask shows",
                              .args = { { PLACE("N"), .type = WR_ARG_LAYER, .help = "the layer" },
                                        JOIN } },
    [WR_ROW(SELECT_GROW)] = { .name = "grow",
                              .help = "move its edge outwards",
                              .args = { TEXELS(WR_FIELD_MAX, "how far") } },
    [WR_ROW(SELECT_SHRINK)] = { .name = "shrink",
                                .help = "move its edge inwards",
                                .args = { TEXELS(WR_FIELD_MAX, "how far") } },
    [WR_ROW(SELECT_FEATHER)] = { .name = "feather",
                                 .help = "blur its edge",
                                 .args = { TEXELS(1024, "standard deviation of the Gaussian") } },
};
WR_ROWS_END(select_forms, SELECT_FORMS);

WR_FORMS(form_select, select_forms)

/* ---- the row ---- */

const WrCommand wr_command_select = {
    .name = "select",
    .kind = WR_CLASS_EDIT,
    .form_word = "WHAT",
    .form = form_select,
    .run = run_select,
    .help = "choose where edits act",
    .details = "Shapes wrap round periodic edges, and their edges are smooth. An edit under a "
               "selection s leaves old + s (new - old), and where s is 0 every bit as it was.",
    .example = "select ellipse at=0.5,0.5 radii=0.3,0.2"
};
