/* idle_probe.h - tells a test when the window is at rest, so that none has to guess how long that takes.
   Where WRINKLE_REST names a FIFO, each byte in it is a question; the answer is a line "at rest N" on standard
   error, N counting from 1, once every event that the X server had at the question is dealt with and nothing
   is left to compute or to draw. */
#pragma once
#include "ui/state/app_state.h"

#include <SDL.h>
#include <stdbool.h>

/* NULL where nobody asks. ask_event: an SDL event type of one's own. */
WrIdleProbe *wr_idle_probe_new(Uint32 ask_event);
void wr_idle_probe_free(WrIdleProbe *rest);
/* The event came. */
void wr_idle_probe_asked(WrApp *app);
/* At the end of each step. busy: something is under way that the window's own clock does not know. */
void wr_idle_probe_step(WrApp *app, bool busy);
