/* vector_drawing_internal.h - state of a drawing, and its vector formats.
   Private to this module. */
#pragma once
#include "base/text.h"
#include "export/vector_drawing.h"

#include <stddef.h>

/* One format. Numbers are written by wr_vector_drawing_number; y points down. */
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
    int width, height;
    double breadth, darkness;
    const WrVectorDrawingVectors *vectors; /* NULL: a picture */
    bool drawing;                          /* vectors: a path is open */
    WrText text;                           /* vectors: the file so far */
    size_t stream;                         /* PDF: offset of the page's content in it */
    float *ink;                            /* pictures: [height][width] darkness 0..1 */
};

int wr_vector_drawing_grey(const WrVectorDrawing *ink);        /* sRGB code of the pen */
void wr_vector_drawing_number(WrVectorDrawing *ink, double x); /* rounded to a hundredth */
