/* simd_sphere_body.h - SIMD spheres seen from outside: ray hits, frame, and n' from slopes. Part of simd_set_body.h. The formulas are those of kern_ray_hit_body.h and kern_bump_body.h, simplified because only the
   nearer root occurs: n is P / R, it is on the viewer's side, and the direction to the viewer is the reversed
   ray. */

/* Rays of a row, from x = 0 on, with their change per sample to the right; in radii. */
typedef struct RowRays {
    WideVec q, d, qx, dx;
    Wide s_min;
} RowRays;

ALWAYS RowRays row_rays(const WrRays *rays, const WrShapef *shape, float gy)
{
    const float by = 1.0f / shape->value[0];
    float q[3], d[3], qx[3], dx[3];
    for (int c = 0; c < 3; c++) {
        q[c] = by * (rays->q0[c] + gy * rays->qy[c]), qx[c] = by * rays->qx[c];
        d[c] = by * (rays->d0[c] + gy * rays->dy[c]), dx[c] = by * rays->dx[c];
    }
    return (RowRays){ w_alike(q), w_alike(d), w_alike(qx), w_alike(dx), w_all(rays->s_min) };
}

typedef struct Met {
    WideVec n;
    Wide inv;           /* 1 / |d| */
    WideMask hit, near; /* the sphere; its nearer side, before the near plane */
} Met;

ALWAYS Met meet_sphere(const RowRays *rays, Wide x)
{
    Met met;
    const WideVec q = w_mad(rays->q, rays->qx, x), d = w_mad(rays->d, rays->dx, x);
    const Wide inv = w_rsqrt(w_dot(d, d)), inv2 = inv * inv, m = w_dot(q, d) * inv2;
    const WideVec f = w_mad(q, d, -m);
    const Wide part = (w_all(1.0f) - w_dot(f, f)) * inv2, half = w_root(part);
    met.n = w_mad(f, d, -half);
    met.inv = inv;
    met.hit = w_less(w_all(0.0f), part);
    met.near = w_both(met.hit, w_less(rays->s_min, -half - m));
    return met;
}

static double product(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Range of x, from..to, in which samples of a row can hit the sphere; false: any can. A ray o + s d touches it
   where (o.d)^2 - d.d (o.o - 1) is 0, a quadratic in x: either o is the eye for all rays, or d is constant. */
static bool reach_of_row(const WrRays *rays, const WrShapef *shape, float gy, double *from,
                         double *to)
{
    double o[3], ox[3], d[3], dx[3];
    for (int c = 0; c < 3; c++) {
        const double by = 1 / (double)shape->value[0], y = (double)gy;
        o[c] = by * (rays->perspective ? (double)rays->eye[c]
                                       : (double)rays->q0[c] + y * (double)rays->qy[c]);
        ox[c] = rays->perspective ? 0 : by * (double)rays->qx[c];
        d[c] = (double)rays->d0[c] + y * (double)rays->dy[c], dx[c] = (double)rays->dx[c];
    }
    const double od = product(o, d), oxd = rays->perspective ? product(o, dx) : product(ox, d);
    const double oo = product(o, o) - 1, dd = product(d, d);
    const double a = oxd * oxd - (rays->perspective ? oo * product(dx, dx) : dd * product(ox, ox));
    const double b = oxd * od - (rays->perspective ? oo * product(dx, d) : dd * product(ox, o));
    const double disc = b * b - a * (od * od - dd * oo);
    if (!(a < 0 && disc > 0 && oo < 1e6)) return false;
    /* The eye is rounded to 2^-24 of its distance, and so are positions in the grid. */
    const double half = sqrt(disc) / -a, more = 3 + 1e-6 * half * (1 + sqrt(oo + 1));
    *from = -b / a - half - more, *to = -b / a + half + more;
    return true;
}

/* Start of a row's hits; count: none. */
static int first_hit(const WrRays *rays, const WrShapef *shape, const RowRays *row, float gx,
                     float gy, int count)
{
    for (int i = 0; i < count; i += WIDE) {
        const unsigned hit = w_bits(meet_sphere(row, row_places(gx, i)).hit);
        double from, to;
        if (hit && i + __builtin_ctz(hit) < count) return i + __builtin_ctz(hit);
        if (hit) return count;
        if (i > 0 || !reach_of_row(rays, shape, gy, &from, &to)) continue;
        if (to < (double)gx || from > (double)gx + count) return count;
        if (from > (double)gx + 2 * WIDE) i = (int)(from - (double)gx) - WIDE;
    }
    return count;
}

/* Number of lanes from the first on; -1: not all hits are neighbours and in front. */
ALWAYS int run_of(const Met *met, int most)
{
    const unsigned all = w_first_bits(most);
    const unsigned hit = w_bits(met->hit) & all, near = w_bits(met->near) & all;
    if (hit != near || (hit & (hit + 1)) != 0) return -1;
    return __builtin_popcount(hit);
}

/* ---- rows ---- */

/* Finds the hits of a row. */
static bool meet_row(const RowRays *row, float gx, int first, int count, WrStrip *strip)
{
    int hits = 0;
    for (int i = first, run = WIDE; i < count; i += WIDE) {
        const Met met = meet_sphere(row, row_places(gx, i));
        const int now = run_of(&met, count - i);
        if (now < 0 || (run < WIDE && now > 0)) return false;
        if (now == 0) break;
        W_STORE3(strip, n, hits, met.n);
        w_store(strip->s + hits, met.inv);
        w_store_counted(strip->index + hits, i);
        hits += run = now;
    }
    strip->count = hits;
    return true;
}

static void wide_points(const WrShapef *shape, WrStrip *strip)
{
    const float radius = shape->value[0];
    for (int i = 0; i < strip->count; i += WIDE) {
        const WideVec p = w_scale(W_LOAD3(strip, n, i), w_all(radius));
        W_STORE3(strip, p, i, p);
    }
}

static bool wide_sphere(const WrSphereRows *ball, const WrRays *rays, const WrShapef *shape,
                        float gx, float gy, int count, bool mapped, WrStrip *strip)
{
    if (ball && ball->good) {
        if (!chord_points(ball, gx, gy, count, strip)) return false;
    } else {
        const RowRays row = row_rays(rays, shape, gy);
        const int first = first_hit(rays, shape, &row, gx, gy, count);
        if (!meet_row(&row, gx, first, count, strip)) return false;
    }
    if (mapped) put_parameters(strip);
    return true;
}

/* ---- n' and light at once ---- */

/* A normalised vector; `other` if it is too short to have a direction. */
ALWAYS WideVec w_unit_or(WideVec a, WideVec other)
{
    const Wide tiny = w_all(1e-30f), aa = w_dot(a, a);
    return w_pick3(w_less(tiny, aa), w_scale(a, w_rsqrt(w_max(aa, tiny))), other);
}

/* N' as in bend_sphere, 2^30 times as long, so that it does not underflow near a pole. */
ALWAYS WideVec bend_wide(Wide scale, WideVec n, Wide fu, Wide fv)
{
    const Wide large = w_all(0x1p30f);
    const Wide cl2 = n.x * n.x + n.y * n.y, cl = cl2 * w_rsqrt(w_max(cl2, w_all(1e-30f)));
    const Wide m = scale * cl2, q = w_all(0x1p31f) * fv * cl, qz = m + q * n.z, t = large * fu;
    const WideVec bent = { qz * n.x + t * n.y, qz * n.y - t * n.x, m * n.z - q * cl2 };
    return w_unit_or(bent, n);
}

#define GENTLE 1e6f /* slopes up to this need no scaling */

/* n' of the strip into b; false: some slope is steeper than that. */
static bool bend_row(float radius, WrStrip *strip)
{
    const Wide scale = w_all(0x1p30f * 6.28318531f * radius);
    const int count = strip->count;
    Wide most = w_all(0.0f);
    for (int i = 0; i < count; i += WIDE) {
        const WideVec n = W_LOAD3(strip, n, i);
        const Wide fu = w_load(strip->fu + i), fv = w_load(strip->fv + i);
        const WideVec bent = bend_wide(scale, n, fu, fv);
        W_STORE3(strip, b, i, bent);
        most = w_max(most, w_among(w_first_bits(count - i), w_max(w_abs(fu), w_abs(fv)), most));
    }
    return w_largest(most) <= GENTLE;
}

/* Lights the row. Returns the largest n'.l, or -1. */
ALWAYS float light_row(const RowRays *row, const Scenery *s, float gx, const bool point,
                       const bool pictured, const bool bent, WrStrip *strip)
{
    const int count = strip->count, first = strip->index[0];
    Wide most = w_all(-1.0f);
    for (int i = 0; i < count; i += WIDE) {
        const WideVec d = w_mad(row->d, row->dx, row_places(gx, first + i));
        const WideVec p = point ? W_LOAD3(strip, p, i) : d, v = w_scale(d, -w_load(strip->s + i));
        const WideVec n = bent ? W_LOAD3(strip, b, i) : W_LOAD3(strip, n, i);
        const Wide n_dot_l = put_colour(s, point, pictured, p, n, v, strip, i);
        most = w_max(most, w_among(w_first_bits(count - i), n_dot_l, most));
    }
    return w_largest(most);
}

static bool wide_sphere_light(const WrRays *rays, const WrShapef *shape, const WrKernLight *light,
                              const WrKernShine *shine, const WrKernMaterial *material, float gx,
                              float gy, bool pictured, bool bent, bool *dark, WrStrip *strip)
{
    const int which = (light->point ? 4 : 0) + (pictured ? 2 : 0) + (bent ? 1 : 0);
    float most;
    if (!narrow(light, shine) || (bent && !bend_row(shape->value[0], strip))) return false;
    const Scenery s = scenery_of(rays, light, shine, material);
    const RowRays row = row_rays(rays, shape, gy);
    switch (which) {
    case 0: most = light_row(&row, &s, gx, false, false, false, strip); break;
    case 1: most = light_row(&row, &s, gx, false, false, true, strip); break;
    case 2: most = light_row(&row, &s, gx, false, true, false, strip); break;
    case 3: most = light_row(&row, &s, gx, false, true, true, strip); break;
    case 4: most = light_row(&row, &s, gx, true, false, false, strip); break;
    case 5: most = light_row(&row, &s, gx, true, false, true, strip); break;
    case 6: most = light_row(&row, &s, gx, true, true, false, strip); break;
    default: most = light_row(&row, &s, gx, true, true, true, strip); break;
    }
    *dark = !(most > 0.0f);
    return true;
}
