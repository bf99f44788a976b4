#include "base/pool.h"

#include "base/memory.h"
#include "base/progress.h"
#include "system/process.h"
#include "system/thread.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct Worker {
    WrPool *pool;
    int id;
    WrThread thread;
} Worker;

/* Pieces are distributed by an atomic counter: fast threads take more. Every worker enters each run, if only to find the
   counter past the end, so `active` reaching 0 means that no thread holds the run's ctx any more. Pieces must write to
   disjoint memory; results then do not depend on the number of threads. */
struct WrPool {
    WrMutex run_lock; /* one run at a time */
    WrMutex lock;     /* guards the members below */
    WrCond wake, done;
    unsigned generation; /* number of the current run */
    int active;          /* workers inside the current run */
    bool quit;
    int next; /* next piece; atomic */
    int count;
    WrPiece piece;
    void *ctx;
    bool reports;     /* the caller's progress is reported after each of its pieces */
    WrProgress quiet; /* the caller's progress for other threads: cancellation without reports */
    int threads;      /* including the caller */
    Worker *workers;
};

static int64_t begun; /* atomic */

int64_t wr_pool_pieces(void)
{
    return __atomic_load_n(&begun, __ATOMIC_RELAXED);
}

/* False: the work was cancelled. */
static bool run_piece(int index, int count, int worker, bool reports, WrPiece piece, void *ctx)
{
    if (reports && worker == 0) wr_progress_report((double)index / count);
    if (wr_progress_stopped()) return false;
    __atomic_fetch_add(&begun, 1, __ATOMIC_RELAXED);
    piece(index, worker, ctx);
    return true;
}

static void take_pieces(WrPool *pool, int worker)
{
    for (;;) {
        int index = __atomic_fetch_add(&pool->next, 1, __ATOMIC_RELAXED);
        if (index >= pool->count) return;
        if (!run_piece(index, pool->count, worker, pool->reports, pool->piece, pool->ctx)) return;
    }
}

static void *worker_main(void *arg)
{
    Worker *self = arg;
    WrPool *pool = self->pool;
    unsigned seen = 0;
    wr_mutex_lock(&pool->lock);
    for (;;) {
        while (pool->generation == seen && !pool->quit) wr_cond_wait(&pool->wake, &pool->lock);
        if (pool->quit) break;
        seen = pool->generation;
        wr_mutex_unlock(&pool->lock);
        wr_progress_set(&pool->quiet);
        take_pieces(pool, self->id);
        wr_progress_set(NULL);
        wr_mutex_lock(&pool->lock);
        if (--pool->active == 0) wr_cond_wake(&pool->done);
    }
    wr_mutex_unlock(&pool->lock);
    return NULL;
}

WrPool *wr_pool_new(int threads)
{
    if (threads <= 0) threads = wr_thread_processors();
    if (threads > 256) threads = 256;
    WrPool *pool = wr_alloc(1, sizeof *pool);
    wr_mutex_init(&pool->run_lock);
    wr_mutex_init(&pool->lock);
    wr_cond_init(&pool->wake);
    wr_cond_init(&pool->done);
    pool->workers = wr_alloc((size_t)threads, sizeof *pool->workers);
    pool->threads = 1;
    for (int i = 1; i < threads; i++) {
        Worker *worker = &pool->workers[i];
        *worker = (Worker){ .pool = pool, .id = i };
        if (!wr_thread_begin(&worker->thread, worker_main, worker)) break;
        pool->threads++;
    }
    return pool;
}

void wr_pool_free(WrPool *pool)
{
    if (!pool) return;
    wr_mutex_lock(&pool->lock);
    pool->quit = true;
    wr_cond_wake_all(&pool->wake);
    wr_mutex_unlock(&pool->lock);
    for (int i = 1; i < pool->threads; i++) wr_thread_join(pool->workers[i].thread);
    wr_cond_fini(&pool->done);
    wr_cond_fini(&pool->wake);
    wr_mutex_fini(&pool->lock);
    wr_mutex_fini(&pool->run_lock);
    wr_free(pool->workers);
    wr_free(pool);
}

int wr_pool_threads(const WrPool *pool)
{
    return pool ? pool->threads : 1;
}

/* Runs all pieces on this thread. A pool of one thread still serialises runs: scratch memory is indexed
 * by worker. */
static void run_here(WrPool *pool, int count, WrPiece piece, void *ctx, bool reports)
{
    if (pool) wr_mutex_lock(&pool->run_lock);
    for (int i = 0; i < count && run_piece(i, count, 0, reports, piece, ctx); i++) {
    }
    if (pool) wr_mutex_unlock(&pool->run_lock);
}

static void run_on_all(WrPool *pool, int count, WrPiece piece, void *ctx, bool reports)
{
    const WrProgress *here = wr_progress_here();
    wr_mutex_lock(&pool->run_lock);
    wr_mutex_lock(&pool->lock);
    pool->piece = piece;
    pool->ctx = ctx;
    pool->count = count;
    pool->reports = reports;
    pool->quiet = (WrProgress){ .cancel = here ? here->cancel : NULL };
    __atomic_store_n(&pool->next, 0, __ATOMIC_RELAXED);
    /* Members are written under the lock before the generation changes; workers read them after they have taken the lock and
       seen it, so the relaxed counter needs no further ordering. */
    pool->active = pool->threads - 1;
    pool->generation++;
    wr_cond_wake_all(&pool->wake);
    wr_mutex_unlock(&pool->lock);
    take_pieces(pool, 0);
    wr_mutex_lock(&pool->lock);
    while (pool->active > 0) wr_cond_wait(&pool->done, &pool->lock);
    wr_mutex_unlock(&pool->lock);
    wr_mutex_unlock(&pool->run_lock);
}

static bool run(WrPool *pool, int count, WrPiece piece, void *ctx, bool reports)
{
    if (reports) wr_progress_report(0.0); /* whichever thread starts the first piece */
    if (count <= 0) return !wr_progress_stopped();
    if (!pool || pool->threads == 1 || count == 1) run_here(pool, count, piece, ctx, reports);
    else run_on_all(pool, count, piece, ctx, reports);
    return !wr_progress_stopped();
}

bool wr_pool_run(WrPool *pool, int count, WrPiece piece, void *ctx)
{
    return run(pool, count, piece, ctx, false);
}

bool wr_pool_run_with_progress(WrPool *pool, int count, WrPiece piece, void *ctx)
{
    return run(pool, count, piece, ctx, true);
}

/* ---- one-time work on a helper thread ---- */

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

bool wr_once_async_done(const WrOnceAsync *once)
{
    wr_mutex_lock(&lock);
    const bool done = once->done;
    wr_mutex_unlock(&lock);
    return done;
}

bool wr_once_async_wait(WrOnceAsync *once, WrError *err)
{
    bool stopped = false;
    wr_once_async_watch_end();
    wr_mutex_lock(&lock);
    begin(once, wr_progress_here() == NULL);
    /* Waiting with a timeout: a cancellation does not signal the condition. */
    while (once->busy && !(stopped = wr_progress_stopped()))
        wr_cond_wait_ms(&changed, &lock, CHECK_MS);
    bool done = once->done;
    if (!done) wr_fail(err, "%s", stopped ? "cancelled" : wr_error_message(&once->why));
    wr_mutex_unlock(&lock);
    return done;
}
