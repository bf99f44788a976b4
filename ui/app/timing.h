/* timing.h - how long the window's own pictures take, for WRINKLE_TIMING. */
#pragma once
#include "ui/state/app_state.h"

typedef struct WrTiming { /* of the window's own pictures */
    int pictures;
    double seconds, slowest;
} WrTiming;

/* WRINKLE_TIMING: a picture of the window took so long; and all of them, at the end. */
void wr_timing_note(WrApp *app, double seconds);
void wr_timing_tell(const WrApp *app);
