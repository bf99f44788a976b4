#include "document/document_file.h"

#include "base/memory.h"
#include "base/progress.h"

#include <math.h>

/* Pictures become heights one output row at a time: the weighted sum of input rows, then the weighted
 * sum of its columns, both in double and in the order of the taps, so that the bits are the same
 * everywhere. Nothing larger than a row is kept. */

/* The taps of one output texel on one axis. */
typedef struct Taps {
    int first, count; /* input indices first .. first + count - 1, not yet wrapped */
    double *weight;   /* [count], sum 1 */
} Taps;

typedef struct Axis {
    int from, to; /* texels of input and output */
    WrWrap wrap;
    int most; /* taps at most */
} Axis;

static Axis make_axis(int from, int to, WrWrap wrap)
{
    int most = to < from ? (int)ceil((double)from / to) + 2 : 4;
    return (Axis){ from, to, wrap, most };
}

/* Box filter: the part of each input texel that lies under the output texel, [i s, (i+1) s), s = from/to. In
 * integers, so that whole ratios give equal weights exactly. */
static void box_taps(const Axis *axis, int i, Taps *taps)
{
    int64_t from = axis->from, to = axis->to;
    int64_t begin = i * from, end = begin + from; /* in units of 1/to input texels */
    taps->first = (int)(begin / to);
    taps->count = 0;
    for (int64_t k = taps->first; k * to < end; k++) {
        int64_t left = k * to > begin ? k * to : begin;
        int64_t right = (k + 1) * to < end ? (k + 1) * to : end;
        taps->weight[taps->count++] = (double)(right - left) / (double)from;
    }
}

/* Catmull-Rom through the input's texel centres: x = (i + 1/2) s - 1/2, reduced in integers. */
static void cubic_taps(const Axis *axis, int i, Taps *taps)
{
    int64_t from = axis->from, to = axis->to;
    int64_t twice = (2 * i + 1) * from - to; /* x = twice / (2 to), above -1 */
    int64_t cell = (twice + 2 * to) / (2 * to) - 1;
    double t = (double)(twice - cell * 2 * to) / (double)(2 * to);
    taps->first = (int)cell - 1;
    taps->count = 4;
    taps->weight[0] = 0.5 * t * (t * (2.0 - t) - 1.0);
    taps->weight[1] = 0.5 * (t * t * (3.0 * t - 5.0) + 2.0);
    taps->weight[2] = 0.5 * t * (t * (4.0 - 3.0 * t) + 1.0);
    taps->weight[3] = 0.5 * t * t * (t - 1.0);
}

static void find_taps(const Axis *axis, int i, Taps *taps)
{
    if (axis->to == axis->from) {
        taps->first = i;
        taps->count = 1;
        taps->weight[0] = 1.0;
    } else if (axis->to < axis->from) {
        box_taps(axis, i, taps);
    } else {
        cubic_taps(axis, i, taps);
    }
}

static int wrap_index(const Axis *axis, int i)
{
    int n = axis->from;
    if (axis->wrap == WR_WRAP_CLAMP) return i < 0 ? 0 : i >= n ? n - 1 : i;
    i %= n;
    return i < 0 ? i + n : i;
}

static double grey(const WrImage *image, int x, int y)
{
    size_t at = ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels;
    double f = wr_image_luma(image->data + at, image->channels);
    return isfinite(f) ? f : 0.0;
}

typedef struct Resampling {
    const WrImage *image;
    Axis u, v;
    Taps *columns;   /* [u.to] */
    double *weights; /* those of the columns, u.most each, then v.most for the present row */
    double *row;     /* [image width] */
} Resampling;

static void resample_row(const Resampling *r, int j, float *out)
{
    Taps taps = { 0, 0, r->weights + (size_t)r->u.to * (size_t)r->u.most };
    find_taps(&r->v, j, &taps);
    for (int x = 0; x < r->u.from; x++) r->row[x] = 0.0;
    for (int k = 0; k < taps.count; k++) {
        int y = wrap_index(&r->v, taps.first + k);
        for (int x = 0; x < r->u.from; x++) r->row[x] += taps.weight[k] * grey(r->image, x, y);
    }
    for (int i = 0; i < r->u.to; i++) {
        const Taps *column = &r->columns[i];
        double sum = 0.0;
        for (int k = 0; k < column->count; k++)
            sum += column->weight[k] * r->row[wrap_index(&r->u, column->first + k)];
        out[i] = (float)sum;
    }
}

static bool resample(Resampling *r, WrField *field, WrError *err)
{
    size_t columns = (size_t)r->u.to;
    r->columns = wr_try_alloc(columns, sizeof *r->columns, "filter taps", err);
    if (!r->columns) return false;
    r->weights = wr_try_alloc(columns * (size_t)r->u.most + (size_t)r->v.most, sizeof *r->weights,
                              "filter weights", err);
    r->row = wr_try_alloc((size_t)r->u.from, sizeof *r->row, "a row", err);
    float *out = wr_try_alloc(columns, sizeof *out, "a row", err);
    bool ok = r->weights && r->row && out;
    for (int i = 0; ok && i < r->u.to && !wr_progress_stopped(); i++) {
        r->columns[i].weight = r->weights + (size_t)i * (size_t)r->u.most;
        find_taps(&r->u, i, &r->columns[i]);
    }
    for (int j = 0; ok && j < r->v.to; j++) {
        if (!wr_progress_tell((double)j / r->v.to)) ok = wr_fail(err, "cancelled");
        if (!ok) break;
        resample_row(r, j, out);
        wr_field_write(field, 0, j, r->u.to, 1, out, columns);
    }
    wr_free(out);
    wr_free(r->row);
    wr_free(r->weights);
    wr_free(r->columns);
    return ok;
}

WrField *wr_import_heights(const WrImage *image, int width, int height, WrWrap wrap_u,
                           WrWrap wrap_v, WrError *err)
{
    if (width == 0 && height == 0) {
        width = image->width;
        height = image->height;
    }
    WrField *field = wr_field_new(width, height, wrap_u, wrap_v, 0.0f, err);
    if (!field) return NULL;
    Resampling r = { .image = image,
                     .u = make_axis(image->width, width, wrap_u),
                     .v = make_axis(image->height, height, wrap_v) };
    if (resample(&r, field, err)) return field;
    wr_field_free(field);
    return NULL;
}
