/* pixel_encode.h - conversion of linear pixels to 8-bit codes: composed over a background and tone-mapped.
   Private to the renderer. */
#pragma once
#include "render/frame/frame.h"
#include "render/kernels/kern.h"
#include "render/frame/srgb_encode.h"
#include "shade/environment_map.h"

#include <stdbool.h>
#include <stdint.h>

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
