#include "ui/panels/layer_rows.h"

#include <math.h>

/* ---- rows ---- */

WrLayerRows wr_layer_rows(const WrDocument *document)
{
    WrLayerRows rows = { .count = 0 };
    for (int i = document->layer_count - 1; i >= 0; i--) {
        rows.layer[rows.count++] = i;
        if (document->layers[i].collapsed) i = wr_layers_first(document->layers, i);
    }
    return rows;
}

int wr_layer_rows_find(const WrLayerRows *rows, int layer)
{
    int row = 0;
    while (row + 1 < rows->count && rows->layer[row + 1] >= layer) row++;
    return row;
}

/* ---- blocks ---- */

WrLayerBlock wr_layer_block(const WrDocument *document, const bool layers[WR_LAYERS_MAX])
{
    WrLayerBlock block = { .count = 0 };
    for (int i = 0; i < document->layer_count; i++) {
        int over = layers[i] ? wr_document_parent(document, i) : -1;
        while (over >= 0 && !layers[over]) over = wr_document_parent(document, over);
        if (!layers[i] || over >= 0) continue;
        block.layer[block.count++] = i;
        block.rows += i + 1 - wr_layers_first(document->layers, i);
    }
    block.lowest = wr_layers_first(document->layers, block.layer[0]);
    return block;
}

int wr_layer_block_rows(const WrDocument *document, const WrLayerBlock *block, int i)
{
    return block->layer[i] + 1 - wr_layers_first(document->layers, block->layer[i]);
}

/* True if layer `index` moves with the block. */
static bool moves(const WrDocument *document, const WrLayerBlock *block, int index)
{
    for (int i = 0; i < block->count; i++)
        if (index == block->layer[i] || wr_document_is_within(document, index, block->layer[i]))
            return true;
    return false;
}

/* True if the group, -1 for none, has room for the block. */
static bool can_hold(const WrDocument *document, const WrLayerBlock *block, int group)
{
    const int depth = group < 0 ? 0 : document->layers[group].depth + 1;
    for (int i = 0; i < block->count; i++)
        if (depth + wr_document_height(document, block->layer[i]) > WR_DEPTH_MAX) return false;
    return group < 0 || !moves(document, block, group);
}

/* True if the block already is in that group, with its lowest layer at index `first`. */
static bool is_there(const WrDocument *document, const WrLayerBlock *block, int first, int group)
{
    for (int i = 0; i < block->count; i++) {
        if (wr_document_parent(document, block->layer[i]) != group) return false;
        if (wr_layers_first(document->layers, block->layer[i]) != first) return false;
        first += wr_layer_block_rows(document, block, i);
    }
    return true;
}

/* The block in the group, under layer `above`, which is layer_count at the top. */
static WrLayerDrop place(const WrDocument *document, const WrLayerBlock *block, int above,
                         int group)
{
    WrLayerDrop drop = { .in = group, .first = 0, .row = -1 };
    for (int i = 0; i < above; i++) drop.first += !moves(document, block, i);
    if (can_hold(document, block, group) && !is_there(document, block, drop.first, group))
        drop.to = drop.first + wr_layer_block_rows(document, block, 0);
    return drop;
}

static WrLayerDrop place_above(const WrDocument *document, const WrLayerBlock *block, int layer)
{
    return place(document, block, layer + 1, wr_document_parent(document, layer));
}

static WrLayerDrop place_below(const WrDocument *document, const WrLayerBlock *block, int layer)
{
    return place(document, block, wr_layers_first(document->layers, layer),
                 wr_document_parent(document, layer));
}

static bool is_open(const WrLayer *layer)
{
    return layer->is_group && !layer->collapsed;
}

/* ---- drops and steps ---- */

WrLayerDrop wr_layer_drop(const WrDocument *document, const WrLayerRows *rows,
                          const WrLayerBlock *block, double y)
{
    const int row = (int)fmin(fmax(floor(y), 0.0), rows->count - 1);
    const int layer = rows->layer[row];
    const WrLayer *on = &document->layers[layer];
    const double part = y - row, rim = on->is_group ? 0.25 : 0.5;
    WrLayerDrop drop;
    if (part < rim) {
        drop = place_above(document, block, layer);
        drop.line = row;
    } else if (part < 1.0 - rim || (is_open(on) && part < 1.0)) {
        drop = place(document, block, layer, layer);
        drop.line = row + 1;
        drop.row = row;
    } else {
        /* below the whole list: in no group */
        drop = part < 1.0 ? place_below(document, block, layer) : place(document, block, 0, -1);
        drop.line = row + 1;
    }
    return drop;
}

WrLayerDrop wr_layer_step(const WrDocument *document, const WrLayerRows *rows,
                          const WrLayerBlock *block, int way)
{
    const int end = way > 0 ? block->layer[block->count - 1] : block->lowest;
    const int row = wr_layer_rows_find(rows, end) - way;
    if (row < 0) return (WrLayerDrop){ .in = -1, .row = -1 };
    if (row >= rows->count) return place(document, block, 0, -1);
    const int layer = rows->layer[row];
    const int depth = document->layers[layer].depth;
    const int own = document->layers[block->layer[way > 0 ? block->count - 1 : 0]].depth;
    const bool empty =
        is_open(&document->layers[layer]) &&
        wr_layers_first(document->layers, layer) == layer; /* without the block too */
    if (way > 0 && empty && wr_document_parent(document, end) != layer)
        return place(document, block, layer, layer);
    if (way > 0) /* below the lowest layer of a group: into the group */
        return depth > own ? place_below(document, block, layer)
                           : place_above(document, block, layer);
    if (depth < own) return place_above(document, block, layer); /* out of a group */
    return is_open(&document->layers[layer]) ? place(document, block, layer, layer)
                                             : place_below(document, block, layer);
}
