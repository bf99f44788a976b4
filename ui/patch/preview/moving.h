/* moving.h - quality control of moving pictures: full resolution if the time allows, then smooth edges, then 2 x 2
   samples everywhere. Pure: times come from the caller. */
#pragma once
#include "scene/dials.h"

#define WR_MOVING_COARSEST 0.125 /* lowest scale of the view's width and height */

/* Modes from cheap to fine. */
typedef enum WrMovingWay {
    WR_MOVING_POINT, /* one sample per pixel */
    WR_MOVING_EDGES, /* more where neighbours differ: silhouettes and steps of the relief */
    WR_MOVING_GRID,  /* 2 x 2 everywhere */
    WR_MOVING_WAYS
} WrMovingWay;

/* Zero-initialise; set the initial scale. */
typedef struct WrMoving {
    WrMovingWay way; /* mode of the next picture */
    double scale;    /* its scale in width and height, 0..1; below 1 only with WR_MOVING_POINT */
    double seconds[WR_MOVING_WAYS]; /* time per pixel; 0: unknown */
    int wait, patience,
        /* numbers of pictures: until a finer mode may be tried; of the next wait; since the last
           try */
        lasted;
} WrMoving;

/* Record a picture's time, without one-time preparations, and its number of pixels in this mode. The view has `view`
 * pixels, and `allowed` is the time for the next picture. Follows the measured speed but ignores small variations:
 * continual changes of quality are worse than slightly too low quality. */
void wr_moving_learn(WrMoving *moving, double seconds, double pixels, double view_pixels,
                     double allowed);
/* Set the mode's dials. */
void wr_moving_dials(WrMovingWay way, WrDials *dials);
/* display names: "1 x 1", "edges 4 x 4", "2 x 2" */
extern const char *const wr_moving_names[WR_MOVING_WAYS];
