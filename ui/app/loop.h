/* loop.h - life cycle and main loop of a window. */
#pragma once
#include "ui/app/state/app_state.h"

#include <stdbool.h>

typedef struct WrError WrError;

/* For wr_app_run and latency.c. Call end after begin even if begin failed. */
bool wr_app_begin(WrApp *app, WrError *err);
void wr_app_step(WrApp *app); /* wait for events, handle them, draw */
void wr_app_end(WrApp *app);

/* Draw menus, panels, dialogs and overlays, between wr_gui_frame_begin and wr_gui_frame_end; `views`: canvas and
   patch too. */
void wr_app_draw_parts(WrApp *app, bool views);

/* ---- allocation of the window's state ---- */

/* State with all members zero except the registry and the pointers to each component. wr_free frees it as a whole. */
WrApp *wr_store_new(void);
