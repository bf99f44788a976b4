/* caption.h - small text labels in images: names under samples, numbers on charts.

   Uses a font shipped with the program (Inter, else DejaVu Sans), never a user's; no shaping, so for
   short Latin labels. */
#pragma once
#include <stdint.h>

typedef struct WrError WrError;

typedef struct WrLabel WrLabel;

/* Opens the font at that size (em, pixels, 4..200). NULL and an error if the font is not installed. The
   caller owns it; one thread at a time. */
WrLabel *wr_label_new(int size, WrError *err);
void wr_label_free(WrLabel *label); /* NULL is allowed */

/* Width of UTF-8 text in pixels. Invalid bytes count as '?'. */
int wr_label_width(WrLabel *label, const char *text);
/* Draws text from x to the right on the baseline y with value 0..255 into a grey image, pixels
   [height][width]; parts outside are clipped. Text wider than `room` is shortened with three dots. */
void wr_label_draw(WrLabel *label, const char *text, int x, int y, int room, uint8_t value,
                   uint8_t *pixels, int width, int height);
