/* progress.h - how long work says how far it is, and how it is told to stop.
   Layer 0. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The caller's; any member, and the pointer to the struct itself, may be NULL. */
typedef struct WrProgress {
    /* The work stops soon after this becomes other than 0. Any thread may set it; it must then stay set
       until the work has returned. */
    volatile int *cancel;
    /* Called now and then on the thread that asked for the work, fraction rising from 0 to 1. It may
       set *cancel. */
    void (*report)(void *ctx, double fraction);
    void *ctx; /* handed to report */
} WrProgress;

/* Is it other than 0? NULL: no. However it was set, by any thread or by a signal. */
bool wr_cancel_asked(const volatile int *cancel);
/* Has somebody asked the work to stop? Any thread may ask. */
bool wr_progress_cancelled(const WrProgress *progress);

/* Tell how far the work is. True if it should go on. */
bool wr_progress_step(const WrProgress *progress, double fraction);

/* "0:07 left", from how far work is and how long that took; "" while that says nothing yet. */
#define WR_PROGRESS_LEFT 24
void wr_progress_left(double fraction, double seconds, char text[WR_PROGRESS_LEFT]);

/* ---- the thread's own ----
   Who asks for long work says here what it looks at: a session, a job in the background. Loops far below find it
   without anybody in between handing it on; the pieces of a pool's run find it too. Where it is cancelled a
   function may return with half of its work done, as long as its caller, who asks too, throws that away. */

/* What this thread's work reports to and is stopped by; NULL: nothing. */
const WrProgress *wr_progress_here(void);
/* Set it; returns what was there, to be put back when the work has returned. */
const WrProgress *wr_progress_set(const WrProgress *progress);

/* Has this thread's work been asked to stop? */
bool wr_progress_stopped(void);
/* Tell how far it is. True if it should go on. */
bool wr_progress_tell(double fraction);

/* How often this thread has asked either, for tests that count work between two looks. */
int64_t wr_progress_looks(void);

/* A part of the whole: 0..1 of it is from..to of the other. */
typedef struct WrProgressPart {
    WrProgress progress; /* hand this on */
    const WrProgress *whole;
    double from, to;
} WrProgressPart;
/* Fill in *part as that part of `whole`, which may be NULL and must outlive it. Returns &part->progress. */
const WrProgress *wr_progress_part(WrProgressPart *part, const WrProgress *whole, double from,
                                   double to);
/* Make it that part of the thread's own. Returns what to give wr_progress_set afterwards. */
const WrProgress *wr_progress_enter(WrProgressPart *part, double from, double to);
