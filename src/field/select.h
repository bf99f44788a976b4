/* select.h - selections: creation, combination and outlines.

   A selection limits an operation or a layer to a part of the table. It is a WrField of 0..1 with the
   table's size and wrap; NULL means everything.

   On a periodic axis a shape exists with all its periodic images, so it may cross the edges or be
   larger than the table, and a texel's coverage is the part of its square inside any of them. On a
   clamped axis the part outside the table is cut off.

   Functions that return a table return a new one, owned by the caller; NULL and an error for arguments
   that are out of range or not finite, or when out of memory. `like` defines size and wrap. pool NULL:
   this thread only. The bits are the same on every processor and for any number of threads; if the
   table is rolled by whole texels, so is the selection, bit for bit. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;

/* Maximum distance of a shape's points from the origin, in cells. */
#define WR_SELECT_REACH 64
#define WR_SELECT_POINTS 16384 /* maximum points of a lasso */

typedef struct WrSelectPoint {
    double u, v; /* table parameters, v up; -WR_SELECT_REACH..WR_SELECT_REACH */
} WrSelectPoint;

/* The rectangle with the corners a and b, any two opposite ones. Coverage is exact: each edge is
 * rounded to 1/65536 texel. A corner beyond 1 (u from 0.9 to 1.1) crosses the table's edge. */
WrField *wr_select_rectangle(const WrField *like, WrSelectPoint a, WrSelectPoint b, WrPool *pool,
                             WrError *err);
/* The ellipse inscribed in that rectangle. Coverage within 1/500 of a texel's area. */
WrField *wr_select_ellipse(const WrField *like, WrSelectPoint a, WrSelectPoint b, WrPool *pool,
                           WrError *err);
/* The polygon through 3..WR_SELECT_POINTS points, closed automatically, which may cross itself:
 * even-odd rule. Points are rounded to 1/65536 texel; coverage is exact except where sides cross: there
 * within 1/500 for each crossing in the texel's row, as long as no more than 64 sides pass through that
 * row. A polygon without area yields an empty selection.
 * points   [count], joined by straight lines, not by the shorter way round the table */
WrField *wr_select_lasso(const WrField *like, const WrSelectPoint *points, int count, WrPool *pool,
                         WrError *err);

/* Texels whose height is in low..high: 1 there, falling linearly to 0 at `soft` height units outside;
 * soft 0 yields a hard edge, low and high included. low <= high, soft >= 0. */
WrField *wr_select_height(const WrField *field, double low, double high, double soft, WrPool *pool,
                          WrError *err);
/* Texels whose slope angle is in low..high degrees (0..90), with a soft edge of `soft` degrees as
 * above.
 *
 *   angle = atan(relief sqrt(su^2 + sv^2)),   su = (T[i+1,j] - T[i-1,j]) / 2,  sv the same along j
 *
 * relief   height of one table unit in texels, > 0: height per texel times relief is a slope Clamped
 *          axes use the table's second-order extrapolation beyond the edge. */
WrField *wr_select_slope(const WrField *field, double relief, double low, double high, double soft,
                         WrPool *pool, WrError *err);

/* Texels whose downhill direction is low..high degrees (0..180) away from the azimuth, degrees anticlockwise from u, v up, with a
 * soft edge as above. Level texels are 180 degrees from any. Slopes are central differences. */
WrField *wr_select_facing(const WrField *field, double azimuth, double low, double high,
                          double soft, WrPool *pool, WrError *err);

/* The connected region, across periodic edges, of the texels whose heights are within `tolerance` (0 or
 * more) of the height of the texel that contains (u, v): 1 there, 0 elsewhere, without soft edges.
 * Texels are connected if they share a side, with `diagonal` also if they share a corner. Points
 * outside a clamped axis use the nearest texel.
 * Memory   one bit per texel and the border of the region, besides the result
 * Errors   also "cancelled", if progress (NULL: none) is cancelled */
WrField *wr_select_flood(const WrField *field, double u, double v, double tolerance, bool diagonal,
                         WrPool *pool, const WrProgress *progress, WrError *err);

typedef enum WrSelectMode {
    WR_SELECT_REPLACE,
    WR_SELECT_ADD,       /* max(a, b) */
    WR_SELECT_SUBTRACT,  /* min(a, 1 - b) */
    WR_SELECT_INTERSECT, /* min(a, b) */
    WR_SELECT_MODES
} WrSelectMode;
/* As in commands: "replace", "add", ...; ends with NULL. */
extern const char *const wr_select_modes[WR_SELECT_MODES + 1];

/* Combines a new selection `b` with the present one `a`, which may be NULL (everything). Then adding or
 * intersecting returns b, and subtracting returns the complement of b. Tiles that b does not change are
 * shared with a. */
WrField *wr_select_combine(const WrField *a, const WrField *b, WrSelectMode mode, WrError *err);
/* 1 - a. */
WrField *wr_select_invert(const WrField *a);

/* Grows by r texels, 0 or more and finite. With d the distance from a texel's centre to the nearest
 * centre where a >= 1/2, exact Euclidean and across periodic edges:
 *
 *   grown = max(a, clamp(r + 1 - d, 0, 1))
 *
 * so a straight edge moves by exactly r and a slanted one stays smooth; r = 0 yields a share of a. */
WrField *wr_select_grow(const WrField *a, double r, WrPool *pool, WrError *err);
/* Shrinks by r texels: with d the distance to the nearest centre where a < 1/2,
 *
 *   shrunk = min(a, clamp(d - r, 0, 1)) */
WrField *wr_select_shrink(const WrField *a, double r, WrPool *pool, WrError *err);
/* Blurs by a Gaussian of `sigma` texels, the table operation "blur"; the result stays in 0..1. */
WrField *wr_select_feather(const WrField *a, double sigma, WrPool *pool, WrError *err);

/* The bounding box of all nonzero texels of a selection or any other field, from texel (i, j), row j
 * from the top; it may extend across periodic edges. False: all are 0. */
typedef struct WrSelectBox {
    int i, j, count_i, count_j;
} WrSelectBox;
bool wr_select_box(const WrField *selection, WrSelectBox *box);
/* That of several fields of the same size and wraps. fields: [count] */
bool wr_select_box_all(const WrField *const *fields, int count, WrSelectBox *box);

/* The outline for drawing: the contour at about 1/2 of the bilinear surface through the texels'
 * centres. */
typedef struct WrOutlineLoop {
    int first, count;   /* points[first] .. points[first + count - 1], in order, the inside on the
                           left as seen with v up */
    int wind_u, wind_v; /* offset in cells from the last point to the first: 0, 0 except for loops
                           that run around a periodic table */
} WrOutlineLoop;

typedef struct WrOutline {
    WrSelectPoint
        *points;          /* [point_count], owned. Loops continue beyond the edges, without wrapping
                             to 0..1 */
    WrOutlineLoop *loops; /* [loop_count], owned */
    int point_count, loop_count;
} WrOutline;

#define WR_OUTLINE_POINTS 4194304 /* maximum, before straight runs are joined */

/* Marching squares at 1/2 through the centres of texels; a saddle joins two sides if the mean of its
 * four corners is 1/2 or more. On a clamped axis the outline is closed along the edge. False and an
 * error for an outline of more than WR_OUTLINE_POINTS points or when out of memory. */
bool wr_select_outline(const WrField *selection, WrOutline *outline, WrError *err);
void wr_outline_fini(WrOutline *outline); /* a zeroed one is allowed */
