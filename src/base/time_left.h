/* time_left.h - remaining time of long work, promised only while the work advances at a steady rate. */
#pragma once

/* Reports of one task; zeroed before the first. A report with fewer seconds than the last begins a new task. */
typedef struct WrTimeLeft {
    double fraction[2], seconds[2]; /* two earlier reports, the older one first */
    double last;                    /* seconds of the last report */
} WrTimeLeft;

/* Seconds left, from the fraction done (0..1) and the seconds used, both of the whole task. NAN in the first second, and
 * unless the rate of the latest part agrees with the rate of the whole within a factor of 1.5: a promise that may be
 * wrong by more than 2 is worse than none. */
double wr_time_left(WrTimeLeft *task, double fraction, double seconds);
