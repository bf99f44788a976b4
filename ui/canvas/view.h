/* view.h - view transform of the canvas: texels to pixels and back, zooming, panning, rotation, and the copies of the
   brush's outline. Pure geometry; tested without a window.

   Pixel positions are relative to the window. Texel positions run right and DOWN from the top left corner of the cell
   and are not wrapped: the copy to the right of the cell starts at x = W. */
#pragma once
#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

/* Displayed arrangement of the copies beside the cell; painting is not affected. */
typedef enum WrTiling {
    WR_TILING_STRAIGHT,
    WR_TILING_HALF_DROP, /* every other column is half a cell lower */
    WR_TILING_BRICK,     /* every other row is half a cell to the right */
    WR_TILINGS
} WrTiling;

typedef struct WrCanvasView {
    int x, y, w, h;            /* the canvas's rectangle in the window, pixels; w, h >= 1 */
    int table_w, table_h;      /* texels */
    double zoom;               /* pixels per texel; see view_zoom_range */
    double centre_x, centre_y; /* texel position at the centre of the canvas */
    bool mirrored;             /* mirrored horizontally: reveals asymmetries */
    double turn;               /* degrees clockwise about the centre of the canvas; -180..180 */
    WrTiling tiling;
} WrCanvasView;

/* Show the whole cell with `margin` (0..1) of the canvas free around it; the rotation is unchanged. */
void wr_view_fit(WrCanvasView *view, double margin);
/* Zoom to `zoom` (clamped) with the texel under the pixel (px, py) fixed. */
void wr_view_zoom_at(WrCanvasView *view, double px, double py, double zoom);
/* Rotate the picture to `degrees` clockwise (any value; reduced to -180..180) with the texel under the pixel (px, py)
   fixed. */
void wr_view_turn_at(WrCanvasView *view, double px, double py, double degrees);
/* Move the picture by dx, dy pixels. On periodic axes the centre is moved back into the cell by whole periods: the
   display is the same, and positions never grow. */
void wr_view_pan(WrCanvasView *view, double dx, double dy);

void wr_view_to_texel(const WrCanvasView *view, double px, double py, double *x, double *y);
void wr_view_to_pixel(const WrCanvasView *view, double x, double y, double *px, double *py);
/* u = x/W, v = 1 - y/H: unwrapped parameters under a pixel. */
void wr_view_to_uv(const WrCanvasView *view, double px, double py, double *u, double *v);
/* u, v of the middle of the visible part, moved into the cell by whole cells. */
void wr_view_middle(const WrCanvasView *view, double at[2]);

/* Position of a texel without the tiling's shifts: for shapes across the cell's edges, which the shifts would tear
   apart. */
void wr_view_place(const WrCanvasView *view, double x, double y, double *px, double *py);
/* Pixels of a displacement of dx, dy texels. */
void wr_view_step(const WrCanvasView *view, double dx, double dy, double *px, double *py);
/* Texels of a displacement of dx, dy pixels. */
void wr_view_step_back(const WrCanvasView *view, double dx, double dy, double *x, double *y);
/* Shift in texels of the copy in column i, row j by the tiling (0, 0: the cell itself). */
void wr_view_tiling_shift(const WrCanvasView *view, int i, int j, double *dx, double *dy);
/* Visible copies by column and row, with one more on each side. */
typedef struct WrCellRange {
    int i0, i1, j0, j1; /* both ends inclusive */
} WrCellRange;
WrCellRange wr_view_cells(const WrCanvasView *view);
/* The smallest rectangle of texels, without the tiling's shifts, that contains everything visible. */
void wr_view_bounds(const WrCanvasView *view, double low[2], double high[2]);
/* An unrotated view that contains everything this one shows, at the same scale: its rectangle starts at 0, 0. */
WrCanvasView wr_view_flat(const WrCanvasView *view);
bool wr_view_same(const WrCanvasView *a, const WrCanvasView *b);

/* Shifts by whole cells, (dx, dy) in texels, at which a disc of `radius` texels about (x, y) also enters the cell:
 * the area that a stroke touches on the other side. (x, y) is first moved into the cell; the first entry is that
 * shift. Clamped axes have no copies. At most WR_VIEW_COPIES; returns their number. */
#define WR_VIEW_COPIES 9
typedef struct WrShift {
    double dx, dy;
} WrShift;
int wr_view_outline_copies(const WrCanvasView *view, bool wraps_u, bool wraps_v, double x, double y,
                           double radius, WrShift copies[WR_VIEW_COPIES]);

/* ---- rotation of a picture with bilinear filtering ---- */

/* Tested without a window. */

/* Fill `rect` (pixels of `to`, within it) of the picture to[to_h][to_w] from from[from_h][from_w], both ARGB, rotated
   clockwise by `degrees` about the centres of both. Bilinear interpolation keeps all colours in quarter turns. from
   must extend one pixel beyond the visible area. */
void wr_canvas_turn(const uint32_t *from, int from_w, int from_h, uint32_t *to, int to_w, int to_h,
                    double degrees, SDL_Rect rect);
/* The rectangle of the rotated picture that is affected by a rectangle of the flat one. */
SDL_Rect wr_canvas_turned_rect(SDL_Rect rect, int from_w, int from_h, int to_w, int to_h,
                               double degrees);
