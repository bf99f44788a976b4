/* ora_show.h - heights as greys, for the pictures of an OpenRaster file that other programs show.
   Layer 5. Private to this room. */
#pragma once
#include "document/blend.h"

#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrDocument WrDocument;
typedef struct WrField WrField;

typedef struct WrOraRange {
    float low, high; /* heights that are black and white; low < high */
} WrOraRange;

/* 0..1 as long as all heights are in it, so that what came from pictures keeps its codes; else wider. */
WrOraRange wr_ora_range(const WrDocument *document);

/* What the picture of a layer shows, so that its composite-op, which knows nothing of heights below 0 and
   scales, gives the greys of what the layer gives. R is the range from low to high, c the coverage, m the
   mask. */
typedef enum WrOraShowing {
    WR_ORA_HEIGHTS, /* (h - low) / R, alpha c m */
    WR_ORA_MIXED,   /* the same, alpha m: the blend does not ask for coverage */
    WR_ORA_SUM,     /* alpha times grey is m h / R, so that adding adds heights */
    WR_ORA_TAKEN,   /* h / R, alpha m where there is anything */
    WR_ORA_FACTOR   /* h, alpha c m */
} WrOraShowing;

WrOraShowing wr_ora_showing(WrBlend blend);

/* Grey and straight alpha of a texel, both 0..1. cover and mask outside 0..1 count as 0 or 1. */
void wr_ora_show(WrOraShowing showing, const WrOraRange *range, float height, float cover,
                 float mask, double *grey, double *alpha);

/* Whether every program that shows the layers from `lowest` on, the lowest that is shown (-1: none is), has the picture
 * that we have: whatever scale it blends greys on, and wherever its operations mean the same as ours. */
bool wr_ora_agrees(const WrDocument *document, int lowest, const WrOraRange *range);

/* A small picture of heights, RGBA, 256 pixels along a side at most; the caller's (wr_free). NULL and an
 * error if memory is gone. */
uint8_t *wr_ora_thumbnail(const WrField *heights, const WrOraRange *range, int *width, int *height,
                          WrError *err);
