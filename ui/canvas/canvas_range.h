/* canvas_range.h - which heights the canvas shows as black and white where the range follows the table. Pure
   numbers; tested without a window. */
#pragma once
#include <stdbool.h>

/* Bring range (black, white) up to date for a table that goes from low to high.
 *
 * At rest it is the table's own. Where the table is level or goes well below zero, zero is mid-grey: so that on a new
 * table both raising and lowering are seen, and the sign of a height too.
 * held: something is being painted. It then only widens, at once and by more than it must, so that neither the
 * picture flickers nor is made anew with each dab. */
void wr_range_follow(double range[2], double low, double high, bool held);
