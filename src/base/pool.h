/* pool.h - a blocking thread pool for jobs that are cut into pieces.

   Waiting threads sleep: an idle program uses no processor time. */
#pragma once
#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrPool WrPool;

/* threads 0 means one per processor. The caller of run is one of them, so a pool of 1 starts none.
   Never fails; if a thread cannot be started the pool is smaller. */
WrPool *wr_pool_new(int threads);
void wr_pool_free(WrPool *pool);         /* NULL is allowed; no run may be active */
int wr_pool_threads(const WrPool *pool); /* number of workers, including the caller; 1 for NULL */

/* Calls piece(index, worker, ctx) once for each index in 0..count-1, on any thread and in any order,
   and returns when all are done. worker is 0..threads-1 and never used twice at a time: index scratch
   memory by it. If pool is NULL, all pieces run on the caller's thread. One run at a time; a second
   caller waits. A piece must not call wr_pool_run on the same pool. If the caller's thread progress
   (progress.h) is cancelled, pieces that have not begun are skipped and the function returns false.
   Pieces inherit that progress, but only the caller's thread may report. */
typedef void (*WrPiece)(int index, int worker, void *ctx);
bool wr_pool_run(WrPool *pool, int count, WrPiece piece, void *ctx);
/* wr_pool_run that also reports the fraction of started pieces to the caller's progress. */
bool wr_pool_run_with_progress(WrPool *pool, int count, WrPiece piece, void *ctx);

/* Number of pieces that this process has started, for tests that count work. */
int64_t wr_pool_pieces(void);

/* ---- one-time work on a helper thread ---- */

/* One-time initialisation on a helper thread; waiters can be cancelled.

   For work that cannot be interrupted, such as loading libraries (base/progress.h). */

/* One initialisation of the process; a static variable each. Set `work` and `ctx`; `why` may be read while no other
 * thread uses it; the others are private. */
typedef struct WrOnceAsync {
    bool (*work)(void *ctx, WrError *err);
    void *ctx;
    bool busy, done;
    WrError why; /* error of the last failed attempt; "": none failed */
} WrOnceAsync;

/* Waits until the work is done; the first caller starts it. A failure is not cached: the next call
 * retries. A cancelled caller returns at once; the work continues and serves the next call. A caller
 * that cannot be cancelled runs the work on its own thread.
 *
 * Errors   those of the work, or "cancelled"
 * Threads  any; results of the work are visible after this returned true */
bool wr_once_async_wait(WrOnceAsync *once, WrError *err);

/* True if the work has succeeded; does not wait. Any thread. */
bool wr_once_async_done(const WrOnceAsync *once);

/* Starts the work in advance, unless it is running or done, and returns at once. */
void wr_once_async_begin(WrOnceAsync *once);

/* Lets the process exit without waiting for running work; exit handlers that were registered before
 * this call (it may be called several times) are then skipped. wr_once_async_wait and wr_once_async_begin call it. */
void wr_once_async_watch_end(void);
