/* solid_texture_footprint.h - resolution of a solid texture in (u,v), for adaptive sampling. Private to the
   renderer. */
#pragma once
#include <stdbool.h>

typedef struct WrScene WrScene;

/* True if the resolution is known for the scene's surface: u and v have closed formulas over one piece. */
bool wr_solid_texture_bounded(const WrScene *scene);
/* Size, along u and v, of a picture as fine as the texture at its finest place: three texels for the narrowest
   possible band. Where u and v are denser than elsewhere this is more than necessary. */
void wr_solid_texture_texels(const WrScene *scene, double texels[2]);
