/* Operations on each height: levels, curves and other tone changes, and noise. */
#include "base/error.h"
#include "base/exactmath.h"
#include "base/hash.h"
#include "field/field.h"
#include "field/ops_internal.h"
#include "noise/texel_grid.h"

#include <math.h>

/* ---- levels, invert, normalise, add, multiply, clamp ---- */

typedef struct Tone Tone;
struct Tone {
    void (*map)(const Tone *tone, float *row, int count); /* in place */
    int window;  /* 1; 0: the numbers below depend on the table's range */
    double a[5]; /* coefficients of `map` */
};

static void make_mapped(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out, size_t pitch,
                        void *scratch)
{
    (void)scratch;
    const Tone *tone = ctx;
    wr_field_read(job->in, b.i, b.j, b.count_i, b.count_j, out, pitch);
    for (int y = 0; y < b.count_j; y++) tone->map(tone, out + (size_t)y * pitch, b.count_i);
}

static bool has_null_tile(const WrField *field)
{
    for (int ty = 0; ty < wr_field_tiles_v(field); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(field); tx++)
            if (!wr_field_tile(field, tx, ty)) return true;
    return false;
}

/* A table with NULL tiles whose level changes is rebuilt at the new level, so that the largest table
   with a few painted tiles stays small. */
static WrField *run_tone(WrOpJob *job, const Tone *tone)
{
    const WrField *in = job->in;
    float level = wr_field_level(in);
    tone->map(tone, &level, 1);
    bool stays = level == wr_field_level(in);
    WrOpWork work = {
        .make = make_mapped, .ctx = tone, .reach = stays ? 0 : -1, .window = tone->window
    };
    if (stays || job->mask || !has_null_tile(in)) return wr_op_build_same(job, &work);
    work.reach = 0;
    WrField *base = wr_field_new(wr_field_width(in), wr_field_height(in), wr_field_wrap_u(in),
                                 wr_field_wrap_v(in), level, job->err);
    return wr_op_build(job, base, &work);
}

/* a: in low, 1 / (in high - in low), 1 / gamma, out low, out high - out low */
static void map_levels(const Tone *tone, float *row, int count)
{
    const double *a = tone->a;
    for (int i = 0; i < count; i++) {
        double t = ((double)row[i] - a[0]) * a[1];
        if (t > 0.0 && a[2] != 1.0) t = wr_pow(t, a[2]);
        row[i] = wr_op_float(a[3] + t * a[4]);
    }
}

/* param: in low, in high, gamma, out low, out high */
WrField *wr_op_levels(WrOpJob *job, const double *param)
{
    double span = param[1] - param[0];
    if (span == 0.0) {
        wr_fail(job->err, "%s: in-low and in-high are both %g: they must differ", job->name,
                param[0]);
        return NULL;
    }
    if (!(1.0 / span <= DBL_MAX && 1.0 / span >= -DBL_MAX)) {
        wr_fail(job->err, "%s: in-low and in-high differ by %g: they must differ by more",
                job->name, span);
        return NULL;
    }
    Tone tone = { map_levels,
                  1,
                  { param[0], 1.0 / span, 1.0 / param[2], param[3], param[4] - param[3] } };
    return run_tone(job, &tone);
}

typedef struct CurveTone {
    Tone tone; /* first member: `map` receives its address */
    WrCurve curve;
} CurveTone;

static void map_curve(const Tone *tone, float *row, int count)
{
    const WrCurve *curve = &((const CurveTone *)tone)->curve;
    for (int i = 0; i < count; i++) row[i] = wr_op_float(wr_curve_at(curve, (double)row[i]));
}

/* param: number of points, then their coordinates */
WrField *wr_op_curves(WrOpJob *job, const double *param)
{
    CurveTone curves = { .tone = { .map = map_curve, .window = 1 } };
    if (wr_curve_make(param + 1, (int)param[0], &curves.curve, job->err))
        return run_tone(job, &curves.tone);
    wr_error_prefix(job->err, "%s: ", job->name);
    return NULL;
}

/* a: the sum of a height and its inverse */
static void map_invert(const Tone *tone, float *row, int count)
{
    double sum = tone->a[0];
    for (int i = 0; i < count; i++) row[i] = wr_op_float(sum - (double)row[i]);
}

/* param: about the range's middle, or about 0 */
WrField *wr_op_invert(WrOpJob *job, const double *param)
{
    float low = 0.0f, high = 0.0f;
    if (param[0] == WR_INVERT_RANGE) wr_field_range(job->in, &low, &high);
    Tone tone = { map_invert, param[0] != WR_INVERT_RANGE, { (double)low + high } };
    return run_tone(job, &tone);
}

/* a: table's low, table's high, new low, new high. Written so that both ends are mapped exactly. */
static void map_normalise(const Tone *tone, float *row, int count)
{
    const double *a = tone->a, scale = 1.0 / (a[1] - a[0]);
    for (int i = 0; i < count; i++) {
        double up = ((double)row[i] - a[0]) * scale, down = (a[1] - (double)row[i]) * scale;
        row[i] = wr_op_float(row[i] < a[1] ? row[i] > a[0] ? down * a[2] + up * a[3] : a[2] : a[3]);
    }
}

static void map_constant(const Tone *tone, float *row, int count)
{
    for (int i = 0; i < count; i++) row[i] = wr_op_float(tone->a[2]);
}

/* param: low, high. The NULL tiles of a tree may all be hidden, so the level may lie outside the range:
   then it is mapped to the nearer end, which is never visible. */
WrField *wr_op_normalise(WrOpJob *job, const double *param)
{
    float low, high;
    wr_field_range(job->in, &low, &high);
    Tone tone = { low < high ? map_normalise : map_constant, 0, { low, high, param[0], param[1] } };
    return run_tone(job, &tone);
}

static void map_add(const Tone *tone, float *row, int count)
{
    for (int i = 0; i < count; i++) row[i] = wr_op_float((double)row[i] + tone->a[0]);
}

WrField *wr_op_add(WrOpJob *job, const double *param)
{
    Tone tone = { map_add, 1, { param[0] } };
    return run_tone(job, &tone);
}

static void map_multiply(const Tone *tone, float *row, int count)
{
    for (int i = 0; i < count; i++) row[i] = wr_op_float((double)row[i] * tone->a[0]);
}

WrField *wr_op_multiply(WrOpJob *job, const double *param)
{
    Tone tone = { map_multiply, 1, { param[0] } };
    return run_tone(job, &tone);
}

static void map_clamp(const Tone *tone, float *row, int count)
{
    float low = wr_op_float(tone->a[0]), high = wr_op_float(tone->a[1]);
    for (int i = 0; i < count; i++) {
        float x = row[i] < low ? low : row[i];
        row[i] = x > high ? high : x;
    }
}

/* param: low, high */
WrField *wr_op_clamp(WrOpJob *job, const double *param)
{
    if (param[0] > param[1]) {
        wr_fail(job->err, "%s: low %g is above high %g", job->name, param[0], param[1]);
        return NULL;
    }
    Tone tone = { map_clamp, 1, { param[0], param[1] } };
    return run_tone(job, &tone);
}

/* ---- tiling noise, added to heights or displacing them ---- */

/* The effect on a texel depends on its position in the table: the result of a rolled table is not the
   rolled result.

   Warp: out(p) = in(p + amount w(p)), w the two noises divided by their bound, so that no height moves
   by more than `amount` texels along an axis. Between texels, Catmull-Rom (or bilinear) interpolation
   is written as differences from the texel at p's top left, so that a level place stays unchanged. */

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

/* ---- added noise ---- */

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
