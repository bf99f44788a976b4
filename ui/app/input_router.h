/* input_router.h - routing of pointer and key events to widgets, views and drags. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/registry.h"
#include "ui/input/pen.h"

#include <SDL.h>

void wr_input_router_event(WrApp *app, const SDL_Event *event);
void wr_input_router_pen(WrApp *app, const WrPenEvent *event);
/* Update the view under the pointer after a frame, since widgets may have appeared or vanished without a pointer
   motion. */
void wr_input_router_update_hover(WrApp *app);

/* The divider at a position: WR_GRAB_DIVIDER, WR_GRAB_PANELS, WR_GRAB_SIDE, or WR_GRAB_NONE. */
WrGrab wr_divider_under(const WrApp *app, const WrPointer *at);

extern const WrPart wr_part_hand;
