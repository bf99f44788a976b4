/* ops_internal.h - internals shared by the table operations: the job, the builder of result tables,
   and the operations.
   Private to ops*.c.

   An operation provides a function that computes any block of the result from the input. The builder
   calls it on the pool's threads for one batch of blocks at a time, blends with the mask, compares with
   the previous content and writes only the tiles that differ. So an operation needs scratch space for a
   block, not for a table. */
#pragma once
#include <float.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/pool.h"
#include "field/changed_blocks.h"
#include "field/ops.h"
#include "field/wrap.h"

/* Words of the operations' enumerated parameters. */
#define WR_INVERT_ABOUTS(X) X(WR_INVERT_RANGE, "range") X(WR_INVERT_ZERO, "zero")
enum { WR_INVERT_ABOUTS(WR_WORD_ID) };
#define WR_WINDOWS(X) X(WR_WINDOW_ROUND, "round") X(WR_WINDOW_SQUARE, "square")
enum { WR_WINDOWS(WR_WORD_ID) };
#define WR_LIMIT_SIDES(X)                                                                          \
    X(WR_SIDE_BELOW, "below") X(WR_SIDE_ABOVE, "above") X(WR_SIDE_MEAN, "mean")
enum { WR_LIMIT_SIDES(WR_WORD_ID) };

/* Values of seamless' `how`. */
#define WR_REPEAT_WAYS(X)                                                                          \
    X(WR_REPEAT_BLEND, "blend")                                                                    \
    X(WR_REPEAT_PATCHES, "patches")                                                                \
    X(WR_REPEAT_MIRROR, "mirror")                                                                  \
    X(WR_REPEAT_FREQUENCY, "frequency")
enum { WR_REPEAT_WAYS(WR_WORD_ID) };
#define WR_RAMPS(X) X(WR_RAMP_SMOOTH, "smooth") X(WR_RAMP_LINEAR, "linear")
enum { WR_RAMPS(WR_WORD_ID) };
#define WR_WARP_BETWEENS(X) X(WR_WARP_CUBIC, "catmull") X(WR_WARP_LINEAR, "linear")
enum { WR_WARP_BETWEENS(WR_WORD_ID) };
/* Noises that tile, by their names in noise/noise.h. */
#define WR_OP_NOISES(X)                                                                            \
    X(WR_OP_NOISE_PERLIN, "perlin")                                                                \
    X(WR_OP_NOISE_GRADIENT, "gradient")                                                            \
    X(WR_OP_NOISE_VALUE, "value")                                                                  \
    X(WR_OP_NOISE_SHEARED, "sheared")
enum { WR_OP_NOISES(WR_WORD_ID) WR_OP_NOISE_COUNT };
extern const char *const wr_op_noise_kinds[]; /* their words; ends with NULL */

#define WR_OP_SIDE WR_CHANGED_SIDE /* texels along a block's side */

/* One call of wr_op_run. */
struct WrOpJob {
    const char *name; /* for messages */
    const WrField *in;
    const WrField *mask;       /* NULL: no mask */
    const WrField *was, *made; /* as in WrOpOptions; NULL: compute everything */
    WrPool *pool;
    const WrProgress *progress;
    double from, to; /* range of the present step within the whole, 0..1 */
    WrError *err;
};

/* A rectangle of texels of the result. */
typedef struct WrOpBlock {
    int i, j, count_i, count_j; /* counts 1..WR_OP_SIDE */
    /* The scratch still contains the data of the block above, of WR_OP_SIDE rows and the same columns. */
    bool follows;
} WrOpBlock;

/* The builder's description of an operation. */
typedef struct WrOpWork {
    /* Computes the new heights of a block, row by row, `pitch` floats a row. They may exceed float's
       range. scratch: `scratch` bytes that no other thread uses, 64-byte aligned, undefined content
       (but see `follows`). */
    void (*make)(const WrOpJob *job, const void *ctx, WrOpBlock block, float *out, size_t pitch,
                 void *scratch);
    const void *ctx;
    size_t scratch;
    /* Position in the scratch where `make` leaves the block's input, in floats; pitch 0: nowhere. */
    struct {
        size_t at, pitch;
    } input;
    int reach;  /* input texels farther away have no effect; -1: unknown */
    int window; /* side in texels of the square of input that a texel depends on, 2 reach + 1; 0: on
                   the whole table, by its range or its sums */
    bool
        moves; /* copies texels: -0 stays -0. Otherwise a texel with an equal result keeps its bits */
} WrOpWork;

/* The initial table of a result of this size: a share of the input if size and edges are equal, else a
   flat one at the input's level. NULL and an error for a size out of range. */
WrField *wr_op_base(const WrOpJob *job, int width, int height, WrWrap wrap_u, WrWrap wrap_v);

/* Computes all blocks of the result and writes them over `base`, which becomes the result (on failure
   it is freed, and the function returns NULL with an error). If `reach` is known, blocks around which
   the input is NULL are skipped: base must be flat there already, as a share is for every filter that
   keeps flat tables. */
WrField *wr_op_build(const WrOpJob *job, WrField *base, const WrOpWork *work);

/* wr_op_build for an operation whose result has the input's size and edges. */
WrField *wr_op_build_same(const WrOpJob *job, const WrOpWork *work);

/* Reports the fraction done of the present step, 0..1; false and an error when the job is cancelled. */
bool wr_op_step(const WrOpJob *job, double fraction);

/* wr_pool_run in batches, with reports between them. False and an error when cancelled. */
bool wr_op_pieces(const WrOpJob *job, int count, WrPiece piece, void *ctx);

/* As wr_field_read, but a clamped axis repeats its edge texel. */
void wr_op_read(const WrField *field, int i, int j, int count_i, int count_j, float *out,
                size_t pitch);

/* A whole table in contiguous memory, for operations that cannot work on blocks. A row starts at at + j
 * * pitch; the pitch avoids powers of two, and the operation may use two floats on either side of a
 * row. */
typedef struct WrOpPlane {
    float *block, *at; /* block: owned; at: texel (0, 0) */
    size_t pitch;
    int width, height;
} WrOpPlane;

/* Allocates a plane of the job's input size. False and an error when out of memory. */
bool wr_op_plane_init(WrOpPlane *plane, const WrOpJob *job);
void wr_op_plane_fini(WrOpPlane *plane);

static inline float wr_op_float(double x)
{
    return x > FLT_MAX ? FLT_MAX : x < -FLT_MAX ? -FLT_MAX : (float)x;
}

/* Sampled Gaussian exp(-k^2 / (2 sigma^2)), k = 0..reach, divided by the sum over all -reach..reach;
   returns reach = ceil(4 sigma). sigma 0..WR_OP_NARROW_SIGMA. */
#define WR_OP_NARROW_SIGMA 16
#define WR_OP_NARROW_REACH 64

/* The operations; parameters as in their rows, checked. */
WrField *wr_op_offset(WrOpJob *job, const double *param);
WrField *wr_op_seamless(WrOpJob *job, const double *param);
WrField *wr_op_match_edges(WrOpJob *job, const double *param);
WrField *wr_op_even_light(WrOpJob *job, const double *param);
WrField *wr_op_flip_u(WrOpJob *job, const double *param);
WrField *wr_op_flip_v(WrOpJob *job, const double *param);
WrField *wr_op_rotate(WrOpJob *job, const double *param);
WrField *wr_op_crop(WrOpJob *job, const double *param);
WrField *wr_op_resize(WrOpJob *job, const double *param);
WrField *wr_op_levels(WrOpJob *job, const double *param);
WrField *wr_op_curves(WrOpJob *job, const double *param);
WrField *wr_op_invert(WrOpJob *job, const double *param);
WrField *wr_op_normalise(WrOpJob *job, const double *param);
WrField *wr_op_add(WrOpJob *job, const double *param);
WrField *wr_op_multiply(WrOpJob *job, const double *param);
WrField *wr_op_clamp(WrOpJob *job, const double *param);
WrField *wr_op_blur(WrOpJob *job, const double *param);
WrField *wr_op_sharpen(WrOpJob *job, const double *param);
WrField *wr_op_median(WrOpJob *job, const double *param);
WrField *wr_op_dilate(WrOpJob *job, const double *param);
WrField *wr_op_erode(WrOpJob *job, const double *param);
WrField *wr_op_noise(WrOpJob *job, const double *param);
WrField *wr_op_warp(WrOpJob *job, const double *param);
WrField *wr_op_slope_limit(WrOpJob *job, const double *param);
