/* scheme.h - interpolation schemes: F and its derivatives from table entries, the first axis of the
   accuracy benchmark.

   | scheme      | value                | derivative                             | order F, Fu | continuity |
   | nearest     | the texel            | central difference at that texel       | 1, 1        | none       |
   | bilinear    | bilinear             | of the bilinear interpolant (creases)  | 2, 1        | C0         |
   | central     | bilinear             | the paper's central difference, E = one texel, of the bilinear
   |             |                      | interpolant                            | 2, 2        | C0 slope   |
   | bspline     | uniform cubic B-spline, table entries as coefficients, analytic | 2, 2 | C2        |
   | bspline-fit | bspline through the samples (circular prefilter, 28 taps a side, double) | 4, 3 | C2 |
   | catmull     | Catmull-Rom, interpolating, analytic          | 3, 2            | C1         |

   With x = W u - 1/2 and y = H (1 - v) - 1/2 the taps are floor(x), floor(x) + 1 and so on. Rows run
   down, so dF/dv has a minus sign. Derivatives are formed from differences of taps, so that a flat
   table yields exactly 0 at any level (HC42-HC48). */
#pragma once
#include <stddef.h>

typedef struct WrField WrField;

/* A WrSchemeId of field/scheme_list.h; 0 <= scheme < wr_scheme_count. An int, because many files
   include this header and few need the list. */
typedef int WrScheme;

/* Input of a scheme. */
typedef enum WrSchemeTaps {
    WR_TAPS_TABLE,   /* table entries, from floor(x) - 1 to floor(x) + 2 */
    WR_TAPS_CENTRED, /* table entries, from one before to two after the texel that holds the point */
    WR_TAPS_FITTED /* wr_field_read_bspline_coefficients's coefficients, from floor(x) - 1 to floor(x) + 2 */
} WrSchemeTaps;

/* Evaluates the scheme: taps[16], 4 rows of 4 from the top; a, b in 0..1 the position to the right of
 * column 1 and below row 1; out: F and its slopes to the right and downwards, per texel. In double,
 * because spline coefficients rounded to single precision would lose the slopes of a table at a high
 * level. */
typedef void (*WrSchemeEval)(const double *taps, double a, double b, double out[3]);

typedef struct WrSchemeInfo {
    const char *name;      /* as in commands: "bspline-fit" */
    const char *label;     /* for people: "cubic B-spline through the samples" */
    const char *title;     /* in lists of the window: "B-spline, fitted" */
    const char *help;      /* one sentence */
    int order_f, order_fu; /* of convergence in the texel's size, for smooth F */
    int reach; /* distance in texels up to which an edited texel changes F or its slopes, including
                  the extrapolated ends of a clamped axis */
    WrSchemeTaps taps;
    WrSchemeEval eval;
} WrSchemeInfo;

extern const WrSchemeInfo wr_schemes[]; /* [wr_scheme_count] */
extern const int wr_scheme_count;
/* The scheme of that name, or -1. */
int wr_scheme_find(const char *name);

/* F and its derivatives at many points of the table itself (no height, no replication).
 *
 *   f[i] = F(u[i], v[i])   fu[i] = dF/du   fv[i] = dF/dv
 *
 * u, v     [count] any value; reduced to [0,1) on a periodic axis; on a clamped one F is constant
 *          outside [0,1] and its slope 0 there
 * f        [count] heights in table units; may be NULL
 * fu, fv   [count] table units per unit of u (v); may be NULL
 * Errors   none      Threads  any number of readers
 * Source   Blinn 1978 section 3 (FVAL, FU, FV; the printed F01 and the IFIX of negative arguments are
 *          corrected: floor, and a modulus on both corner indices) */
void wr_field_sample(const WrField *field, WrScheme scheme, size_t count, const double *u,
                     const double *v, double *f, double *fu, double *fv);

/* The paper's formula to the letter, for the historical rung of the accuracy benchmark and for tests: four bilinear
 * look-ups, FU = (FVAL(U + E, V) - FVAL(U - E, V)) / (2 E) with E = 1/W, FV with 1/H. Equals `central`
 * to rounding, except within 1.5 texels of the ends of a clamped axis, where FVAL is constant outside.
 * Either output may be NULL. */
void wr_field_sample_blinn(const WrField *field, double u, double v, double *fu, double *fv);

/* Cubic B-spline coefficients whose spline passes through the table's samples: one axis at a time, c_i
 * = sum over |k| <= 28 of sqrt(3) (sqrt(3) - 2)^|k| T_(i+k), summed in double in a fixed order.
 * Rectangle and pitch as in wr_field_read (indices outside wrap or are extrapolated). A coefficient has
 * the same bits in every rectangle. About 30 ns per texel for large rectangles. */
#define WR_PREFILTER_REACH 28
void wr_field_read_bspline_coefficients(const WrField *field, int i, int j, int count_i,
                                        int count_j, float *out, size_t pitch);
/* wr_field_read_bspline_coefficients without rounding to single precision. */
void wr_field_read_bspline_coefficients_double(const WrField *field, int i, int j, int count_i,
                                               int count_j, double *out, size_t pitch);
