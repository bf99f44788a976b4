#include "ui/app/jobs/job.h"

#include "base/array.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "system/clock.h"
#include "system/thread.h"

#include <SDL.h>
#include <stddef.h>

struct WrJob {
    WrMutex lock; /* protects the members up to the next blank line */
    WrCond wake;
    bool started, quit;
    void *next, *done;   /* owned; NULL: none */
    bool running, stale; /* stale: the running work is no longer needed */
    double fraction, asked_at;

    volatile int cancel; /* atomic; read by the work */
    const WrJobKind *kind;
    WrThread thread;
    /* Owned; pool for work without a thread, since the work may keep pointers to it. NULL: not used. */
    WrPool *in_place;
    int threads;
    Uint32 done_event;
};

WrJob *wr_job_new(const WrJobKind *kind, int threads, Uint32 done_event)
{
    WrJob *job = wr_alloc(1, sizeof *job);
    wr_mutex_init(&job->lock);
    wr_cond_init(&job->wake);
    job->kind = kind;
    job->threads = threads;
    job->done_event = done_event;
    return job;
}

/* ---- the worker thread ---- */

static void note_fraction(void *ctx, double fraction)
{
    WrJob *job = ctx;
    wr_mutex_lock(&job->lock);
    job->fraction = fraction;
    wr_mutex_unlock(&job->lock);
}

/* Run the next work item. Called with the lock held, which is released during the work. */
static void do_next(WrJob *job, WrPool *pool, const WrProgress *progress)
{
    void *work = job->next;
    job->next = NULL;
    job->running = true;
    job->stale = false;
    job->fraction = 0.0;
    __atomic_store_n(&job->cancel, 0, __ATOMIC_RELAXED);
    wr_mutex_unlock(&job->lock);
    const WrProgress *before = wr_progress_set(progress);
    job->kind->run(work, pool, progress);
    wr_progress_set(before);
    wr_mutex_lock(&job->lock);
    job->running = false;
    bool wanted = !job->stale;
    if (wanted) job->done = work;
    wr_mutex_unlock(&job->lock);
    if (!wanted) job->kind->drop(work);
    SDL_Event event = { .type = job->done_event };
    if (wanted) SDL_PushEvent(&event);
    wr_mutex_lock(&job->lock);
}

static void *thread_main(void *arg)
{
    WrJob *job = arg;
    wr_thread_step_back(); /* lower priority than the window's thread */
    WrPool *pool = wr_pool_new(job->threads);
    WrProgress progress = { .cancel = &job->cancel, .report = note_fraction, .ctx = job };
    wr_mutex_lock(&job->lock);
    while (!job->quit) {
        if (job->next) do_next(job, pool, &progress);
        else wr_cond_wait(&job->wake, &job->lock);
    }
    wr_mutex_unlock(&job->lock);
    wr_pool_free(pool);
    return NULL;
}

/* ---- on the window's thread ---- */

/* Run on the caller's thread, which waits, if no thread can be created. Called with the lock held. */
static void do_in_place(WrJob *job)
{
    WrProgress progress = { .cancel = &job->cancel };
    if (!job->in_place) job->in_place = wr_pool_new(1);
    do_next(job, job->in_place, &progress);
}

/* Replace all pending work by `work`, which may be NULL. */
static void replace(WrJob *job, void *work)
{
    wr_mutex_lock(&job->lock);
    void *waiting = job->next, *done = job->done;
    job->next = work;
    job->done = NULL;
    job->stale = job->running;
    if (job->running) __atomic_store_n(&job->cancel, 1, __ATOMIC_RELAXED);
    job->asked_at = wr_clock_seconds();
    job->fraction = 0.0;
    if (work && !job->started) job->started = wr_thread_start(&job->thread, thread_main, job);
    if (work && !job->started) do_in_place(job);
    wr_cond_wake(&job->wake);
    wr_mutex_unlock(&job->lock);
    if (waiting) job->kind->drop(waiting);
    if (done) job->kind->drop(done);
}

void wr_job_start(WrJob *job, void *work)
{
    replace(job, work);
}

void wr_job_cancel(WrJob *job)
{
    replace(job, NULL);
}

void wr_job_interrupt(WrJob *job)
{
    __atomic_store_n(&job->cancel, 1, __ATOMIC_RELAXED);
}

void *wr_job_take(WrJob *job)
{
    wr_mutex_lock(&job->lock);
    void *done = job->done;
    job->done = NULL;
    wr_mutex_unlock(&job->lock);
    return done;
}

bool wr_job_busy(WrJob *job, double *fraction, double *seconds)
{
    wr_mutex_lock(&job->lock);
    bool busy = job->next || (job->running && !job->stale);
    if (fraction) *fraction = job->fraction;
    if (seconds) *seconds = wr_clock_seconds() - job->asked_at;
    wr_mutex_unlock(&job->lock);
    return busy;
}

void wr_job_free(WrJob *job)
{
    if (!job) return;
    replace(job, NULL);
    wr_mutex_lock(&job->lock);
    job->quit = true;
    wr_cond_wake(&job->wake);
    bool started = job->started;
    wr_mutex_unlock(&job->lock);
    if (started) wr_thread_join(job->thread);
    if (job->done) job->kind->drop(job->done);
    if (job->next) job->kind->drop(job->next);
    wr_pool_free(job->in_place);
    wr_cond_fini(&job->wake);
    wr_mutex_fini(&job->lock);
    wr_free(job);
}

/* ---- start of threads ---- */

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
    int unreported = 1;
    return __atomic_compare_exchange_n(&refused, &unreported, 2, false, __ATOMIC_RELAXED,
                                       __ATOMIC_RELAXED);
}
