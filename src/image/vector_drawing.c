#include "image/vector_drawing.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "image/caption.h"
#include "image/image.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#define CHECK_INTERVAL 256 /* segments of a line between two checks for cancellation */

/* One vector format. Coordinates are pixels, y points down; numbers are written by add_number. */
typedef struct VectorFormat {
    const char *ending;
    void (*head)(WrVectorDrawing *drawing);
    void (*begin_path)(WrVectorDrawing *drawing); /* with the current pen */
    void (*place)(WrVectorDrawing *drawing, bool first, const WrVectorDrawingPoint *p);
    void (*end_line)(WrVectorDrawing *drawing);
    void (*end_path)(WrVectorDrawing *drawing);
    void (*word)(WrVectorDrawing *drawing, const char *word, double x, double y, double size,
                 double anchor);
    void (*tail)(WrVectorDrawing *drawing);
} VectorFormat;

struct WrVectorDrawing {
    char *path;
    int width, height, channels;
    double pen_width;           /* pixels */
    double darkness[3];         /* of red, green and blue; linear 0..1 */
    const VectorFormat *format; /* NULL: a picture */
    bool path_open;             /* vectors */
    WrText text;                /* vectors: the file so far */
    size_t stream;              /* PDF: offset of the page's content in it */
    float *pixels;              /* pictures: [height][width][channels] darkness 0..1 */
};

/* ---- pen and numbers ---- */

/* sRGB code of the pen in a channel. */
static int pen_code(const WrVectorDrawing *drawing, int channel)
{
    return (int)rint(255.0 * (double)wr_srgb_encode((float)(1.0 - drawing->darkness[channel])));
}

/* Rounds to a hundredth and writes no exponent, which PDF does not support. */
static void add_number(WrVectorDrawing *drawing, double x)
{
    const long long parts = llrint(100.0 * fabs(x));
    const int tenth = (int)(parts / 10 % 10), hundredth = (int)(parts % 10);
    wr_text_addf(&drawing->text, "%s%lld", x < 0 && parts ? "-" : "", parts / 100);
    if (hundredth) wr_text_addf(&drawing->text, ".%d%d", tenth, hundredth);
    else if (tenth) wr_text_addf(&drawing->text, ".%d", tenth);
}

/* ---- SVG: one path element for all lines of one pen ---- */

static void head_svg(WrVectorDrawing *drawing)
{
    wr_text_addf(&drawing->text,
                 "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
                 "viewBox=\"0 0 %d %d\">\n<rect width=\"100%%\" height=\"100%%\" "
                 "fill=\"#fff\"/>\n",
                 drawing->width, drawing->height, drawing->width, drawing->height);
}

static void begin_path_svg(WrVectorDrawing *drawing)
{
    wr_text_addf(&drawing->text,
                 "<path fill=\"none\" stroke=\"#%02x%02x%02x\" stroke-linecap=\"round\" "
                 "stroke-linejoin=\"round\" stroke-width=\"",
                 pen_code(drawing, 0), pen_code(drawing, 1), pen_code(drawing, 2));
    wr_text_add_number(&drawing->text, drawing->pen_width);
    wr_text_add(&drawing->text, "\" d=\"");
}

static void place_svg(WrVectorDrawing *drawing, bool first, const WrVectorDrawingPoint *p)
{
    wr_text_add(&drawing->text, first ? "M" : "L");
    add_number(drawing, p->x);
    wr_text_add(&drawing->text, " ");
    add_number(drawing, p->y);
}

static void end_line_svg(WrVectorDrawing *drawing)
{
    wr_text_add(&drawing->text, "\n");
}

static void end_path_svg(WrVectorDrawing *drawing)
{
    wr_text_add(&drawing->text, "\"/>\n");
}

static void word_svg(WrVectorDrawing *drawing, const char *word, double x, double y, double size,
                     double anchor)
{
    wr_text_add(&drawing->text, "<text font-family=\"Inter, sans-serif\" font-size=\"");
    add_number(drawing, size);
    wr_text_add(&drawing->text, "\" x=\"");
    add_number(drawing, x);
    wr_text_add(&drawing->text, "\" y=\"");
    add_number(drawing, y);
    wr_text_addf(&drawing->text, "\" text-anchor=\"%s\">",
                 anchor > 0.75   ? "end"
                 : anchor > 0.25 ? "middle"
                                 : "start");
    for (; *word; word++) {
        const char *escape = *word == '<'   ? "&lt;"
                             : *word == '>' ? "&gt;"
                             : *word == '&' ? "&amp;"
                                            : NULL;
        if (escape) wr_text_add(&drawing->text, escape);
        else wr_text_add_n(&drawing->text, word, 1);
    }
    wr_text_add(&drawing->text, "</text>\n");
}

static void tail_svg(WrVectorDrawing *drawing)
{
    wr_text_add(&drawing->text, "</svg>\n");
}

static const VectorFormat svg_format = { "svg",        head_svg,     begin_path_svg, place_svg,
                                         end_line_svg, end_path_svg, word_svg,       tail_svg };

/* ---- PDF ---- */

/* Version 1.4: one page, a pixel is 1/96 inch as in SVG, Helvetica for text, nothing compressed. */

#define POINTS_PER_PIXEL 0.75

/* Helvetica's advance widths of the characters from space to tilde, in thousandths of the size: Adobe's metrics. */
static const short advances[95] = {
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333,  278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
    611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667,  611, 722, 667, 944, 667,
    667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278,  556, 556, 222, 222, 500,
    222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500,  500, 334, 260, 334, 584
};

/* Objects of the file, numbered in their order: catalog -> pages -> page -> font and content stream; the stream's length is
   an object after it, since it is unknown when the stream begins. The xref table has lines of exactly 20 bytes: a 10-digit
   offset, a generation, n or f. */
enum { CATALOG = 1, PAGES, PAGE, FONT, DRAWING, LENGTH, OBJECTS };

/* Objects are written in the order of their numbers; their offsets are found at the end. */
static void begin_object(WrVectorDrawing *drawing, int number)
{
    wr_text_addf(&drawing->text, "%d 0 obj\n", number);
}

static void head_pdf(WrVectorDrawing *drawing)
{
    WrText *text = &drawing->text;
    /* The four bytes above 127 in a comment mark the file as binary for transfer programs (ISO 32000, 7.5.2). */
    wr_text_add(text, "%PDF-1.4\n%\xe2\xe3\xcf\xd3\n");
    begin_object(drawing, CATALOG);
    wr_text_addf(text, "<< /Type /Catalog /Pages %d 0 R >>\nendobj\n", PAGES);
    begin_object(drawing, PAGES);
    wr_text_addf(text, "<< /Type /Pages /Kids [%d 0 R] /Count 1 >>\nendobj\n", PAGE);
    begin_object(drawing, PAGE);
    wr_text_addf(text, "<< /Type /Page /Parent %d 0 R /MediaBox [0 0 ", PAGES);
    add_number(drawing, POINTS_PER_PIXEL * drawing->width);
    wr_text_add(text, " ");
    add_number(drawing, POINTS_PER_PIXEL * drawing->height);
    wr_text_addf(text, "] /Resources << /Font << /F %d 0 R >> >> /Contents %d 0 R >>\nendobj\n",
                 FONT, DRAWING);
    begin_object(drawing, FONT);
    wr_text_add(text, "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>\nendobj\n");
    begin_object(drawing, DRAWING);
    wr_text_addf(text, "<< /Length %d 0 R >>\nstream\n", LENGTH);
    drawing->stream = text->length;
    add_number(drawing, POINTS_PER_PIXEL);
    wr_text_add(text, " 0 0 ");
    add_number(drawing, -POINTS_PER_PIXEL); /* units from here on: pixels, y down */
    wr_text_add(text, " 0 ");
    add_number(drawing, POINTS_PER_PIXEL * drawing->height);
    wr_text_add(text, " cm\n1 J 1 j\n");
}

static void add_colour(WrVectorDrawing *drawing, const char *grey, const char *rgb)
{
    for (int i = 0; i < drawing->channels; i++) {
        const int parts = (1000 * pen_code(drawing, i) + 127) / 255;
        wr_text_addf(&drawing->text, "%d.%03d ", parts / 1000, parts % 1000);
    }
    wr_text_addf(&drawing->text, "%s\n", drawing->channels == 1 ? grey : rgb);
}

static void begin_path_pdf(WrVectorDrawing *drawing)
{
    add_number(drawing, drawing->pen_width);
    wr_text_add(&drawing->text, " w ");
    add_colour(drawing, "G", "RG");
}

static void place_pdf(WrVectorDrawing *drawing, bool first, const WrVectorDrawingPoint *p)
{
    add_number(drawing, p->x);
    wr_text_add(&drawing->text, " ");
    add_number(drawing, p->y);
    wr_text_add(&drawing->text, first ? " m " : " l ");
}

static void end_line_pdf(WrVectorDrawing *drawing)
{
    wr_text_add(&drawing->text, "S\n");
}

static void end_path_pdf(WrVectorDrawing *drawing)
{
    (void)drawing;
}

static double advance(const char *word, double size)
{
    double sum = 0.0;
    for (; *word; word++) sum += *word >= ' ' && *word <= '~' ? advances[*word - ' '] : 556;
    return sum * size / 1000.0;
}

static void word_pdf(WrVectorDrawing *drawing, const char *word, double x, double y, double size,
                     double anchor)
{
    add_colour(drawing, "g", "rg");
    wr_text_add(&drawing->text, "BT /F ");
    add_number(drawing, size);
    wr_text_add(&drawing->text, " Tf 1 0 0 -1 ");
    add_number(drawing, x - anchor * advance(word, size));
    wr_text_add(&drawing->text, " ");
    add_number(drawing, y);
    wr_text_add(&drawing->text, " Tm (");
    for (; *word; word++) {
        if (*word == '(' || *word == ')' || *word == '\\') wr_text_add(&drawing->text, "\\");
        wr_text_add_n(&drawing->text, *word >= ' ' && *word <= '~' ? word : "?", 1);
    }
    wr_text_add(&drawing->text, ") Tj ET\n");
}

/* Finds the offsets of the objects: "N 0 obj" is a line of its own, and no other line of the file equals it. */
static void find_objects(const WrVectorDrawing *drawing, size_t at[OBJECTS])
{
    const char *text = wr_text_get(&drawing->text);
    size_t from = 0;
    for (int i = CATALOG; i < OBJECTS; i++) {
        char line[24];
        const int length = snprintf(line, sizeof line, "\n%d 0 obj\n", i);
        while (strncmp(text + from, line, (size_t)length) != 0) from++;
        at[i] = from + 1;
    }
}

static void tail_pdf(WrVectorDrawing *drawing)
{
    WrText *text = &drawing->text;
    size_t at[OBJECTS];
    const size_t length = text->length - drawing->stream;
    wr_text_add(text, "endstream\nendobj\n");
    begin_object(drawing, LENGTH);
    wr_text_addf(text, "%zu\nendobj\n", length);
    find_objects(drawing, at);
    const size_t table = text->length;
    wr_text_addf(text, "xref\n0 %d\n0000000000 65535 f \n", OBJECTS);
    for (int i = CATALOG; i < OBJECTS; i++) wr_text_addf(text, "%010zu 00000 n \n", at[i]);
    wr_text_addf(text, "trailer\n<< /Size %d /Root %d 0 R >>\nstartxref\n%zu\n%%%%EOF\n", OBJECTS,
                 CATALOG, table);
}

static const VectorFormat pdf_format = { "pdf",        head_pdf,     begin_path_pdf, place_pdf,
                                         end_line_pdf, end_path_pdf, word_pdf,       tail_pdf };

/* ---- new and free ---- */

static const VectorFormat *format_of(const char *path)
{
    char buffer[16];
    const char *ending = wr_path_ending(path, buffer);
    if (strcmp(ending, svg_format.ending) == 0) return &svg_format;
    return strcmp(ending, pdf_format.ending) == 0 ? &pdf_format : NULL;
}

WrVectorDrawing *wr_vector_drawing_new(const char *path, int width, int height, int channels,
                                       WrError *err)
{
    const VectorFormat *format = format_of(path);
    float *pixels = NULL;
    if (!format) {
        if (!wr_image_can_write(path, WR_PIXEL_U8, channels, false, err)) return NULL;
        pixels = wr_try_alloc((size_t)width * (size_t)height, (size_t)channels * sizeof *pixels,
                              "a drawing", err);
        if (!pixels) return NULL;
    }
    WrVectorDrawing *drawing = wr_alloc(1, sizeof *drawing);
    *drawing = (WrVectorDrawing){ .path = wr_strdup(path),
                                  .width = width,
                                  .height = height,
                                  .channels = channels,
                                  .pen_width = 1.0,
                                  .darkness = { 1.0, 1.0, 1.0 },
                                  .format = format,
                                  .pixels = pixels };
    if (format) format->head(drawing);
    return drawing;
}

void wr_vector_drawing_free(WrVectorDrawing *drawing)
{
    if (!drawing) return;
    wr_free(drawing->path);
    wr_free(drawing->pixels);
    wr_text_fini(&drawing->text);
    wr_free(drawing);
}

/* ---- vectors ---- */

static void close_path(WrVectorDrawing *drawing)
{
    if (drawing->path_open) drawing->format->end_path(drawing);
    drawing->path_open = false;
}

/* True if b is on the straight line from a to c, within a fiftieth of a pixel. */
static bool is_straight(const WrVectorDrawingPoint *a, const WrVectorDrawingPoint *b,
                        const WrVectorDrawingPoint *c)
{
    double dx = c->x - a->x, dy = c->y - a->y, ex = b->x - a->x, ey = b->y - a->y;
    double length2 = dx * dx + dy * dy, across = dx * ey - dy * ex, along = dx * ex + dy * ey;
    return across * across <= 0.0004 * length2 && along >= 0.0 && along <= length2;
}

static void vector_line(WrVectorDrawing *drawing, const WrVectorDrawingPoint *p, int count)
{
    if (!drawing->path_open) drawing->format->begin_path(drawing);
    drawing->path_open = true;
    drawing->format->place(drawing, true, p);
    for (int i = 1, from = 0; i < count; i++) {
        if (i + 1 < count && is_straight(p + from, p + i, p + i + 1)) continue;
        drawing->format->place(drawing, false, p + i);
        from = i;
    }
    drawing->format->end_line(drawing);
}

/* ---- pictures ---- */

/* Distance from (x,y) to the segment ab. */
static double segment_distance(double x, double y, const WrVectorDrawingPoint *a,
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

/* Whole part of x, limited to 0..most. */
static int clip(double x, int most)
{
    return x < 0.0 ? 0 : x > most ? most : (int)x;
}

/* Darkens pixel i by a part (0..1) of the pen's darkness. Where lines overlap, each channel keeps the darkest value. */
static void ink_pixel(WrVectorDrawing *drawing, size_t i, double part)
{
    for (int c = 0; c < drawing->channels; c++) {
        const float dark = (float)(drawing->darkness[c] * part);
        float *at = &drawing->pixels[i * (size_t)drawing->channels + (size_t)c];
        if (dark > *at) *at = dark;
    }
}

/* Draws a line of the pen's width with an edge one pixel wide. */
static void ink_segment(WrVectorDrawing *drawing, const WrVectorDrawingPoint *a,
                        const WrVectorDrawingPoint *b)
{
    double reach = 0.5 * drawing->pen_width + 0.5;
    double most = drawing->pen_width < 1.0 ? drawing->pen_width : 1.0;
    int x0 = clip(floor((a->x < b->x ? a->x : b->x) - reach), drawing->width - 1);
    int x1 = clip(ceil((a->x < b->x ? b->x : a->x) + reach), drawing->width - 1);
    int y0 = clip(floor((a->y < b->y ? a->y : b->y) - reach), drawing->height - 1);
    int y1 = clip(ceil((a->y < b->y ? b->y : a->y) + reach), drawing->height - 1);
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            double d = reach - segment_distance(x + 0.5, y + 0.5, a, b);
            ink_pixel(drawing, (size_t)y * (size_t)drawing->width + (size_t)x,
                      most * (d < 0.0   ? 0.0
                              : d > 1.0 ? 1.0
                                        : d));
        }
}

static void ink_word(WrVectorDrawing *drawing, const char *word, double x, double y, double size,
                     double anchor)
{
    WrLabel *label = wr_label_new((int)rint(size), NULL);
    if (!label) return;
    /* rows that the line can touch */
    int top = clip(rint(y) - 2.0 * size, drawing->height),
        end = clip(rint(y) + size, drawing->height);
    size_t pixels = (size_t)drawing->width * (size_t)(end - top);
    uint8_t *grey = wr_alloc(pixels + 1, 1);
    int from = (int)rint(x - anchor * wr_label_width(label, word));
    wr_label_draw(label, word, from, (int)rint(y) - top, drawing->width, 255, grey, drawing->width,
                  end - top);
    for (size_t i = 0; i < pixels; i++)
        if (grey[i]) ink_pixel(drawing, (size_t)top * (size_t)drawing->width + i, grey[i] / 255.0);
    wr_free(grey);
    wr_label_free(label);
}

static bool write_picture(WrVectorDrawing *drawing, WrError *err)
{
    size_t wide = (size_t)drawing->width * (size_t)drawing->channels;
    uint8_t *codes = wr_alloc(wide * (size_t)drawing->height, 1);
    bool going = true;
    for (int y = 0; going && y < drawing->height; y++) {
        float *row = drawing->pixels + (size_t)y * wide;
        for (size_t i = 0; i < wide; i++) row[i] = wr_srgb_encode(1.0f - row[i]);
        wr_image_codes(WR_PIXEL_U8, row, wide, codes + (size_t)y * wide, NULL);
        going = !wr_progress_stopped();
    }
    if (!going) wr_fail(err, "cancelled");
    bool good = going && wr_image_write_pixels(drawing->path, drawing->width, drawing->height,
                                               drawing->channels, WR_PIXEL_U8, false, codes, err);
    wr_free(codes);
    return good;
}

/* ---- both kinds of drawing ---- */

static void set_pen(WrVectorDrawing *drawing, double pen_width, const double darkness[3])
{
    if (pen_width != drawing->pen_width ||
        memcmp(darkness, drawing->darkness, sizeof drawing->darkness) != 0)
        close_path(drawing);
    drawing->pen_width = pen_width;
    memcpy(drawing->darkness, darkness, sizeof drawing->darkness);
}

void wr_vector_drawing_pen(WrVectorDrawing *drawing, double pen_width, double darkness)
{
    set_pen(drawing, pen_width, (const double[3]){ darkness, darkness, darkness });
}

void wr_vector_drawing_colour(WrVectorDrawing *drawing, double pen_width, uint32_t rgb)
{
    double darkness[3];
    for (int i = 0; i < 3; i++)
        darkness[i] = 1.0 - (double)wr_srgb_decode((float)(rgb >> (16 - 8 * i) & 255) / 255.0f);
    set_pen(drawing, pen_width, darkness);
}

void wr_vector_drawing_line(WrVectorDrawing *drawing, const WrVectorDrawingPoint *points, int count)
{
    if (drawing->format) {
        vector_line(drawing, points, count);
        return;
    }
    for (int i = 1; i < count; i++) {
        if (i % CHECK_INTERVAL == 0 && wr_progress_stopped()) return;
        ink_segment(drawing, points + i - 1, points + i);
    }
}

void wr_vector_drawing_word(WrVectorDrawing *drawing, const char *word, double x, double y,
                            double size, double anchor)
{
    if (drawing->format) {
        close_path(drawing);
        drawing->format->word(drawing, word, x, y, size, anchor);
    } else {
        ink_word(drawing, word, x, y, size, anchor);
    }
}

bool wr_vector_drawing_write(WrVectorDrawing *drawing, WrError *err)
{
    if (!drawing->format) return write_picture(drawing, err);
    close_path(drawing);
    drawing->format->tail(drawing);
    return wr_file_write(drawing->path, wr_text_get(&drawing->text), drawing->text.length, err);
}
