/* job.h - work in the background, one piece at a time: a newer piece takes the place of the one under way.
   Knows nothing of what the work is. All calls come from the window's thread. */
#pragma once
#include <SDL.h>
#include <stdbool.h>

typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;

typedef struct WrJob WrJob;

typedef struct WrJobKind {
    /* Do it, on the job's own thread; results go into `work`. progress can be cancelled; it is the thread's
       own too. */
    void (*run)(void *work, WrPool *pool, const WrProgress *progress);
    void (*drop)(void *work); /* free it; on either thread */
} WrJobKind;

/* threads: as in wr_pool_new. done_event: an SDL event type, pushed when a piece is done. The thread
 * starts with the first piece. kind must outlive the job. */
WrJob *wr_job_new(const WrJobKind *kind, int threads, Uint32 done_event);
/* Cancels and waits. NULL is fine. */
void wr_job_free(WrJob *job);

/* Do this next; takes `work`. What waits is dropped; what runs is cancelled and dropped when it ends; what
 * is done and was not taken is dropped. Where the system gives no thread the work is done in the call. */
void wr_job_start(WrJob *job, void *work);
/* The same without anything to do next. */
void wr_job_cancel(WrJob *job);
/* Tell what runs to stop, but hand it over as it then is. */
void wr_job_interrupt(WrJob *job);
/* What is done, the caller's; NULL if nothing new is. */
void *wr_job_take(WrJob *job);
/* Is something wanted that is not done? fraction 0..1, and seconds since it was asked for; either may be
 * NULL. */
bool wr_job_busy(WrJob *job, double *fraction, double *seconds);
