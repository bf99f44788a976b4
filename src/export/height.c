#include "export/job.h"

#include "base/memory.h"
#include "field/analytic.h"
#include "field/field.h"
#include "field/scheme.h"
#include "image/image.h"
#include "scene/scene.h"

#include <math.h>

/* Heights by the scheme, for samples that are not at texels' centres. */
static void sample_border(const WrExportJob *job, int y, int rows, float *out)
{
    const size_t width = (size_t)job->width;
    double *v = wr_alloc(2 * width, sizeof *v), *f = v + width;
    for (int j = 0; j < rows; j++, out += width) {
        for (size_t i = 0; i < width; i++) v[i] = wr_export_row_v(job, y + j);
        wr_field_sample(job->field, (WrScheme)job->options.scheme, width, job->u, v, f, NULL, NULL);
        for (size_t i = 0; i < width; i++) out[i] = (float)f[i];
    }
    wr_free(v);
}

/* Only formulas can give non-finite heights. */
int64_t wr_export_heights(const WrExportJob *job, int y, int rows, float *out)
{
    if (!job->analytic && job->options.border) {
        sample_border(job, y, rows, out);
        return 0;
    }
    if (!job->analytic) {
        wr_field_read(job->field, 0, y, job->width, rows, out, (size_t)job->width);
        return 0;
    }
    int64_t replaced = 0;
    for (int j = 0; j < rows; j++) {
        double v = wr_export_row_v(job, y + j);
        for (int i = 0; i < job->width; i++) {
            double f;
            wr_analytic_sample(&job->scene->analytic, job->u[i], v, &f, NULL, NULL);
            float value = (float)f;
            bool good = isfinite(value);
            replaced += !good;
            *out++ = good ? value : 0.0f;
        }
    }
    return replaced;
}

/* ---- range of a formula: sampled like the file itself ---- */

static void find_extent(WrExportJob *job, int y, int rows, void *ctx)
{
    WrExtent *extent = ctx;
    float *row = wr_alloc((size_t)job->width, sizeof *row);
    double low = INFINITY, high = -INFINITY;
    for (int j = 0; j < rows; j++) {
        wr_export_heights(job, y + j, 1, row);
        for (int i = 0; i < job->width; i++) {
            low = row[i] < low ? row[i] : low;
            high = row[i] > high ? row[i] : high;
        }
    }
    wr_free(row);
    wr_export_extent_add(extent, low, high);
}

/* Stores the smallest and largest F in the report. */
static void find_range(WrExportJob *job)
{
    if (job->analytic || job->options.border) {
        WrExtent extent;
        wr_export_extent_init(&extent);
        for (int y = 0; y < job->height; y += WR_IMAGE_STRIP) {
            int rows = job->height - y < WR_IMAGE_STRIP ? job->height - y : WR_IMAGE_STRIP;
            wr_export_run(job, y, rows, find_extent, &extent);
        }
        wr_export_extent_finish(&extent, &job->report);
    } else {
        float low, high;
        wr_field_range(job->field, &low, &high);
        job->report.low = low;
        job->report.high = high;
    }
}

/* ---- codes ---- */

/* Codes and heights are related linearly, code 0 at code_low and code `last` at code_high. The signed range has an exact code
   for 0, zero = (last + 1) / 2, and a step of amplitude / (zero - 1):
       8 bits: zero 128, codes 1 .. 255 for -amplitude .. amplitude;   16 bits: zero 32768, codes 1 .. 65535
   Code 0 lies one step below -amplitude and is used by no height, so the range is symmetric. */
void wr_export_height_prepare(WrExportJob *job)
{
    WrExportReport *report = &job->report;
    find_range(job);
    if (job->options.depth == 32) return;
    report->ranged = true;
    report->zero_code = -1;
    double last = wr_export_last_code(job);
    switch (job->options.range) {
    case WR_EXPORT_RANGE_GIVEN:
        report->code_low = job->options.low;
        report->code_high = job->options.high;
        break;
    case WR_EXPORT_RANGE_AUTO:
        report->code_low = report->low;
        report->code_high = report->high;
        /* Flat: any width yields code 0; 1 unless that is lost beside a huge height. */
        if (!(report->code_high > report->code_low))
            report->code_high = report->code_low + fmax(1.0, fabs(report->code_low) * 0x1p-20);
        break;
    case WR_EXPORT_RANGE_SIGNED:
        report->amplitude = job->options.amplitude > 0.0
                                ? job->options.amplitude
                                : fmax(fabs(report->low), fabs(report->high));
        report->zero_code = (int)(last + 1.0) / 2;
        double step = report->amplitude / (report->zero_code - 1);
        report->code_low = -step * report->zero_code;
        report->code_high = step * (last - report->zero_code);
        break;
    }
}

/* F in codes relative to report->zero_code (or 0), not yet rounded. */
static double code_of(const WrExportJob *job, double f)
{
    const WrExportReport *report = &job->report;
    if (report->zero_code < 0)
        return wr_export_last_code(job) * (f - report->code_low) /
               (report->code_high - report->code_low);
    return report->amplitude > 0.0 ? (report->zero_code - 1) * f / report->amplitude : 0.0;
}

typedef struct Strip {
    int y;
    void *out;
} Strip;

/* Runs on the pool's threads for disjoint rows of one strip; `out` is the strip's buffer, whose first row is `y` of the
   strip. Only the counters are shared, and sums of integers do not depend on the order. */
static void height_piece(WrExportJob *job, int y, int rows, void *ctx)
{
    const Strip *strip = ctx;
    size_t width = (size_t)job->width, first = (size_t)(y - strip->y) * width;
    int64_t replaced = 0, clipped = 0;
    if (job->options.depth == 32) {
        replaced = wr_export_heights(job, y, rows, (float *)strip->out + first);
    } else {
        float *row = wr_alloc(width, sizeof *row);
        bool given = job->options.range == WR_EXPORT_RANGE_GIVEN;
        double low = job->report.code_low, high = job->report.code_high;
        int zero = job->report.zero_code < 0 ? 0 : job->report.zero_code;
        for (int j = 0; j < rows; j++) {
            replaced += wr_export_heights(job, y + j, 1, row);
            for (int i = 0; i < job->width; i++) {
                clipped += given && (row[i] < low || row[i] > high);
                wr_export_store_code(job, strip->out, first + (size_t)j * width + (size_t)i,
                                     code_of(job, row[i]), zero, (WrExportTexel){ i, y + j, 0 });
            }
        }
        wr_free(row);
    }
    __atomic_fetch_add(&job->report.replaced, replaced, __ATOMIC_RELAXED);
    __atomic_fetch_add(&job->report.clipped, clipped, __ATOMIC_RELAXED);
}

void wr_export_height_rows(WrExportJob *job, int y, int rows, void *out)
{
    Strip strip = { y, out };
    wr_export_run(job, y, rows, height_piece, &strip);
}

void wr_export_height_describe(WrExportJob *job)
{
    const WrExportReport *report = &job->report;
    char buffer[WR_NUMBER_SIZE];
    WrText *text = wr_export_attribute(job, "wrinkle:range");
    if (report->ranged) {
        wr_text_add_number(text, report->code_low);
        wr_text_add(text, ",");
        wr_text_add_number(text, report->code_high);
    } else {
        wr_text_addf(text, "%s,", wr_number_print_float((float)report->low, buffer));
        wr_text_add(text, wr_number_print_float((float)report->high, buffer));
    }
    text = wr_export_attribute(job, "wrinkle:zero");
    if (report->ranged && report->zero_code >= 0) {
        wr_text_addf(text, "%d", report->zero_code);
        wr_text_add_number(wr_export_attribute(job, "wrinkle:amplitude"), report->amplitude);
    } else if (!report->ranged) {
        wr_text_add(text, "0");
    } else { /* 0 is between two codes */
        wr_text_add_number(text, code_of(job, 0.0));
    }
}
