/* ramp.h - heights that lead from one place to another: linear, radial, cone.

   In texels x = W u, y = H v (v up), with d = to - from, not reduced, and e the way from `from` to a
   texel's centre; |d| must not be 0. Heights are low + t (high - low), low where t = 0, high where t = 1:

     linear   t = e.d / |d|^2, cut to 0..1. On a periodic axis the texel's image nearest to the middle of
              the way counts: so it jumps half a table away from the middle, and nowhere else.
       fold   t = (p dx^2 + q dy^2) / |d|^2, with p = ex/dx on the way and falling back to 0 over the rest of
              the way round the table, q likewise: linear in the rectangle between the two, and without
              any jump. Needs |dx| < W and |dy| < H on periodic axes. A clamped axis has no way round: p is
              ex/dx, cut to 0..1.
     radial   t = |e| / |d|, at most 1, with the distance round all periodic axes: no jump.
       fold   beyond 1 it falls back to 0 at twice the distance: a ring.
     cone     t = the angle from d to e anticlockwise, in turns: it jumps along the ray to `to` and, on
              periodic axes, half a table away.
       fold   t rises for half a turn and falls for the other; on a periodic axis e leads back beyond a
              quarter of the table (e = W/2 - e), so that nothing jumps but in the four points where the
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

/* A table of the size and wrap of `like`, the caller's. NULL and an error where from and to are one place,
   for a fold's way that is as long as the table, without memory, or where progress (NULL: none) says so. */
WrField *wr_ramp_make(const WrField *like, const WrRamp *ramp, WrPool *pool,
                      const WrProgress *progress, WrError *err);
