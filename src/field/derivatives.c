#include "field/derivatives.h"

#include "base/memory.h"
#include "field/scheme_list.h"
#include "field/analytic.h"
#include "field/field.h"

#include <math.h>
#include <string.h>

#define APRON 2
#define STRIP 512 /* texels of a row processed at once */
#define TAPS (2 * APRON + 1)

/* A scheme along one axis, in texels, for the taps -2 .. 2 about a centre: value and slope there, and
   the increase of each from half a texel before to half a texel after. `nearest` uses the slopes of
   `central` at the centres, and so its second derivatives too. A stencil of F is the product of two of these: F_u = slope
   along u x value along v. Tables of second derivatives use the difference of the slopes half a texel to either side, since
   bilinear and central slopes have no derivative at the centres. */
typedef struct Stencil {
    double value[TAPS], slope[TAPS], value_grows[TAPS], slope_grows[TAPS];
} Stencil;

/* Each row was derived by evaluating the scheme's basis at 0 (value, slope) and at +-1/2 (the increases). Example, the
   uniform cubic B-spline: values 1/6 4/6 1/6, slopes -1/2 0 1/2; values at 1/2: 1/48 23/48 23/48 1/48 of taps -1..2, so the
   increase is the difference of that row and its mirror image. */
static const Stencil central = {
    { 0, 0, 1, 0, 0 }, { 0, -0.5, 0, 0.5, 0 }, { 0, -0.5, 0, 0.5, 0 }, { 0.25, 0, -0.5, 0, 0.25 }
};
static const Stencil bilinear = {
    { 0, 0, 1, 0, 0 }, { 0, 0, -1, 1, 0 }, { 0, -0.5, 0, 0.5, 0 }, { 0, 1, -2, 1, 0 }
};
static const Stencil catmull = { { 0, 0, 1, 0, 0 },
                                 { 0, -0.5, 0, 0.5, 0 },
                                 { 0.0625, -0.625, 0, 0.625, -0.0625 },
                                 { -0.125, 1.5, -2.75, 1.5, -0.125 } };
static const Stencil spline = { { 0, 1 / 6.0, 4 / 6.0, 1 / 6.0, 0 },
                                { 0, -0.5, 0, 0.5, 0 },
                                { -1 / 48.0, -22 / 48.0, 0, 22 / 48.0, 1 / 48.0 },
                                { 0.125, 0.5, -1.25, 0.5, 0.125 } };

static const Stencil *stencil_of(WrScheme scheme)
{
    switch ((WrSchemeId)scheme) {
    case WR_SCHEME_BSPLINE:
    case WR_SCHEME_BSPLINE_FIT: return &spline;
    case WR_SCHEME_BILINEAR: return &bilinear;
    case WR_SCHEME_CATMULL: return &catmull;
    case WR_SCHEME_NEAREST:
    case WR_SCHEME_CENTRAL:
    case WR_SCHEME_COUNT: break;
    }
    return &central;
}

struct WrDerivativesBand {
    WrDerivatives ground;
    int x, y, w, rows;
    size_t pitch;
    double
        *taps; /* [rows + 2 APRON][pitch], the first texel at [APRON][APRON]; NULL for a formula */
};

WrDerivativesRow wr_derivatives_row_new(int count, bool bends)
{
    const size_t n = (size_t)count;
    double *all = wr_alloc((bends ? 5 : 2) * n, sizeof *all);
    WrDerivativesRow row = { .p = all, .q = all + n };
    if (bends) row.r = all + 2 * n, row.s = all + 3 * n, row.t = all + 4 * n;
    return row;
}

void wr_derivatives_row_free(WrDerivativesRow *row)
{
    wr_free(row->p);
    *row = (WrDerivativesRow){ 0 };
}

/* wr_field_read extrapolates beyond clamped edges by a quadratic; maps instead repeat the edge texel, so a margin adds no
   height that the table does not contain. */
static int held(int at, int n, WrWrap wrap)
{
    if (wrap == WR_WRAP_PERIODIC) return at;
    return at < 0 ? 0 : at < n ? at : n - 1;
}

void wr_derivatives_read_clamped(const WrField *field, int i, int j, int count, float *out)
{
    const int w = wr_field_width(field),
              row = held(j, wr_field_height(field), wr_field_wrap_v(field));
    if (wr_field_wrap_u(field) == WR_WRAP_PERIODIC) {
        wr_field_read(field, i, row, count, 1, out, (size_t)count);
        return;
    }
    const int from = held(i, w, WR_WRAP_CLAMP), last = held(i + count - 1, w, WR_WRAP_CLAMP);
    float *inner = out + (from - i > 0 ? from - i : 0);
    if (inner >= out + count) inner = out + count - 1;
    wr_field_read(field, from, row, last - from + 1, 1, inner, (size_t)count);
    for (float *x = out; x < inner; x++) *x = *inner;
    for (float *x = inner + (last - from) + 1; x < out + count; x++) *x = x[-1];
}

/* Taps are converted to double once. A fitted scheme reads its B-spline coefficients in double, since slopes are differences
   of nearly equal taps (NUMERICS.md HC48). */
static void read_taps(WrDerivativesBand *band)
{
    const WrField *field = band->ground.field;
    const int wide = (int)band->pitch, tall = band->rows + 2 * APRON;
    band->taps = wr_alloc_unset(band->pitch * (size_t)tall, sizeof(double));
    if (wr_schemes[band->ground.scheme].taps == WR_TAPS_FITTED) {
        wr_field_read_bspline_coefficients_double(field, band->x - APRON, band->y - APRON, wide,
                                                  tall, band->taps, band->pitch);
        return;
    }
    const size_t count = band->pitch * (size_t)tall;
    float *texels = wr_alloc_unset(count, sizeof *texels);
    double *taps = band->taps;
    wr_field_read(field, band->x - APRON, band->y - APRON, wide, tall, texels, band->pitch);
#pragma omp simd
    for (size_t k = 0; k < count; k++) taps[k] = (double)texels[k];
    wr_free(texels);
}

WrDerivativesBand *wr_derivatives_open(const WrDerivatives *ground, int x, int y, int w, int rows)
{
    WrDerivativesBand *band = wr_alloc(1, sizeof *band);
    *band = (WrDerivativesBand){ *ground, x, y, w, rows, (size_t)w + 2 * APRON, NULL };
    if (!ground->formula) read_taps(band);
    return band;
}

void wr_derivatives_close(WrDerivativesBand *band)
{
    if (!band) return;
    wr_free(band->taps);
    wr_free(band);
}

/* out[i] = sum of weight[k] in[i + (k - APRON) step], from the first tap to the last. */
static void weigh(const double weight[TAPS], const double *in, ptrdiff_t step, int count,
                  double *restrict out)
{
    bool first = true;
    for (int k = 0; k < TAPS; k++) {
        const double *at = in + (k - APRON) * step, w = weight[k];
        if (w == 0) continue;
        if (first)
#pragma omp simd
            for (int i = 0; i < count; i++) out[i] = w * at[i];
        else
#pragma omp simd
            for (int i = 0; i < count; i++) out[i] += w * at[i];
        first = false;
    }
}

static void scale(double by, int count, double *x)
{
#pragma omp simd
    for (int i = 0; i < count; i++) x[i] *= by;
}

/* s is the mean of the increase of q along x and of p along y; rows run down, y up. */
static void bends(const Stencil *st, const double *at, ptrdiff_t down, int w,
                  const WrDerivativesRow *out)
{
    double line[STRIP + 2 * APRON], more[STRIP], *inner = line + APRON;
    const int wide = w + 2 * APRON;
    weigh(st->value, at - APRON, down, wide, line);
    weigh(st->slope_grows, inner, 1, w, out->r);
    weigh(st->slope_grows, at - APRON, down, wide, line);
    weigh(st->value, inner, 1, w, out->t);
    weigh(st->slope, at - APRON, down, wide, line);
    weigh(st->value_grows, inner, 1, w, out->s);
    weigh(st->value_grows, at - APRON, down, wide, line);
    weigh(st->slope, inner, 1, w, more);
    for (int i = 0; i < w; i++) out->s[i] += more[i];
}

/* at: the tap of the first texel; adjacent rows are `down` apart. */
static void strip_of_table(const WrDerivatives *g, const double *at, ptrdiff_t down, int w,
                           const WrDerivativesRow *out)
{
    const Stencil *st = stencil_of(g->scheme);
    /* Scene units per texel: slopes are height * dF/dtexel / unit. The sign of q: rows run down, v up. */
    const double x = g->cell_w / wr_field_width(g->field);
    const double y = g->cell_h / wr_field_height(g->field);
    double line[STRIP + 2 * APRON];
    weigh(st->value, at - APRON, down, w + 2 * APRON, line);
    weigh(st->slope, line + APRON, 1, w, out->p);
    weigh(st->slope, at - APRON, down, w + 2 * APRON, line);
    weigh(st->value, line + APRON, 1, w, out->q);
    scale(g->height / x, w, out->p);
    scale(-g->height / y, w, out->q);
    if (!out->r) return;
    bends(st, at, down, w, out);
    scale(g->height / (x * x), w, out->r);
    scale(-0.5 * g->height / (x * y), w, out->s);
    scale(g->height / (y * y), w, out->t);
}

/* Processes strips that fit the first-level cache. */
static void row_of_table(const WrDerivativesBand *band, int j, const WrDerivativesRow *out)
{
    /* at[] is the tap of the row's first texel; at[k] and at[k * down] with k = -APRON..APRON are inside the band's apron. */
    const ptrdiff_t down = (ptrdiff_t)band->pitch;
    const double *at = band->taps + (j + APRON) * down + APRON;
    for (int x = 0; x < band->w; x += STRIP) {
        const int left = band->w - x;
        WrDerivativesRow part = { .p = out->p + x, .q = out->q + x };
        if (out->r) part.r = out->r + x, part.s = out->s + x, part.t = out->t + x;
        strip_of_table(&band->ground, at + x, down, left < STRIP ? left : STRIP, &part);
    }
}

/* Slopes of the formula, along u and v. */
static void formula_slopes(const WrDerivatives *g, double u, double v, double *p, double *q)
{
    double fu, fv;
    wr_analytic_sample(g->formula, u, v, NULL, &fu, &fv);
    *p = g->height * fu / g->cell_w;
    *q = g->height * fv / g->cell_h;
}

static void row_of_formula(const WrDerivativesBand *band, int j, const WrDerivativesRow *out)
{
    const WrDerivatives *g = &band->ground;
    const int w = wr_field_width(g->field), h = wr_field_height(g->field);
    const double v = 1 - (band->y + j + 0.5) / h, half_u = 0.5 / w, half_v = 0.5 / h;
    for (int i = 0; i < band->w; i++) {
        const double u = (band->x + i + 0.5) / w;
        double p[4], q[4];
        formula_slopes(g, u, v, &out->p[i], &out->q[i]);
        if (!out->r) continue;
        formula_slopes(g, u + half_u, v, &p[0], &q[0]);
        formula_slopes(g, u - half_u, v, &p[1], &q[1]);
        formula_slopes(g, u, v + half_v, &p[2], &q[2]);
        formula_slopes(g, u, v - half_v, &p[3], &q[3]);
        const double x = g->cell_w / w, y = g->cell_h / h;
        out->r[i] = (p[0] - p[1]) / x;
        out->t[i] = (q[2] - q[3]) / y;
        out->s[i] = 0.5 * ((q[0] - q[1]) / x + (p[2] - p[3]) / y);
    }
}

void wr_derivatives_row(const WrDerivativesBand *band, int j, const WrDerivativesRow *out)
{
    if (band->ground.formula) row_of_formula(band, j, out);
    else row_of_table(band, j, out);
}

/* Mean curvature of the graph z(x,y) with p = z_x, q = z_y, r = z_xx, s = z_xy, t = z_yy (Monge's notation):
     H = ((1 + q^2) r - 2 p q s + (1 + p^2) t) / (2 (1 + p^2 + q^2)^(3/2)),
   negated, so that ridges (r, t < 0) are positive. */
double wr_derivatives_convexity(double p, double q, double r, double s, double t)
{
    const double n2 = 1 + p * p + q * q;
    return -((1 + q * q) * r - 2 * p * q * s + (1 + p * p) * t) / (2 * n2 * sqrt(n2));
}
