/* zbuffer_tile.h - one tile of the depth buffer while it is drawn.
   Layer 4, private to the depth buffer. */
#pragma once
#include "base/array.h"
#include "field/field.h"
#include "generate/zbuffer.h"

#define WR_Z_FULL 0xffffU /* all samples */

/* Where a texel is sampled, sixteenths of it from its centre; nearest first, no two in a row or column. */
extern const int8_t wr_z_samples[WR_Z_SAMPLES][2];

/* What is seen at a texel's samples; -inf: nothing yet. */
typedef struct WrZBlock {
    double z[WR_Z_SAMPLES];
} WrZBlock;

#define WR_Z_SQUARE 8 /* texels of the squares that are looked at together */
#define WR_Z_SQUARES (WR_TILE / WR_Z_SQUARE)

typedef struct WrZSheet {
    int x, y;       /* of its first texel */
    int wide, high; /* texels that the table has in it */
    double floor;
    double depth[WR_TILE * WR_TILE]; /* the highest at the centre; -inf: none there */
    double edge[WR_TILE * WR_TILE];  /* the highest at other samples */
    double
        whole[WR_TILE * WR_TILE]; /* at the centre, the highest of solids that cover all samples */
    uint16_t mask[WR_TILE * WR_TILE];
    uint8_t
        bodies[WR_TILE * WR_TILE]; /* solids that cover it, in part or all; 2: more, or one twice */
    int block[WR_TILE * WR_TILE];  /* 1 + its block's index; 0: none */
    WR_ARRAY(WrZBlock) blocks;     /* of texels that a solid covers in part */
    /* of what is hidden, by squares of the tile (zbuffer_bound.c) */
    bool culls;
    int64_t squares; /* drawn */
    double
        settled[WR_Z_SQUARES * WR_Z_SQUARES]; /* solids that are not higher change nothing there */
    uint8_t draws[WR_Z_SQUARES * WR_Z_SQUARES]; /* since that was found out */
    double least;                               /* of them all */
} WrZSheet;

/* Draw one image of a primitive, moved by (dx, dy) whole texels. */
void wr_zsheet_triangle(WrZSheet *sheet, const WrZTriangle *triangle, double dx, double dy);
void wr_zsheet_solid(WrZSheet *sheet, const WrZSolid *solid, double dx, double dy);

/* ---- what is hidden: zbuffer_bound.c ---- */

typedef struct WrZRect {
    double x0, y0, x1, y1; /* texels, closed */
} WrZRect;
/* No place of the solid over the rectangle is higher. */
double wr_zsolid_bound(const WrZSolid *solid, const WrZRect *rect);
/* From now on look for what is hidden; the sheet is empty. */
void wr_zsheet_cull(WrZSheet *sheet);
/* A solid that is nowhere in the square higher than that changes nothing there. */
double wr_zsheet_settled(WrZSheet *sheet, int square);
/* The same for triangles, anywhere in the tile. */
double wr_zsheet_filled(const WrZSheet *sheet);

/* texels of [low, high] as whole numbers; x may be any number */
static inline int wr_z_clip(double x, int low, int high)
{
    return x < low ? low : x > high ? high : (int)x;
}

static inline void wr_z_raise(double *depth, double z)
{
    if (z > *depth) *depth = z;
}
