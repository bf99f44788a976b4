/* disc.h - a flat round plate: P = (rho c, rho s, 0), rho = R (1 - v); c, s of 2 pi u. The rim is v =
   0, the centre v = 1.

     N = 2 pi R rho (0, 0, 1)

   At the centre Pu = N = 0; the unit normal is (0, 0, 1) everywhere. */

R_INLINE void FN(disc_at)(const SHAPE *shape, int face, REAL u, REAL v, POINT *o)
{
    (void)face;
    const REAL a = K_(2 * WR_PI);
    const VEC zero = { 0, 0, 0 }, up = { 0, 0, 1 };
    REAL R = shape->value[0], rho = R * (K_(1) - v);
    REAL s, c;
    r_sincos_turns(u, &s, &c);
    VEC out = { c, s, 0 }, along = { -s, c, 0 };
    o->p = v_scale(out, rho);
    o->pu = v_scale(along, a * rho);
    o->pv = v_scale(out, -R);
    o->puu = v_scale(out, -a * a * rho);
    o->puv = v_scale(along, -a * R);
    o->pvv = zero;
    o->n = (VEC){ 0, 0, a * R * rho };
    o->n_len = r_abs(a * R * rho);
    o->n_unit = up;
    o->n_u = o->n_v = zero;
}

#ifndef WR_FORMULA_FLOAT
static double disc_radius(const WrShape *s)
{
    return s->value[0];
}

static const WrSurfaceInfo disc_row = {
    .name = "disc",
    .label = "Disc",
    .help = "a flat round plate, facing the viewer; the table's upper edge meets at its centre",
    .params = { { "R", 1, { 1 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "radius" } },
    .closed_u = true,
    .open = true,
    .faces = 1,
    .flat = true,
    .inversion = WR_INVERT_MESH,
    .at = disc_at_d,
    .radius = disc_radius,
};
#endif
