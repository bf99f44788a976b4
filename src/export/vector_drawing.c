#include "export/vector_drawing.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "export/vector_drawing_internal.h"
#include "image/image.h"
#include "image/caption.h"

#include <math.h>
#include <string.h>

#define LOOK 256 /* pieces of a line between two checks for cancellation */

static const WrVectorDrawingVectors *vectors_of(const char *path)
{
    char buffer[16];
    const char *ending = wr_path_ending(path, buffer);
    if (strcmp(ending, wr_vector_drawing_svg.ending) == 0) return &wr_vector_drawing_svg;
    return strcmp(ending, wr_vector_drawing_pdf.ending) == 0 ? &wr_vector_drawing_pdf : NULL;
}

WrVectorDrawing *wr_vector_drawing_new(const char *path, int width, int height, WrError *err)
{
    const WrVectorDrawingVectors *vectors = vectors_of(path);
    float *pixels = NULL;
    if (!vectors) {
        if (!wr_image_can_write(path, WR_PIXEL_U8, 1, false, err)) return NULL;
        pixels = wr_try_alloc((size_t)width * (size_t)height, sizeof *pixels, "a drawing", err);
        if (!pixels) return NULL;
    }
    WrVectorDrawing *ink = wr_alloc(1, sizeof *ink);
    *ink = (WrVectorDrawing){ .path = wr_strdup(path),
                              .width = width,
                              .height = height,
                              .breadth = 1.0,
                              .darkness = 1.0,
                              .vectors = vectors,
                              .ink = pixels };
    if (vectors) vectors->head(ink);
    return ink;
}

void wr_vector_drawing_free(WrVectorDrawing *ink)
{
    if (!ink) return;
    wr_free(ink->path);
    wr_free(ink->ink);
    wr_text_fini(&ink->text);
    wr_free(ink);
}

/* ---- vectors ---- */

static void end_path(WrVectorDrawing *ink)
{
    if (ink->drawing) ink->vectors->end_path(ink);
    ink->drawing = false;
}

int wr_vector_drawing_grey(const WrVectorDrawing *ink)
{
    return (int)rint(255.0 * (double)wr_srgb_encode((float)(1.0 - ink->darkness)));
}

/* Formats without an exponent, which PDF does not support. */
void wr_vector_drawing_number(WrVectorDrawing *ink, double x)
{
    const long long parts = llrint(100.0 * fabs(x));
    const int tenth = (int)(parts / 10 % 10), hundredth = (int)(parts % 10);
    wr_text_addf(&ink->text, "%s%lld", x < 0 && parts ? "-" : "", parts / 100);
    if (hundredth) wr_text_addf(&ink->text, ".%d%d", tenth, hundredth);
    else if (tenth) wr_text_addf(&ink->text, ".%d", tenth);
}

/* True if b is on the straight line from a to c, within a fiftieth of a pixel. */
static bool is_straight(const WrVectorDrawingPoint *a, const WrVectorDrawingPoint *b,
                        const WrVectorDrawingPoint *c)
{
    double dx = c->x - a->x, dy = c->y - a->y, ex = b->x - a->x, ey = b->y - a->y;
    double length2 = dx * dx + dy * dy, across = dx * ey - dy * ex, along = dx * ex + dy * ey;
    return across * across <= 0.0004 * length2 && along >= 0.0 && along <= length2;
}

static void vector_line(WrVectorDrawing *ink, const WrVectorDrawingPoint *p, int count)
{
    if (!ink->drawing) ink->vectors->begin_path(ink);
    ink->drawing = true;
    ink->vectors->place(ink, true, p);
    for (int i = 1, from = 0; i < count; i++) {
        if (i + 1 < count && is_straight(p + from, p + i, p + i + 1)) continue;
        ink->vectors->place(ink, false, p + i);
        from = i;
    }
    ink->vectors->end_line(ink);
}

/* ---- pictures ---- */

static double to_segment(double x, double y, const WrVectorDrawingPoint *a,
                         const WrVectorDrawingPoint *b)
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

/* Draws a line of the pen's width with an edge one pixel wide; of overlapping lines the darkest counts. */
static void ink_segment(WrVectorDrawing *ink, const WrVectorDrawingPoint *a,
                        const WrVectorDrawingPoint *b)
{
    double reach = 0.5 * ink->breadth + 0.5;
    double most = ink->darkness * (ink->breadth < 1.0 ? ink->breadth : 1.0);
    int x0 = clip(floor((a->x < b->x ? a->x : b->x) - reach), ink->width - 1);
    int x1 = clip(ceil((a->x < b->x ? b->x : a->x) + reach), ink->width - 1);
    int y0 = clip(floor((a->y < b->y ? a->y : b->y) - reach), ink->height - 1);
    int y1 = clip(ceil((a->y < b->y ? b->y : a->y) + reach), ink->height - 1);
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            double d = reach - to_segment(x + 0.5, y + 0.5, a, b);
            float dark = (float)(most * (d < 0.0 ? 0.0 : d > 1.0 ? 1.0 : d));
            float *at = &ink->ink[(size_t)y * (size_t)ink->width + (size_t)x];
            if (dark > *at) *at = dark;
        }
}

static void ink_word(WrVectorDrawing *ink, const char *word, double x, double y, double size,
                     double anchor)
{
    WrLabel *label = wr_label_new((int)rint(size), NULL);
    if (!label) return;
    /* rows that the line can touch */
    int top = clip(rint(y) - 2.0 * size, ink->height), end = clip(rint(y) + size, ink->height);
    size_t pixels = (size_t)ink->width * (size_t)(end - top);
    uint8_t *grey = wr_alloc(pixels + 1, 1);
    float *under = ink->ink + (size_t)top * (size_t)ink->width;
    int from = (int)rint(x - anchor * wr_label_width(label, word));
    wr_label_draw(label, word, from, (int)rint(y) - top, ink->width, 255, grey, ink->width,
                  end - top);
    for (size_t i = 0; i < pixels; i++) {
        float dark = (float)(ink->darkness * grey[i] / 255.0);
        if (dark > under[i]) under[i] = dark;
    }
    wr_free(grey);
    wr_label_free(label);
}

static bool write_picture(WrVectorDrawing *ink, WrError *err)
{
    size_t wide = (size_t)ink->width;
    uint8_t *codes = wr_alloc(wide * (size_t)ink->height, 1);
    bool going = true;
    for (int y = 0; going && y < ink->height; y++) {
        float *row = ink->ink + (size_t)y * wide;
        for (size_t i = 0; i < wide; i++) row[i] = wr_srgb_encode(1.0f - row[i]);
        wr_image_codes(WR_PIXEL_U8, row, wide, codes + (size_t)y * wide, NULL);
        going = !wr_progress_stopped();
    }
    if (!going) wr_fail(err, "cancelled");
    bool good = going && wr_image_write_pixels(ink->path, ink->width, ink->height, 1, WR_PIXEL_U8,
                                               false, codes, err);
    wr_free(codes);
    return good;
}

/* ---- both kinds of drawing ---- */

void wr_vector_drawing_pen(WrVectorDrawing *ink, double breadth, double darkness)
{
    if (breadth != ink->breadth || darkness != ink->darkness) end_path(ink);
    ink->breadth = breadth;
    ink->darkness = darkness;
}

void wr_vector_drawing_line(WrVectorDrawing *ink, const WrVectorDrawingPoint *points, int count)
{
    if (ink->vectors) {
        vector_line(ink, points, count);
        return;
    }
    for (int i = 1; i < count; i++) {
        if (i % LOOK == 0 && wr_progress_stopped()) return;
        ink_segment(ink, points + i - 1, points + i);
    }
}

void wr_vector_drawing_word(WrVectorDrawing *ink, const char *word, double x, double y, double size,
                            double anchor)
{
    if (ink->vectors) {
        end_path(ink);
        ink->vectors->word(ink, word, x, y, size, anchor);
    } else {
        ink_word(ink, word, x, y, size, anchor);
    }
}

bool wr_vector_drawing_write(WrVectorDrawing *ink, WrError *err)
{
    if (!ink->vectors) return write_picture(ink, err);
    end_path(ink);
    ink->vectors->tail(ink);
    return wr_file_write(ink->path, wr_text_get(&ink->text), ink->text.length, err);
}
