/* line_drawing.h - a table as a 3D line drawing with its hidden lines removed: the paper's figure 5.
   Layer 6. Private to this room.

   The heights stand on the unit square, z = relief F; the drawing looks at it in parallel projection,
   turned about the vertical by turn_deg and seen from tilt_deg above the horizon. Lines run along u and
   along v through texels' centres. */
#pragma once
#include "export/vector_drawing.h"

#include <stdbool.h>
#include <stdint.h>

#define WR_LINES_MOST 1024   /* lines along either axis */
#define WR_DRAWING_MOST 4096 /* pixels along a side of the drawing */

typedef struct WrLinesView {
    int lines_u,
        lines_v; /* lines along u, along v: 0..WR_LINES_MOST; 0: none; clamped to the texels */
    double turn_deg, tilt_deg; /* any; 0..90 */
    double relief;             /* height of F = 1, cells */
    bool hidden;               /* hidden lines are drawn as well */
    int width, height;         /* of the drawing, pixels, 16..WR_DRAWING_MOST */
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

/* Where a height stands in the drawing, and how far behind (larger is farther). */
typedef struct WrLinesPlace {
    double x, y, depth;
} WrLinesPlace;
typedef struct WrLinesFrame { /* view and scale, worked out */
    double xx, xy, yx, yy, yz, dx, dy, dz, left, top, scale;
} WrLinesFrame;
WrLinesPlace wr_lines_place(const WrLinesFrame *frame, double u, double v, double z);

/* heights: [rows][columns] samples at texel centres, row 0 at the top of the cell; columns, rows >= 1.
 * frame may be NULL; the drawing is the caller's. Visibility is found on a raster of a quarter of a
 * pixel. Error: no memory for it. */
bool wr_lines_draw(const float *heights, int columns, int rows, const WrLinesView *view,
                   WrLinesFrame *frame, WrDrawing *drawing, WrError *err);
void wr_drawing_fini(WrDrawing *drawing);
