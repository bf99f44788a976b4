/* tool_view.h - moving and zooming the canvas. */
#pragma once
#include "ui/desk/desk.h"

void wr_tool_pan_drag(WrApp *app, const WrPointer *at);
