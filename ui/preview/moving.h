/* moving.h - how fine a picture of the moving patch may be: as large as the view if the time allows, then with its edges
   smooth, then with 2 x 2 samples everywhere. Pure: times come from the caller. */
#pragma once
#include "scene/dials.h"

#define WR_MOVING_COARSEST 0.125 /* of the view's width and height */

/* Cheap to fine. */
typedef enum WrMovingWay {
    WR_MOVING_POINT, /* one sample a pixel */
    WR_MOVING_EDGES, /* more where neighbours differ: outlines and steps of the relief */
    WR_MOVING_GRID,  /* 2 x 2 everywhere */
    WR_MOVING_WAYS
} WrMovingWay;

/* Zero-initialise; scale to begin with. */
typedef struct WrMoving {
    WrMovingWay way; /* of the next picture */
    double scale;    /* of its width and height, 0..1; below 1 only of WR_MOVING_POINT */
    double seconds[WR_MOVING_WAYS]; /* of a pixel; 0: not known yet */
    int wait, patience,
        lasted; /* pictures: until a finer way may be tried, .. next time, since the last try */
} WrMoving;

/* A picture of so many pixels was made this way, in that time without what was only prepared for it; the view has so
 * many, and `allowed` is what the next one may take. Follows the measured speed, but not every wobble of it: a picture
 * that changes its looks all the time is worse than one that is a little too coarse. */
void wr_moving_learn(WrMoving *moving, double seconds, double pixels, double view_pixels,
                     double allowed);
/* The way's dials. */
void wr_moving_dials(WrMovingWay way, WrDials *dials);
/* "1 x 1", "edges 4 x 4", "2 x 2", as people write it */
extern const char *const wr_moving_names[WR_MOVING_WAYS];
