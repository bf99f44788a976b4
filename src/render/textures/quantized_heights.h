/* quantized_heights.h - a height table as a file or a store of fewer bits would have kept it: half precision, or
   integers over the table's own range.
   Layer 5, private to the renderer. The rounded heights are kept as single precision again: what is
   measured on this rung is the error; its memory and its time are those of single precision. */
#pragma once
#include "base/kernmath.h"
#include "scene/dials.h"

typedef struct WrError WrError;
typedef struct WrField WrField;

/* Zero-initialise; drop frees. */
typedef struct WrQuantizedHeights {
    WrField *source;  /* snapshot that it was made from; NULL: none */
    WrField *field;   /* owned */
    WrHeights format; /* that it was made in */
    float low, high;  /* range of the codes */
} WrQuantizedHeights;

/* Bring it up to date: only changed tiles, unless the range moved. Returns the table to look up: `field`
   itself for double and float, else one owned by `rounded`, valid until the next call.
     half   nearest binary16, ties to even; beyond 65504 the largest
     16bit  low + round((F - low) / (high - low) M) (high - low) / M with M = 65535 and the table's least
     8bit   and largest height; M = 255. A table of one height stays as it is
   low, high: of the table. NULL and an error when memory is gone. */
const WrField *wr_quantized_heights_bring(WrQuantizedHeights *rounded, const WrField *field,
                                          WrHeights format, float low, float high, WrError *err);
void wr_quantized_heights_drop(WrQuantizedHeights *rounded);
