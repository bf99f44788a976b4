/* brush_sample.h - a brush preset's sample: one stroke as a small, side-lit picture. Used by `wrinkle brushes` for
   contact sheets and thumbnails.

   The stroke is a horizontal S from left to right. Its pressure rises from light to full and falls at the end, and
   the pen's tilt changes from left to right. The radius is limited to the sample's size; all other settings are the
   preset's own. Brushes that act on existing heights (smooth, flatten, erase, ...) paint on grainy ridges, others on
   a flat table. The height scale is adjusted for a visible relief, so samples show a brush's character, not its
   strength. */
#pragma once
#include "brush/preset.h"
#include "cli/cli.h"

#include <stdbool.h>
#include <stdint.h>

#define WR_SAMPLE_W 256 /* texels of the table */
#define WR_SAMPLE_H 192

typedef struct WrSampler WrSampler;

/* A sampler for pictures of width x height pixels, which should have the aspect ratio 4:3. The caller owns it. */
/* NULL is allowed */

