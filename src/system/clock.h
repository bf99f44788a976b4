/* clock.h - monotonic time, processor time and calendar dates.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stdbool.h>
#include <stdint.h>
#include <time.h>

/* Seconds since an arbitrary start, monotonic, resolution about 1e-8 s. */
double wr_clock_seconds(void);
/* Processor seconds of the calling thread; other load on the machine does not count. */
double wr_clock_thread_seconds(void);
double wr_clock_process_seconds(void); /* processor seconds of all threads of the program */

/* Converts seconds since 1970 to a date in local time and in UTC; any thread. */
bool wr_clock_local(int64_t seconds, struct tm *date);
bool wr_clock_universal(int64_t seconds, struct tm *date);
