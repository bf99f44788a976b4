/* Operations that only move texels: offset, flips, quarter turns, crop. */
#include "field/ops_internal.h"

#include "base/error.h"
#include "field/field.h"

#include <math.h>

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
