/* view.h - where the table stands on the canvas: texels to pixels and back, zooming, panning, and the
   copies of the brush's outline. Pure geometry; tested without a window.

   Pixel positions are relative to the window; texel positions run right and DOWN from the top left
   corner of the real cell and are not wrapped: the copy to the right of the cell starts at x = W. */
#pragma once
#include <stdbool.h>

typedef struct WrCanvasView {
    int x, y, w, h;            /* the canvas's rectangle in the window, pixels; w, h >= 1 */
    int table_w, table_h;      /* texels */
    double zoom;               /* pixels a texel; see wr_view_zoom_range */
    double centre_x, centre_y; /* texel position in the middle of the canvas */
    bool mirrored;             /* the table runs to the left: seen so, what is lopsided shows */
} WrCanvasView;

/* Zoom 1 is 100 %. From 1/128, or where the longer side is 64 pixels if that is less zoomed out, up to
   128 pixels a texel. */
void wr_view_zoom_range(const WrCanvasView *view, double *low, double *high);
/* Show the whole cell with `margin` (0..1) of the canvas free around it. */
void wr_view_fit(WrCanvasView *view, double margin);
/* Zoom to `zoom` (clamped) so that the texel under the pixel (px, py) stays there. */
void wr_view_zoom_at(WrCanvasView *view, double px, double py, double zoom);
/* Move the picture by dx, dy pixels. The centre stays within the cell by whole periods on tiled axes:
   what is seen is the same, and positions never grow. */
void wr_view_pan(WrCanvasView *view, double dx, double dy);
void wr_view_keep_near(WrCanvasView *view);

void wr_view_to_texel(const WrCanvasView *view, double px, double py, double *x, double *y);
void wr_view_to_pixel(const WrCanvasView *view, double x, double y, double *px, double *py);
/* u = x/W, v = 1 - y/H: unwrapped parameters under a pixel. */
void wr_view_to_uv(const WrCanvasView *view, double px, double py, double *u, double *v);

/* Pixels to the right for a texel to the right: below 0 where the table is mirrored. */
double wr_view_across(const WrCanvasView *view);

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
