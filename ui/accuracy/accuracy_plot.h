/* accuracy_plot.h - logarithmic plot axes with round ends: range, ticks, positions of values, point under the
   pointer. Pure; tested without a window. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

/* An axis; 0 < low < high. */
typedef struct WrPlotAxis {
    double low, high;
} WrPlotAxis;

/* The axis from one round number (1, 2 or 5 times a power of ten) to another that contains all positive finite values
 * with a small margin. At least half a decade long. False if there are no such values. */
bool wr_plot_axis(const double *values, int count, WrPlotAxis *out);
/* Round numbers on the axis, ascending: 1, 2 and 5 times powers of ten if at most `room` are on it, else powers of
 * ten, else every second power, and so on. Returns their number, at most `room`. */
int wr_plot_ticks(const WrPlotAxis *axis, double *out, int room);
/* Position of a value: 0 at low, 1 at high, logarithmic; 0 for values that are not positive. */
double wr_plot_place(const WrPlotAxis *axis, double value);
/* Index of the point nearest to (x, y) within `reach`, or -1. points: x, y of each. */
int wr_plot_nearest(const double (*points)[2], int count, double x, double y, double reach);

/* The smallest 1, 2 or 5 times a power of ten that is not below `value`, as the end of a scale from 0; 1 if value is
 * not positive and finite. */
double wr_plot_round_up(double value);
/* A number for an axis or a table in at most 8 characters with at most three digits: "0.02", "12.5", "3e-05". Returns
 * text, of at least 16 bytes. */
char *wr_plot_number(double value, char *text);
