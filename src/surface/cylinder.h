/* cylinder.h - a tube without caps: P = (R c, R s, H (v - 1/2)), c, s of 2 pi u. */

/* P, Pu, Pv, n, |N| at longitude (c, s) and height z. */
R_INLINE void FN(cylinder_frame)(const SHAPE *shape, REAL c, REAL s, REAL z, POINT *o)
{
    const REAL a = K_(2 * WR_PI);
    REAL R = shape->value[0], H = shape->value[1];
    VEC out = { c, s, 0 }, along = { -s, c, 0 };
    o->p = (VEC){ R * c, R * s, z };
    o->pu = v_scale(along, a * R);
    o->pv = (VEC){ 0, 0, H };
    o->n_len = a * R * H;
    o->n_unit = out;
}

R_INLINE void FN(cylinder_at)(const SHAPE *shape, int face, REAL u, REAL v, POINT *o)
{
    (void)face;
    const REAL a = K_(2 * WR_PI);
    const VEC zero = { 0, 0, 0 };
    REAL R = shape->value[0], H = shape->value[1];
    REAL s, c;
    r_sincos_turns(u, &s, &c);
    VEC out = { c, s, 0 }, along = { -s, c, 0 };
    FN(cylinder_frame)(shape, c, s, H * (v - K_(0.5)), o);
    o->puu = v_scale(out, -a * a * R);
    o->puv = o->pvv = zero;
    o->n = v_scale(out, o->n_len);
    o->n_u = v_scale(along, a);
    o->n_v = zero;
}

/* The frame at the point's longitude and height, without (u,v); any distance from the axis. */
R_INLINE void FN(cylinder_from)(const SHAPE *shape, VEC p, POINT *o)
{
    REAL inv = K_(1) / r_sqrt(p.x * p.x + p.y * p.y);
    FN(cylinder_frame)(shape, p.x * inv, p.y * inv, p.z, o);
}

#ifndef WR_FORMULA_FLOAT
static double cylinder_radius(const WrShape *s)
{
    return v3_len((WrVec3){ s->value[0], s->value[1] / 2, 0 });
}

static const WrSurfaceInfo cylinder_row = {
    .name = "cylinder",
    .label = "Cylinder",
    .help = "an upright tube, open at both ends",
    .params = { { "R", 1, { 0.7 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "radius" },
                { "H", 1, { 1.6 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "height" } },
    .pose_deg = { -90, 90, 0 },
    .closed_u = true,
    .faces = 1,
    .inversion = WR_INVERT_CYLINDER,
    .at = cylinder_at_d,
    .radius = cylinder_radius,
};
#endif
