/* clock.h - monotonic time. Layer 0. */
#pragma once

/* Seconds since an arbitrary start, monotonic, about 1e-8 s fine. */
double wr_clock_seconds(void);
/* Seconds that the calling thread has worked: what others do on the machine does not count. */
double wr_clock_thread_seconds(void);
double wr_clock_process_seconds(void); /* the same of all threads of the program together */
