/* loop.h - one window's life. */
#pragma once
#include "ui/state/app_state.h"

#include <stdbool.h>

typedef struct WrError WrError;

/* One window's life, for wr_app_run and latency.c. end after begin even if that failed. */
bool wr_app_begin(WrApp *app, WrError *err);
void wr_app_step(WrApp *app); /* wait for something, do it, draw */
void wr_app_end(WrApp *app);

/* What stands in a picture of the window, between wr_gui_frame_begin and wr_gui_frame_end: menus, panels, dialogs and what
   lies over the views; `views`: the table and the patch too. */
void wr_app_draw_parts(WrApp *app, bool views);
