/* layer_points.h - canvas handles for the points of a layer whose line is a shape or a ramp. */
#pragma once
#include "ui/app/state/app_state.h"

#include <stdbool.h>

bool wr_layer_points_press(WrApp *app, const WrPointer *at); /* true if the press is on a point */
void wr_layer_points_drag(WrApp *app, const WrPointer *at);  /* previews the change */
void wr_layer_points_release(WrApp *app, const WrPointer *at);
void wr_layer_points_cancel(WrApp *app);
void wr_layer_points_marks(const WrApp *app); /* draw the handles on the canvas */
