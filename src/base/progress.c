#include "base/progress.h"

#include <math.h>

/* The progress of the running task belongs to the thread, so that deep functions check for cancellation without a parameter
   through all layers. wr_progress_enter replaces it by a part, from..to of the whole; the caller restores the previous one. */
static _Thread_local const WrProgress *here;
static _Thread_local int64_t checks;

bool wr_cancel_requested(const volatile int *cancel)
{
    return cancel && __atomic_load_n(cancel, __ATOMIC_RELAXED) != 0;
}

/* Not inline: a test replaces these functions to measure the time between two checks. */
bool wr_progress_cancelled(const WrProgress *progress)
{
    return progress && wr_cancel_requested(progress->cancel);
}

bool wr_progress_step(const WrProgress *progress, double fraction)
{
    if (progress && progress->report) progress->report(progress->ctx, fraction);
    return !wr_progress_cancelled(progress);
}

const WrProgress *wr_progress_here(void)
{
    return here;
}

const WrProgress *wr_progress_set(const WrProgress *progress)
{
    const WrProgress *before = here;
    here = progress;
    return before;
}

int64_t wr_progress_checks(void)
{
    return checks;
}

bool wr_progress_stopped(void)
{
    checks++;
    return wr_progress_cancelled(here);
}

bool wr_progress_report(double fraction)
{
    checks++;
    return wr_progress_step(here, fraction);
}

static void report_part(void *ctx, double fraction)
{
    const WrProgressPart *part = ctx;
    double within = fraction < 0.0 ? 0.0 : fraction > 1.0 ? 1.0 : fraction;
    part->whole->report(part->whole->ctx, part->from + (part->to - part->from) * within);
}

const WrProgress *wr_progress_part(WrProgressPart *part, const WrProgress *whole, double from,
                                   double to)
{
    *part = (WrProgressPart){ .whole = whole, .from = from, .to = to };
    if (whole) part->progress.cancel = whole->cancel;
    if (whole && whole->report) part->progress.report = report_part;
    part->progress.ctx = part;
    return &part->progress;
}

const WrProgress *wr_progress_enter(WrProgressPart *part, double from, double to)
{
    return wr_progress_set(wr_progress_part(part, here, from, to));
}

/* ---- time left ---- */

#define GROWTH 1.25 /* of the time between two kept reports */
#define AGREE 1.5   /* factor between the two rates */
#define FIRST_SECONDS 0.25

/* The earlier reports are those at which the time had grown by GROWTH, so the oldest is from 64 to 80 % of the present
   time, and the rate since then is that of the latest fifth to third of the work. */
static void note(WrTimeLeft *t, double fraction, double seconds)
{
    if (seconds < t->last) *t = (WrTimeLeft){ .last = 0 };
    if (seconds >= FIRST_SECONDS && seconds >= GROWTH * t->seconds[1]) {
        t->fraction[0] = t->fraction[1], t->seconds[0] = t->seconds[1];
        t->fraction[1] = fraction, t->seconds[1] = seconds;
    }
    t->last = seconds;
}

double wr_time_left(WrTimeLeft *task, double fraction, double seconds)
{
    note(task, fraction, seconds);
    if (!(task->seconds[0] > 0.0) || seconds < 1.0 || fraction < 0.01) return NAN;
    const double whole = fraction / seconds;
    const double recent = (fraction - task->fraction[0]) / (seconds - task->seconds[0]);
    if (recent * AGREE < whole || recent > whole * AGREE) return NAN;
    return fmax((1.0 - fraction) / whole, 0.0);
}
