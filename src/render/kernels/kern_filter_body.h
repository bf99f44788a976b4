/* kern_filter_body.h - footprints of pixels in the table, and slopes filtered over them. Part of kern_body.h. */

#define VAST K_(1e9) /* texels: upper limit of a footprint */

ALWAYS REAL within(REAL x, REAL most)
{
    x = x < most ? x : most; /* NaN becomes most */
    return x > -most ? x : -most;
}

/* The ray q(x) + s d(x) intersects the plane across n in P; for a step in x, P moves by
     w = q_x + s d_x - d (n . (q_x + s d_x)) / (n . d)
   and u, v by the solution of w = u_x Pu + v_x Pv. At grazing angles n . d is kept away from 0, so that the
   footprint is long but finite. */
ALWAYS VEC step_on_plane(VEC n, VEC d, VEC step, REAL dn)
{
    return v_mad(step, d, -v_dot(n, step) / dn);
}

FLAT static void kern_footprint(const RAYS *rays, const LOOK *look, REAL pixel, STRIP *strip)
{
    const REAL W = (REAL)look->width * (REAL)look->ru * pixel;
    const REAL H = -(REAL)look->height * (REAL)look->rv * pixel;
    const VEC qx = { rays->qx[0], rays->qx[1], rays->qx[2] };
    const VEC qy = { rays->qy[0], rays->qy[1], rays->qy[2] };
    const VEC dx = { rays->dx[0], rays->dx[1], rays->dx[2] };
    const VEC dy = { rays->dy[0], rays->dy[1], rays->dy[2] };
    const VEC d0 = { rays->d0[0], rays->d0[1],
                     rays->d0[2] }; /* loaded here: read inside the loop it would prevent vectors */
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        VEC d = v_mad(v_mad(d0, dy, strip->y[i]), dx, strip->x[i]);
        REAL least = K_(1e-6) * r_sqrt(v_dot(d, d)), size = v_dot(LOAD3(strip, n, i), d);
        strip->s[i] = r_abs(size) > least ? size : least;
    }
    SIMD for (int i = 0; i < count; i++)
    {
        VEC q = RAY_Q(rays, strip->y[i], strip->x[i]), d = RAY_D(rays, strip->y[i], strip->x[i]);
        VEC n = LOAD3(strip, n, i), pu = LOAD3(strip, pu, i), pv = LOAD3(strip, pv, i);
        REAL s = v_dot(v_sub(LOAD3(strip, p, i), q), d) / v_dot(d, d), dn = strip->s[i];
        VEC a = step_on_plane(n, d, v_mad(qx, dx, s), dn);
        VEC b = step_on_plane(n, d, v_mad(qy, dy, s), dn);
        REAL uu = v_dot(pu, pu), uv = v_dot(pu, pv), vv = v_dot(pv, pv);
        /* |N|^2, with a lower limit of its rounding error */
        REAL det = uu * vv - uv * uv, noise = K_(1e-12) * uu * vv + K_(1e-30);
        REAL inv = K_(1) / (r_abs(det) + noise);
        REAL au = v_dot(a, pu), av = v_dot(a, pv), bu = v_dot(b, pu), bv = v_dot(b, pv);
        strip->rx[i] = W * ((vv * au - uv * av) * inv);
        strip->ry[i] = H * ((uu * av - uv * au) * inv);
        strip->wx[i] = W * ((vv * bu - uv * bv) * inv);
        strip->wy[i] = H * ((uu * bv - uv * bu) * inv);
    }
    SIMD for (int i = 0; i < count; i++)
    {
        strip->rx[i] = within(strip->rx[i], VAST);
        strip->ry[i] = within(strip->ry[i], VAST);
        strip->wx[i] = within(strip->wx[i], VAST);
        strip->wy[i] = within(strip->wy[i], VAST);
    }
}

/* Motion of a triangle's u and v with P: their gradients, which `meet` stored as Pv = n x grad u and Pu = grad v
   x n. */
ALWAYS void put_met(const RAYS *rays, REAL W, REAL H, STRIP *strip, int i)
{
    const VEC qx = { rays->qx[0], rays->qx[1], rays->qx[2] };
    const VEC qy = { rays->qy[0], rays->qy[1], rays->qy[2] };
    const VEC dx = { rays->dx[0], rays->dx[1], rays->dx[2] };
    const VEC dy = { rays->dy[0], rays->dy[1], rays->dy[2] };
    VEC q = RAY_Q(rays, strip->y[i], strip->x[i]), d = RAY_D(rays, strip->y[i], strip->x[i]);
    VEC n = LOAD3(strip, n, i);
    REAL dd = v_dot(d, d), least = K_(1e-6) * r_sqrt(dd), size = v_dot(n, d);
    REAL dn = r_abs(size) > least ? size : least;
    REAL s = v_dot(v_sub(LOAD3(strip, p, i), q), d) / dd;
    VEC a = step_on_plane(n, d, v_mad(qx, dx, s), dn);
    VEC b = step_on_plane(n, d, v_mad(qy, dy, s), dn);
    VEC gu = v_cross(LOAD3(strip, pv, i), n), gv = v_cross(n, LOAD3(strip, pu, i));
    strip->rx[i] = within(W * v_dot(a, gu), VAST);
    strip->ry[i] = within(H * v_dot(a, gv), VAST);
    strip->wx[i] = within(W * v_dot(b, gu), VAST);
    strip->wy[i] = within(H * v_dot(b, gv), VAST);
}

FLAT static void kern_footprint_met(const RAYS *rays, const LOOK *look, REAL pixel, STRIP *strip)
{
    const REAL W = (REAL)look->width * (REAL)look->ru * pixel;
    const REAL H = -(REAL)look->height * (REAL)look->rv * pixel;
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        put_met(rays, W, H, strip, i);
    }
}

/* Isotropic: one fetch with the longer side. Anisotropic: fetches of the parallelogram's height, side by side
   along its longer side, at most WR_TAPS_MAX, beyond which they grow. Up to one texel: level 0 (E17). */
FLAT static void kern_spread(const LOOK *look, bool anisotropic, STRIP *strip)
{
    const REAL most = anisotropic ? (REAL)WR_TAPS_MAX : K_(1);
    const REAL last = (REAL)(look->pyramid->levels - 1);
    const REAL reach = look->reach > K_(0) ? look->reach : K_(10) * VAST;
    const REAL per_u = K_(1) / ((REAL)look->width * (look->ru != 0.0 ? (REAL)look->ru : K_(1)));
    const REAL per_v = K_(-1) / ((REAL)look->height * (look->rv != 0.0 ? (REAL)look->rv : K_(1)));
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        REAL rx = strip->rx[i], ry = strip->ry[i], wx = strip->wx[i], wy = strip->wy[i];
        REAL r = r_sqrt(rx * rx + ry * ry), w = r_sqrt(wx * wx + wy * wy);
        REAL major = r > w ? r : w, less = major > reach ? reach / major : K_(1);
        rx *= less, ry *= less, wx *= less, wy *= less, major *= less;
        REAL area = r_abs(rx * wy - ry * wx);
        REAL minor = area / (major > K_(1) ? major : K_(1));
        REAL ratio = major / (minor > K_(1) ? minor : K_(1));
        REAL taps = -r_floor(-ratio);
        taps = taps < most ? taps : most;
        taps = taps > K_(1) ? taps : K_(1);
        REAL side = major / taps;
        side = side > minor ? side : minor;
        side = taps > K_(1) ? side : major;
        REAL level = (REAL)wr_log2_f((float)(side > K_(1) ? side : K_(1)));
        strip->level[i] = level < last ? level : last;
        strip->long_u[i] = (r > w ? rx : wx) * per_u;
        strip->long_v[i] = (r > w ? ry : wy) * per_v;
        strip->taps[i] = (int)taps;
    }
}

/* Mean and covariance of some slopes. */
typedef struct Moments {
    Four mean;   /* Fu, Fv, F */
    Four spread; /* Suu, Suv, Svv */
} Moments;

/* Mixes a with the part r of b: the distance of the two means adds to the covariance, so that it can never
   become negative (HC93). */
ALWAYS Moments moments_mix(Moments a, Moments b, REAL r)
{
    Four d = b.mean - a.mean;
    REAL k = r * (K_(1) - r);
    Four apart = { k * d[0] * d[0], k * d[0] * d[1], k * d[1] * d[1], K_(0) };
    return (Moments){ a.mean + r * d, a.spread + r * (b.spread - a.spread) + apart };
}

ALWAYS Moments moments_at(const WrPyramidLevel *level, int floats, bool moments, REAL tu, REAL tv)
{
    REAL x = (REAL)level->width * tu - K_(0.5), y = (REAL)level->height * (K_(1) - tv) - K_(0.5);
    REAL i = r_floor(x), j = r_floor(y), a = x - i, b = y - j;
    const float *top =
        level->data +
        ((size_t)((int)j + 1) * (size_t)level->pitch + (size_t)((int)i + 1)) * (size_t)floats;
    const float *low = top + (size_t)level->pitch * (size_t)floats;
    const Four none = { 0 };
    if (!moments) {
        Four t0 = load_floats(top), l0 = load_floats(low);
        Four upper = t0 + a * (load_floats(top + floats) - t0);
        Four lower = l0 + a * (load_floats(low + floats) - l0);
        return (Moments){ upper + b * (lower - upper), none };
    }
    Moments t0 = { load_floats(top), load_floats(top + 4) };
    Moments t1 = { load_floats(top + floats), load_floats(top + floats + 4) };
    Moments l0 = { load_floats(low), load_floats(low + 4) };
    Moments l1 = { load_floats(low + floats), load_floats(low + floats + 4) };
    return moments_mix(moments_mix(t0, t1, a), moments_mix(l0, l1, a), b);
}

/* Interpolates between two levels; below level 1 returns level 1, which the caller mixes with the table itself. */
ALWAYS Moments moments_between(const LOOK *look, bool moments, const STRIP *strip, int k)
{
    const WrPyramid *pyramid = look->pyramid;
    REAL level = strip->level[k], whole = r_floor(level);
    int low = (int)whole;
    low = low > 1 ? low : 1;
    Moments at =
        moments_at(&pyramid->level[low], pyramid->floats, moments, strip->tu[k], strip->tv[k]);
    REAL t = level - (REAL)low;
    if (!(t > K_(0))) return at;
    Moments next =
        moments_at(&pyramid->level[low + 1], pyramid->floats, moments, strip->tu[k], strip->tv[k]);
    if (moments) return moments_mix(at, next, t);
    return (Moments){ at.mean + t * (next.mean - at.mean), at.spread };
}

FLAT static void kern_look_pyramid(const LOOK *look, bool moments, STRIP *strip)
{
    const int count = strip->count;
    const Scales by = scales_of(look);
    kern_reduce(look, strip);
    for (int k = 0; k < count; k++) {
        Moments m = moments_between(look, moments, strip, k);
        put_look(strip, k, by, m.mean[2], m.mean[0], m.mean[1]);
        REAL in_u = strip->inside_u[k], in_v = strip->inside_v[k];
        strip->suu[k] = bounded(m.spread[0] * by.u * by.u * in_u);
        strip->suv[k] = bounded(m.spread[1] * by.u * by.v * in_u * in_v);
        strip->svv[k] = bounded(m.spread[2] * by.v * by.v * in_v);
    }
}

FLAT static void kern_colour_pyramid(const LOOK *look, STRIP *strip)
{
    const int count = strip->count;
    kern_reduce(look, strip);
    for (int k = 0; k < count; k++) {
        Four c = moments_between(look, false, strip, k).mean;
        strip->cr[k] = c[0];
        strip->cg[k] = c[1];
        strip->cb[k] = c[2];
    }
}
