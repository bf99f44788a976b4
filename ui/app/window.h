/* window.h - system window: creation, scale and position. */
#pragma once
#include "ui/app/state/app_state.h"

#include <SDL.h>
#include <stdbool.h>

/* hidden, with its renderer; false: the cause is in SDL_GetError */
bool wr_window_open(WrApp *app);
/* Keep the window with its decoration inside the desktop's usable area, so that the status line is visible. The
   decoration is known only after the window is shown; checked until the first user input. */
void wr_window_event(WrApp *app, const SDL_Event *event);
