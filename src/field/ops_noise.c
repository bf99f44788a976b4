/* Operations with tiling noise: heights with noise added, and heights displaced sideways by noise. The
   effect on a texel depends on its position in the table, so a rolled table does not give the rolled
   result.

   Warp: out(p) = in(p + amount w(p)), w the two noises divided by their bound, so that no height moves
   by more than `amount` texels along an axis. Between texels, Catmull-Rom (or bilinear) interpolation
   is written as differences from the texel at p's top left, so that a level place stays unchanged. */
#include "field/ops_internal.h"

#include "base/error.h"
#include "base/hash.h"
#include "field/field.h"
#include "noise/grid.h"

#include <math.h>

#define SIDE WR_OP_SIDE
#define MARGIN 2 /* texels that a cubic reads beyond the position */
#define CELLS_MAX 8192.0

const char *const wr_op_noise_kinds[] = { WR_OP_NOISES(WR_WORD) NULL };

/* Chooses cells that are about square in texels. */
static WrOctaves octaves_of(const WrField *in, double cells, double octaves, double seed)
{
    const double rows = floor(cells * wr_field_height(in) / wr_field_width(in) + 0.5);
    WrOctaves o = wr_octaves_default(2);
    o.count = (int)octaves;
    o.cells[0] = cells;
    o.cells[1] = rows < 1.0 ? 1.0 : rows > CELLS_MAX ? CELLS_MAX : rows;
    o.seed = (uint32_t)seed;
    return o;
}

static bool plan_of(const WrOpJob *job, const WrOctaves *octaves, WrOctavesPlan *plan)
{
    const int texels[2] = { wr_field_width(job->in), wr_field_height(job->in) };
    if (wr_octaves_plan(octaves, texels, plan, job->err)) return true;
    wr_error_prefix(job->err, "%s: ", job->name);
    return false;
}

static WrNoiseGrid grid_of(const WrOpJob *job, WrOpBlock b)
{
    return (WrNoiseGrid){ .width = wr_field_width(job->in),
                          .height = wr_field_height(job->in),
                          .i = b.i,
                          .j = b.j,
                          .count_i = b.count_i,
                          .count_j = b.count_j };
}

/* ---- noise ---- */

typedef struct Added {
    WrOctavesPlan plan;
    double amount;
} Added;

static void make_noisy(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out, size_t pitch,
                       void *scratch)
{
    const Added *added = ctx;
    float *noise = scratch;
    const WrNoiseGrid grid = grid_of(job, b);
    wr_field_read(job->in, b.i, b.j, b.count_i, b.count_j, out, pitch);
    wr_octaves_grid(&added->plan, &grid, noise, NULL, NULL, SIDE);
    for (int y = 0; y < b.count_j; y++) {
        float *row = out + (size_t)y * pitch;
        for (int x = 0; x < b.count_i; x++)
            row[x] = wr_op_float((double)row[x] + added->amount * (double)noise[y * SIDE + x]);
    }
}

/* param: amount, cells, octaves, kind, mode, seed */
WrField *wr_op_noise(WrOpJob *job, const double *param)
{
    Added added = { .amount = param[0] };
    WrOctaves octaves = octaves_of(job->in, param[1], param[2], param[5]);
    octaves.kind = (WrNoiseKind)wr_noise_find(wr_op_noise_kinds[(int)param[3]]);
    octaves.mode = (WrOctavesMode)param[4];
    if (!plan_of(job, &octaves, &added.plan)) return NULL;
    WrOpWork work = { .make = make_noisy,
                      .ctx = &added,
                      .scratch = sizeof(float[SIDE * SIDE]),
                      .reach = -1,
                      .window = 1 };
    return wr_op_build_same(job, &work);
}

/* ---- warp ---- */

typedef struct Warp {
    WrOctavesPlan plan[2]; /* of the displacement along u and along v */
    double amount;         /* texels */
    int reach;
    bool cubic;
} Warp;

/* Weights of the four texels from the one before the position on, without the second, whose weight is 1
 * minus the others. */
typedef struct Weights {
    double before, next, last;
} Weights;

static Weights weights_at(double t, bool cubic)
{
    if (!cubic) return (Weights){ .next = t };
    return (Weights){ .before = 0.5 * t * (t * (2.0 - t) - 1.0),
                      .next = 0.5 * t * (t * (4.0 - 3.0 * t) + 1.0),
                      .last = 0.5 * t * t * (t - 1.0) };
}

/* The row interpolated between f[0] and f[1], minus `base`. */
static double across(const float *f, Weights w, double base)
{
    const double own = (double)f[0] - base;
    return own + w.before * ((double)f[-1] - (double)f[0]) +
           w.next * ((double)f[1] - (double)f[0]) + w.last * ((double)f[2] - (double)f[0]);
}

static double height_at(const float *f, ptrdiff_t pitch, Weights u, Weights v)
{
    const double base = f[0], own = across(f, u, base);
    return base + own + v.before * (across(f - pitch, u, base) - own) +
           v.next * (across(f + pitch, u, base) - own) +
           v.last * (across(f + 2 * pitch, u, base) - own);
}

/* Displacement in texels; 0 where the noise is 0. */
static double move_of(const Warp *warp, int axis, float noise)
{
    const double bound = warp->plan[axis].bound;
    const double d = bound > 0.0 ? warp->amount * (double)noise / bound : 0.0;
    return d > warp->amount ? warp->amount : d < -warp->amount ? -warp->amount : d;
}

static void make_warped(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out, size_t pitch,
                        void *scratch)
{
    const Warp *warp = ctx;
    const int r = warp->reach, wide = b.count_i + 2 * r;
    float *to_u = scratch, *to_v = to_u + SIDE * SIDE, *in = to_v + SIDE * SIDE;
    const WrNoiseGrid grid = grid_of(job, b);
    wr_octaves_grid(&warp->plan[0], &grid, to_u, NULL, NULL, SIDE);
    wr_octaves_grid(&warp->plan[1], &grid, to_v, NULL, NULL, SIDE);
    wr_op_read(job->in, b.i - r, b.j - r, wide, b.count_j + 2 * r, in, (size_t)wide);
    for (int y = 0; y < b.count_j; y++)
        for (int x = 0; x < b.count_i; x++) {
            const double du = move_of(warp, 0, to_u[y * SIDE + x]);
            const double dv = -move_of(warp, 1, to_v[y * SIDE + x]); /* rows run down */
            const double left = floor(du), top = floor(dv);
            const float *f = in + (ptrdiff_t)(y + r + (int)top) * wide + (x + r + (int)left);
            out[(size_t)y * pitch + (size_t)x] = wr_op_float(height_at(
                f, wide, weights_at(du - left, warp->cubic), weights_at(dv - top, warp->cubic)));
        }
}

/* param: amount, cells, octaves, between, seed */
WrField *wr_op_warp(WrOpJob *job, const double *param)
{
    Warp warp = { .amount = param[0],
                  .reach = (int)ceil(param[0]) + MARGIN,
                  .cubic = param[3] == WR_WARP_CUBIC };
    WrOctaves octaves = octaves_of(job->in, param[1], param[2], param[4]);
    for (int axis = 0; axis < 2; axis++) {
        octaves.seed = wr_mix32(octaves.seed + 0x51ed270bU);
        if (!plan_of(job, &octaves, &warp.plan[axis])) return NULL;
    }
    const size_t wide = SIDE + 2 * (size_t)warp.reach;
    WrOpWork work = { .make = make_warped,
                      .ctx = &warp,
                      .scratch = sizeof(float) * (2 * SIDE * SIDE + wide * wide),
                      .reach = warp.reach,
                      .window = 2 * warp.reach + 1 };
    return wr_op_build_same(job, &work);
}
