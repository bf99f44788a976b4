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

/* Creates a drawing of width x height pixels: vectors if `path` ends in svg or pdf, else a picture.
   channels: 1 for grey, 3 for colours. NULL and an error if the picture format does not support 8 bits of that many
   channels, or if memory is exhausted. The caller owns the drawing. */
WrVectorDrawing *wr_vector_drawing_new(const char *path, int width, int height, int channels,
                                       WrError *err);
void wr_vector_drawing_free(WrVectorDrawing *drawing); /* NULL is allowed */

/* Sets the width (pixels) and the darkness (0 white .. 1 black, linear) of the lines and texts that follow. */
void wr_vector_drawing_pen(WrVectorDrawing *drawing, double pen_width, double darkness);
/* Sets the width (pixels) and the colour (sRGB 0xrrggbb) of the lines and texts that follow. Drawings of 3
   channels only. */
void wr_vector_drawing_colour(WrVectorDrawing *drawing, double pen_width, uint32_t rgb);
/* Draws a line with round ends through count >= 1 points; two equal points are a disc. */
void wr_vector_drawing_line(WrVectorDrawing *drawing, const WrVectorDrawingPoint *points,
                            int count);
/* Draws text with its baseline at y. size: em in pixels. anchor: 0 begins at x, 0.5 is centred, 1 ends at x. Text in an
   SVG file is black. Pictures omit text if no font is installed. */
void wr_vector_drawing_word(WrVectorDrawing *drawing, const char *word, double x, double y,
                            double size, double anchor);

/* Writes the file atomically. */
bool wr_vector_drawing_write(WrVectorDrawing *drawing, WrError *err);
