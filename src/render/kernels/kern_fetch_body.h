/* kern_fetch_body.h - fetches of heights, slopes and colours from the contiguous copies. Part of kern_body.h. */

/* ---- positions in the table ---- */

/* Fractional part, 0 <= t < 1. */
ALWAYS REAL turned(REAL x)
{
    REAL turn = x - r_floor(x);
    return turn < 1.0f ? turn : 0.0f;
}

/* 1 inside; 0 beyond the end of a clamped axis, which is flat there. */
ALWAYS REAL inside_ends(REAL x)
{
    return x >= 0.0f ? (x <= 1.0f ? 1.0f : 0.0f) : 0.0f;
}

/* r t before reduction to the table; wide: reduced in double (E10).
   HC40: r u in float is off by whole texels for large r; the product and its floor in double are not. */
ALWAYS REAL replicated(REAL t, REAL narrow, double r, const bool wide, const bool periodic)
{
    double x = r * (double)t, whole = periodic ? __builtin_floor(x) : 0.0;
    return wide ? (REAL)(x - whole) : narrow * t;
}

/* A choice that is equal for all samples prevents vectorisation inside a loop: one loop for each case. */
ALWAYS void reduce_case(int count, const REAL *restrict t, double r, const bool wide,
                        const bool periodic, REAL *restrict out, REAL *restrict inside)
{
    const REAL narrow = (REAL)r;
    SIMD for (int i = 0; i < count; i++)
    {
        REAL x = replicated(t[i], narrow, r, wide, periodic);
        out[i] = periodic ? turned(x) : clamp01(x);
        inside[i] = periodic ? K_(1) : inside_ends(x);
    }
}

/* r t reduced to the table: 0..1. */
static inline void reduce_axis(int count, const REAL *restrict t, double r, bool wide,
                               bool periodic, REAL *restrict out, REAL *restrict inside)
{
    if (wide && periodic) reduce_case(count, t, r, true, true, out, inside);
    else if (wide) reduce_case(count, t, r, true, false, out, inside);
    else if (periodic) reduce_case(count, t, r, false, true, out, inside);
    else reduce_case(count, t, r, false, false, out, inside);
}

FLAT static void kern_reduce(const LOOK *look, STRIP *strip)
{
    reduce_axis(strip->count, strip->u, look->ru, look->wide, look->periodic_u, strip->tu,
                strip->inside_u);
    reduce_axis(strip->count, strip->v, look->rv, look->wide, look->periodic_v, strip->tv,
                strip->inside_v);
}

/* Stores the first tap of sample k: at[k] is the texel up and left of it, ta and tb the fractions past that
   texel. */
ALWAYS void put_tap(STRIP *strip, int k, REAL x, REAL y, int pitch)
{
    REAL i = r_floor(x), j = r_floor(y);
    strip->at[k] = ((int)j + WR_APRON) * pitch + (int)i + WR_APRON;
    strip->ta[k] = x - i;
    strip->tb[k] = y - j;
}

/* A fetch is three loops: positions (vectors), copies of the taps into rows of the strip (four numbers at a
   time, no slower than gathering), arithmetic (vectors). For a table that is periodic in both directions,
   positions need only one loop. */
static inline void place_taps(const LOOK *look, STRIP *strip)
{
    const int pitch = look->pitch, count = strip->count;
    const REAL W = (REAL)look->width, H = (REAL)look->height;
    if (look->wide || !look->periodic_u || !look->periodic_v) {
        kern_reduce(look, strip);
        SIMD for (int k = 0; k < count; k++)
        {
            put_tap(strip, k, W * strip->tu[k] - 0.5f, H * (1.0f - strip->tv[k]) - 0.5f, pitch);
        }
        return;
    }
    const REAL ru = (REAL)look->ru, rv = (REAL)look->rv;
    SIMD for (int k = 0; k < count; k++)
    {
        REAL tu = turned(ru * strip->u[k]), tv = turned(rv * strip->v[k]);
        strip->tu[k] = tu;
        strip->tv[k] = tv;
        strip->inside_u[k] = strip->inside_v[k] = K_(1);
        put_tap(strip, k, W * tu - 0.5f, H * (1.0f - tv) - 0.5f, pitch);
    }
}

static inline REAL bounded(REAL x)
{
    x = x < FLT_MAX ? x : FLT_MAX;
    return x > -FLT_MAX ? x : -FLT_MAX;
}

/* Factors of F, Fu and Fv. */
typedef struct Scales {
    REAL f, u, v;
} Scales;

ALWAYS Scales scales_of(const LOOK *look)
{
    return (Scales){ look->scale_f, look->scale_u, look->scale_v };
}

/* `inside` is 0 beyond the end of a clamped axis. Slopes are bounded to FLT_MAX, so that bump stays finite
   (HC15). */
ALWAYS void put_slopes(STRIP *strip, int k, Scales by, REAL fu, REAL fv)
{
    strip->fu[k] = bounded(fu * by.u * strip->inside_u[k]);
    strip->fv[k] = bounded(fv * by.v * strip->inside_v[k]);
}

ALWAYS void put_look(STRIP *strip, int k, Scales by, REAL f, REAL fu, REAL fv)
{
    strip->f[k] = bounded(f * by.f);
    put_slopes(strip, k, by, fu, fv);
}

/* ---- heights and slopes ---- */

/* Four neighbouring texels at once. */
typedef REAL Four __attribute__((vector_size(4 * sizeof(REAL))));

static inline Four load_four(const REAL *from)
{
    Four four;
    memcpy(&four, from, sizeof four);
    return four;
}

/* Four neighbouring texels of a single-precision picture or pyramid. */
static inline Four load_floats(const float *from)
{
    return (Four){ (REAL)from[0], (REAL)from[1], (REAL)from[2], (REAL)from[3] };
}

/* Two neighbouring texels of the upper and the lower row, stored side by side. */
static inline void copy_pairs(const REAL *table, int pitch, int texel, STRIP *strip)
{
    const int count = strip->count;
    for (int k = 0; k < count; k++) {
        const REAL *top = table + (size_t)texel * (size_t)strip->at[k];
        const REAL *low = top + (size_t)texel * (size_t)pitch;
        memcpy(strip->top + 2 * texel * k, top, 2 * (size_t)texel * sizeof *top);
        memcpy(strip->low + 2 * texel * k, low, 2 * (size_t)texel * sizeof *low);
    }
}

/* F and its own derivative, which jumps at texel centres (HC54). Differences come first: exactly 0 on flat
   tables (HC42, HC47). */
FLAT static void kern_look_bilinear(const LOOK *look, STRIP *strip)
{
    const int count = strip->count;
    const REAL W = (REAL)look->width, H = (REAL)look->height;
    const Scales by = scales_of(look);
    place_taps(look, strip);
    copy_pairs(look->heights, look->pitch, 1, strip);
    SIMD for (int k = 0; k < count; k++)
    {
        REAL f00 = strip->top[2 * k], f10 = strip->top[2 * k + 1], a = strip->ta[k];
        REAL f01 = strip->low[2 * k], f11 = strip->low[2 * k + 1], b = strip->tb[k];
        REAL d0 = f10 - f00, d1 = f11 - f01, e0 = f01 - f00, e1 = f11 - f10;
        REAL upper = f00 + a * d0, lower = f01 + a * d1;
        REAL fu = W * (d0 + b * (d1 - d0)), fv = -H * (e0 + a * (e1 - e0));
        put_look(strip, k, by, upper + b * (lower - upper), fu, fv);
    }
}

/* Theorem: with E = one texel the paper's FU is the bilinear interpolation of the table of central differences:
   one fetch from the gradient table instead of four FVALs (NUMERICS a.1, item 6). */
static inline void slopes_central(const LOOK *look, STRIP *strip)
{
    const int pitch = look->pitch, count = strip->count;
    const Scales by = scales_of(look);
    const REAL *const gradient = look->gradient;
    REAL *restrict const column = strip->top; /* Fu, Fv of the left texel, then of the right */
    place_taps(look, strip);
    for (int k = 0; k < count; k++) {
        const REAL *at = gradient + 2 * (size_t)strip->at[k];
        Four top = load_four(at), low = load_four(at + 2 * (size_t)pitch);
        Four both = top + strip->tb[k] * (low - top);
        memcpy(column + 4 * k, &both, sizeof both);
    }
    SIMD for (int k = 0; k < count; k++)
    {
        const REAL fu = strip->top[4 * k], fv = strip->top[4 * k + 1], a = strip->ta[k];
        put_slopes(strip, k, by, fu + a * (strip->top[4 * k + 2] - fu),
                   fv + a * (strip->top[4 * k + 3] - fv));
    }
}

/* Heights as well, for exact mode. */
FLAT static void kern_look_central(const LOOK *look, STRIP *strip)
{
    slopes_central(look, strip);
    const int count = strip->count;
    const REAL scale_f = look->scale_f;
    if (!look->heights) {
        memset(strip->f, 0, (size_t)count * sizeof *strip->f);
        return;
    }
    copy_pairs(look->heights, look->pitch, 1, strip);
    SIMD for (int k = 0; k < count; k++)
    {
        REAL a = strip->ta[k], f00 = strip->top[2 * k], f01 = strip->low[2 * k];
        REAL upper = f00 + a * (strip->top[2 * k + 1] - f00);
        REAL lower = f01 + a * (strip->low[2 * k + 1] - f01);
        strip->f[k] = bounded((upper + strip->tb[k] * (lower - upper)) * scale_f);
    }
}

/* The texel that contains the point, and the central difference there. */
FLAT static void kern_look_nearest(const LOOK *look, STRIP *strip)
{
    const int pitch = look->pitch, count = strip->count;
    const REAL W = (REAL)look->width, H = (REAL)look->height;
    const Scales by = scales_of(look);
    kern_reduce(look, strip);
    SIMD for (int k = 0; k < count; k++)
    {
        REAL i = r_floor(W * strip->tu[k]), j = r_floor(H * (1.0f - strip->tv[k]));
        strip->at[k] = ((int)j + WR_APRON) * pitch + (int)i + WR_APRON;
    }
    /* Beyond a clamped end the last texel continues: `inside` is 0 there, except at the end itself. */
    const int last_i = look->periodic_u ? look->width : look->width - 1;
    const int last_j = look->periodic_v ? look->height : look->height - 1;
    for (int k = 0; k < count; k++) {
        int i = strip->at[k] % pitch - WR_APRON, j = strip->at[k] / pitch - WR_APRON;
        int at =
            strip->at[k] - (i > last_i ? i - last_i : 0) - (j > last_j ? j - last_j : 0) * pitch;
        strip->top[2 * k] = look->gradient[2 * (size_t)at];
        strip->top[2 * k + 1] = look->gradient[2 * (size_t)at + 1];
        strip->low[k] = look->heights ? look->heights[at] : 0.0f;
    }
    SIMD for (int k = 0; k < count; k++)
    {
        put_look(strip, k, by, strip->low[k], strip->top[2 * k], strip->top[2 * k + 1]);
    }
}

/* Weights of the taps for the value and, for slopes in difference form, of the differences between neighbouring
   taps. */
typedef struct Weights {
    REAL w0, w1, w2, w3;
    REAL d0, d1, d2;
} Weights;

/* w: uniform cubic B-spline at t past the second tap; d: quadratic B-spline of the differences. */
static inline Weights bspline_weights(REAL t)
{
    REAL s = 1.0f - t, t2 = t * t, t3 = t2 * t;
    return (Weights){ s * s * s * (K_(1) / K_(6)),
                      (4.0f - 6.0f * t2 + 3.0f * t3) * (K_(1) / K_(6)),
                      (1.0f + 3.0f * t + 3.0f * t2 - 3.0f * t3) * (K_(1) / K_(6)),
                      t3 * (K_(1) / K_(6)),
                      0.5f * s * s,
                      0.5f + t - t2,
                      0.5f * t2 };
}

/* d follows from w by summation by parts: d0 = -w0', d1 = -(w0' + w1'), d2 = w3'. */
static inline Weights catmull_weights(REAL t)
{
    REAL t2 = t * t, t3 = t2 * t;
    return (Weights){ 0.5f * (-t3 + 2.0f * t2 - t),         0.5f * (3.0f * t3 - 5.0f * t2 + 2.0f),
                      0.5f * (-3.0f * t3 + 4.0f * t2 + t),  0.5f * (t3 - t2),
                      0.5f * (3.0f * t2 - 4.0f * t + 1.0f), 0.5f * (-6.0f * t2 + 6.0f * t + 1.0f),
                      0.5f * (3.0f * t2 - 2.0f * t) };
}

/* 4 x 4 taps: first down the rows, four columns side by side, then across. Each value is the second tap plus
   weighted differences (the weights sum to 1), so that a flat table yields its own height and slopes of exactly 0
   (HC47). Slopes are per texel. */
ALWAYS void look_cubic(const LOOK *look, STRIP *strip, Weights (*const weights)(REAL t))
{
    const int pitch = look->pitch, count = strip->count;
    const REAL W = (REAL)look->width, H = (REAL)look->height;
    const Scales by = scales_of(look);
    place_taps(look, strip);
    for (int k = 0; k < count; k++) {
        const REAL *at = look->heights + strip->at[k] - 1;
        Four r0 = load_four(at - pitch), r1 = load_four(at);
        Four r2 = load_four(at + pitch), r3 = load_four(at + 2 * (ptrdiff_t)pitch);
        Weights a = weights(strip->ta[k]), b = weights(strip->tb[k]);
        Four c = r1 + (b.w0 * (r0 - r1) + (b.w2 * (r2 - r1) + b.w3 * (r3 - r1)));
        Four e = b.d0 * (r1 - r0) + (b.d1 * (r2 - r1) + b.d2 * (r3 - r2));
        REAL f = c[1] + (a.w0 * (c[0] - c[1]) + (a.w2 * (c[2] - c[1]) + a.w3 * (c[3] - c[1])));
        REAL fu = a.d0 * (c[1] - c[0]) + (a.d1 * (c[2] - c[1]) + a.d2 * (c[3] - c[2]));
        REAL fv = a.w0 * e[0] + a.w1 * e[1] + a.w2 * e[2] + a.w3 * e[3];
        put_look(strip, k, by, f, fu * W, fv * -H);
    }
}

FLAT static void kern_look_bspline(const LOOK *look, STRIP *strip)
{
    look_cubic(look, strip, bspline_weights);
}

FLAT static void kern_look_catmull(const LOOK *look, STRIP *strip)
{
    look_cubic(look, strip, catmull_weights);
}

/* Bilinear interpolation of four texels R, G, B, A starting at `at`, by ta and tb: 4 numbers per sample, in top. */
ALWAYS void mix_texels(const float *restrict rgba, int pitch, STRIP *strip)
{
    const int count = strip->count;
    REAL *restrict const texel = strip->top;
    for (int k = 0; k < count; k++) {
        const float *top = rgba + 4 * (ptrdiff_t)strip->at[k], *low = top + 4 * (ptrdiff_t)pitch;
        const REAL a = strip->ta[k], b = strip->tb[k];
        Four t0 = load_floats(top), t1 = load_floats(top + 4);
        Four l0 = load_floats(low), l1 = load_floats(low + 4);
        Four upper = t0 + a * (t1 - t0), lower = l0 + a * (l1 - l0);
        Four c = upper + b * (lower - upper);
        memcpy(texel + 4 * k, &c, sizeof c);
    }
}

/* Bilinear C(u,v): Catmull's texturing, with the table's replication. */
FLAT static void kern_colour(const WrColourLook *look, STRIP *strip)
{
    const int pitch = look->pitch, count = strip->count;
    const REAL W = (REAL)look->width, H = (REAL)look->height;
    reduce_axis(count, strip->u, look->ru, false, look->periodic_u, strip->tu, strip->inside_u);
    reduce_axis(count, strip->v, look->rv, false, look->periodic_v, strip->tv, strip->inside_v);
    SIMD for (int k = 0; k < count; k++)
    {
        REAL x = W * strip->tu[k] - 0.5f, y = H * (1.0f - strip->tv[k]) - 0.5f;
        REAL i = r_floor(x), j = r_floor(y);
        strip->at[k] = ((int)j + 1) * pitch + (int)i + 1;
        strip->ta[k] = x - i;
        strip->tb[k] = y - j;
    }
    mix_texels(look->rgba, pitch, strip);
    const REAL *restrict const texel = strip->top;
    SIMD for (int k = 0; k < count; k++)
    {
        strip->cr[k] = texel[4 * k];
        strip->cg[k] = texel[4 * k + 1];
        strip->cb[k] = texel[4 * k + 2];
    }
}
