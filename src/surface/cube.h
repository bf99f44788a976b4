/* cube.h - six squares of half side s: P = s (c + (2u-1) e + (2v-1) f), e x f = c, N = 4 s^2 c.
   Each face has the whole table. Faces 0..5 are +Z, +X, -Z, -X, +Y, -Y; standing on its -Y side, v
   runs up on the four upright faces and u to the right seen from outside; the lid's lower edge
   meets the front face, and so does the upper edge of the bottom. */

R_INLINE void FN(cube_at)(const SHAPE *shape, int face, REAL u, REAL v, POINT *o)
{
    static const signed char frame[6][9] = {
        /* c = outward, e = along u, f = along v */
        { 0, 0, 1, 1, 0, 0, 0, 1, 0 },   /* +Z */
        { 1, 0, 0, 0, 0, -1, 0, 1, 0 },  /* +X */
        { 0, 0, -1, -1, 0, 0, 0, 1, 0 }, /* -Z */
        { -1, 0, 0, 0, 0, 1, 0, 1, 0 },  /* -X */
        { 0, 1, 0, 1, 0, 0, 0, 0, -1 },  /* +Y */
        { 0, -1, 0, 1, 0, 0, 0, 0, 1 },  /* -Y */
    };
    const signed char *t = frame[face];
    const VEC zero = { 0, 0, 0 };
    VEC c = { t[0], t[1], t[2] }, e = { t[3], t[4], t[5] }, f = { t[6], t[7], t[8] };
    REAL s = shape->value[0];
    REAL x = K_(2) * u - K_(1), y = K_(2) * v - K_(1);
    o->p = v_scale(v_add(c, v_add(v_scale(e, x), v_scale(f, y))), s);
    o->pu = v_scale(e, K_(2) * s);
    o->pv = v_scale(f, K_(2) * s);
    o->puu = o->puv = o->pvv = zero;
    o->n_len = K_(4) * s * s;
    o->n = v_scale(c, o->n_len);
    o->n_unit = c;
    o->n_u = o->n_v = zero;
}

#ifndef WR_FORMULA_FLOAT
static double cube_radius(const WrShape *s)
{
    return s->value[0] * sqrt(3.0);
}

static const WrSurfaceInfo cube_row = {
    .name = "cube",
    .label = "Cube",
    .help = "a cube with the table on each of its six faces",
    .params = { { "s", 1, { 0.6 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "half the edge" } },
    /* Turned 35 degrees to the left about the upright axis, then tipped 25 degrees forward. */
    .pose_deg = { 29.65, -31.32, -16.48 },
    .faces = 6,
    .flat = true,
    .convex_closed = true,
    .inversion = WR_INVERT_CUBE,
    .at = cube_at_d,
    .radius = cube_radius,
};
#endif
