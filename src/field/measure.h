/* measure.h - measures of a table's surface, as tables of its size and wrap, and joins of masks.

   wr_select_height turns a measure into a mask. Slopes are central differences of heights times `relief`, the height
   of one table unit in texels. Functions return a new table, owned by the caller; NULL and an error when out of
   memory or cancelled. pool NULL: this thread only. The bits are the same on every processor and for any number of
   threads; if the table is rolled by whole texels, so is the measure, bit for bit. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;

/* `scale` times minus the mean curvature, per texel, of the heights blurred by a Gaussian of sigma `scale`: above 0
 * on ridges and edges, below 0 in grooves. A flat table has 0 everywhere. scale: above 0, texels */
WrField *wr_measure_convexity(const WrField *field, double relief, double scale, WrPool *pool,
                              WrError *err);
/* Visible part of the sky, 0..1 (occlusion.h, 16 directions). reach: 1..WR_OCCLUSION_FARTHEST texels */
WrField *wr_measure_sky(const WrField *field, double relief, int reach, WrPool *pool, WrError *err);

/* Ways of joining a table b to a: */
typedef enum WrJoin {
    WR_JOIN_MULTIPLY, /* a b */
    WR_JOIN_SUBTRACT, /* max(0, a - b) */
    WR_JOIN_MAX,      /* max(a, b) */
    WR_JOIN_ADD       /* a + b */
} WrJoin;
WrField *wr_measure_join(const WrField *a, const WrField *b, WrJoin join, WrPool *pool,
                         WrError *err);
