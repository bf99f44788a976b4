/* coverage.h - a stroke's coverage: pages of 64 x 64 texels beside the tiles, and the heights computed
   from them.
   Private to this module.
   Dabs only add to the coverage; the heights of all changed pages are computed later at once. The time
   has no influence, since they are computed from the heights before the stroke. */
#pragma once
#include "base/array.h"
#include "brush/stroke_resolve.h"
#include "brush/scan_convert.h"

#include <stdbool.h>

typedef enum WrCoverageRule {
    WR_COVERAGE_MAX,
    WR_COVERAGE_OVER, /* 1 - (1 - A) (1 - a) */
    WR_COVERAGE_SUM
} WrCoverageRule;

typedef struct WrPage {
    float cover[WR_TILE * WR_TILE]; /* unused texels of the last tiles stay 0 */
    float *rest;                    /* for sums: rounding errors; owned, or NULL */
    float *target;                  /* owned, or NULL */
    int tx, ty;
    bool listed; /* member of cover->changed */
    /* changed since the last resolve; high_x <= low_x: nothing; columns before high_x, rows up to
     * high_y */
    int low_x, high_x, low_y, high_y;
} WrPage;

typedef struct WrCoverage {
    WrMaker maker;
    WrCoverageRule rule;
    int tiles_u;
    WrPage **pages; /* [tiles]; NULL: no coverage; owned */
    WR_ARRAY(WrPage *) made, changed;
    WR_ARRAY(WrStrokeResolve) makes; /* scratch */
} WrCoverage;

void wr_coverage_init(WrCoverage *cover, const WrBrushGround *ground, const WrBrush *brush,
                      WrCoverageRule rule);
void wr_coverage_fini(WrCoverage *cover);
void wr_coverage_add(WrCoverage *cover, const WrDabShape *shape);
/* Computes the heights of changed pages until that time of the clock (HUGE_VAL: all), at least a few
 * tiles. True if some are left. */
bool wr_coverage_make(WrCoverage *cover, double until);
/* The targets of a tile, computed on first use; NULL if the mode has none. */
const float *wr_coverage_target(WrCoverage *cover, int tx, int ty);
