/* grid.h - a grid of equal parts of the cell over the canvas, with a ruler along its edges, which drawn things snap to. */
#pragma once
#include "ui/desk/desk.h"

#include <stdbool.h>

void wr_grid_draw(const WrApp *app);
/* A place along u (axis 0) or down the rows (1), texels: on the nearest line, where the grid is shown and one is near. */
double wr_grid_snap(const WrApp *app, int axis, double texel);
/* Texels between two lines along that axis; 0: the grid is not shown. */
double wr_grid_step(const WrApp *app, int axis);
