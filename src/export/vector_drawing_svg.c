/* SVG: one path element for all lines of one pen. */
#include "export/vector_drawing_internal.h"

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
    const int grey = wr_vector_drawing_grey(ink);
    wr_text_addf(&ink->text,
                 "<path fill=\"none\" stroke=\"#%02x%02x%02x\" stroke-linecap=\"round\" "
                 "stroke-linejoin=\"round\" stroke-width=\"",
                 grey, grey, grey);
    wr_text_add_number(&ink->text, ink->breadth);
    wr_text_add(&ink->text, "\" d=\"");
}

static void place(WrVectorDrawing *ink, bool first, const WrVectorDrawingPoint *p)
{
    wr_text_add(&ink->text, first ? "M" : "L");
    wr_vector_drawing_number(ink, p->x);
    wr_text_add(&ink->text, " ");
    wr_vector_drawing_number(ink, p->y);
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
    wr_vector_drawing_number(ink, size);
    wr_text_add(&ink->text, "\" x=\"");
    wr_vector_drawing_number(ink, x);
    wr_text_add(&ink->text, "\" y=\"");
    wr_vector_drawing_number(ink, y);
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
