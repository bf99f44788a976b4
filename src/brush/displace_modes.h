/* displace_modes.h - dabs that change the heights that they find.
   Private to this module.
   A dab's box is copied out, changed and written back. It takes about 16 bytes a texel; where there is no
   memory for that the dab does nothing. */
#pragma once
#include "brush/coverage.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct WrMoveBox {
    int width, height, pitch; /* texels; pitch: floats a row, whole blocks */
    bool wraps_x, wraps_y;    /* the box is the table's whole period: its sides meet */
    double x, y, dx, dy;      /* centre and way from the dab before, in the box's texels, y down */
    double radius;
    int reach;
    const float *weights; /* [height][pitch] how much of the dab counts: 0..1; 0 in the margin */
    float *heights;       /* [height][pitch] before; after, if fresh is not written */
    float *fresh;         /* [height][pitch] for what comes out; a mode swaps the two */
    float *spare;         /* rows: 6 (pitch + 2 WR_REACH_MAX) floats */
    const WrBrushKernels *kernels;
} WrMoveBox;

void wr_move_smooth(WrMoveBox *box);
void wr_move_level(WrMoveBox *box);
void wr_move_pinch(WrMoveBox *box);
void wr_move_smear(WrMoveBox *box);
/* Texels beside the dab that pinch and smear read. */
double wr_move_pinch_margin(double radius, double way_x, double way_y);
double wr_move_smear_margin(double radius, double way_x, double way_y);

/* The scratch memory of a stroke. */
typedef struct WrMover {
    float *memory; /* owned */
    size_t size;   /* floats */
} WrMover;

void wr_mover_fini(WrMover *mover);

/* Put one dab's shape down; the maker in `cover` tells ground, mode and arguments. way_x, way_y: from the
 * dab before. drag, dragged: as in WrDab. */
void wr_move_dab(WrMover *mover, WrCoverage *cover, const WrDabShape *shape, double radius,
                 double way_x, double way_y, double drag, double dragged);
/* The mean height under a disc. */
double wr_move_height(const WrField *field, double x, double y, double radius);
