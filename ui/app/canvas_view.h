/* canvas_view.h - the canvas' view: the picture and what lies on it. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/state/roster.h"

void wr_app_place_view(WrApp *app);
void wr_canvas_view_draw(WrApp *app);    /* the picture */
void wr_canvas_view_overlay(WrApp *app); /* what lies on it */

extern const WrPart wr_part_canvas;
