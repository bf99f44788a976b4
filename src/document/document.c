#include "document/document.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "document/composite.h"
#include "field/field.h"
#include "scene/scene.h"

#include <string.h>

#define NEW_SIZE 512 /* texels along a side of an empty document */

/* ---- layers ---- */

static WrField *share_or_null(const WrField *field)
{
    return field ? wr_field_share(field) : NULL;
}

static WrLayer layer_of(const char *name, WrField *heights)
{
    return (
        WrLayer){ .name = wr_strdup(name), .heights = heights, .opacity = 1.0f, .visible = true };
}

static WrField *empty_like(const WrField *field, float level)
{
    return wr_field_new(wr_field_width(field), wr_field_height(field), wr_field_wrap_u(field),
                        wr_field_wrap_v(field), level, NULL);
}

WrLayer wr_layer_new(const char *name, const WrField *like)
{
    WrLayer layer = layer_of(name, empty_like(like, 0.0f));
    layer.cover = empty_like(like, 0.0f);
    return layer;
}

WrLayer wr_layer_of_filter(const char *name, const WrFilter *filter, const WrField *like)
{
    WrLayer layer = layer_of(name, empty_like(like, 0.0f));
    layer.blend = WR_BLEND_MIX;
    layer.filter = *filter;
    return layer;
}

WrLayer wr_layer_share(const WrLayer *layer)
{
    WrLayer copy = *layer;
    copy.name = wr_strdup(layer->name);
    copy.heights = wr_field_share(layer->heights);
    copy.cover = share_or_null(layer->cover);
    copy.mask = share_or_null(layer->mask);
    return copy;
}

void wr_layer_fini(WrLayer *layer)
{
    wr_free(layer->name);
    wr_field_free(layer->heights);
    wr_field_free(layer->cover);
    wr_field_free(layer->mask);
    *layer = (WrLayer){ 0 };
}

WrLayer *wr_document_edit_begin(WrDocument *document, WrStandIn *stand_in)
{
    WrLayer *layer = &document->layers[document->active];
    if (!layer->on_mask) return layer;
    if (stand_in->layer.heights) return &stand_in->layer;
    *stand_in = (WrStandIn){
        .layer = { .name = layer->name, .heights = layer->mask, .opacity = 1.0f, .visible = true },
        .before = wr_field_share(layer->mask),
        .index = document->active
    };
    return &stand_in->layer;
}

/* Texels beyond the table's edge have the level, which is already in 0..1. */
static void keep_to_unit(int tx, int ty, void *ctx)
{
    WrField *mask = ctx;
    const float *old = wr_field_tile(mask, tx, ty);
    float *tile = NULL;
    for (int i = 0; old && i < WR_TILE * WR_TILE; i++) {
        if (old[i] >= 0.0f && old[i] <= 1.0f) continue;
        if (!tile) old = tile = wr_field_tile_write(mask, tx, ty);
        tile[i] = old[i] > 1.0f ? 1.0f : 0.0f;
    }
}

static WrField *with_unit_level(WrField *mask)
{
    float level = wr_field_level(mask);
    if (level >= 0.0f && level <= 1.0f) return mask;
    WrField *kept = empty_like(mask, level > 1.0f ? 1.0f : 0.0f);
    for (int ty = 0; ty < wr_field_tiles_v(mask); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(mask); tx++)
            if (wr_field_tile(mask, tx, ty)) wr_field_tile_share(kept, mask, tx, ty);
    wr_field_free(mask);
    return kept;
}

void wr_document_edit_end(WrDocument *document, WrStandIn *stand_in)
{
    if (!stand_in->layer.heights) return;
    WrField *mask = with_unit_level(stand_in->layer.heights);
    wr_field_changes(stand_in->before, mask, keep_to_unit, mask);
    document->layers[stand_in->index].mask = mask;
    wr_field_free(stand_in->before);
    *stand_in = (WrStandIn){ .index = 0 };
}

bool wr_document_filters(const WrDocument *document)
{
    bool any = false;
    for (int i = 0; i < document->layer_count; i++) any |= document->layers[i].filter.op != NULL;
    return any;
}

bool wr_document_shows(const WrDocument *document, int index)
{
    if (document->solo >= 0) return document->solo == index;
    return document->layers[index].visible;
}

/* ---- documents ---- */

WrDocument *wr_document_new(void)
{
    WrDocument *document = wr_alloc(1, sizeof *document);
    document->layers = wr_alloc(1, sizeof *document->layers);
    document->layer_count = 1;
    document->layers[0] = layer_of(
        "base", wr_field_new(NEW_SIZE, NEW_SIZE, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL));
    document->solo = -1;
    document->scene = wr_scene_new();
    document->composite = wr_composite_new();
    return document;
}

static WrDocument *share_with(const WrDocument *document, WrComposite *composite)
{
    WrDocument *copy = wr_alloc(1, sizeof *copy);
    int count = document->layer_count;
    *copy = *document;
    copy->layers = wr_alloc((size_t)count, sizeof *copy->layers);
    for (int i = 0; i < count; i++) copy->layers[i] = wr_layer_share(&document->layers[i]);
    copy->selection = share_or_null(document->selection);
    copy->scene = wr_scene_share(document->scene);
    copy->composite = composite;
    return copy;
}

WrDocument *wr_document_share(const WrDocument *document)
{
    return share_with(document, wr_composite_share(document->composite));
}

WrDocument *wr_document_snapshot(const WrDocument *document)
{
    return share_with(document, wr_composite_new());
}

void wr_document_swap_composites(WrDocument *document, WrDocument *from)
{
    WrComposite *other = document->composite;
    document->composite = from->composite;
    from->composite = other;
}

static void drop_layers(WrDocument *document)
{
    for (int i = 0; i < document->layer_count; i++) wr_layer_fini(&document->layers[i]);
    wr_free(document->layers);
    document->layers = NULL;
    document->layer_count = 0;
}

void wr_document_free(WrDocument *document)
{
    if (!document) return;
    drop_layers(document);
    wr_field_free(document->selection);
    wr_scene_free(document->scene);
    wr_composite_free(document->composite);
    wr_free(document);
}

/* For the lowest layer, add is equivalent to mix (compositor.h). */
static bool is_plain(const WrDocument *document)
{
    const WrLayer *layer = &document->layers[0];
    const WrBlendMode *mode = &wr_blends[layer->blend];
    return document->layer_count == 1 && wr_document_shows(document, 0) && layer->opacity == 1.0f &&
           !layer->mask && !layer->filter.op &&
           (layer->blend == WR_BLEND_ADD || (mode->takes && !(mode->uses_cover && layer->cover)));
}

const WrField *wr_document_composite(const WrDocument *document, WrPool *pool)
{
    if (is_plain(document)) return document->layers[0].heights;
    return wr_composite_update(document->composite, document->layers, document->layer_count,
                               document->solo, pool);
}

const WrField *wr_document_field(const WrDocument *document)
{
    return wr_document_composite(document, NULL);
}

const WrField *wr_document_whole(const WrDocument *document, WrPool *pool, WrError *err)
{
    wr_filters_forget();
    const WrField *field = wr_document_composite(document, pool);
    return wr_filters_carried(err) ? field : NULL;
}

/* ---- the order of layers ---- */

void wr_document_insert(WrDocument *document, int index, WrLayer layer)
{
    int count = document->layer_count;
    WR_ASSERT(index >= 0 && index <= count && count < WR_LAYERS_MAX);
    document->layers =
        wr_realloc(document->layers, (size_t)count, (size_t)count + 1, sizeof *document->layers);
    memmove(document->layers + index + 1, document->layers + index,
            (size_t)(count - index) * sizeof *document->layers);
    document->layers[index] = layer;
    document->layer_count++;
    document->active += document->active >= index;
    document->solo += document->solo >= index;
}

void wr_document_add_filter(WrDocument *document, const char *name, const WrFilter *filter)
{
    WrLayer layer = wr_layer_of_filter(name, filter, document->layers[0].heights);
    layer.mask = share_or_null(document->selection);
    const int place = document->active + 1;
    wr_document_insert(document, place, layer);
    document->active = place;
}

/* Closes the gap of a removed layer. */
static void close_gap(WrDocument *document, int index)
{
    document->layer_count--;
    memmove(document->layers + index, document->layers + index + 1,
            (size_t)(document->layer_count - index) * sizeof *document->layers);
    if (document->solo == index) document->solo = -1;
    document->solo -= document->solo > index;
    document->active -= document->active >= index && document->active > 0;
}

void wr_document_remove(WrDocument *document, int index)
{
    WR_ASSERT(document->layer_count > 1);
    wr_layer_fini(&document->layers[index]);
    close_gap(document, index);
}

/* New index of a layer after another one moves. */
static int moved(int index, int from, int to)
{
    if (index == from) return to;
    if (from < index && index <= to) return index - 1;
    if (to <= index && index < from) return index + 1;
    return index;
}

void wr_document_move(WrDocument *document, int from, int to)
{
    WrLayer layer = document->layers[from], *layers = document->layers;
    if (from < to) memmove(layers + from, layers + from + 1, (size_t)(to - from) * sizeof layer);
    else memmove(layers + to + 1, layers + to, (size_t)(from - to) * sizeof layer);
    layers[to] = layer;
    document->active = moved(document->active, from, to);
    if (document->solo >= 0) document->solo = moved(document->solo, from, to);
}

void wr_document_start_over(WrDocument *document, WrField *heights)
{
    drop_layers(document);
    wr_field_free(document->selection);
    document->selection = NULL;
    document->layers = wr_alloc(1, sizeof *document->layers);
    document->layers[0] = layer_of("base", heights);
    document->layer_count = 1;
    document->active = 0;
    document->solo = -1;
}

/* ---- identity ---- */

static WrHash hash_field(const WrField *field, WrHash hash)
{
    if (!field) return wr_hash_bytes("-", 1, hash);
    WrHash texels = wr_field_hash(field);
    return wr_hash_bytes(&texels, sizeof texels, hash);
}

static WrHash hash_filter(const WrFilter *filter, WrHash hash)
{
    WrText text = { 0 };
    wr_filter_print(filter, &text);
    hash = wr_hash_bytes(text.data, text.length, hash);
    wr_text_fini(&text);
    return hash;
}

static WrHash hash_layer(const WrLayer *layer, WrHash hash)
{
    int32_t settings[3] = { (int32_t)layer->blend, layer->visible, layer->locked };
    float numbers[2] = { layer->opacity, layer->radius };
    hash = wr_hash_bytes(layer->name, strlen(layer->name) + 1, hash);
    hash = wr_hash_bytes(settings, sizeof settings, hash);
    hash = wr_hash_bytes(numbers, sizeof numbers, hash);
    if (layer->on_mask) hash = wr_hash_bytes("mask", 4, hash);
    if (layer->filter.op) hash = hash_filter(&layer->filter, hash);
    hash = hash_field(layer->heights, hash);
    hash = hash_field(layer->cover, hash);
    return hash_field(layer->mask, hash);
}

WrHash wr_document_hash(const WrDocument *document, const char *scene_text)
{
    int32_t numbers[3] = { document->layer_count, document->active, document->solo };
    WrHash hash = wr_hash_bytes(numbers, sizeof numbers, (WrHash){ 0, 0 });
    for (int i = 0; i < document->layer_count; i++) hash = hash_layer(&document->layers[i], hash);
    hash = hash_field(document->selection, hash);
    return wr_hash_bytes(scene_text, strlen(scene_text), hash);
}
