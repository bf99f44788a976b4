/* job.h - background worker for one piece of work at a time: newer work replaces the running one. Independent of the
   kind of work. All calls are from the window's thread. */
#pragma once
#include "system/thread.h"

#include <SDL.h>
#include <stdbool.h>

/* Start a thread; false, and recorded, if the system refuses one. */
bool wr_thread_start(WrThread *thread, void *(*run)(void *), void *arg);
/* True once after the system has refused a thread, for a single message. */
bool wr_thread_refused(void);

/* ---- job ---- */

typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;

typedef struct WrJob WrJob;

typedef struct WrJobKind {
    /* Do the work on the job's thread; store results in `work`. progress can be cancelled; it is also the thread's
       own. */
    void (*run)(void *work, WrPool *pool, const WrProgress *progress);
    void (*drop)(void *work); /* free the work; on either thread */
} WrJobKind;

/* threads: as in wr_pool_new. done_event: an SDL event type, pushed when a piece is done. The thread starts with the
 * first piece. kind must outlive the job. */
WrJob *wr_job_new(const WrJobKind *kind, int threads, Uint32 done_event);
/* Cancels the work and waits. NULL is allowed. */
void wr_job_free(WrJob *job);

/* Start `work` (ownership passes). Waiting work is dropped; running work is cancelled and dropped when it ends;
 * finished work that was not fetched is dropped. If no thread can be created, the work is done within the call. */
void wr_job_start(WrJob *job, void *work);
/* Drop all work without starting another. */
void wr_job_cancel(WrJob *job);
/* Cancel the running work, but return it in its state at that time. */
void wr_job_interrupt(WrJob *job);
/* The finished work, owned by the caller; NULL if there is none. */
void *wr_job_take(WrJob *job);
/* True if work is pending. fraction 0..1, and seconds since its start; either may be NULL. */
bool wr_job_busy(WrJob *job, double *fraction, double *seconds);
