#include "ui/panels/accuracy/accuracy_schedule.h"

#include <math.h>

WrAccuracyNext wr_accuracy_next(const WrAccuracyMoment *m, double *due)
{
    *due = 0;
    if (!m->rests || m->busy) return WR_ACCURACY_NOTHING;
    const bool error = m->open && !m->error_known;
    const bool asked = m->plot_asked;
    const bool plot = asked || (m->plot_open && !m->plot_known);
    if (!error && !plot) return WR_ACCURACY_NOTHING;
    const double wait = error ? WR_ACCURACY_REST : asked ? 0 : WR_ACCURACY_BENCHMARK_REST;
    if (m->now < m->changed_at + wait) { /* bit-identical to *due */
        *due = m->changed_at + wait;
        return WR_ACCURACY_NOTHING;
    }
    return error ? WR_ACCURACY_ERROR : WR_ACCURACY_BENCHMARK;
}

bool wr_accuracy_flicker(double now, double since, double *next)
{
    const double count = floor((now - since) / WR_FLICKER_SECONDS);
    *next = since + (count + 1) * WR_FLICKER_SECONDS;
    return fmod(count, 2) != 0;
}

double wr_accuracy_split_from_pointer(double x, double left, double width, double margin)
{
    const double least = width > 2 * margin ? margin / width : 0.5;
    const double share = width > 0 ? (x - left) / width : 0.5;
    return share < least ? least : share > 1 - least ? 1 - least : share;
}

void wr_accuracy_picture_size(int width, int height, int longest, int *out_width, int *out_height)
{
    const int longer = width > height ? width : height;
    const double scale = longer > longest ? (double)longest / longer : 1;
    const int w = (int)lround(width * scale), h = (int)lround(height * scale);
    *out_width = w > 1 ? w : 1;
    *out_height = h > 1 ? h : 1;
}
