/* clock.h - monotonic time, and the calendar.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stdbool.h>
#include <stdint.h>
#include <time.h>

/* Seconds since an arbitrary start, monotonic, about 1e-8 s fine. */
double wr_clock_seconds(void);
/* Seconds that the calling thread has worked: what others do on the machine does not count. */
double wr_clock_thread_seconds(void);
double wr_clock_process_seconds(void); /* the same of all threads of the program together */

/* The date of a second since 1970, here and in Greenwich; any thread. */
bool wr_clock_local(int64_t seconds, struct tm *date);
bool wr_clock_universal(int64_t seconds, struct tm *date);
