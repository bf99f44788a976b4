/* silhouette.h - what is known of an object's outline without sampling it.
   Layer 5, private to the renderer. */
#pragma once
#include "render/visibility/raster.h"
#include "render/frame/tile.h"

#include <stdbool.h>

/* Is pixel (x, y), whose centre shows nothing, empty for certain? Of planes, cubes and spheres. */
bool wr_outline_misses(const WrTileJob *job, double x, double y);

/* Where two sides of a surface meet its outline has a tip, which may lie between all samples: the corners of planar
   faces and of patches, in 1/256 samples. Returns how many. */
#define WR_OUTLINE_TIPS 24
int wr_outline_tips(const WrTileJob *job, WrRasterVertex tips[WR_OUTLINE_TIPS]);
