/* The command transform: move, rotate, scale and mirror the selection or whole layers. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/enum_rows.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/transform.h"
#include "document/blend.h"
#include "document/document.h"
#include "document/edit.h"
#include "field/field.h"
#include "field/select.h"
#include "generate/generator.h"
#include "generate/transform_piece.h"

#include <math.h>

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
static bool join(const Moving *m, WrLayer *layer, const WrRelief *piece, const WrField *cover,
                 WrError *err)
{
    float *rows = wr_try_alloc((size_t)wr_field_width(layer->heights), 5 * sizeof *rows,
                               "rows of what is moved", err);
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

static bool place(Moving *m, const WrField *what, WrRelief *out, WrError *err)
{
    m->placing.heights = what;
    m->placing.weight = m->selection;
    WrGenerateJob job = m->job;
    WrProgressPart part;
    job.progress = wr_progress_part(&part, m->job.progress, (double)m->done / m->tables,
                                    (m->done + 1.0) / m->tables);
    m->done++;
    return wr_place(&m->placing, &job, out, err);
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
    if (!place(m, layer->mask, &piece, err)) return false;
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
    const bool holds = !layer->filter.op;
    return holds + (holds && layer->cover) + (layer->mask && !m->selection && !m->leave);
}

static bool move_layer(Moving *m, WrLayer *layer, WrError *err)
{
    WrRelief piece = { NULL, NULL }, cover = { NULL, NULL };
    if (layer->filter.op) return move_mask(m, layer, err);
    bool good = place(m, layer->heights, &piece, err) &&
                (!layer->cover || place(m, layer->cover, &cover, err));
    if (good && !m->leave) {
        take_out(m, &layer->heights);
        if (layer->cover) take_out(m, &layer->cover);
    }
    good = good && join(m, layer, &piece, cover.heights, err) && move_mask(m, layer, err);
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

/* The piece: bounding box of the selection, or the whole table; and its centre. */
static bool set_piece(Moving *m, const WrCall *call, const WrField *like, WrError *err)
{
    const double w = wr_field_width(like), h = wr_field_height(like);
    double *box = m->placing.window;
    WrSelectBox selected = { 0, 0, (int)w, (int)h };
    if (m->selection && !wr_select_box(m->selection, &selected))
        return wr_fail(err, "nothing is inside the selection that could be moved");
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
    if (!place(m, m->selection, &piece, err)) return false;
    wr_field_free(document->selection);
    document->selection = wr_field_share(piece.cover);
    wr_relief_fini(&piece);
    return true;
}

bool wr_call_transform(const WrCall *call, WrDocument *document, WrLayer *active, WrPool *pool,
                       const WrProgress *progress, WrError *err)
{
    Moving moving;
    /* the layers' tables are replaced meanwhile */
    WrField *like = wr_field_share(document->layers[0].heights);
    bool good = set_up(&moving, call, document, pool, like, progress, err);
    moving.tables = moving.selection != NULL;
    for (int i = 0; i < document->layer_count; i++)
        if (!active || i == document->active)
            moving.tables += tables_of(&moving, active ? active : &document->layers[i]);
    for (int i = 0; good && i < document->layer_count; i++)
        if (!active || i == document->active)
            good = move_layer(&moving, active ? active : &document->layers[i], err);
    good = good && move_selection(&moving, document, err);
    wr_field_free(like);
    return good;
}

static bool run_transform(WrSession *session, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    WrLayer *active = NULL;
    if (wr_call_choice(call, "layers") == 0) {
        active = wr_session_layer(session, err);
        if (!active) return false;
    }
    for (int i = 0; !active && i < document->layer_count; i++)
        if (!wr_session_check_unlocked(session, i, err)) return false;
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
      .help = "to the right and up" },
    { .name = "turn",
      .type = WR_ARG_NUMBER,
      .low = -36000,
      .high = 36000,
      .fallback = NUMBERS(0),
      .unit = "degrees",
      .help = "anticlockwise" },
    { .name = "scale",
      .type = WR_ARG_TUPLE,
      .components = 2,
      .shape = "su,sv",
      .low = -WR_PLACE_SCALE,
      .high = WR_PLACE_SCALE,
      .fallback = NUMBERS(1, 1),
      .help = "how much larger along u and v, before it is turned; below 0 mirrors" },
    { .name = "about",
      .type = WR_ARG_TUPLE,
      .components = 2,
      .shape = "u,v",
      .low = -WR_SELECT_REACH,
      .high = WR_SELECT_REACH,
      .help = "the point that only moves; left out, the middle of what is selected" },
    { .name = "blend",
      .type = WR_ARG_CHOICE,
      .choice = blend_name,
      .fallback_text = "replace",
      .help = "how it joins what lies where it comes" },
    { .name = "leave",
      .type = WR_ARG_CHOICE,
      .words = wr_off_on,
      .fallback_text = "off",
      .help = "on: what is selected stays, and a copy of it goes" },
    { .name = "filter",
      .type = WR_ARG_CHOICE,
      .words = wr_place_filters,
      .fallback_text = "catmull",
      .help = "how heights are read between texels" },
    { .name = "layers",
      .type = WR_ARG_CHOICE,
      .words = layer_choices,
      .fallback_text = "active",
      .help = "which layers it moves" },
    { 0 }
};

const WrCommand wr_command_transform = {
    .name = "transform",
    .kind = WR_CLASS_EDIT,
    .args = args_transform,
    .run = run_transform,
    .help = "move, turn, scale and mirror what is selected, or a whole layer",
    .details = "Everything goes round periodic edges, and the selection goes along. Without a "
               "selection the "
               "whole layer moves, with its mask. Moves by whole texels, quarter turns and mirrors "
               "keep every "
               "height as it is; quarter turns come to lie on whole texels.",
    .example = "transform move=40,0 turn=30"
};
