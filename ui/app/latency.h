/* latency.h - frame times of the window for WRINKLE_TIMING. */
#pragma once
#include "ui/app/state/app_state.h"

typedef struct WrTiming { /* frame times */
    int pictures;
    double seconds, slowest;
} WrTiming;

/* Record the time of a frame; print the summary at the end. */
void wr_timing_note(WrApp *app, double seconds);
void wr_timing_report(const WrApp *app);
