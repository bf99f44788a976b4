/* certificate.h - seam certificate of a cell: the smoothness of F across its edges, for the pattern and
   for the scheme.

   The pattern is judged by its texels (field/seam.h): a photograph that does not tile has no smoothness
   there, whatever the scheme. If the pattern tiles, the scheme determines the smoothness of the join.
   The certificate's class is the lower one of both.

   The scheme is measured between the centres of the last and the first texel, ends included. This
   interval contains the edge and the scheme's own joints on both sides of it, at every texel's centre
   (for `nearest` only the edge). On an axis that repeats, the edge lies within a piece of the scheme,
   so only `nearest` jumps there; the joints are those of the scheme. With the texels T before, at and
   after a joint the jumps are

     bilinear            F'  T1 - 2 T0 + T-1, per texel
     central             F'' (T2 - 2 T1 + 2 T-1 - T-2) / 2: of its own slopes; F itself is bilinear
     catmull             F'' -(T2 - 2 T1 + 2 T-1 - T-2)
     bspline, fit        none up to F''

   On an axis that ends, the two ends are placed side by side, as another program repeats the cell. A
   formula is one piece, from edge to edge.

   The result is the largest jump along the edge, sampled at the texels' centres. Between them the jumps
   of a spline are not larger, those of catmull at most 1.25 times as large, which is included. */
#pragma once
#include "field/scheme.h"
#include "field/seam.h"

#include <stdbool.h>

typedef struct WrAnalytic WrAnalytic;
typedef struct WrText WrText;

#define WR_CERTIFICATE_ORDERS 3 /* F, and its first and second derivative across the edge */

typedef struct WrCertificateEdge {
    bool ends; /* the axis does not repeat */
    /* absolute value, in table units, per unit of u (v), per its square */
    double jump[WR_CERTIFICATE_ORDERS];
    int order; /* -1: F itself jumps; 0: C0, 1: C1, 2: C2. Rounding errors are no jumps */
} WrCertificateEdge;

typedef struct WrCertificate {
    WrCertificateEdge u; /* right edge against left edge */
    WrCertificateEdge v; /* bottom against top */
    WrSeam pattern;      /* for a formula only the exact orders */
} WrCertificate;

/* seam: measurement of the pattern; NULL: one cell of floats. */
WrCertificate wr_certificate_table(const WrField *field, WrScheme scheme,
                                   const WrSeamOptions *seam);
WrCertificate wr_certificate_formula(const WrAnalytic *analytic);
/* The lowest order of both edges, for scheme and pattern. */
int wr_certificate_order(const WrCertificate *certificate);
const char *wr_certificate_word(int order); /* "none", "C0", "C1", "C2" */
/* "seam C1, F'' jumps by up to 12.3". If the edges differ: "seam C2 in u; in v none, F jumps by up to
   0.3, the axis ends". If the pattern does not tile: "seam none, height differs by 0.31 across the
   edge, by 0.05 ...". */
void wr_certificate_text(const WrCertificate *certificate, WrText *text);
