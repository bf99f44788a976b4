#include "ui/patch/preview/moving.h"

#include "base/enum_rows.h"

#include <math.h>
#include <stdbool.h>

#define FASTER 0.5 /* smoothing factor for decreasing times ... */
#define SLOWER 0.25
#define ROOM                                                                                       \
    0.75 /* fraction of the allowed time for trying a finer mode; a mode is left only when it
            exceeds the whole time */
#define WOBBLE 0.15 /* tolerated variation of the scale */
/* Pictures before a mode that was too slow is tried again: doubled each time, until one try has lasted this long. */
#define PATIENCE 40
#define PATIENCE_MAX 1200
#define LASTED 300

WR_ROWS(wr_moving_names);
const char *const wr_moving_names[] = { [WR_ROW(WR_MOVING_POINT)] = "1 \xc3\x97 1",
                                        [WR_ROW(WR_MOVING_EDGES)] = "edges 4 \xc3\x97 4",
                                        [WR_ROW(WR_MOVING_GRID)] = "2 \xc3\x97 2" };
WR_ROWS_END(wr_moving_names, WR_MOVING_WAYS);

/* Cost relative to the next coarser mode, before it is measured. */
WR_ROWS(dearer);
static const double dearer[] = { [WR_ROW(WR_MOVING_POINT)] = 1,
                                 [WR_ROW(WR_MOVING_EDGES)] = 1.8,
                                 [WR_ROW(WR_MOVING_GRID)] = 2 };
WR_ROWS_END(dearer, WR_MOVING_WAYS);

void wr_moving_dials(WrMovingWay way, WrDials *dials)
{
    dials->aa = way == WR_MOVING_POINT   ? WR_AA_POINT
                : way == WR_MOVING_EDGES ? WR_AA_ADAPTIVE
                                         : WR_AA_SUPERSAMPLE;
    dials->samples = way == WR_MOVING_POINT ? 1 : way == WR_MOVING_EDGES ? 4 : 2;
    dials->spread = WR_SPREAD_REGULAR;
    dials->refine = WR_REFINE_CONTRAST;
    dials->contrast = 0.05;
}

static void follow(double *known, double measured)
{
    const double pace = measured < *known ? FASTER : SLOWER;
    *known = *known > 0 ? *known + pace * (measured - *known) : measured;
}

static void choose_scale(WrMoving *moving, double view_pixels, double allowed)
{
    /* The time is proportional to the number of pixels, so the scale of a side is the square root of the ratio. */
    double scale = sqrt(allowed / moving->seconds[WR_MOVING_POINT] / view_pixels);
    scale = scale > 0.9 ? 1.0 : scale < WR_MOVING_COARSEST ? WR_MOVING_COARSEST : scale;
    if (fabs(scale - moving->scale) > WOBBLE * moving->scale || scale == 1.0) moving->scale = scale;
}

static void go_down(WrMoving *moving)
{
    moving->way--;
    moving->patience = moving->patience > 0 ? 2 * moving->patience : PATIENCE;
    if (moving->patience > PATIENCE_MAX) moving->patience = PATIENCE_MAX;
    moving->wait = moving->patience;
    moving->lasted = LASTED; /* it failed */
}

static void go_up(WrMoving *moving)
{
    moving->way++;
    moving->seconds[moving->way] = 0;
    moving->lasted = 0;
}

void wr_moving_learn(WrMoving *moving, double seconds, double pixels, double view_pixels,
                     double allowed)
{
    double *known = &moving->seconds[moving->way];
    follow(known, seconds / pixels);
    const double takes = *known * view_pixels;
    if (moving->wait > 0) moving->wait--;
    if (++moving->lasted == LASTED) moving->patience = 0;
    if (moving->way == WR_MOVING_POINT) choose_scale(moving, view_pixels, allowed);
    else if (takes > allowed) go_down(moving);
    const bool last = moving->way + 1 == WR_MOVING_WAYS;
    if (!last && moving->wait == 0 && moving->scale == 1 &&
        dearer[moving->way + 1] * takes < ROOM * allowed)
        go_up(moving);
}
