/* sphere.h - the sphere P = R (c cos l, s cos l, sin l), c, s of 2 pi u, l = pi (v - 1/2): poles at v =
   0 and 1.

   The unit normal is P/R without a division, so that the poles give (0, 0, -1) and (0, 0, 1) exactly in
   both precisions. */

/* P, Pu, Pv, n, |N| for the normal n, which is that of longitude (c, s) and latitude (cl, sl). */
R_INLINE void FN(sphere_frame)(REAL R, VEC n, REAL c, REAL s, REAL cl, REAL sl, POINT *o)
{
    const REAL pi = K_(WR_PI), a = K_(2) * pi;
    VEC east = { -s, c, 0 }, north = { -c * sl, -s * sl, cl };
    o->p = v_scale(n, R);
    o->pu = v_scale(east, a * R * cl);
    o->pv = v_scale(north, pi * R);
    o->n_unit = n;
    o->n_len = r_abs(K_(2) * pi * pi * R * R * cl);
}

R_INLINE void FN(sphere_at)(const SHAPE *shape, int face, REAL u, REAL v, POINT *o)
{
    (void)face;
    const REAL pi = K_(WR_PI);
    REAL R = shape->value[0];
    REAL s, c, sl, cl;
    r_sincos_turns(u, &s, &c);
    r_sincos_turns(K_(0.5) * (v - K_(0.5)), &sl, &cl);
    cl = cl + K_(0); /* no negative zero */
    VEC east = { -s, c, 0 }, north = { -c * sl, -s * sl, cl };
    REAL a = K_(2) * pi;
    FN(sphere_frame)(R, (VEC){ c * cl, s * cl, sl }, c, s, cl, sl, o);
    o->puu = (VEC){ -a * a * R * cl * c, -a * a * R * cl * s, 0 };
    o->puv = v_scale(east, -a * pi * R * sl);
    o->pvv = v_scale(o->n_unit, -pi * pi * R);
    o->n = v_scale(o->n_unit, K_(2) * pi * pi * R * R * cl);
    o->n_u = v_scale(east, a * cl);
    o->n_v = v_scale(north, pi);
}

/* The frame in the direction of a point, without (u,v); any distance. */
R_INLINE void FN(sphere_from)(const SHAPE *shape, VEC p, POINT *o)
{
    REAL inv = K_(1) / r_sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    VEC n = v_scale(p, inv);
    REAL cl = r_sqrt(n.x * n.x + n.y * n.y), by = K_(1) / (cl > K_(0) ? cl : K_(1));
    FN(sphere_frame)(shape->value[0], n, cl > K_(0) ? n.x * by : K_(1), n.y * by, cl, n.z, o);
}

#ifndef WR_FORMULA_FLOAT
static double sphere_radius(const WrShape *s)
{
    return s->value[0];
}

static const WrSurfaceInfo sphere_row = {
    .name = "sphere",
    .label = "Sphere",
    .help = "a ball; the table's lower and upper edges meet at its poles",
    .params = { { "R", 1, { 1 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "radius" } },
    .pose_deg = { -90, 90, 0 },
    .closed_u = true,
    .faces = 1,
    .convex_closed = true,
    .inversion = WR_INVERT_SPHERE,
    .at = sphere_at_d,
    .radius = sphere_radius,
};
#endif
