/* height_copies.h - contiguous copies of a height table for the kernels, updated incrementally. Private to the
   renderer. An update compares the snapshot that a copy was made from with the current table. Each copy has an
   apron of WR_APRON texels, so no kernel wraps an index, and a row length that is not a power of two. */
#pragma once
#include "base/kernmath.h"
#include "render/kernels/kern.h"
#include "render/plan/plan.h"
#include "scene/dials.h"

#include <stdbool.h>
#include <stdint.h>

/* ---- minimum and maximum of an array ---- */

/* Extends *low and *high by `count` numbers; NaNs are ignored. */
static inline void wr_extent_add(const float *restrict x, int count, float *low, float *high)
{
    float least = *low, most = *high;
#pragma omp simd reduction(min : least) reduction(max : most)
    for (int i = 0; i < count; i++) {
        least = x[i] < least ? x[i] : least;
        most = x[i] > most ? x[i] : most;
    }
    *low = least, *high = most;
}

/* ---- height table rounded to a storage format of fewer bits: half precision, or integers over the table's own range ---- */

/* The rounded heights are stored in single precision again: this measures the error of the format; memory and time are those of single precision. */

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

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;

typedef enum WrCopyKind {
    WR_COPY_HEIGHTS,  /* F */
    WR_COPY_FITTED,   /* B-spline coefficients through F */
    WR_COPY_GRADIENT, /* central differences per unit of u, v; two floats per texel */
    WR_COPY_COUNT
} WrCopyKind;

typedef struct WrTableCopy {
    WrField *seen; /* snapshot that data was made from; NULL: none */
    WrPrecision precision;
    float *data;  /* owned; only for SINGLE */
    double *fine; /* owned; for the other precisions */
    int pitch;    /* texels per row */
    bool sparse;  /* in small pages, because most of the table was empty */
} WrTableCopy;

typedef struct WrTable {
    WrPrecision precision; /* of the copies to be updated; set by the caller */
    WrTableCopy copies[WR_COPY_COUNT];
    WrField *ranged;   /* snapshot that low and high were computed from */
    float *low, *high; /* [tiles] of each field tile */
    float (*steep)
        [2]; /* [tiles] largest |dF/du|, |dF/dv| of the gradient copy in each tile; INFINITY: unknown */
    float steepest[2], gentlest[2]; /* largest and smallest of those over all tiles ... */
    int sloped;                     /* ... and the number of tiles with slopes */
    int64_t texels_refreshed;       /* by the last update: the cost of an edit */
} WrTable;

void wr_table_init(WrTable *table);
void wr_table_fini(WrTable *table);

/* True if all texels of the table are equal. Its cost depends only on the changes since the last call. */
bool wr_table_flat(WrTable *table, const WrField *field);
/* Smallest and largest height of the table of the last wr_table_flat call. */
void wr_table_range(const WrTable *table, float *low, float *high);

/* Updates one copy to the field. */
bool wr_table_update(WrTable *table, WrCopyKind kind, const WrField *field, WrPool *pool,
                     WrError *err);
/* Frees a copy that the plan no longer needs. */
void wr_table_drop(WrTable *table, WrCopyKind kind);
/* True if the gradient, which must be up to date, is 0 everywhere. */
bool wr_table_slope_free(const WrTable *table);
