/* panel_status.h - the line at the bottom. */
#pragma once
#include "ui/state/app_state.h"

typedef struct WrMeter {     /* memory, measured now and then */
    double at;               /* clock */
    double tiles, undo, all; /* bytes */
} WrMeter;

void wr_panel_status(WrApp *app);
