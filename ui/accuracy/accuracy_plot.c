#include "ui/accuracy/accuracy_plot.h"

#include <math.h>
#include <stdio.h>

#define ROOM 1.12 /* margin beyond the outer values */

static const double steps[3] = { 1, 2, 5 };

/* Round number of an index: 0 is 1, 1 is 2, 2 is 5, 3 is 10, -1 is 0.5. Powers of ten below 1 are computed by
   division, so that they equal the decimal literals. */
static double round_number(int index)
{
    const int k = (int)floor(index / 3.0);
    const double step = steps[index - 3 * k];
    return k < 0 ? step / pow(10.0, -k) : step * pow(10.0, k);
}

/* Index of the largest round number at or below a positive value. */
static int round_below(double value)
{
    int index = 3 * (int)floor(log10(value)) - 1;
    while (round_number(index + 1) <= value) index++;
    return index;
}

bool wr_plot_axis(const double *values, int count, WrPlotAxis *out)
{
    double low = INFINITY, high = 0;
    for (int i = 0; i < count; i++) {
        if (!(values[i] > 1e-300) || !(values[i] < 1e300)) continue;
        low = fmin(low, values[i]);
        high = fmax(high, values[i]);
    }
    if (high <= 0) return false;
    int from = round_below(low / ROOM), to = round_below(high * ROOM) + 1;
    for (bool down = true; round_number(to) < 3.2 * round_number(from); down = !down) {
        if (down) from--;
        else to++;
    }
    *out = (WrPlotAxis){ round_number(from), round_number(to) };
    return true;
}

int wr_plot_ticks(const WrPlotAxis *axis, double *out, int room)
{
    const int first = round_below(axis->low * (1 + 1e-12));
    for (int step = 1;; step = step == 1 ? 3 : step + 3) {
        int count = 0;
        bool fits = true;
        for (int i = first; fits && round_number(i) <= axis->high * (1 + 1e-12); i++) {
            if (round_number(i) < axis->low * (1 - 1e-12) || i % step != 0) continue;
            fits = count < room;
            if (fits) out[count++] = round_number(i);
        }
        if (fits) return count;
    }
}

double wr_plot_place(const WrPlotAxis *axis, double value)
{
    if (!(value > 0)) return 0;
    return log(value / axis->low) / log(axis->high / axis->low);
}

int wr_plot_nearest(const double (*points)[2], int count, double x, double y, double reach)
{
    int best = -1;
    double least = reach;
    for (int i = 0; i < count; i++) {
        const double d = hypot(points[i][0] - x, points[i][1] - y);
        if (d > least || (best >= 0 && d == least)) continue;
        best = i;
        least = d;
    }
    return best;
}

double wr_plot_round_up(double value)
{
    if (!(value > 1e-300) || !(value < 1e300)) return 1;
    const int below = round_below(value * (1 - 1e-12));
    return round_number(below) >= value * (1 - 1e-12) ? round_number(below)
                                                      : round_number(below + 1);
}

char *wr_plot_number(double value, char *text)
{
    const double size = fabs(value);
    if (isnan(value)) snprintf(text, 16, "\xe2\x80\x93");
    else if (size > 0 && (size < 1e-3 || size >= 1e5)) snprintf(text, 16, "%.2g", value);
    else if (size >= 100) snprintf(text, 16, "%.0f", value);
    else snprintf(text, 16, "%.3g", value);
    return text;
}
