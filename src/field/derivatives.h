/* derivatives.h - the slopes and bends of a table's relief over a cell, at the texels' centres.

   Every scheme's are a fixed stencil of table entries there (of coefficients for the splines), so that no position is
   rounded: a table that is moved by whole texels over its periodic axes gives the moved numbers, to the bit. */
#pragma once
#include "field/scheme.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct WrAnalytic WrAnalytic;
typedef struct WrField WrField;

/* Heights times `height` over a cell of that size: scene units. */
typedef struct WrDerivatives {
    const WrField *field;
    const WrAnalytic *formula; /* in the table's place; NULL: none */
    WrScheme scheme;
    double height, cell_w, cell_h;
} WrDerivatives;

/* A rectangle of texels inside the table; rows of what is made of it are `pitch` numbers apart. */
typedef struct WrMapPart {
    int x, y, w, h;
    size_t pitch;
} WrMapPart;

/* Of a row of texels, y up: slopes, and second derivatives as differences of the scheme's slopes across a texel, that is
 * their means over it. r, s and t are NULL where they are not wanted. */
typedef struct WrDerivativesRow {
    double *p, *q;     /* dz/dx, dz/dy */
    double *r, *s, *t; /* d2z/dx2, d2z/dxdy, d2z/dy2 */
} WrDerivativesRow;

/* Rows of all widths' numbers, to be freed as a whole. bends: r, s and t too. */
WrDerivativesRow wr_derivatives_row_new(int count, bool bends);
void wr_derivatives_row_free(WrDerivativesRow *row);

/* Some rows under way: what they need of the table is read, and fitted, once. */
typedef struct WrDerivativesBand WrDerivativesBand;
WrDerivativesBand *wr_derivatives_open(const WrDerivatives *ground, int x, int y, int w, int rows);
void wr_derivatives_close(WrDerivativesBand *band);
/* The band's row j, 0..rows-1. */
void wr_derivatives_row(const WrDerivativesBand *band, int j, const WrDerivativesRow *out);

/* `count` texels of row j from column i on, outside the table too: beyond a clamped axis its edge. */
void wr_derivatives_read_held(const WrField *field, int i, int j, int count, float *out);

/* Minus the mean curvature, so that what is convex, ridges, is above 0:
 *   ((1 + q^2) r - 2 p q s + (1 + p^2) t) / (-2 (1 + p^2 + q^2)^(3/2)) */
double wr_derivatives_convexity(double p, double q, double r, double s, double t);
