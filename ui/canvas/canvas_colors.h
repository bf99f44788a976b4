/* canvas_colors.h - pixel colours of the canvas: palettes of heights with contour lines; shaded relief; normals.
   Plain numbers; tested without a window. */
#pragma once
#include "ui/canvas/canvas.h"

#include <stdbool.h>
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
void wr_canvas_ink_make(WrCanvasInk *ink, const WrCanvasDisplay *look, double low, double high);
/* The colour of a height, without contours. */
uint32_t wr_canvas_ink_colour(const WrCanvasInk *ink, double height);
/* Height difference of contours that yields about 10 of them from `low` to `high`: 1, 2 or 5 times a power of 10. */
double wr_canvas_ink_step(double low, double high);

/* Colours of a row of pixels. left: height to the left of the first; above: heights of the previous row, NULL: none.
 * Both are only for contours, drawn where a pixel's height and one of these are on different sides of a step. NaN: no
 * height, and no contour beside it. */
void wr_canvas_ink_heights(const WrCanvasInk *ink, const float *heights, float left,
                           const float *above, int count, uint32_t *out);
/* Colours of a row from slopes dz/dx (right) and dz/dy (up). */
void wr_canvas_ink_slopes(const WrCanvasInk *ink, const float *p, const float *q, int count,
                          uint32_t *out);

/* ---- automatic black and white heights ---- */

/* Update range (black, white) for a table with heights low..high.
 *
 * An empty range (black >= white) becomes the table's own. In it zero is mid-grey if the table is level or goes well
 * below zero, so that raising and lowering are both visible. Otherwise the picture is kept as far as possible: a
 * height beyond the range moves only that end, and the other keeps its grey. An end that is passed by little, as by a
 * stroke, moves by more than necessary, so that not every stroke moves it. A range of which the table uses less than
 * an eighth becomes the table's own, with zero in the middle if it was there. */
void wr_range_follow(double range[2], double low, double high);
/* Widen the range just as far as the heights low..high need. */
void wr_range_widen(double range[2], double low, double high);
/* The ends as text, "-0.25", "1": to a hundredth of the range's leading digit, so that nothing invisible is shown. */
#define WR_RANGE_TEXT 40
void wr_range_print(double low, double high, char black[WR_RANGE_TEXT], char white[WR_RANGE_TEXT]);

/* ---- thumbnails of tables for lists ---- */

#define WR_THUMB_MAX 128 /* largest side in pixels */

/* Draw a picture of side x side pixels (1..WR_THUMB_MAX) of the whole table, stretched to a square: grey from the
 * lowest to the highest sampled height. Four texels per pixel are read, so the cost is independent of the table's
 * size. A flat table shows its height, 0 black and 1 white. With a cover, height 0 is middle grey, so that raised and
 * lowered areas are both visible.
 *
 * cover  0..1, of the field's size: the background shows where it is 0; NULL: 1 everywhere
 * unit   true: fixed range, black is 0 and white is 1, as for masks
 * argb   [side * side] 0xAARRGGBB */
void wr_thumb_draw(const WrField *field, const WrField *cover, bool unit, int side, uint32_t *argb);
