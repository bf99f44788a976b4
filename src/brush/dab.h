/* dab.h - one dab of a brush, and the interface of dab generators.
   Private to this module.
   Texel coordinates as in capsule.h: texel (i, j) has its centre at x = i, y = j, y down; not wrapped. */
#pragma once
#include <stdbool.h>

typedef enum WrFalloff {
    WR_FALLOFF_ROUND,  /* brush.h */
    WR_FALLOFF_MYPAINT /* with q = (d/R)^2, hardness k: q <= k ? 1 - q (1/k - 1) : k/(1-k) (1 - q) */
} WrFalloff;

typedef struct WrDab {
    double x, y;
    double radius;    /* texels, > 0: of the long axis; of a tip: half its longer side */
    double hardness;  /* 0..1 */
    double alpha;     /* 0..1: includes flow and pressure */
    double aspect;    /* >= 1 */
    double angle_rad; /* of the long axis, anticlockwise as seen (y up) */
    double dx, dy;    /* vector from the previous dab; 0, 0 for the first */
    double drag;      /* 0..1: fraction that moves heights towards `dragged`; the mode applies to
                         the rest */
    double dragged;   /* height */
    WrFalloff falloff;
    int tip_cell; /* of brush.tip; wr_tip_pick */
    bool flips;   /* a tip is mirrored */
} WrDab;

/* Receiver of dabs. */
typedef struct WrDabSink {
    void *ctx;
    void (*dab)(void *ctx, const WrDab *dab);
    /* The present mean height under a round dab. */
    double (*height)(void *ctx, double x, double y, double radius);
} WrDabSink;
