/* srgb_encode.h - quantization of linear light to 8-bit codes of the sRGB curve (IEC 61966-2-1). Private to the
   renderer. */
#pragma once
#include <stdint.h>

/* Smallest linear value of each code: decode((code - 1/2) / 255). */
extern const float wr_srgb_borders[256];

/* Linear light is cut into bins. The curve rises by less than one code within a bin (12.92 * 255 / 4096), so the
   code at a bin's lower end and the position of the one border inside give the code of any value. A float times
   BINS is exact, and borders lie on steps of 1/STEPS of a bin: the result equals a comparison with the border
   itself. */
#define WR_CODE_BINS 4096
#define WR_CODE_STEPS 8388608.0f /* 2^23 */

/* [WR_CODE_BINS + 1]: code | border << 8, in steps; WR_CODE_STEPS if the bin has no border. */
void wr_code_bins_fill(uint32_t bins[WR_CODE_BINS + 1]);

/* Position among the bins; 0 for NaN. Separate from wr_code_at: a loop that clamps and indexes at once does
   not vectorise. */
static inline float wr_srgb_bin_position(float x)
{
    x = x > 0.0f ? x : 0.0f;
    x = x < 1.0f ? x : 1.0f;
    return x * (float)WR_CODE_BINS;
}

/* The nearest code. */
static inline uint32_t wr_code_at(const uint32_t *bins, float place)
{
    const int32_t bin = (int32_t)place;
    const uint32_t at = bins[bin];
    const int32_t past = (int32_t)((place - (float)bin) * WR_CODE_STEPS);
    return (at & 255U) + (uint32_t)(past >= (int32_t)(at >> 8));
}

/* Opaque 0xAARRGGBB: on little-endian machines the bytes B, G, R, A. */
static inline uint32_t wr_code_pack(uint32_t r, uint32_t g, uint32_t b)
{
    return 0xff000000U | r << 16 | g << 8 | b;
}
