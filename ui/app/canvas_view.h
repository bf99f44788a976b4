/* canvas_view.h - canvas view: the table's picture and overlays. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/state/roster.h"

void wr_app_place_view(WrApp *app);
void wr_canvas_view_draw(WrApp *app);    /* the picture */
void wr_canvas_view_overlay(WrApp *app); /* overlays */

extern const WrPart wr_part_canvas;
