/* ribbon.h - a band L long and W wide, waving k times with amplitude A, twisted by t turns.
     beta = 2 pi t u,  w = W (v - 1/2)
     P = (L (u - 1/2), w cos beta, A sin 2 pi k u + w sin beta)
     N = (-2 pi t w W - 2 pi k A W cos 2 pi k u cos beta, -L W sin beta, L W cos beta)
   |N| >= L W, so that it is never degenerate. */

R_INLINE void FN(ribbon_at)(const SHAPE *shape, int face, REAL u, REAL v, POINT *o)
{
    (void)face;
    const VEC zero = { 0, 0, 0 };
    REAL L = shape->value[0], A = shape->value[1], k = shape->value[2];
    REAL W = shape->value[3], t = shape->value[4];
    REAL kk = K_(2 * WR_PI) * k, tt = K_(2 * WR_PI) * t;
    REAL sk, ck, sb, cb, w = W * (v - K_(0.5));
    r_sincos_turns(k * u, &sk, &ck);
    r_sincos_turns(t * u, &sb, &cb);
    o->p = (VEC){ L * (u - K_(0.5)), w * cb, A * sk + w * sb };
    o->pu = (VEC){ L, -tt * w * sb, kk * A * ck + tt * w * cb };
    o->pv = (VEC){ 0, W * cb, W * sb };
    o->puu = (VEC){ 0, -tt * tt * w * cb, -kk * kk * A * sk - tt * tt * w * sb };
    o->puv = (VEC){ 0, -tt * W * sb, tt * W * cb };
    o->pvv = zero;
    VEC n = { -tt * w * W - kk * A * W * ck * cb, -L * W * sb, L * W * cb };
    VEC n_du = { kk * A * W * (kk * sk * cb + tt * ck * sb), -L * W * tt * cb, -L * W * tt * sb };
    VEC n_dv = { -tt * W * W, 0, 0 };
    FN(frame_from_n)(n, n_du, n_dv, o);
}

#ifndef WR_FORMULA_FLOAT
/* No point is farther from the x axis than |A| + W/2. */
static double ribbon_radius(const WrShape *s)
{
    return v3_len((WrVec3){ s->value[0] / 2, fabs(s->value[1]) + s->value[3] / 2, 0 });
}

static const WrSurfaceInfo ribbon_row = {
    .name = "ribbon",
    .label = "Ribbon",
    .help = "a waving band that may be twisted",
    .params = { { "L", 1, { 2.4 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "length" },
                { "A", 1, { 0.25 }, -WR_LENGTH_MAX, WR_LENGTH_MAX, true, "height of the waves" },
                { "k", 1, { 1 }, -1000, 1000, false, "number of waves" },
                { "W", 1, { 0.8 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "width" },
                { "t", 1, { 0 }, -1000, 1000, false, "twist in turns" } },
    .pose_deg = { -35, 20, 0 },
    .open = true,
    .faces = 1,
    .inversion = WR_INVERT_MESH,
    .at = ribbon_at_d,
    .radius = ribbon_radius,
};
#endif
