/* silhouette.h - silhouette tests that need no samples.
   Private to the renderer. */
#pragma once
#include "render/visibility/raster.h"
#include "render/frame/tile.h"

#include <stdbool.h>

/* True if pixel (x, y), whose centre is empty, is certainly empty. For planes, cubes and spheres. */
bool wr_outline_misses(const WrTileJob *job, double x, double y);

/* Corners of the outline, which may lie between all samples: the corners of planar faces and of patches, in
   1/256 samples. Returns their number. */
#define WR_OUTLINE_TIPS 24
int wr_outline_tips(const WrTileJob *job, WrRasterVertex tips[WR_OUTLINE_TIPS]);
