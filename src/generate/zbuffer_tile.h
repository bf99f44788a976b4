/* zbuffer_tile.h - one tile of the depth buffer while it is drawn.
   Private to the depth buffer. */
#pragma once
#include "base/array.h"
#include "field/field.h"
#include "generate/zbuffer.h"

#include <stdbool.h>
#include <stdint.h>

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
    int64_t squares;               /* drawn */
} WrZSheet;

/* One image of a primitive. */
typedef struct WrZEntry {
    int64_t index; /* of the solid, or solid_count + of the triangle */
    double dx, dy; /* texels: the image is moved by this */
} WrZEntry;

/* Draw one image of a primitive, moved by (dx, dy) whole texels. */
void wr_zsheet_triangle(WrZSheet *sheet, const WrZTriangle *triangle, double dx, double dy);
void wr_zsheet_solid(WrZSheet *sheet, const WrZSolid *solid, double dx, double dy);
/* Only what of it lies in the square whose first texel is (x, y) of the tile. dx, dy: of parts of texels too, if
 * they are places as from wr_z_place. */
void wr_zsheet_solid_at(WrZSheet *sheet, const WrZSolid *solid, double dx, double dy, int x, int y);

/* May the work go on? part: of the tile, 0..1. */
typedef struct WrZGoOn {
    bool (*call)(const void *ctx, double part);
    const void *ctx;
} WrZGoOn;
/* Draw the images of solids [count], but what is hidden. Drawing that too would change no bit. False: told to
   stop. */
bool wr_zsheet_many(WrZSheet *sheet, const WrZScene *scene, const WrZEntry *entries, int64_t count,
                    const WrZGoOn *go_on);

/* ---- what is hidden: zbuffer_bound.c ---- */

/* Fill in what the solid's bounds are found from; part of wr_zsolid_set. */
void wr_zsolid_set_bounds(WrZSolid *solid);

typedef struct WrZRect {
    double x0, y0, x1, y1; /* texels, closed */
} WrZRect;
/* No place of the solid over the rectangle is higher; -inf: it is not there. *least: where it covers all of the
   rectangle, none is lower; else -inf. */
double wr_zsolid_range(const WrZSolid *solid, const WrZRect *rect, double *least);
/* Each texel of the square of WR_Z_SQUARE from (x, y) on: a solid that is nowhere higher than that changes nothing
   there; inf beyond the table. Returns the least. */
double wr_zsheet_settled(const WrZSheet *sheet, int x, int y,
                         double settled[WR_Z_SQUARE * WR_Z_SQUARE]);
/* The same of one texel. */
double wr_zsheet_settled_texel(const WrZSheet *sheet, int at);

/* A torus that lies flat and is not thin, of which single texels can be told apart. */
bool wr_zsolid_is_ring(const WrZSolid *solid);
/* How far from its axis such a torus may change each texel of a square: squares of distances. Holds for all of that
   height and those radii. */
typedef struct WrZBand {
    double at, ring, tube; /* of the torus; tube 0: none yet */
    double
        within; /* a texel whose centre is that near to the middle line is covered, and its height is all
                              that counts */
    double low[WR_Z_SQUARE * WR_Z_SQUARE], high[WR_Z_SQUARE * WR_Z_SQUARE];
} WrZBand;
/* For the ring, anew where it is another kind, else only for the texels (a bit each, row by row) that have changed.
 * settled: from wr_zsheet_settled. */
void wr_zband_set(WrZBand *band, const WrZSolid *ring, double floor, const double *settled,
                  uint64_t texels);
/* The texels that such a ring may change. (x, y): from its axis to the square's first texel. */
uint64_t wr_zband_meets(const WrZBand *band, double x, double y);
/* Whether it lies well within those texels. */
bool wr_zband_is_within(const WrZBand *band, double x, double y, uint64_t texels);
/* Draw it there, where its height over the centre is all that counts. (x, y): the square's first
 * texel; texels: not 0. */
void wr_zsheet_ring_at(WrZSheet *sheet, const WrZSolid *ring, double dx, double dy, int x, int y,
                       uint64_t texels);
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
