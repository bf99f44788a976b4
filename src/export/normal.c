#include "export/job.h"

#include "base/memory.h"
#include "base/vec.h"
#include "field/analytic.h"
#include "field/field.h"
#include "field/scheme.h"
#include "scene/scene.h"

#include <math.h>

/* Slopes at texel centres. There every scheme's derivative is a fixed stencil of table entries (scheme.h,
 * with x and y whole numbers), in texels, rows downwards:
 *   nearest, central, catmull   (T[i+1] - T[i-1]) / 2
 *   bilinear                    T[i+1] - T[i], the cell that begins at the centre
 *   bspline, bspline-fit        (c[i+1] - c[i-1]) / 2, averaged across by 1/6, 4/6, 1/6
 * so no position is rounded and no branch depends on one. dF/dV = -H * (slope downwards). */

#define APRON 1

/* Differences along x of the three rows about `at`, or along y of the three columns. */
static double difference(const double *at, ptrdiff_t step, bool forward)
{
    double after = at[step];
    return forward ? after - at[0] : 0.5 * (after - at[-step]);
}

static void table_slope(const double *at, ptrdiff_t pitch, WrScheme scheme, double *right,
                        double *down)
{
    switch (scheme) {
    case WR_SCHEME_BSPLINE:
    case WR_SCHEME_BSPLINE_FIT:
        *right = (difference(at - pitch, 1, false) + 4.0 * difference(at, 1, false) +
                  difference(at + pitch, 1, false)) /
                 6.0;
        *down = (difference(at - 1, pitch, false) + 4.0 * difference(at, pitch, false) +
                 difference(at + 1, pitch, false)) /
                6.0;
        return;
    case WR_SCHEME_BILINEAR:
        *right = difference(at, 1, true);
        *down = difference(at, pitch, true);
        return;
    case WR_SCHEME_NEAREST:
    case WR_SCHEME_CENTRAL:
    case WR_SCHEME_CATMULL:
    case WR_SCHEME_COUNT: break;
    }
    *right = difference(at, 1, false);
    *down = difference(at, pitch, false);
}

/* normalise(x, y, 1) of x = -height Fu / cell_w, y = -height Fv / cell_h; straight up and counted where
 * one is not finite. */
static WrVec3 normal_of(double x, double y, int64_t *replaced)
{
    WrVec3 n = { x, y, 1.0 }, up = { 0.0, 0.0, 1.0 };
    if (!isfinite(x) || !isfinite(y)) {
        ++*replaced;
        return up;
    }
    if (x == 0.0 && y == 0.0) return up;
    return v3_unit(n, up);
}

static void store(const WrExportJob *job, void *out, size_t texel, WrVec3 n, int column, int row)
{
    double value[3] = { n.x / 2.0 + 0.5, job->kind->green * n.y / 2.0 + 0.5, n.z / 2.0 + 0.5 };
    for (int c = 0; c < 3; c++) {
        size_t i = 3 * texel + (size_t)c;
        if (job->options.depth == 32) ((float *)out)[i] = (float)value[c];
        else
            wr_export_store_code(job, out, i, wr_export_last_code(job) * value[c], 0,
                                 (WrExportTexel){ column, row, c });
    }
}

typedef struct Strip {
    int y;
    void *out;
} Strip;

/* Whether a row's slopes are such that plain products give the bits of v3_unit, which scales by powers of
 * two against overflow. What is not finite is not. */
#define PLAIN 1e100

/* -height Fu / cell_w and -height Fv / cell_h of a row of texels. */
static bool row_tilts(const WrExportJob *job, const double *at, ptrdiff_t pitch,
                      double *restrict tx, double *restrict ty)
{
    WrScheme scheme = (WrScheme)job->options.scheme;
    double height = job->scene->height, cell_w = job->options.cell_w, cell_h = job->options.cell_h;
    double width = job->width, rows = job->height, largest = 0.0;
    for (int i = 0; i < job->width; i++) {
        double right, down;
        table_slope(at + i, pitch, scheme, &right, &down);
        tx[i] = -height * (width * right) / cell_w;
        ty[i] = -height * (-rows * down) / cell_h;
    }
    bool plain = true;
#pragma omp simd reduction(max : largest)
    for (int i = 0; i < job->width; i++) {
        double far = fabs(tx[i]) > fabs(ty[i]) ? fabs(tx[i]) : fabs(ty[i]);
        largest = far > largest ? far : largest;
    }
    for (int i = 0; i < job->width; i++) plain &= tx[i] == tx[i] && ty[i] == ty[i];
    return plain && largest < PLAIN;
}

/* round(last (n/2 + 1/2)) of what is not negative. */
static inline int32_t code_of(double last, double n)
{
    double x = last * (n / 2.0 + 0.5);
    int32_t whole = (int32_t)x;
    return whole + (x - whole >= 0.5 ? 1 : 0);
}

/* Whole codes of a row without dither: what normal_of and store do. */
static void plain_row(const WrExportJob *job, const double *restrict tx, const double *restrict ty,
                      int32_t *restrict codes)
{
    double last = wr_export_last_code(job), green = job->kind->green;
    int width = job->width;
    int32_t *x = codes, *y = codes + width, *z = codes + 2 * (size_t)width;
#pragma omp simd
    for (int i = 0; i < width; i++) {
        double inverse = 1.0 / sqrt(tx[i] * tx[i] + ty[i] * ty[i] + 1.0);
        x[i] = code_of(last, tx[i] * inverse);
        y[i] = code_of(last, green * (ty[i] * inverse));
        z[i] = code_of(last, inverse);
    }
}

static void store_row(const WrExportJob *job, const int32_t *codes, void *out, size_t texel)
{
    size_t width = (size_t)job->width;
    if (job->options.depth == 8) {
        uint8_t *to = (uint8_t *)out + 3 * texel;
        for (size_t i = 0; i < width; i++)
            for (size_t c = 0; c < 3; c++) to[3 * i + c] = (uint8_t)codes[c * width + i];
        return;
    }
    uint16_t *to = (uint16_t *)out + 3 * texel;
    for (size_t i = 0; i < width; i++)
        for (size_t c = 0; c < 3; c++) to[3 * i + c] = (uint16_t)codes[c * width + i];
}

/* The taps of rows y .. and one texel around them: heights, or coefficients that are not rounded, which at a high
   level would lose the slopes. */
static double *read_taps(const WrExportJob *job, int y, int rows, size_t pitch)
{
    const int tall = rows + 2 * APRON, wide = (int)pitch;
    const size_t count = pitch * (size_t)tall;
    double *taps = wr_alloc(count, sizeof *taps);
    if (wr_schemes[job->options.scheme].taps == WR_TAPS_FITTED) {
        wr_field_read_fitted_double(job->field, -APRON, y - APRON, wide, tall, taps, pitch);
        return taps;
    }
    float *texels = wr_alloc(count, sizeof *texels);
    wr_field_read(job->field, -APRON, y - APRON, wide, tall, texels, pitch);
    for (size_t k = 0; k < count; k++) taps[k] = texels[k];
    wr_free(texels);
    return taps;
}

static void table_rows(WrExportJob *job, int y, int rows, const Strip *strip, int64_t *replaced)
{
    size_t pitch = (size_t)job->width + 2 * APRON, width = (size_t)job->width;
    bool whole = job->options.depth < 32 && !job->options.dither;
    double *taps = read_taps(job, y, rows, pitch);
    double *tx = wr_alloc(2 * width, sizeof *tx), *ty = tx + width;
    int32_t *codes = wr_alloc(3 * width, sizeof *codes);
    for (int j = 0; j < rows; j++) {
        const double *at = taps + (size_t)(j + APRON) * pitch + APRON;
        size_t texel = (size_t)(y - strip->y + j) * width;
        if (row_tilts(job, at, (ptrdiff_t)pitch, tx, ty) && whole) {
            plain_row(job, tx, ty, codes);
            store_row(job, codes, strip->out, texel);
            continue;
        }
        for (int i = 0; i < job->width; i++)
            store(job, strip->out, texel + (size_t)i, normal_of(tx[i], ty[i], replaced), i, y + j);
    }
    wr_free(codes);
    wr_free(tx);
    wr_free(taps);
}

static void formula_rows(WrExportJob *job, int y, int rows, const Strip *strip, int64_t *replaced)
{
    for (int j = 0; j < rows; j++) {
        double v = wr_export_row_v(job, y + j);
        for (int i = 0; i < job->width; i++) {
            double fu, fv;
            wr_analytic_sample(&job->scene->analytic, job->u[i], v, NULL, &fu, &fv);
            double height = job->scene->height;
            WrVec3 n = normal_of(-height * fu / job->options.cell_w,
                                 -height * fv / job->options.cell_h, replaced);
            store(job, strip->out, (size_t)(y - strip->y + j) * (size_t)job->width + (size_t)i, n,
                  i, y + j);
        }
    }
}

static void normal_piece(WrExportJob *job, int y, int rows, void *ctx)
{
    int64_t replaced = 0;
    if (job->analytic) formula_rows(job, y, rows, ctx, &replaced);
    else table_rows(job, y, rows, ctx, &replaced);
    __atomic_fetch_add(&job->report.replaced, replaced, __ATOMIC_RELAXED);
}

void wr_export_normal_rows(WrExportJob *job, int y, int rows, void *out)
{
    Strip strip = { y, out };
    wr_export_run(job, y, rows, normal_piece, &strip);
}

void wr_export_normal_describe(WrExportJob *job)
{
    wr_text_add(wr_export_attribute(job, "wrinkle:convention"),
                job->kind->green > 0.0 ? "+Y" : "-Y");
    wr_text_add(wr_export_attribute(job, "wrinkle:scheme"), wr_schemes[job->options.scheme].name);
    WrText *cell = wr_export_attribute(job, "wrinkle:cell");
    wr_text_add_number(cell, job->options.cell_w);
    wr_text_add(cell, ",");
    wr_text_add_number(cell, job->options.cell_h);
    wr_text_add_number(wr_export_attribute(job, "wrinkle:height"), job->scene->height);
}
