/* Generator layers: layers that keep the command line that generates them. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/commands.h"
#include "command/session_internal.h"
#include "document/blend.h"
#include "document/document.h"
#include "document/layer_times.h"
#include "field/field.h"
#include "generate/generator.h"
#include "system/clock.h"
#include "system/path.h"

#include <stdlib.h>
#include <string.h>

/* The layer's heights and coverage are those of the line, so that composites, exports and other programs need to know
   nothing of lines. The line's own blend mode and radius become the layer's: the composite then has the bits of the
   plain command run on the layers below. */

static const WrHash nothing; /* WrLayer.below of a line that reads no heights */

/* ---- the line's settings that belong to the layer ---- */

/* The value of a choice argument as a blend mode; -1: the form has no such argument. */
static int blend_of(const WrCall *call, const char *name)
{
    for (int i = 0; i < call->count; i++)
        if (strcmp(call->specs[i].name, name) == 0 && call->args[i].choice >= 0)
            return wr_blend_find(wr_arg_word(&call->specs[i], call->args[i].choice));
    return -1;
}

static void clear(WrCall *call, const char *name)
{
    for (int i = 0; i < call->count; i++)
        if (strcmp(call->specs[i].name, name) == 0) call->args[i].given = false;
}

static const char *own_name(const WrCall *call, const char *plain)
{
    const WrGenerator *generator = wr_call_generator(call);
    return generator ? wr_generator_argument(generator, plain) : plain;
}

/* Copy blend= and radius= of the line to the layer. all: defaults too, as for a new layer. */
static void take_blend(const WrCall *call, bool all, WrLayer *layer)
{
    const char *name = own_name(call, "blend");
    const int blend = blend_of(call, name);
    if (blend >= 0 && (all || wr_call_gives(call, name)))
        /* the plain command mixes by its coverage, a layer of mode mix does not */
        layer->blend = blend == WR_BLEND_MIX ? WR_BLEND_REPLACE : (WrBlend)blend;
    if (!wr_call_generator(call)) return;
    name = own_name(call, "radius");
    if (all || wr_call_given(call, name)) layer->radius = (float)wr_call_number(call, name);
}

void wr_call_begin_layer(const WrCall *call, const WrField *selection, WrLayer *layer)
{
    const WrFamily *family = wr_family_find(call->command->name);
    if (selection && !(family && family->beyond)) layer->mask = wr_field_share(selection);
    take_blend(call, true, layer);
}

/* File names become absolute: the line is run again later, from any folder. */
static void name_files(WrCall *call, void *ctx)
{
    WrSession *session = ctx;
    for (int i = 0; i < call->count; i++) {
        if (call->specs[i].type != WR_ARG_PATH || !wr_call_names_file(call, i)) continue;
        char *path = wr_session_input_path(session, call->args[i].text);
        char *full = wr_path_real(path);
        wr_call_set_text(call, call->specs[i].name, full ? full : path);
        free(full);
        wr_free(path);
    }
}

/* ---- generating ---- */

/* Commands that paint: on an empty layer, without the selection. */
static bool by_painting(WrSession *session, int index, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    WrField *selection = document->selection;
    const int active = document->active, solo = document->solo;
    const WrLayer kept = document->layers[index];
    document->layers[index] = wr_layer_make(kept.name, kept.heights);
    document->selection = NULL;
    document->active = index;
    document->solo = -1;
    const bool good = call->command->run(session, call, err);
    WrLayer made = document->layers[index];
    document->layers[index] = kept;
    document->selection = selection;
    document->active = active;
    document->solo = solo;
    if (good) {
        WrLayer *layer = &document->layers[index];
        WrField *heights = layer->heights, *cover = layer->cover;
        layer->heights = made.heights;
        layer->cover = made.cover;
        made.heights = heights;
        made.cover = cover;
    }
    wr_layer_fini(&made);
    return good;
}

static bool by_generator(WrSession *session, int index, WrCall *call, const WrField *below,
                         WrError *err)
{
    WrLayer *layer = &session->state.document->layers[index];
    WrProgressPart making, laying;
    WrGenerateJob job = { .like = below ? below : layer->heights,
                          .mask = layer->mask,
                          .progress = wr_progress_part(&making, wr_progress_here(), 0.0, 0.9) };
    WrRelief relief = { NULL, NULL };
    const bool good = wr_call_make(session, call, &job, &relief, err) &&
                      wr_call_lay(call, &relief, layer, session->options.pool,
                                  wr_progress_part(&laying, wr_progress_here(), 0.9, 1.0), err);
    wr_relief_fini(&relief);
    return good;
}

static bool reads(const WrCall *call)
{
    const WrGenerator *generator = wr_call_generator(call);
    return generator && generator->reads;
}

/* Generate the content of layer `index` by a call, whose canonical line becomes the layer's. On failure the layer is
   unchanged. outer: the call whose from= this is; it gets the line with absolute file names and checksums; or NULL */
static bool generate(WrSession *session, int index, WrCall *call, WrCall *outer, WrError *err)
{
    const double began = wr_clock_seconds();
    WrField *below = NULL;
    WrHash hash = nothing;
    if (reads(call)) {
        below = wr_document_below(session->state.document, index, session->options.pool);
        hash = wr_field_hash(below);
    }
    const bool good = wr_call_generator(call) ? by_generator(session, index, call, below, err)
                                              : by_painting(session, index, call, err);
    wr_field_free(below);
    if (!good) return false;
    WrText line = { 0 };
    if (outer) {
        wr_call_print(call, &line);
        wr_call_set_text(outer, "from", wr_text_get(&line));
        wr_text_clear(&line);
    }
    clear(call, own_name(call, "blend"));
    if (wr_call_generator(call)) clear(call, own_name(call, "radius"));
    wr_call_print(call, &line);
    WrLayer *layer = &session->state.document->layers[index];
    wr_layer_set_line(layer, wr_text_get(&line), hash);
    wr_layer_time_note(layer->made, wr_clock_seconds() - began, 0);
    wr_text_fini(&line);
    return true;
}

bool wr_session_add_generator_layer(WrSession *session, WrCall *outer, int index, WrLayer layer,
                                    WrError *err)
{
    WrDocument *document = session->state.document;
    WrCall *call = wr_call_inner(outer);
    wr_call_begin_layer(call, document->selection, &layer);
    wr_document_insert(document, index, layer);
    bool good = wr_session_take_tiles(session, call, err);
    if (good) {
        name_files(call, session);
        good = generate(session, index, call, outer, err);
    }
    wr_call_free(call);
    return good;
}

/* The call of the layer's line; NULL and an error if this program does not know it. */
static WrCall *call_of(const WrSession *session, int index, WrError *err)
{
    const WrLayer *layer = &session->state.document->layers[index];
    WrText name = { 0 };
    WrError why = { "" };
    WrCall *call = NULL;
    wr_session_layer_name(session, index, &name);
    if (!layer->line)
        wr_fail(err, "%s is no generator layer: `layer add NAME from=` makes one",
                wr_text_get(&name));
    else if (!wr_check_layer_line(NULL, "from", layer->line, &why) ||
             !wr_call_parse(layer->line, false, &call, &why))
        wr_fail(err, "%s: its line is not known here (%s): its heights stay", wr_text_get(&name),
                wr_error_message(&why));
    wr_text_fini(&name);
    return call;
}

bool wr_session_change_generator_layer(WrSession *session, WrCall *outer, int index,
                                       const char *change, WrError *err)
{
    WrLayer *layer = &session->state.document->layers[index];
    WrCall *call = call_of(session, index, err), *other = wr_call_inner(outer);
    const bool replaces = other;
    if (!call && !(other && layer->line)) { /* an unknown line can be replaced */
        wr_call_free(other);
        return false;
    }
    if (other) {
        wr_call_free(call);
        call = other;
    }
    bool good =
        (!change || wr_call_change(call, change, err)) && wr_session_take_tiles(session, call, err);
    if (good) {
        name_files(call, session);
        take_blend(call, false, layer);
        good = generate(session, index, call, replaces ? outer : NULL, err);
    }
    wr_call_free(call);
    return good;
}

bool wr_session_generate_again(WrSession *session, int index, WrError *err)
{
    WrCall *call = call_of(session, index, err);
    const bool good = call && generate(session, index, call, NULL, err);
    wr_call_free(call);
    return good;
}

/* ---- after each command ---- */

/* True if the layers below have changed since the line read them. */
static bool is_stale(const WrSession *session, int index, const WrBelowKey *key)
{
    const WrDocument *document = session->state.document;
    const WrLayer *layer = &document->layers[index];
    if (wr_hash_equal(layer->below, nothing) || layer->seen == (key->shown.low | 1)) return false;
    WrField *below = wr_document_below(document, index, session->options.pool);
    const bool stale = !wr_hash_equal(wr_field_hash(below), layer->below);
    wr_field_free(below);
    return stale;
}

bool wr_session_follow_line(WrSession *session, int index, const WrBelowKey *key, WrError *err)
{
    WrLayer *layer = &session->state.document->layers[index];
    if (!layer->line) return true;
    if (wr_field_key(layer->heights) == layer->made) {
        if (!key) return true;
        if (is_stale(session, index, key) && !wr_session_generate_again(session, index, err))
            return false;
        layer->seen = key->shown.low | 1;
        return true;
    }
    WrText name = { 0 }; /* another command wrote its heights */
    wr_session_note(session, "%s is a plain layer now: its heights are no longer its line's",
                    wr_session_layer_name(session, index, &name));
    wr_text_fini(&name);
    wr_layer_set_line(layer, NULL, nothing);
    return true;
}

void wr_session_note_lines(WrSession *session)
{
    const WrDocument *document = session->state.document;
    for (int i = 0; i < document->layer_count; i++) {
        WrError why = { "" };
        WrCall *call = document->layers[i].line ? call_of(session, i, &why) : NULL;
        if (document->layers[i].line && !call)
            wr_session_note(session, "%s", wr_error_message(&why));
        wr_call_free(call);
        wr_session_note_mask(session, i);
    }
}
