#include "export/job.h"

#include "base/memory.h"
#include "base/vec.h"

#include <math.h>

/* Slopes at texel centres. There every scheme's derivative is a fixed stencil of table entries (scheme.h,
 * with x and y whole numbers), in texels, rows downwards:
 *   nearest, central, catmull   (T[i+1] - T[i-1]) / 2
 *   bilinear                    T[i+1] - T[i], the cell that begins at the centre
 *   bspline, bspline-fit        (c[i+1] - c[i-1]) / 2, averaged across by 1/6, 4/6, 1/6
 * so no position is rounded and no branch depends on one. dF/dV = -H * (slope downwards). */

#define APRON 1

/* Differences along x of the three rows about `at`, or along y of the three columns. */
static double difference(const float *at, ptrdiff_t step, bool forward)
{
    double after = at[step];
    return forward ? after - at[0] : 0.5 * (after - at[-step]);
}

static void table_slope(const float *at, ptrdiff_t pitch, WrScheme scheme, double *right,
                        double *down)
{
    if (scheme == WR_SCHEME_BSPLINE || scheme == WR_SCHEME_BSPLINE_FIT) {
        *right = (difference(at - pitch, 1, false) + 4.0 * difference(at, 1, false) +
                  difference(at + pitch, 1, false)) /
                 6.0;
        *down = (difference(at - 1, pitch, false) + 4.0 * difference(at, pitch, false) +
                 difference(at + 1, pitch, false)) /
                6.0;
    } else {
        bool forward = scheme == WR_SCHEME_BILINEAR;
        *right = difference(at, 1, forward);
        *down = difference(at, pitch, forward);
    }
}

/* normalise(-height Fu / cell_w, -height Fv / cell_h, 1); straight up and counted where a slope is not
 * finite. */
static WrVec3 normal_of(const WrExportJob *job, double fu, double fv, int64_t *replaced)
{
    double height = job->scene->height;
    WrVec3 n = { -height * fu / job->options.cell_w, -height * fv / job->options.cell_h, 1.0 };
    WrVec3 up = { 0.0, 0.0, 1.0 };
    if (!isfinite(n.x) || !isfinite(n.y)) {
        ++*replaced;
        return up;
    }
    if (n.x == 0.0 && n.y == 0.0) return up;
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

static void table_rows(WrExportJob *job, int y, int rows, const Strip *strip, int64_t *replaced)
{
    WrScheme scheme = (WrScheme)job->options.scheme;
    size_t pitch = (size_t)job->width + 2 * APRON, width = (size_t)job->width;
    float *texels = wr_alloc(pitch * ((size_t)rows + 2 * APRON), sizeof *texels);
    if (scheme == WR_SCHEME_BSPLINE_FIT)
        wr_field_read_fitted(job->field, -APRON, y - APRON, (int)pitch, rows + 2 * APRON, texels,
                             pitch);
    else wr_field_read(job->field, -APRON, y - APRON, (int)pitch, rows + 2 * APRON, texels, pitch);
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < job->width; i++) {
            double right, down;
            table_slope(texels + (size_t)(j + APRON) * pitch + (size_t)(i + APRON),
                        (ptrdiff_t)pitch, scheme, &right, &down);
            WrVec3 n = normal_of(job, job->width * right, -job->height * down, replaced);
            store(job, strip->out, (size_t)(y - strip->y + j) * width + (size_t)i, n, i, y + j);
        }
    wr_free(texels);
}

static void formula_rows(WrExportJob *job, int y, int rows, const Strip *strip, int64_t *replaced)
{
    for (int j = 0; j < rows; j++) {
        double v = wr_export_row_v(job, y + j);
        for (int i = 0; i < job->width; i++) {
            double fu, fv;
            wr_analytic_sample(&job->scene->analytic, job->u[i], v, NULL, &fu, &fv);
            WrVec3 n = normal_of(job, fu, fv, replaced);
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
