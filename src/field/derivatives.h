/* derivatives.h - slopes and second derivatives of a height table at the texels' centres.

   For every scheme they are a fixed stencil of table entries (for splines, of coefficients), so no
   position is rounded: a table shifted by whole texels along its periodic axes produces the shifted
   result, to the bit. */
#pragma once
#include "field/scheme.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct WrAnalytic WrAnalytic;
typedef struct WrField WrField;

/* Heights times `height` over a cell of that size, in scene units. */
typedef struct WrDerivatives {
    const WrField *field;
    const WrAnalytic *formula; /* used instead of the table; NULL: none */
    WrScheme scheme;
    double height, cell_w, cell_h;
} WrDerivatives;

/* A rectangle of texels inside the table; rows of the output are `pitch` numbers apart. */
typedef struct WrMapPart {
    int x, y, w, h;
    size_t pitch;
} WrMapPart;

/* Derivatives of a row of texels, y up: slopes, and second derivatives as differences of the scheme's
 * slopes across a texel, that is their means over it. r, s and t are NULL if not wanted. */
typedef struct WrDerivativesRow {
    double *p, *q;     /* dz/dx, dz/dy */
    double *r, *s, *t; /* d2z/dx2, d2z/dxdy, d2z/dy2 */
} WrDerivativesRow;

/* Allocates all rows of one struct. bends: r, s and t too. */
WrDerivativesRow wr_derivatives_row_new(int count, bool bends);
void wr_derivatives_row_free(WrDerivativesRow *row);

/* A band of rows in progress: the table entries that it needs are read, and fitted, once. */
typedef struct WrDerivativesBand WrDerivativesBand;
WrDerivativesBand *wr_derivatives_open(const WrDerivatives *ground, int x, int y, int w, int rows);
void wr_derivatives_close(WrDerivativesBand *band);
/* The band's row j, 0..rows-1. */
void wr_derivatives_row(const WrDerivativesBand *band, int j, const WrDerivativesRow *out);

/* Reads `count` texels of row j from column i on, also outside the table: a clamped axis repeats its
 * edge texel. */
void wr_derivatives_read_clamped(const WrField *field, int i, int j, int count, float *out);

/* Minus the mean curvature, so that convex places (ridges) are positive:
 *    ((1 + q^2) r - 2 p q s + (1 + p^2) t) / (-2 (1 + p^2 + q^2)^(3/2)) */
double wr_derivatives_convexity(double p, double q, double r, double s, double t);
