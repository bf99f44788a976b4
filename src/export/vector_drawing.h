/* vector_drawing.h - black lines and words on white, as an SVG or PDF file or as a picture of antialiased lines.
   Layer 6. Private to this room. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;

/* Pixels from the top left. */
typedef struct WrVectorDrawingPoint {
    float x, y;
} WrVectorDrawingPoint;

typedef struct WrVectorDrawing WrVectorDrawing;

/* A sheet of width x height pixels; vectors if `path` ends in svg or pdf, else a picture, whose format must hold
 * grey of 8 bits. NULL and an error otherwise, or without memory. The caller owns it. */
WrVectorDrawing *wr_vector_drawing_new(const char *path, int width, int height, WrError *err);
void wr_vector_drawing_free(WrVectorDrawing *ink); /* NULL is fine */

/* Lines of that breadth, pixels, and darkness 0..1 from now on. */
void wr_vector_drawing_pen(WrVectorDrawing *ink, double breadth, double darkness);
/* A line through count >= 1 points. */
void wr_vector_drawing_line(WrVectorDrawing *ink, const WrVectorDrawingPoint *points, int count);
/* A word of that size (em, pixels) with the baseline at y; anchor 0 begins at x, 1 ends there. Pictures go
 * without words where no typeface is installed. */
void wr_vector_drawing_word(WrVectorDrawing *ink, const char *word, double x, double y, double size,
                            double anchor);

/* Write the file as a whole replacement. */
bool wr_vector_drawing_write(WrVectorDrawing *ink, WrError *err);
