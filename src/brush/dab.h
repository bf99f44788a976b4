/* dab.h - one touch of a brush, and who makes them.
   Private to this module. Texel coordinates as in capsule.h: texel (i, j) has its centre at x = i,
   y = j, y down; not wrapped. */
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
    double alpha;     /* 0..1: flow and pressure are in it */
    double aspect;    /* >= 1 */
    double angle_rad; /* of the long axis, anticlockwise as seen (y up) */
    double dx, dy;    /* the way from the dab before; 0, 0 for the first */
    double drag;      /* 0..1: this part of it pulls towards `dragged`, the rest does the mode */
    double dragged;   /* height */
    WrFalloff falloff;
    int tip_cell; /* of brush.tip; wr_tip_pick */
    bool flips;   /* a tip is drawn as its mirror image */
} WrDab;

/* What dabs are put onto. */
typedef struct WrDabSink {
    void *ctx;
    void (*dab)(void *ctx, const WrDab *dab);
    /* The mean height under a round dab, as it is now. */
    double (*height)(void *ctx, double x, double y, double radius);
} WrDabSink;
