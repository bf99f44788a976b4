/* checkerboard.h - the squares that show where a picture in the window has nothing. */
#pragma once
#include <stdint.h>

typedef struct WrFrame WrFrame;
typedef struct WrTone WrTone;

/* Put light and dark squares behind a picture of floats, whose codes are [height][width] B,G,R,A. scale: the picture's
 * pixels to one of the window's; a square is 8 of these wide. Pixels that are wholly covered keep their codes. */
void wr_chequer_behind(const WrFrame *frame, const WrTone *tone, double scale, uint8_t *bgra);
