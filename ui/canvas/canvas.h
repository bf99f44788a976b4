/* canvas.h - picture of the table on the canvas: grey or false colour, tiled in all directions, box-filtered at every
   zoom. Only changed parts of its texture are redrawn. */
#pragma once
#include "ui/canvas/view.h"

#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrField WrField;
typedef struct WrRetainedFrame WrRetainedFrame;

typedef struct WrCanvas WrCanvas;

/* How the automatic range follows the heights. */
typedef enum WrRangeHold {
    WR_RANGE_RESTS, /* no edit in progress: it follows (wr_range_follow in canvas_colors.h) */
    WR_RANGE_TRIES, /* the table is a finished preview of an edit: it widens until the preview ends */
    WR_RANGE_STAYS /* painting, dragging, or a preview that follows the pointer: it stays */
} WrRangeHold;

typedef enum WrCanvasColours {
    WR_CANVAS_GREY,
    WR_CANVAS_SIGNED,
    WR_CANVAS_CONTOURS, /* contour lines */
    WR_CANVAS_RELIEF,   /* shaded relief */
    WR_CANVAS_NORMALS   /* colours of a normal map */
} WrCanvasColours;
#define WR_CANVAS_LOOKS 3 /* the first of them can be chosen; the others belong to maps */

/* Displayed content: the table, or a map of it (canvas_derived_map.h). */
typedef enum WrCanvasShown {
    WR_CANVAS_HEIGHTS,
    WR_CANVAS_OCCLUSION,
    WR_CANVAS_CAVITY,
    WR_CANVAS_CURVATURE,
    WR_CANVAS_SLOPE,
    WR_CANVAS_ROUGHNESS,
    WR_CANVAS_LIT,  /* its slopes along u and v, as shaded relief */
    WR_CANVAS_BENT, /* its slopes as normals */
    WR_CANVAS_SHOWN
} WrCanvasShown;

typedef struct WrCanvasDisplay {
    WrCanvasShown shown;
    WrCanvasColours colours; /* of heights; SIGNED: blue below zero, white at zero, orange above */
    bool automatic[2];       /* low, high: adjusted to the table (wr_range_follow) */
    bool marks;              /* tint heights beyond the range: warm above, cool below */
    double low, high;        /* heights displayed as black and white, unless automatic */
    /* of shaded relief: right and up components of the unit vector towards the light */
    double light_x, light_y;
} WrCanvasDisplay;

typedef struct WrCanvasRange {
    double low, high;             /* values displayed as black and white */
    double table_low, table_high; /* range of the table */
} WrCanvasRange;

WrCanvas *wr_canvas_new(int threads);  /* as in wr_pool_new; they start with the first picture */
void wr_canvas_free(WrCanvas *canvas); /* must be freed before the renderer; NULL is allowed */

/* Height difference between two contour lines. */
double wr_canvas_contour_interval(const WrCanvas *canvas);

/* Update the picture and draw it into the view's rectangle. Averaging large tables needs at most about `budget`
 * seconds; true if another call would improve the picture. second: slopes along v, if `field` holds those along u;
 * else NULL. kept: borrowed until the next call. hold: mode of the automatic range. */
bool wr_canvas_draw(WrCanvas *canvas, WrRetainedFrame *kept, const WrCanvasView *view,
                    const WrField *field, const WrField *second, const WrCanvasDisplay *look,
                    WrRangeHold hold, double budget, WrCanvasRange *range);
/* Reset the automatic range to the table's own with the next picture. */
void wr_canvas_fit_range(WrCanvas *canvas);
/* The colour of a height in the last picture, 0xffRRGGBB. */
uint32_t wr_canvas_colour(const WrCanvas *canvas, double height);
/* The renderer lost its textures: create them again. */
void wr_canvas_forget(WrCanvas *canvas);
