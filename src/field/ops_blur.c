/* Gaussian blur and the unsharp mask.
 *
 * Along each axis, with w the weights and R = 4 sigma,
 *   out = c + sum over k = 1..R of w_k ((T[-k] + T[+k]) - 2 c),   c = T[0],
 * which is sum w_k T[k] since the weights add to 1; but this way a flat neighbourhood gives exactly c, and
 * float's rounding is that of the differences. What is cut off beyond 4 sigma weighs 6e-5.
 *
 * A block is read with an apron of R texels, filtered along u, then along v: rows of 320 floats at most,
 * so that all of it stays in the second-level cache. */
#include "field/ops_inner.h"

#include "base/exactmath.h"
#include "field/field.h"
#include "field/taps.h"

#include <math.h>

#define REACH WR_OP_NARROW_REACH
#define WIDE (WR_OP_SIDE + 2 * REACH) /* a block with its apron */
#define READ_PITCH (WIDE + 16)
#define MID_PITCH (WR_OP_SIDE + 16)
#define LOG2_E 1.4426950408889634

int wr_op_gauss(double sigma, float weight[REACH + 1])
{
    double raw[REACH + 1], sum = 1.0;
    int reach = (int)ceil(4.0 * sigma);
    reach = reach > REACH ? REACH : reach;
    raw[0] = 1.0;
    for (int k = 1; k <= reach; k++) {
        double x = k / sigma;
        raw[k] = wr_exp2(-0.5 * LOG2_E * x * x);
        sum += 2.0 * raw[k];
    }
    for (int k = 0; k <= REACH; k++) weight[k] = k <= reach ? (float)(raw[k] / sum) : 0.0f;
    return reach;
}

typedef struct Blur {
    int reach;
    float weight[REACH + 1];
    float amount; /* how much of the blurred difference is added to the height: 1 a blur */
} Blur;

/* A strip of the block's rows, filtered along v. */
static void finish_strip(const Blur *blur, const WrOpBlock *b, int x, const float *in,
                         const float *mid, float *out, size_t pitch)
{
    const WrTaps *taps = wr_taps();
    int count = b->count_i - x < WR_TAPS_STRIP ? b->count_i - x : WR_TAPS_STRIP, r = blur->reach;
    for (int y = 0; y < b->count_j; y++) {
        const float *centre = mid + (y + r) * MID_PITCH + x;
        const float *was = in + (y + r) * READ_PITCH + r + x;
        float *row = out + (size_t)y * pitch + x, sum[WR_TAPS_STRIP];
        if (blur->amount == 1.0f) {
            taps->smooth(blur->weight, r, centre, MID_PITCH, count, row);
            continue;
        }
        taps->add(blur->weight, r, centre, MID_PITCH, count, sum);
        for (int k = 0; k < count; k++)
            row[k] = was[k] + blur->amount * ((centre[k] - was[k]) + sum[k]);
    }
}

static void make_blurred(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out, size_t pitch,
                         void *scratch)
{
    const Blur *blur = ctx;
    const WrTaps *taps = wr_taps();
    int r = blur->reach, rows = b.count_j + 2 * r;
    float *in = scratch, *mid = in + READ_PITCH * WIDE;
    wr_op_read(job->in, b.i - r, b.j - r, b.count_i + 2 * r, rows, in, READ_PITCH);
    for (int y = 0; y < rows; y++) {
        const float *centre = in + y * READ_PITCH + r;
        taps->smooth(blur->weight, r, centre, 1, b.count_i, mid + y * MID_PITCH);
    }
    for (int x = 0; x < b.count_i; x += WR_TAPS_STRIP)
        finish_strip(blur, &b, x, in, mid, out, pitch);
}

typedef struct Wide {
    const WrOpPlane *plane;
    float amount;
} Wide;

static void make_wide(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out, size_t pitch,
                      void *scratch)
{
    (void)scratch;
    const Wide *wide = ctx;
    wr_field_read(job->in, b.i, b.j, b.count_i, b.count_j, out, pitch);
    for (int y = 0; y < b.count_j; y++) {
        const float *blurred = wide->plane->at + (size_t)(b.j + y) * wide->plane->pitch + b.i;
        float *row = out + (size_t)y * pitch;
        if (wide->amount == 1.0f)
            for (int x = 0; x < b.count_i; x++) row[x] = blurred[x];
        else
            for (int x = 0; x < b.count_i; x++)
                row[x] = row[x] + wide->amount * (blurred[x] - row[x]);
    }
}

static WrField *run_blur(WrOpJob *job, double sigma, double amount)
{
    if (sigma <= WR_OP_NARROW_SIGMA) {
        Blur blur = { .amount = (float)amount };
        blur.reach = wr_op_gauss(sigma, blur.weight);
        WrOpWork work = { .make = make_blurred,
                          .ctx = &blur,
                          .scratch = sizeof(float) * (READ_PITCH * WIDE + MID_PITCH * WIDE),
                          .input = { (size_t)blur.reach * (READ_PITCH + 1), READ_PITCH },
                          .reach = blur.reach,
                          .window = 2 * blur.reach + 1 };
        return wr_op_build_same(job, &work);
    }
    WrOpPlane plane;
    if (!wr_op_plane_init(&plane, job)) return NULL;
    Wide wide = { &plane, (float)amount };
    WrOpWork work = { .make = make_wide, .ctx = &wide, .reach = -1 };
    WrField *out = NULL;
    job->to = 0.8;
    if (wr_op_blur_wide(job, sigma, &plane)) {
        job->from = 0.8;
        job->to = 1.0;
        out = wr_op_build_same(job, &work);
    }
    wr_op_plane_fini(&plane);
    return out;
}

/* param: sigma */
WrField *wr_op_blur(WrOpJob *job, const double *param)
{
    return run_blur(job, param[0], 1.0);
}

/* F + amount (F - blurred F); param: amount, sigma */
WrField *wr_op_sharpen(WrOpJob *job, const double *param)
{
    return run_blur(job, param[1], -param[0]);
}
