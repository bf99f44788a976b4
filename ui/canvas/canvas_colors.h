/* canvas_colors.h - the colours of the canvas's pixels: of heights by a palette, with contour lines; of slopes lit, or as
   normals. Plain numbers; tested without a window. */
#pragma once
#include "ui/canvas/canvas.h"

#include <stdint.h>

#define WR_CANVAS_INK_CODES 256  /* of a picture; two more mark what lies beyond its range */
#define WR_CANVAS_INK_TONES 1024 /* of lit slopes */

typedef struct WrCanvasInk {
    WrCanvasColours colours;
    double low, high;                          /* heights of the first and last code */
    uint32_t palette[WR_CANVAS_INK_CODES + 2]; /* the last two: below, above */
    uint32_t tones[WR_CANVAS_INK_TONES + 1];   /* by the cosine of the light's angle */
    float light[3];                            /* unit: right, up, towards the eye */
    double step;                               /* heights between two contours */
} WrCanvasInk;

/* For a range that look and table came to. */
void wr_canvas_ink_make(WrCanvasInk *ink, const WrCanvasLook *look, double low, double high);
/* The colour of a height; contours aside. */
uint32_t wr_canvas_ink_colour(const WrCanvasInk *ink, double height);
/* Heights between two contours so that `low` to `high` has about 10 of them: 1, 2 or 5 times a power of 10. */
double wr_canvas_ink_step(double low, double high);

/* A row of pixels. left: the height to the left of the first; above: of the row above, NULL: there is none. Both count
 * for contours alone, which are drawn where a pixel's height and one of theirs are on both sides of a step. NaN: there is
 * no height, and so no contour beside it. */
void wr_canvas_ink_heights(const WrCanvasInk *ink, const float *heights, float left,
                           const float *above, int count, uint32_t *out);
/* Of slopes dz/dx (right) and dz/dy (up). */
void wr_canvas_ink_slopes(const WrCanvasInk *ink, const float *p, const float *q, int count,
                          uint32_t *out);
