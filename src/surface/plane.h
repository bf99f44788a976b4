/* plane.h - the flat patch: P = (a u, b v, 0), N = (0, 0, ab).

   Blinn's N' is exact on it for any F. If endless, u and v are unbounded: it extends to the horizon. */

R_INLINE void FN(plane_at)(const SHAPE *s, int face, REAL u, REAL v, POINT *o)
{
    (void)face;
    const VEC zero = { 0, 0, 0 }, up = { 0, 0, 1 };
    REAL a = s->value[0], b = s->value[1];
    o->p = (VEC){ a * u, b * v, 0 };
    o->pu = (VEC){ a, 0, 0 };
    o->pv = (VEC){ 0, b, 0 };
    o->puu = o->puv = o->pvv = zero;
    o->n = (VEC){ 0, 0, a * b };
    o->n_len = a * b;
    o->n_unit = up;
    o->n_u = o->n_v = zero;
}

#ifndef WR_FORMULA_FLOAT
static double plane_radius(const WrShape *s)
{
    return v3_len((WrVec3){ s->value[0] / 2, s->value[1] / 2, 0 });
}

static const WrSurfaceInfo plane_row = {
    .name = "plane",
    .label = "Plane",
    .help = "a flat rectangle, a wide and b high, facing the viewer",
    .params = { { "a", 1, { 1 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "width" },
                { "b", 1, { 1 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "height" },
                { "endless",
                  1,
                  { 0 },
                  0,
                  1,
                  false,
                  "1: it continues beyond its sides, to the horizon",
                  { "Ends at its sides", "Goes on to the horizon" } } },
    .endless = true,
    .centre_half_ab = true,
    .open = true,
    .faces = 1,
    .flat = true,
    .inversion = WR_INVERT_PLANE,
    .at = plane_at_d,
    .radius = plane_radius,
};
#endif
