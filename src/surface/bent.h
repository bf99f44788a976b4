/* bent.h - a rectangle with its corner (1,1) moved by c, a bilinear patch.

     P = (a u, b v, 0) + u v c
     N = (-b v c_z, -a u c_z, ab + a u c_y + b v c_x)

   N = 0 only where the patch folds over: such a c is rejected. */

R_INLINE void FN(bent_at)(const SHAPE *s, int face, REAL u, REAL v, POINT *o)
{
    (void)face;
    const VEC zero = { 0, 0, 0 };
    REAL a = s->value[0], b = s->value[1];
    VEC c = { s->value[2], s->value[3], s->value[4] };
    REAL uv = u * v;
    o->p = (VEC){ a * u + uv * c.x, b * v + uv * c.y, uv * c.z };
    o->pu = (VEC){ a + v * c.x, v * c.y, v * c.z };
    o->pv = (VEC){ u * c.x, b + u * c.y, u * c.z };
    o->puu = o->pvv = zero;
    o->puv = c;
    VEC n = { -b * v * c.z, -a * u * c.z, a * b + a * u * c.y + b * v * c.x };
    VEC n_du = { 0, -a * c.z, a * c.y };
    VEC n_dv = { -b * c.z, 0, b * c.x };
    FN(frame_from_n)(n, n_du, n_dv, o);
}

#ifndef WR_FORMULA_FLOAT
/* N is linear in (u, v). Its z is 0 somewhere on the patch unless it has one sign at all four corners
 * (at (0,0) it is ab > 0); its x and y are both 0 where c_z = 0, else only at u = v = 0, where z is ab.
 * So a lifted corner (c_z != 0) never folds, and a flat one needs z > 0 at the corners. A corner whose
 * distance from a fold is below rounding error is rejected too. */
static bool bent_check(const WrShape *s, WrError *err)
{
    double a = s->value[0], b = s->value[1];
    double x = s->value[2] / a, y = s->value[3] / b, z = s->value[4];
    double least = fmin(fmin(1 + x, 1 + y), 1 + x + y); /* of N_z / ab over the corners */
    double lift = fabs(z) / fmax(a, b);
    if (least > 1e-9 || lift > 1e-9) return true;
    char text[3][WR_NUMBER_SIZE];
    return wr_fail(err,
                   "bent c = %s,%s,%s: the corner folds the patch flat onto itself; lift it (c's z "
                   "not 0) or keep it nearer, with 1 + x/a, 1 + y/b and 1 + x/a + y/b above 0",
                   wr_number_print(s->value[2], text[0]), wr_number_print(s->value[3], text[1]),
                   wr_number_print(s->value[4], text[2]));
}

/* |P - centre| is convex along u and along v, so that the farthest point is a corner. */
static double bent_radius(const WrShape *s)
{
    double a = s->value[0] / 2, b = s->value[1] / 2;
    double flat = v3_len((WrVec3){ a, b, 0 });
    double moved = v3_len((WrVec3){ a + s->value[2], b + s->value[3], s->value[4] });
    return fmax(flat, moved);
}

static const WrSurfaceInfo bent_row = {
    .name = "bent",
    .label = "Bent corner",
    .help = "a rectangle with its upper right corner pulled out of the plane",
    .params = { { "a", 1, { 1 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "width" },
                { "b", 1, { 1 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "height" },
                { "c",
                  3,
                  { -0.4, -0.4, 0.6 },
                  -WR_LENGTH_MAX,
                  WR_LENGTH_MAX,
                  true,
                  "displacement of the corner (1,1)" } },
    .pose_deg = { -25, 20, 0 },
    .centre_half_ab = true,
    .open = true,
    .faces = 1,
    .inversion = WR_INVERT_MESH,
    .at = bent_at_d,
    .check = bent_check,
    .radius = bent_radius,
};
#endif
