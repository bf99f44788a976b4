#include "base/once_async.h"

#include "base/progress.h"
#include "system/process.h"
#include "system/thread.h"

#include <stdio.h>
#include <stdlib.h>

#define CHECK_MS 20 /* interval between cancellation checks of a waiting thread */

/* State of the process: number of initialisations that are running. */
static WrMutex lock = WR_MUTEX_READY;
static WrCond changed = WR_COND_READY;
static int under_way;

/* A library that is being loaded holds a lock that the process exit waits for. */
static void leave_at_once(int status)
{
    wr_mutex_lock(&lock);
    bool busy = under_way > 0;
    wr_mutex_unlock(&lock);
    if (!busy) return;
    fflush(NULL);
    wr_process_leave(status);
}

void wr_once_async_watch_end(void)
{
    static bool watching;
    wr_mutex_lock(&lock);
    if (!watching) watching = wr_process_at_end(leave_at_once);
    wr_mutex_unlock(&lock);
}

/* Called with the lock held; releases it during the work. */
static void work_here(WrOnceAsync *once)
{
    WrError why = { "" };
    wr_mutex_unlock(&lock);
    bool good = once->work(once->ctx, &why);
    wr_mutex_lock(&lock);
    once->why = why;
    once->done = good;
    once->busy = false;
    under_way--;
    wr_cond_wake_all(&changed);
}

static void *thread_main(void *once)
{
    wr_mutex_lock(&lock);
    work_here(once);
    wr_mutex_unlock(&lock);
    return NULL;
}

/* Called with the lock held. Signals are handled by the existing threads only. here: run on this
 * thread, which is also the fallback if no thread can be started. */
static void begin(WrOnceAsync *once, bool here)
{
    if (once->done || once->busy) return;
    once->busy = true;
    under_way++;
    if (here || !wr_thread_begin_detached(thread_main, once)) work_here(once);
}

void wr_once_async_begin(WrOnceAsync *once)
{
    wr_once_async_watch_end();
    wr_mutex_lock(&lock);
    begin(once, false);
    wr_mutex_unlock(&lock);
}

bool wr_once_async_wait(WrOnceAsync *once, WrError *err)
{
    bool stopped = false;
    wr_once_async_watch_end();
    wr_mutex_lock(&lock);
    begin(once, wr_progress_here() == NULL);
    while (once->busy && !(stopped = wr_progress_stopped()))
        wr_cond_wait_ms(&changed, &lock, CHECK_MS);
    bool done = once->done;
    if (!done) wr_fail(err, "%s", stopped ? "cancelled" : wr_error_message(&once->why));
    wr_mutex_unlock(&lock);
    return done;
}
