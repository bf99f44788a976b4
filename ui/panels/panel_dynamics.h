/* panel_dynamics.h - curve editor of a preset: the effect of pressure, speed and other inputs on a setting. */
#pragma once
#include "ui/app/state/app_state.h"

#include <SDL.h>
#include <stdbool.h>

/* setting: libmypaint's number, -1 for the last one shown. Without a preset a note is shown. */
void wr_dialog_dynamics_open(WrApp *app, int setting);
void wr_dialog_dynamics(WrApp *app);
/* Handle the undo key while the editor is open: undo the last change of a curve. */
bool wr_dynamics_undo_key(WrApp *app, const SDL_KeyboardEvent *event);
/* Free app->dynamics and set it to NULL. */
void wr_dynamics_free(WrApp *app);
