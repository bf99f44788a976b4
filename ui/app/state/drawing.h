/* drawing.h - vector drawings (SVG) that become layers: dropped on the window, or pasted. */
#pragma once
#include "ui/app/state/app_state.h"

/* Add a generator layer of an SVG file; or, with path NULL, of path data. Its longer side is three quarters of the shorter
   side of the selection or the table; it lies in the middle of the selection, or of the visible canvas. name: the layer's;
   NULL: the file's name. */
void wr_app_add_drawing(WrApp *app, const char *path, const char *data, const char *name);
