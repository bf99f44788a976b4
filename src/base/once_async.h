/* once_async.h - work that nothing can tell to stop, such as the loading of libraries: a thread of its own does it, and
   who waits for it can be told to stop (base/progress.h).
   Layer 0. */
#pragma once
#include "base/error.h"

#include <stdbool.h>

/* What is done once for the whole process; one static variable each. All but `work` and `ctx` is private. */
typedef struct WrOnceAsync {
    bool (*work)(void *ctx, WrError *err);
    void *ctx;
    bool busy, done;
    WrError why; /* it failed, the last time */
} WrOnceAsync;

/* Wait until the work is done; whoever comes first begins it. A failure is not kept: the next call tries again. Who
 * is cancelled meanwhile does not wait: the work goes on by itself, and serves the next call. Who cannot be cancelled
 * does it on his own thread.
 *
 * Errors   the work's own, or "cancelled"
 * Threads  any; what the work wrote can be read where this returned true */
bool wr_once_async_wait(WrOnceAsync *aside, WrError *err);

/* Begin ahead of need, if nobody has, and return at once. */
void wr_once_async_begin(WrOnceAsync *aside);

/* The end of the program does not wait for work that is still under way; handlers of its end that were registered
 * before this call (any number of times) are then left out. The two above call it. */
void wr_once_async_watch_end(void);
