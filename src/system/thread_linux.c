/* Threads: the functions that Linux and its C library add to POSIX. */
#include "system/thread.h"

#include <sched.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#define NICENESS 5 /* below the priority of interactive threads */

void wr_cond_wait_ms(WrCond *cond, WrMutex *mutex, int ms)
{
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_sec += ms / 1000;
    until.tv_nsec += ms % 1000 * 1000000L;
    until.tv_sec += until.tv_nsec / 1000000000L;
    until.tv_nsec %= 1000000000L;
    pthread_cond_clockwait(&cond->it, &mutex->it, CLOCK_MONOTONIC, &until);
}

void wr_thread_step_back(void)
{
    /* on Linux this applies to the thread and its children */
    setpriority(PRIO_PROCESS, 0, NICENESS);
}

bool wr_thread_pin(WrPin *pin)
{
    cpu_set_t one, before;
    _Static_assert(sizeof before <= sizeof pin->before, "a set of processors fits");
    pin->held = false;
    if (sched_getaffinity(0, sizeof before, &before) != 0) return false;
    const int here = sched_getcpu();
    if (here < 0) return false;
    CPU_ZERO(&one);
    CPU_SET(here, &one);
    memcpy(pin->before, &before, sizeof before);
    pin->held = sched_setaffinity(0, sizeof one, &one) == 0;
    return pin->held;
}

void wr_thread_unpin(const WrPin *pin)
{
    cpu_set_t before;
    memcpy(&before, pin->before, sizeof before);
    if (pin->held) sched_setaffinity(0, sizeof before, &before);
}
