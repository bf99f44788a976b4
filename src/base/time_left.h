/* time_left.h - remaining time of long work, promised only while the work advances at a steady rate. */
#pragma once
#include "base/progress.h"

/* Reports of one task; zeroed before the first. A report with fewer seconds than the last begins a new task. */
typedef struct WrTimeLeft {
    double fraction[3], seconds[3]; /* two earlier reports, oldest first, and the last one */
} WrTimeLeft;

/* Formats "0:07 left" from the fraction done (0..1) and the seconds used. "" in the first second, and unless the rate of
 * the latest part agrees with the rate of the whole within a factor of 1.5: a promise that may be wrong by more than 2
 * is worse than none. */
void wr_time_left(WrTimeLeft *task, double fraction, double seconds, char text[WR_PROGRESS_LEFT]);
