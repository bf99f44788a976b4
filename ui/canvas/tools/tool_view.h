/* tool_view.h - tools for panning and zooming the canvas. */
#pragma once
#include "ui/app/state/app_state.h"

/* Rotate the canvas about its centre by the angle of the pointer's motion around it. */
void wr_tool_turn_drag(WrApp *app, const WrPointer *at);
void wr_tool_pan_drag(WrApp *app, const WrPointer *at);
