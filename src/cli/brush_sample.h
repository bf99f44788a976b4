/* brush_sample.h - what a brush does, as a small picture: one stroke on a table of its own, lit from the
   side. Used by `wrinkle brushes` for contact sheets and thumbnails.
   Layer 7.

   The stroke is a lying S from the left to the right, its pressure rising from a touch to full and falling
   at the end, the pen leaning from the left over to the right. The radius is brought to what a sample of
   this size can show; all else is the preset's own. Where the brush acts on what is there (smooth,
   flatten, erase, ...) the table has grainy ridges, else it is flat. The relief is lit at a height that shows it
   well, so samples tell of a brush's character, not of its strength. */
#pragma once
#include "brush/preset.h"
#include "cli/cli.h"

#include <stdbool.h>
#include <stdint.h>

#define WR_SAMPLE_W 256 /* texels of the table */
#define WR_SAMPLE_H 192

typedef struct WrSampler WrSampler;

/* Pictures of width x height pixels, which should be as 4 to 3. The caller owns it. */
WrSampler *wr_sampler_new(const WrCli *cli, int width, int height, WrError *err);
void wr_sampler_free(WrSampler *sampler); /* NULL is fine */

/* The preset's sample as grey 8-bit sRGB, [height][width]. */
bool wr_sampler_paint(WrSampler *sampler, const WrPreset *preset, uint8_t *grey, WrError *err);
