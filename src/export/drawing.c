/* Line drawings of the cell as files: SVG, or a picture of antialiased lines. */
#include "base/memory.h"
#include "export/ink.h"
#include "export/job.h"
#include "export/lines.h"

#include <math.h>

#define RELIEF 0.2 /* cells: how high all of it is drawn, unless told */

static bool draw(WrExportJob *job, WrDrawing *drawing, WrError *err)
{
    const WrExportOptions *o = &job->options;
    size_t texels = (size_t)job->width * (size_t)job->height;
    float *heights = wr_try_alloc(texels, sizeof *heights, "a table's heights", err);
    if (!heights) return false;
    job->report.replaced = wr_export_heights(job, 0, job->height, heights);
    float low = heights[0], high = heights[0];
    for (size_t i = 0; i < texels; i++) {
        low = heights[i] < low ? heights[i] : low;
        high = heights[i] > high ? heights[i] : high;
    }
    job->report.low = low;
    job->report.high = high;
    double range = (double)high - (double)low;
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
    if (!draw(job, &drawing, err)) return false;
    job->report.width = o->drawing_w;
    job->report.height = o->drawing_h;
    job->report.lines = drawing.stretch_count;
    WrInk *ink = wr_ink_new(path, o->drawing_w, o->drawing_h, err);
    if (ink) {
        wr_ink_pen(ink, o->pen, 1.0);
        for (int s = 0; s < drawing.stretch_count; s++)
            wr_ink_line(ink, drawing.points + drawing.stretches[s].first,
                        drawing.stretches[s].count);
    }
    bool good = ink && wr_ink_write(ink, err);
    wr_ink_free(ink);
    wr_drawing_fini(&drawing);
    return good;
}
