/* panel_dynamics.h - the dialog in which the curves of a preset are drawn: what pressure, speed and other inputs add to a
   setting. */
#pragma once
#include "ui/state/app_state.h"

#include <SDL.h>
#include <stdbool.h>

/* setting: the library's number, -1 the one that was looked at last. Without a preset it is said that there are none. */
void wr_dialog_dynamics_open(WrApp *app, int setting);
void wr_dialog_dynamics(WrApp *app);
/* While it is open the key of undo takes the last change of a curve back. */
bool wr_dynamics_take_key(WrApp *app, const SDL_KeyboardEvent *event);
/* app->dynamics, which becomes NULL. */
void wr_dynamics_free(WrApp *app);
