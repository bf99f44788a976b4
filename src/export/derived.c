/* Maps of the table's derivatives: slopes, steepness, curvature. */
#include "export/job.h"

#include "base/exactmath.h"
#include "base/memory.h"
#include "base/pool.h"
#include "field/analytic.h"
#include "field/field.h"
#include "field/scheme.h"
#include "image/image.h"
#include "scene/scene.h"
#include "system/thread.h"

#include <math.h>

/* ---- slopes along a row, in scene units: p and q of the relief over the cell ---- */

typedef struct Slopes {
    double *u, *v, *p, *q; /* [width] each */
} Slopes;

/* A stretch of rows under way. band: NULL for a formula, or where memory is gone. */
typedef struct Rows {
    const WrExportJob *job;
    WrFieldBand *band;
} Rows;

static Rows open_rows(const WrExportJob *job, int y, int rows)
{
    const WrScheme scheme = (WrScheme)job->options.scheme;
    return (Rows){ job, job->analytic ? NULL : wr_field_band_new(job->field, scheme, y, rows) };
}

static void find_slopes_of_table(const Rows *rows, Slopes *s)
{
    const WrExportJob *job = rows->job;
    const size_t count = (size_t)job->width;
    if (rows->band) wr_field_band_sample(rows->band, count, s->u, s->v, NULL, s->p, s->q);
    else
        wr_field_sample(job->field, (WrScheme)job->options.scheme, count, s->u, s->v, NULL, s->p,
                        s->q);
}

static Slopes new_slopes(const WrExportJob *job)
{
    const size_t width = (size_t)job->width;
    double *all = wr_alloc(4 * width, sizeof *all);
    return (Slopes){ all, all + width, all + 2 * width, all + 3 * width };
}

/* At the centres of row y moved by so many texels to the right and upwards. */
static void find_slopes(const Rows *rows, int y, double right, double up, Slopes *s)
{
    const WrExportJob *job = rows->job;
    const double height = job->scene->height, w = job->options.cell_w, h = job->options.cell_h;
    const double v = wr_export_row_v(job, y) + up / job->height;
    for (int i = 0; i < job->width; i++) s->u[i] = job->u[i] + right / job->width, s->v[i] = v;
    if (job->analytic)
        for (int i = 0; i < job->width; i++)
            wr_analytic_sample(&job->scene->analytic, s->u[i], v, NULL, &s->p[i], &s->q[i]);
    else find_slopes_of_table(rows, s);
    for (int i = 0; i < job->width; i++) s->p[i] *= height / w, s->q[i] *= height / h;
}

/* What a kind makes of a row, [width] numbers a channel, one channel after the other; how many were not finite. */
typedef int64_t Derive(const Rows *rows, int y, double *out);

static int64_t settle(double *x)
{
    if (isfinite(*x)) return 0;
    *x = 0;
    return 1;
}

static int64_t both_slopes(const Rows *rows, int y, double *out)
{
    const WrExportJob *job = rows->job;
    Slopes s = new_slopes(job);
    int64_t replaced = 0;
    find_slopes(rows, y, 0, 0, &s);
    for (int i = 0; i < job->width; i++) {
        out[i] = s.p[i], out[job->width + i] = s.q[i];
        replaced += settle(&out[i]) + settle(&out[job->width + i]);
    }
    wr_free(s.u);
    return replaced;
}

static int64_t steepness(const Rows *rows, int y, double *out)
{
    const WrExportJob *job = rows->job;
    Slopes s = new_slopes(job);
    int64_t replaced = 0;
    find_slopes(rows, y, 0, 0, &s);
    for (int i = 0; i < job->width; i++) {
        out[i] = atan(hypot(s.p[i], s.q[i])) * 180 / WR_PI;
        replaced += settle(&out[i]);
    }
    wr_free(s.u);
    return replaced;
}

/* Differences of slopes across a texel, per scene unit. */
static void find_bend(const Rows *rows, int y, bool across, Slopes *a, Slopes *b)
{
    const WrExportJob *job = rows->job;
    const double right = across ? 0.5 : 0, up = across ? 0 : 0.5;
    const double step =
        across ? job->options.cell_w / job->width : job->options.cell_h / job->height;
    find_slopes(rows, y, right, up, a);
    find_slopes(rows, y, -right, -up, b);
    for (int i = 0; i < job->width; i++) {
        a->p[i] = (a->p[i] - b->p[i]) / step;
        a->q[i] = (a->q[i] - b->q[i]) / step;
    }
}

static int64_t bend(const Rows *rows, int y, double *out)
{
    const WrExportJob *job = rows->job;
    Slopes at = new_slopes(job), u = new_slopes(job), v = new_slopes(job), other = new_slopes(job);
    int64_t replaced = 0;
    find_slopes(rows, y, 0, 0, &at);
    find_bend(rows, y, true, &u, &other);
    find_bend(rows, y, false, &v, &other);
    for (int i = 0; i < job->width; i++) {
        const double p = at.p[i], q = at.q[i], n2 = 1 + p * p + q * q;
        const double r = u.p[i], s = 0.5 * (u.q[i] + v.p[i]), t = v.q[i];
        const double sum = (1 + q * q) * r - 2 * p * q * s + (1 + p * p) * t;
        out[i] = -sum / (2 * n2 * sqrt(n2));
        replaced += settle(&out[i]);
    }
    wr_free(at.u), wr_free(u.u), wr_free(v.u), wr_free(other.u);
    return replaced;
}

/* ---- the range ---- */

typedef struct Extent {
    WrMutex lock;
    Derive *derive;
    double low, high;
} Extent;

static void find_extent(WrExportJob *job, int y, int rows, void *ctx)
{
    Extent *extent = ctx;
    double low = INFINITY, high = -INFINITY;
    double *row = wr_alloc((size_t)job->width, sizeof *row);
    const Rows stretch = open_rows(job, y, rows);
    for (int j = 0; j < rows; j++) {
        extent->derive(&stretch, y + j, row);
        for (int i = 0; i < job->width; i++) low = fmin(low, row[i]), high = fmax(high, row[i]);
    }
    wr_field_band_free(stretch.band);
    wr_free(row);
    wr_mutex_lock(&extent->lock);
    extent->low = fmin(extent->low, low);
    extent->high = fmax(extent->high, high);
    wr_mutex_unlock(&extent->lock);
}

static void find_range(WrExportJob *job, Derive *derive, const char *quantity)
{
    Extent extent = { .derive = derive, .low = INFINITY, .high = -INFINITY };
    wr_mutex_init(&extent.lock);
    wr_export_run(job, 0, job->height, find_extent, &extent);
    wr_mutex_fini(&extent.lock);
    job->report.low = extent.low;
    job->report.high = extent.high;
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

void wr_export_curvature_prepare(WrExportJob *job)
{
    WrExportReport *report = &job->report;
    find_range(job, bend, "curvature");
    if (job->options.depth == 32) return;
    const double most = fmax(fabs(report->low), fabs(report->high));
    report->ranged = true;
    report->amplitude = job->options.full > 0 ? job->options.full : most;
    report->zero_code = (int)(wr_export_last_code(job) + 1) / 2;
    const double step = report->amplitude / (report->zero_code - 1);
    report->code_low = -step * report->zero_code;
    report->code_high = step * (wr_export_last_code(job) - report->zero_code);
}

/* ---- rows ---- */

typedef struct Strip {
    int y;
    void *out;
    Derive *derive;
} Strip;

/* A number in codes above the code of 0. */
static double code_of(const WrExportJob *job, double x)
{
    const WrExportReport *report = &job->report;
    if (report->zero_code < 0) return wr_export_last_code(job) * x / report->code_high;
    return report->amplitude > 0 ? (report->zero_code - 1) * x / report->amplitude : 0;
}

static void put(const WrExportJob *job, void *out, size_t at, double x, WrExportTexel texel)
{
    const int zero = job->report.zero_code < 0 ? 0 : job->report.zero_code;
    if (job->options.depth == 32) ((float *)out)[at] = (float)x;
    else wr_export_store_code(job, out, at, code_of(job, x), zero, texel);
}

static void derived_piece(WrExportJob *job, int y, int rows, void *ctx)
{
    const Strip *strip = ctx;
    const int channels = job->kind->channels, width = job->width;
    const double full = job->report.amplitude;
    int64_t replaced = 0, clipped = 0;
    double *row = wr_alloc((size_t)(channels * width), sizeof *row);
    const Rows stretch = open_rows(job, y, rows);
    for (int j = 0; j < rows; j++) {
        const size_t first = (size_t)(y - strip->y + j) * (size_t)width;
        replaced += strip->derive(&stretch, y + j, row);
        for (int i = 0; i < channels * width; i++) {
            const int column = i % width, channel = i / width;
            const size_t at = (first + (size_t)column) * (size_t)channels + (size_t)channel;
            clipped += job->options.full > 0 && job->options.depth != 32 && fabs(row[i]) > full;
            put(job, strip->out, at, row[i], (WrExportTexel){ column, y + j, channel });
        }
    }
    wr_field_band_free(stretch.band);
    wr_free(row);
    __atomic_fetch_add(&job->report.replaced, replaced, __ATOMIC_RELAXED);
    __atomic_fetch_add(&job->report.clipped, clipped, __ATOMIC_RELAXED);
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

void wr_export_curvature_rows(WrExportJob *job, int y, int rows, void *out)
{
    derived_rows(job, y, rows, out, bend);
}

void wr_export_derived_describe(WrExportJob *job)
{
    const WrExportReport *report = &job->report;
    wr_export_describe_slopes(job);
    if (!report->ranged) return;
    WrText *codes = wr_export_attribute(job, "wrinkle:codes"); /* `range` is of heights */
    wr_text_add_number(codes, report->code_low);
    wr_text_add(codes, ",");
    wr_text_add_number(codes, report->code_high);
}
