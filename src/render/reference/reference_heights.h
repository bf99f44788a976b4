/* reference_heights.h - F for the reference: cubic B-spline through the table's samples, in double. Private to
   the reference. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;
typedef struct WrScene WrScene;

typedef struct WrReferenceTable {
    int width, height; /* texels */
    bool periodic_u, periodic_v;
    /* subtracted from all texels first, so that a flat table has a slope of exactly 0 */
    double base;
    double *c;    /* [height + 4][width + 4] coefficients of F - base, two beyond each end; owned */
    size_t pitch; /* width + 4 */
} WrReferenceTable;

/* Computes the coefficients: (c[i-1] + 4 c[i] + c[i+1]) / 6 = T[i] on each axis. Missing texels of a clamped
   axis are on the quadratic through the three at its end (the end repeated if there are fewer). Errors: no
   memory. Same bits for any number of threads. */
bool wr_reference_table_init(WrReferenceTable *table, const WrField *field, WrPool *pool,
                             WrError *err);
void wr_reference_table_fini(WrReferenceTable *table); /* also for a zeroed one */

/* F and its derivatives at (u, v) of the patch, height and replication included, as in wr_scene_height; beyond
   the ends of a clamped axis F is constant and its slope 0. A table without coefficients yields 0. */
void wr_reference_table_at(const WrReferenceTable *table, const WrScene *scene, double u, double v,
                           double *f, double *fu, double *fv);
