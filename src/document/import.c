#include "document/document_file.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "field/field.h"
#include "image/image.h"

#include <math.h>

/* Conversion of pictures to heights, one output row at a time: the weighted sum of input rows, then the weighted
   sum of its columns, both in double and in the order of the taps, so that the bits are the same everywhere. No
   buffer is larger than a row. */

/* The filter taps of one output texel on one axis. */
typedef struct Taps {
    int first, count; /* input indices first .. first + count - 1, not yet wrapped */
    double *weight;   /* [count], sum 1 */
} Taps;

typedef struct Axis {
    int from, to; /* number of texels of input and output */
    WrWrap wrap;
    int most; /* maximum number of taps */
} Axis;

static Axis make_axis(int from, int to, WrWrap wrap)
{
    int most = to < from ? (int)ceil((double)from / to) + 2 : 4;
    return (Axis){ from, to, wrap, most };
}

/* Box filter: the part of each input texel that lies under the output texel, [i s, (i+1) s), s = from/to. In
   integers, so that whole ratios give exactly equal weights. */
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

/* Grey value of one pixel; pictures of one or two channels are already grey. */
static inline float grey(const float *pixel, int channels)
{
    float f = channels < 3 ? pixel[0] : wr_image_luma(pixel, channels);
    return isfinite(f) ? f : 0.0f;
}

typedef struct Resampling {
    const WrImage *image; /* the whole picture; or only its header, with `rows` */
    WrImageRows *rows;
    Axis u, v;
    Taps *columns;   /* [u.to] */
    double *weights; /* those of the columns, u.most each, then v.most for the current row */
    double *row;     /* [image width] */
} Resampling;

static const float *input_row(const Resampling *r, int y, WrError *err)
{
    const WrImage *image = r->image;
    if (r->rows) return wr_image_rows_get(r->rows, y, err);
    return image->data + (size_t)y * (size_t)image->width * (size_t)image->channels;
}

/* Without resampling: equals the sums below, including -0 as 0. */
static bool copy_row(const Resampling *r, int j, float *out, WrError *err)
{
    const float *in = input_row(r, j, err);
    int channels = r->image->channels;
    for (int x = 0; in && x < r->u.to; x++) out[x] = grey(in + x * channels, channels) + 0.0f;
    return in != NULL;
}

static bool resample_row(const Resampling *r, int j, float *out, WrError *err)
{
    Taps taps = { 0, 0, r->weights + (size_t)r->u.to * (size_t)r->u.most };
    int channels = r->image->channels;
    find_taps(&r->v, j, &taps);
    for (int x = 0; x < r->u.from; x++) r->row[x] = 0.0;
    for (int k = 0; k < taps.count; k++) {
        const float *in = input_row(r, wrap_index(&r->v, taps.first + k), err);
        if (!in) return false;
        for (int x = 0; x < r->u.from; x++)
            r->row[x] += taps.weight[k] * (double)grey(in + x * channels, channels);
    }
    for (int i = 0; i < r->u.to; i++) {
        const Taps *column = &r->columns[i];
        double sum = 0.0;
        for (int k = 0; k < column->count; k++)
            sum += column->weight[k] * r->row[wrap_index(&r->u, column->first + k)];
        out[i] = (float)sum;
    }
    return true;
}

/* Computes rows [j, j + count) of the table. */
static bool make_rows(const Resampling *r, int j, int count, float *out, WrError *err)
{
    bool same = r->u.from == r->u.to && r->v.from == r->v.to;
    for (int k = 0; k < count; k++, out += r->u.to) {
        if (!wr_progress_report((double)(j + k) / r->v.to)) return wr_fail(err, "cancelled");
        if (!(same ? copy_row : resample_row)(r, j + k, out, err)) return false;
    }
    return true;
}

/* Fills one row of tiles at a time, so that tiles of one height are not allocated; that height is the first
   texel's. */
static WrField *fill_field(const Resampling *r, float *strip, WrError *err)
{
    WrField *field = NULL;
    for (int j = 0; j < r->v.to; j += WR_TILE) {
        int count = r->v.to - j < WR_TILE ? r->v.to - j : WR_TILE;
        bool ok = make_rows(r, j, count, strip, err);
        if (ok && !field)
            ok = (field = wr_field_new(r->u.to, r->v.to, r->u.wrap, r->v.wrap, strip[0], err));
        if (!ok) {
            wr_field_free(field);
            return NULL;
        }
        wr_field_write(field, 0, j, r->u.to, count, strip, (size_t)r->u.to);
    }
    return field;
}

static WrField *resample(Resampling *r, WrError *err)
{
    size_t columns = (size_t)r->u.to;
    WrField *field = NULL;
    r->columns = wr_try_alloc(columns, sizeof *r->columns, "filter taps", err);
    if (!r->columns) return NULL;
    r->weights = wr_try_alloc(columns * (size_t)r->u.most + (size_t)r->v.most, sizeof *r->weights,
                              "filter weights", err);
    r->row = wr_try_alloc((size_t)r->u.from, sizeof *r->row, "a row", err);
    float *strip = wr_try_alloc(columns * WR_TILE, sizeof *strip, "rows of a table", err);
    bool ok = r->weights && r->row && strip;
    for (int i = 0; ok && i < r->u.to && !wr_progress_stopped(); i++) {
        r->columns[i].weight = r->weights + (size_t)i * (size_t)r->u.most;
        find_taps(&r->u, i, &r->columns[i]);
    }
    if (ok) field = fill_field(r, strip, err);
    wr_free(strip);
    wr_free(r->row);
    wr_free(r->weights);
    wr_free(r->columns);
    return field;
}

static WrField *import(const WrImage *image, WrImageRows *rows, int width, int height,
                       WrWrap wrap_u, WrWrap wrap_v, WrError *err)
{
    if (width == 0 && height == 0) {
        width = image->width;
        height = image->height;
    }
    if (width < 1 || width > WR_FIELD_MAX || height < 1 || height > WR_FIELD_MAX) {
        wr_field_new(width, height, wrap_u, wrap_v, 0.0f, err); /* err is set */
        return NULL;
    }
    Resampling r = { .image = image,
                     .rows = rows,
                     .u = make_axis(image->width, width, wrap_u),
                     .v = make_axis(image->height, height, wrap_v) };
    return resample(&r, err);
}

WrField *wr_import_heights(const WrImage *image, int width, int height, WrWrap wrap_u,
                           WrWrap wrap_v, WrError *err)
{
    return import(image, NULL, width, height, wrap_u, wrap_v, err);
}

WrField *wr_import_rows(WrImageRows *rows, int width, int height, WrWrap wrap_u, WrWrap wrap_v,
                        WrError *err)
{
    const WrImage *head = wr_image_rows_head(rows);
    if (height <= head->height) return import(head, rows, width, height, wrap_u, wrap_v, err);
    /* Growing starts with rows from the other end; such a picture is smaller than the table. */
    WrImage *image = wr_image_rows_whole(rows, err);
    if (!image) return NULL;
    WrField *field = import(image, NULL, width, height, wrap_u, wrap_v, err);
    wr_image_free(image);
    return field;
}
