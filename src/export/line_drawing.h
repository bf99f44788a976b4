/* line_drawing.h - 3D line drawing of a table with its hidden lines removed: the paper's figure 5. Private to
   this module.

   The heights stand on the unit square, z = relief F, in parallel projection, rotated about the vertical by
   turn_deg and seen from tilt_deg above the horizon. Lines run along u and along v through texels' centres. */
#pragma once
#include "image/vector_drawing.h"

#include <stdbool.h>
#include <stdint.h>

#define WR_LINES_MAX 1024   /* maximum lines along either axis */
#define WR_DRAWING_MAX 4096 /* maximum pixels along a side of the drawing */

typedef struct WrLinesView {
    /* number of lines along u and along v: 0..WR_LINES_MAX; 0: none; limited to the texels */
    int lines_u, lines_v;
    double turn_deg, tilt_deg; /* any; 0..90 */
    double relief;             /* height of F = 1, cells */
    bool hidden;               /* hidden lines are drawn as well */
    int width, height;         /* of the drawing, pixels, 16..WR_DRAWING_MAX */
} WrLinesView;

/* One visible stretch of a line. */
typedef struct WrStretch {
    int first, count; /* points[first] .. */
} WrStretch;

typedef struct WrDrawing {
    WrVectorDrawingPoint *points; /* [point_count]; owned */
    WrStretch *stretches;         /* [stretch_count]; owned */
    int point_count, stretch_count;
} WrDrawing;

/* Position of a height in the drawing, and its depth (larger is farther). */
typedef struct WrLinesPlace {
    double x, y, depth;
} WrLinesPlace;
typedef struct WrLinesFrame { /* resulting view and scale */
    double xx, xy, yx, yy, yz, dx, dy, dz, left, top, scale;
} WrLinesFrame;
WrLinesPlace wr_lines_place(const WrLinesFrame *frame, double u, double v, double z);

/* Draws the lines. heights: [rows][columns] samples at texel centres, row 0 at the top of the cell; columns,
   rows >= 1. frame may be NULL; the caller owns the drawing. Visibility is computed on a raster of a quarter of
   a pixel. Error: no memory. */
bool wr_lines_draw(const float *heights, int columns, int rows, const WrLinesView *view,
                   WrLinesFrame *frame, WrDrawing *drawing, WrError *err);
void wr_drawing_fini(WrDrawing *drawing);
