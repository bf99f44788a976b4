#include "ui/canvas/canvas_range.h"

#include <math.h>
#include <stdbool.h>

#define LEVEL_REACH 0.5  /* least range on each side of zero for a level table */
#define ROOM 0.25        /* margin, as a fraction of the range */
#define USED_LEAST 0.125 /* least used fraction of the range */
#define SLIGHT                                                                                     \
    0.25 /* if dents are much shallower than bumps are high, they must not take half of the greys */

static void own_range(double range[2], double low, double high)
{
    const bool level = !(high > low), signs = level || low < fmin(0.0, -SLIGHT * high);
    double reach = fmax(fabs(low), fabs(high));
    if (level) reach = fmax(LEVEL_REACH, 2.0 * reach);
    range[0] = signs ? -reach : low;
    range[1] = signs ? reach : high;
}

void wr_range_follow(double range[2], double low, double high, WrRangeHold hold)
{
    const double span = range[1] - range[0];
    const bool spare = high > low && high - low < USED_LEAST * span;
    if (!(span > 0.0) || (spare && hold == WR_RANGE_RESTS)) {
        own_range(range, low, high);
        return;
    }
    if (hold == WR_RANGE_STAYS) return;
    const double more = hold == WR_RANGE_WIDENS ? ROOM * span : 0.0;
    if (low < range[0]) range[0] = low - more;
    if (high > range[1]) range[1] = high + more;
}
