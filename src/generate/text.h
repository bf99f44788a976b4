/* text.h - closed outlines turned into a relief: which part of each texel they cover, how far each texel is
   inside of them, and a profile over that distance.
   Private to this module.

   Outlines are polygons in texels, x to the right, y down, from the table's top left corner. A place is
   inside where the winding number of all of them together, with all their periodic images, is not 0; so
   glyphs that overlap are one shape. Corners are rounded to 1/65536 texel.

   Every outline is cut along the borders of texels into pieces, with places relative to their texel, in
   whole numbers; all that follows is done texel by texel from the pieces in an order of their own. So
   neither the order of outlines nor where the table begins can change a bit. */
#pragma once
#include "base/array.h"
#include "base/enum_rows.h"
#include "field/wrap.h"
#include "generate/tile_builder.h"

#include <stdbool.h>
#include <stdint.h>

#define WR_TEXT_SUB 65536              /* corners are multiples of 1/WR_TEXT_SUB texel */
#define WR_TEXT_UNIT (2 * WR_TEXT_SUB) /* a texel in the units of pieces */
#define WR_TEXT_PIECES_MAX ((int64_t)1 << 25)

/* The part of an outline's side in one texel, in units from the texel's top left corner, 0..UNIT. Corners
 * have odd numbers, so that none lies on a texel's border. */
typedef struct WrTextPiece {
    int32_t x0, y0, x1, y1;
    uint16_t i, j; /* the texel */
} WrTextPiece;

/* Outlines being gathered. */
typedef struct WrTextShape {
    int width, height;
    bool wraps_u, wraps_v;
    WrTextPiece *pieces; /* [count], owned */
    int64_t count, room, steps;
    int64_t *base; /* [height] the winding number at each row's upper left corner */
} WrTextShape;

bool wr_text_shape_init(WrTextShape *shape, const WrField *like, bool clip, WrError *err);
void wr_text_shape_fini(WrTextShape *shape);

/* Add a closed polygon: its corners moved by `move`, which is kept apart so that a move by whole texels
 * stays one. xy: [count][2] texels, within 2^20 of 0; move: within 2^30.
 * Errors   out of reach, too many pieces, no memory */
bool wr_text_shape_add(WrTextShape *shape, const double *xy, int count, const double move[2],
                       WrError *err);

/* One side alone, from a to b; then the winding numbers at the rows' corners mean nothing. Within 2^20 of 0. */
bool wr_text_shape_side(WrTextShape *shape, const double a[2], const double b[2], WrError *err);

/* What is inside, of a whole table. */
typedef struct WrTextInside {
    /* The covered part of each texel; below 0 where the texel's centre is outside. Within 1/16384 of
     * nothing and all it is 0 and 1. */
    WrField *cover;
    /* The outline's pieces between inside and outside, sorted by row, then by column. */
    struct WrTextRim {
        WR_ARRAY(WrTextPiece) pieces;
        int first[WR_TILE + 1]; /* of each row */
    } * rims;                   /* [ceil(height / WR_TILE)], owned */
} WrTextInside;

/* Sorts the shape's pieces. */
bool wr_text_inside(WrTextShape *shape, const WrGenerateJob *job, double from, double to,
                    WrTextInside *out, WrError *err);
void wr_text_inside_fini(WrTextInside *inside, int height);

/* One texel's part of the work: n pieces of one texel, winding number w at its upper left corner. Returns
 * the covered part, exact up to 48 pieces and 2048 crossings of theirs; `rim` takes pieces between inside
 * and outside. Of more pieces the part is the winding number's mean, up to 1, and all count as rim. */
double wr_text_texel(const WrTextPiece *pieces, int n, int64_t w, bool *centre_inside,
                     struct WrTextRim *rim);

/* Distances from the centres of a tile's texels to the nearest rim, up to `reach` texels; only where
 * want[y * WR_TILE + x] is set. Exact but for the rounding of pieces. scratch: kept from tile to tile. */
typedef struct WrTextNear {
    WR_ARRAY(float) x, y;  /* middles of pieces, texels from the tile's corner */
    WR_ARRAY(double) ends; /* four a piece */
    WR_ARRAY(int) list;
} WrTextNear;
void wr_text_near_fini(WrTextNear *near);
void wr_text_distances(const WrTextShape *shape, const WrTextInside *inside,
                       const WrGenerateBlock *block, double reach, const bool *want,
                       WrTextNear *near, float *distance);

/* ---- profiles ---- */

/* A plateau with steep walls; a quarter of a circle, then a plateau; a straight slope, then a plateau; a straight slope
   up to the middle line; the chisel's, downwards. */
#define WR_TEXT_PROFILES(X)                                                                        \
    X(WR_TEXT_FLAT, "flat")                                                                        \
    X(WR_TEXT_ROUND, "round")                                                                      \
    X(WR_TEXT_CHISEL, "chisel")                                                                    \
    X(WR_TEXT_RIDGE, "ridge")                                                                      \
    X(WR_TEXT_ENGRAVED, "engraved")
typedef enum WrTextProfile { WR_TEXT_PROFILES(WR_WORD_ID) } WrTextProfile;

typedef struct WrTextFinish {
    WrTextProfile profile;
    double bevel;  /* texels */
    double height; /* table units */
} WrTextFinish;

/* Of a texel that is covered by `cover`, whose centre is inside or not and so far from the rim; such that times the
 * coverage it gives the profile. */
float wr_text_height(const WrTextFinish *finish, double cover, bool centre, double distance);
/* The relief of a shape: heights, and the covered part of each texel as cover. */
bool wr_text_relief(WrTextShape *shape, const WrTextFinish *finish, const WrGenerateJob *job,
                    WrNormalMips *out, WrError *err);
