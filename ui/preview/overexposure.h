/* overexposure.h - pixels of a finished picture that show no more light than they do: full in some colour. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

/* The share of pixels, [height][width] B,G,R,A, that hold a code of 255; mark: those become black and violet, in stripes. */
double wr_overexposed(uint8_t *bgra, int width, int height, bool mark);
