/* checkerboard.h - checkerboard behind transparent areas of a picture. */
#pragma once
#include <stdint.h>

typedef struct WrFrame WrFrame;
typedef struct WrTone WrTone;

/* Composite a float picture over a checkerboard into 8-bit pixels [height][width] B,G,R,A. scale: picture pixels per
 * window pixel; a square is 8 window pixels wide. Fully covered pixels keep their values. */
void wr_chequer_behind(const WrFrame *frame, const WrTone *tone, double scale, uint8_t *bgra);
