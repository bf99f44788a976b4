/* view.h - where the table stands on the canvas: texels to pixels and back, zooming, panning, and the
   copies of the brush's outline. Pure geometry; tested without a window.

   Pixel positions are relative to the window; texel positions run right and DOWN from the top left
   corner of the real cell and are not wrapped: the copy to the right of the cell starts at x = W. */
#pragma once
#include <stdbool.h>

/* How copies stand beside the cell, to the eye: what is painted is the same. */
typedef enum WrTiling {
    WR_TILING_STRAIGHT,
    WR_TILING_HALF_DROP, /* every other column half a cell lower */
    WR_TILING_BRICK,     /* every other row half a cell to the right */
    WR_TILINGS
} WrTiling;

typedef struct WrCanvasView {
    int x, y, w, h;            /* the canvas's rectangle in the window, pixels; w, h >= 1 */
    int table_w, table_h;      /* texels */
    double zoom;               /* pixels a texel; see wr_view_zoom_range */
    double centre_x, centre_y; /* texel position in the middle of the canvas */
    bool mirrored;             /* the table runs to the left: seen so, what is lopsided shows */
    double turn;               /* degrees clockwise about the middle of the canvas; -180..180 */
    WrTiling tiling;
} WrCanvasView;

/* Zoom 1 is 100 %. From 1/128, or where the longer side is 64 pixels if that is less zoomed out, up to
   128 pixels a texel. */
void wr_view_zoom_range(const WrCanvasView *view, double *low, double *high);
/* Show the whole cell with `margin` (0..1) of the canvas free around it; turns stay. */
void wr_view_fit(WrCanvasView *view, double margin);
/* Zoom to `zoom` (clamped) so that the texel under the pixel (px, py) stays there. */
void wr_view_zoom_at(WrCanvasView *view, double px, double py, double zoom);
/* Turn the picture to `degrees` clockwise (any; brought into -180..180) about the texel under the pixel (px, py), which
   stays there. */
void wr_view_turn_at(WrCanvasView *view, double px, double py, double degrees);
/* Move the picture by dx, dy pixels. The centre stays within the cell by whole periods on tiled axes:
   what is seen is the same, and positions never grow. */
void wr_view_pan(WrCanvasView *view, double dx, double dy);
void wr_view_keep_near(WrCanvasView *view);

void wr_view_to_texel(const WrCanvasView *view, double px, double py, double *x, double *y);
void wr_view_to_pixel(const WrCanvasView *view, double x, double y, double *px, double *py);
/* u = x/W, v = 1 - y/H: unwrapped parameters under a pixel. */
void wr_view_to_uv(const WrCanvasView *view, double px, double py, double *u, double *v);

/* Where a texel would be if copies stood straight: for what lies across the cell's edges, which tilings tear. */
void wr_view_place(const WrCanvasView *view, double x, double y, double *px, double *py);
/* Pixels of a step of dx, dy texels. */
void wr_view_step(const WrCanvasView *view, double dx, double dy, double *px, double *py);
/* Texels of a step of dx, dy pixels. */
void wr_view_step_back(const WrCanvasView *view, double dx, double dy, double *x, double *y);
/* Texels by which the tiling moves the copy in column i, row j (0, 0: the real cell). */
void wr_view_tiling_shift(const WrCanvasView *view, int i, int j, double *dx, double *dy);
/* The copies that are seen, by column and row, with one more all around. */
typedef struct WrCellRange {
    int i0, i1, j0, j1; /* both ends are in it */
} WrCellRange;
WrCellRange wr_view_cells(const WrCanvasView *view);
/* The least rectangle of texels, as if copies stood straight, that holds all that is seen. */
void wr_view_bounds(const WrCanvasView *view, double low[2], double high[2]);
/* The view that is not turned and holds all that this one shows, pixel for pixel: its rectangle begins at 0, 0. */
WrCanvasView wr_view_flat(const WrCanvasView *view);
/* Cosine and sine of a turn by degrees; quarters are exact. */
void wr_view_turn_of(double degrees, double *c, double *s);
bool wr_view_same(const WrCanvasView *a, const WrCanvasView *b);

/* The shifts by whole cells, (dx, dy) in texels, at which a disc of `radius` texels about (x, y) also
 * enters the real cell: what the stroke will touch on the other side. (x, y) is first brought into the
 * cell; the first entry is the shift that does so. Axes that do not wrap give no copies. At most
 * WR_VIEW_COPIES; returns how many. */
#define WR_VIEW_COPIES 9
typedef struct WrShift {
    double dx, dy;
} WrShift;
int wr_view_outline_copies(const WrCanvasView *view, bool wraps_u, bool wraps_v, double x, double y,
                           double radius, WrShift copies[WR_VIEW_COPIES]);
