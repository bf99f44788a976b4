/* accuracy_plot.h - a plot whose axes are logarithmic, and scales with round ends: where axes end, where their
   ticks are, where a value lies, which point is under the pointer. Pure; tested without a window. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

/* One axis; 0 < low < high. */
typedef struct WrPlotAxis {
    double low, high;
} WrPlotAxis;

/* The axis from a round number (1, 2 or 5 times a power of ten) to another that holds all values which are
 * positive and finite, with a little room beside the outer ones. At least half a decade long. False if there
 * are no such values. */
bool wr_plot_axis(const double *values, int count, WrPlotAxis *out);
/* Round numbers on the axis, ascending: 1, 2 and 5 times powers of ten where at most `room` of them are on it,
 * else powers of ten, else every second of those, and so on. Returns how many, at most `room`. */
int wr_plot_ticks(const WrPlotAxis *axis, double *out, int room);
/* Where a value lies: 0 at low, 1 at high, by its logarithm; values that are not positive lie at 0. */
double wr_plot_place(const WrPlotAxis *axis, double value);
/* The point nearest to (x, y) that is no farther than `reach`, or -1. points: x, y of each. */
int wr_plot_nearest(const double (*points)[2], int count, double x, double y, double reach);

/* The smallest of 1, 2, 5 times a power of ten that is not below `value`; 1 where value is not positive and
 * finite: the end of a scale that begins at 0. */
double wr_plot_round_up(double value);
/* A number for an axis or a table in at most 8 characters, three digits at most: "0.02", "12.5", "3e-05".
 * Returns text, of at least 16 bytes. */
char *wr_plot_number(double value, char *text);
