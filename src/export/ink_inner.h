/* ink_inner.h - a sheet, and the formats of vectors that it can be.
   Private to this room. */
#pragma once
#include "base/text.h"
#include "export/ink.h"

#include <stddef.h>

/* One format. Numbers go through wr_ink_number; y runs down. */
typedef struct WrInkVectors {
    const char *ending;
    void (*head)(WrInk *ink);
    void (*begin_path)(WrInk *ink); /* of the pen at hand */
    void (*place)(WrInk *ink, bool first, const WrInkPoint *p);
    void (*end_line)(WrInk *ink);
    void (*end_path)(WrInk *ink);
    void (*word)(WrInk *ink, const char *word, double x, double y, double size, double anchor);
    void (*tail)(WrInk *ink);
} WrInkVectors;

extern const WrInkVectors wr_ink_svg, wr_ink_pdf;

struct WrInk {
    char *path;
    int width, height;
    double breadth, darkness;
    const WrInkVectors *vectors; /* NULL: a picture */
    bool drawing;                /* vectors: a path is open */
    WrText text;                 /* vectors: the file so far */
    size_t stream;               /* PDF: where the page's drawing begins in it */
    float *ink;                  /* pictures: [height][width] darkness 0..1 */
};

int wr_ink_grey(const WrInk *ink);        /* the sRGB code of the pen */
void wr_ink_number(WrInk *ink, double x); /* to a hundredth */
