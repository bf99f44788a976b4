/* Line drawings of the cell as files: SVG, PDF, or a picture of antialiased lines. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "export/vector_drawing.h"
#include "export/job.h"
#include "export/line_drawing.h"

#include <math.h>

#define RELIEF 0.2 /* cells: default height of the drawn relief */

/* Reads all heights, row by row, and stores their range in the report. Returns the width of the range. */
static double read_heights(WrExportJob *job, float *heights)
{
    float low = INFINITY, high = -INFINITY;
    for (int y = 0; y < job->height && !wr_progress_stopped(); y++) {
        float *row = heights + (size_t)y * (size_t)job->width;
        job->report.replaced += wr_export_heights(job, y, 1, row);
        for (int x = 0; x < job->width; x++) {
            low = row[x] < low ? row[x] : low;
            high = row[x] > high ? row[x] : high;
        }
    }
    job->report.low = low;
    job->report.high = high;
    return (double)high - (double)low;
}

static bool draw(WrExportJob *job, WrDrawing *drawing, WrError *err)
{
    const WrExportOptions *o = &job->options;
    size_t texels = (size_t)job->width * (size_t)job->height;
    float *heights = wr_try_alloc(texels, sizeof *heights, "a table's heights", err);
    if (!heights) return false;
    double range = read_heights(job, heights);
    WrLinesView view = { .lines_u = o->lines_u,
                         .lines_v = o->lines_v,
                         .turn_deg = o->turn_deg,
                         .tilt_deg = o->tilt_deg,
                         .hidden = o->hidden,
                         .width = o->drawing_w,
                         .height = o->drawing_h };
    view.relief = o->relief != 0.0 ? o->relief : range > 0.0 ? RELIEF / range : 1.0;
    bool good = wr_lines_draw(heights, job->width, job->height, &view, NULL, drawing, err);
    wr_free(heights);
    return good;
}

bool wr_export_drawing_write(WrExportJob *job, const char *path, WrError *err)
{
    const WrExportOptions *o = &job->options;
    WrDrawing drawing;
    WrProgressPart part;
    const WrProgress *whole = wr_progress_enter(&part, 0.0, 0.7);
    bool drawn = draw(job, &drawing, err);
    wr_progress_set(whole);
    if (!drawn) return false;
    wr_progress_enter(&part, 0.7, 1.0);
    job->report.width = o->drawing_w;
    job->report.height = o->drawing_h;
    job->report.lines = drawing.stretch_count;
    WrVectorDrawing *ink = wr_vector_drawing_new(path, o->drawing_w, o->drawing_h, err);
    if (ink) {
        wr_vector_drawing_pen(ink, o->pen, 1.0);
        for (int s = 0; s < drawing.stretch_count && !wr_progress_stopped(); s++)
            wr_vector_drawing_line(ink, drawing.points + drawing.stretches[s].first,
                                   drawing.stretches[s].count);
    }
    bool good = ink && (!wr_progress_stopped() || wr_fail(err, "cancelled")) &&
                wr_vector_drawing_write(ink, err);
    wr_progress_set(whole);
    wr_vector_drawing_free(ink);
    wr_drawing_fini(&drawing);
    return good;
}
