/* capsule.h - a cylinder with a hemisphere at each end. v is proportional to arc length from pole to
   pole, L = pi R + H:

     P = (R c S, R s S, +-(H/2 + R C)) on the hemispheres, (R c, R s, L (v - 1/2)) between them

   with S, C the sine and cosine of (arc from the nearer pole) / R, a quarter turn on the cylinder. So

     n = (c S, s S, +-C)      N = 2 pi R L S n

   in one formula. n is continuous; the curvature along v jumps from L/R to 0 where hemisphere and tube
   meet; there the second derivatives are those of the tube. The poles are exact, like the sphere's. */

R_INLINE void FN(capsule_at)(const SHAPE *shape, int face, REAL u, REAL v, POINT *o)
{
    (void)face;
    const REAL pi = K_(WR_PI), a = K_(2) * pi;
    REAL R = shape->value[0], H = shape->value[1], L = pi * R + H;
    REAL up = v < K_(0.5) ? K_(-1) : K_(1), arc = (v < K_(0.5) ? v : K_(1) - v) * L;
    REAL inv = R > K_(64) * R_MIN ? K_(1) / (R > K_(64) * R_MIN ? R : K_(1)) : K_(0);
    int ball = arc < K_(0.5) * pi * R;
    REAL turn = arc * inv * K_(0.15915494309189533577); /* 1 / (2 pi) */
    REAL s, c, S, C;
    r_sincos_turns(u, &s, &c);
    r_sincos_turns(ball ? turn : K_(0.25), &S, &C);
    REAL bend = ball ? L * inv : K_(0);
    VEC along = { -s, c, 0 }, n = { c * S, s * S, up * C };
    VEC rise = { -up * C * c, -up * C * s, S };
    REAL z = ball ? up * (K_(0.5) * H + R * C) : L * (v - K_(0.5));
    o->p = (VEC){ R * S * c, R * S * s, z };
    o->pu = v_scale(along, a * R * S);
    o->pv = v_scale(rise, L);
    o->puu = (VEC){ -a * a * R * S * c, -a * a * R * S * s, 0 };
    o->puv = v_scale(along, -a * L * up * C);
    o->pvv = v_scale(n, -L * bend);
    o->n = v_scale(n, a * R * L * S);
    o->n_len = r_abs(a * R * L * S);
    o->n_unit = n;
    o->n_u = v_scale(along, a * S);
    o->n_v = v_scale(rise, bend);
}

#ifndef WR_FORMULA_FLOAT
static double capsule_radius(const WrShape *s)
{
    return s->value[0] + s->value[1] / 2;
}

static const WrSurfaceInfo capsule_row = {
    .name = "capsule",
    .label = "Capsule",
    .help =
        "a tube with a hemisphere at each end; the table's lower and upper edges meet at its poles",
    .params = { { "R", 1, { 0.5 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "radius" },
                { "H", 1, { 1 }, 0, WR_LENGTH_MAX, true, "length between the hemispheres" } },
    .pose_deg = { -90, 90, 0 },
    .closed_u = true,
    .faces = 1,
    .convex_closed = true,
    .inversion = WR_INVERT_MESH,
    .at = capsule_at_d,
    .radius = capsule_radius,
};
#endif
