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

/* One format. Numbers are written by vector_drawing_number; y points down. */
typedef struct WrVectorDrawingVectors {
    const char *ending;
    void (*head)(WrVectorDrawing *ink);
    void (*begin_path)(WrVectorDrawing *ink); /* with the current pen */
    void (*place)(WrVectorDrawing *ink, bool first, const WrVectorDrawingPoint *p);
    void (*end_line)(WrVectorDrawing *ink);
    void (*end_path)(WrVectorDrawing *ink);
    void (*word)(WrVectorDrawing *ink, const char *word, double x, double y, double size,
                 double anchor);
    void (*tail)(WrVectorDrawing *ink);
} WrVectorDrawingVectors;

extern const WrVectorDrawingVectors wr_vector_drawing_svg, wr_vector_drawing_pdf;

struct WrVectorDrawing {
    char *path;
    int width, height, channels;
    double breadth;
    double darkness[3];                    /* of red, green and blue; linear 0..1 */
    const WrVectorDrawingVectors *vectors; /* NULL: a picture */
    bool drawing;                          /* vectors: a path is open */
    WrText text;                           /* vectors: the file so far */
    size_t stream;                         /* PDF: offset of the page's content in it */
    float *ink;                            /* pictures: [height][width][channels] darkness 0..1 */
};

/* sRGB code of the pen in that channel */
static int vector_drawing_code(const WrVectorDrawing *ink, int channel);
/* rounded to a hundredth */
static void vector_drawing_number(WrVectorDrawing *ink, double x);

/* ---- SVG: one path element for all lines of one pen ---- */

static void head(WrVectorDrawing *ink)
{
    wr_text_addf(&ink->text,
                 "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
                 "viewBox=\"0 0 %d %d\">\n<rect width=\"100%%\" height=\"100%%\" "
                 "fill=\"#fff\"/>\n",
                 ink->width, ink->height, ink->width, ink->height);
}

static void begin_path(WrVectorDrawing *ink)
{
    wr_text_addf(&ink->text,
                 "<path fill=\"none\" stroke=\"#%02x%02x%02x\" stroke-linecap=\"round\" "
                 "stroke-linejoin=\"round\" stroke-width=\"",
                 vector_drawing_code(ink, 0), vector_drawing_code(ink, 1),
                 vector_drawing_code(ink, 2));
    wr_text_add_number(&ink->text, ink->breadth);
    wr_text_add(&ink->text, "\" d=\"");
}

static void place(WrVectorDrawing *ink, bool first, const WrVectorDrawingPoint *p)
{
    wr_text_add(&ink->text, first ? "M" : "L");
    vector_drawing_number(ink, p->x);
    wr_text_add(&ink->text, " ");
    vector_drawing_number(ink, p->y);
}

static void end_line(WrVectorDrawing *ink)
{
    wr_text_add(&ink->text, "\n");
}

static void end_path(WrVectorDrawing *ink)
{
    wr_text_add(&ink->text, "\"/>\n");
}

static void word(WrVectorDrawing *ink, const char *word, double x, double y, double size,
                 double anchor)
{
    wr_text_add(&ink->text, "<text font-family=\"Inter, sans-serif\" font-size=\"");
    vector_drawing_number(ink, size);
    wr_text_add(&ink->text, "\" x=\"");
    vector_drawing_number(ink, x);
    wr_text_add(&ink->text, "\" y=\"");
    vector_drawing_number(ink, y);
    wr_text_addf(&ink->text, "\" text-anchor=\"%s\">",
                 anchor > 0.75   ? "end"
                 : anchor > 0.25 ? "middle"
                                 : "start");
    for (; *word; word++) {
        const char *escape = *word == '<'   ? "&lt;"
                             : *word == '>' ? "&gt;"
                             : *word == '&' ? "&amp;"
                                            : NULL;
        if (escape) wr_text_add(&ink->text, escape);
        else wr_text_add_n(&ink->text, word, 1);
    }
    wr_text_add(&ink->text, "</text>\n");
}

static void tail(WrVectorDrawing *ink)
{
    wr_text_add(&ink->text, "</svg>\n");
}

const WrVectorDrawingVectors wr_vector_drawing_svg = { "svg",    head,     begin_path, place,
                                                       end_line, end_path, word,       tail };

/* ---- pdf ---- */

/* PDF, version 1.4: one page, a pixel is 1/96 inch as in SVG, Helvetica for text, nothing compressed. */

#define POINTS 0.75 /* per pixel */

/* Helvetica's advance widths of the characters from space to tilde, in thousandths of the size: Adobe's metrics. */
static const short advances[95] = {
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333,  278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
    611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667,  611, 722, 667, 944, 667,
    667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278,  556, 556, 222, 222, 500,
    222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500,  500, 334, 260, 334, 584
};

enum { CATALOG = 1, PAGES, PAGE, FONT, DRAWING, LENGTH, OBJECTS };

/* Objects are written in the order of their numbers; their offsets are found at the end. */
static void begin_object(WrVectorDrawing *ink, int number)
{
    wr_text_addf(&ink->text, "%d 0 obj\n", number);
}

static void head_pdf(WrVectorDrawing *ink)
{
    WrText *text = &ink->text;
    wr_text_add(text, "%PDF-1.4\n%\xe2\xe3\xcf\xd3\n");
    begin_object(ink, CATALOG);
    wr_text_addf(text, "<< /Type /Catalog /Pages %d 0 R >>\nendobj\n", PAGES);
    begin_object(ink, PAGES);
    wr_text_addf(text, "<< /Type /Pages /Kids [%d 0 R] /Count 1 >>\nendobj\n", PAGE);
    begin_object(ink, PAGE);
    wr_text_addf(text, "<< /Type /Page /Parent %d 0 R /MediaBox [0 0 ", PAGES);
    vector_drawing_number(ink, POINTS * ink->width);
    wr_text_add(text, " ");
    vector_drawing_number(ink, POINTS * ink->height);
    wr_text_addf(text, "] /Resources << /Font << /F %d 0 R >> >> /Contents %d 0 R >>\nendobj\n",
                 FONT, DRAWING);
    begin_object(ink, FONT);
    wr_text_add(text, "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>\nendobj\n");
    begin_object(ink, DRAWING);
    wr_text_addf(text, "<< /Length %d 0 R >>\nstream\n", LENGTH);
    ink->stream = text->length;
    vector_drawing_number(ink, POINTS);
    wr_text_add(text, " 0 0 ");
    vector_drawing_number(ink, -POINTS); /* units from here on: pixels, y down */
    wr_text_add(text, " 0 ");
    vector_drawing_number(ink, POINTS * ink->height);
    wr_text_add(text, " cm\n1 J 1 j\n");
}

static void add_colour(WrVectorDrawing *ink, const char *grey, const char *rgb)
{
    for (int i = 0; i < ink->channels; i++) {
        const int parts = (1000 * vector_drawing_code(ink, i) + 127) / 255;
        wr_text_addf(&ink->text, "%d.%03d ", parts / 1000, parts % 1000);
    }
    wr_text_addf(&ink->text, "%s\n", ink->channels == 1 ? grey : rgb);
}

static void begin_path_pdf(WrVectorDrawing *ink)
{
    vector_drawing_number(ink, ink->breadth);
    wr_text_add(&ink->text, " w ");
    add_colour(ink, "G", "RG");
}

static void place_pdf(WrVectorDrawing *ink, bool first, const WrVectorDrawingPoint *p)
{
    vector_drawing_number(ink, p->x);
    wr_text_add(&ink->text, " ");
    vector_drawing_number(ink, p->y);
    wr_text_add(&ink->text, first ? " m " : " l ");
}

static void end_line_pdf(WrVectorDrawing *ink)
{
    wr_text_add(&ink->text, "S\n");
}

static void end_path_pdf(WrVectorDrawing *ink)
{
    (void)ink;
}

static double advance(const char *word, double size)
{
    double sum = 0.0;
    for (; *word; word++) sum += *word >= ' ' && *word <= '~' ? advances[*word - ' '] : 556;
    return sum * size / 1000.0;
}

static void word_pdf(WrVectorDrawing *ink, const char *word, double x, double y, double size,
                     double anchor)
{
    add_colour(ink, "g", "rg");
    wr_text_add(&ink->text, "BT /F ");
    vector_drawing_number(ink, size);
    wr_text_add(&ink->text, " Tf 1 0 0 -1 ");
    vector_drawing_number(ink, x - anchor * advance(word, size));
    wr_text_add(&ink->text, " ");
    vector_drawing_number(ink, y);
    wr_text_add(&ink->text, " Tm (");
    for (; *word; word++) {
        if (*word == '(' || *word == ')' || *word == '\\') wr_text_add(&ink->text, "\\");
        wr_text_add_n(&ink->text, *word >= ' ' && *word <= '~' ? word : "?", 1);
    }
    wr_text_add(&ink->text, ") Tj ET\n");
}

/* Finds the objects' offsets: each begins a line, and no line of a drawing looks like one. */
static void find_objects(const WrVectorDrawing *ink, size_t at[OBJECTS])
{
    const char *text = wr_text_get(&ink->text);
    size_t from = 0;
    for (int i = CATALOG; i < OBJECTS; i++) {
        char line[24];
        const int length = snprintf(line, sizeof line, "\n%d 0 obj\n", i);
        while (strncmp(text + from, line, (size_t)length) != 0) from++;
        at[i] = from + 1;
    }
}

static void tail_pdf(WrVectorDrawing *ink)
{
    WrText *text = &ink->text;
    size_t at[OBJECTS];
    const size_t length = text->length - ink->stream;
    wr_text_add(text, "endstream\nendobj\n");
    begin_object(ink, LENGTH);
    wr_text_addf(text, "%zu\nendobj\n", length);
    find_objects(ink, at);
    const size_t table = text->length;
    wr_text_addf(text, "xref\n0 %d\n0000000000 65535 f \n", OBJECTS);
    for (int i = CATALOG; i < OBJECTS; i++) wr_text_addf(text, "%010zu 00000 n \n", at[i]);
    wr_text_addf(text, "trailer\n<< /Size %d /Root %d 0 R >>\nstartxref\n%zu\n%%%%EOF\n", OBJECTS,
                 CATALOG, table);
}

const WrVectorDrawingVectors wr_vector_drawing_pdf = { "pdf",     head_pdf,     begin_path_pdf,
                                                       place_pdf, end_line_pdf, end_path_pdf,
                                                       word_pdf,  tail_pdf };

#define LOOK 256 /* pieces of a line between two checks for cancellation */

static const WrVectorDrawingVectors *vectors_of(const char *path)
{
    char buffer[16];
    const char *ending = wr_path_ending(path, buffer);
    if (strcmp(ending, wr_vector_drawing_svg.ending) == 0) return &wr_vector_drawing_svg;
    return strcmp(ending, wr_vector_drawing_pdf.ending) == 0 ? &wr_vector_drawing_pdf : NULL;
}

WrVectorDrawing *wr_vector_drawing_new(const char *path, int width, int height, int channels,
                                       WrError *err)
{
    const WrVectorDrawingVectors *vectors = vectors_of(path);
    float *pixels = NULL;
    if (!vectors) {
        if (!wr_image_can_write(path, WR_PIXEL_U8, channels, false, err)) return NULL;
        pixels = wr_try_alloc((size_t)width * (size_t)height, (size_t)channels * sizeof *pixels,
                              "a drawing", err);
        if (!pixels) return NULL;
    }
    WrVectorDrawing *ink = wr_alloc(1, sizeof *ink);
    *ink = (WrVectorDrawing){ .path = wr_strdup(path),
                              .width = width,
                              .height = height,
                              .channels = channels,
                              .breadth = 1.0,
                              .darkness = { 1.0, 1.0, 1.0 },
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

static void close_path(WrVectorDrawing *ink)
{
    if (ink->drawing) ink->vectors->end_path(ink);
    ink->drawing = false;
}

static int vector_drawing_code(const WrVectorDrawing *ink, int channel)
{
    return (int)rint(255.0 * (double)wr_srgb_encode((float)(1.0 - ink->darkness[channel])));
}

/* Formats without an exponent, which PDF does not support. */
static void vector_drawing_number(WrVectorDrawing *ink, double x)
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

/* Darkens pixel i by that part of the pen's darkness; of overlapping lines the darkest counts in each channel. */
static void ink_pixel(WrVectorDrawing *ink, size_t i, double part)
{
    for (int c = 0; c < ink->channels; c++) {
        const float dark = (float)(ink->darkness[c] * part);
        float *at = &ink->ink[i * (size_t)ink->channels + (size_t)c];
        if (dark > *at) *at = dark;
    }
}

/* Draws a line of the pen's width with an edge one pixel wide. */
static void ink_segment(WrVectorDrawing *ink, const WrVectorDrawingPoint *a,
                        const WrVectorDrawingPoint *b)
{
    double reach = 0.5 * ink->breadth + 0.5;
    double most = ink->breadth < 1.0 ? ink->breadth : 1.0;
    int x0 = clip(floor((a->x < b->x ? a->x : b->x) - reach), ink->width - 1);
    int x1 = clip(ceil((a->x < b->x ? b->x : a->x) + reach), ink->width - 1);
    int y0 = clip(floor((a->y < b->y ? a->y : b->y) - reach), ink->height - 1);
    int y1 = clip(ceil((a->y < b->y ? b->y : a->y) + reach), ink->height - 1);
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            double d = reach - to_segment(x + 0.5, y + 0.5, a, b);
            ink_pixel(ink, (size_t)y * (size_t)ink->width + (size_t)x,
                      most * (d < 0.0   ? 0.0
                              : d > 1.0 ? 1.0
                                        : d));
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
    int from = (int)rint(x - anchor * wr_label_width(label, word));
    wr_label_draw(label, word, from, (int)rint(y) - top, ink->width, 255, grey, ink->width,
                  end - top);
    for (size_t i = 0; i < pixels; i++)
        if (grey[i]) ink_pixel(ink, (size_t)top * (size_t)ink->width + i, grey[i] / 255.0);
    wr_free(grey);
    wr_label_free(label);
}

static bool write_picture(WrVectorDrawing *ink, WrError *err)
{
    size_t wide = (size_t)ink->width * (size_t)ink->channels;
    uint8_t *codes = wr_alloc(wide * (size_t)ink->height, 1);
    bool going = true;
    for (int y = 0; going && y < ink->height; y++) {
        float *row = ink->ink + (size_t)y * wide;
        for (size_t i = 0; i < wide; i++) row[i] = wr_srgb_encode(1.0f - row[i]);
        wr_image_codes(WR_PIXEL_U8, row, wide, codes + (size_t)y * wide, NULL);
        going = !wr_progress_stopped();
    }
    if (!going) wr_fail(err, "cancelled");
    bool good = going && wr_image_write_pixels(ink->path, ink->width, ink->height, ink->channels,
                                               WR_PIXEL_U8, false, codes, err);
    wr_free(codes);
    return good;
}

/* ---- both kinds of drawing ---- */

static void set_pen(WrVectorDrawing *ink, double breadth, const double darkness[3])
{
    if (breadth != ink->breadth || memcmp(darkness, ink->darkness, sizeof ink->darkness) != 0)
        close_path(ink);
    ink->breadth = breadth;
    memcpy(ink->darkness, darkness, sizeof ink->darkness);
}

void wr_vector_drawing_pen(WrVectorDrawing *ink, double breadth, double darkness)
{
    set_pen(ink, breadth, (const double[3]){ darkness, darkness, darkness });
}

void wr_vector_drawing_colour(WrVectorDrawing *ink, double breadth, uint32_t rgb)
{
    double darkness[3];
    for (int i = 0; i < 3; i++)
        darkness[i] = 1.0 - (double)wr_srgb_decode((float)(rgb >> (16 - 8 * i) & 255) / 255.0f);
    set_pen(ink, breadth, darkness);
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
        close_path(ink);
        ink->vectors->word(ink, word, x, y, size, anchor);
    } else {
        ink_word(ink, word, x, y, size, anchor);
    }
}

bool wr_vector_drawing_write(WrVectorDrawing *ink, WrError *err)
{
    if (!ink->vectors) return write_picture(ink, err);
    close_path(ink);
    ink->vectors->tail(ink);
    return wr_file_write(ink->path, wr_text_get(&ink->text), ink->text.length, err);
}
