/* vector_drawing_internal.h - a sheet, and the formats of vectors that it can be.
   Private to this room. */
#pragma once
#include "base/text.h"
#include "export/vector_drawing.h"

#include <stddef.h>

/* One format. Numbers go through wr_vector_drawing_number; y runs down. */
typedef struct WrVectorDrawingVectors {
    const char *ending;
    void (*head)(WrVectorDrawing *ink);
    void (*begin_path)(WrVectorDrawing *ink); /* of the pen at hand */
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
    size_t stream;                         /* PDF: where the page's drawing begins in it */
    float *ink;                            /* pictures: [height][width] darkness 0..1 */
};

int wr_vector_drawing_grey(const WrVectorDrawing *ink);        /* the sRGB code of the pen */
void wr_vector_drawing_number(WrVectorDrawing *ink, double x); /* to a hundredth */
