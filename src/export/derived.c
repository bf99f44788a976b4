/* Maps of the table's first derivatives: slopes, steepness. */
#include "export/job.h"

#include "base/exactmath.h"
#include "base/memory.h"
#include "field/analytic.h"
#include "field/derivatives.h"
#include "scene/scene.h"

#include <math.h>

/* Computes a kind's row, [width] numbers per channel, channel after channel; returns the number of non-finite
   values. */
typedef int64_t Derive(const WrExportJob *job, const WrDerivativesRow *row, double *out);

static int64_t settle(double *x)
{
    if (isfinite(*x)) return 0;
    *x = 0;
    return 1;
}

static int64_t both_slopes(const WrExportJob *job, const WrDerivativesRow *row, double *out)
{
    int64_t replaced = 0;
    for (int i = 0; i < job->width; i++) {
        out[i] = row->p[i], out[job->width + i] = row->q[i];
        replaced += settle(&out[i]) + settle(&out[job->width + i]);
    }
    return replaced;
}

static int64_t steepness(const WrExportJob *job, const WrDerivativesRow *row, double *out)
{
    int64_t replaced = 0;
    for (int i = 0; i < job->width; i++) {
        out[i] = wr_atan(wr_hypot(row->p[i], row->q[i])) * 180 / WR_PI;
        replaced += settle(&out[i]);
    }
    return replaced;
}

/* Rows being computed. */
typedef struct Rows {
    WrDerivativesBand *band;
    WrDerivativesRow row;
    int y;
} Rows;

/* Row of samples beside the texels' centres, which stencils do not reach. */
static void border_row(const WrExportJob *job, int y, const WrDerivativesRow *row)
{
    const double height = job->scene->height;
    const size_t width = (size_t)job->width;
    double *v = wr_alloc(width, sizeof *v);
    for (size_t i = 0; i < width; i++) v[i] = wr_export_row_v(job, y);
    if (!job->analytic)
        wr_field_sample(job->field, (WrScheme)job->options.scheme, width, job->u, v, NULL, row->p,
                        row->q);
    for (int i = 0; i < job->width; i++) {
        double *p = &row->p[i], *q = &row->q[i];
        if (job->analytic) wr_analytic_sample(&job->scene->analytic, job->u[i], v[i], NULL, p, q);
        *p *= height / job->options.cell_w, *q *= height / job->options.cell_h;
    }
    wr_free(v);
}

static Rows open_rows(const WrExportJob *job, int y, int rows)
{
    const WrDerivatives ground = wr_export_ground(job, NULL);
    return (Rows){ job->options.border ? NULL
                                       : wr_derivatives_open(&ground, 0, y, job->width, rows),
                   wr_derivatives_row_new(job->width, false), y };
}

static void close_rows(Rows *rows)
{
    if (rows->band) wr_derivatives_close(rows->band);
    wr_derivatives_row_free(&rows->row);
}

static int64_t derive_row(const WrExportJob *job, const Rows *rows, int y, Derive *derive,
                          double *out)
{
    if (rows->band) wr_derivatives_row(rows->band, y - rows->y, &rows->row);
    else border_row(job, y, &rows->row);
    return derive(job, &rows->row, out);
}

/* ---- the range ---- */

typedef struct Deriving {
    WrExtent extent;
    Derive *derive;
} Deriving;

static void find_extent(WrExportJob *job, int y, int rows, void *ctx)
{
    Deriving *deriving = ctx;
    double low = INFINITY, high = -INFINITY;
    double *row = wr_alloc((size_t)job->width, sizeof *row);
    Rows stretch = open_rows(job, y, rows);
    for (int j = 0; j < rows; j++) {
        derive_row(job, &stretch, y + j, deriving->derive, row);
        for (int i = 0; i < job->width; i++) low = fmin(low, row[i]), high = fmax(high, row[i]);
    }
    close_rows(&stretch);
    wr_free(row);
    wr_export_extent_add(&deriving->extent, low, high);
}

static void find_range(WrExportJob *job, Derive *derive, const char *quantity)
{
    Deriving deriving = { .derive = derive };
    wr_export_extent_init(&deriving.extent);
    wr_export_run(job, 0, job->height, find_extent, &deriving);
    wr_export_extent_finish(&deriving.extent, &job->report);
    job->report.quantity = quantity;
}

void wr_export_slope_prepare(WrExportJob *job)
{
    WrExportReport *report = &job->report;
    find_range(job, steepness, "degrees");
    if (job->options.depth == 32) return;
    report->ranged = true;
    report->code_high = 90;
}

/* ---- rows ---- */

typedef struct Strip {
    int y;
    void *out;
    Derive *derive;
} Strip;

/* Converts a number to a code. */
static double code_of(const WrExportJob *job, double x)
{
    return wr_export_last_code(job) * x / job->report.code_high;
}

static void put(const WrExportJob *job, void *out, size_t at, double x, WrExportTexel texel)
{
    if (job->options.depth == 32) ((float *)out)[at] = (float)x;
    else wr_export_store_code(job, out, at, code_of(job, x), 0, texel);
}

static void derived_piece(WrExportJob *job, int y, int rows, void *ctx)
{
    const Strip *strip = ctx;
    const int channels = job->channels, width = job->width;
    int64_t replaced = 0;
    double *row = wr_alloc((size_t)channels * (size_t)width, sizeof *row);
    Rows stretch = open_rows(job, y, rows);
    for (int j = 0; j < rows; j++) {
        const size_t first = (size_t)(y - strip->y + j) * (size_t)width;
        replaced += derive_row(job, &stretch, y + j, strip->derive, row);
        for (int i = 0; i < channels * width; i++) {
            const int column = i % width, channel = i / width;
            const size_t at = (first + (size_t)column) * (size_t)channels + (size_t)channel;
            put(job, strip->out, at, row[i], (WrExportTexel){ column, y + j, channel });
        }
    }
    close_rows(&stretch);
    wr_free(row);
    __atomic_fetch_add(&job->report.replaced, replaced, __ATOMIC_RELAXED);
}

static void derived_rows(WrExportJob *job, int y, int rows, void *out, Derive *derive)
{
    Strip strip = { y, out, derive };
    wr_export_run(job, y, rows, derived_piece, &strip);
}

void wr_export_slopes_rows(WrExportJob *job, int y, int rows, void *out)
{
    derived_rows(job, y, rows, out, both_slopes);
}

void wr_export_slope_rows(WrExportJob *job, int y, int rows, void *out)
{
    derived_rows(job, y, rows, out, steepness);
}

void wr_export_derived_describe(WrExportJob *job)
{
    const WrExportReport *report = &job->report;
    wr_export_describe_slopes(job);
    if (!report->ranged) return;
    WrText *codes = wr_export_attribute(job, "wrinkle:codes"); /* `range` is the label of heights */
    wr_text_add_number(codes, report->code_low);
    wr_text_add(codes, ",");
    wr_text_add_number(codes, report->code_high);
}
