/* terrain_row.h - the surface kind of height images, as a set of patches (terrain.h) stored in the
   scene like a mesh. */

R_INLINE void FN(terrain_at)(const SHAPE *s, int face, REAL u, REAL v, POINT *o)
{
    FN(mesh_at)(s, face, u, v, o);
}

#ifndef WR_FORMULA_FLOAT
static const WrSurfaceInfo terrain_row = {
    .name = "terrain",
    .label = "Terrain",
    .help = "smooth ground with the heights of a picture or a layer",
    .params = { { "a", 1, { 1 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "width" },
                { "b", 1, { 1 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "depth" },
                { "height",
                  1,
                  { 0.25 },
                  -WR_LENGTH_MAX,
                  WR_LENGTH_MAX,
                  true,
                  "height of white above black" },
                { "cells", 1, { 48 }, 2, 64, false, "patches along the longer side" } },
    .pose_deg = { -55, 0, -25 },
    .held = true,
    .open = true,
    .faces = 1,
    .inversion = WR_INVERT_TRIANGLES,
    .at = terrain_at_d,
    .radius = mesh_radius,
};
#endif
