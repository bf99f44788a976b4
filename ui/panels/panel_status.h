/* panel_status.h - status line. */
#pragma once
#include "ui/app/state/app_state.h"

typedef struct WrMeter {     /* memory use, measured at intervals */
    double at;               /* clock */
    double tiles, undo, all; /* bytes */
} WrMeter;

void wr_panel_status(WrApp *app);
