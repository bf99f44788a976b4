/* panel_status.h - the line at the bottom. */
#pragma once
#include "ui/desk/desk.h"

typedef struct WrMeter {     /* memory, measured now and then */
    double at;               /* clock */
    double tiles, undo, all; /* bytes */
} WrMeter;

void wr_panel_status(WrApp *app);
