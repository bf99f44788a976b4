/* once_async.h - one-time initialisation on a helper thread; waiters can be cancelled.

   For work that cannot be interrupted, such as loading libraries (base/progress.h). */
#pragma once
#include "base/error.h"

#include <stdbool.h>

/* One initialisation of the process; a static variable each. All members but `work` and `ctx` are
 * private. */
typedef struct WrOnceAsync {
    bool (*work)(void *ctx, WrError *err);
    void *ctx;
    bool busy, done;
    WrError why; /* error of the last failed attempt */
} WrOnceAsync;

/* Waits until the work is done; the first caller starts it. A failure is not cached: the next call
 * retries. A cancelled caller returns at once; the work continues and serves the next call. A caller
 * that cannot be cancelled runs the work on its own thread.
 *
 * Errors   those of the work, or "cancelled"
 * Threads  any; results of the work are visible after this returned true */
bool wr_once_async_wait(WrOnceAsync *once, WrError *err);

/* Starts the work in advance, unless it is running or done, and returns at once. */
void wr_once_async_begin(WrOnceAsync *once);

/* Lets the process exit without waiting for running work; exit handlers that were registered before
 * this call (it may be called several times) are then skipped. The two functions above call it. */
void wr_once_async_watch_end(void);
