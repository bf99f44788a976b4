/* certificate.h - seam certificate of a cell: how smoothly F goes on where its edges meet, by the pattern and by the scheme.

   The pattern is judged by its texels (field/seam.h): a photograph that is torn at its edge has no smoothness there,
   whatever the scheme. Of a pattern that meets, the scheme says how smooth the join is. The certificate's class is the
   lower one of both.

   Of the scheme is measured the stretch between the last texel's centre and the first one's, its ends counted in: there stand
   the edge itself and the scheme's own joints on both sides of it, at every texel's centre (of `nearest` the edge alone).
   On an axis that repeats, the edge lies within a piece of the scheme, so nothing jumps there but `nearest`; the joints
   are the scheme's: of T before, at and after one
     bilinear            F'  T1 - 2 T0 + T-1, per texel
     central             F'' (T2 - 2 T1 + 2 T-1 - T-2) / 2: of its own slopes, which F, that is bilinear's, has not
     catmull             F'' -(T2 - 2 T1 + 2 T-1 - T-2)
     bspline, fit        nothing up to F''
   On one that ends, the two ends are laid side by side, as a cell that is repeated by another program has them. A formula
   is one piece, from edge to edge.

   Jumps are the largest along the edge, taken at texels' centres. Between them a spline's are no larger, those of
   catmull at most 1.25 times as large, which is counted in. */
#pragma once
#include "field/scheme.h"
#include "field/seam.h"

#include <stdbool.h>

typedef struct WrAnalytic WrAnalytic;
typedef struct WrText WrText;

#define WR_CERTIFICATE_ORDERS 3 /* F, and its first and second derivative across the edge */

typedef struct WrCertificateEdge {
    bool ends;                          /* the axis does not repeat */
    double jump[WR_CERTIFICATE_ORDERS]; /* |.|, in table units, per unit of u (v), per its square */
    int order; /* -1: F itself jumps; 0: C0, 1: C1, 2: C2. What rounding leaves is no jump */
} WrCertificateEdge;

typedef struct WrCertificate {
    WrCertificateEdge u; /* where the right edge meets the left one */
    WrCertificateEdge v; /* where the bottom meets the top */
    WrSeam pattern;      /* of a formula the exact orders alone */
} WrCertificate;

/* seam: how the pattern is measured; NULL: one cell of floats. */
WrCertificate wr_certificate_table(const WrField *field, WrScheme scheme,
                                   const WrSeamOptions *seam);
WrCertificate wr_certificate_formula(const WrAnalytic *analytic);
/* Of both edges, scheme and pattern: the lowest. */
int wr_certificate_order(const WrCertificate *certificate);
const char *wr_certificate_word(int order); /* "none", "C0", "C1", "C2" */
/* "seam C1, F'' jumps by up to 12.3"; of edges that differ each: "seam C2 in u; in v none, F jumps by up to 0.3, the
   axis ends". Of a torn pattern "seam none, height differs by 0.31 across the edge, by 0.05 ...". */
void wr_certificate_text(const WrCertificate *certificate, WrText *text);
