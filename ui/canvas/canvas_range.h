/* canvas_range.h - heights that the canvas shows as black and white where the range is automatic. Pure numbers; tested
   without a window. */
#pragma once

typedef enum WrRangeHold {
    WR_RANGE_RESTS,  /* nothing is in progress */
    WR_RANGE_WIDENS, /* something is being painted */
    WR_RANGE_STAYS   /* the table is a preview that follows the pointer */
} WrRangeHold;

/* Update range (black, white) for a table whose heights are low..high.
 *
 * An empty range (black >= white) becomes the table's own. There zero is mid-grey where the table is level or goes well
 * below zero, so that raising and lowering both show.
 * Else the picture stays as it is as far as it can: a height beyond the range moves that end only, and the other keeps
 * its grey. A range of which the table uses less than an eighth becomes the table's own, at rest.
 * WR_RANGE_WIDENS: an end moves by more than it must, so that the picture is not made anew with each dab. */
void wr_range_follow(double range[2], double low, double high, WrRangeHold hold);
