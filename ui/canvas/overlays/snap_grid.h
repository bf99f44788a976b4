/* snap_grid.h - snapping grid over the canvas, with equal parts of the cell and a ruler along its edges. */
#pragma once
#include "ui/canvas/view.h"
#include "ui/app/state/app_state.h"
#include "ui/toolkit/theme.h"

#include <stdbool.h>

/* Draw a line across the whole view: vertical at that texel (axis 0), or horizontal. low, high: wr_view_bounds. */
void wr_grid_line(const WrCanvasView *view, int axis, double texel, const double low[2],
                  const double high[2], WrColour colour);
void wr_grid_draw(const WrApp *app);
/* Snap a position along u (axis 0) or down the rows (1), in texels, to the nearest line, if the grid is visible and a
   line is near. */
double wr_grid_snap(const WrApp *app, int axis, double texel);
/* Distance of two lines along that axis in texels; 0: the grid is hidden. */
double wr_grid_step(const WrApp *app, int axis);
