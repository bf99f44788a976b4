/* height_copies.h - contiguous copies of a height table for the kernels, kept up to date from what changed
   between the snapshot they were made from and the one at hand.
   Layer 5, private to the renderer. Each copy has an apron of WR_APRON texels (so no kernel wraps an
   index) and a row length off the powers of two. */
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
    WR_COPY_GRADIENT, /* central differences per unit of u, v; two floats a texel */
    WR_COPY_COUNT
} WrCopyKind;

typedef struct WrTableCopy {
    WrField *seen; /* snapshot that data was made from; NULL: none */
    WrPrecision precision;
    float *data;  /* owned; SINGLE only */
    double *fine; /* owned; the others */
    int pitch;    /* texels a row */
} WrTableCopy;

typedef struct WrTable {
    WrPrecision precision; /* of the copies to be brought; the caller's to set */
    WrTableCopy copies[WR_COPY_COUNT];
    WrField *ranged;   /* snapshot that low and high were made from */
    float *low, *high; /* [tiles] of each field tile */
    float (*steep)
        [2]; /* [tiles] the gradient copy's largest |dF/du|, |dF/dv| there; INFINITY: not known */
    float steepest[2], gentlest[2]; /* of all tiles, the largest and the least of those ... */
    int sloped;                     /* ... and how many tiles have any */
    int64_t texels_refreshed;       /* by the last bring-up: what an edit cost */
} WrTable;

void wr_table_init(WrTable *table);
void wr_table_fini(WrTable *table);

/* True if every texel of the table is equal; costs what changed since the last call. */
bool wr_table_flat(WrTable *table, const WrField *field);
/* Least and largest height of the table last asked about. */
void wr_table_range(const WrTable *table, float *low, float *high);

/* Bring one copy up to date with field. */
bool wr_table_bring(WrTable *table, WrCopyKind kind, const WrField *field, WrPool *pool,
                    WrError *err);
/* Drop a copy that the plan no longer calls for. */
void wr_table_drop(WrTable *table, WrCopyKind kind);
/* After bringing the gradient: true if it is 0 everywhere. */
bool wr_table_slope_free(const WrTable *table);
