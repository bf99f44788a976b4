/* canvas_range.h - automatic black and white heights of the canvas. Pure numbers; tested without a window. */
#pragma once

typedef enum WrRangeHold {
    WR_RANGE_RESTS,  /* no edit in progress */
    WR_RANGE_WIDENS, /* painting in progress */
    WR_RANGE_STAYS   /* the table is a preview that follows the pointer */
} WrRangeHold;

/* Update range (black, white) for a table with heights low..high.
 *
 * An empty range (black >= white) becomes the table's own. In it zero is mid-grey if the table is level or goes well
 * below zero, so that raising and lowering are both visible. Otherwise the picture is kept as far as possible: a
 * height beyond the range moves only that end, and the other keeps its grey. A range of which the table uses less
 * than an eighth becomes the table's own, at rest. WR_RANGE_WIDENS: an end moves by more than necessary, so that not
 * every dab redraws the picture. */
void wr_range_follow(double range[2], double low, double high, WrRangeHold hold);
