/* light_body.h - formulas of light and reflection at one sample, for both precisions and every kernel.

   Uses the names of surface/precision.h for one precision, or those of the kernels
   (render/kernels/kern_body.h): REAL, VEC, K_, R_INLINE, v_dot, r_sqrt, r_pow_below. Only ?:, no
   branches, so that loops over samples vectorise. No include guard: compiled once per precision. The
   reference renderer intentionally has its own formulas.

     I = C (ambient + sum of kd L max(0, n'.l)) + sum of ks L lobe(n'.h)        h = (l + v) / |l + v| */

/* The direction from one point to another; for nearly equal points their difference. */
R_INLINE VEC light_toward(VEC from, VEC to)
{
    VEC w = v_sub(to, from);
    REAL ww = v_dot(w, w), inv = K_(1) / r_sqrt(ww > K_(1e-30) ? ww : K_(1));
    return v_scale(w, inv);
}

/* max(0, n'.l) */
R_INLINE REAL light_lit(REAL n_dot_l)
{
    return n_dot_l > K_(0) ? n_dot_l : K_(0);
}

/* The half vector h. High powers are computed from 1 - n'.h: near 1 that is |n' - h|^2 / 2, which is
   insensitive to rounding of the lengths of n' and h (HC89). */
typedef struct Half {
    VEC h;         /* unit; 0 where l and v are opposite */
    REAL c, below; /* n'.h; 1 - n'.h */
    bool there;
} Half;

R_INLINE Half light_half(VEC l, VEC v, VEC bent)
{
    VEC h = v_add(l, v);
    REAL hh = v_dot(h, h);
    bool there = hh > K_(1e-24);
    h = v_scale(h, there ? K_(1) / r_sqrt(there ? hh : K_(1)) : K_(0));
    REAL c = v_dot(bent, h);
    VEC off = v_sub(bent, h);
    return (Half){ h, c, c > K_(0.5) ? K_(0.5) * v_dot(off, off) : K_(1) - c, there };
}

/* max(0, c)^s from c and 1 - c. */
R_INLINE REAL light_lobe(REAL c, REAL below, REAL s)
{
    return r_pow_below(c > K_(0) ? c : K_(0), below, s);
}

/* `lobe`, or 0 if there is no highlight: if l and v are opposite (HC91), or, gated, facing away from
 * the light. */
R_INLINE REAL light_shown(REAL lobe, bool gate, REAL n_dot_l, bool there)
{
    return (!gate || n_dot_l > K_(0)) && there ? lobe : K_(0);
}

/* I = C (ambient + diffuse) + specular */
R_INLINE REAL light_sum(REAL own, REAL picture, REAL diffuse, REAL specular)
{
    return own * picture * diffuse + specular;
}
