/* ramp.h - linear, radial and conical gradients of heights between two points.

   In texels x = W u, y = H v (v up), with d = to - from, not reduced, and e the vector from `from` to a
   texel's centre; |d| must not be 0. Heights are low + t (high - low), low where t = 0, high where t =
   1:

     linear   t = e.d / |d|^2, clamped to 0..1. On a periodic axis the texel's image nearest to the middle of
              d is used: so the ramp jumps only half a table away from the middle.
       fold   t = (p dx^2 + q dy^2) / |d|^2, with p = ex/dx along d, falling back to 0 over the rest of
              the period, and q the same for y: linear in the rectangle between the two points, and without
              any jump. Needs |dx| < W and |dy| < H on periodic axes. On a clamped axis p is
              ex/dx, clamped to 0..1.
     radial   t = |e| / |d|, at most 1, with the shortest periodic distance: no jump.
       fold   beyond 1 it falls back to 0 at twice the distance: a ring.
     cone     t = the angle from d to e anticlockwise, in turns: it jumps along the ray to `to` and, on
              periodic axes, half a table away.
       fold   t rises for half a turn and falls for the other; on a periodic axis e is mirrored beyond a
              quarter of the table (e = W/2 - e), so that the only jumps are the four points where the
              mirrored cones have their tips.

   Double arithmetic with base/exactmath.h: the same bits on every processor, for any number of threads. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;

typedef enum WrRampKind { WR_RAMP_LINEAR, WR_RAMP_RADIAL, WR_RAMP_CONE, WR_RAMP_KINDS } WrRampKind;
extern const char *const wr_ramp_names[WR_RAMP_KINDS]; /* as in commands: "linear" */

typedef struct WrRamp {
    WrRampKind kind;
    double from_u, from_v, to_u, to_v; /* finite */
    double low, high;                  /* heights, within float's range */
    bool fold;
} WrRamp;

/* A table of the size and wrap of `like`, owned by the caller. NULL and an error if both points are
   equal, if a fold's distance is as long as the table, when out of memory, or if progress (NULL: none)
   is cancelled. */
WrField *wr_ramp_make(const WrField *like, const WrRamp *ramp, WrPool *pool,
                      const WrProgress *progress, WrError *err);
