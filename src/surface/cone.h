/* cone.h - a cone without its base: P = (R (1-v) c, R (1-v) s, H (v - 1/2)), apex at v = 1.

     N = 2 pi R (1-v) (H c, H s, R)

   At the apex Pu = N = 0 and there is one normal for each generator: n = (H c, H s, R)/l of that u, l =
   sqrt(R^2 + H^2). */

/* P, Pu, Pv, n, |N| at longitude (c, s) and height z, which is w H below the apex. */
R_INLINE void FN(cone_frame)(const SHAPE *shape, REAL c, REAL s, REAL w, REAL z, POINT *o)
{
    const REAL a = K_(2 * WR_PI);
    REAL R = shape->value[0], H = shape->value[1];
    VEC along = { -s, c, 0 };
    REAL m = R > H ? R : H, x = R / m, y = H / m; /* l without overflow */
    REAL unit = r_sqrt(x * x + y * y), inv = K_(1) / unit;
    o->p = (VEC){ R * w * c, R * w * s, z };
    o->pu = v_scale(along, a * R * w);
    o->pv = (VEC){ -R * c, -R * s, H };
    o->n_len = r_abs(a * R * w) * (m * unit);
    o->n_unit = (VEC){ y * c * inv, y * s * inv, x * inv };
    o->n_u = v_scale(along, a * y * inv);
}

R_INLINE void FN(cone_at)(const SHAPE *shape, int face, REAL u, REAL v, POINT *o)
{
    (void)face;
    const REAL a = K_(2 * WR_PI);
    const VEC zero = { 0, 0, 0 };
    REAL R = shape->value[0], H = shape->value[1];
    REAL s, c, w = K_(1) - v;
    r_sincos_turns(u, &s, &c);
    VEC along = { -s, c, 0 }, steep = { H * c, H * s, R };
    FN(cone_frame)(shape, c, s, w, H * (v - K_(0.5)), o);
    o->puu = (VEC){ -a * a * R * w * c, -a * a * R * w * s, 0 };
    o->puv = v_scale(along, -a * R);
    o->pvv = zero;
    o->n = v_scale(steep, a * R * w);
    o->n_v = zero;
}

/* The frame at a point, relative to the apex, without (u,v); at the apex that of u = 0. */
R_INLINE void FN(cone_from)(const SHAPE *shape, VEC p, POINT *o)
{
    REAL H = shape->value[1], w = -p.z / H;
    REAL rho = r_sqrt(p.x * p.x + p.y * p.y), by = K_(1) / (rho > K_(0) ? rho : K_(1));
    REAL c = rho > K_(0) ? p.x * by : K_(1), s = p.y * by;
    FN(cone_frame)(shape, c, s, w, H * K_(0.5) + p.z, o);
}

#ifndef WR_FORMULA_FLOAT
static double cone_radius(const WrShape *s)
{
    return v3_len((WrVec3){ s->value[0], s->value[1] / 2, 0 });
}

static const WrSurfaceInfo cone_row = {
    .name = "cone",
    .label = "Cone",
    .help = "an upright cone without its base; the table's upper edge meets at the tip",
    .params = { { "R", 1, { 0.8 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "radius of the rim" },
                { "H", 1, { 1.6 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "height" } },
    .pose_deg = { -90, 90, 0 },
    .closed_u = true,
    .faces = 1,
    .inversion = WR_INVERT_CONE,
    .at = cone_at_d,
    .radius = cone_radius,
};
#endif
