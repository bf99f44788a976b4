/* caption.h - lines of small type in a picture: names under samples, numbers on charts. One of the program's
   own faces (Inter, else DejaVu Sans), never a stranger's; no shaping, so for short Latin labels. */
#pragma once
#include <stdint.h>

typedef struct WrError WrError;

typedef struct WrLabel WrLabel;

/* The face at that size (em, pixels, 4..200). NULL and an error if no face is installed. The caller owns
   it; one thread at a time. */
WrLabel *wr_label_new(int size, WrError *err);
void wr_label_free(WrLabel *label); /* NULL is fine */

/* Pixels from the start of UTF-8 text to its end. What is not UTF-8 counts as '?'. */
int wr_label_width(WrLabel *label, const char *text);
/* Draw it from x rightwards on the baseline y in a value 0..255 over a grey picture, pixels
   [height][width]; what lies outside is left out. If it is wider than `room` it is cut, with three dots. */
void wr_label_draw(WrLabel *label, const char *text, int x, int y, int room, uint8_t value,
                   uint8_t *pixels, int width, int height);
