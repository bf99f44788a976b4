/* layer_rows.h - rows of the layers' list, from the top, and the place where dragged rows would land. Plain data. */
#pragma once
#include "document/document.h"

#include <stdbool.h>

typedef struct WrLayerRows {
    int layer[WR_LAYERS_MAX]; /* index of the layer in each row */
    int count;
} WrLayerRows;

WrLayerRows wr_layer_rows(const WrDocument *document);

/* Where dragged layers would land. */
typedef struct WrLayerDrop {
    int to;      /* argument of `layer move LIST to=`; 0: they stay where they are */
    double line; /* position of the line that shows the place, in rows from the top */
} WrLayerDrop;

/* moved: the dragged layers. y: the pointer, in rows from the top; beyond the list, its end counts. */
WrLayerDrop wr_layer_drop(const WrDocument *document, const WrLayerRows *rows,
                          const bool moved[WR_LAYERS_MAX], double y);
