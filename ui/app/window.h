/* window.h - the window of the system. */
#pragma once
#include "ui/state/app_state.h"

#include <SDL.h>
#include <stdbool.h>

bool wr_window_open(WrApp *app); /* hidden, with its renderer; false: SDL_GetError says why */
double wr_window_scale(
    SDL_Window *window); /* what the desktop, or its display, asks for, in steps of 1/4 */
/* The window with what a window manager put around it stays within what the desktop leaves free, so that the
   status line is on the screen. Known only once it is shown, and looked at until a hand has been at it. */
void wr_window_keep(WrApp *app);
void wr_window_event(WrApp *app, const SDL_Event *event);
