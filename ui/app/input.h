/* input.h - queue of input events in order of arrival. An event that may move the keyboard focus (a click on a
   widget, Enter in a text field, a key of an action) holds back all later events until a frame shows its effect, so
   keys never overtake clicks, however slow frames are. A press belongs to the widget that was on the screen at that
   time; if another one is there now, the press is dropped. */
#pragma once
#include "ui/app/state/app_state.h"

#include <SDL.h>
#include <stdbool.h>

typedef struct WrInput WrInput;

WrInput *wr_input_new(void);
void wr_input_free(WrInput *input); /* NULL is allowed */

/* Move all events of SDL's queue to the end of this one. Also called before a frame is shown, since events up to then
   belong to the previous frame. */
void wr_input_collect(WrApp *app);
/* The next event to handle. False: there is none, or it must wait for a frame. Sets mods, x and y of app->hand to the
   state at that event, since SDL's own state is newer. */
bool wr_input_next(WrApp *app, SDL_Event *event);
/* Report that the event was handled. */
void wr_input_handled(WrApp *app, const SDL_Event *event);
/* Report that a frame was shown. */
void wr_input_shown(WrApp *app);
/* True if there are unhandled events. */
bool wr_input_waits(const WrApp *app);
