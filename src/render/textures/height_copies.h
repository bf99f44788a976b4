/* height_copies.h - contiguous copies of a height table for the kernels, updated incrementally. Private to the
   renderer. An update compares the snapshot that a copy was made from with the current table. Each copy has an
   apron of WR_APRON texels, so no kernel wraps an index, and a row length that is not a power of two. */
#pragma once
#include "render/kernels/kern.h"
#include "render/plan/plan.h"

#include <stdbool.h>
#include <stdint.h>

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
