/* simd_sphere_body.h - SIMD spheres seen from outside: u and v, chords of rows without bumps, hits and frames, n' from
   slopes. Part of simd_set_body.h. */

/* ---- u and v ---- */

/* The angle in turns from sine and cosine, both non-negative, by the smaller one times `by`; error up to 2e-7. */
ALWAYS Wide turns_of(Wide sine, Wide cosine, Wide by)
{
    const Wide s = w_min(sine, cosine) * by, w = s * s;
    const Wide high =
        w_all(0.00955011882f) + w * (w_all(-0.00352944806f) + w * w_all(0.0150733879f));
    const Wide a = s * (w_all(0.159154847f) +
                        w * (w_all(0.0265393257f) + w * (w_all(0.0116312345f) + w * high)));
    return w_pick(w_less(cosine, sine), w_all(0.25f) - a, a);
}

/* n contains all sines and cosines, except the distance from the axis. by: 1 / |n|. */
ALWAYS void put_parameters_of(WideVec n, Wide by, WrStrip *strip, int i)
{
    const Wide zero = w_all(0.0f), one = w_all(1.0f), half = w_all(0.5f);
    const Wide flat = n.x * n.x + n.y * n.y, inv = w_rsqrt(w_max(flat, w_all(1e-37f)));
    Wide u = turns_of(w_abs(n.y), w_abs(n.x), inv);
    u = w_pick(w_less(n.x, zero), half - u, u);
    u = w_pick(w_less(n.y, zero), one - u, u);
    const Wide a = turns_of(w_abs(n.z), flat * inv, by);
    w_store(strip->u + i, w_kept(w_less(u, one), u));
    w_store(strip->v + i, w_min(w_max(half + w_all(2.0f) * w_signed(a, n.z), zero), one));
}

static void put_parameters(WrStrip *strip)
{
    for (int i = 0; i < strip->count; i += WIDE)
        put_parameters_of(W_LOAD3(strip, n, i), w_all(1.0f), strip, i);
}

/* ---- chords of a row ---- */

/* SIMD evaluation of sphere rows (sphere_rows.h). Part of simd_set_body.h. */

/* gx + i is exact for whole numbers up to 2^24; x of neighbouring lanes differ by 1. */
ALWAYS Wide row_places(float gx, int i)
{
    return w_all(gx + (float)i) + w_count();
}

typedef struct WideCurve {
    Wide c0, c1, c2;
} WideCurve;

ALWAYS WideCurve w_curve(const WrForm *form, const WrChord *chord)
{
    float c[3];
    wr_form_along(form, chord, c);
    return (WideCurve){ w_all(c[0]), w_all(c[1]), w_all(c[2]) };
}
/* Horner's scheme: two products per polynomial and pixel. */
ALWAYS Wide w_bent(WideCurve of, Wide x)
{
    return of.c0 + x * (of.c1 + x * of.c2);
}
ALWAYS Wide w_straight(WideCurve of, Wide x)
{
    return of.c0 + x * of.c1;
}

/* n.w along a row. */
typedef struct WideSlant {
    WideCurve along, across;
} WideSlant;

ALWAYS WideSlant w_slant(const WrSlant *of, const WrChord *chord)
{
    return (WideSlant){ w_curve(&of->along, chord), w_curve(&of->across, chord) };
}
/* n.w times d.d. */
ALWAYS Wide w_slanted(const WideSlant *of, Wide x, Wide r)
{
    return w_bent(of->along, x) - r * w_straight(of->across, x);
}

/* n and 1 / |d|; false: positions are not exact. */
static bool chord_points(const WrSphereRows *ball, float gx, float gy, int count, WrStrip *strip)
{
    WrChord chord;
    if (!wr_chord_of(ball, (double)gx, (double)gy, count, &chord)) return false;
    const WideCurve dd = w_curve(&ball->dd, &chord), rr = w_curve(&ball->rr, &chord);
    const WideSlant x_of = w_slant(&ball->n[0], &chord), y_of = w_slant(&ball->n[1], &chord);
    const WideSlant z_of = w_slant(&ball->n[2], &chord);
    const float from = (float)((double)gx - chord.middle);
    const int hits = chord.last - chord.first + 1;
    strip->count = hits > 0 ? hits : 0;
    for (int i = 0; i < hits; i += WIDE) {
        const Wide x = row_places(from, chord.first + i);
        const Wide inv = w_rsqrt(w_bent(dd, x)), r = w_root(w_bent(rr, x));
        const WideVec n = { w_slanted(&x_of, x, r), w_slanted(&y_of, x, r),
                            w_slanted(&z_of, x, r) };
        const WideVec unit = w_scale(n, inv * inv);
        W_STORE3(strip, n, i, unit);
        w_store(strip->s + i, inv);
        w_store_counted(strip->index + i, chord.first + i);
    }
    return true;
}

/* ---- smooth spheres under a distant lamp ---- */

/* The highlight for given n.l, n.v and l.v: n.h = (n.l + n.v) / |l + v|. */
ALWAYS Wide broad_highlight(const Lamp *of, Wide n_dot_l, Wide n_dot_v, Wide l_dot_v)
{
    const Wide half = w_all(0.5f), size = w_max(half + half * l_dot_v, w_all(1e-7f));
    const Wide n_dot_h = (n_dot_l + n_dot_v) * half * w_rsqrt(size);
    WideMask shown = w_less(of->least, n_dot_h);
    if (of->gate) shown = w_both(shown, w_less(w_all(0.0f), n_dot_l));
    return whole_power(w_kept(shown, n_dot_h), of->whole);
}

/* Polynomials along a row from which the light is computed.
   lit = n.l d.d along the row: the light of a smooth sphere needs no n, v or l per pixel. */
typedef struct SmoothRow {
    WideCurve dd, rr;
    WideSlant lit;
    float from; /* x of the row's pixel 0 */
} SmoothRow;

/* Lights the chord. Returns the largest n.l.
   n.v = r / |d|, and l.v = -d.l / |d| from `across`, which is d.l. */
ALWAYS float smooth_chord(const SmoothRow *row, const Scenery *s, const WrWidePaint how, int first,
                          WrStrip *strip)
{
    const int count = strip->count;
    const Wide one = w_all(1.0f);
    Wide largest = w_all(-1.0f);
    for (int i = 0; i < count; i += WIDE) {
        const Wide x = row_places(row->from, first + i);
        const Wide inv = w_rsqrt(w_bent(row->dd, x)), inv2 = inv * inv;
        const Wide r = w_root(w_bent(row->rr, x)), across = w_straight(row->lit.across, x);
        const Wide n_dot_l = (w_bent(row->lit.along, x) - r * across) * inv2;
        const Wide lobe = broad_highlight(&s->lamp, n_dot_l, r * inv, -across * inv);
        const Wide lit = w_max(n_dot_l, w_all(0.0f));
        w_store_counted(strip->index + i, first + i);
        largest = w_max(largest, w_among(w_first_bits(count - i), n_dot_l, largest));
        if (how == WR_WIDE_LATER) {
            w_store(strip->n_dot_l + i, lit), w_store(strip->sr + i, lobe);
            w_store(strip->s + i, r), w_store(strip->n_len + i, inv2);
            continue;
        }
        w_store(strip->cr + i, channel_lit(s->red, one, s->ambient, lit, lobe));
        if (how == WR_WIDE_RED) continue;
        w_store(strip->cg + i, channel_lit(s->green, one, s->ambient, lit, lobe));
        w_store(strip->cb + i, channel_lit(s->blue, one, s->ambient, lit, lobe));
    }
    return w_largest(largest);
}

/* u and v from the values that smooth_chord stored.
   LATER keeps r in strip->s and 1 / d.d in n_len. */
static void chord_parameters(const WrSphereRows *ball, const WrChord *chord, float from,
                             WrStrip *strip)
{
    const int count = strip->count;
    const WideSlant x_of = w_slant(&ball->n[0], chord), y_of = w_slant(&ball->n[1], chord);
    const WideSlant z_of = w_slant(&ball->n[2], chord);
    for (int i = 0; i < count; i += WIDE) {
        const Wide x = row_places(from, chord->first + i);
        const Wide r = w_load(strip->s + i);
        const WideVec n = { w_slanted(&x_of, x, r), w_slanted(&y_of, x, r),
                            w_slanted(&z_of, x, r) };
        put_parameters_of(n, w_load(strip->n_len + i), strip, i);
    }
}

static bool wide_smooth(const WrSphereRows *ball, const WrRays *rays, const WrKernLight *light,
                        const WrKernShine *shine, const WrKernMaterial *material, float gx,
                        float gy, int count, WrWidePaint how, bool *dark, WrStrip *strip)
{
    WrChord chord;
    if (!ball->shown || light->point || whole_exponent(shine) == 0 ||
        !wr_chord_of(ball, (double)gx, (double)gy, count, &chord))
        return false;
    strip->count = chord.last - chord.first + 1;
    *dark = true;
    if (strip->count <= 0) {
        strip->count = 0;
        return true;
    }
    const Scenery s = scenery_of(rays, light, shine, material);
    const SmoothRow row = { w_curve(&ball->dd, &chord), w_curve(&ball->rr, &chord),
                            w_slant(&ball->lit, &chord), (float)((double)gx - chord.middle) };
    float most;
    switch (how) {
    case WR_WIDE_RED: most = smooth_chord(&row, &s, WR_WIDE_RED, chord.first, strip); break;
    case WR_WIDE_ALL: most = smooth_chord(&row, &s, WR_WIDE_ALL, chord.first, strip); break;
    default:
        most = smooth_chord(&row, &s, WR_WIDE_LATER, chord.first, strip);
        chord_parameters(ball, &chord, row.from, strip);
    }
    *dark = !(most > 0.0f);
    return true;
}

/* The picture's colours under that light.
   First the light with LATER, then fetches of colours, then this: the fetch stage reads u and v of the whole
   strip. */
static void wide_paint(const WrRays *rays, const WrKernLight *light, const WrKernShine *shine,
                       const WrKernMaterial *material, WrStrip *strip)
{
    const Scenery s = scenery_of(rays, light, shine, material);
    const int count = strip->count;
    for (int i = 0; i < count; i += WIDE) {
        const Wide lit = w_load(strip->n_dot_l + i), lobe = w_load(strip->sr + i);
        const Wide r = w_load(strip->cr + i), g = w_load(strip->cg + i), b = w_load(strip->cb + i);
        w_store(strip->cr + i, channel_lit(s.red, r, s.ambient, lit, lobe));
        w_store(strip->cg + i, channel_lit(s.green, g, s.ambient, lit, lobe));
        w_store(strip->cb + i, channel_lit(s.blue, b, s.ambient, lit, lobe));
    }
}

/* ---- hits and frames ---- */

/* SIMD spheres seen from outside: ray hits, frame, and n' from slopes. Part of simd_set_body.h. The formulas are those of kern_ray_hit_body.h and kern_bump_body.h, simplified because only the
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
