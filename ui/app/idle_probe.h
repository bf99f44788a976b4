/* idle_probe.h - idle notifications for tests, so that these need not wait for fixed times. WRINKLE_REST names a
   FIFO; each byte in it is a request. The answer is a line "at rest N" on standard error, N counting from 1, when
   every event that the X server had at the request is handled and no computation or drawing is left. While a row that
   the search has found is framed, " row X Y WIDTH HEIGHT" follows, in pixels. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"

#include <SDL.h>
#include <stdbool.h>

/* NULL without WRINKLE_REST. ask_event: a separate SDL event type. */
WrIdleProbe *wr_idle_probe_new(Uint32 ask_event);
void wr_idle_probe_free(WrIdleProbe *rest);
/* Handle the request event. */
void wr_idle_probe_requested(WrApp *app);
/* Called at the end of each step. busy: work is running that the main loop's timers do not include. */
void wr_idle_probe_step(WrApp *app, bool busy);

/* ---- release of cached memory after an idle period ---- */

extern const WrPart wr_part_thrift;
