/* Gaussian blur and the unsharp mask.
 *
 * Along each axis, with w the weights and R = 4 sigma,
 *
 *   out = c + sum over k = 1..R of w_k ((T[-k] + T[+k]) - 2 c),   c = T[0],
 *
 * which is sum w_k T[k] since the weights add to 1. In this form a flat neighbourhood gives exactly c,
 * and float's rounding applies only to the differences. The tails beyond 4 sigma have a weight of 6e-5.
 *
 * A block is read with an apron of R texels, filtered along u, then along v. The block stays in the
 * second-level cache, the rows filtered at once in the first. */
#include "field/ops_internal.h"

#include "base/exactmath.h"
#include "field/field.h"
#include "field/filter_kernels.h"

#include <math.h>
#include <string.h>

#define REACH WR_OP_NARROW_REACH
#define SIDE WR_OP_SIDE
#define LANES WR_TAPS_LANES
#define WIDE (SIDE + 2 * REACH) /* a block with its apron */
#define ROWS (WIDE + LANES)     /* padded: the last LANES may extend beyond it */
#define READ_PITCH (WIDE + 16)
#define MID_PITCH (SIDE + 16)
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
    float amount; /* fraction of the blurred difference that is added to the height: 1 for a blur */
} Blur;

/* Buffers of a thread. */
typedef struct Desk {
    float in[ROWS * READ_PITCH];                    /* the block with its apron */
    float mid[ROWS * MID_PITCH];                    /* filtered along u */
    float turned[WIDE * LANES], done[SIDE * LANES]; /* LANES rows transposed to columns; filtered */
} Desk;

/* Filters LANES rows along u: transposed, so that the texels of one vector are contiguous. */
static void filter_rows(const Blur *blur, int count, const float *in, float *mid, Desk *desk)
{
    const WrTaps *taps = wr_taps();
    const int r = blur->reach;
    for (int x = 0; x < count + 2 * r; x += LANES)
        taps->turn(in + x, READ_PITCH, desk->turned + x * LANES, LANES);
    taps->smooth(blur->weight, r, desk->turned + r * LANES, LANES, count, desk->done, LANES);
    for (int x = 0; x < count; x += LANES)
        taps->turn(desk->done + x * LANES, LANES, mid + x, MID_PITCH);
}

/* Converts the sums along v to heights. */
static void sharpen(const Blur *blur, const WrOpBlock *b, const Desk *desk, float *out,
                    size_t pitch)
{
    const int r = blur->reach;
    for (int y = 0; y < b->count_j; y++) {
        const float *centre = desk->mid + (y + r) * MID_PITCH;
        const float *was = desk->in + (y + r) * READ_PITCH + r;
        float *row = out + (size_t)y * pitch;
        for (int k = 0; k < b->count_i; k++)
            row[k] = was[k] + blur->amount * ((centre[k] - was[k]) + row[k]);
    }
}

/* The lower rows needed by the block above are the top rows of this one: reuses them and returns their
 * number. */
static int keep_rows(const Blur *blur, const WrOpBlock *b, Desk *desk)
{
    const size_t rows = b->follows ? 2 * (size_t)blur->reach : 0;
    memmove(desk->in, desk->in + SIDE * READ_PITCH, rows * READ_PITCH * sizeof *desk->in);
    memmove(desk->mid, desk->mid + SIDE * MID_PITCH, rows * MID_PITCH * sizeof *desk->mid);
    return (int)rows;
}

static void make_blurred(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out, size_t pitch,
                         void *scratch)
{
    Desk *desk = scratch;
    const Blur *blur = ctx;
    const WrTaps *taps = wr_taps();
    const int r = blur->reach, rows = b.count_j + 2 * r, first = keep_rows(blur, &b, desk);
    const bool blurs = blur->amount == 1.0f;
    wr_op_read(job->in, b.i - r, b.j - r + first, b.count_i + 2 * r, rows - first,
               desk->in + first * READ_PITCH, READ_PITCH);
    for (int y = first; y < rows; y += LANES)
        filter_rows(blur, b.count_i, desk->in + y * READ_PITCH, desk->mid + y * MID_PITCH, desk);
    for (int x = 0; x < b.count_i; x += LANES)
        (blurs ? taps->smooth : taps->add)(blur->weight, r, desk->mid + r * MID_PITCH + x,
                                           MID_PITCH, b.count_j, out + x, (ptrdiff_t)pitch);
    if (!blurs) sharpen(blur, &b, desk, out, pitch);
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
                          .scratch = sizeof(Desk),
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
