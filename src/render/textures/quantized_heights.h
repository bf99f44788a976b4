/* quantized_heights.h - height table rounded to a storage format of fewer bits: half precision, or integers over
   the table's own range.
   Private to the renderer. The rounded heights are stored in single precision again: this measures the error of
   the format; memory and time are those of single precision. */
#pragma once
#include "base/kernmath.h"
#include "scene/dials.h"

typedef struct WrError WrError;
typedef struct WrField WrField;

/* Zero-initialise; drop frees. */
typedef struct WrQuantizedHeights {
    WrField *source;  /* snapshot that it was made from; NULL: none */
    WrField *field;   /* owned */
    WrHeights format; /* current format */
    float low, high;  /* range of the integers */
} WrQuantizedHeights;

/* Updates the rounded table: only changed tiles, unless the range changed. Returns the table to fetch from:
   `field` itself for double and float, else one owned by `rounded`, valid until the next call.
     half   nearest binary16, ties to even; beyond 65504 the largest
     16bit  low + round((F - low) / (high - low) M) (high - low) / M with M = 65535 and the table's least
     8bit   and largest height; M = 255. A table of one height stays as it is
   low, high: of the table. NULL and an error if there is no memory. */
const WrField *wr_quantized_heights_update(WrQuantizedHeights *rounded, const WrField *field,
                                           WrHeights format, float low, float high, WrError *err);
void wr_quantized_heights_drop(WrQuantizedHeights *rounded);
