#include "ui/canvas/canvas_range.h"

#include <math.h>

#define LEVEL_REACH 0.5 /* heights from zero that a level table shows, at least */
#define ROOM 0.25       /* more than it must, as a part of the range */
#define SLIGHT                                                                                     \
    0.25 /* dents that are so much shallower than the bumps are high do not cost half of the greys */

void wr_range_follow(double range[2], double low, double high, bool held)
{
    bool level = !(high > low), signs = level || low < fmin(0.0, -SLIGHT * high);
    double reach = fmax(fabs(low), fabs(high));
    if (level) reach = fmax(LEVEL_REACH, 2.0 * reach);
    double rest[2] = { signs ? -reach : low, signs ? reach : high };
    bool inside = rest[0] >= range[0] && rest[1] <= range[1];
    if (held && inside && range[0] < range[1]) return;
    double more = held ? ROOM * (rest[1] - rest[0]) : 0.0;
    bool below = held && (signs || rest[0] < range[0]);
    range[0] = rest[0] - (below ? more : 0.0);
    range[1] = rest[1] + more;
}
