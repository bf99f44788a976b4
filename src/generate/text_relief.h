/* text_relief.h - layout of letters, and conversion of their closed outlines to a relief: coverage of each
   texel, distance inside the outline, and a profile over that distance.
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
#include "generate/generator.h"
#include "generate/tile_builder.h"
#include "image/font.h"

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

/* ---- layout ---- */

/* Layout of a text's letters on the table: in lines, rotated, on a path, around the
   table. */

/* Middle: half way between the first line's ascent and the last one's descent; the others refer to the
 * first line. */
#define WR_TEXT_ANCHORS(X)                                                                         \
    X(WR_TEXT_MIDDLE, "middle")                                                                    \
    X(WR_TEXT_BASELINE, "baseline")                                                                \
    X(WR_TEXT_TOP, "top")                                                                          \
    X(WR_TEXT_BOTTOM, "bottom")
typedef enum WrTextAnchor { WR_TEXT_ANCHORS(WR_WORD_ID) } WrTextAnchor;

/* Treatment of letters missing in the font. */
#define WR_TEXT_MISSING(X) X(WR_TEXT_BORROW, "borrow") X(WR_TEXT_SIGN, "sign")
enum { WR_TEXT_MISSING(WR_WORD_ID) };

typedef struct WrTextRequest {
    WrFontRequest ask;
    WrFontSetting setting;
    double at[2]; /* u, v */
    WrTextAnchor anchor;
    double rotate_deg;    /* anticlockwise as seen */
    const double *points; /* [point_count][2] u, v: a path; point_count 0: none */
    int point_count;
    bool around;       /* along lattice[0] tables to the right and lattice[1] up */
    double lattice[2]; /* integers */
    int repeats;       /* 0: the best number */
    bool clip;
} WrTextRequest;

/* Rows of those parameters, and of the others that select fonts. */
#define WR_P_FONT(value)                                                                           \
    {                                                                                              \
        .name = "font", .label = "Font", .help = "an installed font, if no file is given",         \
        .unit = "", .kind = WR_PARAM_CHOICE, .fallback = { value }, .words = wr_font_names         \
    }
#define WR_P_FONT_FILE                                                                             \
    { .name = "file",                                                                              \
      .label = "Font file",                                                                        \
      .help = "a font file: TrueType, OpenType, Type 1, PCF, BDF, OTB, also compressed by gzip",   \
      .unit = "",                                                                                  \
      .kind = WR_PARAM_FILE,                                                                       \
      .fallback_text = "" },                                                                       \
        WR_P_WHOLE("face", "Face", 0, 0, 65535, 15, "number of the font in a file with several")
#define WR_P_MISSING(n, words)                                                                     \
    WR_P_CHOICE(n, "Missing letters", WR_TEXT_BORROW, words,                                       \
                "characters that the font lacks. borrow: taken from other installed fonts; sign: " \
                "drawn as the font's sign for missing characters")
#define WR_P_FALLBACK(n, l, h)                                                                     \
    {                                                                                              \
        .name = (n), .label = (l), .help = (h), .unit = "", .kind = WR_PARAM_FILE,                 \
        .fallback_text = ""                                                                        \
    }

/* Adds all letters' outlines to a shape. Curves are approximated within 1/64 texel. Dots of bitmap
 * fonts with an integer number of texels each, unrotated, are exactly at texels.
 * Errors   all points are equal; around= on a table that is not periodic, or without direction; those
 *          of wr_text_shape_add; cancelled */
bool wr_text_lay(const WrTextRequest *wish, const WrFontText *text, const WrGenerateJob *job,
                 WrTextShape *shape, WrError *err);
