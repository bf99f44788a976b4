/* displace_modes.h - dabs of moving modes, which modify the present heights.
   Private to this module.
   A dab's box is copied out, modified and written back. It needs about 16 bytes per texel; without
   memory the dab does nothing. */
#pragma once
#include "brush/coverage.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct WrMoveBox {
    int width, height, pitch; /* texels; pitch: floats a row, whole blocks */
    bool wraps_x, wraps_y;    /* the box is the table's whole period: opposite sides meet */
    double x, y, dx, dy;      /* centre, and vector from the previous dab, in the box's texels, y
                                 down */
    double radius;
    int reach;
    const float *weights; /* [height][pitch] weight of the dab: 0..1; 0 in the margin */
    float *heights;       /* [height][pitch] input; also the output, if fresh is not written */
    float *fresh;         /* [height][pitch] output; a mode swaps the two */
    float *spare;         /* rows: 6 (pitch + 2 WR_REACH_MAX) floats */
    const WrBrushKernels *kernels;
} WrMoveBox;

void wr_move_smooth(WrMoveBox *box);
void wr_move_level(WrMoveBox *box);
void wr_move_pinch(WrMoveBox *box);
void wr_move_smear(WrMoveBox *box);
/* Margin in texels beside the dab that pinch and smear read. */
double wr_move_pinch_margin(double radius, double way_x, double way_y);
double wr_move_smear_margin(double radius, double way_x, double way_y);

/* The scratch memory of a stroke. */
typedef struct WrMover {
    float *memory; /* owned */
    size_t size;   /* floats */
} WrMover;

void wr_mover_fini(WrMover *mover);
/* Its memory, at least so many floats, not cleared; NULL: there is none. */
float *wr_mover_reserve(WrMover *mover, size_t floats);

/* Applies one dab's shape; the maker in `cover` contains ground, mode and arguments. way_x, way_y: from
 * the previous dab. drag, dragged: as in WrDab. */
void wr_move_dab(WrMover *mover, WrCoverage *cover, const WrDabShape *shape, double radius,
                 double way_x, double way_y, double drag, double dragged);
/* Raises the mark to the weights, or lowers it by them if the mode does so. */
void wr_move_write_mark(const WrStrokeResolver *maker, const float *weights, int count,
                        float *mark);
/* The mean height under a disc. */
double wr_move_height(const WrField *field, double x, double y, double radius);
