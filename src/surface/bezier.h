/* bezier.h - the bicubic Bezier patch P = sum B_i(u) B_j(v) C_ij, point k = C_ij with i = k % 4 along u
   and j = k / 4 along v.

   Evaluated row by row: along u in each of the four rows of points (value and two derivatives), then
   along v. Differences of points are computed first, so that a row whose points coincide yields
   derivatives of exactly 0 and the basis at u, v = 0, 1 is exactly 0 and 1. Where N = Pu x Pv = 0 the
   normal is the first nonzero Taylor coefficient of N in the direction of the patch's middle, du, dv =
   +1 in the lower half, -1 in the upper:

     order 1   (du Puu + dv Puv) x Pv + Pu x (du Puv + dv Pvv)
               an edge v = 0 (v = 1) collapsed to a point, Pu = 0: +(Puv x Pv), -(Puv x Pv); an edge u = 0
               (u = 1), Pv = 0: +-(Pu x Puv); a corner whose handles coincide: along the diagonal
     order 2   Pv = 0 as well: Puv x Pvv; two collapsed rows: Puvv x Pv / 2
     order 3   both tangents 0 along a whole edge: +-(Puvv x Pvv) / 2 or +-(Puu x Puuv) / 2

   If all orders are 0 (all points equal, or on a line) n = (0, 0, 1). At all these points n_u = n_v =
   0. */

/* One row: value and derivatives along u, from its four points. */
R_INLINE void FN(bezier_row)(const REAL *c, REAL u, VEC *p, VEC *d, VEC *dd)
{
    REAL w = K_(1) - u;
    VEC c0 = { c[0], c[1], c[2] }, c1 = { c[3], c[4], c[5] };
    VEC c2 = { c[6], c[7], c[8] }, c3 = { c[9], c[10], c[11] };
    VEC a0 = v_sub(c1, c0), a1 = v_sub(c2, c1), a2 = v_sub(c3, c2);
    VEC b0 = v_sub(a1, a0), b1 = v_sub(a2, a1);
    REAL w2 = w * w, wu = K_(2) * w * u, u2 = u * u;
    REAL k1 = K_(3) * w2 * u, k2 = K_(3) * w * u2;
    *p = v_add(v_add(v_scale(c0, w2 * w), v_scale(c1, k1)),
               v_add(v_scale(c2, k2), v_scale(c3, u2 * u)));
    *d = v_scale(v_add(v_add(v_scale(a0, w2), v_scale(a1, wu)), v_scale(a2, u2)), K_(3));
    *dd = v_scale(v_add(v_scale(b0, w), v_scale(b1, u)), K_(6));
}

/* Value, first and second derivative along v across four rows of vectors. */
R_INLINE VEC FN(bezier_mix)(VEC c0, VEC c1, VEC c2, VEC c3, REAL v, VEC *d, VEC *dd)
{
    REAL w = K_(1) - v;
    VEC a0 = v_sub(c1, c0), a1 = v_sub(c2, c1), a2 = v_sub(c3, c2);
    VEC b0 = v_sub(a1, a0), b1 = v_sub(a2, a1);
    REAL w2 = w * w, wv = K_(2) * w * v, v2 = v * v;
    REAL k1 = K_(3) * w2 * v, k2 = K_(3) * w * v2;
    *d = v_scale(v_add(v_add(v_scale(a0, w2), v_scale(a1, wv)), v_scale(a2, v2)), K_(3));
    *dd = v_scale(v_add(v_scale(b0, w), v_scale(b1, v)), K_(6));
    return v_add(v_add(v_scale(c0, w2 * w), v_scale(c1, k1)),
                 v_add(v_scale(c2, k2), v_scale(c3, v2 * v)));
}

/* |x| + |y| + |z|: a size without comparisons, which would keep the compiler from vectorising. */
R_INLINE REAL FN(bezier_size)(VEC a)
{
    return r_abs(a.x) + r_abs(a.y) + r_abs(a.z);
}

/* The sizes of the three differences between four vectors, added up. */
R_INLINE REAL FN(bezier_spans)(VEC a, VEC b, VEC c, VEC d)
{
    return FN(bezier_size)(v_sub(b, a)) + FN(bezier_size)(v_sub(c, b)) +
           FN(bezier_size)(v_sub(d, c));
}

/* a where use_a, else b, component by component. */
R_INLINE VEC FN(either)(int use_a, VEC a, VEC b)
{
    return (VEC){ use_a ? a.x : b.x, use_a ? a.y : b.y, use_a ? a.z : b.z };
}

/* Computes n, n_unit, n_len, n_u, n_v from the derivatives in *o and the third derivatives Puuv, Puvv.
 * `noise` is the rounding error: a smaller product of tangents counts as 0. */
R_INLINE void FN(bezier_frame)(REAL u, REAL v, VEC puuv, VEC puvv, REAL noise, POINT *o)
{
    VEC n = v_cross(o->pu, o->pv);
    VEC n_du = v_add(v_cross(o->puu, o->pv), v_cross(o->pu, o->puv));
    VEC n_dv = v_add(v_cross(o->puv, o->pv), v_cross(o->pu, o->pvv));
    REAL du = u < K_(0.5) ? K_(1) : K_(-1), dv = v < K_(0.5) ? K_(1) : K_(-1);
    VEC pu1 = v_add(v_scale(o->puu, du), v_scale(o->puv, dv));
    VEC pv1 = v_add(v_scale(o->puv, du), v_scale(o->pvv, dv));
    VEC pu2 = v_scale(puvv, K_(0.5)), pv2 = v_scale(puuv, K_(0.5));
    VEC first = v_add(v_scale(n_du, du), v_scale(n_dv, dv));
    VEC second = v_add(v_cross(pu1, pv1), v_add(v_cross(pu2, o->pv), v_cross(o->pu, pv2)));
    VEC third = v_add(v_cross(pu2, pv1), v_cross(pu1, pv2));
    const VEC zero = { 0, 0, 0 };
    int solid = FN(bezier_size)(n) > noise;
    VEC limit = FN(either)(FN(bezier_size)(third) > noise, third, zero);
    limit = FN(either)(FN(bezier_size)(second) > noise, second, limit);
    limit = FN(either)(FN(bezier_size)(first) > noise, first, limit);
    FN(frame_from_n)
    (FN(either)(solid, n, limit), FN(either)(solid, n_du, zero), FN(either)(solid, n_dv, zero), o);
    o->n = n;
    o->n_len = solid ? o->n_len : K_(0);
}

/* P, Pu, Pv only, for points prepared once for many samples: an eighth of the work. */
typedef struct FN(BezierPlane) {
    REAL c[48], a[36]; /* the points, and 3 (c[i+1] - c[i]) along each row */
} FN(BezierPlane);

R_INLINE void FN(bezier_ready)(const SHAPE *s, FN(BezierPlane) * to)
{
    for (int k = 0; k < 48; k++) to->c[k] = s->value[k];
    for (int k = 0; k < 36; k++) {
        const int at = k + k / 9 * 3;
        to->a[k] = K_(3) * (s->value[at + 3] - s->value[at]);
    }
}

/* The cubic basis, and the quadratic one of derivatives. */
typedef struct FN(BezierBasis) {
    REAL b0, b1, b2, b3, d0, d1, d2;
} FN(BezierBasis);

R_INLINE FN(BezierBasis) FN(bezier_basis)(REAL t)
{
    REAL w = K_(1) - t, w2 = w * w, t2 = t * t;
    return (FN(BezierBasis)){
        w2 * w, K_(3) * (w2 * t), K_(3) * (w * t2), t2 * t, w2, K_(2) * (w * t), t2
    };
}

R_INLINE VEC FN(bezier_point)(const REAL *c, const FN(BezierBasis) * u)
{
    return (VEC){ u->b0 * c[0] + u->b1 * c[3] + u->b2 * c[6] + u->b3 * c[9],
                  u->b0 * c[1] + u->b1 * c[4] + u->b2 * c[7] + u->b3 * c[10],
                  u->b0 * c[2] + u->b1 * c[5] + u->b2 * c[8] + u->b3 * c[11] };
}

R_INLINE VEC FN(bezier_slope)(const REAL *a, const FN(BezierBasis) * u)
{
    return (VEC){ u->d0 * a[0] + u->d1 * a[3] + u->d2 * a[6],
                  u->d0 * a[1] + u->d1 * a[4] + u->d2 * a[7],
                  u->d0 * a[2] + u->d1 * a[5] + u->d2 * a[8] };
}

R_INLINE VEC FN(bezier_across)(VEC p0, VEC p1, VEC p2, VEC p3, const FN(BezierBasis) * v)
{
    return (VEC){ v->b0 * p0.x + v->b1 * p1.x + v->b2 * p2.x + v->b3 * p3.x,
                  v->b0 * p0.y + v->b1 * p1.y + v->b2 * p2.y + v->b3 * p3.y,
                  v->b0 * p0.z + v->b1 * p1.z + v->b2 * p2.z + v->b3 * p3.z };
}

/* Fills p, pu, pv. */
R_INLINE void FN(bezier_plane)(const FN(BezierPlane) * s, REAL u, REAL v, POINT *o)
{
    const FN(BezierBasis) bu = FN(bezier_basis)(u), bv = FN(bezier_basis)(v);
    VEC p0 = FN(bezier_point)(s->c, &bu), p1 = FN(bezier_point)(s->c + 12, &bu);
    VEC p2 = FN(bezier_point)(s->c + 24, &bu), p3 = FN(bezier_point)(s->c + 36, &bu);
    VEC a0 = v_sub(p1, p0), a1 = v_sub(p2, p1), a2 = v_sub(p3, p2);
    o->p = FN(bezier_across)(p0, p1, p2, p3, &bv);
    o->pv =
        v_scale(v_add(v_add(v_scale(a0, bv.d0), v_scale(a1, bv.d1)), v_scale(a2, bv.d2)), K_(3));
    o->pu =
        FN(bezier_across)(FN(bezier_slope)(s->a, &bu), FN(bezier_slope)(s->a + 9, &bu),
                          FN(bezier_slope)(s->a + 18, &bu), FN(bezier_slope)(s->a + 27, &bu), &bv);
}

/* Upper bound of bezier_frame's rounding threshold on the patch. With d the largest difference of a
   coordinate between neighbours, of vectors up to 3 d: |Pu| terms up to 3 * 3 d, second derivatives 6 *
   6 d and 9 * 6 d; spans 3 * 3 d and 3 * 3 * 6 d. */
R_INLINE REAL FN(bezier_noise)(const SHAPE *s)
{
    REAL d = K_(0);
    for (int k = 0; k < 36; k++) {
        REAL along = r_abs(s->value[k + 12] - s->value[k]);
        int row = k % 9 + k / 9 * 12;
        REAL across = r_abs(s->value[row + 3] - s->value[row]);
        d = along > d ? along : d;
        d = across > d ? across : d;
    }
    return R_NOISE * (K_(99) * d) * (K_(63) * d);
}

R_INLINE void FN(bezier_at)(const SHAPE *s, int face, REAL u, REAL v, POINT *o)
{
    (void)face;
    const REAL *c = s->value;
    VEC p0, p1, p2, p3, d0, d1, d2, d3, dd0, dd1, dd2, dd3, t;
    FN(bezier_row)(c, u, &p0, &d0, &dd0);
    FN(bezier_row)(c + 12, u, &p1, &d1, &dd1);
    FN(bezier_row)(c + 24, u, &p2, &d2, &dd2);
    FN(bezier_row)(c + 36, u, &p3, &d3, &dd3);
    VEC puvv, puuv;
    o->p = FN(bezier_mix)(p0, p1, p2, p3, v, &o->pv, &o->pvv);
    o->pu = FN(bezier_mix)(d0, d1, d2, d3, v, &o->puv, &puvv);
    o->puu = FN(bezier_mix)(dd0, dd1, dd2, dd3, v, &puuv, &t);
    /* The sizes of Pu and Pv in the neighbourhood, nonzero even if they vanish at the point itself. */
    REAL su = K_(0.25) * (FN(bezier_size)(d0) + FN(bezier_size)(d1) + FN(bezier_size)(d2) +
                          FN(bezier_size)(d3)) +
              FN(bezier_size)(o->puu) + FN(bezier_size)(o->puv);
    REAL sv = FN(bezier_spans)(p0, p1, p2, p3) + FN(bezier_spans)(d0, d1, d2, d3);
    FN(bezier_frame)(u, v, puuv, puvv, R_NOISE * su * sv, o);
}

#ifndef WR_FORMULA_FLOAT
static const WrSurfaceInfo bezier_row = {
    .name = "bezier",
    .label = "Bezier patch",
    .help = "a bicubic Bezier patch with sixteen control points",
    /* Two crossed waves over the unit square: z = s_i + t_j. */
    /* clang-format off */
    .params = { { "points", 48,
                  { 0, 0,     0,    1./3, 0,     0.45, 2./3, 0,    -0.45, 1, 0,     0,
                    0, 1./3, -0.3,  1./3, 1./3,  0.15, 2./3, 1./3, -0.75, 1, 1./3, -0.3,
                    0, 2./3,  0.3,  1./3, 2./3,  0.75, 2./3, 2./3, -0.15, 1, 2./3,  0.3,
                    0, 1,     0,    1./3, 1,     0.45, 2./3, 1,    -0.45, 1, 1,     0 },
                  -WR_LENGTH_MAX, WR_LENGTH_MAX, true,
                  "x,y,z of each; four along u, then the next row" } },
    /* clang-format on */
    .pose_deg = { -35, -20, 0 },
    .centre = { 0.5, 0.5, 0 },
    .open = true,
    .faces = 1,
    .inversion = WR_INVERT_MESH,
    .at = bezier_at_d,
};
#endif
