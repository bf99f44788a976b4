/* Documents and their layers: creation, sharing, hashes, changes of the list of layers, and merging. */
#include "document/document.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "document/blend.h"
#include "document/composite.h"
#include "field/field.h"
#include "scene/scene.h"

#include <float.h>
#include <math.h>
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

WrLayer wr_layer_make(const char *name, const WrField *like)
{
    WrLayer layer = layer_of(name, empty_like(like, 0.0f));
    layer.cover = empty_like(like, 0.0f);
    return layer;
}

WrLayer wr_layer_make_filter(const char *name, const WrFilter *filter, const WrField *like)
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
    copy.line = wr_strdup(layer->line);
    copy.mask_line = wr_strdup(layer->mask_line);
    copy.heights = wr_field_share(layer->heights);
    copy.cover = share_or_null(layer->cover);
    copy.mask = share_or_null(layer->mask);
    return copy;
}

void wr_layer_fini(WrLayer *layer)
{
    wr_free(layer->name);
    wr_free(layer->line);
    wr_free(layer->mask_line);
    wr_field_free(layer->heights);
    wr_field_free(layer->cover);
    wr_field_free(layer->mask);
    *layer = (WrLayer){ 0 };
}

void wr_layer_set_line(WrLayer *layer, const char *line, WrHash below)
{
    char *copy = wr_strdup(line);
    wr_free(layer->line);
    layer->line = copy;
    layer->below = below;
    layer->made = line ? wr_field_key(layer->heights) : 0;
    layer->seen = 0;
}

void wr_layer_set_mask_line(WrLayer *layer, const char *line, WrHash read)
{
    char *copy = layer->mask ? wr_strdup(line) : NULL;
    wr_free(layer->mask_line);
    layer->mask_line = copy;
    layer->mask_read = read;
    layer->mask_made = copy ? wr_field_key(layer->mask) : 0;
    layer->mask_seen = 0;
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

bool wr_document_generates(const WrDocument *document)
{
    bool any = false;
    for (int i = 0; i < document->layer_count; i++)
        any |= document->layers[i].line || document->layers[i].mask_line;
    return any;
}

bool wr_layer_hides(const WrLayer *layer)
{
    const WrBlendMode *mode = &wr_blends[layer->blend];
    return layer->visible && mode->takes && layer->opacity >= 1.0f && !layer->mask &&
           !layer->filter.op && !(mode->uses_cover && layer->cover);
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

/* For the lowest layer, add is equivalent to mix (composite.h). */
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
    WrLayer layer = wr_layer_make_filter(name, filter, document->layers[0].heights);
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
    if (layer->line) hash = wr_hash_bytes(layer->line, strlen(layer->line) + 1, hash);
    if (layer->mask_line)
        hash = wr_hash_bytes(layer->mask_line, strlen(layer->mask_line) + 1, hash);
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

/* ---- merging of layers ---- */

#define TEXELS (WR_TILE * WR_TILE)

/* The composite of `count` layers on the ground; owned by the caller. */
static WrField *composite_of(const WrLayer *layers, int count, int solo, WrPool *pool)
{
    WrComposite *composite = wr_composite_new();
    WrField *field = wr_field_share(wr_composite_update(composite, layers, count, solo, pool));
    wr_composite_free(composite);
    return field;
}

static float bounded(double x)
{
    return (float)(x > FLT_MAX ? FLT_MAX : x < -FLT_MAX ? -FLT_MAX : x);
}

/* Values of a tile that may be NULL; a NULL field is 1 everywhere. */
typedef struct Values {
    const float *tile;
    float level;
} Values;

static Values values_of(const WrField *field, int tx, int ty)
{
    if (!field) return (Values){ NULL, 1.0f };
    return (Values){ wr_field_tile(field, tx, ty), wr_field_level(field) };
}

static double value_at(const Values *values, int i)
{
    return values->tile ? values->tile[i] : values->level;
}

static double unit(double x)
{
    return x > 0.0 ? x < 1.0 ? x : 1.0 : 0.0;
}

static bool is_additive(const WrLayer *layer)
{
    if (layer->filter.op) return false;
    return layer->blend == WR_BLEND_ADD || layer->blend == WR_BLEND_SUBTRACT;
}

/* The amount that an additive layer adds at texel i of a tile. */
static double added(const WrLayer *layer, const Values *heights, const Values *mask, int i)
{
    double h = value_at(heights, i) * unit(value_at(mask, i)) * (double)layer->opacity;
    return layer->blend == WR_BLEND_SUBTRACT ? -h : h;
}

static void add_tile(const WrLayer *a, const WrLayer *b, int tx, int ty, WrField *out)
{
    Values ha = values_of(a->heights, tx, ty), ma = values_of(a->mask, tx, ty);
    Values hb = values_of(b->heights, tx, ty), mb = values_of(b->mask, tx, ty);
    if (!ha.tile && !ma.tile && !hb.tile && !mb.tile) return; /* equals out's level */
    float *texels = wr_field_tile_write(out, tx, ty);
    for (int i = 0; i < TEXELS; i++)
        texels[i] = bounded(added(a, &ha, &ma, i) + added(b, &hb, &mb, i));
}

static Values level_of(const WrField *field)
{
    return (Values){ NULL, field ? wr_field_level(field) : 1.0f };
}

static double row_part(const WrField *field, int ty)
{
    return (double)ty / wr_field_tiles_v(field);
}

/* The sum of two additive layers. */
static WrField *sum_of(const WrLayer *a, const WrLayer *b)
{
    Values ha = level_of(a->heights), ma = level_of(a->mask);
    Values hb = level_of(b->heights), mb = level_of(b->mask);
    const WrField *like = a->heights;
    WrField *out = wr_field_new(wr_field_width(like), wr_field_height(like), wr_field_wrap_u(like),
                                wr_field_wrap_v(like),
                                bounded(added(a, &ha, &ma, 0) + added(b, &hb, &mb, 0)), NULL);
    for (int ty = 0; ty < wr_field_tiles_v(like) && wr_progress_report(row_part(like, ty)); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(like); tx++) add_tile(a, b, tx, ty, out);
    return out;
}

typedef struct Change {
    const WrField *below, *with;
    WrField *out;
} Change;

/* Heights of a layer with mode add that turns `below` into `with`. */
static void change_tile(int tx, int ty, void *ctx)
{
    const Change *change = ctx;
    Values a = values_of(change->below, tx, ty), b = values_of(change->with, tx, ty);
    if (!a.tile && !b.tile) return; /* equals out's level */
    float *texels = wr_field_tile_write(change->out, tx, ty);
    for (int i = 0; i < TEXELS; i++) texels[i] = bounded(value_at(&b, i) - value_at(&a, i));
}

/* with - below, as a new field. */
static WrField *change_of(const WrField *below, const WrField *with)
{
    double level = (double)wr_field_level(with) - (double)wr_field_level(below);
    WrField *out =
        wr_field_new(wr_field_width(below), wr_field_height(below), wr_field_wrap_u(below),
                     wr_field_wrap_v(below), bounded(level), NULL);
    Change change = { below, with, out };
    for (int ty = 0; ty < wr_field_tiles_v(below) && !wr_progress_stopped(); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(below); tx++)
            if (level != 0.0 || wr_field_tile(below, tx, ty) != wr_field_tile(with, tx, ty))
                change_tile(tx, ty, &change);
    return out;
}

/* The larger coverage of two layers; NULL: 1 everywhere. */
static WrField *cover_of(const WrLayer *a, const WrLayer *b)
{
    if (!a->cover || !b->cover) return NULL;
    const WrField *f = a->cover, *g = b->cover;
    float low = wr_field_level(f), other = wr_field_level(g);
    WrField *out = wr_field_new(wr_field_width(f), wr_field_height(f), wr_field_wrap_u(f),
                                wr_field_wrap_v(f), low > other ? low : other, NULL);
    for (int ty = 0; ty < wr_field_tiles_v(f) && !wr_progress_stopped(); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(f); tx++) {
            Values x = values_of(f, tx, ty), y = values_of(g, tx, ty);
            if (!x.tile && !y.tile) continue;
            float *texels = wr_field_tile_write(out, tx, ty);
            for (int i = 0; i < TEXELS; i++) {
                double p = value_at(&x, i), q = value_at(&y, i);
                texels[i] = (float)(p > q ? p : q);
            }
        }
    return out;
}

WrField *wr_document_below(const WrDocument *document, int index, WrPool *pool)
{
    if (index == 0) return empty_like(document->layers[0].heights, 0.0f);
    return wr_composite_below(document->composite, document->layers, document->layer_count, index,
                              pool);
}

void wr_document_merge(WrDocument *document, int index, WrPool *pool)
{
    WrLayer *layers = document->layers, *upper = &layers[index], *lower = &layers[index - 1];
    WrLayer made = { .name = wr_strdup(lower->name), .opacity = 1.0f, .visible = true };
    if (index == 1) {
        made.heights = composite_of(layers, 2, -1, pool);
    } else if (is_additive(upper) && is_additive(lower)) {
        made.heights = sum_of(upper, lower);
    } else {
        WrProgressPart part;
        const WrProgress *whole = wr_progress_enter(&part, 0.0, 0.45);
        WrField *below = composite_of(layers, index - 1, -1, pool);
        part.from = part.to;
        part.to = 0.9;
        WrField *with = composite_of(layers, index + 1, -1, pool);
        wr_progress_set(whole);
        made.heights = change_of(below, with);
        wr_field_free(below);
        wr_field_free(with);
    }
    if (index > 1) made.cover = cover_of(upper, lower);
    bool active = document->active == index;
    bool alone = document->solo == index;
    wr_layer_fini(lower);
    *lower = made;
    wr_document_remove(document, index);
    if (active) document->active = index - 1;
    if (alone) document->solo = index - 1;
}

void wr_document_flatten(WrDocument *document, WrPool *pool)
{
    WrField *heights = composite_of(document->layers, document->layer_count, -1, pool);
    while (document->layer_count > 1) wr_document_remove(document, document->layer_count - 1);
    WrLayer *layer = &document->layers[0];
    WrLayer made = {
        .name = wr_strdup(layer->name), .heights = heights, .opacity = 1.0f, .visible = true
    };
    wr_layer_fini(layer);
    *layer = made;
    document->active = 0;
    document->solo = -1;
}
