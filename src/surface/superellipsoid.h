/* superellipsoid.h - |(|x/a|^(2/e2) + |y/b|^(2/e2))|^(e2/e1) + |z/c|^(2/e1) = 1 (Barr 1981), the
   spherical product of two superellipses, (w, z) along v and (x, y) along u:

     P = (a w x, b w y, c z)

   Barr's own parameters, x = cos^e, y = sin^e, have vanishing or unbounded speed if e is far from 1: at
   e = 0.1 nearly the whole table lies along the edges. The parametrisation here has a tangent that
   neither vanishes nor grows without bound. With C = |cos|, S = |sin| of the angle (signs separate), k
   = max(1, e/2), alpha = 2k/e, A = C^alpha + S^alpha:

     x = C^k A^(-e/2)                          y = S^k A^(-e/2)
     x' = -k C^(k-1) S^(alpha-1) A^(-1-e/2)    y' = k S^(k-1) C^(alpha-1) A^(-1-e/2)

   which for e <= 2 is the direction (C, S) projected onto the curve. One of k - 1 and alpha - 1 is 0.
   The normal of the curve is along

     m = (S^(k-1) C^(alpha-1), C^(k-1) S^(alpha-1))

   and N along (m_w m_x / a, m_w m_y / b, m_z (x m_x + y m_y) / c) of the two curves. Where C or S is 0:

     e < 2    smooth, the axis; for 1 < e < 2 the curvature is unbounded near there,
              and reported as 0 at the point itself
     e = 2    facets: the normal jumps; that of the positive side is used
     e > 2    a cusp: the normal is perpendicular to the arm, one for each side; that of the positive side is used

   At the poles the limit for that u is perpendicular in the same way: (0, 0, +-1) for e1 < 2. */

/* A superellipse: its point, two derivatives by the angle in radians, the normal's direction and its derivative. */
typedef struct FN(SuperCurve) {
    REAL x, y, dx, dy, ddx, ddy, mx, my, dmx, dmy;
} FN(SuperCurve);

R_INLINE FN(SuperCurve) FN(super_curve)(REAL e, REAL s, REAL c)
{
    const REAL one = K_(1), zero = K_(0), least = K_(0x1p-100);
    REAL sx = c < zero ? -one : one, sy = s < zero ? -one : one;
    REAL C = r_abs(c), S = r_abs(s);
    C = C < one ? C : one, S = S < one ? S : one;
    REAL k = e > K_(2) ? K_(0.5) * e : one, ka = k - one;
    REAL al = K_(2) * k / e - one, h = ka + al; /* one of the two is 0 */
    REAL Ch = r_pow01(C, h), Sh = r_pow01(S, h);
    int sharp = ka > zero;
    REAL Ck = sharp ? Ch : one, Sk = sharp ? Sh : one; /* to the power k - 1 */
    REAL Ca = sharp ? one : Ch, Sa = sharp ? one : Sh; /* to the power alpha - 1 */
    REAL A = Ca * C + Sa * S, F = r_pow_near(A, K_(-0.5) * e), by = F / A;
    const REAL flat =
        h == one ? one : zero; /* the power h - 1 at 0; unbounded values are replaced by 0 */
    REAL Chi = C > least ? Ch / (C > least ? C : one) : flat;
    REAL Shi = S > least ? Sh / (S > least ? S : one) : flat;
    REAL U = sharp ? -ka * Chi * S : al * Shi * C; /* derivatives of C^(k-1) S^(alpha-1) ... */
    REAL V = sharp ? ka * Shi * C : -al * Chi * S; /* ... and of S^(k-1) C^(alpha-1) */
    /* of A^(-1-e/2), relative to its value */
    REAL turn = (Ca * S - Sa * C) / A * (k + K_(2) * k / e);
    REAL dx = -k * Ck * Sa * by, dy = k * Sk * Ca * by;
    FN(SuperCurve) o;
    o.x = sx * (Ck * C * F);
    o.y = sy * (Sk * S * F);
    o.dx = sy * dx;
    o.dy = sx * dy;
    o.ddx = sx * (dx * turn - k * by * U);
    o.ddy = sy * (dy * turn + k * by * V);
    o.mx = sx * (Sk * Ca);
    o.my = sy * (Ck * Sa);
    o.dmx = sy * V;
    o.dmy = sx * U;
    return o;
}

R_INLINE void FN(superellipsoid_at)(const SHAPE *shape, int face, REAL u, REAL v, POINT *o)
{
    (void)face;
    const REAL q = K_(2 * WR_PI), p = K_(WR_PI);
    REAL a = shape->value[0], b = shape->value[1], c = shape->value[2];
    REAL s, co, sl, cl;
    r_sincos_turns(u, &s, &co);
    r_sincos_turns(K_(0.5) * (v - K_(0.5)), &sl, &cl);
    cl = r_abs(cl) + K_(0);
    const FN(SuperCurve) f = FN(super_curve)(shape->value[4], s, co);
    const FN(SuperCurve) g = FN(super_curve)(shape->value[3], sl, cl);
    VEC x = { a * f.x, b * f.y, 0 }, dx = { a * f.dx, b * f.dy, 0 },
        ddx = { a * f.ddx, b * f.ddy, 0 };
    REAL w = g.x, dw = g.dx;
    o->p = (VEC){ w * x.x, w * x.y, c * g.y };
    o->pu = v_scale(dx, q * w);
    o->pv = (VEC){ p * dw * x.x, p * dw * x.y, p * c * g.dy };
    o->puu = v_scale(ddx, q * q * w);
    o->puv = v_scale(dx, q * p * dw);
    o->pvv = (VEC){ p * p * g.ddx * x.x, p * p * g.ddx * x.y, p * p * c * g.ddy };
    REAL least = a < b ? a : b;
    least = least < c ? least : c;
    REAL ia = least / a, ib = least / b, ic = least / c;
    REAL t = f.x * f.mx + f.y * f.my,
         dt = f.x * f.dmx + f.y * f.dmy; /* the tangent is perpendicular to m */
    VEC m = { g.mx * f.mx * ia, g.mx * f.my * ib, g.my * t * ic };
    VEC mu = { q * g.mx * f.dmx * ia, q * g.mx * f.dmy * ib, q * g.my * dt * ic };
    VEC mv = { p * g.dmx * f.mx * ia, p * g.dmx * f.my * ib, p * g.dmy * t * ic };
    m.z = FN(max_norm)(m) > K_(0) ? m.z : g.my; /* a pole, on an edge between two cusps */
    FN(frame_from_n)(m, mu, mv, o);
    o->n = v_cross(o->pu, o->pv);
    REAL len = v_dot(o->n, o->n_unit);
    o->n_len = r_abs(len);
}

#ifndef WR_FORMULA_FLOAT
static const WrSurfaceInfo superellipsoid_row = {
    .name = "superellipsoid",
    .label = "Superellipsoid",
    .help = "a rounded box, ellipsoid, octahedron or star, by its exponents",
    .params = { { "a", 1, { 0.8 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "half its width, x" },
                { "b", 1, { 0.8 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "half its depth, y" },
                { "c", 1, { 0.8 }, WR_LENGTH_MIN, WR_LENGTH_MAX, true, "half its height, z" },
                { "e1",
                  1,
                  { 0.4 },
                  0.1,
                  4,
                  false,
                  "exponent from pole to pole: 0.1 box, 1 round, 2 straight" },
                { "e2", 1, { 0.4 }, 0.1, 4, false, "exponent around the axis, as e1" } },
    /* Upright with u = 1/2 in front, rotated 35 degrees to the left and tilted 25 forward, like the
     * cube. */
    .pose_deg = { -50.89, 47.94, 31.11 },
    .closed_u = true,
    .faces = 1,
    .inversion = WR_INVERT_MESH,
    .at = superellipsoid_at_d,
};
#endif
