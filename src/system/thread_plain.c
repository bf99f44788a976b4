/* Threads: fallback for any POSIX system. Missing here: waits on a monotonic clock (setting the wall
   clock back makes a wait longer), thread priorities, pinned threads. */
#include "system/thread.h"

#include <time.h>

void wr_cond_wait_ms(WrCond *cond, WrMutex *mutex, int ms)
{
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_sec += ms / 1000;
    until.tv_nsec += ms % 1000 * 1000000L;
    until.tv_sec += until.tv_nsec / 1000000000L;
    until.tv_nsec %= 1000000000L;
    pthread_cond_timedwait(&cond->it, &mutex->it, &until);
}

void wr_thread_step_back(void)
{
}

bool wr_thread_pin(WrPin *pin)
{
    pin->held = false;
    return false;
}

void wr_thread_unpin(const WrPin *pin)
{
    (void)pin;
}
