/* frame.h - the unit frame from N and its derivatives, for surfaces whose unit normal has no closed
   form.

   No include guard: compiled once per precision (precision.h).

     n = N / |N|     n_u = (N_u - n (n . N_u)) / |N|     n_v the same with N_v

   N is divided by its largest component first, so that |N|^2 neither overflows nor underflows. */

/* The largest |component|. */
R_INLINE REAL FN(max_norm)(VEC a)
{
    REAL x = r_abs(a.x), y = r_abs(a.y), z = r_abs(a.z);
    REAL m = x > y ? x : y;
    return m > z ? m : z;
}

/* Fills n, n_unit, n_len, n_u, n_v from N and its derivatives. Where N = 0: n_unit = (0,0,1) and n_u =
 * n_v = 0. */
R_INLINE void FN(frame_from_n)(VEC n, VEC n_du, VEC n_dv, POINT *o)
{
    REAL m = FN(max_norm)(n);
    int good = m > R_MIN;
    REAL inv = K_(1) / (good ? m : K_(1));
    REAL x = n.x * inv, y = n.y * inv, z = n.z * inv;
    REAL s = r_sqrt(x * x + y * y + z * z); /* 1 .. sqrt(3) where good */
    REAL si = K_(1) / (good ? s : K_(1));
    VEC unit = { good ? x * si : K_(0), good ? y * si : K_(0), good ? z * si : K_(1) };
    REAL d = good ? inv * si : K_(0); /* 1 / |N| */
    o->n = n;
    o->n_unit = unit;
    o->n_len = good ? m * s : m;
    VEC du = v_scale(n_du, d), dv = v_scale(n_dv, d);
    o->n_u = v_sub(du, v_scale(unit, v_dot(unit, du)));
    o->n_v = v_sub(dv, v_scale(unit, v_dot(unit, dv)));
}
