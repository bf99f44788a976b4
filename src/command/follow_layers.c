/* Generator layers and live masks after each command: which of them the picture needs, and what has changed below them. */
#include "base/error.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/layer_plan.h"
#include "command/live_masks.h"
#include "command/session_internal.h"
#include "document/document.h"
#include "field/field.h"
#include "scene/objects.h"

#include <string.h>

/* ---- which layers are needed ---- */

static const WrHash nothing;

/* True if the layer's content depends on the composite of the layers below it. */
static bool reads_below(const WrLayer *layer)
{
    return layer->filter.op || layer->mask_line || !wr_hash_equal(layer->below, nothing);
}

/* Marks the layers that the terms of a layer's mask name. */
static void mark_named(const WrDocument *document, int index, bool *called)
{
    const char *line = document->layers[index].mask_line;
    WrMaskTerms terms;
    if (!line || !wr_mask_terms_parse(line, &terms, NULL)) return;
    for (int k = 0; k < terms.count; k++) {
        const int found = wr_mask_term_layer(document, index, terms.calls[k]);
        if (found >= 0) called[found] = true;
    }
    wr_mask_terms_free(&terms);
}

/* True if the layer is needed whatever is above it: it is shown alone, an object uses it, or it is edited, by brushes that may
   read the layers below. */
static bool is_called(const WrDocument *document, int index)
{
    if (index == document->solo) return true;
    if (document->solo < 0 && wr_scene_uses_layer(document->scene, document->layers[index].name))
        return true;
    return index == document->active && wr_document_shows(document, index);
}

void wr_session_layer_needs(const WrSession *session, WrLayerNeed needs[WR_LAYERS_MAX])
{
    const WrDocument *document = session->state.document;
    bool called[WR_LAYERS_MAX] = { false };
    WrLayerNeed below = { document->solo < 0 ? WR_LAYER_NEEDED : WR_LAYER_ALONE, document->solo };
    for (int i = document->layer_count - 1; i >= 0; i--) {
        const WrLayer *layer = &document->layers[i];
        const bool edited = i == document->active && wr_document_shows(document, i);
        called[i] |= is_called(document, i);
        needs[i] = below;
        if (called[i]) needs[i] = (WrLayerNeed){ WR_LAYER_NEEDED, -1 };
        else if (!layer->visible) needs[i] = (WrLayerNeed){ WR_LAYER_HIDDEN, -1 };
        else if (!(layer->opacity > 0.0f)) needs[i] = (WrLayerNeed){ WR_LAYER_CLEAR, -1 };
        if (needs[i].why != WR_LAYER_NEEDED) continue;
        if (reads_below(layer) || edited) below = needs[i];
        else if (below.why == WR_LAYER_NEEDED && wr_layer_hides(layer))
            below = (WrLayerNeed){ WR_LAYER_COVERED, i };
        mark_named(document, i, called);
    }
}

/* ---- the layers below, as one number ---- */

/* Keys of fields are unique over the life of the process, so one comparison of
   numbers replaces composites and their hashes. */
void wr_below_key_add(const WrLayer *layer, WrBelowKey *key)
{
    const uint64_t keys[] = { wr_field_key(layer->heights),
                              layer->cover ? wr_field_key(layer->cover) : 0,
                              layer->mask ? wr_field_key(layer->mask) : 0,
                              (uint64_t)layer->blend << 1 | layer->visible };
    const float numbers[] = { layer->opacity, layer->radius };
    WrHash hash = wr_hash_bytes(keys, sizeof keys, (WrHash){ 0, 0 });
    hash = wr_hash_bytes(numbers, sizeof numbers, hash);
    if (layer->filter.op) {
        WrText filter = { 0 };
        wr_filter_print(&layer->filter, &filter);
        hash = wr_hash_bytes(wr_text_get(&filter), filter.length, hash);
        wr_text_fini(&filter);
    }
    if (layer->visible && layer->opacity > 0.0f)
        key->shown = wr_hash_bytes(&hash, sizeof hash, key->shown);
    hash = wr_hash_bytes(layer->name, strlen(layer->name) + 1, hash);
    key->all = wr_hash_bytes(&hash, sizeof hash, key->all);
}

/* ---- after each command ---- */

/* all: layers that the picture does not need are made too */
static bool follow(WrSession *session, bool all, WrError *err)
{
    WrLayerNeed needs[WR_LAYERS_MAX];
    WrBelowKey key = { { 0, 0 }, { 0, 0 } };
    if (!wr_document_generates(session->state.document)) return true;
    wr_session_layer_needs(session, needs);
    for (int i = 0; i < session->state.document->layer_count; i++) {
        const bool needed = all || needs[i].why == WR_LAYER_NEEDED;
        if (!wr_session_follow_line(session, i, needed ? &key : NULL, err) ||
            (needed && !wr_session_follow_mask(session, i, &key, err)))
            return false;
        wr_below_key_add(&session->state.document->layers[i], &key);
    }
    return true;
}

bool wr_session_follow_layers(WrSession *session, WrError *err)
{
    return follow(session, false, err);
}

bool wr_session_make_all_layers(WrSession *session, WrError *err)
{
    return follow(session, true, err);
}
