#include "base/time_left.h"

#define GROWTH 1.25 /* of the time between two kept reports */
#define AGREE 1.5   /* factor between the two rates */
#define FIRST_SECONDS 0.25

/* The earlier reports are those at which the time had grown by GROWTH, so the oldest is from 64 to 80 % of the present
   time, and the rate since then is that of the latest fifth to third of the work. */
static void note(WrTimeLeft *t, double fraction, double seconds)
{
    if (seconds < t->seconds[2]) *t = (WrTimeLeft){ .seconds = { 0 } };
    if (seconds >= FIRST_SECONDS && seconds >= GROWTH * t->seconds[1]) {
        t->fraction[0] = t->fraction[1], t->seconds[0] = t->seconds[1];
        t->fraction[1] = fraction, t->seconds[1] = seconds;
    }
    t->fraction[2] = fraction, t->seconds[2] = seconds;
}

void wr_time_left(WrTimeLeft *task, double fraction, double seconds, char text[WR_PROGRESS_LEFT])
{
    note(task, fraction, seconds);
    text[0] = '\0';
    if (!(task->seconds[0] > 0.0) || seconds < 1.0) return;
    const double whole = fraction / seconds;
    const double recent = (fraction - task->fraction[0]) / (seconds - task->seconds[0]);
    if (recent * AGREE >= whole && recent <= whole * AGREE)
        wr_progress_left(fraction, seconds, text);
}
