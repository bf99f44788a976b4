/* solid_texture_footprint.h - how fine a solid texture is along u and v, for adaptive sampling.
   Layer 5, private to the renderer. */
#pragma once
#include <stdbool.h>

typedef struct WrScene WrScene;

/* Is it known for the scene's surface: where u and v go by formulas of closed form, over one piece of them? */
bool wr_solid_texture_bounded(const WrScene *scene);
/* How many texels of a picture along u and v would be as fine as the texture is anywhere: three to the narrowest band that it
 * may have. Where u and v are denser than elsewhere that is more than there are. */
void wr_solid_texture_texels(const WrScene *scene, double texels[2]);
