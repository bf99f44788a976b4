/* pixel_encode.h - finished light as 8-bit codes: over what lies behind it, developed as the scene says.
   Layer 5, private to the renderer. */
#pragma once
#include "render/frame/frame.h"
#include "render/kernels/kern.h"
#include "render/frame/srgb_encode.h"
#include "shade/environment_map.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrPool WrPool;

/* What stands behind a pixel, or a row, of a picture of codes. */
typedef struct WrBehind {
    float colour[3]; /* linear, before it is developed */
    uint32_t code;   /* developed, opaque */
} WrBehind;

typedef struct WrPixelEncoder {
    const WrKernels *kernels; /* of the exact ones, whatever others the picture is made by */
    const uint32_t *bins;     /* [WR_CODE_BINS + 1] */
    WrToneCurve tone;
} WrPixelEncoder;

/* `count` premultiplied colours, [count][4], out [count]; each pixel has its own `behind`, or, across 0, all have that
   one. How many numbers were not finite, and counted as 0. Any count. */
int64_t wr_code_row(const WrPixelEncoder *coder, const WrBehind *behind, int across, int count,
                    const float *rgba, uint32_t *out);

/* What the camera sees of surroundings: the direction at the first pixel's centre, and what it changes by from pixel to
   pixel and from row to row, in the picture's directions. */
typedef struct WrOutlook {
    const WrEnvironmentMap *light; /* NULL: of none */
    double strength;
    double first[3], right[3], down[3];
} WrOutlook;

/* The background of a picture: a cell for each pixel, for each row, or for all. */
typedef struct WrBackdrop {
    WrBehind *cells; /* owned */
    size_t room;
    int step, across; /* cells from row to row and from pixel to pixel: 0 where they share one */
    /* what they were made of, where it was surroundings */
    WrEnvironmentMap *held; /* own share */
    WrOutlook outlook;
    WrTone tone;
    int width, height, first, rows;
} WrBackdrop;

/* Fill it for rows [first, first + rows) of a picture; surroundings that stand there already are kept.
   radius: wr_shape_radius of the scene's, or 0 where it is not known. */
void wr_backdrop_bring(WrBackdrop *backdrop, const WrFrameCodes *of, double radius, int width,
                       int height, int first, int rows, const WrPixelEncoder *coder, WrPool *pool);
void wr_backdrop_fini(WrBackdrop *backdrop);
static inline const WrBehind *wr_backdrop_at(const WrBackdrop *backdrop, int x, int row)
{
    return backdrop->cells + (size_t)row * (size_t)backdrop->step + (size_t)(x * backdrop->across);
}
