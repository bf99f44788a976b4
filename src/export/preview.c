#include "export/preview.h"

#include "base/error.h"
#include "base/memory.h"
#include "document/document.h"
#include "export/job.h"
#include "field/field.h"

#include <math.h>

/* Source and destination of a picture's rows. */
typedef struct Codes {
    const uint8_t *from;
    uint8_t *rgb;
} Codes;

/* One number 0..255 per channel; two channels are red and green. */
static void put_codes(WrExportJob *job, int y, int rows, void *ctx)
{
    const Codes *codes = ctx;
    const int channels = job->channels;
    const size_t first = (size_t)y * (size_t)job->width, count = (size_t)rows * (size_t)job->width;
    const uint8_t *restrict from = codes->from + first * (size_t)channels;
    uint8_t *restrict rgb = codes->rgb + 3 * first;
    for (size_t i = 0; channels == 1 && i < count; i++)
        rgb[3 * i] = rgb[3 * i + 1] = rgb[3 * i + 2] = from[i];
    for (size_t i = 0; channels > 1 && i < count; i++)
        for (int c = 0; c < 3; c++)
            rgb[3 * i + (size_t)c] = c < channels ? from[i * (size_t)channels + (size_t)c] : 128;
}

/* Floats, 0 in the middle, the largest magnitude white or black. */
static void put_floats(const float *from, int channels, size_t count, uint8_t *rgb)
{
    double most = 0;
    for (size_t i = 0; i < count * (size_t)channels; i++) most = fmax(most, fabs((double)from[i]));
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) {
            const bool there = channels == 1 || c < channels;
            const size_t at = i * (size_t)channels + (size_t)(channels == 1 ? 0 : c);
            const double x = there && most > 0 ? from[at] / most : 0;
            rgb[3 * i + (size_t)c] = (uint8_t)lrint(127.5 + 127.4 * x);
        }
}

static size_t value_bytes(const WrExportJob *job)
{
    return job->options.depth == 32 ? sizeof(float) : (size_t)job->options.depth / 8;
}

/* Computes the map's values, [height][width][channels] of the options' depth. */
static bool compute(WrExportJob *job, void *values, WrError *err)
{
    if (job->kind->make && !job->kind->make(job, err)) return false;
    if (job->kind->prepare) job->kind->prepare(job);
    job->kind->rows(job, 0, job->height, values);
    return true;
}

bool wr_export_fill_values(WrExportJob *job, WrError *err)
{
    const size_t count = (size_t)job->width * (size_t)job->height * (size_t)job->channels;
    job->values->data = wr_try_alloc_unset(count, value_bytes(job), "a map in memory", err);
    return job->values->data && compute(job, job->values->data, err);
}

bool wr_export_fill_preview(WrExportJob *job, WrError *err)
{
    WrExportPreview *picture = job->picture;
    const size_t count = (size_t)job->width * (size_t)job->height;
    const int channels = job->channels;
    const size_t each = value_bytes(job);
    const bool as_they_are = each == 1 && channels == 3;
    picture->rgb = wr_try_alloc_unset(count, 3, "a picture of a map", err);
    char *values = as_they_are    ? (char *)picture->rgb
                   : picture->rgb ? wr_try_alloc_unset(count * (size_t)channels, each,
                                                       "a picture of a map", err)
                                  : NULL;
    const bool made = values && compute(job, values, err);
    if (made) {
        if (each == 1 && !as_they_are)
            wr_export_run(job, 0, job->height, put_codes,
                          &(Codes){ (const uint8_t *)values, picture->rgb });
        else if (each != 1)
            put_floats((const float *)(const void *)values, channels, count, picture->rgb);
        picture->width = job->width;
        picture->height = job->height;
    }
    if (!as_they_are) wr_free(values);
    return made;
}

void wr_export_preview_fini(WrExportPreview *picture)
{
    wr_free(picture->rgb);
    *picture = (WrExportPreview){ 0 };
}

/* ---- numbers ---- */

void wr_export_extent_init(WrExtent *extent)
{
    extent->low = INFINITY, extent->high = -INFINITY;
    wr_mutex_init(&extent->lock);
}

void wr_export_extent_add(WrExtent *extent, double low, double high)
{
    wr_mutex_lock(&extent->lock);
    extent->low = fmin(extent->low, low);
    extent->high = fmax(extent->high, high);
    wr_mutex_unlock(&extent->lock);
}

void wr_export_extent_finish(WrExtent *extent, WrExportReport *report)
{
    wr_mutex_fini(&extent->lock);
    report->low = extent->low;
    report->high = extent->high;
}

static void count_row(const float *row, int width, WrHistogram *out)
{
    const double scale = out->high > out->low ? WR_HISTOGRAM / (out->high - out->low) : 0;
    for (int i = 0; i < width; i++) {
        const int bar = (int)(((double)row[i] - out->low) * scale);
        out->count[bar < 0 ? 0 : bar < WR_HISTOGRAM ? bar : WR_HISTOGRAM - 1]++;
    }
}

WrHistogram wr_export_histogram(const WrDocument *document, double from, double to)
{
    const WrField *field = wr_document_field(document);
    const int width = wr_field_width(field);
    WrHistogram out = { 0 };
    float low, high, *row = wr_alloc_unset((size_t)width, sizeof *row);
    wr_field_range(field, &low, &high);
    out.low = low;
    out.high = high;
    for (int j = 0; j < wr_field_height(field); j++) {
        wr_field_read(field, 0, j, width, 1, row, (size_t)width);
        count_row(row, width, &out);
        for (int i = 0; i < width; i++) out.outside += (double)row[i] < from || (double)row[i] > to;
    }
    wr_free(row);
    return out;
}

double wr_export_estimate_bytes(const WrExportKind *kind, int width, int height, int depth)
{
    return (double)width * height * (kind->channels > 0 ? kind->channels : 1) * (depth / 8.0);
}
