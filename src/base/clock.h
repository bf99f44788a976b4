/* clock.h - monotonic time. Layer 0. */
#pragma once

/* Seconds since an arbitrary start, monotonic, about 1e-8 s fine. */
double wr_clock_seconds(void);
