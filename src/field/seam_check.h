/* seam_check.h - seam test of a table: height, slope and second difference across its edges, compared with
   the lines inside.

   It reads only texels; the smoothness of an interpolation scheme is measured by the certificate below.

   A line lies between two neighbouring columns (rows). With texels t0 t1 | t2 t3 across it, three
   differences are computed at each position along it:

     WR_SEAM_STEP    t2 - t1                       the height
     WR_SEAM_SLOPE   (t3 - t2) - (t1 - t0)         the slope
     WR_SEAM_BEND    t3 - 3 t2 + 3 t1 - t0         the second difference

   Three means of their sizes describe a line: the squared mean of roots, which is large only if most of
   the line differs, so that a few sharp veins inside do not hide a seam; the root mean square; the
   largest. Each mean of the edge is divided by the largest of the same mean of all lines inside. The
   largest quotient is the ratio of that difference. Above `limit` the pattern breaks there:
   WR_SEAM_CLEARLY, and more if there are few lines inside, whose maximum is less reliable.

   Source: measured with 62 cells of the generators, plain and torn. No ratio of a seamless cell is
   above 1.2. */
#pragma once
#include "field/scheme.h"

#include <stdbool.h>

typedef struct WrField WrField;
typedef struct WrText WrText;

enum { WR_SEAM_STEP, WR_SEAM_SLOPE, WR_SEAM_BEND, WR_SEAM_DIFFERENCES };

#define WR_SEAM_CLEARLY 1.5 /* times the largest value inside */
/* Divided by the number of lines inside and added to the limit. Without it 15 of 320 seamless noise
 * tables, 8 to 16 texels wide, showed a seam, of wider ones none; with it none. */
#define WR_SEAM_FEW 5.0
#define WR_SEAM_MIN 8 /* minimum texels of an axis: shorter ones are not measured */

/* One pair of edges. In table units; slopes and bends per texel and per its square. */
typedef struct WrSeamEdge {
    bool ends;     /* the axis does not repeat; its two ends are compared anyway */
    bool measured; /* false: too few texels; the other members are 0 and the order is 2 */
    double across[WR_SEAM_DIFFERENCES]; /* the mean with the largest quotient, at the edge */
    double inside[WR_SEAM_DIFFERENCES]; /* the same mean at the line inside where it is largest */
    double ratio[WR_SEAM_DIFFERENCES];
    double limit; /* ratios above it are breaks */
    double rank; /* fraction of the lines inside with a smaller second difference, root mean square;
                    0..1 */
    bool repeats; /* the last line repeats the first one, on ground that is not level there */
    int order; /* -1: the height steps; 0: only the slope breaks, or a line is duplicated; 1: only
                  the second difference jumps, by less than slopes change inside; 2: the edge is
                  like the lines inside */
} WrSeamEdge;

typedef struct WrSeam {
    WrSeamEdge u; /* right edge against left edge */
    WrSeamEdge v; /* bottom against top */
} WrSeam;

/* Measurement of a table. All 0: one cell of floats. */
typedef struct WrSeamOptions {
    int copies
        [2]; /* copies of the cell in the table, side by side in u and in v; 0: 1. The edges of the
                first copy are measured, against their neighbours, and against the lines inside that
                copy: so a half-drop (2 in u) is judged as it is laid */
    int shift
        [2]; /* offset of the neighbour along the edge in texels, if it is not part of the table: v
                of the u edge (a half-drop of a single cell: half its height), u of the v edge */
    double noise; /* distance of two neighbouring quantization levels, in table units; 0: floats */
} WrSeamOptions;

#define WR_SEAM_LOOKS                                                                              \
    512 /* maximum number of lines inside, and of positions along each; edges are measured
           completely */

/* options: NULL for all 0. */
WrSeam wr_seam_measure(const WrField *field, const WrSeamOptions *options);
/* The difference that determines an edge's order; for order 2 the larger of step and slope. */
int wr_seam_worst(const WrSeamEdge *edge);
/* True if the pattern shows a seam: its order is below 1. */
bool wr_seam_shows(const WrSeamEdge *edge);
/* "height differs by 0.31 across the edge, by 0.05 across the worst line inside: 6.1 times" */
void wr_seam_text(const WrSeamEdge *edge, WrText *text);

/* ---- seam certificate of a cell ---- */

/* The smoothness of F across its edges, for the pattern and for the scheme. The pattern is judged by its texels,
   as above: a photograph that does not tile has no smoothness there, whatever the scheme. If the pattern
   tiles, the scheme determines the smoothness of the join. The certificate's class is the lower one of both. The
   scheme is measured between the centres of the last and the first texel, ends included. This interval contains
   the edge and the scheme's own joints on both sides of it, at every texel's centre (for `nearest` only the edge).
   On an axis that repeats, the edge lies within a piece of the scheme, so only `nearest` jumps there; the joints
   are those of the scheme. With the texels T before, at and after a joint the jumps are bilinear            F'  T1
   - 2 T0 + T-1, per texel central             F'' (T2 - 2 T1 + 2 T-1 - T-2) / 2: of its own slopes; F itself is
   bilinear catmull             F'' -(T2 - 2 T1 + 2 T-1 - T-2) bspline, fit        none up to F'' On an axis that
   ends, the two ends are placed side by side, as another program repeats the cell. A formula is one piece, from
   edge to edge. The result is the largest jump along the edge, sampled at the texels' centres. Between them the
   jumps of a spline are not larger, those of catmull at most 1.25 times as large, which is included. */

typedef struct WrAnalytic WrAnalytic;

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
int wr_certificate_continuity(const WrCertificate *certificate);
const char *wr_certificate_word(int order); /* "none", "C0", "C1", "C2" */
/* "seam C1, F'' jumps by up to 12.3". If the edges differ: "seam C2 in u; in v none, F jumps by up to
   0.3, the axis ends". If the pattern does not tile: "seam none, height differs by 0.31 across the
   edge, by 0.05 ...". */
void wr_certificate_text(const WrCertificate *certificate, WrText *text);
