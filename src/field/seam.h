/* seam.h - does a table go on smoothly where its edges meet?
   Layer 1. Of the texels alone; what a scheme makes of them over the edge is the certificate's affair
   (field/certificate.h). */
#pragma once
#include <stdbool.h>

typedef struct WrField WrField;

/* One pair of edges. Jump: how much more two texels differ across the edge than the slopes on both sides
 * lead one to expect, a step in the height. Crease: how much the slope changes over the edge. Both are root
 * mean squares along the edge; `inside` is the largest of the same over columns (rows) within the table.
 * In table units, creases in table units a texel. */
typedef struct WrSeamEdge {
    bool wraps; /* false: the axis ends there, and nothing is measured */
    double jump, jump_inside;
    double jump_most, jump_most_inside; /* the largest single ones */
    double crease, crease_inside, crease_most, crease_most_inside;
    double rank;         /* share of the lines inside whose jump is smaller, 0..1 */
    bool jumps, creases; /* clearly more than anywhere inside */
} WrSeamEdge;

typedef struct WrSeam {
    WrSeamEdge u; /* where the right edge meets the left one */
    WrSeamEdge v; /* where the bottom meets the top */
} WrSeam;

#define WR_SEAM_CLEARLY 1.5 /* times what is found inside */

/* Looks at no more than `looks` places along an edge and so many lines inside, however large the table. Axes of
 * fewer than 4 texels have no seam to speak of. */
WrSeam wr_seam_measure(const WrField *field, int looks);
