/* srgb_codes.h - where the 8-bit codes of the sRGB curve (IEC 61966-2-1) change.
   Layer 5, private to the renderer. */
#pragma once

/* The least linear value of each code: decode((code - 1/2) / 255). */
extern const float wr_srgb_borders[256];
