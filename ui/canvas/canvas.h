/* canvas.h - the picture of the table on the canvas: grey or false colour, repeated in all directions,
   box-filtered at every zoom, kept in a texture of which only what changed is made anew. */
#pragma once
#include "ui/canvas/canvas_range.h"
#include "ui/canvas/view.h"

#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrField WrField;
typedef struct WrRetainedFrame WrRetainedFrame;

typedef struct WrCanvas WrCanvas;

typedef enum WrCanvasColours {
    WR_CANVAS_GREY,
    WR_CANVAS_SIGNED,
    WR_CANVAS_CONTOURS, /* lines of equal height */
    WR_CANVAS_RELIEF,   /* slopes, lit */
    WR_CANVAS_NORMALS,  /* slopes, as a normal map has them */
    WR_CANVAS_COLOURS
} WrCanvasColours;

/* What is shown: the table, or a map of it (canvas_map.h). */
typedef enum WrCanvasShown {
    WR_CANVAS_HEIGHTS,
    WR_CANVAS_OCCLUSION,
    WR_CANVAS_CAVITY,
    WR_CANVAS_CURVATURE,
    WR_CANVAS_SLOPE,
    WR_CANVAS_ROUGHNESS,
    WR_CANVAS_LIT,  /* its slopes along u and v */
    WR_CANVAS_BENT, /* the same, as normals */
    WR_CANVAS_SHOWN
} WrCanvasShown;

typedef struct WrCanvasLook {
    WrCanvasShown shown;
    WrCanvasColours colours; /* of heights; SIGNED: blue below zero, white at zero, orange above */
    bool automatic;          /* low and high follow the table (canvas_range.h) */
    bool marks;              /* what lies beyond them is tinted: warm above, cool below */
    double low, high;        /* heights shown as black and white; low < high */
    double light_x, light_y; /* of a relief: to the right and up, of a unit vector towards it */
} WrCanvasLook;

typedef struct WrCanvasRange {
    double low, high;             /* shown as black and white */
    double table_low, table_high; /* that there are */
} WrCanvasRange;

WrCanvas *wr_canvas_new(void);
void wr_canvas_free(WrCanvas *canvas); /* before the renderer; NULL is fine */

/* Heights between two of its lines. */
double wr_canvas_contour_step(const WrCanvas *canvas);

/* Bring the picture up to date and draw it into the view's rectangle. Takes at most about `budget`
 * seconds for the means of large tables; true if it would be better with another call. second: slopes along v, where `field`
 * holds those along u; else NULL. kept: borrowed until the next call. hold: of an automatic range. */
bool wr_canvas_draw(WrCanvas *canvas, WrRetainedFrame *kept, const WrCanvasView *view,
                    const WrField *field, const WrField *second, const WrCanvasLook *look,
                    WrRangeHold hold, double budget, WrCanvasRange *range);
/* The automatic range becomes the table's own with the next picture. */
void wr_canvas_fit_range(WrCanvas *canvas);
/* The colour of a height, 0xffRRGGBB, as in the last picture. */
uint32_t wr_canvas_colour(const WrCanvas *canvas, double height);
/* The renderer lost its textures: make them anew. */
void wr_canvas_forget(WrCanvas *canvas);
