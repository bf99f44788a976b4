/* Lines in space and their visible parts: the surface's quads are drawn into a depth buffer, and a line's
   samples are compared with it. */
#include "export/line_drawing.h"

#include "base/array.h"
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/progress.h"
#include "export/job.h"
#include "image/vector_drawing.h"

#include <math.h>

#define FINE 4      /* depth buffer cells per pixel */
#define MARGIN 0.04 /* of the drawing, on every side */
#define STEP 0.25   /* pixels between samples of a line */
#define CLOSE 0.004 /* cells: the surface hides a line only from this far in front */

typedef struct Sheet {
    const float *heights;
    int columns, rows;
    const WrLinesView *view;
    WrLinesFrame frame;
    float *depth; /* [high][wide], nearest; owned */
    int wide, high;
} Sheet;

/* Parallel projection: (x, y) from the cell's centre and z are turned by the angle t about the vertical and tilted by a:
     right = x cos t - y sin t; up = (x sin t + y cos t) sin a + z cos a; depth = (x sin t + y cos t) cos a - z sin a.
   Depth grows away from the viewer. At a = 90 degrees the view is straight down. */
WrLinesPlace wr_lines_place(const WrLinesFrame *f, double u, double v, double z)
{
    double x = u - 0.5, y = v - 0.5;
    return (WrLinesPlace){ f->left + f->scale * (f->xx * x + f->xy * y),
                           f->top - f->scale * (f->yx * x + f->yy * y + f->yz * z),
                           f->dx * x + f->dy * y + f->dz * z };
}

static double column_u(const Sheet *sheet, double column)
{
    return (column + 0.5) / sheet->columns;
}

static double row_v(const Sheet *sheet, double row)
{
    return 1.0 - (row + 0.5) / sheet->rows;
}

static double height_at(const Sheet *sheet, int column, int row)
{
    return sheet->view->relief *
           (double)sheet->heights[(size_t)row * (size_t)sheet->columns + (size_t)column];
}

static WrLinesPlace vertex(const Sheet *sheet, int column, int row)
{
    return wr_lines_place(&sheet->frame, column_u(sheet, column), row_v(sheet, row),
                          height_at(sheet, column, row));
}

/* Rotation, tilt, and the scale at which the drawing fits into the margins. */
static void find_frame(Sheet *sheet)
{
    const WrLinesView *view = sheet->view;
    double st, ct, sa, ca;
    wr_sincos_turns(view->turn_deg / 360.0, &st, &ct);
    wr_sincos_turns(view->tilt_deg / 360.0, &sa, &ca);
    WrLinesFrame *f = &sheet->frame;
    *f = (WrLinesFrame){ .xx = ct,
                         .xy = -st,
                         .yx = st * sa,
                         .yy = ct * sa,
                         .yz = ca,
                         .dx = st * ca,
                         .dy = ct * ca,
                         .dz = -sa,
                         .scale = 1.0 };
    double low_x = INFINITY, high_x = -INFINITY, low_y = INFINITY, high_y = -INFINITY;
    for (int row = 0; row < sheet->rows && !wr_progress_stopped(); row++)
        for (int column = 0; column < sheet->columns; column++) {
            WrLinesPlace p = vertex(sheet, column, row);
            low_x = p.x < low_x ? p.x : low_x;
            high_x = p.x > high_x ? p.x : high_x;
            low_y = p.y < low_y ? p.y : low_y;
            high_y = p.y > high_y ? p.y : high_y;
        }
    double room_x = view->width * (1.0 - 2.0 * MARGIN),
           room_y = view->height * (1.0 - 2.0 * MARGIN);
    double wide = high_x - low_x, high = high_y - low_y, small = 1e-12;
    double by_x = room_x / (wide > small ? wide : small),
           by_y = room_y / (high > small ? high : small);
    f->scale = by_x < by_y ? by_x : by_y;
    if (f->scale > 1e9) f->scale = 1.0; /* a single point */
    f->left = 0.5 * view->width - f->scale * 0.5 * (low_x + high_x);
    f->top = 0.5 * view->height - f->scale * 0.5 * (low_y + high_y);
}

/* ---- the depth buffer ---- */

static double edge(const WrLinesPlace *a, const WrLinesPlace *b, double x, double y)
{
    return (b->x - a->x) * (y - a->y) - (b->y - a->y) * (x - a->x);
}

static double least(double a, double b, double c)
{
    return a < b ? (a < c ? a : c) : (b < c ? b : c);
}

static int within(double x, int low, int high)
{
    return x < low ? low : x > high ? high : (int)x;
}

/* Edge functions as barycentric weights, at the centres of FINE x FINE cells per pixel; dividing by the signed area makes
   them independent of the orientation. */
static void fill_triangle(Sheet *sheet, WrLinesPlace a, WrLinesPlace b, WrLinesPlace c)
{
    double area = edge(&a, &b, c.x, c.y);
    if (!(fabs(area) > 0.0)) return;
    int x0 = within(floor(FINE * least(a.x, b.x, c.x)), 0, sheet->wide - 1);
    int x1 = within(ceil(-FINE * least(-a.x, -b.x, -c.x)), 0, sheet->wide - 1);
    int y0 = within(floor(FINE * least(a.y, b.y, c.y)), 0, sheet->high - 1);
    int y1 = within(ceil(-FINE * least(-a.y, -b.y, -c.y)), 0, sheet->high - 1);
    for (int j = y0; j <= y1; j++)
        for (int i = x0; i <= x1; i++) {
            double x = (i + 0.5) / FINE, y = (j + 0.5) / FINE;
            double wa = edge(&b, &c, x, y) / area, wb = edge(&c, &a, x, y) / area;
            double wc = 1.0 - wa - wb;
            if (wa < 0.0 || wb < 0.0 || wc < 0.0) continue;
            float depth = (float)(wa * a.depth + wb * b.depth + wc * c.depth);
            float *at = &sheet->depth[(size_t)j * (size_t)sheet->wide + (size_t)i];
            if (depth < *at) *at = depth;
        }
}

static void fill_depth(Sheet *sheet)
{
    size_t cells = (size_t)sheet->wide * (size_t)sheet->high;
    for (size_t i = 0; i < cells; i++) sheet->depth[i] = INFINITY;
    for (int row = 0; row + 1 < sheet->rows && wr_progress_report((double)row / sheet->rows); row++)
        for (int column = 0; column + 1 < sheet->columns; column++) {
            WrLinesPlace a = vertex(sheet, column, row), b = vertex(sheet, column + 1, row);
            WrLinesPlace c = vertex(sheet, column, row + 1), d = vertex(sheet, column + 1, row + 1);
            fill_triangle(sheet, a, b, d);
            fill_triangle(sheet, a, d, c);
        }
}

/* A point is visible unless the surface is in front of it in all cells around: so a line along a fold, whose
   neighbouring cells are half in front and half behind, is visible. Cells beside the surface are ignored, unless
   there are no others. CLOSE is a depth in cells: without it a line, which lies on the surface, would be hidden by its own
   quads' rounding. */
static bool is_seen(const Sheet *sheet, const WrLinesPlace *p)
{
    int i = within(floor(FINE * p->x), 0, sheet->wide - 1);
    int j = within(floor(FINE * p->y), 0, sheet->high - 1);
    bool surface = false;
    for (int y = j > 0 ? j - 1 : 0; y <= j + 1 && y < sheet->high; y++)
        for (int x = i > 0 ? i - 1 : 0; x <= i + 1 && x < sheet->wide; x++) {
            double depth = sheet->depth[(size_t)y * (size_t)sheet->wide + (size_t)x];
            if (isinf(depth)) continue;
            surface = true;
            if (depth >= p->depth - CLOSE) return true;
        }
    return !surface;
}

/* ---- lines ---- */

typedef struct Points {
    WR_ARRAY(WrStretch) stretches;
    WR_ARRAY(WrVectorDrawingPoint) points;
    bool open; /* the last stretch is not finished */
} Points;

static void put_point(Points *out, double x, double y)
{
    wr_array_push(&out->points, ((WrVectorDrawingPoint){ (float)x, (float)y }));
}

static void begin_stretch(Points *out, double x, double y)
{
    wr_array_push(&out->stretches, ((WrStretch){ out->points.count, 1 }));
    put_point(out, x, y);
    out->open = true;
}

static void go_on(Points *out, double x, double y)
{
    put_point(out, x, y);
    out->stretches.data[out->stretches.count - 1].count++;
}

static WrLinesPlace between(const WrLinesPlace *a, const WrLinesPlace *b, double t)
{
    return (WrLinesPlace){ a->x + t * (b->x - a->x), a->y + t * (b->y - a->y),
                           a->depth + t * (b->depth - a->depth) };
}

/* Refines the position where the line from a to b, visible or not at t0, changes: between t0 and t1. */
static double find_change(const Sheet *sheet, const WrLinesPlace *a, const WrLinesPlace *b,
                          double t0, double t1, bool seen)
{
    for (int step = 0; step < 12; step++) {
        double t = 0.5 * (t0 + t1);
        WrLinesPlace p = between(a, b, t);
        if (is_seen(sheet, &p) == seen) t0 = t;
        else t1 = t;
    }
    return 0.5 * (t0 + t1);
}

static void draw_segment(const Sheet *sheet, const WrLinesPlace *a, const WrLinesPlace *b,
                         Points *out)
{
    double length = sqrt((b->x - a->x) * (b->x - a->x) + (b->y - a->y) * (b->y - a->y));
    int steps = 1 + (int)(length / STEP);
    bool all = sheet->view->hidden, seen = all || is_seen(sheet, a);
    if (seen && !out->open) begin_stretch(out, a->x, a->y);
    if (!seen) out->open = false;
    for (int i = 1; i <= steps && !all; i++) {
        double t0 = (double)(i - 1) / steps, t1 = (double)i / steps;
        WrLinesPlace p = between(a, b, t1);
        bool now = is_seen(sheet, &p);
        if (now == seen) continue;
        double t = find_change(sheet, a, b, t0, t1, seen);
        p = between(a, b, t);
        if (now) begin_stretch(out, p.x, p.y);
        else go_on(out, p.x, p.y);
        out->open = seen = now;
    }
    if (seen) go_on(out, b->x, b->y);
}

static void draw_line(const Sheet *sheet, bool along_u, int at, Points *out)
{
    int count = along_u ? sheet->columns : sheet->rows;
    out->open = false;
    WrLinesPlace a = along_u ? vertex(sheet, 0, at) : vertex(sheet, at, 0);
    for (int k = 1; k < count; k++) {
        WrLinesPlace b = along_u ? vertex(sheet, k, at) : vertex(sheet, at, k);
        draw_segment(sheet, &a, &b, out);
        a = b;
    }
}

static void draw_family(const Sheet *sheet, bool along_u, int lines, Points *out)
{
    int places = along_u ? sheet->rows : sheet->columns;
    if (lines > places) lines = places;
    for (int i = 0; i < lines && !wr_progress_stopped(); i++) {
        /* Line i of n lies on texel row round(i (places - 1) / (n - 1)): lines pass through texel centres, where the heights
           are exact, and the first and the last are the table's edges. */
        int at = lines > 1 ? (int)(((int64_t)i * (places - 1) + (lines - 1) / 2) / (lines - 1))
                           : places / 2;
        draw_line(sheet, along_u, at, out);
    }
}

bool wr_lines_draw(const float *heights, int columns, int rows, const WrLinesView *view,
                   WrLinesFrame *frame, WrDrawing *drawing, WrError *err)
{
    Sheet sheet = { .heights = heights,
                    .columns = columns,
                    .rows = rows,
                    .view = view,
                    .wide = view->width * FINE,
                    .high = view->height * FINE };
    Points out = { 0 };
    find_frame(&sheet);
    if (!view->hidden) {
        sheet.depth = wr_try_alloc((size_t)sheet.wide * (size_t)sheet.high, sizeof *sheet.depth,
                                   "a drawing's depth buffer", err);
        if (!sheet.depth) return false;
        fill_depth(&sheet);
    }
    draw_family(&sheet, true, view->lines_u, &out);
    draw_family(&sheet, false, view->lines_v, &out);
    wr_free(sheet.depth);
    if (wr_progress_stopped()) {
        wr_array_free(&out.points);
        wr_array_free(&out.stretches);
        return wr_fail(err, "cancelled");
    }
    if (frame) *frame = sheet.frame;
    *drawing =
        (WrDrawing){ out.points.data, out.stretches.data, out.points.count, out.stretches.count };
    return true;
}

void wr_drawing_fini(WrDrawing *drawing)
{
    wr_free(drawing->points);
    wr_free(drawing->stretches);
    *drawing = (WrDrawing){ 0 };
}

/* ---- Line drawings of the cell as files: SVG, PDF, or a picture of antialiased lines ---- */

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

bool wr_export_line_drawing_write(WrExportJob *job, const char *path, WrError *err)
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
    WrVectorDrawing *ink = wr_vector_drawing_new(path, o->drawing_w, o->drawing_h, 1, err);
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
