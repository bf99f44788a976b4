/* pixel_encode.h - quantization of linear light to 8-bit codes of the sRGB curve (IEC 61966-2-1). Private to the
   renderer. */
#pragma once
#include "render/frame/frame.h"
#include "render/kernels/kern.h"
#include "shade/environment_map.h"

#include <stdbool.h>
#include <stdint.h>

/* ---- sRGB ---- */

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

/* ---- pixels ---- */

/* Conversion of linear pixels to 8-bit codes: composed over a background and tone-mapped.
   Private to the renderer. */

typedef struct WrPool WrPool;

/* Background of a pixel, or of a row, of a quantized picture. */
typedef struct WrBehind {
    float colour[3]; /* linear, before tone mapping */
    uint32_t code;   /* tone-mapped, opaque */
} WrBehind;

typedef struct WrPixelEncoder {
    const WrKernels *kernels; /* the exact kernels, whichever kernels render the picture */
    const uint32_t *bins;     /* [WR_CODE_BINS + 1] */
    WrToneCurve tone;
} WrPixelEncoder;

/* Encodes `count` premultiplied colours, [count][4], to out [count]. across 1: each pixel has its own `behind`;
   0: all share one. Returns the number of non-finite values, which count as 0. Any count. */
int64_t wr_code_row(const WrPixelEncoder *coder, const WrBehind *behind, int across, int count,
                    const float *rgba, uint32_t *out);

/* Camera rays into the environment: direction at the first pixel's centre, and its steps per pixel and per row,
   in the picture's axes. */
typedef struct WrOutlook {
    const WrEnvironmentMap *light; /* NULL: no environment */
    double strength;
    double first[3], right[3], down[3];
} WrOutlook;

/* The background of a picture: one cell for each pixel, for each row, or for all. */
typedef struct WrBackdrop {
    WrBehind *cells; /* owned */
    size_t room;
    int step, across; /* cells per row and per pixel: 0 where they share one */
    /* source of the cells, where it was an environment */
    WrEnvironmentMap *held; /* own share */
    WrOutlook outlook;
    WrTone tone;
    int width, height, first, rows;
} WrBackdrop;

/* Fills the background of rows [first, first + rows); an environment that is already there is kept. radius:
   wr_shape_radius of the scene's shape, or 0 if unknown. */
void wr_backdrop_update(WrBackdrop *backdrop, const WrFrameCodes *of, double radius, int width,
                        int height, int first, int rows, const WrPixelEncoder *coder, WrPool *pool);
void wr_backdrop_fini(WrBackdrop *backdrop);
static inline const WrBehind *wr_backdrop_at(const WrBackdrop *backdrop, int x, int row)
{
    return backdrop->cells + (size_t)row * (size_t)backdrop->step + (size_t)(x * backdrop->across);
}
