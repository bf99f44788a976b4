/* torus.h - the torus P = (w c, w s, r sin psi), w = R + r cos psi, psi = 2 pi v; c, s of 2 pi u.

     N = 4 pi^2 r w (c cos psi, s cos psi, sin psi)

   The unit normal is the bracket, without w: it points away from the tube's centre line everywhere,
   also on horn (R = r), spindle (R < r) and thin (r = 0) tori. There N = Pu x Pv is 0 or, on the inner
   part of a spindle where w < 0, has the opposite direction: N has the sign of w, the unit normal does
   not. */

R_INLINE void FN(torus_at)(const SHAPE *shape, int face, REAL u, REAL v, POINT *o)
{
    (void)face;
    const REAL a = K_(2 * WR_PI);
    REAL R = shape->value[0], r = shape->value[1];
    REAL s, c, sp, cp;
    r_sincos_turns(u, &s, &c);
    r_sincos_turns(v, &sp, &cp);
    REAL w = R + r * cp, len = a * a * r * w;
    VEC n = { cp * c, cp * s, sp };
    VEC along = { -s, c, 0 }, round = { -sp * c, -sp * s, cp };
    o->p = (VEC){ w * c, w * s, r * sp };
    o->pu = v_scale(along, a * w);
    o->pv = v_scale(round, a * r);
    o->puu = (VEC){ -a * a * w * c, -a * a * w * s, 0 };
    o->puv = v_scale(along, -a * a * r * sp);
    o->pvv = v_scale(n, -a * a * r);
    o->n = v_scale(n, len);
    o->n_len = r_abs(len);
    o->n_unit = n;
    o->n_u = v_scale(along, a * cp);
    o->n_v = v_scale(round, a);
}

#ifndef WR_FORMULA_FLOAT
static bool torus_check(const WrShape *s, WrError *err)
{
    if (s->value[0] + s->value[1] >= WR_LENGTH_MIN) return true;
    return wr_fail(err, "torus R = 0 and r = 0: no surface; one of them must be above 0");
}

static double torus_radius(const WrShape *s)
{
    return s->value[0] + s->value[1];
}

static const WrSurfaceInfo torus_row = {
    .name = "torus",
    .label = "Torus",
    .help = "a ring of radius R, its tube of radius r",
    .params = { { "R", 1, { 1 }, 0, WR_LENGTH_MAX, true, "radius of the ring" },
                { "r", 1, { 0.4 }, 0, WR_LENGTH_MAX, true, "radius of the tube" } },
    .pose_deg = { -50, 0, 0 },
    .closed_u = true,
    .closed_v = true,
    .faces = 1,
    .inversion = WR_INVERT_MESH,
    .at = torus_at_d,
    .check = torus_check,
    .radius = torus_radius,
};
#endif
