/* cube.h - six squares of half side s: P = s (c + (2x-1) e + (2y-1) f), e x f = c, N = 4 s^2 x_u y_v c.

   x = u, y = v: each face has the whole table. Optionally each has a cell of it, three beside two from
   the lower left, within a margin (WR_CELL_MARGIN): then u and v cover only the cell (wr_surface_cell).
   Faces 0..5 are +Z, +X, -Z, -X, +Y, -Y. With the cube on its -Y side, v runs up on the four upright
   faces and u to the right seen from outside; the top's lower edge meets the front face, and so does
   the upper edge of the bottom. */

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
    const REAL s = shape->value[0], margin = K_(WR_CELL_MARGIN), side = K_(1) - K_(2) * margin;
    const bool own = shape->value[1] > K_(1);
    const REAL xu = own ? K_(3) / side : K_(1), yv = own ? K_(2) / side : K_(1);
    const REAL u0 = own ? ((REAL)(face % 3) + margin) / K_(3) : K_(0);
    const REAL v0 = own ? ((REAL)(face / 3) + margin) / K_(2) : K_(0);
    REAL x = K_(2) * (xu * (u - u0)) - K_(1), y = K_(2) * (yv * (v - v0)) - K_(1);
    o->p = v_scale(v_add(c, v_add(v_scale(e, x), v_scale(f, y))), s);
    o->pu = v_scale(e, K_(2) * s * xu);
    o->pv = v_scale(f, K_(2) * s * yv);
    o->puu = o->puv = o->pvv = zero;
    o->n_len = K_(4) * s * s * xu * yv;
    o->n = v_scale(c, o->n_len);
    o->n_unit = c;
    o->n_u = o->n_v = zero;
}

#ifndef WR_FORMULA_FLOAT
static double cube_radius(const WrShape *s)
{
    return s->value[0] * sqrt(3.0);
}

static WrSurfaceCell cube_cell(const WrShape *s, int face)
{
    if (!(s->value[1] > 1)) return (WrSurfaceCell){ 0, 1, 0, 1 };
    const double i = face % 3, j = face / 3, margin = WR_CELL_MARGIN;
    return (WrSurfaceCell){ (i + margin) / 3, (i + 1 - margin) / 3, (j + margin) / 2,
                            (j + 1 - margin) / 2 };
}

static const WrSurfaceInfo cube_row = {
    .name = "cube",
    .label = "Cube",
    .help = "a cube with the table on each of its six faces",
    .params = { { "s", 1, { 0.6 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "half the edge" },
                { "faces",
                  1,
                  { 1 },
                  1,
                  6,
                  false,
                  "1: each face shows the whole table; 6: each face shows its own cell of it",
                  { "All of it on each face", "A cell for each face" } } },
    /* Rotated 35 degrees to the left about the upright axis, then tilted 25 degrees forward. */
    .pose_deg = { 29.65, -31.32, -16.48 },
    .faces = 6,
    .flat = true,
    .convex_closed = true,
    .inversion = WR_INVERT_CUBE,
    .at = cube_at_d,
    .radius = cube_radius,
    .cell = cube_cell,
};
#endif
