/* pattern.h - common parts of patterns: the sampling grid, edge profiles, and randomly varied pieces.
   Private to this module.

   A pattern is a function of a position: x texels to the right of the origin, y upwards, within one
   table. It returns about 0..1, multiplied by the row's `height`. Everything repeats an integer number
   of times across the table, so that the pattern tiles; and since it depends only on the position, a
   moved origin rolls it bit for bit. */
#pragma once
#include "base/enum_rows.h"
#include "generate/tile_builder.h"
#include "generate/generator.h"
#include "noise/noise.h"

#include <stdbool.h>
#include <stdint.h>

/* Height at a position; ctx belongs to the pattern. Any thread. */
typedef double (*WrPatternAt)(const void *ctx, double x, double y);

/* Fills the output: height times the mean of samples x samples positions in each texel (1: its centre,
 * for antialiased patterns; always in a coarse preview). Reads height and origin. */
bool wr_pattern_make(const WrParams *params, const WrGenerateJob *job, WrPatternAt at,
                     const void *ctx, int samples, WrRelief *out, WrError *err);
#define WR_PATTERN_SAMPLES 4

/* ---- cells ---- */

/* A grid of cells on the table. */
typedef struct WrCells {
    double width, height;           /* of the table, texels */
    int across, rows;               /* cells, from 1 */
    double cell_width, cell_height; /* texels; may be fractional */
    bool turned;                    /* for patterns along v: x and y are exchanged */
} WrCells;

WrCells wr_cell_grid_make(const WrField *like, int across, int rows);
/* From the parameters across and rows. */
WrCells wr_cells_of(const WrParams *params, const WrField *like);
/* wr_cells_of for patterns with a direction, the parameter along. */
WrCells wr_cells_directed(const WrParams *params, const WrField *like);
/* Exchanges x and y if the pattern is turned. */
static inline void wr_cells_turn(const WrCells *cells, double *x, double *y)
{
    const double keep = *x;
    if (!cells->turned) return;
    *x = *y;
    *y = keep;
}

#define WR_CELLS_MAX 1024 /* maximum along an axis */
#define WR_P_ACROSS(value)                                                                         \
    WR_P_WHOLE("across", "Across", value, 1, WR_CELLS_MAX, 32, "number across")
#define WR_P_ROWS(value) WR_P_WHOLE("rows", "Rows", value, 1, WR_CELLS_MAX, 32, "number of rows")

static inline int wr_modulo(int i, int n)
{
    int rest = i % n;
    return rest < 0 ? rest + n : rest;
}

/* A random number 0..1 from a seed, two integers and a purpose; a multiple of 2^-24, so that sums are
 * exact. */
double wr_chance(uint32_t seed, int i, int j, int use);

/* Adds a remark if rows is no multiple of `multiple`: "the bond closes where ..." */
void wr_note_rows(const WrGenerateJob *job, int rows, int multiple, const char *what);

/* ---- direction of pieces ---- */

#define WR_ALONGS(X)                                                                               \
    X(WR_ALONG_U, "u")                                                                             \
    X(WR_ALONG_V, "v")
enum { WR_ALONGS(WR_WORD_ID) };
extern const char *const wr_along_words[];
#define WR_P_ALONG                                                                                 \
    WR_P_CHOICE("along", "Along", WR_ALONG_U, wr_along_words, "direction in which they run")

/* ---- edges ---- */

/* A convex quarter circle; 3 t^2 - 2 t^3; a linear slope; a concave quarter circle. */
#define WR_PROFILES(X)                                                                             \
    X(WR_PROFILE_ROUND, "round")                                                                   \
    X(WR_PROFILE_SMOOTH, "smooth")                                                                 \
    X(WR_PROFILE_CHAMFER, "chamfer")                                                               \
    X(WR_PROFILE_COVE, "cove")
typedef enum WrProfile { WR_PROFILES(WR_WORD_ID) } WrProfile;

/* The rise of a height from 0 at an edge to 1 at `bevel` texels inside. */
typedef struct WrEdge {
    double bevel; /* texels, 0: a step */
    WrProfile profile;
} WrEdge;

extern const char *const wr_profile_words[];
#define WR_P_BEVEL(value) WR_P_TEXELS("bevel", "Bevel", value, 32, "width of the rounded edge")
#define WR_P_PROFILE                                                                               \
    WR_P_CHOICE("profile", "Profile", WR_PROFILE_ROUND, wr_profile_words, "profile of the edge")
WrEdge wr_edge_of(const WrParams *params);

/* The height at d texels inside an edge (below 0: outside), averaged over one texel across the edge, in
 * closed form: for a straight edge along the table's axes an exact box filter. */
double wr_edge_height(const WrEdge *edge, double d);

/* Distance of (dx, dy) inside a rectangle of those half sides with rounded corners, texels. */
double wr_inside_box(double dx, double dy, double half_x, double half_y, double corner);

/* ---- pieces: bricks, tiles, planks, stones ---- */

/* Random variation and surface of pieces. */
typedef struct WrPieces {
    WrEdge edge;
    double uneven, tilt, pillow, rough; /* fractions of the height */
    uint32_t seed;
    double width, height; /* of the table, texels */
    WrNoise grain[2];     /* coarse and fine */
} WrPieces;

#define WR_P_PIECES(uneven, tilt, pillow, rough)                                                   \
    WR_P_PART("uneven", "Height variation", uneven,                                                \
              "random height of the pieces, as a share of the height"),                            \
        WR_P_PART("tilt", "Tilt", tilt, "tilt of each piece, as a share of the height"),           \
        WR_P_PART("pillow", "Pillow", pillow, "bulge of the middle"),                              \
        WR_P_PART("rough", "Roughness", rough,                                                     \
                  "roughness of the surface, as a share of the height"),                           \
        WR_P_SEED

/* cells: their size determines that of the grain. */
WrPieces wr_pieces_of(const WrParams *params, const WrCells *cells);
/* The height of a piece at a position d texels inside its edge, (px, py) from its middle with -1 and 1
 * at its sides; (i, j) identifies the piece. */
double wr_piece(const WrPieces *pieces, double d, double px, double py, int i, int j, double x,
                double y);
/* sin(2 pi turns) to 1e-7, for detail evaluated many times per texel; |turns| < 1e9. */
double wr_ripple(double turns);
/* Noise of -1..1, two octaves, at a position. */
double wr_piece_roughness(const WrNoise grain[2], const WrPieces *pieces, double x, double y);
/* A noise that repeats after this many cells. */
WrNoise wr_pattern_noise(uint32_t seed, double cells_u, double cells_v);

/* ---- the rows: parameters and functions, by file ---- */

#define WR_PATTERN(name)                                                                           \
    extern const WrParam wr_params_##name[];                                                       \
    bool wr_pattern_##name(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,    \
                           WrError *err)

WR_PATTERN(bricks); /* pattern_wall.c */
WR_PATTERN(tiles);
WR_PATTERN(hexagons);
WR_PATTERN(planks);
WR_PATTERN(shingles); /* pattern_coat.c */
WR_PATTERN(scales);
WR_PATTERN(grid); /* pattern_line.c */
WR_PATTERN(checks);
WR_PATTERN(stripes);
WR_PATTERN(waves);
WR_PATTERN(knurl);
WR_PATTERN(dots); /* pattern_cell.c */
WR_PATTERN(voronoi);
WR_PATTERN(cracks);
WR_PATTERN(weave); /* pattern_cloth.c */
WR_PATTERN(rope);
WR_PATTERN(chain);     /* pattern_metal.c */
WR_PATTERN(scratches); /* pattern_scratch.c */
#undef WR_PATTERN
