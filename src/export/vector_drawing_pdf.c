/* PDF, version 1.4: one page, a pixel is 1/96 inch as in SVG, Helvetica for text, nothing compressed. */
#include "export/vector_drawing_internal.h"

#include <stdio.h>
#include <string.h>

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

static void head(WrVectorDrawing *ink)
{
    WrText *text = &ink->text;
    wr_text_add(text, "%PDF-1.4\n%\xe2\xe3\xcf\xd3\n");
    begin_object(ink, CATALOG);
    wr_text_addf(text, "<< /Type /Catalog /Pages %d 0 R >>\nendobj\n", PAGES);
    begin_object(ink, PAGES);
    wr_text_addf(text, "<< /Type /Pages /Kids [%d 0 R] /Count 1 >>\nendobj\n", PAGE);
    begin_object(ink, PAGE);
    wr_text_addf(text, "<< /Type /Page /Parent %d 0 R /MediaBox [0 0 ", PAGES);
    wr_vector_drawing_number(ink, POINTS * ink->width);
    wr_text_add(text, " ");
    wr_vector_drawing_number(ink, POINTS * ink->height);
    wr_text_addf(text, "] /Resources << /Font << /F %d 0 R >> >> /Contents %d 0 R >>\nendobj\n",
                 FONT, DRAWING);
    begin_object(ink, FONT);
    wr_text_add(text, "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>\nendobj\n");
    begin_object(ink, DRAWING);
    wr_text_addf(text, "<< /Length %d 0 R >>\nstream\n", LENGTH);
    ink->stream = text->length;
    wr_vector_drawing_number(ink, POINTS);
    wr_text_add(text, " 0 0 ");
    wr_vector_drawing_number(ink, -POINTS); /* units from here on: pixels, y down */
    wr_text_add(text, " 0 ");
    wr_vector_drawing_number(ink, POINTS * ink->height);
    wr_text_add(text, " cm\n1 J 1 j\n");
}

static void add_grey(WrVectorDrawing *ink, const char *operator)
{
    const int parts = (1000 * wr_vector_drawing_grey(ink) + 127) / 255;
    wr_text_addf(&ink->text, "%d.%03d %s\n", parts / 1000, parts % 1000, operator);
}

static void begin_path(WrVectorDrawing *ink)
{
    wr_vector_drawing_number(ink, ink->breadth);
    wr_text_add(&ink->text, " w ");
    add_grey(ink, "G");
}

static void place(WrVectorDrawing *ink, bool first, const WrVectorDrawingPoint *p)
{
    wr_vector_drawing_number(ink, p->x);
    wr_text_add(&ink->text, " ");
    wr_vector_drawing_number(ink, p->y);
    wr_text_add(&ink->text, first ? " m " : " l ");
}

static void end_line(WrVectorDrawing *ink)
{
    wr_text_add(&ink->text, "S\n");
}

static void end_path(WrVectorDrawing *ink)
{
    (void)ink;
}

static double advance(const char *word, double size)
{
    double sum = 0.0;
    for (; *word; word++) sum += *word >= ' ' && *word <= '~' ? advances[*word - ' '] : 556;
    return sum * size / 1000.0;
}

static void word(WrVectorDrawing *ink, const char *word, double x, double y, double size,
                 double anchor)
{
    add_grey(ink, "g");
    wr_text_add(&ink->text, "BT /F ");
    wr_vector_drawing_number(ink, size);
    wr_text_add(&ink->text, " Tf 1 0 0 -1 ");
    wr_vector_drawing_number(ink, x - anchor * advance(word, size));
    wr_text_add(&ink->text, " ");
    wr_vector_drawing_number(ink, y);
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

static void tail(WrVectorDrawing *ink)
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

const WrVectorDrawingVectors wr_vector_drawing_pdf = { "pdf",    head,     begin_path, place,
                                                       end_line, end_path, word,       tail };
