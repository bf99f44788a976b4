/* environment_map_body.h - light of surroundings at one sample: the formulas, written once for both precisions and for every
   kernel, after reflection_body.h.
   No branch but ?:. No include guard: compiled once a precision. The reference renderer has its own. */

/* E / pi of a direction n by wr_environment_map_form's terms; nowhere below 0. */
R_INLINE REAL surround_light(const REAL *f, VEC n)
{
    const REAL x = n.x * (f[1] + f[4] * n.x + f[7] * n.y);
    const REAL y = n.y * (f[2] + f[5] * n.y + f[8] * n.z);
    const REAL z = n.z * (f[3] + f[6] * n.z + f[9] * n.x);
    return reflect_positive(f[0] + (x + (y + z)));
}

/* A share of light, by x = sqrt(n.v). */
R_INLINE REAL surround_share(const REAL *a, REAL x)
{
    return reflect_positive(reflect_terms(a, x));
}

R_INLINE REAL surround_root(VEC n, VEC v)
{
    return r_sqrt(reflect_least(reflect_positive(v_dot(n, v)), K_(1)));
}

/* The mirrored direction r = 2 (n.v) n - v, of n' as it is seen; unit, as n and v are. */
R_INLINE VEC surround_mirrored(VEC n, VEC v)
{
    const VEC seen = reflect_seen(n, v);
    return v_sub(v_scale(seen, K_(2) * v_dot(seen, v)), v);
}
