/* vector_drawing.h - black line drawing with text on white, as an SVG or PDF file or as an antialiased picture.
   Private to this module. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;

/* Pixels from the top left. */
typedef struct WrVectorDrawingPoint {
    float x, y;
} WrVectorDrawingPoint;

typedef struct WrVectorDrawing WrVectorDrawing;

/* Creates a drawing of width x height pixels: vectors if `path` ends in svg or pdf, else a picture, whose format
   must support 8-bit grey. NULL and an error otherwise, or without memory. The caller owns it. */
WrVectorDrawing *wr_vector_drawing_new(const char *path, int width, int height, WrError *err);
void wr_vector_drawing_free(WrVectorDrawing *ink); /* NULL is fine */

/* Sets width, pixels, and darkness 0..1 of the following lines. */
void wr_vector_drawing_pen(WrVectorDrawing *ink, double breadth, double darkness);
/* Draws a line through count >= 1 points. */
void wr_vector_drawing_line(WrVectorDrawing *ink, const WrVectorDrawingPoint *points, int count);
/* Draws text of that size (em, pixels) with the baseline at y; anchor 0 begins at x, 1 ends there. Pictures omit
   text if no font is installed. */
void wr_vector_drawing_word(WrVectorDrawing *ink, const char *word, double x, double y, double size,
                            double anchor);

/* Writes the file atomically. */
bool wr_vector_drawing_write(WrVectorDrawing *ink, WrError *err);
