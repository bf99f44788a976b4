/* A wide Gaussian blur at a cost that hardly depends on its width.
 *
 * Four successive boxes approximate a Gaussian, but flatter: the excess kurtosis is -1.2/4. The mean of
 * two such kernels with variances sigma^2 (1 - 1/3) and sigma^2 (1 + 1/3) has the variance sigma^2 and
 * no excess kurtosis. It differs from the Gaussian by 0.7 % in the sum of |differences| (four plain
 * boxes: 3.9 %), so that along one axis the error of a blurred height is at most 0.35 % of the table's
 * range; it has three continuous derivatives and no negative weight.
 *
 * A box of real variance v has 2r + 1 whole texels and a fraction `end` of one more on either side:
 *
 *   v = ((2r + 1) r (r + 1)/3 + 2 end (r + 1)^2) / (2r + 1 + 2 end),  0 <= end < 1.
 *
 * Box sums run along the row: one texel is added, one subtracted. They must not depend on their
 * starting point (a rolled table gives rolled heights, a flat place stays flat), so they are sums of
 * integers, which doubles represent exactly: heights are counted in steps of 2^-40 of the largest |F|,
 * rounded up to a power of two, and each box's result is rounded to whole steps again. A box has less
 * than 2^12 texels. */
#include "field/ops_internal.h"

#include "base/memory.h"
#include "field/field.h"
#include "field/filter_kernels.h"

#include <math.h>

#define LANES WR_BOX_LANES
#define BOXES 4
#define CHAINS 2
#define BITS 40

typedef struct WideBlur {
    const WrField *in;
    WrOpPlane *plane;
    WrBox box[CHAINS];
    const WrTaps *taps;
    int apron;            /* texels read on either side of a row */
    double scale, step;   /* steps in a table unit, and its inverse; powers of two */
    double *work;         /* [threads][pitch] */
    size_t pitch, length; /* doubles; `length` of one row of LANES with its aprons */
} WideBlur;

static WrBox box_of(double variance)
{
    int r = (int)((sqrt(1.0 + 12.0 * variance) - 1.0) / 2.0);
    while (r > 0 && r * (r + 1.0) / 3.0 > variance) r--;
    while ((r + 1.0) * (r + 2.0) / 3.0 <= variance) r++;
    double whole = 2.0 * r + 1.0, next = (r + 1.0) * (r + 1.0);
    double end = whole * (variance - r * (r + 1.0) / 3.0) / (2.0 * (next - variance));
    return (WrBox){ r, end, 1.0 / (whole + 2.0 * end) };
}

/* Filters `count` elements of LANES steps each; row begins with the apron. Returns the sum of both
   chains, [count][LANES]. */
static const double *run_chains(const WideBlur *wide, double *row, int count)
{
    double *a = row + wide->length, *b = a + wide->length, *sum = b + wide->length;
    for (int chain = 0; chain < CHAINS; chain++) {
        const WrBox *box = &wide->box[chain];
        int ring = box->r + 1, skip = wide->apron - BOXES * ring;
        const double *from = row + (size_t)skip * LANES;
        for (int pass = 1; pass <= BOXES; pass++) {
            double *to = pass == BOXES && chain == 0 ? sum : pass % 2 ? a : b;
            wide->taps->box(box, from, count + 2 * ring * (BOXES - pass), to);
            from = to;
        }
        if (chain > 0)
            for (size_t i = 0; i < (size_t)count * LANES; i++) sum[i] += from[i];
    }
    return sum;
}

static void blur_rows(int index, int worker, void *ctx)
{
    const WideBlur *wide = ctx;
    const WrOpPlane *plane = wide->plane;
    int j = index * LANES, rows = plane->height - j < LANES ? plane->height - j : LANES;
    int across = plane->width + 2 * wide->apron;
    double *row = wide->work + (size_t)worker * wide->pitch;
    float *texels = (float *)(row + 4 * wide->length);
    for (int lane = 0; lane < rows; lane++) {
        wr_op_read(wide->in, -wide->apron, j + lane, across, 1, texels, (size_t)across);
        wide->taps->to_steps(wide->scale, texels, across, row + lane);
    }
    const double *sum = run_chains(wide, row, plane->width);
    for (int lane = 0; lane < rows; lane++) {
        float *to = plane->at + (size_t)(j + lane) * plane->pitch;
        wr_field_read(wide->in, 0, j + lane, plane->width, 1, to, plane->pitch);
        wide->taps->add_steps(wide->scale, wide->step, sum + lane, plane->width, to);
    }
}

static int row_of(const WideBlur *wide, int j)
{
    int height = wide->plane->height;
    if (wr_field_wrap_v(wide->in) == WR_WRAP_CLAMP) return j < 0 ? 0 : j < height ? j : height - 1;
    int rest = j % height;
    return rest < 0 ? rest + height : rest;
}

static void blur_columns(int index, int worker, void *ctx)
{
    const WideBlur *wide = ctx;
    const WrOpPlane *plane = wide->plane;
    int i = index * LANES; /* the last ones may extend into the gap between rows */
    double *row = wide->work + (size_t)worker * wide->pitch;
    for (int y = 0; y < plane->height + 2 * wide->apron; y++) {
        const float *from = plane->at + (size_t)row_of(wide, y - wide->apron) * plane->pitch + i;
        wide->taps->to_steps_across(wide->scale, from, row + (size_t)y * LANES);
    }
    const double *sum = run_chains(wide, row, plane->height);
    for (int y = 0; y < plane->height; y++) {
        float *to = plane->at + (size_t)y * plane->pitch + i;
        wide->taps->add_steps_across(wide->scale, wide->step, sum + (size_t)y * LANES, to);
    }
}

/* Powers of two, so that scaling is exact. A table of zeros has any scale. */
static void set_scale(WideBlur *wide)
{
    float low, high;
    wr_field_range(wide->in, &low, &high);
    double largest = fmax(fabs((double)low), fabs((double)high));
    int exponent = largest > 0.0 ? ilogb(largest) + 1 : 0;
    wide->scale = scalbn(1.0, BITS - exponent);
    wide->step = scalbn(1.0, exponent - BITS);
}

static bool run_axes(const WrOpJob *job, WideBlur *wide)
{
    WrOpJob half = *job;
    half.to = 0.5 * (job->from + job->to);
    if (!wr_op_pieces(&half, (wide->plane->height + LANES - 1) / LANES, blur_rows, wide))
        return false;
    half.from = half.to;
    half.to = job->to;
    return wr_op_pieces(&half, (wide->plane->width + LANES - 1) / LANES, blur_columns, wide);
}

bool wr_op_blur_wide(const WrOpJob *job, double sigma, WrOpPlane *plane)
{
    WideBlur wide = { .in = job->in, .plane = plane, .taps = wr_taps() };
    double third = sigma * sigma / 3.0;
    wide.box[0] = box_of(2.0 * third / BOXES);
    wide.box[1] = box_of(4.0 * third / BOXES);
    wide.apron = BOXES * (wide.box[1].r + 1);
    set_scale(&wide);
    int longest = plane->width > plane->height ? plane->width : plane->height;
    size_t across = (size_t)longest + 2 * (size_t)wide.apron;
    wide.length = across * LANES;
    wide.pitch = 4 * wide.length + across; /* the last is a row of floats */
    wide.work = wr_try_alloc((size_t)wr_pool_threads(job->pool), wide.pitch * sizeof(double),
                             job->name, job->err);
    if (!wide.work) return false;
    bool good = run_axes(job, &wide);
    wr_free(wide.work);
    return good;
}
