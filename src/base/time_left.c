#include "base/time_left.h"

#include <math.h>

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
