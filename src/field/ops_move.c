/* Operations that move texels: offset, flips, quarter turns, crop, resize. */
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/progress.h"
#include "field/field.h"
#include "field/ops_internal.h"

#include <math.h>
#include <string.h>

/* ---- offset, flips, quarter turns, crop ---- */

/* Result texel (i, j) is input texel (i + du, j + dv). */
typedef struct Shift {
    int du, dv;
} Shift;

static void make_shifted(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out, size_t pitch,
                         void *scratch)
{
    (void)scratch;
    const Shift *shift = ctx;
    wr_op_read(job->in, b.i + shift->du, b.j + shift->dv, b.count_i, b.count_j, out, pitch);
}

/* A shift in texels: a number between -1 and 1 is a fraction of the side, rounded to whole texels. */
static int texels_of(double shift, int side)
{
    return (int)(fabs(shift) < 1.0 ? round(shift * side) : shift);
}

/* param: du, dv. The source of a shift to the right or upwards is to the left or below, and rows run
 * down. */
WrField *wr_op_offset(WrOpJob *job, const double *param)
{
    Shift shift = { -texels_of(param[0], wr_field_width(job->in)),
                    texels_of(param[1], wr_field_height(job->in)) };
    WrOpWork work = { .make = make_shifted, .ctx = &shift, .reach = -1, .moves = true };
    return wr_op_build_same(job, &work);
}

static void swap_floats(float *a, float *b)
{
    float was = *a;
    *a = *b;
    *b = was;
}

static void reverse_columns(float *out, size_t pitch, int count_i, int count_j)
{
    for (int y = 0; y < count_j; y++)
        for (int x = 0, end = count_i - 1; x < end; x++, end--)
            swap_floats(out + (size_t)y * pitch + x, out + (size_t)y * pitch + end);
}

static void reverse_rows(float *out, size_t pitch, int count_i, int count_j)
{
    for (int y = 0, end = count_j - 1; y < end; y++, end--)
        for (int x = 0; x < count_i; x++)
            swap_floats(out + (size_t)y * pitch + x, out + (size_t)end * pitch + x);
}

static int mirrored(int i, int count, int n)
{
    return n - i - count;
}

static void make_flipped_u(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out,
                           size_t pitch, void *scratch)
{
    (void)ctx, (void)scratch;
    int i = mirrored(b.i, b.count_i, wr_field_width(job->in));
    wr_field_read(job->in, i, b.j, b.count_i, b.count_j, out, pitch);
    reverse_columns(out, pitch, b.count_i, b.count_j);
}

static void make_flipped_v(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out,
                           size_t pitch, void *scratch)
{
    (void)ctx, (void)scratch;
    int j = mirrored(b.j, b.count_j, wr_field_height(job->in));
    wr_field_read(job->in, b.i, j, b.count_i, b.count_j, out, pitch);
    reverse_rows(out, pitch, b.count_i, b.count_j);
}

WrField *wr_op_flip_u(WrOpJob *job, const double *param)
{
    (void)param;
    WrOpWork work = { .make = make_flipped_u, .reach = -1, .moves = true };
    return wr_op_build_same(job, &work);
}

WrField *wr_op_flip_v(WrOpJob *job, const double *param)
{
    (void)param;
    WrOpWork work = { .make = make_flipped_v, .reach = -1, .moves = true };
    return wr_op_build_same(job, &work);
}

/* Counter-clockwise: the top right corner becomes the top left,
 *    90: out(i, j) = in(W - 1 - j, i)    270: out(i, j) = in(j, H - 1 - i) */
static void make_quarter_turn(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out,
                              size_t pitch, void *scratch)
{
    bool back = *(const int *)ctx == 2; /* 270 */
    float *from = scratch;
    int i = back ? b.j : mirrored(b.j, b.count_j, wr_field_width(job->in));
    int j = back ? mirrored(b.i, b.count_i, wr_field_height(job->in)) : b.i;
    wr_field_read(job->in, i, j, b.count_j, b.count_i, from, WR_OP_SIDE);
    for (int y = 0; y < b.count_j; y++)
        for (int x = 0; x < b.count_i; x++) {
            int column = back ? y : b.count_j - 1 - y, row = back ? b.count_i - 1 - x : x;
            out[(size_t)y * pitch + x] = from[row * WR_OP_SIDE + column];
        }
}

static void make_half_turn(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out,
                           size_t pitch, void *scratch)
{
    (void)ctx, (void)scratch;
    wr_field_read(job->in, mirrored(b.i, b.count_i, wr_field_width(job->in)),
                  mirrored(b.j, b.count_j, wr_field_height(job->in)), b.count_i, b.count_j, out,
                  pitch);
    reverse_columns(out, pitch, b.count_i, b.count_j);
    reverse_rows(out, pitch, b.count_i, b.count_j);
}

/* param: index of 90, 180, 270 degrees. The axes' wraps turn with the texels. */
WrField *wr_op_rotate(WrOpJob *job, const double *param)
{
    const WrField *in = job->in;
    int quarter = (int)param[0];
    bool half = quarter == 1;
    WrField *base = half ? wr_field_share(in)
                         : wr_op_base(job, wr_field_height(in), wr_field_width(in),
                                      wr_field_wrap_v(in), wr_field_wrap_u(in));
    WrOpWork work = { .make = half ? make_half_turn : make_quarter_turn,
                      .ctx = &quarter,
                      .scratch = sizeof(float) * WR_OP_SIDE * WR_OP_SIDE,
                      .reach = -1,
                      .moves = true };
    return wr_op_build(job, base, &work);
}

static bool check_span(const WrOpJob *job, const char *axis, int from, int count, int n,
                       WrWrap wrap)
{
    if (count > n)
        return wr_fail(job->err, "%s: %d texels along %s: the table has %d", job->name, count, axis,
                       n);
    if (wrap == WR_WRAP_CLAMP && from + count > n)
        return wr_fail(job->err,
                       "%s: texels %d to %d along %s: the table ends at %d, and that axis is "
                       "not periodic",
                       job->name, from, from + count - 1, axis, n - 1);
    if (from >= n)
        return wr_fail(job->err, "%s: starts at texel %d along %s: the last is %d", job->name, from,
                       axis, n - 1);
    return true;
}

/* param: x, y of the rectangle's top left texel, width, height. */
WrField *wr_op_crop(WrOpJob *job, const double *param)
{
    const WrField *in = job->in;
    int i = (int)param[0], j = (int)param[1], width = (int)param[2], height = (int)param[3];
    if (!check_span(job, "u", i, width, wr_field_width(in), wr_field_wrap_u(in)) ||
        !check_span(job, "v", j, height, wr_field_height(in), wr_field_wrap_v(in)))
        return NULL;
    Shift shift = { i, j };
    WrOpWork work = { .make = make_shifted, .ctx = &shift, .reach = -1, .moves = true };
    return wr_op_build(job, wr_op_base(job, width, height, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC),
                       &work);
}

/* ---- resize ---- */

/* Resize with a separable filter.
 *
 * Output texel i of n samples the position x = (i + 1/2) N/n - 1/2 of the N input texels. A filter f,
 * which is stretched by s = N/n when shrinking, weights input texel k by f((k - x)/s); the weights of
 * one output texel are divided by their sum, so that flat tables stay flat. For integer ratios, each
 * input texel also has the same total weight over all output texels, so that the mean is preserved, if
 * f's values one apart add to 1 at every offset. Triangle and Catmull-Rom do; Lanczos does after
 * division by that sum. `box` is the mean over the area of an output texel, exact for any ratio.
 *
 * A block of the result reads its input rows once: each is filtered along u and added to the output
 * rows that use it, so that even a shrink of 16384 rows to one needs little memory. */

#define SIDE WR_OP_SIDE

/* One axis: output texel i uses taps[i].count input texels from taps[i].from on, which may lie outside;
   weights from weight + i * most. */
typedef struct Taps {
    int from, count;
} Taps;
typedef struct Axis {
    int most;   /* maximum number of taps */
    bool folds; /* the taps may exceed the input: every output uses all input texels */
    Taps *taps;
    double *weight; /* [outputs][most] */
} Axis;

typedef struct Resize {
    Axis u, v;
} Resize;

static double sinc(double x)
{
    if (x == 0.0) return 1.0;
    double sine, cosine;
    wr_sincos_turns(0.5 * x, &sine, &cosine);
    return sine / (WR_PI * x);
}

static double lanczos3(double x)
{
    return fabs(x) < 3.0 ? sinc(x) * sinc(x / 3.0) : 0.0;
}

static double filter_value(int filter, double x)
{
    double a = fabs(x);
    if (filter == WR_RESIZE_LINEAR) return a < 1.0 ? 1.0 - a : 0.0;
    if (filter == WR_RESIZE_CATMULL)
        return a < 1.0   ? 1.0 + a * a * (1.5 * a - 2.5)
               : a < 2.0 ? 2.0 + a * (-4.0 + a * (2.5 - 0.5 * a))
                         : 0.0;
    double sum = 0.0, part = x - floor(x);
    for (int k = -3; k < 3; k++) sum += lanczos3(part + k);
    return lanczos3(x) / sum;
}

/* Maximum number of input texels on either side of an output texel's position. */
static double filter_reach(int filter, double ratio)
{
    double stretch = ratio > 1.0 ? ratio : 1.0;
    if (filter == WR_RESIZE_BOX) return 0.5 * ratio + 0.5;
    return stretch * (filter == WR_RESIZE_LINEAR ? 1.0 : filter == WR_RESIZE_CATMULL ? 2.0 : 3.0);
}

/* The part of input texel k, which covers k - 1/2 .. k + 1/2, inside low .. high. */
static double covered(double k, double low, double high)
{
    double from = k - 0.5 > low ? k - 0.5 : low, to = k + 0.5 < high ? k + 0.5 : high;
    return to > from ? to - from : 0.0;
}

/* A sum of double weights is 1 to about 1e-14; float's rounding of a flat table's height removes that
   error. */
static void divide_by_sum(double *weight, int count)
{
    double sum = 0.0;
    for (int k = 0; k < count; k++) sum += weight[k];
    for (int k = 0; k < count; k++) weight[k] /= sum;
}

/* Maps taps outside the table to the texels that they represent: from = 0, count = n. */
static void fold(Taps *taps, double *weight, const double *wide, int n, WrWrap wrap)
{
    memset(weight, 0, sizeof *weight * (size_t)n);
    for (int k = 0; k < taps->count; k++) {
        int64_t at = (int64_t)taps->from + k;
        if (wrap == WR_WRAP_CLAMP) at = at < 0 ? 0 : at < n ? at : n - 1;
        else at = (at % n + n) % n;
        weight[at] += wide[k];
    }
    *taps = (Taps){ 0, n };
}

static void set_taps(Axis *axis, int index, int filter, int n, int out, WrWrap wrap, double *wide)
{
    double ratio = (double)n / out, x = (index + 0.5) * ratio - 0.5;
    double stretch = ratio > 1.0 ? ratio : 1.0;
    double half = filter_reach(filter, ratio);
    Taps *taps = &axis->taps[index];
    taps->from = (int)ceil(x - half);
    taps->count = (int)floor(x + half) - taps->from + 1;
    for (int k = 0; k < taps->count; k++) {
        double at = (double)taps->from + k;
        wide[k] = filter == WR_RESIZE_BOX ? covered(at, x - 0.5 * ratio, x + 0.5 * ratio)
                                          : filter_value(filter, (at - x) / stretch);
    }
    double *weight = axis->weight + (size_t)index * (size_t)axis->most;
    if (axis->folds) fold(taps, weight, wide, n, wrap);
    else memcpy(weight, wide, sizeof *wide * (size_t)taps->count);
    divide_by_sum(weight, taps->count);
}

static bool axis_init(Axis *axis, const WrOpJob *job, int filter, int n, int out, WrWrap wrap)
{
    int widest = (int)(2.0 * filter_reach(filter, (double)n / out)) + 1;
    axis->folds = widest > n;
    axis->most = axis->folds ? n : widest;
    axis->taps = wr_try_alloc((size_t)out, sizeof *axis->taps, job->name, job->err);
    if (!axis->taps) return false;
    axis->weight =
        wr_try_alloc((size_t)out * (size_t)axis->most, sizeof *axis->weight, job->name, job->err);
    if (!axis->weight) return false;
    double *wide = wr_try_alloc((size_t)widest, sizeof *wide, job->name, job->err);
    if (!wide) return false;
    for (int i = 0; i < out; i++) set_taps(axis, i, filter, n, out, wrap, wide);
    wr_free(wide);
    return true;
}

static void axis_fini(Axis *axis)
{
    wr_free(axis->taps);
    wr_free(axis->weight);
}

/* mid[x] = input row, from texel `first` on, filtered for output columns i .. */
static void filter_row(const Axis *u, const float *row, int first, int i, int count, double *mid)
{
    for (int x = 0; x < count; x++) {
        const Taps *taps = &u->taps[i + x];
        const double *weight = u->weight + (size_t)(i + x) * (size_t)u->most;
        const float *from = row + (taps->from - first);
        double sum = 0.0;
        for (int k = 0; k < taps->count; k++) sum += weight[k] * from[k];
        mid[x] = sum;
    }
}

/* Range of texels used by the outputs i .. i + count - 1 of an axis. */
static Taps seen(const Axis *axis, int i, int count)
{
    const Taps *first = &axis->taps[i], *last = &axis->taps[i + count - 1];
    return (Taps){ first->from, last->from + last->count - first->from };
}

static void add_row(const Axis *v, WrOpBlock b, int row, int *open, const double *mid, double *sums)
{
    while (*open < b.count_j && v->taps[b.j + *open].from + v->taps[b.j + *open].count <= row)
        ++*open; /* finished outputs; the ends of the taps rise with the outputs */
    for (int y = *open; y < b.count_j && v->taps[b.j + y].from <= row; y++) {
        double weight =
            v->weight[(size_t)(b.j + y) * (size_t)v->most + (size_t)(row - v->taps[b.j + y].from)];
        double *to = sums + y * SIDE;
#pragma omp simd
        for (int x = 0; x < b.count_i; x++) to[x] += weight * mid[x];
    }
}

static void make_resized(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out, size_t pitch,
                         void *scratch)
{
    const Resize *resize = ctx;
    double *sums = scratch, *mid = sums + SIDE * SIDE;
    float *row = (float *)(mid + SIDE);
    Taps u = seen(&resize->u, b.i, b.count_i), v = seen(&resize->v, b.j, b.count_j);
    memset(sums, 0, sizeof *sums * SIDE * SIDE);
    for (int k = 0, open = 0; k < v.count; k++) {
        if (wr_progress_cancelled(job->progress)) return;
        wr_op_read(job->in, u.from, v.from + k, u.count, 1, row, (size_t)u.count);
        filter_row(&resize->u, row, u.from, b.i, b.count_i, mid);
        add_row(&resize->v, b, v.from + k, &open, mid, sums);
    }
    for (int y = 0; y < b.count_j; y++)
        for (int x = 0; x < b.count_i; x++)
            out[(size_t)y * pitch + x] = wr_op_float(sums[y * SIDE + x]);
}

static int widest_read(const Axis *axis, int out)
{
    int widest = 0;
    for (int i = 0; i < out; i += SIDE) {
        int count = seen(axis, i, out - i < SIDE ? out - i : SIDE).count;
        widest = count > widest ? count : widest;
    }
    return widest;
}

/* param: width, height, filter */
WrField *wr_op_resize(WrOpJob *job, const double *param)
{
    const WrField *in = job->in;
    int width = (int)param[0], height = (int)param[1], filter = (int)param[2];
    Resize resize = { { 0 }, { 0 } };
    WrField *out = NULL;
    if (axis_init(&resize.u, job, filter, wr_field_width(in), width, wr_field_wrap_u(in)) &&
        axis_init(&resize.v, job, filter, wr_field_height(in), height, wr_field_wrap_v(in))) {
        WrOpWork work = { .make = make_resized,
                          .ctx = &resize,
                          .scratch = sizeof(double) * (SIDE * SIDE + SIDE) +
                                     sizeof(float) * (size_t)widest_read(&resize.u, width),
                          .reach = -1 };
        out = wr_op_build(
            job, wr_op_base(job, width, height, wr_field_wrap_u(in), wr_field_wrap_v(in)), &work);
    }
    axis_fini(&resize.u);
    axis_fini(&resize.v);
    return out;
}
