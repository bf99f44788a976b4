/* Line drawings of the cell as files: SVG, or a picture of antialiased lines. */
#include "base/file.h"
#include "base/memory.h"
#include "export/job.h"
#include "export/lines.h"

#include <math.h>
#include <string.h>

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

/* ---- SVG ---- */

static void add_place(WrText *text, char command, const WrDrawingPoint *p)
{
    char buffer[WR_NUMBER_SIZE];
    wr_text_addf(text, "%c%s ", command,
                 wr_number_print_float((float)(rint(100.0 * (double)p->x) / 100.0), buffer));
    wr_text_add(text, wr_number_print_float((float)(rint(100.0 * (double)p->y) / 100.0), buffer));
}

/* Does b lie on the straight line from a to c, to a fiftieth of a pixel? */
static bool is_straight(const WrDrawingPoint *a, const WrDrawingPoint *b, const WrDrawingPoint *c)
{
    double dx = c->x - a->x, dy = c->y - a->y, ex = b->x - a->x, ey = b->y - a->y;
    double length2 = dx * dx + dy * dy, across = dx * ey - dy * ex, along = dx * ex + dy * ey;
    return across * across <= 0.0004 * length2 && along >= 0.0 && along <= length2;
}

static void svg_text(const WrExportJob *job, const WrDrawing *drawing, WrText *text)
{
    const WrExportOptions *o = &job->options;
    wr_text_addf(text,
                 "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
                 "viewBox=\"0 0 %d %d\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n"
                 "<path fill=\"none\" stroke=\"#000\" stroke-linecap=\"round\" "
                 "stroke-linejoin=\"round\" stroke-width=\"",
                 o->drawing_w, o->drawing_h, o->drawing_w, o->drawing_h);
    wr_text_add_number(text, o->pen);
    wr_text_add(text, "\" d=\"");
    for (int s = 0; s < drawing->stretch_count; s++) {
        const WrDrawingPoint *p = drawing->points + drawing->stretches[s].first;
        int count = drawing->stretches[s].count, from = 0;
        add_place(text, 'M', p);
        for (int i = 1; i < count; i++) {
            bool bends = i + 1 == count || !is_straight(p + from, p + i, p + i + 1);
            if (!bends) continue;
            add_place(text, 'L', p + i);
            from = i;
        }
        wr_text_add(text, "\n");
    }
    wr_text_add(text, "\"/>\n</svg>\n");
}

/* ---- pictures ---- */

static double to_segment(double x, double y, const WrDrawingPoint *a, const WrDrawingPoint *b)
{
    double dx = b->x - a->x, dy = b->y - a->y, ex = x - a->x, ey = y - a->y;
    double length2 = dx * dx + dy * dy;
    double t = length2 > 0.0 ? (ex * dx + ey * dy) / length2 : 0.0;
    t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
    ex -= t * dx;
    ey -= t * dy;
    return sqrt(ex * ex + ey * ey);
}

static int clip(double x, int most)
{
    return x < 0.0 ? 0 : x > most ? most : (int)x;
}

/* Darkness 0..1 of a line of that breadth with an edge a pixel wide; the darkest line wins. */
static void ink_segment(float *ink, int width, int height, const WrDrawingPoint *a,
                        const WrDrawingPoint *b, double pen)
{
    double reach = 0.5 * pen + 0.5, most = pen < 1.0 ? pen : 1.0;
    int x0 = clip(floor((a->x < b->x ? a->x : b->x) - reach), width - 1);
    int x1 = clip(ceil((a->x < b->x ? b->x : a->x) + reach), width - 1);
    int y0 = clip(floor((a->y < b->y ? a->y : b->y) - reach), height - 1);
    int y1 = clip(ceil((a->y < b->y ? b->y : a->y) + reach), height - 1);
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            double d = reach - to_segment(x + 0.5, y + 0.5, a, b);
            float dark = (float)(most * (d < 0.0 ? 0.0 : d > 1.0 ? 1.0 : d));
            float *at = &ink[(size_t)y * (size_t)width + (size_t)x];
            if (dark > *at) *at = dark;
        }
}

static bool write_picture(const WrExportJob *job, const WrDrawing *drawing, const char *path,
                          WrError *err)
{
    const WrExportOptions *o = &job->options;
    int width = o->drawing_w, height = o->drawing_h;
    if (!wr_image_can_write(path, WR_PIXEL_U8, 1, false, err)) return false;
    size_t pixels = (size_t)width * (size_t)height;
    float *ink = wr_try_alloc(pixels, sizeof *ink, "a drawing", err);
    if (!ink) return false;
    for (int s = 0; s < drawing->stretch_count; s++) {
        const WrDrawingPoint *p = drawing->points + drawing->stretches[s].first;
        for (int i = 1; i < drawing->stretches[s].count; i++)
            ink_segment(ink, width, height, p + i - 1, p + i, o->pen);
    }
    uint8_t *codes = wr_alloc(pixels, 1);
    for (size_t i = 0; i < pixels; i++) ink[i] = wr_srgb_encode(1.0f - ink[i]);
    wr_image_codes(WR_PIXEL_U8, ink, pixels, codes, NULL);
    bool good = wr_image_write_pixels(path, width, height, 1, WR_PIXEL_U8, false, codes, err);
    wr_free(codes);
    wr_free(ink);
    return good;
}

bool wr_export_drawing_write(WrExportJob *job, const char *path, WrError *err)
{
    WrDrawing drawing;
    char buffer[16];
    if (!draw(job, &drawing, err)) return false;
    job->report.width = job->options.drawing_w;
    job->report.height = job->options.drawing_h;
    job->report.lines = drawing.stretch_count;
    bool good;
    if (strcmp(wr_path_ending(path, buffer), "svg") == 0) {
        WrText text = { 0 };
        svg_text(job, &drawing, &text);
        good = wr_file_write(path, wr_text_get(&text), text.length, err);
        wr_text_fini(&text);
    } else {
        good = write_picture(job, &drawing, path, err);
    }
    wr_drawing_fini(&drawing);
    return good;
}
