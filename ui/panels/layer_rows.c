#include "ui/panels/layer_rows.h"

#include <math.h>

WrLayerRows wr_layer_rows(const WrDocument *document)
{
    WrLayerRows rows = { .count = document->layer_count };
    for (int i = 0; i < rows.count; i++) rows.layer[i] = rows.count - 1 - i;
    return rows;
}

/* True if the layers, in a block whose lowest becomes layer `first`, all stay where they are. */
static bool stays(const bool moved[WR_LAYERS_MAX], int count, int first)
{
    for (int i = 0; i < count; i++) {
        if (!moved[i]) continue;
        if (i != first) return false;
        first++;
    }
    return true;
}

WrLayerDrop wr_layer_drop(const WrDocument *document, const WrLayerRows *rows,
                          const bool moved[WR_LAYERS_MAX], double y)
{
    const double line = fmin(fmax(rint(y), 0.0), rows->count);
    /* the block lies on the layer of the next row */
    const int on = line < rows->count ? rows->layer[(int)line] : -1;
    int first = 0; /* layers below the block */
    for (int i = 0; i <= on; i++) first += !moved[i];
    return (WrLayerDrop){ .to = stays(moved, document->layer_count, first) ? 0 : first + 1,
                          .line = line };
}
