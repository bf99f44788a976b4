/* Generator layers, linked copies and live masks after each command: those that the picture needs, and changes below
   them. */
#include "base/error.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/layer_plan.h"
#include "command/linked_copies.h"
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

/* Marks the layers that a layer's line and the terms of its mask name. */
static void mark_named(const WrSession *session, int index, bool *called)
{
    int named[WR_MASK_TERMS];
    const int read = wr_session_line_layer(session, index);
    if (read >= 0) called[read] = true;
    const int count = wr_mask_named(session->state.document, index, named);
    for (int k = 0; k < count; k++) called[named[k]] = true;
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

/* With groups or linked copies every visible layer counts as needed: a member's layers below are not all layers below, and
   copies read layers above too. */
static void needs_of_visible(const WrSession *session, const WrLinks *links,
                             WrLayerNeed needs[WR_LAYERS_MAX])
{
    const WrDocument *document = session->state.document;
    bool called[WR_LAYERS_MAX] = { false };
    for (int i = document->layer_count - 1; i >= 0; i--) {
        const bool needed = called[i] || links->within[i] || is_called(document, i) ||
                            wr_document_is_visible(document, i) || wr_document_shows(document, i);
        needs[i] = (WrLayerNeed){ needed ? WR_LAYER_NEEDED : WR_LAYER_HIDDEN, -1 };
        if (needed) mark_named(session, i, called);
    }
}

static void needs_of_stack(const WrSession *session, WrLayerNeed needs[WR_LAYERS_MAX])
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
        mark_named(session, i, called);
    }
}

void wr_session_layer_needs(const WrSession *session, WrLayerNeed needs[WR_LAYERS_MAX])
{
    WrLinks links;
    wr_session_links(session, &links);
    if (links.any || wr_document_groups(session->state.document))
        needs_of_visible(session, &links, needs);
    else needs_of_stack(session, needs);
}

/* ---- the layers below, as one number ---- */

/* Keys of fields are unique over the life of the process, so one comparison of
   numbers replaces composites and their hashes. */
static void add_key(const WrDocument *document, int index, bool groups, WrBelowKey *key)
{
    const WrLayer *layer = &document->layers[index];
    const int group = wr_document_parent(document, index);
    const uint64_t keys[] = { wr_field_key(layer->heights),
                              layer->cover ? wr_field_key(layer->cover) : 0,
                              layer->mask ? wr_field_key(layer->mask) : 0,
                              (uint64_t)layer->blend << 1 | layer->visible };
    const float numbers[] = { layer->opacity, layer->radius,
                              (float)(2 * layer->depth + layer->is_group),
                              group < 0 ? -1.0f : (float)document->layers[group].blend };
    WrHash hash = wr_hash_bytes(keys, sizeof keys, (WrHash){ 0, 0 });
    hash = wr_hash_bytes(numbers, sizeof numbers, hash);
    if (layer->filter.op) {
        WrText filter = { 0 };
        wr_filter_print(&layer->filter, &filter);
        hash = wr_hash_bytes(wr_text_get(&filter), filter.length, hash);
        wr_text_fini(&filter);
    }
    if (groups || (layer->visible && layer->opacity > 0.0f))
        key->shown = wr_hash_bytes(&hash, sizeof hash, key->shown);
    hash = wr_hash_bytes(layer->name, strlen(layer->name) + 1, hash);
    key->all = wr_hash_bytes(&hash, sizeof hash, key->all);
}

void wr_session_below_key(const WrDocument *document, int index, WrBelowKey *key)
{
    const bool groups = wr_document_groups(document);
    *key = (WrBelowKey){ { 0, 0 }, { 0, 0 } };
    if (groups) { /* the same layers may have come into a group, or out of one */
        const int group = wr_document_parent(document, index);
        const int place[] = { wr_layers_first_sibling(document->layers, index),
                              wr_layers_first(document->layers, index),
                              group < 0 ? -1 : (int)document->layers[group].blend };
        key->shown = key->all = wr_hash_bytes(place, sizeof place, key->all);
    }
    for (int i = 0; i < index; i++) add_key(document, i, groups, key);
}

WrHash wr_session_group_key(const WrDocument *document, int group)
{
    const int blend = (int)document->layers[group].blend;
    WrBelowKey key = { .shown = wr_hash_bytes(&blend, sizeof blend, (WrHash){ 1, 0 }) };
    for (int i = wr_layers_first(document->layers, group); i < group; i++)
        add_key(document, i, true, &key);
    return key.shown;
}

/* ---- after each command ---- */

/* One pass over the layers, from the bottom up; the layers that a layer reads are made before it, even those above. */
typedef struct Following {
    WrSession *session;
    WrLinks links;
    bool needed[WR_LAYERS_MAX];
    bool heights[WR_LAYERS_MAX]; /* done, or being done */
    bool masks[WR_LAYERS_MAX];
} Following;

/* Hidden copies that nothing reads wait until they are shown, as other lines do. */
static bool is_read(const Following *f, int index)
{
    const WrDocument *document = f->session->state.document;
    bool read = f->needed[index] || f->links.within[index] ||
                wr_scene_uses_layer(document->scene, document->layers[index].name);
    for (int i = 0; i < document->layer_count && !read; i++) read = f->links.source[i] == index;
    return read;
}

static bool follow_line(Following *f, int index, WrError *err)
{
    /* cycles of links are refused only among lines that are followed */
    const bool needed =
        f->needed[index] &&
        (!f->links.any || wr_layer_is_followed(f->session->state.document, &f->links, index));
    const bool read = f->links.copies[index] && is_read(f, index);
    return wr_session_follow_line(f->session, &f->links, index, needed, read, err);
}

static bool follow_rows(Following *f, int from, int to, WrError *err);

static bool follow_mask(Following *f, int index, WrError *err)
{
    if (f->masks[index]) return true;
    f->masks[index] = true;
    if (!f->needed[index]) return true;
    const WrDocument *document = f->session->state.document;
    int named[WR_MASK_TERMS];
    const int count = f->links.any ? wr_mask_named(document, index, named) : 0;
    if (document->layers[index].mask_line && f->links.any &&
        !follow_rows(f, wr_layers_first_sibling(document->layers, index), index, err))
        return false;
    for (int i = 0; i < count; i++)
        if (!follow_rows(f, named[i], named[i] + 1, err)) return false;
    return wr_session_follow_mask(f->session, index, err);
}

static bool follow_heights(Following *f, int index, WrError *err)
{
    if (f->heights[index]) return true;
    f->heights[index] = true; /* a cycle ends here; its copies keep their heights */
    const WrReads reads = wr_session_reads(f->session, &f->links, index);
    if (reads.layer >= 0 && !follow_heights(f, reads.layer, err)) return false;
    if (!follow_rows(f, reads.from, reads.to, err)) return false;
    return follow_line(f, index, err);
}

static bool follow_rows(Following *f, int from, int to, WrError *err)
{
    bool good = true;
    for (int i = from; good && i < to; i++)
        good = follow_heights(f, i, err) && follow_mask(f, i, err);
    return good;
}

/* all: layers that the picture does not need are made too */
static bool follow(WrSession *session, bool all, WrError *err)
{
    if (!wr_document_generates(session->state.document)) {
        wr_made_from_free(session->made_from);
        session->made_from = NULL;
        return true;
    }
    Following f = { .session = session };
    WrLayerNeed needs[WR_LAYERS_MAX];
    const int count = session->state.document->layer_count;
    wr_session_layer_needs(session, needs);
    for (int i = 0; i < count; i++) f.needed[i] = all || needs[i].why == WR_LAYER_NEEDED;
    wr_session_links(session, &f.links);
    const bool good = follow_rows(&f, 0, count, err);
    wr_made_from_prune(session->made_from, session->state.document, f.needed);
    return good;
}

bool wr_session_follow_layers(WrSession *session, WrError *err)
{
    return follow(session, false, err);
}

bool wr_session_make_all_layers(WrSession *session, WrError *err)
{
    return follow(session, true, err);
}
