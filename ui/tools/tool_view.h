/* tool_view.h - moving and zooming the canvas. */
#pragma once
#include "ui/state/app_state.h"

/* Turn the canvas about its middle, by as much as the pointer goes round it. */
void wr_tool_turn_drag(WrApp *app, const WrPointer *at);
void wr_tool_pan_drag(WrApp *app, const WrPointer *at);
