/* transform_snap.h - lines to which the frame of Free transform snaps: fractions of the cell, the snapping grid, edges and centres of
   other layers' content. */
#pragma once
#include "ui/app/state/app_state.h"

#include "document/document.h"
#include "field/select.h"

#include <stdbool.h>
#include <stdint.h>

#define WR_SNAP_OTHERS 32 /* layers of which the content counts: the highest ones */

/* Content of other layers, measured once for a revision of the document. Zeroed is empty. */
typedef struct WrSnapOthers {
    bool measured;
    uint64_t revision;
    int count;
    WrSelectBox box[WR_SNAP_OTHERS];
} WrSnapOthers;

/* Bounding box of the content of these layers, [layer_count] flags: of their coverage, or of heights that are not 0. It may
   cross periodic edges. On an axis that it nearly fills, or without content, it is the whole axis. A single layer whose mask is
   edited has the content of its mask. */
WrSelectBox wr_content_box(const WrDocument *document, const bool layers[WR_LAYERS_MAX]);
/* Measure the content of the visible layers that are not flagged; of large documents none. */
void wr_snap_measure(const WrApp *app, const bool moved[WR_LAYERS_MAX], WrSnapOthers *others);
/* The line next to a position along an axis (1: down), in texels, unwrapped. */
double wr_snap_line(const WrApp *app, const WrSnapOthers *others, int axis, double at);
