/* Interpolation schemes, and the prefilter of the B-spline. */
#include "field/scheme.h"

#include "base/enum_rows.h"
#include "base/memory.h"
#include "field/field.h"
#include "field/scheme_list.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <string.h>

/* ---- the prefilter of the B-spline ---- */

/* The interpolating prefilter of the uniform cubic B-spline.
 *
 * The spline has the value (c[i-1] + 4 c[i] + c[i+1]) / 6 at sample i. The inverse of that filter on an
 * infinite (or circular) row is c[i] = sqrt(3) sum over k of z^|k| T[i+k] with z = sqrt(3) - 2 =
 * -0.268. It is truncated where z^|k| falls below double's rounding (z^29 = 2.6e-17). So an edit
 * affects only WR_PREFILTER_REACH texels on each side, and a coefficient does not depend on the
 * rectangle that was read.
 *
 * A chunk of columns is processed from top to bottom: each table row is filtered along u into a ring of
 * rows, and each output row is the same filter across the ring. */

#define REACH WR_PREFILTER_REACH
#define TAPS (2 * REACH + 1)
#define CHUNK 512 /* columns; the ring (230 kB) stays in the second-level cache */

typedef struct Fit {
    double weight[REACH + 1];
    int width;     /* columns of a chunk: at most CHUNK */
    float *texels; /* [width + 2 REACH] one row as read, */
    double *wide;  /* and converted to double */
    double *ring;  /* [TAPS][width] row j is in slot (j - first row) % TAPS */
    double *sum;   /* [width] */
} Fit;

/* One allocation for all buffers: fitting 4 x 4 texels should not be dominated by allocation. */
static Fit *fit_new(int width)
{
    size_t across = (size_t)width + 2 * REACH;
    size_t doubles = across + (size_t)width * (TAPS + 1);
    Fit *fit = wr_alloc(1, sizeof *fit + doubles * sizeof(double) + across * sizeof(float));
    fit->width = width;
    fit->wide = (double *)(fit + 1);
    fit->ring = fit->wide + across;
    fit->sum = fit->ring + (size_t)width * TAPS;
    fit->texels = (float *)(fit->sum + width);
    double root = sqrt(3.0), w = root;
    for (int k = 0; k <= REACH; k++, w *= root - 2.0) fit->weight[k] = w;
    return fit;
}

static double *ring_row(Fit *fit, int j)
{
    return fit->ring + (size_t)(j % TAPS) * (size_t)fit->width;
}

/* Two sums side by side, with the bits of scalar sums on every processor. */
typedef double Two __attribute__((vector_size(2 * sizeof(double))));
#define SIDE 8 /* sums at a time, kept in registers */

static inline Two load(const double *from)
{
    Two two;
    memcpy(&two, from, sizeof two);
    return two;
}

/* sum[i] = centre[i] + sum over k, from 1 outwards, of weight[k] (below[k][i] + above[k][i] - 2
   centre[i]), centre = below[0]. The weights sum to 1, so each coefficient of a flat row equals its
   level to the bit (HC47), and a high level costs no precision of the details on it. */
static void fold(const Fit *fit, const double *const below[REACH + 1],
                 const double *const above[REACH + 1], int count, double *restrict sum)
{
    const double *weight = fit->weight;
    int i = 0;
    for (; i + SIDE <= count; i += SIDE) {
        Two part[SIDE / 2], twice[SIDE / 2];
        for (int n = 0; n < SIDE / 2; n++) {
            part[n] = load(below[0] + i + 2 * n);
            twice[n] = part[n] + part[n];
        }
        for (int k = 1; k <= REACH; k++) {
            const double *low = below[k] + i, *high = above[k] + i;
            part[0] += weight[k] * (load(low) + load(high) - twice[0]);
            part[1] += weight[k] * (load(low + 2) + load(high + 2) - twice[1]);
            part[2] += weight[k] * (load(low + 4) + load(high + 4) - twice[2]);
            part[3] += weight[k] * (load(low + 6) + load(high + 6) - twice[3]);
        }
        memcpy(sum + i, part, sizeof part);
    }
    for (; i < count; i++) {
        const double centre = below[0][i];
        double part = centre;
        for (int k = 1; k <= REACH; k++)
            part += weight[k] * (below[k][i] + above[k][i] - (centre + centre));
        sum[i] = part;
    }
}

/* Filters table row j, columns i .. i + count - 1, along u. */
static void fit_row(Fit *fit, const WrField *field, int i, int j, int count, double *out)
{
    const double *below[REACH + 1], *above[REACH + 1];
    wr_field_read(field, i - REACH, j, count + 2 * REACH, 1, fit->texels, 0);
    for (int k = 0; k < count + 2 * REACH; k++) fit->wide[k] = fit->texels[k];
    for (int k = 0; k <= REACH; k++) {
        below[k] = fit->wide + REACH - k;
        above[k] = fit->wide + REACH + k;
    }
    fold(fit, below, above, count, out);
}

/* Filters across the ring, rows middle - REACH .. middle + REACH, into fit->sum. */
static void fit_columns(Fit *fit, int middle, int count)
{
    const double *below[REACH + 1], *above[REACH + 1];
    for (int k = 0; k <= REACH; k++) {
        below[k] = ring_row(fit, middle - k);
        above[k] = ring_row(fit, middle + k);
    }
    fold(fit, below, above, count, fit->sum);
}

/* Destination of the coefficients: one of the two. */
typedef struct Out {
    float *single;
    double *wide;
} Out;

static void put(Out out, size_t at, const double *sum, int count)
{
    if (out.wide) {
        memcpy(out.wide + at, sum, (size_t)count * sizeof *sum);
        return;
    }
    for (int k = 0; k < count; k++) {
        double c = sum[k] > FLT_MAX ? FLT_MAX : sum[k];
        out.single[at + (size_t)k] = (float)(c < -FLT_MAX ? -FLT_MAX : c);
    }
}

static void read_fitted(const WrField *field, int i, int j, int count_i, int count_j, Out out,
                        size_t pitch)
{
    if (count_i <= 0 || count_j <= 0) return;
    Fit *fit = fit_new(count_i < CHUNK ? count_i : CHUNK);
    for (int col = 0; col < count_i; col += CHUNK) {
        int cols = count_i - col < CHUNK ? count_i - col : CHUNK;
        for (int row = 0; row < count_j + 2 * REACH; row++) {
            fit_row(fit, field, i + col, j - REACH + row, cols, ring_row(fit, row));
            int ready = row - 2 * REACH; /* this output row has all its input rows in the ring */
            if (ready < 0) continue;
            fit_columns(fit, ready + REACH, cols);
            put(out, (size_t)ready * pitch + (size_t)col, fit->sum, cols);
        }
    }
    wr_free(fit);
}

void wr_field_read_bspline_coefficients(const WrField *field, int i, int j, int count_i,
                                        int count_j, float *out, size_t pitch)
{
    read_fitted(field, i, j, count_i, count_j, (Out){ .single = out }, pitch);
}

void wr_field_read_bspline_coefficients_double(const WrField *field, int i, int j, int count_i,
                                               int count_j, double *out, size_t pitch)
{
    read_fitted(field, i, j, count_i, count_j, (Out){ .wide = out }, pitch);
}

/* ---- schemes ---- */

/* Every scheme reads the 4 x 4 taps around a point, taps[4 j + i] with rows running down, and the
 * point's position between the middle ones: a to the right of column 1, b below row 1. It returns F and
 * its slopes in heights per texel, all from differences of taps, so that equal taps give their height
 * and slopes of exactly 0. Differences are computed in double, where no two floats overflow (HC50). */

#define COLUMN(a, i, base) a[i] - base, a[4 + (i)] - base, a[8 + (i)] - base, a[12 + (i)] - base

static double mix(double p, double q, double t)
{
    return p + t * (q - p);
}

/* Half the difference of the neighbours of tap (i, j), across and down. */
static double central_across(const double *taps, int i, int j)
{
    return 0.5 * (taps[4 * j + i + 1] - taps[4 * j + i - 1]);
}

static double central_down(const double *taps, int i, int j)
{
    return 0.5 * (taps[4 * j + 4 + i] - taps[4 * j - 4 + i]);
}

static void eval_nearest(const double *taps, double a, double b, double out[3])
{
    (void)a, (void)b;
    out[0] = taps[5];
    out[1] = central_across(taps, 1, 1);
    out[2] = central_down(taps, 1, 1);
}

static void eval_bilinear(const double *taps, double a, double b, double out[3])
{
    double t00 = taps[5], t10 = taps[6], t01 = taps[9], t11 = taps[10];
    out[0] = mix(mix(t00, t10, a), mix(t01, t11, a), b);
    out[1] = mix(t10 - t00, t11 - t01, b);
    out[2] = mix(t01 - t00, t11 - t10, a);
}

/* With E = one texel, the central difference of the bilinear interpolant is the bilinear interpolant
 * of the table of central differences. */
static void eval_central(const double *taps, double a, double b, double out[3])
{
    eval_bilinear(taps, a, b, out);
    out[1] = mix(mix(central_across(taps, 1, 1), central_across(taps, 2, 1), a),
                 mix(central_across(taps, 1, 2), central_across(taps, 2, 2), a), b);
    out[2] = mix(mix(central_down(taps, 1, 1), central_down(taps, 2, 1), a),
                 mix(central_down(taps, 1, 2), central_down(taps, 2, 2), a), b);
}

/* One axis of the uniform cubic B-spline: value and slope at t between c1 and c2.
 *
 *   S  = (1-t)^3/6 c0 + (4 - 6 t^2 + 3 t^3)/6 c1 + (1 + 3 t + 3 t^2 - 3 t^3)/6 c2 + t^3/6 c3
 *   S' = (1-t)^2/2 (c1 - c0) + (1/2 + t - t^2) (c2 - c1) + t^2/2 (c3 - c2)
 *
 * The weights sum to 1, so S is c1 plus weighted differences from it. */
static double bspline_value(double c0, double c1, double c2, double c3, double t)
{
    double s = 1.0 - t;
    double w0 = s * s * s / 6.0, w3 = t * t * t / 6.0;
    double w2 = (1.0 + 3.0 * t * (1.0 + t * s)) / 6.0;
    return c1 + (w0 * (c0 - c1) + w2 * (c2 - c1) + w3 * (c3 - c1));
}

static double bspline_slope(double c0, double c1, double c2, double c3, double t)
{
    double s = 1.0 - t;
    return 0.5 * s * s * (c1 - c0) + (0.5 + t * s) * (c2 - c1) + 0.5 * t * t * (c3 - c2);
}

/* One axis of Catmull-Rom: the cubic with values p1, p2 and slopes (p2 - p0)/2, (p3 - p1)/2. */
static double catmull_value(double p0, double p1, double p2, double p3, double t)
{
    double m1 = 0.5 * (p2 - p0), m2 = 0.5 * (p3 - p1), d = p2 - p1;
    return p1 + t * (m1 + t * ((3.0 * d - 2.0 * m1 - m2) + t * (m1 + m2 - 2.0 * d)));
}

static double catmull_slope(double p0, double p1, double p2, double p3, double t)
{
    double m1 = 0.5 * (p2 - p0), m2 = 0.5 * (p3 - p1), d = p2 - p1;
    return m1 + t * (2.0 * (3.0 * d - 2.0 * m1 - m2) + 3.0 * t * (m1 + m2 - 2.0 * d));
}

/* A tensor product of one-axis cubics: columns are interpolated at b, the results at a. A tap is
 * subtracted first, so that slopes do not depend on the table's level (HC48). */
typedef double (*Cubic)(double p0, double p1, double p2, double p3, double t);

static inline void eval_cubic(Cubic value, Cubic slope, const double *taps, double a, double b,
                              double out[3])
{
    double base = taps[5], row[4], down[4]; /* of each column at b: value, slope */
    for (int i = 0; i < 4; i++) {
        row[i] = value(COLUMN(taps, i, base), b);
        down[i] = slope(COLUMN(taps, i, base), b);
    }
    out[0] = base + value(row[0], row[1], row[2], row[3], a);
    out[1] = slope(row[0], row[1], row[2], row[3], a);
    out[2] = value(down[0], down[1], down[2], down[3], a);
}

static void eval_bspline(const double *taps, double a, double b, double out[3])
{
    eval_cubic(bspline_value, bspline_slope, taps, a, b, out);
}

static void eval_catmull(const double *taps, double a, double b, double out[3])
{
    eval_cubic(catmull_value, catmull_slope, taps, a, b, out);
}

WR_ROWS(wr_schemes);
const WrSchemeInfo wr_schemes[WR_SCHEME_COUNT] = {
    [WR_ROW(WR_SCHEME_NEAREST)] = { "nearest", "nearest texel", "Nearest",
                                    "the texel's own height and its central difference: blocks", 1,
                                    1, 3, WR_TAPS_CENTRED, eval_nearest },
    [WR_ROW(WR_SCHEME_BILINEAR)] = { "bilinear", "bilinear", "Bilinear",
                                     "straight between texels, with creases where cells meet", 2, 1,
                                     3, WR_TAPS_TABLE, eval_bilinear },
    [WR_ROW(WR_SCHEME_CENTRAL)] = { "central", "central difference", "Central",
                                    "the paper's: bilinear heights, differences one "
                                    "texel to either side",
                                    2, 2, 3, WR_TAPS_TABLE, eval_central },
    [WR_ROW(WR_SCHEME_BSPLINE)] = { "bspline", "cubic B-spline", "B-spline",
                                    "smooth everywhere; rounds the heights off a little", 2, 2, 3,
                                    WR_TAPS_TABLE, eval_bspline },
    [WR_ROW(WR_SCHEME_BSPLINE_FIT)] = { "bspline-fit", "cubic B-spline through the samples",
                                        "B-spline, fitted",
                                        "smooth everywhere and through every texel's height; may "
                                        "overshoot",
                                        4, 3, WR_PREFILTER_REACH + 2, WR_TAPS_FITTED,
                                        eval_bspline },
    [WR_ROW(WR_SCHEME_CATMULL)] = { "catmull", "Catmull-Rom", "Catmull-Rom",
                                    "through every texel's height, with continuous slopes", 3, 2, 3,
                                    WR_TAPS_TABLE, eval_catmull },
};
WR_ROWS_END(wr_schemes, WR_SCHEME_COUNT);
const int wr_scheme_count = WR_SCHEME_COUNT;

int wr_scheme_find(const char *name)
{
    for (int k = 0; k < WR_SCHEME_COUNT; k++)
        if (strcmp(name, wr_schemes[k].name) == 0) return k;
    return -1;
}

/* A coordinate on one axis: its cell, the fraction in it, and whether F varies there. */
typedef struct Place {
    int cell;
    double fraction; /* 0..1 */
    bool varies;     /* false outside a clamped axis */
} Place;

static Place locate(double u, int n, WrWrap wrap, bool runs_down, WrSchemeTaps taps)
{
    Place place = { .varies = true };
    double p = 0.0;
    if (wrap == WR_WRAP_PERIODIC) {
        p = wr_field_reduce(u, 1.0);
    } else {
        place.varies = u >= 0.0 && u <= 1.0;
        p = u > 0.0 ? (u < 1.0 ? u : 1.0) : 0.0;
    }
    if (runs_down) p = 1.0 - p;
    double x = n * p - (taps == WR_TAPS_CENTRED ? 0.0 : 0.5), cell = floor(x);
    if (taps == WR_TAPS_CENTRED && wrap == WR_WRAP_CLAMP && cell > n - 1) cell = n - 1;
    place.cell = (int)cell;
    place.fraction = x - cell;
    return place;
}

/* The part of the table, fitted, that holds the taps of all points: of a row of samples, four rows. */
typedef struct Fitted {
    double *taps; /* NULL: the taps of each point are fitted separately */
    int i, j;
    size_t pitch;
} Fitted;

/* None if fitting the taps of single points is cheaper (about 200 texels' worth each) or memory is exhausted. */
static Fitted fit_around(const WrField *field, WrScheme scheme, size_t count, const double *u,
                         const double *v)
{
    const WrSchemeTaps kind = wr_schemes[scheme].taps;
    const int width = wr_field_width(field), height = wr_field_height(field);
    int left = INT_MAX, right = INT_MIN, top = INT_MAX, bottom = INT_MIN;
    if (kind != WR_TAPS_FITTED || count < 2) return (Fitted){ NULL, 0, 0, 0 };
    for (size_t k = 0; k < count; k++) {
        const int i = locate(u[k], width, wr_field_wrap_u(field), false, kind).cell - 1;
        const int j = locate(v[k], height, wr_field_wrap_v(field), true, kind).cell - 1;
        left = i < left ? i : left, right = i > right ? i : right;
        top = j < top ? j : top, bottom = j > bottom ? j : bottom;
    }
    const int columns = right - left + 4, rows = bottom - top + 4;
    const size_t texels = (size_t)columns * (size_t)rows;
    Fitted fitted = { NULL, left, top, (size_t)columns };
    if (count < texels / 200) return fitted;
    fitted.taps = wr_try_alloc(texels, sizeof *fitted.taps, "taps", NULL);
    if (fitted.taps)
        wr_field_read_bspline_coefficients_double(field, left, top, columns, rows, fitted.taps,
                                                  fitted.pitch);
    return fitted;
}

/* The 16 taps whose first is (i, j). */
static void read_taps(const WrField *field, WrSchemeTaps kind, const Fitted *fitted, int i, int j,
                      double taps[16])
{
    float texels[16];
    if (fitted->taps) {
        const double *from = fitted->taps + (size_t)(j - fitted->j) * fitted->pitch;
        for (int k = 0; k < 4; k++)
            memcpy(taps + 4 * k, from + (size_t)k * fitted->pitch + (size_t)(i - fitted->i),
                   4 * sizeof *taps);
    } else if (kind == WR_TAPS_FITTED) {
        wr_field_read_bspline_coefficients_double(field, i, j, 4, 4, taps, 4);
    } else {
        wr_field_read(field, i, j, 4, 4, texels, 4);
        for (int k = 0; k < 16; k++) taps[k] = (double)texels[k];
    }
}

void wr_field_sample(const WrField *field, WrScheme scheme, size_t count, const double *u,
                     const double *v, double *f, double *fu, double *fv)
{
    const Fitted fitted = fit_around(field, scheme, count, u, v);
    const WrSchemeInfo *info = &wr_schemes[scheme];
    int width = wr_field_width(field), height = wr_field_height(field);
    Place last_x = { .cell = -2 }, last_y = last_x; /* no point is in cell -2 */
    double taps[16];
    for (size_t k = 0; k < count; k++) {
        Place x = locate(u[k], width, wr_field_wrap_u(field), false, info->taps);
        Place y = locate(v[k], height, wr_field_wrap_v(field), true, info->taps);
        if (x.cell != last_x.cell || y.cell != last_y.cell)
            read_taps(field, info->taps, &fitted, x.cell - 1, y.cell - 1, taps);
        last_x = x, last_y = y;
        double out[3];
        info->eval(taps, x.fraction, y.fraction, out);
        if (f) f[k] = out[0];
        if (fu) fu[k] = x.varies ? width * out[1] : 0.0;
        if (fv) fv[k] = y.varies ? 0.0 - height * out[2] : 0.0; /* rows run down; 0 - 0 is +0 */
    }
    wr_free(fitted.taps);
}

/* FVAL of the paper, with v up and texels at their centres. */
static double fval(const WrField *field, double u, double v)
{
    int width = wr_field_width(field), height = wr_field_height(field);
    Place x = locate(u, width, wr_field_wrap_u(field), false, WR_TAPS_TABLE);
    Place y = locate(v, height, wr_field_wrap_v(field), true, WR_TAPS_TABLE);
    float t[4];
    wr_field_read(field, x.cell, y.cell, 2, 2, t, 2);
    double f00 = t[0], f10 = t[1], f01 = t[2], f11 = t[3];
    double fu0 = f00 + x.fraction * (f10 - f00), fu1 = f01 + x.fraction * (f11 - f01);
    return fu0 + y.fraction * (fu1 - fu0);
}

void wr_field_sample_blinn(const WrField *field, double u, double v, double *fu, double *fv)
{
    double eu = 1.0 / wr_field_width(field), ev = 1.0 / wr_field_height(field);
    if (wr_field_wrap_u(field) == WR_WRAP_PERIODIC) u = wr_field_reduce(u, 1.0);
    if (wr_field_wrap_v(field) == WR_WRAP_PERIODIC) v = wr_field_reduce(v, 1.0);
    if (fu) *fu = (fval(field, u + eu, v) - fval(field, u - eu, v)) / (2.0 * eu);
    if (fv) *fv = (fval(field, u, v + ev) - fval(field, u, v - ev)) / (2.0 * ev);
}
