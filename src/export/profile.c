/* Profiles: F along a line of the cell as a chart, for the 1D constructions of noise and for seams. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "image/vector_drawing.h"
#include "export/job.h"
#include "field/analytic.h"
#include "field/scheme.h"
#include "scene/scene.h"

#include <math.h>

#define SIZE 14.0 /* pixels: font size of the numbers */

/* The chart's rectangle in the drawing, and its value range. */
typedef struct Chart {
    double x0, y0, x1, y1; /* pixels: left, top, right, bottom */
    double low, high;      /* table units */
    int samples;           /* along the line */
    double *f;             /* [samples] from 0 to 1; owned */
} Chart;

static void sample(const WrExportJob *job, Chart *chart)
{
    const WrExportOptions *o = &job->options;
    chart->low = INFINITY;
    chart->high = -INFINITY;
    for (int i = 0; i < chart->samples; i++) {
        double t = (double)i / (chart->samples - 1), f;
        double u = o->along_v ? o->at : t, v = o->along_v ? t : o->at;
        if (job->analytic) wr_analytic_sample(&job->scene->analytic, u, v, &f, NULL, NULL);
        else wr_field_sample(job->field, (WrScheme)o->scheme, 1, &u, &v, &f, NULL, NULL);
        chart->f[i] = isfinite(f) ? f : 0.0;
        chart->low = chart->f[i] < chart->low ? chart->f[i] : chart->low;
        chart->high = chart->f[i] > chart->high ? chart->f[i] : chart->high;
    }
}

/* 1, 2 or 5 times a power of ten, for about `count` steps in that range. */
static double step_of(double range, int count)
{
    double step = pow(10.0, floor(log10(range / count)));
    double rough = range / count / step;
    return step * (rough < 1.5 ? 1.0 : rough < 3.5 ? 2.0 : rough < 7.5 ? 5.0 : 10.0);
}

static double y_of(const Chart *chart, double f)
{
    return chart->y1 + (chart->y0 - chart->y1) * (f - chart->low) / (chart->high - chart->low);
}

static void line(WrVectorDrawing *ink, double x0, double y0, double x1, double y1)
{
    const WrVectorDrawingPoint ends[2] = { { (float)x0, (float)y0 }, { (float)x1, (float)y1 } };
    wr_vector_drawing_line(ink, ends, 2);
}

static void word_number(WrVectorDrawing *ink, double number, double x, double y, double anchor)
{
    WrText text = { 0 };
    wr_text_addf(&text, "%.6g", number + 0.0);
    wr_vector_drawing_word(ink, wr_text_get(&text), x, y, SIZE, anchor);
    wr_text_fini(&text);
}

static void draw_grid(const WrExportOptions *o, WrVectorDrawing *ink, const Chart *chart)
{
    double step = step_of(chart->high - chart->low, 5);
    for (double f = ceil(chart->low / step) * step; f <= chart->high && !wr_progress_stopped();
         f += step) {
        double value = rint(f / step) * step, y = y_of(chart, value);
        wr_vector_drawing_pen(ink, 1.0, fabs(value) < 0.5 * step ? 0.45 : 0.12);
        line(ink, chart->x0, y, chart->x1, y);
        wr_vector_drawing_pen(ink, 1.0, 0.97);
        word_number(ink, value, chart->x0 - 8.0, y + 0.35 * SIZE, 1.0);
    }
    for (int i = 0; i <= o->grid && !wr_progress_stopped(); i++) {
        double t = (double)i / o->grid, x = chart->x0 + t * (chart->x1 - chart->x0);
        wr_vector_drawing_pen(ink, 1.0, 0.12);
        line(ink, x, chart->y0, x, chart->y1);
        wr_vector_drawing_pen(ink, 1.0, 0.97);
        if (o->grid <= 16 || i % ((o->grid + 15) / 16) == 0)
            word_number(ink, t, x, chart->y1 + 1.6 * SIZE, 0.5);
    }
    wr_vector_drawing_word(ink, o->along_v ? "v" : "u", chart->x1, chart->y1 + 2.9 * SIZE, SIZE,
                           1.0);
    wr_vector_drawing_word(ink, "F", chart->x0 - 8.0, chart->y0 - 0.8 * SIZE, SIZE, 1.0);
}

static void draw_curve(const WrExportOptions *o, WrVectorDrawing *ink, const Chart *chart)
{
    WrVectorDrawingPoint *points = wr_alloc((size_t)chart->samples, sizeof *points);
    for (int i = 0; i < chart->samples; i++)
        points[i] = (WrVectorDrawingPoint){ (float)(chart->x0 + (chart->x1 - chart->x0) * i /
                                                                    (chart->samples - 1)),
                                            (float)y_of(chart, chart->f[i]) };
    wr_vector_drawing_pen(ink, o->pen * 1.5, 1.0);
    wr_vector_drawing_line(ink, points, chart->samples);
    wr_free(points);
}

/* Adds a margin above and below; a flat line is centred in one unit. */
static void give_room(Chart *chart)
{
    double range = chart->high - chart->low, least = 1e-6 * fmax(fabs(chart->low), 1e-30);
    double air = range > least ? 0.06 * range : 0.5 * fmax(1.0, fabs(chart->low));
    chart->low -= air;
    chart->high += air;
}

bool wr_export_profile_write(WrExportJob *job, const char *path, WrError *err)
{
    WrExportOptions *o = &job->options;
    if (o->scheme < 0) o->scheme = (int)job->scene->scheme;
    WrVectorDrawing *ink = wr_vector_drawing_new(path, o->drawing_w, o->drawing_h, 1, err);
    if (!ink) return false;
    Chart chart = { .x0 = 4.5 * SIZE,
                    .y0 = 2.0 * SIZE,
                    .x1 = o->drawing_w - 1.5 * SIZE,
                    .y1 = o->drawing_h - 3.5 * SIZE };
    chart.samples = 2 * o->drawing_w + 1;
    chart.f = wr_alloc((size_t)chart.samples, sizeof *chart.f);
    sample(job, &chart);
    job->report.low = chart.low;
    job->report.high = chart.high;
    job->report.width = o->drawing_w;
    job->report.height = o->drawing_h;
    job->report.lines = 1;
    give_room(&chart);
    draw_grid(o, ink, &chart);
    draw_curve(o, ink, &chart);
    bool good =
        wr_progress_stopped() ? wr_fail(err, "cancelled") : wr_vector_drawing_write(ink, err);
    wr_vector_drawing_free(ink);
    wr_free(chart.f);
    return good;
}
