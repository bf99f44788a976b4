/* Flood fills and ramps. */
#include "base/error.h"
#include "base/progress.h"
#include "command/args.h"
#include "command/brush_args.h"
#include "command/commands.h"
#include "document/blend.h"
#include "document/document.h"
#include "field/field.h"
#include "field/ramp.h"
#include "field/select.h"

static bool run_flood(WrSession *session, WrCall *call, WrError *err)
{
    const WrDocument *document = session->state.document;
    const double *at = wr_call_arg(call, "u,v")->numbers;
    WrPainting painting;
    if (!wr_painting_begin(session, call, &painting, err)) return false;
    const WrProgress *progress = wr_progress_here();
    painting.ground.progress = progress;
    WrField *cover =
        wr_select_flood(wr_document_composite(document, session->options.pool), at[0], at[1],
                        wr_call_number(call, "tolerance"), wr_call_choice(call, "diagonal") == 1,
                        session->options.pool, progress, err);
    bool good =
        cover && wr_brush_fill(&painting.ground, &painting.held.brush, cover, at[0], at[1], err);
    wr_field_free(cover);
    wr_painting_end(session, &painting);
    return good;
}

/* ---- ramp ---- */

/* Blend the ramp into the heights. */
static bool join(WrField *heights, const WrField *ramp, WrBlend blend, const WrProgress *progress,
                 WrError *err)
{
    for (int ty = 0; ty < wr_field_tiles_v(heights); ty++) {
        if (wr_progress_cancelled(progress)) return wr_fail(err, "cancelled");
        for (int tx = 0; tx < wr_field_tiles_u(heights); tx++) {
            WrBlendTile tile = { .heights = wr_field_tile(ramp, tx, ty),
                                 .level = wr_field_level(ramp),
                                 .cover_level = 1.0f,
                                 .mask_level = 1.0f };
            float *below = wr_field_tile_write(heights, tx, ty);
            int columns = wr_field_width(heights) - tx * WR_TILE;
            int rows = wr_field_height(heights) - ty * WR_TILE;
            if (columns > WR_TILE) columns = WR_TILE;
            for (int y = 0; y < rows && y < WR_TILE; y++) {
                wr_blend_tile(blend, 1.0f, 0.0f, &tile, (size_t)columns, below + y * WR_TILE);
                if (tile.heights) tile.heights += WR_TILE;
            }
        }
    }
    return true;
}

static bool run_ramp(WrSession *session, WrCall *call, WrError *err)
{
    WrLayer *layer = wr_session_layer(session, err);
    if (!layer) return false;
    const double *from = wr_call_arg(call, "from")->numbers, *to = wr_call_arg(call, "to")->numbers;
    WrRamp ramp = { .kind = (WrRampKind)call->form,
                    .from_u = from[0],
                    .from_v = from[1],
                    .to_u = to[0],
                    .to_v = to[1],
                    .low = wr_call_number(call, "low"),
                    .high = wr_call_number(call, "high"),
                    .fold = wr_call_choice(call, "fold") == 1 };
    const WrProgress *progress = wr_progress_here();
    WrField *made = wr_ramp_make(layer->heights, &ramp, session->options.pool, progress, err);
    if (!made) return false;
    WrBlend blend = wr_ramp_blends[wr_call_choice(call, "blend")];
    if (blend != WR_BLEND_REPLACE) {
        WrField *joined = wr_field_share(layer->heights);
        bool good = join(joined, made, blend, progress, err);
        wr_field_free(made);
        if (!good) {
            wr_field_free(joined);
            return false;
        }
        made = joined;
    }
    wr_session_put_heights(session, layer, made);
    return true;
}

static const char *ramp_blend(int i)
{
    return i >= 0 && i < WR_RAMP_BLENDS ? wr_blends[wr_ramp_blends[i]].name : NULL;
}

/* ---- flood, ramp ---- */

static const WrArgSpec args_flood[] = { WR_ARGS_FLOOD("the composite's heights"),
                                        PAINT_ARGS,
                                        { 0 } };

#define HEIGHT(name_, default_, help_)                                                             \
    {                                                                                              \
        .name = name_, .type = WR_ARG_NUMBER, .low = -WR_BIG_HEIGHT, .high = WR_BIG_HEIGHT,        \
        .fallback = NUMBERS(default_), .help = help_                                               \
    }

#define RAMP_ARGS                                                                                  \
    POINT("from", "where the height is low"), POINT("to", "where it is high"),                     \
        HEIGHT("low", 0, "the height at from"), HEIGHT("high", 1, "the height at to"),             \
        { .name = "fold",                                                                          \
          .type = WR_ARG_CHOICE,                                                                   \
          .words = wr_off_on,                                                                      \
          .fallback_text = "off",                                                                  \
          .help = "on: it leads back down again, so that nothing jumps" },                         \
    {                                                                                              \
        .name = "blend", .type = WR_ARG_CHOICE, .choice = ramp_blend, .fallback_text = "replace",  \
        .help = "how it joins the heights that are there"                                          \
    }

/* In the order of WrRampKind. */
static const WrForm ramp_forms[] = {
    { .name = "linear",
      .help = "along the way; low before from, high after to. On periodic axes it jumps half a "
              "table away from the middle of the way; fold=on leads from to on round the table "
              "back to from instead, along u and v each",
      .args = { RAMP_ARGS } },
    { .name = "radial",
      .help = "by the distance from from, round all edges; high beyond to, or with fold=on a ring "
              "that is low again at twice the distance. Nothing jumps",
      .args = { RAMP_ARGS } },
    { .name = "cone",
      .help =
          "by the angle about from, anticlockwise from the direction of to, where it jumps, as "
          "it does half a table away; fold=on rises for half a turn and falls for the other, and "
          "beyond a quarter of the table mirrors itself, so that nothing jumps",
      .args = { RAMP_ARGS } },
};
_Static_assert(sizeof ramp_forms / sizeof *ramp_forms == WR_RAMP_KINDS, "one a kind");

static bool form_ramp(int i, WrForm *out)
{
    if (i >= WR_RAMP_KINDS) return false;
    *out = ramp_forms[i];
    return true;
}

/* ---- the rows ---- */

const WrCommand wr_command_flood = {
    .name = "flood",
    .kind = WR_CLASS_EDIT,
    .args = args_flood,
    .run = run_flood,
    .help = "fill a connected part of about one height",
    .details = "The part is found in the composite, goes on across periodic edges, and has no "
               "soft edge; "
               "`select flood` selects it instead, to be feathered or grown.",
    .example = "flood 0.5,0.5 tolerance=0.05 mode=to to=1 strength=10"
};

const WrCommand wr_command_ramp = { .name = "ramp",
                                    .kind = WR_CLASS_EDIT,
                                    .form_word = "KIND",
                                    .form = form_ramp,
                                    .run = run_ramp,
                                    .help = "heights that lead from one place to another",
                                    .example = "ramp linear from=0.1,0.5 to=0.6,0.5 fold=on" };
