/* Set-up of painting: brush and target layer of a line. */
#include "command/brush_args.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "brush/preset.h"
#include "brush/tip.h"
#include "document/blend.h"
#include "document/document.h"
#include "field/field.h"

#include <string.h>

bool wr_call_gives(const WrCall *call, const char *name)
{
    for (int i = 0; i < call->count; i++)
        if (strcmp(call->specs[i].name, name) == 0) return call->args[i].given;
    return false;
}

/* ---- the brush ---- */

static void take_number(const WrCall *call, const char *name, double *value)
{
    if (wr_call_gives(call, name)) *value = wr_call_number(call, name);
}

static void take_switch(const WrCall *call, const char *name, bool *value)
{
    if (wr_call_gives(call, name)) *value = wr_call_choice(call, name) == 1;
}

static void take_values(const WrCall *call, WrBrush *brush)
{
    take_number(call, "radius", &brush->radius);
    take_number(call, "hardness", &brush->hardness);
    take_number(call, "strength", &brush->strength);
    take_number(call, "to", &brush->to);
    take_number(call, "opacity", &brush->opacity);
    take_number(call, "flow", &brush->flow);
    take_number(call, "spacing", &brush->spacing);
    take_number(call, "reach", &brush->reach);
    take_number(call, "angle", &brush->angle_deg);
    take_number(call, "aspect", &brush->aspect);
    take_switch(call, "buildup", &brush->buildup);
    take_switch(call, "follow", &brush->follow);
    if (wr_call_gives(call, "mode")) brush->mode = (WrBrushMode)wr_call_choice(call, "mode");
    if (wr_call_gives(call, "pressure"))
        brush->pressure = (WrBrushPressure)wr_call_choice(call, "pressure");
    if (wr_call_gives(call, "seed")) brush->seed = (uint64_t)wr_call_number(call, "seed");
    if (wr_call_gives(call, "source")) {
        const double *source = wr_call_arg(call, "source")->numbers;
        brush->source_u = source[0];
        brush->source_v = source[1];
    }
    if (wr_call_gives(call, "jitter")) {
        const double *jitter = wr_call_arg(call, "jitter")->numbers;
        brush->jitter_place = jitter[0];
        brush->jitter_angle_deg = jitter[1];
        brush->jitter_size = jitter[2];
    }
}

static bool take_symmetry(const WrCall *call, WrSymmetry *out, WrError *err)
{
    const double *centre = wr_call_arg(call, "centre")->numbers;
    const double *repeat = wr_call_arg(call, "repeat")->numbers;
    int mirror = wr_call_choice(call, "mirror"); /* choices: none, u, v, uv */
    WrSymmetry symmetry = { .mirror_u = mirror & 1,
                            .mirror_v = mirror & 2,
                            .radial = (int)wr_call_number(call, "radial"),
                            .centre_u = centre[0],
                            .centre_v = centre[1],
                            .repeat_u = (int)repeat[0],
                            .repeat_v = (int)repeat[1],
                            .stagger = wr_call_number(call, "stagger") };
    if (!wr_symmetry_check(&symmetry, err)) return false;
    *out = symmetry;
    return true;
}

static bool check_needs(const WrCall *call, const char *name, const char *needed, WrError *err)
{
    if (!wr_call_gives(call, name) || wr_call_gives(call, needed)) return true;
    return wr_fail(err, "%s= is given without %s=, which it belongs to", name, needed);
}

static bool take_preset(WrSession *session, WrCall *call, WrHeldBrush *held, WrError *err)
{
    if (!check_needs(call, "preset_sha256", "preset", err) ||
        !check_needs(call, "set", "preset", err))
        return false;
    if (!wr_call_gives(call, "preset")) return true;
    WrBrushFile file;
    if (!wr_session_preset_file(session, wr_call_arg(call, "preset")->text, session->folder, &file,
                                err) ||
        !wr_call_check_sha256(call, "preset_sha256", file.path, file.sha256, err))
        return false;
    wr_session_note_input(session, file.path);
    if (file.tip_path) wr_session_note_input(session, file.tip_path);
    held->preset = wr_call_gives(call, "set")
                       ? wr_preset_with(file.preset, wr_call_arg(call, "set")->text, err)
                       : wr_preset_share(file.preset);
    if (!held->preset) return false;
    held->brush = wr_preset_brush(held->preset);
    return true;
}

/* Use a tip; its own spacing is the default. */
static bool take_tip(WrSession *session, WrCall *call, WrHeldBrush *held, WrError *err)
{
    if (!check_needs(call, "tip_sha256", "tip", err)) return false;
    if (!wr_call_gives(call, "tip")) return true;
    WrBrushFile file;
    if (!wr_session_tip_file(session, wr_call_arg(call, "tip")->text, session->folder, &file,
                             err) ||
        !wr_call_check_sha256(call, "tip_sha256", file.path, file.sha256, err))
        return false;
    wr_session_note_input(session, file.path);
    held->tip = wr_tip_share(file.tip);
    held->brush.tip = held->tip;
    if (!wr_call_gives(call, "spacing") && wr_tip_spacing(held->tip) > 0.0)
        held->brush.spacing = wr_tip_spacing(held->tip);
    return true;
}

static void held_fini(WrHeldBrush *held)
{
    wr_preset_free(held->preset);
    wr_tip_free(held->tip);
    *held = (WrHeldBrush){ 0 };
}

/* A flood fill has no brush shape: no preset, tip or symmetry. */
static bool has_shape(const WrCall *call)
{
    return call->command->more == wr_args_brush;
}

static bool hold_brush(WrSession *session, WrCall *call, WrHeldBrush *out, WrError *err)
{
    WrHeldBrush held = { .brush = wr_brush_default() };
    bool good = !has_shape(call) ||
                (take_preset(session, call, &held, err) && take_tip(session, call, &held, err) &&
                 take_symmetry(call, &held.brush.symmetry, err));
    if (good) take_values(call, &held.brush);
    if (good && held.brush.mode == WR_BRUSH_CLONE && !wr_call_gives(call, "source"))
        good = wr_fail(err, "mode=clone needs source=du,dv: where its heights come from");
    if (good) *out = held;
    else held_fini(&held);
    return good;
}

bool wr_check_settings(const void *ctx, const char *name, const char *value, WrError *err)
{
    (void)ctx;
    if (wr_preset_settings_check(value, err)) return true;
    wr_error_prefix(err, "%s: ", name);
    return false;
}

/* ---- target ---- */

/* Effect of erasing on a layer, by its blend mode:
 *   add, subtract   height 0, which changes nothing below
 *   mix             the composite of the layers below, computed once
 *   others          coverage falls; the heights stay, since changing them would alter the partly covered rest.
 *                   Where coverage reaches 0 they become 0, as in a new layer (wr_painting_end)
 * The bottom layer has nothing below it: without coverage its heights go to 0. */
static void prepare_erasing(WrSession *session, WrLayer *layer, WrPainting *painting)
{
    const WrDocument *document = session->state.document;
    bool covers = wr_blends[layer->blend].uses_cover;
    if (layer->blend == WR_BLEND_MIX) {
        painting->below = wr_document_below(document, document->active, session->options.pool);
    } else if (covers && (layer->cover || document->active > 0)) {
        const WrField *like = layer->heights;
        if (!layer->cover)
            layer->cover = wr_field_new(wr_field_width(like), wr_field_height(like),
                                        wr_field_wrap_u(like), wr_field_wrap_v(like), 1.0f, NULL);
        painting->cover_before = wr_field_share(layer->cover);
        painting->below = wr_field_share(layer->heights);
    }
}

bool wr_painting_begin(WrSession *session, WrCall *call, WrPainting *painting, WrError *err)
{
    WrPainting made = { 0 };
    WrLayer *layer = wr_session_layer(session, err);
    if (!layer || !hold_brush(session, call, &made.held, err)) return false;
    wr_filters_forget();
    if (made.held.brush.mode == WR_BRUSH_ERASE) prepare_erasing(session, layer, &made);
    if (!wr_filters_carried(err)) { /* of the layers below */
        wr_field_free(made.below);
        held_fini(&made.held);
        return false;
    }
    made.ground = (WrBrushGround){ .field = layer->heights,
                                   .mark = layer->cover,
                                   .selection = session->state.document->selection,
                                   .below = made.below,
                                   .pool = session->options.pool };
    *painting = made;
    return true;
}

/* ---- afterwards ---- */

typedef struct Clearing {
    WrField *heights;
    const WrField *before, *after;
} Clearing;

static void clear_tile(int tx, int ty, void *ctx)
{
    const Clearing *c = ctx;
    const float *before = wr_field_tile(c->before, tx, ty),
                *after = wr_field_tile(c->after, tx, ty);
    const float *old = wr_field_tile(c->heights, tx, ty);
    float before_level = wr_field_level(c->before), after_level = wr_field_level(c->after);
    float level = wr_field_level(c->heights), *heights = NULL;
    int columns = wr_field_width(c->heights) - tx * WR_TILE;
    int rows = wr_field_height(c->heights) - ty * WR_TILE;
    for (int i = 0; i < WR_TILE * WR_TILE; i++) {
        if (i % WR_TILE >= columns || i / WR_TILE >= rows) continue;
        bool went =
            (after ? after[i] : after_level) <= 0.0f && (before ? before[i] : before_level) > 0.0f;
        if (!went || (old ? old[i] : level) == 0.0f) continue;
        if (!heights) old = heights = wr_field_tile_write(c->heights, tx, ty);
        heights[i] = 0.0f;
    }
}

void wr_painting_end(WrSession *session, WrPainting *painting)
{
    (void)session;
    if (painting->cover_before) {
        Clearing clearing = { painting->ground.field, painting->cover_before,
                              painting->ground.mark };
        wr_field_changes(clearing.before, clearing.after, clear_tile, &clearing);
    }
    wr_field_free(painting->cover_before);
    wr_field_free(painting->below);
    held_fini(&painting->held);
    *painting = (WrPainting){ 0 };
}
