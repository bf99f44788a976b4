/* select.h - selections: which part of a table an operation or a layer acts on, how it is made, combined
   and drawn. A selection is a WrField of 0..1 with the table's size and wrap; none at all (NULL) means
   everything.

   Everything wraps: on a periodic axis a shape is there with all its periodic images, so it may cross
   the edges or be larger than the table, and a texel's coverage is the part of its square that lies in
   any of them. On a clamped axis what lies outside the table is cut off.

   All functions that give a table: NULL and an error for arguments that are out of range or not finite,
   or without memory; else a new table, the caller's. `like` lends its size and wrap. pool NULL: all on
   this thread. The bits are the same on every processor and for any number of threads; where the table
   is rolled by whole texels, so is the selection, bit for bit. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;

/* How far from the origin the points of a shape may lie, in cells. */
#define WR_SELECT_REACH 64
#define WR_SELECT_POINTS 16384 /* of a lasso, at most */

typedef struct WrSelectPoint {
    double u, v; /* table parameters, v up; -WR_SELECT_REACH..WR_SELECT_REACH */
} WrSelectPoint;

/* The rectangle with the corners a and b, any two that face each other. Coverage is exact: each edge is
 * rounded to 1/65536 texel. A corner beyond 1 (u from 0.9 to 1.1) crosses the table's edge. */
WrField *wr_select_rectangle(const WrField *like, WrSelectPoint a, WrSelectPoint b, WrPool *pool,
                             WrError *err);
/* The ellipse that touches the sides of that rectangle. Coverage within 1/500 of a texel's area. */
WrField *wr_select_ellipse(const WrField *like, WrSelectPoint a, WrSelectPoint b, WrPool *pool,
                           WrError *err);
/* The polygon through 3..WR_SELECT_POINTS points, closed by itself, which may cross itself: inside is
 * where a ray meets it an odd number of times. Points are rounded to 1/65536 texel; coverage is exact
 * but for where sides cross: there within 1/500 for each crossing in the texel's row, as long as no more
 * than 64 sides pass through that row. A polygon without area gives an empty selection.
 * points   [count], each joined to the next in a straight line, not the shorter way round */
WrField *wr_select_lasso(const WrField *like, const WrSelectPoint *points, int count, WrPool *pool,
                         WrError *err);

/* Texels whose height is in low..high: 1 there, falling in a straight line to 0 at `soft` height units
 * outside of it; soft 0 gives a hard edge, low and high included. low <= high, soft >= 0. */
WrField *wr_select_height(const WrField *field, double low, double high, double soft, WrPool *pool,
                          WrError *err);
/* Texels whose slope angle is in low..high degrees (0..90), with a soft edge of `soft` degrees as above.
 *
 *   angle = atan(relief sqrt(su^2 + sv^2)),   su = (T[i+1,j] - T[i-1,j]) / 2,  sv likewise
 *
 * relief   how many texels one unit of height is tall, > 0: height per texel times relief is a slope
 * Clamped axes take the table's second-order extrapolation beyond the edge. */
WrField *wr_select_slope(const WrField *field, double relief, double low, double high, double soft,
                         WrPool *pool, WrError *err);

/* The connected part, round all periodic edges, of the texels whose heights are within `tolerance` (0 or
 * more) of the height of the texel that holds (u, v): 1 there, 0 elsewhere, without soft edges. Texels are
 * connected where they share a side, with `diagonal` also where they share a corner. Off the ends of a
 * clamped axis the nearest texel counts.
 * Memory   one bit a texel and the edge of what was reached, besides the result
 * Errors   "cancelled" too, where progress (NULL: none) says so */
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

/* Join a new selection `b` to the present one `a`, which may be NULL: to add to or intersect with
 * everything gives b, and to subtract from it gives what b leaves. Tiles that b does not change are
 * shared with a. */
WrField *wr_select_combine(const WrField *a, const WrField *b, WrSelectMode mode, WrError *err);
/* 1 - a. */
WrField *wr_select_invert(const WrField *a);

/* Grow by r texels, 0 or more and finite. With d the distance from a texel's centre to the nearest
 * centre where a >= 1/2, exact Euclidean and round all the edges:
 *
 *   grown = max(a, clamp(r + 1 - d, 0, 1))
 *
 * so a straight edge moves by exactly r and a slanted one stays smooth; r = 0 gives a share of a. */
WrField *wr_select_grow(const WrField *a, double r, WrPool *pool, WrError *err);
/* Shrink by r texels: with d the distance to the nearest centre where a < 1/2,
 *   shrunk = min(a, clamp(d - r, 0, 1)) */
WrField *wr_select_shrink(const WrField *a, double r, WrPool *pool, WrError *err);
/* Blur by a Gaussian of `sigma` texels, the table operation "blur"; the result stays in 0..1. */
WrField *wr_select_feather(const WrField *a, double sigma, WrPool *pool, WrError *err);

/* The smallest box that holds all texels that are not 0, of a selection those selected at all, of any other field its
 * content; from texel (i, j), row j from the top; it may go over periodic edges. False: there is none. */
typedef struct WrSelectBox {
    int i, j, count_i, count_j;
} WrSelectBox;
bool wr_select_box(const WrField *selection, WrSelectBox *box);

/* The outline, for drawing: where the bilinear surface through the texels' centres is about 1/2. */
typedef struct WrOutlineLoop {
    int first, count;   /* points[first] .. points[first + count - 1], in order, the inside on the
                           left as seen with v up */
    int wind_u, wind_v; /* after the last point comes the first, moved by so many whole cells; 0, 0
                           but for loops that run round a periodic table */
} WrOutlineLoop;

typedef struct WrOutline {
    WrSelectPoint
        *points;          /* [point_count], owned. Loops go on beyond the edges, not back to 0..1 */
    WrOutlineLoop *loops; /* [loop_count], owned */
    int point_count, loop_count;
} WrOutline;

#define WR_OUTLINE_POINTS 4194304 /* at most, before straight runs are joined */

/* Marching squares at 1/2 through the centres of texels, two sides of a saddle joined where the mean of
 * its four corners is 1/2 or more. On a clamped axis the outline is closed along the edge. False and an
 * error for an outline of more than WR_OUTLINE_POINTS points or without memory. */
bool wr_select_outline(const WrField *selection, WrOutline *outline, WrError *err);
void wr_outline_fini(WrOutline *outline); /* fine on a zeroed one */
