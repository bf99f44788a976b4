/* mesh.h - the surface kind of triangle meshes (triangles.h), which are stored in the scene beside the
   shape.

   The shape's numbers are not user parameters: they are the mesh's bounding sphere and its key, so that
   two shapes are equal only if their meshes are. Without a file the mesh is the unit square of two
   triangles, P = (u, v, 0). Code that evaluates P(u,v) of a mesh gets this square: the points of a mesh
   are no function of u and v. */

R_INLINE void FN(mesh_at)(const SHAPE *s, int face, REAL u, REAL v, POINT *o)
{
    (void)s;
    (void)face;
    const VEC zero = { 0, 0, 0 }, up = { 0, 0, 1 };
    o->p = (VEC){ u, v, 0 };
    o->pu = (VEC){ 1, 0, 0 };
    o->pv = (VEC){ 0, 1, 0 };
    o->puu = o->puv = o->pvv = zero;
    o->n = up;
    o->n_len = 1;
    o->n_unit = up;
    o->n_u = o->n_v = zero;
}

#ifndef WR_FORMULA_FLOAT
static double mesh_radius(const WrShape *s)
{
    return s->value[WR_MESH_RADIUS] > 0 ? s->value[WR_MESH_RADIUS] : sqrt(0.5);
}

static const WrSurfaceInfo mesh_row = {
    .name = "mesh",
    .label = "Mesh",
    .help = "triangles from a file: OBJ, PLY, STL, glTF, 3MF and others; without a file, a square "
            "of two triangles",
    .held = true,
    .open = true,
    .faces = 1,
    .flat = true,
    .inversion = WR_INVERT_TRIANGLES,
    .at = mesh_at_d,
    .radius = mesh_radius,
};
#endif
