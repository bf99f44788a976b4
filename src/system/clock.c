#include "system/clock.h"

#include <time.h>

static double read(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double wr_clock_seconds(void)
{
    return read(CLOCK_MONOTONIC);
}

double wr_clock_process_seconds(void)
{
    return read(CLOCK_PROCESS_CPUTIME_ID);
}

double wr_clock_thread_seconds(void)
{
    return read(CLOCK_THREAD_CPUTIME_ID);
}

bool wr_clock_local(int64_t seconds, struct tm *date)
{
    const time_t when = (time_t)seconds;
    return localtime_r(&when, date) != NULL;
}

bool wr_clock_universal(int64_t seconds, struct tm *date)
{
    const time_t when = (time_t)seconds;
    return gmtime_r(&when, date) != NULL;
}
