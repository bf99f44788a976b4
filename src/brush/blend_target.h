/* blend_target.h - target heights of coverage-based modes, tile by tile, from the table before the
   stroke.
   Private to this module. */
#pragma once
#include "brush/mode.h"

#define WR_REACH_MAX 256 /* texels */

typedef struct WrTargets {
    WrBlendTargetKind kind;
    const WrField *start, *below; /* borrowed; below may be NULL */
    float neutral;
    double shift_x, shift_y; /* texels, y down */
    int reach;               /* 1..WR_REACH_MAX */
} WrTargets;

/* brush from wr_brush_sane. */
WrTargets wr_targets(const WrBrushGround *ground, const WrField *start, const WrBrush *brush);
/* Computes the targets of tile (tx, ty), row by row; out: [WR_TILE * WR_TILE]. Any number of threads. */
void wr_blend_target_tile(const WrTargets *targets, int tx, int ty, float *out);

/* Copies count_i x count_j texels at (i, j), contiguous rows; indices wrap on periodic axes and are
 * clamped to the ends of others. */
void wr_read_box(const WrField *field, int i, int j, int count_i, int count_j, int pitch,
                 float *out);
