/* vector_drawing.h - line drawing with text on white, as an SVG or PDF file or as an antialiased picture. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;

/* Pixels from the top left. */
typedef struct WrVectorDrawingPoint {
    float x, y;
} WrVectorDrawingPoint;

typedef struct WrVectorDrawing WrVectorDrawing;

/* Creates a drawing of width x height pixels: vectors if `path` ends in svg or pdf, else a picture, whose format
   must support 8 bits of as many channels: 1, grey, or 3, colours. NULL and an error otherwise, or without memory.
   The caller owns it. */
WrVectorDrawing *wr_vector_drawing_new(const char *path, int width, int height, int channels,
                                       WrError *err);
void wr_vector_drawing_free(WrVectorDrawing *ink); /* NULL is fine */

/* Sets width, pixels, and darkness 0..1 of the following lines. */
void wr_vector_drawing_pen(WrVectorDrawing *ink, double breadth, double darkness);
/* The same with a colour, sRGB 0xrrggbb, for drawings of 3 channels. */
void wr_vector_drawing_colour(WrVectorDrawing *ink, double breadth, uint32_t rgb);
/* Draws a line with round ends through count >= 1 points; two equal points are a disc. */
void wr_vector_drawing_line(WrVectorDrawing *ink, const WrVectorDrawingPoint *points, int count);
/* Draws text of that size (em, pixels) with the baseline at y; anchor 0 begins at x, 1 ends there. Black in an SVG
   file. Pictures omit text if no font is installed. */
void wr_vector_drawing_word(WrVectorDrawing *ink, const char *word, double x, double y, double size,
                            double anchor);

/* Writes the file atomically. */
bool wr_vector_drawing_write(WrVectorDrawing *ink, WrError *err);
