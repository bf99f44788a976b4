/* revolution.h - a profile (r, z)(v) rotated about the axis: P = (r c, r s, z); c, s of 2 pi u.

     N = 2 pi r (z' c, z' s, -r')      n = (z' c, z' s, -r') / |(r', z')|

   n does not depend on r: at a pole (r = 0, z' = 0) it is (0, 0, -+1), at a tip there is one for each
   generator. Where (r', z') = 0, second derivatives replace them, with + towards larger v in the lower
   half and - in the upper. At a corner the upper piece is used. The outside is to the right of the
   direction of the profile. */

R_INLINE void FN(revolution_at)(const SHAPE *shape, int face, REAL u, REAL v, POINT *o)
{
    (void)face;
    const REAL q = K_(2 * WR_PI), one = K_(1), zero = K_(0), three = K_(3), six = K_(6);
    const PROFILE *c = &shape->data->FN(profile);
    int k = 0;
    k += v >= c->from[32] ? 32 : 0;
    k += v >= c->from[k + 16] ? 16 : 0;
    k += v >= c->from[k + 8] ? 8 : 0;
    k += v >= c->from[k + 4] ? 4 : 0;
    k += v >= c->from[k + 2] ? 2 : 0;
    k += v >= c->from[k + 1] ? 1 : 0;
    REAL size = shape->scale, inv = c->inv[k], w = (c->to[k] - v) * inv, t = (v - c->from[k]) * inv;
    REAL r0 = c->r[4 * k] * size, r1 = c->r[4 * k + 1] * size;
    REAL r2 = c->r[4 * k + 2] * size, r3 = c->r[4 * k + 3] * size;
    REAL z0 = c->z[4 * k] * size, z1 = c->z[4 * k + 1] * size;
    REAL z2 = c->z[4 * k + 2] * size, z3 = c->z[4 * k + 3] * size;
    REAL w2 = w * w, wt = w * t, t2 = t * t;
    REAL r = w2 * w * r0 + three * (w * wt * r1 + wt * t * r2) + t2 * t * r3;
    REAL z = w2 * w * z0 + three * (w * wt * z1 + wt * t * z2) + t2 * t * z3;
    REAL ra = r1 - r0, rb = r2 - r1, rc = r3 - r2, za = z1 - z0, zb = z2 - z1, zc = z3 - z2;
    REAL rp = three * inv * (w2 * ra + K_(2) * wt * rb + t2 * rc);
    REAL zp = three * inv * (w2 * za + K_(2) * wt * zb + t2 * zc);
    REAL rpp = six * inv * inv * (w * (rb - ra) + t * (rc - rb));
    REAL zpp = six * inv * inv * (w * (zb - za) + t * (zc - zb));
    REAL turn = v < K_(0.5) ? one : -one;
    REAL big = r_abs(rp) > r_abs(zp) ? r_abs(rp) : r_abs(zp);
    int goes = big > R_MIN;
    REAL dr = goes ? rp : turn * rpp, dz = goes ? zp : turn * zpp;
    REAL more = r_abs(dr) > r_abs(dz) ? r_abs(dr) : r_abs(dz);
    int any = more > R_MIN;
    dr = any ? dr / (any ? more : one) : zero;
    dz = any ? dz / (any ? more : one) : one;
    REAL unit = one / r_sqrt(dr * dr + dz * dz), x = dz * unit, y = -dr * unit;
    REAL s, co;
    r_sincos_turns(u, &s, &co);
    VEC out = { co, s, 0 }, along = { -s, co, 0 };
    o->p = (VEC){ r * co, r * s, z };
    o->pu = v_scale(along, q * r);
    o->pv = (VEC){ rp * co, rp * s, zp };
    o->puu = v_scale(out, -q * q * r);
    o->puv = v_scale(along, q * rp);
    o->pvv = (VEC){ rpp * co, rpp * s, zpp };
    o->n_unit = (VEC){ x * co, x * s, y };
    REAL len = goes ? (rp * -y) + zp * x : zero, by = goes ? one / (goes ? big : one) : zero;
    o->n_len = r_abs(q * r) * len;
    o->n = (VEC){ q * r * zp * co, q * r * zp * s, -q * r * rp };
    o->n_u = v_scale(along, q * x);
    /* (x, y) changes as (z'', -r'') minus its part along (x, y), over |(r', z')| = big / unit. */
    REAL gx = zpp * by * unit, gy = -rpp * by * unit, part = gx * x + gy * y;
    gx = gx - part * x;
    gy = gy - part * y;
    o->n_v = (VEC){ gx * co, gx * s, gy };
}

#ifndef WR_FORMULA_FLOAT
static bool revolution_make(WrSurfaceData *data, WrError *err)
{
    if (!wr_profile_make(data->text[0], &data->profile_d, err)) return false;
    wr_profile_narrow(&data->profile_d, &data->profile_f);
    wr_profile_extent(&data->profile_d, &data->centre.z, &data->radius);
    return true;
}

static int revolution_corners(const WrShape *shape, double *v, int most)
{
    return wr_profile_corners(&shape->data->profile_d, v, most);
}

static const WrSurfaceInfo revolution_row = {
    .name = "revolution",
    .label = "Revolution",
    .help = "a profile turned about the axis, as on a lathe",
    .texts = { { "profile", "Profile",
                 "0,-0.9;0.45,-0.82;0.72,-0.35;0.55,0.25;0.3,0.55;0.34,0.75;0.5,0.9",
                 "points of a smooth curve, upwards; a repeated point is a corner", "r,z;..." } },
    .make = revolution_make,
    .pose_deg = { -0.0, 70.0, 90.0 },
    .closed_u = true,
    .faces = 1,
    .inversion = WR_INVERT_MESH,
    .at = revolution_at_d,
    .corners = revolution_corners,
};
#endif
