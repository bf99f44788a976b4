/* text.h - conversion of closed outlines to a relief: coverage of each texel, distance inside the
   outline, and a profile over that distance.
   Private to this module.

   Outlines are polygons in texels, x to the right, y down, from the table's top left corner. A point is
   inside where the total winding number of all polygons, with all their periodic images, is not 0; so
   overlapping glyphs are one shape. Corners are rounded to 1/65536 texel. Every outline is cut along
   the borders of texels into pieces, with positions relative to their texel, in integers; all further
   steps work texel by texel on the pieces in a canonical order. So neither the order of outlines nor
   the table's origin can change a bit. */
#pragma once
#include "base/array.h"
#include "base/enum_rows.h"
#include "field/wrap.h"
#include "generate/tile_builder.h"

#include <stdbool.h>
#include <stdint.h>

#define WR_TEXT_SUB 65536              /* corners are multiples of 1/WR_TEXT_SUB texel */
#define WR_TEXT_UNIT (2 * WR_TEXT_SUB) /* size of a texel in the units of pieces */
#define WR_TEXT_PIECES_MAX ((int64_t)1 << 25)

/* The part of an outline's side in one texel, in units from the texel's top left corner, 0..UNIT.
 * Corners have odd coordinates, so that none lies on a texel's border. */
typedef struct WrTextPiece {
    int32_t x0, y0, x1, y1;
    uint16_t i, j; /* the texel */
} WrTextPiece;

/* Outlines under construction. */
typedef struct WrTextShape {
    int width, height;
    bool wraps_u, wraps_v;
    WrTextPiece *pieces; /* [count], owned */
    int64_t count, room, steps;
    int64_t *base; /* [height] the winding number at each row's upper left corner */
} WrTextShape;

bool wr_text_shape_init(WrTextShape *shape, const WrField *like, bool clip, WrError *err);
void wr_text_shape_fini(WrTextShape *shape);

/* Adds a closed polygon: its corners are moved by `move`, which is separate so that a move by whole
 * texels stays exact. xy: [count][2] texels, within 2^20 of 0; move: within 2^30.
 * Errors   out of range, too many pieces, out of memory */
bool wr_text_shape_add(WrTextShape *shape, const double *xy, int count, const double move[2],
                       WrError *err);

/* Adds a single side from a to b; then the winding numbers at the rows' corners are undefined. Within
 * 2^20 of 0. */
bool wr_text_shape_side(WrTextShape *shape, const double a[2], const double b[2], WrError *err);

/* Inside of the shape on a whole table. */
typedef struct WrTextInside {
    /* The coverage of each texel; negative if the texel's centre is outside. Coverage within 1/16384 of
     * 0 or 1 is rounded to it. */
    WrField *cover;
    /* The outline's pieces between inside and outside, sorted by row, then by column. */
    struct WrTextRim {
        WR_ARRAY(WrTextPiece) pieces;
        int first[WR_TILE + 1]; /* of each row */
    } * rims;                   /* [ceil(height / WR_TILE)], owned */
} WrTextInside;

/* Sorts the shape's pieces. */
void wr_text_inside_fini(WrTextInside *inside, int height);

/* Processes one texel: n pieces of one texel, winding number w at its upper left corner. Returns the
 * coverage, exact up to 48 pieces and 2048 crossings; `rim` receives pieces between inside and outside.
 * For more pieces the coverage is the winding number's mean, up to 1, and all pieces count as rim. */
double wr_text_texel(const WrTextPiece *pieces, int n, int64_t w, bool *centre_inside,
                     struct WrTextRim *rim);

/* Distances from the centres of a tile's texels to the nearest rim, up to `reach` texels; only where
 * want[y * WR_TILE + x] is set. Exact except for the rounding of pieces. scratch: reused from tile to
 * tile. */
typedef struct WrTextNear {
    WR_ARRAY(float) x, y;  /* centres of pieces, texels from the tile's corner */
    WR_ARRAY(double) ends; /* four per piece */
    WR_ARRAY(int) list;
} WrTextNear;
void wr_text_near_fini(WrTextNear *near);
void wr_text_distances(const WrTextShape *shape, const WrTextInside *inside,
                       const WrGenerateBlock *block, double reach, const bool *want,
                       WrTextNear *near, float *distance);

/* ---- profiles ---- */

/* A plateau with vertical walls; a quarter circle, then a plateau; a linear slope, then a plateau; a
   linear slope up to the medial axis; the chisel's, downwards. */
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

/* The height of a texel with coverage `cover`, whose centre is inside or not, at this distance from the
 * rim; multiplied by the coverage it yields the profile. */
float wr_text_height(const WrTextFinish *finish, double cover, bool centre, double distance);
/* The relief of a shape: heights, and the coverage of each texel. */
bool wr_text_relief(WrTextShape *shape, const WrTextFinish *finish, const WrGenerateJob *job,
                    WrRelief *out, WrError *err);
