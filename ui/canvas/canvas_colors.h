/* canvas_colors.h - pixel colours of the canvas: palettes of heights with contour lines; shaded relief; normals.
   Plain numbers; tested without a window. */
#pragma once
#include "ui/canvas/canvas.h"

#include <stdint.h>

#define WR_CANVAS_INK_CODES 256  /* palette size; two more entries mark values beyond the range */
#define WR_CANVAS_INK_TONES 1024 /* shades of relief */

typedef struct WrCanvasInk {
    WrCanvasColours colours;
    double low, high;                          /* heights of the first and last code */
    uint32_t palette[WR_CANVAS_INK_CODES + 2]; /* the last two: below, above */
    uint32_t tones[WR_CANVAS_INK_TONES + 1];   /* by the cosine to the light */
    float light[3];                            /* unit vector: right, up, towards the eye */
    double step;                               /* height difference of two contours */
} WrCanvasInk;

/* Build the tables for a range. */
void wr_canvas_ink_make(WrCanvasInk *ink, const WrCanvasLook *look, double low, double high);
/* The colour of a height, without contours. */
uint32_t wr_canvas_ink_colour(const WrCanvasInk *ink, double height);
/* Height difference of contours that gives about 10 of them from `low` to `high`: 1, 2 or 5 times a power of 10. */
double wr_canvas_ink_step(double low, double high);

/* Colours of a row of pixels. left: height to the left of the first; above: heights of the previous row, NULL: none.
 * Both are only for contours, drawn where a pixel's height and one of these are on different sides of a step. NaN: no
 * height, and no contour beside it. */
void wr_canvas_ink_heights(const WrCanvasInk *ink, const float *heights, float left,
                           const float *above, int count, uint32_t *out);
/* Colours of a row from slopes dz/dx (right) and dz/dy (up). */
void wr_canvas_ink_slopes(const WrCanvasInk *ink, const float *p, const float *q, int count,
                          uint32_t *out);
