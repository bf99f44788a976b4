/* ora_show.h - conversion of heights to greys, for the pictures of an OpenRaster file that other programs
   display. Private to this module. */
#pragma once
#include "document/blend.h"

#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrDocument WrDocument;
typedef struct WrField WrField;

typedef struct WrOraRange {
    float low, high; /* heights of black and white; low < high */
} WrOraRange;

/* 0..1 as long as all heights are inside, so that imported pictures keep their codes; else wider. */
WrOraRange wr_ora_range(const WrDocument *document);

/* Content of a layer's picture, chosen so that its composite-op, which has no heights below 0 and no scales,
   gives the greys of the layer's result. R is the range from low to high, c the coverage, m the mask. */
typedef enum WrOraShowing {
    WR_ORA_HEIGHTS, /* (h - low) / R, alpha c m */
    WR_ORA_MIXED,   /* (h - low) / R, alpha m: for a blend without coverage */
    WR_ORA_SUM,     /* alpha times grey is m h / R, so that adding adds heights */
    WR_ORA_TAKEN,   /* h / R, alpha m where the layer is not empty */
    WR_ORA_FACTOR   /* h, alpha c m */
} WrOraShowing;

WrOraShowing wr_ora_showing(WrBlend blend);

/* Grey and alpha (not premultiplied) of a texel, both 0..1. cover and mask outside 0..1 are clamped. */
void wr_ora_show(WrOraShowing showing, const WrOraRange *range, float height, float cover,
                 float mask, double *grey, double *alpha);

/* True if every program that blends the layers from `lowest` on, the lowest visible one (-1: none), gets our
   composite, on any scale of greys, as far as its operations equal ours. */
bool wr_ora_agrees(const WrDocument *document, int lowest, const WrOraRange *range);

/* A small picture of heights, RGBA, 256 pixels along a side at most; owned by the caller (wr_free). NULL and an
   error if there is no memory. */
uint8_t *wr_ora_thumbnail(const WrField *heights, const WrOraRange *range, int *width, int *height,
                          WrError *err);
