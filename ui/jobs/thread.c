#include "ui/jobs/thread.h"

#include "system/thread.h"

#include <stddef.h>

static int refused; /* atomic; 1: not yet reported, 2: reported */

bool wr_thread_start(WrThread *thread, void *(*run)(void *), void *arg)
{
    if (wr_thread_begin(thread, run, arg)) return true;
    int none = 0;
    __atomic_compare_exchange_n(&refused, &none, 1, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED);
    return false;
}

bool wr_thread_refused(void)
{
    int untold = 1;
    return __atomic_compare_exchange_n(&refused, &untold, 2, false, __ATOMIC_RELAXED,
                                       __ATOMIC_RELAXED);
}
