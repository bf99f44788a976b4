/* progress.h - how long work says how far it is, and how it is told to stop.
   Layer 0. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

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

/* Has somebody asked the work to stop? Any thread may ask. */
static inline bool wr_progress_cancelled(const WrProgress *progress)
{
    return progress && progress->cancel && __atomic_load_n(progress->cancel, __ATOMIC_RELAXED) != 0;
}

/* Tell how far the work is. True if it should go on. */
static inline bool wr_progress_step(const WrProgress *progress, double fraction)
{
    if (progress && progress->report) progress->report(progress->ctx, fraction);
    return !wr_progress_cancelled(progress);
}
