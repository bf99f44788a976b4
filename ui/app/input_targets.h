/* input_targets.h - who gets an event of the pointer or the keys. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/state/roster.h"
#include "ui/input/pen.h"

#include <SDL.h>

void wr_hand_event(WrApp *app, const SDL_Event *event);
void wr_hand_pen(WrApp *app, const WrPenEvent *event);
/* After a picture of the window: where widgets came or went, the pointer is on a view or no more, though it did
   not move. */
void wr_hand_look(WrApp *app);

extern const WrPart wr_part_hand;
