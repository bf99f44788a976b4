/* layer_rows.h - rows of the layers' list, and where layers would land that are dragged or moved by a step. Plain data. */
#pragma once
#include "document/document.h"

#include <stdbool.h>

/* The rows from the top: all layers but the members of collapsed groups. */
typedef struct WrLayerRows {
    int layer[WR_LAYERS_MAX]; /* index of the layer in each row */
    int count;
} WrLayerRows;

WrLayerRows wr_layer_rows(const WrDocument *document);
/* The row of a layer, or of the collapsed group that it is in. */
int wr_layer_rows_find(const WrLayerRows *rows, int layer);

/* Layers that move together, each with its members. */
typedef struct WrLayerBlock {
    int layer[WR_LAYERS_MAX]; /* those that are in none of the others, the lowest first */
    int count;
    int rows;   /* number of all layers, with members */
    int lowest; /* index of the lowest one, with members */
} WrLayerBlock;

/* layers: at least one */
WrLayerBlock wr_layer_block(const WrDocument *document, const bool layers[WR_LAYERS_MAX]);
/* Rows of layer i of the block, with its members. */
int wr_layer_block_rows(const WrDocument *document, const WrLayerBlock *block, int i);

/* Where a block would land. */
typedef struct WrLayerDrop {
    int to;      /* argument of `layer move LIST to=`; 0: it stays, or may not be there */
    int in;      /* index of the group that it would be in; -1: none */
    int first;   /* index that its lowest layer would have */
    double line; /* position of the line that shows the place, in rows from the top */
    int row;     /* row of the group in which it is dropped; -1: between rows */
} WrLayerDrop;

/* The block is dragged; y: the pointer, in rows from the top. On the upper part of a row: above it; on the lower part: below
   it; on the middle of a group: as its topmost layer. Beyond the list, its ends count. */
WrLayerDrop wr_layer_drop(const WrDocument *document, const WrLayerRows *rows,
                          const WrLayerBlock *block, double y);
/* A step up (1) or down (-1) in the list: past a layer, past a collapsed group, or into or out of a group. */
WrLayerDrop wr_layer_step(const WrDocument *document, const WrLayerRows *rows,
                          const WrLayerBlock *block, int way);
