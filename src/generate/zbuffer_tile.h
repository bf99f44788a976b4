/* zbuffer_tile.h - state of one tile of the depth buffer during drawing.
   Private to the depth buffer. */
#pragma once
#include "base/array.h"
#include "field/field.h"
#include "generate/zbuffer.h"

#include <stdbool.h>
#include <stdint.h>

#define WR_Z_FULL 0xffffU /* all samples */

/* Sample positions in a texel, in sixteenths from its centre; nearest first, no two in a row or column. */
extern const int8_t wr_z_samples[WR_Z_SAMPLES][2];

/* Depths of a texel's samples; -inf: none yet. */
typedef struct WrZBlock {
    double z[WR_Z_SAMPLES];
} WrZBlock;

#define WR_Z_SQUARE 8 /* side in texels of the squares culled together */
#define WR_Z_SQUARES (WR_TILE / WR_Z_SQUARE)

typedef struct WrZSheet {
    int x, y;       /* of its first texel */
    int wide, high; /* texels of the tile inside the table */
    double floor;
    double depth[WR_TILE * WR_TILE]; /* the highest at the centre; -inf: none */
    double edge[WR_TILE * WR_TILE];  /* the highest at other samples */
    double
        whole[WR_TILE * WR_TILE]; /* at the centre, the highest of solids that cover all samples */
    uint16_t mask[WR_TILE * WR_TILE];
    uint8_t bodies[WR_TILE * WR_TILE]; /* number of solids that cover it, in part or completely; 2:
                                      more, or one twice */
    int block[WR_TILE * WR_TILE];      /* 1 + its block's index; 0: none */
    WR_ARRAY(WrZBlock) blocks;         /* for texels partly covered by a solid */
    int64_t squares;                   /* drawn */
} WrZSheet;

/* One image of a primitive. */
typedef struct WrZEntry {
    int64_t index; /* of the solid, or solid_count + of the triangle */
    double dx, dy; /* texels: offset of the image */
} WrZEntry;

/* Returns false if the work was cancelled. part: fraction of the tile, 0..1. */
typedef struct WrZGoOn {
    bool (*call)(const void *ctx, double part);
    const void *ctx;
} WrZGoOn;
/* ---- culling: zbuffer.c ---- */

/* Fills in the data for the solid's bounds; part of wr_zsolid_set. */
void wr_zsolid_set_bounds(WrZSolid *solid);

typedef struct WrZRect {
    double x0, y0, x1, y1; /* texels, closed */
} WrZRect;
/* Squared distances from its axis at which such a torus may change each texel of a square. Valid for
   all of the same height and radii. */
typedef struct WrZBand {
    double at, ring, tube; /* of the torus; tube 0: none yet */
    double within; /* a texel whose centre is that near to the middle line is covered, and only its
                   height matters */
    double low[WR_Z_SQUARE * WR_Z_SQUARE], high[WR_Z_SQUARE * WR_Z_SQUARE];
} WrZBand;
/* clamps to [low, high] as integers; x may be any number */
static inline int wr_z_clip(double x, int low, int high)
{
    return x < low ? low : x > high ? high : (int)x;
}

static inline void wr_z_raise(double *depth, double z)
{
    if (z > *depth) *depth = z;
}
