#include "document/object_tables.h"

#include "base/hash.h"
#include "base/memory.h"
#include "base/text.h"
#include "document/document.h"
#include "field/field.h"
#include "scene/scene.h"

#include <string.h>

int wr_layer_named(const WrDocument *document, const char *name)
{
    int i = name ? document->layer_count - 1 : -1;
    while (i >= 0 && strcmp(document->layers[i].name, name) != 0) i--;
    return i;
}

/* True if the layer alone equals its own heights: all of them are shown unchanged. */
static bool is_plain(const WrLayer *layer)
{
    return !layer->cover && !layer->mask && wr_layer_holds(layer) && layer->opacity == 1.0f &&
           layer->blend == WR_BLEND_ADD;
}

static WrField *field_of(const WrDocument *document, int index, WrDocument **cached, WrPool *pool)
{
    if (is_plain(&document->layers[index])) return wr_field_share(document->layers[index].heights);
    WrDocument *alone = wr_document_snapshot(document);
    alone->solo = index;
    if (cached && *cached) wr_document_swap_composites(alone, *cached);
    WrField *field = wr_field_share(wr_document_composite(alone, pool));
    if (cached) wr_document_free(*cached);
    if (cached) *cached = alone;
    else wr_document_free(alone);
    return field;
}

WrField *wr_document_layer_alone(const WrDocument *document, int index, WrPool *pool)
{
    return field_of(document, index, NULL, pool);
}

static uint64_t key_of(const WrLayer *layer, uint64_t key)
{
    uint32_t how[3] = { (uint32_t)layer->blend | (uint32_t)layer->visible << 8 |
                        (uint32_t)layer->is_group << 9 | (uint32_t)layer->depth << 10 };
    memcpy(how + 1, &layer->opacity, sizeof *how);
    memcpy(how + 2, &layer->radius, sizeof *how);
    const uint64_t part[] = { wr_field_key(layer->heights),
                              layer->cover ? wr_field_key(layer->cover) : 0,
                              layer->mask ? wr_field_key(layer->mask) : 0,
                              how[0],
                              how[1],
                              how[2] };
    for (size_t i = 0; i < sizeof part / sizeof *part; i++)
        key = (key ^ part[i]) * 0x9e3779b97f4a7c15U, key ^= key >> 32;
    return key;
}

/* A filter also depends on the layers below it in its group, a group on its members. */
uint64_t wr_layer_key(const WrDocument *document, int index)
{
    const WrFilter *filter = &document->layers[index].filter;
    const int first = filter->op ? wr_layers_first_sibling(document->layers, index)
                                 : wr_layers_first(document->layers, index);
    uint64_t key = 1;
    for (int i = first; i <= index; i++) {
        key = key_of(&document->layers[i], key);
        WrText text = { 0 };
        if (document->layers[i].filter.op) wr_filter_print(&document->layers[i].filter, &text);
        WrHash hash = wr_hash_bytes(wr_text_get(&text), text.length, (WrHash){ key, 0 });
        key = hash.low ^ hash.high;
        wr_text_fini(&text);
    }
    return key;
}

const WrTriangles *wr_document_painted_mesh(const WrDocument *document, double *ru, double *rv)
{
    const WrScene *scene = document->scene;
    const char *name = document->layers[document->active].name;
    const bool mask = scene->mask_layer && strcmp(scene->mask_layer, name) == 0;
    *ru = mask ? 1 : scene->replicate_u;
    *rv = mask ? 1 : scene->replicate_v;
    return mask && scene->projection.udim == 0 ? wr_scene_mesh_source(scene) : scene->triangles;
}

WrTables *wr_document_tables(const WrDocument *document, const WrScene *scene, WrTableCache *cache,
                             WrPool *pool)
{
    WrTables *tables = NULL;
    const int count = wr_scene_object_count(scene);
    for (int i = 0; i < count && i < WR_OBJECTS_MAX; i++) {
        const char *name = wr_scene_object(scene, i)->layer;
        const int index = name ? wr_layer_named(document, name) : -1;
        if (index < 0) continue;
        if (!tables) tables = wr_alloc(1, sizeof *tables);
        tables->refs = 1;
        tables->count = count;
        tables->fields[i] = field_of(document, index, cache ? &cache->alone[i] : NULL, pool);
    }
    return tables;
}

WrTables *wr_tables_share(const WrTables *tables)
{
    WrTables *shared = (WrTables *)tables; /* only the count changes */
    if (shared) __atomic_fetch_add(&shared->refs, 1, __ATOMIC_RELAXED);
    return shared;
}

void wr_tables_free(WrTables *tables)
{
    if (!tables || __atomic_sub_fetch(&tables->refs, 1, __ATOMIC_ACQ_REL) > 0) return;
    for (int i = 0; i < tables->count; i++) wr_field_free((WrField *)tables->fields[i]);
    wr_free(tables);
}

bool wr_tables_same(const WrTables *a, const WrTables *b)
{
    if (!a || !b) return a == b;
    bool same = a->count == b->count;
    for (int i = 0; i < a->count && same; i++) {
        const WrField *p = a->fields[i], *q = b->fields[i];
        same = p && q ? wr_field_key(p) == wr_field_key(q) : p == q;
    }
    return same;
}

const WrField *wr_tables_at_hand(const WrTables *tables, const WrScene *scene, const WrField *all)
{
    const WrField *own = tables ? tables->fields[scene->chosen] : NULL;
    return own ? own : all;
}

const WrField *const *wr_tables_fields(const WrTables *tables)
{
    return tables ? tables->fields : NULL;
}

void wr_table_cache_fini(WrTableCache *cache)
{
    for (int i = 0; i < WR_OBJECTS_MAX; i++) wr_document_free(cache->alone[i]);
    *cache = (WrTableCache){ 0 };
}
