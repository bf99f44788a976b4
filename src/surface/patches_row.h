/* patches_row.h - the surface kind of patch sets from a file (patches.h), stored in the scene like a
   mesh (mesh.h).

   Code that evaluates P(u,v) gets the unit square, as for a mesh. */

R_INLINE void FN(patches_at)(const SHAPE *s, int face, REAL u, REAL v, POINT *o)
{
    FN(mesh_at)(s, face, u, v, o);
}

#ifndef WR_FORMULA_FLOAT
static const WrSurfaceInfo patches_row = {
    .name = "patches",
    .label = "Bezier patches",
    .help = "a set of bicubic patches from a file, such as the teapot; without a file, a square",
    .held = true,
    .open = true,
    .faces = 1,
    .pose_deg = { -66, 0, -14 }, /* sets such as the teapot stand along z */
    .inversion = WR_INVERT_TRIANGLES,
    .at = patches_at_d,
    .radius = mesh_radius,
};
#endif
