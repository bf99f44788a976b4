/* overlay_marks.h - lines and marks on the canvas, on every copy of the cell. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/toolkit/theme.h"

#include "field/select.h"

#include <stdbool.h>

/* points: u, v, unwrapped. Drawn dark under light, to be visible on any background. */
void wr_overlay_lines(const WrApp *app, const WrSelectPoint *points, int count, bool closed,
                      WrColour colour);
/* A cross, a small square or a disc at u, v (unwrapped), on all copies. */
void wr_overlay_cross(const WrApp *app, double u, double v, WrColour colour);
void wr_overlay_handle(const WrApp *app, double u, double v, bool round, bool hot);
/* u, v (unwrapped) of a position in texels, y downwards. */
WrSelectPoint wr_overlay_uv(const WrApp *app, double x, double y);
/* Whole cells to add to u, v to move it into the cell (on periodic axes). */
WrSelectPoint wr_overlay_home(const WrApp *app, double u, double v);
void wr_overlay_label(double x, double y, const char *text); /* centred at a pixel */
