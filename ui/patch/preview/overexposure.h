/* overexposure.h - over-exposed pixels of a finished picture: a channel at 255. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

/* Share of over-exposed pixels in [height][width] B,G,R,A; mark: replace them by black and violet stripes. */
double wr_overexposed(uint8_t *bgra, int width, int height, bool mark);
