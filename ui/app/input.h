/* input.h - the queue of input events, in the order in which they came.
   An event that may move the keyboard focus (a click on a widget, Enter in a text, a key that runs an action) holds all
   later events back until a picture of the window shows its effect. So keys never overtake clicks, however slow pictures
   are. A press counts for the widget that was on the screen when the press came: if another one has taken that place
   since, the press is dropped. */
#pragma once
#include "ui/state/app_state.h"

#include <SDL.h>
#include <stdbool.h>

typedef struct WrInput WrInput;

WrInput *wr_input_new(void);
void wr_input_free(WrInput *input); /* NULL is allowed */

/* Moves all events of SDL's queue to the end of this one. Called before a picture is shown, too: what came until then
   belongs to the picture before it. */
void wr_input_take(WrApp *app);
/* The next event whose turn it is. False: there is none, or it must wait for a picture. Sets mods, x and y of app->hand to
   the state at that event: SDL's own state is newer. */
bool wr_input_next(WrApp *app, SDL_Event *event);
/* That event was handled. */
void wr_input_handled(WrApp *app, const SDL_Event *event);
/* A picture was shown. */
void wr_input_shown(WrApp *app);
/* Events that have not been handled. */
bool wr_input_waits(const WrApp *app);
