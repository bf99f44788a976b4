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

#include <math.h>

#include "base/exactmath.h"

#define REACH WR_OP_NARROW_REACH
#define AT_ONCE 4                     /* taps on either side in one pass over a row */
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

/* sum[i] += four taps' w ((below + above) - twice), nearest first */
static void add_taps(const float *w, const float *const below[AT_ONCE],
                     const float *const above[AT_ONCE], const float *restrict centre, int count,
                     float *restrict sum)
{
    const float *b0 = below[0], *b1 = below[1], *b2 = below[2], *b3 = below[3];
    const float *a0 = above[0], *a1 = above[1], *a2 = above[2], *a3 = above[3];
    float w0 = w[0], w1 = w[1], w2 = w[2], w3 = w[3];
#pragma omp simd
    for (int i = 0; i < count; i++) {
        float twice = centre[i] + centre[i];
        float s = sum[i] + w0 * ((b0[i] + a0[i]) - twice);
        s += w1 * ((b1[i] + a1[i]) - twice);
        s += w2 * ((b2[i] + a2[i]) - twice);
        sum[i] = s + w3 * ((b3[i] + a3[i]) - twice);
    }
}

/* sum[i] = what the blur along one axis adds to centre[i]; tap k is centre + k * step. */
static void blur_row(const Blur *blur, const float *centre, ptrdiff_t step, int count,
                     float *restrict sum)
{
    for (int i = 0; i < count; i++) sum[i] = 0.0f;
    for (int k = 1; k <= blur->reach; k += AT_ONCE) {
        const float *below[AT_ONCE], *above[AT_ONCE];
        float weight[AT_ONCE];
        for (int t = 0; t < AT_ONCE; t++) { /* past the last tap: the centre, which adds 0 */
            ptrdiff_t at = k + t <= blur->reach ? (k + t) * step : 0;
            below[t] = centre - at;
            above[t] = centre + at;
            weight[t] = at ? blur->weight[k + t] : 0.0f;
        }
        add_taps(weight, below, above, centre, count, sum);
    }
}

static void make_blurred(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out, size_t pitch,
                         void *scratch)
{
    const Blur *blur = ctx;
    int r = blur->reach, rows = b.count_j + 2 * r;
    float *in = scratch, *mid = in + READ_PITCH * WIDE, *sum = mid + MID_PITCH * WIDE;
    wr_op_read(job->in, b.i - r, b.j - r, b.count_i + 2 * r, rows, in, READ_PITCH);
    for (int y = 0; y < rows; y++) {
        const float *centre = in + y * READ_PITCH + r;
        blur_row(blur, centre, 1, b.count_i, sum);
        for (int x = 0; x < b.count_i; x++) mid[y * MID_PITCH + x] = centre[x] + sum[x];
    }
    for (int y = 0; y < b.count_j; y++) {
        const float *centre = mid + (y + r) * MID_PITCH, *was = in + (y + r) * READ_PITCH + r;
        float *row = out + (size_t)y * pitch;
        blur_row(blur, centre, MID_PITCH, b.count_i, sum);
        if (blur->amount == 1.0f)
            for (int x = 0; x < b.count_i; x++) row[x] = centre[x] + sum[x];
        else
            for (int x = 0; x < b.count_i; x++)
                row[x] = was[x] + blur->amount * ((centre[x] - was[x]) + sum[x]);
    }
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
                          .scratch = sizeof(float) * (READ_PITCH * WIDE + MID_PITCH * (WIDE + 1)),
                          .reach = blur.reach };
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
