/* Documents and their layers: creation, sharing, hashes, changes of the list of layers, and merging. */
#include "document/document.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "document/blend.h"
#include "document/composite.h"
#include "document/variants.h"
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
    copy.values = wr_strdup(layer->values);
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
    wr_free(layer->values);
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
    layer->copied = 0;
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

bool wr_document_groups(const WrDocument *document)
{
    bool any = false;
    for (int i = 0; i < document->layer_count; i++) any |= document->layers[i].is_group;
    return any;
}

bool wr_document_generates(const WrDocument *document)
{
    bool any = false;
    for (int i = 0; i < document->layer_count; i++)
        any |= document->layers[i].line || document->layers[i].mask_line;
    return any;
}

bool wr_layer_holds(const WrLayer *layer)
{
    return !layer->filter.op && !layer->is_group;
}

bool wr_layer_hides(const WrLayer *layer)
{
    const WrBlendMode *mode = &wr_blends[layer->blend];
    return layer->visible && mode->takes && layer->opacity >= 1.0f && !layer->mask &&
           wr_layer_holds(layer) && !(mode->uses_cover && layer->cover);
}

/* ---- groups ---- */

int wr_layers_first(const WrLayer *layers, int index)
{
    int first = index;
    while (first > 0 && layers[first - 1].depth > layers[index].depth) first--;
    return first;
}

int wr_layers_first_sibling(const WrLayer *layers, int index)
{
    int first = index;
    while (first > 0 && layers[first - 1].depth >= layers[index].depth) first--;
    return first;
}

int wr_document_parent(const WrDocument *document, int index)
{
    const int depth = document->layers[index].depth;
    if (depth == 0) return -1;
    while (document->layers[index].depth >= depth) index++;
    return index;
}

bool wr_document_is_within(const WrDocument *document, int index, int group)
{
    return index < group && index >= wr_layers_first(document->layers, group);
}

int wr_document_height(const WrDocument *document, int index)
{
    const WrLayer *layers = document->layers;
    int height = layers[index].is_group;
    for (int i = wr_layers_first(layers, index); i < index; i++) {
        const int here = layers[i].depth + layers[i].is_group - layers[index].depth;
        height = here > height ? here : height;
    }
    return height;
}

bool wr_document_check_groups(const WrDocument *document, WrError *err)
{
    for (int i = document->layer_count - 1, most = 0; i >= 0; i--) {
        const WrLayer *layer = &document->layers[i];
        if (layer->depth < 0 || layer->depth + layer->is_group > WR_DEPTH_MAX)
            return wr_fail(err, "layer %d is in %d groups: up to %d can be nested", i + 1,
                           layer->depth + layer->is_group, WR_DEPTH_MAX);
        if (layer->depth > most)
            return wr_fail(err,
                           "layer %d is %d groups deep, but only %d are open: a group is missing",
                           i + 1, layer->depth, most);
        if (layer->is_group && (layer->filter.op || layer->line))
            return wr_fail(err, "layer %d is a group and a filter or generator layer", i + 1);
        most = layer->depth + layer->is_group;
    }
    return true;
}

bool wr_document_is_visible_up_to(const WrDocument *document, int index, int top)
{
    while (index >= 0 && index != top) {
        if (!document->layers[index].visible) return false;
        index = wr_document_parent(document, index);
    }
    return true;
}

int wr_document_find_below(const WrDocument *document, int index, const char *name)
{
    do index--;
    while (index >= 0 && strcmp(document->layers[index].name, name) != 0);
    return index;
}

bool wr_document_is_visible(const WrDocument *document, int index)
{
    return wr_document_is_visible_up_to(document, index, -1);
}

bool wr_document_shows(const WrDocument *document, int index)
{
    const int solo = document->solo;
    if (solo < 0) return wr_document_is_visible(document, index);
    if (index == solo) return true;
    return wr_document_is_within(document, index, solo) &&
           wr_document_is_visible_up_to(document, index, solo);
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
    copy->variants = wr_strdup(document->variants);
    copy->variant = wr_strdup(document->variant);
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
    wr_free(document->variants);
    wr_free(document->variant);
    wr_composite_free(document->composite);
    wr_free(document);
}

/* For the lowest layer, add is equivalent to mix (composite.h). */
static bool is_plain(const WrDocument *document)
{
    const WrLayer *layer = &document->layers[0];
    const WrBlendMode *mode = &wr_blends[layer->blend];
    return document->layer_count == 1 && wr_document_shows(document, 0) && layer->opacity == 1.0f &&
           !layer->mask && wr_layer_holds(layer) &&
           (layer->blend == WR_BLEND_ADD || (mode->takes && !(mode->uses_cover && layer->cover)));
}

const WrField *wr_document_composite(const WrDocument *document, WrPool *pool)
{
    const int solo = document->solo;
    if (is_plain(document)) return document->layers[0].heights;
    WrRows rows = { .layers = document->layers, .to = document->layer_count };
    if (solo >= 0) { /* the layers up to it, if it is a filter; else it alone, with its members */
        const bool filters = document->layers[solo].filter.op;
        rows.from = filters ? wr_layers_first_sibling(rows.layers, solo)
                            : wr_layers_first(rows.layers, solo);
        rows.to = solo + 1;
    }
    return wr_composite_update(document->composite, &rows, solo, pool, NULL);
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
    const WrLayer *above = index < count ? &document->layers[index] : NULL;
    const int least = index > 0 ? document->layers[index - 1].depth : 0;
    const int most = above ? above->depth + above->is_group : 0;
    layer.depth = layer.depth < least ? least : layer.depth > most ? most : layer.depth;
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

/* Index after `count` rows from `first` were removed; of one of these, `gone`. */
static int closed(int index, int first, int count, int gone)
{
    if (index < first) return index;
    return index < first + count ? gone : index - count;
}

static void remove_rows(WrDocument *document, int first, int count)
{
    WrLayer *layers = document->layers;
    for (int i = first; i < first + count; i++) wr_layer_fini(&layers[i]);
    document->layer_count -= count;
    memmove(layers + first, layers + first + count,
            (size_t)(document->layer_count - first) * sizeof *layers);
    document->solo = closed(document->solo, first, count, -1);
    document->active = closed(document->active, first, count, first > 0 ? first - 1 : 0);
}

void wr_document_remove(WrDocument *document, int index)
{
    const int first = wr_layers_first(document->layers, index);
    WR_ASSERT(document->layer_count > index + 1 - first);
    remove_rows(document, first, index + 1 - first);
}

/* Puts the layers in the order of order[layer_count], old indices from the bottom up. */
static void reorder(WrDocument *document, const int order[])
{
    const int count = document->layer_count, active = document->active, solo = document->solo;
    WrLayer *layers = wr_alloc((size_t)count, sizeof *layers);
    for (int i = 0; i < count; i++) {
        layers[i] = document->layers[order[i]];
        if (order[i] == active) document->active = i;
        if (order[i] == solo) document->solo = i;
    }
    wr_free(document->layers);
    document->layers = layers;
}

/* Lists the rows that are not in first..last. */
static int list_rest(const WrDocument *document, int first, int last, int rest[])
{
    int count = 0;
    for (int i = 0; i < document->layer_count; i++)
        if (i < first || i > last) rest[count++] = i;
    return count;
}

void wr_document_move_depths(const WrDocument *document, int from, int to, int *least, int *most)
{
    const WrLayer *layers = document->layers;
    int rest[WR_LAYERS_MAX];
    const int first = wr_layers_first(layers, from);
    const int count = list_rest(document, first, from, rest), place = to - (from - first);
    WR_ASSERT(place >= 0 && place <= count);
    *least = place > 0 ? layers[rest[place - 1]].depth : 0;
    *most = place < count ? layers[rest[place]].depth + layers[rest[place]].is_group : 0;
}

void wr_document_move(WrDocument *document, int from, int to, int depth)
{
    WrLayer *layers = document->layers;
    int order[WR_LAYERS_MAX], least, most;
    const int first = wr_layers_first(layers, from), moving = from + 1 - first;
    wr_document_move_depths(document, from, to, &least, &most);
    WR_ASSERT(depth >= least && depth <= most &&
              depth + wr_document_height(document, from) <= WR_DEPTH_MAX);
    const int deeper = depth - layers[from].depth, place = to + 1 - moving;
    const int count = list_rest(document, first, from, order);
    memmove(order + place + moving, order + place, (size_t)(count - place) * sizeof *order);
    for (int i = 0; i < moving; i++) {
        order[place + i] = first + i;
        layers[first + i].depth += deeper;
    }
    reorder(document, order);
}

/* The chosen layer that row `index` belongs to: itself, or the outermost group that it is in; -1: none. */
static int chosen_over(const WrDocument *document, const bool chosen[], int index)
{
    int found = -1;
    for (int i = index; i >= 0; i = wr_document_parent(document, i))
        if (chosen[i]) found = i;
    return found;
}

/* Blend and radius with which a group of one such layer is that layer. */
static void take_blend(const WrLayer *lowest, WrLayer *group)
{
    const bool same = !lowest->filter.op && lowest->blend != WR_BLEND_SUBTRACT;
    const bool mixes = same && lowest->blend == WR_BLEND_MIX;
    group->blend = mixes ? WR_BLEND_REPLACE : same ? lowest->blend : WR_BLEND_ADD;
    group->radius = same ? lowest->radius : 0.0f;
}

/* New order of the rows after the chosen ones are grouped, without the group's own row. Returns the number of rows up to the
   highest chosen one.
     order   output [layer_count], old index of each row
     deeper  output [layer_count], increase of the depth of each old row
     lowest  output, place of the lowest chosen row in `order` */
static int list_grouped(const WrDocument *document, const bool chosen[], int order[], int deeper[],
                        int *lowest)
{
    const WrLayer *layers = document->layers;
    int over[WR_LAYERS_MAX], top = 0, count = 0;
    for (int i = 0; i < document->layer_count; i++) {
        over[i] = chosen_over(document, chosen, i);
        if (over[i] >= 0) top = i;
    }
    for (int i = 0; i < document->layer_count; i++) {
        deeper[i] = over[i] < 0 ? 0 : layers[top].depth + 1 - layers[over[i]].depth;
        if (over[i] < 0 && i < top) order[count++] = i;
    }
    *lowest = -1;
    for (int i = 0; i <= top; i++) {
        if (over[i] < 0) continue;
        if (*lowest < 0 && over[i] == i) *lowest = count;
        order[count++] = i;
    }
    for (int i = top + 1; i < document->layer_count; i++) order[i] = i;
    return count;
}

int wr_document_group(WrDocument *document, const bool chosen[], const char *name)
{
    WrLayer *layers = document->layers;
    int order[WR_LAYERS_MAX], deeper[WR_LAYERS_MAX], lowest;
    const int place = list_grouped(document, chosen, order, deeper, &lowest);
    const int depth = layers[order[place - 1]].depth;
    for (int i = 0; i < document->layer_count; i++)
        if (layers[i].depth + deeper[i] + layers[i].is_group > WR_DEPTH_MAX) return -1;
    for (int i = 0; i < document->layer_count; i++) layers[i].depth += deeper[i];
    reorder(document, order);
    WrLayer group = layer_of(name, empty_like(document->layers[0].heights, 0.0f));
    group.is_group = true;
    take_blend(&document->layers[lowest], &group);
    wr_document_insert(document, place, group);
    document->layers[place].depth = depth;
    document->active = place;
    return place;
}

void wr_document_ungroup(WrDocument *document, int index)
{
    const int first = wr_layers_first(document->layers, index);
    for (int i = first; i < index; i++) document->layers[i].depth--;
    remove_rows(document, index, 1);
}

void wr_document_start_over(WrDocument *document, WrField *heights)
{
    drop_layers(document);
    wr_field_free(document->selection);
    wr_document_set_variants(document, NULL, NULL);
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

static WrHash hash_text(const char *text, WrHash hash)
{
    return wr_hash_bytes(text, strlen(text) + 1, hash);
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
    if (layer->is_group || layer->depth) {
        int32_t place[3] = { layer->depth, layer->is_group, layer->collapsed };
        hash = wr_hash_bytes(place, sizeof place, hash);
    }
    if (layer->line) hash = hash_text(layer->line, hash);
    if (layer->mask_line) hash = hash_text(layer->mask_line, hash);
    if (layer->values) hash = hash_text(layer->values, hash);
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
    if (document->variants) hash = hash_text(document->variants, hash);
    if (document->variant) hash = hash_text(document->variant, hash);
    return wr_hash_bytes(scene_text, strlen(scene_text), hash);
}

/* ---- merging of layers ---- */

#define TEXELS (WR_TILE * WR_TILE)

/* The composite of rows; owned by the caller, and so is their coverage, unless it is not wanted. */
static WrField *composite_of(const WrRows *rows, WrPool *pool, WrField **cover)
{
    WrComposite *composite = wr_composite_new();
    const WrField *covered = NULL;
    WrField *field =
        wr_field_share(wr_composite_update(composite, rows, -1, pool, cover ? &covered : NULL));
    if (cover) *cover = wr_field_share(covered);
    wr_composite_free(composite);
    return field;
}

/* The rows from..to - 1 of the group that layer `index` is in. */
static WrRows rows_beside(const WrDocument *document, int index, int from, int to)
{
    const int group = wr_document_parent(document, index);
    const bool partial = group >= 0 && wr_blends[document->layers[group].blend].uses_cover;
    return (WrRows){ document->layers, from, to, partial };
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
    if (!wr_layer_holds(layer)) return false;
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
    const WrLayer *layers = document->layers;
    const WrRows rows = rows_beside(document, index, wr_layers_first_sibling(layers, index),
                                    wr_layers_first(layers, index));
    if (rows.from < rows.to)
        return wr_composite_below(document->composite, &rows, document->layer_count, index, pool);
    return empty_like(layers[index].heights, 0.0f);
}

int wr_document_rasterize_group(WrDocument *document, int index, WrPool *pool)
{
    WrLayer *group = &document->layers[index];
    const WrRows rows = { document->layers, wr_layers_first(document->layers, index), index,
                          wr_blends[group->blend].uses_cover };
    bool any = false;
    for (int i = rows.from; i < rows.to; i++)
        any |= !document->layers[i].is_group && wr_document_is_visible_up_to(document, i, index);
    group->is_group = group->collapsed = false;
    if (!any) { /* nothing, as before: a layer of mode mix would show its heights, 0 */
        if (group->blend == WR_BLEND_MIX) group->blend = WR_BLEND_ADD;
        group->cover = empty_like(group->heights, 0.0f);
    } else {
        wr_field_free(group->heights);
        group->heights = composite_of(&rows, pool, &group->cover);
    }
    const bool active = document->active >= rows.from && document->active <= index;
    remove_rows(document, rows.from, rows.to - rows.from);
    if (active) document->active = rows.from;
    return rows.from;
}

/* Heights of a layer with mode add that has the effect of layers index - 1 and index. */
static WrField *joined(const WrDocument *document, int index, WrPool *pool)
{
    const WrLayer *layers = document->layers;
    if (is_additive(&layers[index]) && is_additive(&layers[index - 1]))
        return sum_of(&layers[index], &layers[index - 1]);
    WrRows rows = rows_beside(document, index, wr_layers_first_sibling(layers, index), index - 1);
    WrProgressPart part;
    const WrProgress *whole = wr_progress_enter(&part, 0.0, 0.45);
    WrField *below = composite_of(&rows, pool, NULL);
    part.from = part.to;
    part.to = 0.9;
    rows.to = index + 1;
    WrField *with = composite_of(&rows, pool, NULL);
    wr_progress_set(whole);
    WrField *made = change_of(below, with);
    wr_field_free(below);
    wr_field_free(with);
    return made;
}

void wr_document_merge(WrDocument *document, int index, WrPool *pool)
{
    int other = wr_layers_first(document->layers, index) - 1;
    if (document->layers[index].is_group) wr_document_rasterize_group(document, index, pool);
    if (document->layers[other].is_group)
        other = wr_document_rasterize_group(document, other, pool);
    index = other + 1;
    WrLayer *layers = document->layers, *upper = &layers[index], *lower = &layers[index - 1];
    WrLayer made = {
        .name = wr_strdup(lower->name), .opacity = 1.0f, .visible = true, .depth = lower->depth
    };
    const WrRows both = rows_beside(document, index, index - 1, index + 1);
    const bool lowest = wr_layers_first_sibling(layers, index) == index - 1;
    if (lowest) made.heights = composite_of(&both, pool, made.depth > 0 ? &made.cover : NULL);
    else made.heights = joined(document, index, pool);
    if (!lowest && made.depth == 0) made.cover = cover_of(upper, lower);
    if (!lowest && made.depth > 0) wr_field_free(composite_of(&both, pool, &made.cover));
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
    const WrRows all = { .layers = document->layers, .to = document->layer_count };
    WrField *heights = composite_of(&all, pool, NULL);
    remove_rows(document, 1, document->layer_count - 1);
    WrLayer *layer = &document->layers[0];
    WrLayer made = {
        .name = wr_strdup(layer->name), .heights = heights, .opacity = 1.0f, .visible = true
    };
    wr_layer_fini(layer);
    *layer = made;
    document->active = 0;
    document->solo = -1;
}
