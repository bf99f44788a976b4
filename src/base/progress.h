/* progress.h - progress reports and cancellation of long work. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Owned by the caller; any member, and the pointer to the struct itself, may be NULL. */
typedef struct WrProgress {
    /* The work stops soon after this becomes nonzero. Any thread may set it; it must then stay set
       until the work has returned. */
    volatile int *cancel;
    /* Called at intervals on the thread that started the work, with a fraction rising from 0 to 1. It
       may set *cancel. */
    void (*report)(void *ctx, double fraction);
    void *ctx; /* passed to report */
} WrProgress;

/* True if *cancel is nonzero, set by any thread or signal handler. NULL: false. */
bool wr_cancel_requested(const volatile int *cancel);
/* True if the work was cancelled. Any thread. */
bool wr_progress_cancelled(const WrProgress *progress);

/* Reports the fraction done. True if the work should continue. */
bool wr_progress_step(const WrProgress *progress, double fraction);

/* ---- progress of the thread ---- The caller of long work (a session, a background job) sets a
   progress for its thread. Deep loops find it without passing it through every function; the pieces of
   a pool's run inherit it. After cancellation a function may return with half of its work done, if its
   caller also checks for cancellation and discards the result. */

/* Progress and cancellation of this thread's work; NULL: none. */
const WrProgress *wr_progress_here(void);
/* Sets it; returns the previous value, which the caller restores when the work has returned. */
const WrProgress *wr_progress_set(const WrProgress *progress);

/* True if this thread's work was cancelled. */
bool wr_progress_stopped(void);
/* Reports the fraction done to it. True if the work should continue. */
bool wr_progress_report(double fraction);

/* Number of the thread's calls of the two functions above, for tests that count work between two
 * checks. */
int64_t wr_progress_checks(void);

/* A sub-range of a progress: its 0..1 is from..to of the whole. */
typedef struct WrProgressPart {
    WrProgress progress; /* pass this to the sub-task */
    const WrProgress *whole;
    double from, to;
} WrProgressPart;
/* Fills in *part as that range of `whole`, which may be NULL and must outlive it. Returns
 * &part->progress. */
const WrProgress *wr_progress_part(WrProgressPart *part, const WrProgress *whole, double from,
                                   double to);
/* Makes it a range of the thread's progress and sets it. Returns the value to restore with
 * wr_progress_set. */
const WrProgress *wr_progress_enter(WrProgressPart *part, double from, double to);

/* ---- time left ---- */

/* Remaining time of long work, promised only while the work advances at a steady rate. */

/* Reports of one task; zeroed before the first. A report with fewer seconds than the last begins a new task. */
typedef struct WrTimeLeft {
    double fraction[2], seconds[2]; /* two earlier reports, the older one first */
    double last;                    /* seconds of the last report */
} WrTimeLeft;

/* Seconds left, from the fraction done (0..1) and the seconds used, both of the whole task. NAN in the first second, and
 * unless the rate of the latest part agrees with the rate of the whole within a factor of 1.5: a promise that may be
 * wrong by more than 2 is worse than none. */
double wr_time_left(WrTimeLeft *task, double fraction, double seconds);
