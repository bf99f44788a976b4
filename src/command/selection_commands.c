/* Commands for the selection: select, copy, transform. */
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "command/args.h"
#include "command/commands.h"
#include "document/blend.h"
#include "document/document.h"
#include "document/edit.h"
#include "export/export.h"
#include "field/field.h"
#include "field/ops.h"
#include "field/select.h"
#include "generate/generator.h"
#include "generate/transform_piece.h"
#include "image/image.h"
#include "scene/scene.h"
#include "system/clock.h"

#include <math.h>

/* ---- The command select ---- */

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
        .fallback_text = "replace", .help = "how it is combined with the present selection"        \
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
    [WR_ROW(SELECT_ALL)] = { .name = "all", .help = "select everything" },
    [WR_ROW(SELECT_NONE)] = { .name = "none",
                              .help = "remove the selection: edits act everywhere" },
    [WR_ROW(
        SELECT_INVERT)] = { .name = "invert",
                            .help =
                                "invert the selection; without a selection, select everything" },
    [WR_ROW(SELECT_RECT)] = { .name = "rect",
                              .help = "select a rectangle; corners below 0 or above 1 cross the "
                                      "table's edge",
                              .args = { POINT("from", "a corner"),
                                        POINT("to", "the opposite corner"), JOIN } },
    [WR_ROW(
        SELECT_ELLIPSE)] = { .name = "ellipse",
                             .help = "select an ellipse with axes along u and v",
                             .args = { { WR_ARG_MIDDLE, .also = "centre" }, WR_ARG_RADII, JOIN } },
    [WR_ROW(SELECT_LASSO)] = { .name = "lasso",
                               .help = "select a polygon",
                               .args = { { .name = "points",
                                           .type = WR_ARG_LIST,
                                           .required = true,
                                           .components = 2,
                                           .shape = "u,v;...",
                                           .rows_low = 3,
                                           .rows_high = WR_SELECT_POINTS,
                                           .low = -WR_SELECT_REACH,
                                           .high = WR_SELECT_REACH,
                                           .help = "corners in order" },
                                         JOIN } },
    [WR_ROW(SELECT_HEIGHT)] = { .name = "height",
                                .help = "select a range of the composite's height",
                                .args = { HEIGHT("low", "lower end"),
                                          HEIGHT("high", "upper end of the range"),
                                          { .name = "soft",
                                            .type = WR_ARG_NUMBER,
                                            .low = 0,
                                            .high = WR_BIG_HEIGHT,
                                            .fallback = NUMBERS(0),
                                            .unit = "height units",
                                            .help = "width of the fade beyond both ends" },
                                          JOIN } },
    [WR_ROW(SELECT_SLOPE)] = { .name = "slope",
                               .help = "select a range of the composite's slope",
                               .args = { ANGLE("low", 0, "lower end"),
                                         ANGLE("high", 90, "upper end of the range"),
                                         ANGLE("soft", 0, "width of the fade beyond both ends"),
                                         { .name = "relief",
                                           .type = WR_ARG_NUMBER,
                                           .low = 0,
                                           .above = true,
                                           .high = 1e30,
                                           .unit = "texels",
                                           .help = "relief of height 1; left out, that of the "
                                                   "scene on a cell one scene unit wide" },
                                         JOIN } },
    [WR_ROW(SELECT_FLOOD)] = { .name = "flood",
                               .help = "select a connected region of similar height in the "
                                       "composite, with a hard edge",
                               .args = { WR_ARGS_FLOOD("heights"), JOIN } },
    [WR_ROW(SELECT_MASK)] = { .name = "mask",
                              .help = "select by the mask of a layer",
                              .args = { { PLACE("N"), .type = WR_ARG_LAYER, .help = "the layer" },
                                        JOIN } },
    [WR_ROW(SELECT_GROW)] = { .name = "grow",
                              .help = "move the selection's edge outwards",
                              .args = { TEXELS(WR_FIELD_MAX, "distance") } },
    [WR_ROW(SELECT_SHRINK)] = { .name = "shrink",
                                .help = "move the selection's edge inwards",
                                .args = { TEXELS(WR_FIELD_MAX, "distance") } },
    [WR_ROW(SELECT_FEATHER)] = { .name = "feather",
                                 .help = "blur the selection's edge",
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
    .help = "select where edits act",
    .details = "Shapes wrap around periodic edges and are antialiased. An edit under a selection s "
               "results in old + s (new - old); where s is 0, every bit stays the same.",
    .example = "select ellipse at=0.5,0.5 radii=0.3,0.2"
};

/* ---- The command copy: the selection as a file for `picture paste` ---- */

enum { OF_LAYER, OF_COMPOSITE };
static const char *const sources[] = { "layer", "composite", NULL };

typedef struct Copying {
    const WrField *heights, *cover, *selection; /* the last two NULL: 1 */
    WrSelectBox box;
    const char *path;
} Copying;

static void read_row(const WrField *field, const WrSelectBox *box, int y, float *out)
{
    if (field) {
        wr_field_read(field, box->i, box->j + y, box->count_i, 1, out, (size_t)box->count_i);
        return;
    }
    for (int x = 0; x < box->count_i; x++) out[x] = 1.0f;
}

/* Interleaved row: each height, and its weight = selection times coverage. */
static void make_row(const Copying *copy, int y, float *parts, float *out)
{
    const int n = copy->box.count_i;
    float *cover = parts + n, *selection = parts + 2 * (size_t)n;
    read_row(copy->heights, &copy->box, y, parts);
    read_row(copy->cover, &copy->box, y, cover);
    read_row(copy->selection, &copy->box, y, selection);
    for (int x = 0; x < n; x++) {
        out[2 * (size_t)x] = parts[x];
        out[2 * (size_t)x + 1] = cover[x] * selection[x];
    }
}

static float *parts_of(const Copying *copy, WrError *err)
{
    return wr_try_alloc((size_t)copy->box.count_i, 5 * sizeof(float), "rows of the copy", err);
}

/* rows and seen have the signature of WrImageOut: they are called strip by strip, so a copy needs memory for single rows
   only. */
static bool rows(void *ctx, int y, int count, void *out, WrError *err)
{
    const Copying *copy = ctx;
    float *parts = parts_of(copy, err);
    for (int k = 0; parts && k < count; k++)
        make_row(copy, y + k, parts, (float *)out + 2 * (size_t)k * (size_t)copy->box.count_i);
    wr_free(parts);
    return parts != NULL;
}

/* Read-back check: the file's values equal the copied ones. */
static bool seen(void *ctx, int y, int count, const float *values, bool exact, WrError *err)
{
    const Copying *copy = ctx;
    const size_t n = 2 * (size_t)copy->box.count_i;
    float *parts = parts_of(copy, err), *row = parts ? parts + 3 * (size_t)copy->box.count_i : NULL;
    bool same = parts != NULL;
    for (int k = 0; same && exact && k < count; k++) {
        make_row(copy, y + k, parts, row);
        for (size_t x = 0; same && x < n; x++)
            same =
                values[(size_t)k * n + x] == row[x] ||
                wr_fail(err, "%s: row %d does not read back as it was written", copy->path, y + k);
    }
    wr_free(parts);
    return same;
}

static bool run_copy(WrSession *session, WrCall *call, WrError *err);

/* Copies the layer that the active group would become. */
static bool copy_group(WrSession *session, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    session->state.document = wr_document_snapshot(document);
    wr_filters_forget();
    wr_document_rasterize_group(session->state.document, document->active, session->options.pool);
    const bool good = wr_filters_carried(err) && run_copy(session, call, err);
    wr_document_free(session->state.document);
    session->state.document = document;
    return good;
}

static bool run_copy(WrSession *session, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    const WrLayer *layer = &document->layers[document->active];
    if (layer->is_group && !layer->on_mask && wr_call_choice(call, "of") != OF_COMPOSITE)
        return copy_group(session, call, err);
    Copying copy = { .heights = layer->on_mask ? layer->mask : layer->heights,
                     .cover = layer->on_mask ? NULL : layer->cover,
                     .selection = document->selection,
                     .path = wr_call_arg(call, "FILE")->text };
    if (wr_call_choice(call, "of") == OF_COMPOSITE) {
        copy.heights = wr_document_whole(document, session->options.pool, err);
        if (!copy.heights) return false;
        copy.cover = NULL;
    }
    if (wr_progress_stopped()) return wr_fail(err, "cancelled");
    copy.box = (WrSelectBox){ 0, 0, wr_field_width(copy.heights), wr_field_height(copy.heights) };
    if (copy.selection && !wr_select_box(copy.selection, &copy.box))
        return wr_fail(err, "the selection contains nothing to copy");
    if (!wr_image_can_write(copy.path, WR_PIXEL_F32, 2, true, err)) return false;
    const WrImageOut out = { .width = copy.box.count_i,
                             .height = copy.box.count_j,
                             .channels = 2,
                             .type = WR_PIXEL_F32,
                             .data = true,
                             .rows = rows,
                             .seen = seen,
                             .ctx = &copy };
    const double began = wr_clock_seconds();
    if (!wr_image_write(copy.path, &out, 1, err)) return false;
    const WrExportReport report = {
        .width = out.width, .height = out.height, .channels = out.channels, .depth = 32
    };
    wr_session_receipt(session, copy.path, "copy", &report, began);
    return true;
}

static const WrArgSpec args_copy[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH, .help = "an OpenEXR or TIFF file" },
    { .name = "of",
      .type = WR_ARG_CHOICE,
      .words = sources,
      .fallback_text = "layer",
      .help = "the active layer (or its mask, if that is being edited), or the composite" },
    { 0 }
};

const WrCommand wr_command_copy = {
    .name = "copy",
    .kind = WR_CLASS_OUTPUT,
    .args = args_copy,
    .run = run_copy,
    .help = "write the selected heights to a file",
    .details = "The file has the size of the selection's bounding box; its alpha is the selection. "
               "`picture paste` pastes it anywhere, in any document.",
    .example = "copy piece.exr"
};

/* ---- The command transform: move, rotate, scale and mirror the selection or whole layers ---- */

/* State of one line. */
typedef struct Moving {
    WrPlacing placing; /* for any table of the document; heights and weight are set for each one */
    const WrField *selection;
    WrBlend blend;
    bool leave;
    WrGenerateJob job;
    int tables, done; /* to move, and moved: equal parts of the progress */
} Moving;

/* Blend modes that depend only on the two heights. */
static const WrBlend blends[] = { WR_BLEND_REPLACE, WR_BLEND_ADD, WR_BLEND_SUBTRACT,
                                  WR_BLEND_MAX,     WR_BLEND_MIN, WR_BLEND_MULTIPLY };

static const char *blend_name(int i)
{
    return i < WR_LENGTH(blends) ? wr_blends[blends[i]].name : NULL;
}

static WrField *flat(const WrField *like, float level)
{
    return wr_field_new(wr_field_width(like), wr_field_height(like), wr_field_wrap_u(like),
                        wr_field_wrap_v(like), level, NULL);
}

/* ---- joining ---- */

/* Compositing of a piece's texel (height h, coverage c) over a layer's (height b, coverage cb): alpha compositing,
 * with the blend mode where both are covered. */
typedef struct Texel {
    float height, cover;
} Texel;

static double blended(WrBlend blend, float below, float height)
{
    WrBlendTile tile = { .heights = &height, .cover_level = 1.0f, .mask_level = 1.0f };
    wr_blend_tile(blend, 1.0f, 0.0f, &tile, 1, &below);
    return (double)below;
}

/*   c' = c + cb (1 - c)
     h' = (c t + cb (1 - c) b) / c', with t = h + cb (blend(b, h) - h)
   Porter and Duff's "over" with straight alpha; the blend mode counts as far as the layer is covered. */
static Texel over(WrBlend blend, Texel below, Texel piece)
{
    double c = (double)piece.cover, cb = (double)below.cover, b = (double)below.height;
    double target = (double)piece.height;
    if (!(c > 0.0)) return below;
    if (blend != WR_BLEND_REPLACE)
        target += cb * (blended(blend, below.height, piece.height) - target);
    double all = c + cb * (1.0 - c);
    double height = c >= 1.0 ? target : (c * target + cb * (1.0 - c) * b) / all;
    return (Texel){ (float)height, (float)all };
}

static void join_rows(const Moving *m, WrLayer *layer, const WrRelief *piece, const WrField *cover,
                      int j, float *rows)
{
    const int n = wr_field_width(layer->heights);
    float *h = rows, *c = rows + n, *ph = rows + 2 * (size_t)n, *pc = rows + 3 * (size_t)n,
          *pp = rows + 4 * (size_t)n;
    const size_t pitch = (size_t)n;
    wr_field_read(layer->heights, 0, j, n, 1, h, pitch);
    if (layer->cover) wr_field_read(layer->cover, 0, j, n, 1, c, pitch);
    wr_field_read(piece->heights, 0, j, n, 1, ph, pitch);
    wr_field_read(piece->cover, 0, j, n, 1, pc, pitch);
    if (cover) wr_field_read(cover, 0, j, n, 1, pp, pitch);
    for (int i = 0; i < n; i++) {
        Texel below = { h[i], layer->cover ? c[i] : 1.0f };
        Texel made = over(m->blend, below, (Texel){ ph[i], pc[i] * (cover ? pp[i] : 1.0f) });
        h[i] = made.height;
        c[i] = made.cover < 1.0f ? made.cover : 1.0f;
    }
    wr_field_write(layer->heights, 0, j, n, 1, h, pitch);
    if (layer->cover) wr_field_write(layer->cover, 0, j, n, 1, c, pitch);
}

static bool any_in_row(const WrField *field, int j, float *row)
{
    const int n = wr_field_width(field);
    wr_field_read(field, 0, j, n, 1, row, (size_t)n);
    for (int i = 0; i < n; i++)
        if (row[i] > 0.0f) return true;
    return false;
}

/* cover: coverage of the piece; NULL: 1 everywhere. */
static bool join_piece(const Moving *m, WrLayer *layer, const WrRelief *piece, const WrField *cover,
                       WrError *err)
{
    float *rows = wr_try_alloc((size_t)wr_field_width(layer->heights), 5 * sizeof *rows,
                               "rows of the moved part", err);
    for (int j = 0; rows && j < wr_field_height(layer->heights); j++) {
        if (wr_progress_stopped()) {
            wr_free(rows);
            return wr_fail(err, "cancelled");
        }
        if (any_in_row(piece->cover, j, rows)) join_rows(m, layer, piece, cover, j, rows);
    }
    wr_free(rows);
    return rows != NULL;
}

/* ---- one table ---- */

static bool place(Moving *m, const WrField *what, const WrField *weight, WrRelief *out,
                  WrError *err)
{
    m->placing.heights = what;
    m->placing.weight = weight;
    WrGenerateJob job = m->job;
    WrProgressPart part;
    job.progress = wr_progress_part(&part, m->job.progress, (double)m->done / m->tables,
                                    (m->done + 1.0) / m->tables);
    m->done++;
    return wr_transform_piece(&m->placing, &job, out, err);
}

/* Weight of a whole layer without coverage of which a copy moves: 1 where its heights are not 0, so that the copy replaces
   only the texels under its content. */
static WrField *content_of(const WrField *heights, WrPool *pool, WrError *err)
{
    WrField *empty = wr_select_height(heights, 0.0, 0.0, 0.0, pool, err);
    WrField *content = empty ? wr_select_invert(empty) : NULL;
    wr_field_free(empty);
    return content;
}

/* Clear the source area, weighted by the selection. */
static void take_out(const Moving *m, WrField **field)
{
    WrField *nothing = flat(*field, 0.0f), *left = wr_edit_within(*field, nothing, m->selection);
    wr_field_free(nothing);
    wr_field_free(*field);
    *field = left;
}

/* Move the mask with its whole layer; uncovered areas show everything. */
static bool move_mask(Moving *m, WrLayer *layer, WrError *err)
{
    WrRelief piece = { NULL, NULL };
    if (!layer->mask || m->selection || m->leave) return true;
    if (!place(m, layer->mask, NULL, &piece, err)) return false;
    WrField *white = flat(layer->mask, 1.0f);
    wr_field_free(layer->mask);
    layer->mask = wr_edit_within(white, piece.heights, piece.cover);
    wr_field_free(white);
    wr_relief_fini(&piece);
    return true;
}

/* Number of tables that move_layer moves. */
static int tables_of(const Moving *m, const WrLayer *layer)
{
    const bool holds = wr_layer_holds(layer);
    return holds + (holds && layer->cover) + (layer->mask && !m->selection && !m->leave);
}

static bool move_layer(Moving *m, WrLayer *layer, WrError *err)
{
    WrRelief piece = { NULL, NULL }, cover = { NULL, NULL };
    if (!wr_layer_holds(layer)) return move_mask(m, layer, err);
    const bool stamps = m->leave && !m->selection && !layer->cover;
    WrField *content = stamps ? content_of(layer->heights, m->job.pool, err) : NULL;
    bool good = (content || !stamps) &&
                place(m, layer->heights, stamps ? content : m->selection, &piece, err) &&
                (!layer->cover || place(m, layer->cover, m->selection, &cover, err));
    wr_field_free(content);
    if (good && !m->leave) {
        take_out(m, &layer->heights);
        if (layer->cover) take_out(m, &layer->cover);
    }
    good = good && join_piece(m, layer, &piece, cover.heights, err) && move_mask(m, layer, err);
    wr_relief_fini(&piece);
    wr_relief_fini(&cover);
    return good;
}

/* ---- the line ---- */

static bool check_scale(const double *scale, WrError *err)
{
    for (int k = 0; k < 2; k++)
        if (!(fabs(scale[k]) >= 1.0 / WR_PLACE_SCALE))
            return wr_fail(err, "scale=%g,%g: must be 1/%g to %g, or below 0 to mirror", scale[0],
                           scale[1], WR_PLACE_SCALE, WR_PLACE_SCALE);
    return true;
}

/* The piece: bounding box of the selection, or the whole table; and its centre. A whole periodic table is cut as far from
   the fixed point as possible, so that content across its edges stays in one piece. */
static bool set_piece(Moving *m, const WrCall *call, const WrField *like, WrError *err)
{
    const double w = wr_field_width(like), h = wr_field_height(like);
    double *box = m->placing.window;
    WrSelectBox selected = { 0, 0, (int)w, (int)h };
    if (m->selection && !wr_select_box(m->selection, &selected))
        return wr_fail(err, "the selection contains nothing to move");
    box[0] = selected.i;
    box[1] = selected.j;
    box[2] = selected.count_i;
    box[3] = selected.count_j;
    m->placing.from[0] = box[0] + 0.5 * box[2];
    m->placing.from[1] = box[1] + 0.5 * box[3];
    if (!wr_call_given(call, "about")) return true;
    const double *about = wr_call_arg(call, "about")->numbers;
    m->placing.from[0] = about[0] * w;
    m->placing.from[1] = (1.0 - about[1]) * h;
    const WrWrap wraps[] = { wr_field_wrap_u(like), wr_field_wrap_v(like) };
    for (int k = 0; k < 2 && !m->selection; k++)
        if (wraps[k] == WR_WRAP_PERIODIC) box[k] = rint(m->placing.from[k] - 0.5 * box[k + 2]);
    return true;
}

static bool set_up(Moving *m, const WrCall *call, const WrDocument *document, WrPool *pool,
                   const WrField *like, const WrProgress *progress, WrError *err)
{
    const double *move = wr_call_arg(call, "move")->numbers;
    const double *scale = wr_call_arg(call, "scale")->numbers;
    *m = (Moving){ .selection = document->selection,
                   .blend = blends[wr_call_choice(call, "blend")],
                   .leave = wr_call_choice(call, "leave") == 1,
                   .job = { .like = like, .pool = pool, .progress = progress } };
    if (!check_scale(scale, err) || !set_piece(m, call, like, err)) return false;
    for (int k = 0; k < 2; k++) {
        /* Tables' rows run down, `move` counts up. */
        m->placing.at[k] = m->placing.from[k] + (k == 0 ? move[0] : -move[1]);
        m->placing.scale[k] = scale[k];
    }
    m->placing.turn_deg = wr_call_number(call, "turn");
    m->placing.filter = (WrPlaceFilter)wr_call_choice(call, "filter");
    return true;
}

/* Move the selection too. */
static bool move_selection(Moving *m, WrDocument *document, WrError *err)
{
    WrRelief piece = { NULL, NULL };
    if (!m->selection) return true;
    if (!place(m, m->selection, m->selection, &piece, err)) return false;
    wr_field_free(document->selection);
    document->selection = wr_field_share(piece.cover);
    wr_relief_fini(&piece);
    return true;
}

/* Layers that a line moves, groups with their members, the lowest first. active: NULL if the line names the layers. */
static bool find_moved(const WrCall *call, const WrDocument *document, const WrLayer *active,
                       WrLayerList *out, WrError *err)
{
    bool moved[WR_LAYERS_MAX] = { false };
    const bool of = wr_call_given(call, "of"), all = wr_call_choice(call, "layers") == 1;
    WrLayerList listed = { .index = { document->active }, .count = 1 };
    if (of && all) return wr_fail(err, "give of= or layers=all, not both");
    if (of && !wr_layers_find(document, wr_call_arg(call, "of")->text, &listed, err)) return false;
    for (int k = 0; k < listed.count; k++) {
        const int last = listed.index[k];
        const bool alone = active && !active->is_group;
        for (int i = alone ? last : wr_layers_first(document->layers, last); i <= last; i++)
            moved[i] = true;
    }
    out->count = 0;
    for (int i = 0; i < document->layer_count; i++)
        if (all || moved[i]) out->index[out->count++] = i;
    return true;
}

bool wr_call_transform(const WrCall *call, WrDocument *document, WrLayer *active, WrPool *pool,
                       const WrProgress *progress, WrError *err)
{
    Moving moving;
    WrLayerList list;
    WrLayer *layers[WR_LAYERS_MAX];
    if (!find_moved(call, document, active, &list, err)) return false;
    /* the layers' tables are replaced meanwhile */
    WrField *like = wr_field_share(document->layers[0].heights);
    bool good = set_up(&moving, call, document, pool, like, progress, err);
    moving.tables = moving.selection != NULL;
    for (int k = 0; k < list.count; k++) {
        const int i = list.index[k];
        layers[k] = active && i == document->active ? active : &document->layers[i];
        moving.tables += tables_of(&moving, layers[k]);
    }
    for (int k = 0; good && k < list.count; k++) good = move_layer(&moving, layers[k], err);
    good = good && move_selection(&moving, document, err);
    wr_field_free(like);
    return good;
}

bool wr_call_transforms_one(const WrCall *call)
{
    return wr_call_choice(call, "layers") == 0 && !wr_call_given(call, "of");
}

static bool run_transform(WrSession *session, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    WrLayer *active = &document->layers[document->active];
    WrLayerList list;
    if (!wr_call_transforms_one(call)) active = NULL;
    else if (!active->is_group || active->on_mask) active = wr_session_layer(session, err);
    if (!active && wr_call_transforms_one(call)) return false;
    if (!find_moved(call, document, active, &list, err)) return false;
    for (int k = 0; k < list.count; k++)
        if (!wr_session_check_unlocked(session, list.index[k], err)) return false;
    return wr_call_transform(call, document, active, session->options.pool, wr_progress_here(),
                             err);
}

/* ---- the row ---- */

static const char *const layer_choices[] = { "active", "all", NULL };

static const WrArgSpec args_transform[] = {
    { .name = "move",
      .type = WR_ARG_TUPLE,
      .components = 2,
      .shape = "du,dv",
      .low = -4 * WR_FIELD_MAX,
      .high = 4 * WR_FIELD_MAX,
      .fallback = NUMBERS(0, 0),
      .unit = "texels",
      .help = "offset to the right and up" },
    WR_TRANSFORM_ARGS("rotation, anticlockwise"),
    { .name = "about",
      .type = WR_ARG_TUPLE,
      .components = 2,
      .shape = "u,v",
      .low = -WR_SELECT_REACH,
      .high = WR_SELECT_REACH,
      .help = "pivot of turn and scale; left out, the centre of the selection" },
    { .name = "blend",
      .type = WR_ARG_CHOICE,
      .choice = blend_name,
      .fallback_text = "replace",
      .help = "how it is combined with the heights at its new place" },
    { .name = "leave",
      .type = WR_ARG_CHOICE,
      .words = wr_off_on,
      .fallback_text = "off",
      .help = "on: a copy of the selected or the layer's content moves, and the original stays" },
    { .name = "filter",
      .type = WR_ARG_CHOICE,
      .words = wr_place_filters,
      .fallback_text = "catmull",
      .help = "interpolation between texels" },
    { .name = "layers",
      .type = WR_ARG_CHOICE,
      .words = layer_choices,
      .fallback_text = "active",
      .help = "layers that move" },
    { .name = "of",
      .type = WR_ARG_LAYER,
      .several = true,
      .help = "layers to move in place of the active one" },
    { 0 }
};

const WrCommand wr_command_transform = {
    .name = "transform",
    .kind = WR_CLASS_EDIT,
    .args = args_transform,
    .run = run_transform,
    .help = "move, rotate, scale and mirror the selection or a whole layer",
    .details =
        "Content wraps around periodic edges, and the selection moves with it. Without a selection "
        "the whole layer moves, with its mask. Moves by whole texels, quarter turns and mirrors "
        "keep every height unchanged; quarter turns are aligned to whole texels.",
    .example = "transform move=40,0 turn=30"
};
