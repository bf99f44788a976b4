/* coverage.h - a stroke's coverage: pages of 64 x 64 texels beside the tiles, and the heights computed
   from them.
   Private to this module.
   Dabs only add to the coverage; the heights of all changed pages are computed later at once. The time
   has no influence, since they are computed from the heights before the stroke. */
#pragma once
#include "base/array.h"
#include "brush/mode.h"
#include "brush/footprint_scan.h"

#include <stdbool.h>

/* ---- target heights of coverage-based modes, tile by tile, from the table before the stroke ---- */

#define WR_REACH_MAX 256 /* texels */

typedef struct WrTargets {
    WrBlendTargetKind kind;
    const WrField *start, *below; /* borrowed; below may be NULL */
    float neutral;
    double shift_x, shift_y; /* texels, y down */
    int reach;               /* 1..WR_REACH_MAX */
} WrTargets;

/* Computes the targets of tile (tx, ty), row by row; out: [WR_TILE * WR_TILE]. Any number of threads. */
void wr_targets_compute_tile(const WrTargets *targets, int tx, int ty, float *out);

/* Copies count_i x count_j texels at (i, j), contiguous rows; indices wrap on periodic axes and are
 * clamped to the ends of others. */
void wr_read_box(const WrField *field, int i, int j, int count_i, int count_j, int pitch,
                 float *out);

/* ---- computation of heights from those before the stroke and its coverage ---- */

typedef struct WrStrokeResolver {
    WrBrushGround ground; /* borrowed */
    WrBrush brush;        /* sane */
    WrField *start;       /* the table before the stroke; owned */
    WrField *mark_start;  /* the mark before the stroke, if erasing lowers it; owned, or NULL */
    const WrModeWork *work;
    WrModeArgs args;
    WrTargets targets;
} WrStrokeResolver;

void wr_stroke_resolver_init(WrStrokeResolver *maker, const WrBrushGround *ground,
                             const WrBrush *brush);
void wr_stroke_resolver_fini(WrStrokeResolver *maker);
/* Sets flatten's height: that of the texel at (x, y), before the stroke. */
void wr_stroke_resolver_set_flatten_height(WrStrokeResolver *maker, double x, double y);

/* A rectangle of one tile's texels. */
typedef struct WrStrokeResolve {
    int tx, ty;
    int low_y, high_y;                  /* rows in the tile */
    int low_x, count;                   /* columns in the tile: whole blocks */
    const float *cover, *rest, *target; /* of the tile; rest and target may be NULL */
    bool within_1;                      /* no coverage is above 1 */
    struct WrFieldPlace *out, *mark;    /* places of the tile; for wr_stroke_resolve */
} WrStrokeResolve;

/* True if any texel of it may change, judging by coverage and selection. */
bool wr_stroke_resolve_needed(const WrStrokeResolver *maker, const WrStrokeResolve *make);
/* Sets out and mark. Not for several threads at once. */
void wr_stroke_resolve_open(const WrStrokeResolver *maker, WrStrokeResolve *make);
/* Any number of threads, on different tiles. */
void wr_stroke_resolve(const WrStrokeResolver *maker, const WrStrokeResolve *make);

typedef enum WrCoverageRule {
    WR_COVERAGE_MAX,
    WR_COVERAGE_OVER, /* 1 - (1 - A) (1 - a) */
    WR_COVERAGE_SUM
} WrCoverageRule;

typedef struct WrPage {
    /* a tile (wr_field_tile_make), owned; texels beyond the table's edge stay 0; NULL: all are 0 */
    float *cover;
    float *rest;   /* for sums: rounding errors; owned, or NULL */
    float *target; /* owned, or NULL */
    int tx, ty;
    float least; /* lower bound of `cover`, for WR_COVERAGE_MAX */
    bool listed; /* member of cover->changed */
    /* changed since the last resolve; high_x <= low_x: nothing; columns before high_x, rows up to
     * high_y */
    int low_x, high_x, low_y, high_y;
} WrPage;

typedef struct WrCoverage {
    WrStrokeResolver maker;
    WrCoverageRule rule;
    int tiles_u;
    double strongest; /* upper bound of the shapes being added; infinite between shapes */
    WrPage **pages;   /* [tiles]; NULL: no coverage; owned */
    WR_ARRAY(WrPage *) made, changed;
    WR_ARRAY(WrDabShape) waiting;    /* large shapes that are added together, for WR_COVERAGE_MAX */
    WR_ARRAY(WrStrokeResolve) makes; /* scratch */
} WrCoverage;

void wr_coverage_init(WrCoverage *cover, const WrBrushGround *ground, const WrBrush *brush,
                      WrCoverageRule rule);
void wr_coverage_fini(WrCoverage *cover);
void wr_coverage_add(WrCoverage *cover, const WrDabShape *shape);
/* Replaces the target of a texel that has no coverage yet, which then keeps it. The mode has targets. */
void wr_coverage_set_target(WrCoverage *cover, int x, int y, float target);
/* Adds coverage c > 0 to one texel of the table. */
void wr_coverage_add_texel(WrCoverage *cover, int x, int y, float c);
/* Computes the heights of changed pages until that time of the clock (HUGE_VAL: all), at least a few
 * tiles. True if some are left. */
bool wr_coverage_make(WrCoverage *cover, double until);
/* The targets of a tile, computed on first use; NULL if the mode has none. */
const float *wr_coverage_target(WrCoverage *cover, int tx, int ty);
