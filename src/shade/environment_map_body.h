/* environment_map_body.h - formulas of environment light at one sample, for both precisions and every
   kernel.

   Included after reflection_body.h. Only ?:, no branches. No include guard: compiled once per
   precision. The reference renderer has its own formulas. */

/* E / pi for a direction n from wr_environment_map_form's terms; nowhere negative. */
R_INLINE REAL surround_light(const REAL *f, VEC n)
{
    const REAL x = n.x * (f[1] + f[4] * n.x + f[7] * n.y);
    const REAL y = n.y * (f[2] + f[5] * n.y + f[8] * n.z);
    const REAL z = n.z * (f[3] + f[6] * n.z + f[9] * n.x);
    return reflect_positive(f[0] + (x + (y + z)));
}

/* A fraction of light, by x = sqrt(n.v). */
R_INLINE REAL surround_share(const REAL *a, REAL x)
{
    return reflect_positive(reflect_terms(a, x));
}

R_INLINE REAL surround_root(VEC n, VEC v)
{
    return r_sqrt(reflect_least(reflect_positive(v_dot(n, v)), K_(1)));
}

/* The mirrored direction r = 2 (n.v) n - v, for n' bent into view; unit, as n and v are. */
R_INLINE VEC surround_mirrored(VEC n, VEC v)
{
    const VEC seen = reflect_seen(n, v);
    return v_sub(v_scale(seen, K_(2) * v_dot(seen, v)), v);
}
