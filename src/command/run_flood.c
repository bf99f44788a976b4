/* flood, ramp: edits of a whole region at once. */
#include "command/inner.h"

#include "field/ramp.h"
#include "field/select.h"

bool wr_run_flood(WrSession *session, WrCall *call, WrError *err)
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

/* heights = the blend of the ramp onto them. */
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

bool wr_run_ramp(WrSession *session, WrCall *call, WrError *err)
{
    /* In the order of the argument's words. */
    static const WrBlend blends[] = { WR_BLEND_REPLACE, WR_BLEND_ADD, WR_BLEND_MAX, WR_BLEND_MIN };
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
    WrBlend blend = blends[wr_call_choice(call, "blend")];
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
