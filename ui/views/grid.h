/* grid.h - a grid of equal parts of the cell over the canvas, with a ruler along its edges, which drawn things snap to. */
#pragma once
#include "ui/canvas/view.h"
#include "ui/state/app_state.h"
#include "ui/toolkit/theme.h"

#include <stdbool.h>

/* A line across all that is seen: upright at that texel (axis 0), or level. low, high: wr_view_bounds. */
void wr_grid_line(const WrCanvasView *view, int axis, double texel, const double low[2],
                  const double high[2], WrColour colour);
void wr_grid_draw(const WrApp *app);
/* A place along u (axis 0) or down the rows (1), texels: on the nearest line, where the grid is shown and one is near. */
double wr_grid_snap(const WrApp *app, int axis, double texel);
/* Texels between two lines along that axis; 0: the grid is not shown. */
double wr_grid_step(const WrApp *app, int axis);
