/* kern_svbrdf_body.h - lamps and environment on strips with roughness and metalness for each sample
   (strip->rough, strip->metal). Part of kern_body.h; the formulas are in shade/reflection_body.h and
   shade/environment_map_body.h.

   Fetches from a table of roughness are three loops: positions, rows mixed four numbers at a time, arithmetic. */

/* Position of the samples among the sixteenths of roughness. */
typedef struct Steps {
    int low[WR_SPAN];
    REAL t[WR_SPAN];
} Steps;

ALWAYS void find_step(REAL rough, int i, Steps *to)
{
    const REAL x = between(rough, K_(0), K_(1)) * (REAL)(WR_SVBRDF_STEPS - 1), whole = r_floor(x);
    to->low[i] = among((int)whole, WR_SVBRDF_STEPS);
    to->t[i] = x - whole;
}

ALWAYS int next_step(int low)
{
    return low + 1 < WR_SVBRDF_STEPS ? low + 1 : low;
}

/* reflect_terms of x without its last sum: four partial sums per sample.
   Albedo polynomials of degree 11 in x = sqrt(cos), with coefficients tabulated for STEPS roughnesses and
   interpolated linearly. Four lanes hold the powers 0 to 3; Horner's scheme in x^4 combines coefficients k, k
   + 4, k + 8. */
ALWAYS void vary_parts(const REAL (*table)[WR_SVBRDF_TERMS], const Steps *at,
                       const REAL *restrict x, int count, REAL *restrict part)
{
    for (int i = 0; i < count; i++) {
        const REAL *low = table[at->low[i]], *high = table[next_step(at->low[i])];
        const REAL t = at->t[i], xx = x[i] * x[i], x4 = xx * xx;
        const Four a = load_four(low), b = load_four(low + 4), c = load_four(low + 8);
        const Four first = a + t * (load_four(high) - a), mid = b + t * (load_four(high + 4) - b);
        const Four last = c + t * (load_four(high + 8) - c), sum = first + (mid + last * x4) * x4;
        memcpy(part + 4 * i, &sum, sizeof sum);
    }
}

ALWAYS REAL vary_sum(const REAL *part, REAL x)
{
    return (part[0] + part[1] * x) + (part[2] + part[3] * x) * (x * x);
}

ALWAYS void vary_values(const REAL *of, const Steps *at, int count, REAL *restrict out)
{
    for (int i = 0; i < count; i++) {
        const REAL low = of[at->low[i]];
        out[i] = low + at->t[i] * (of[next_step(at->low[i])] - low);
    }
}

/* The material at a sample, except for the energy left by its highlights.
   alpha = roughness^2, at least WR_ALPHA_MIN, as wr_matter_init; the polynomials of the energy-preserving
   Oren-Nayar model (Portsmouth, Kutz, Hill): A = 1 / (1 + (1/2 - 2/(3 pi)) s), B = A s, its mean albedo A (1 +
   (2/3 - 28/(15 pi)) s), and 1 / (1 - mean) for the light of several reflections. */
ALWAYS MATTER vary_matter(const MATTER *m, const bool kept, REAL roughness, REAL metal)
{
    const REAL rough = between(roughness, K_(0), K_(1)), s = rough, ss = s * s;
    MATTER out = { .kd = m->kd, .ks = m->ks, .ior = m->ior, .f0 = m->f0 };
    out.alpha = larger(rough * rough, K_(WR_ALPHA_MIN));
    out.metal = between(metal, K_(0), K_(1));
    out.scale = kept ? m->scale : out.alpha * out.alpha;
    /* of oren-nayar, as in wr_matter_init; unused for other models, so their loops omit them */
    if (!kept)
        out.a = K_(1) - K_(0.5) * ss / (ss + K_(0.33)), out.b = K_(0.45) * ss / (ss + K_(0.09));
    if (kept) {
        out.a = K_(1) / (K_(1) + K_(0.28779340921080631) * s); /* 1/2 - 2/(3 pi) */
        out.b = out.a * s;
        out.mean = out.a * (K_(1) + K_(0.072488212456924341) * s); /* 2/3 - 28/(15 pi) */
        const REAL left = K_(1) - out.mean;
        out.again = s > K_(1e-6) ? K_(1) / (s > K_(1e-6) ? left : K_(1)) : K_(0);
    }
    return out;
}

/* Share of energy that microfacet highlights leave for diffuse light, for each sample.
   (1 - E(l)) (1 - E(v)) again, the coupling of Kelemen and Szirmay-Kalos: reciprocal, and 0 where the
   highlight reflects all. */
ALWAYS void vary_left(const VARY *vary, const STRIP *strip, REAL *restrict left)
{
    REAL to_lamp[WR_SPAN], to_eye[WR_SPAN], lamp[4 * WR_SPAN], eye[4 * WR_SPAN], again[WR_SPAN];
    const int count = strip->count;
    Steps at;
    SIMD for (int i = 0; i < count; i++)
    {
        const VEC n = LOAD3(strip, b, i), v = LOAD3(strip, v, i);
        to_lamp[i] = reflect_root(v_dot(n, LOAD3(strip, l, i)));
        to_eye[i] = reflect_root(v_dot(reflect_seen(n, v), v));
        find_step(strip->rough[i], i, &at);
    }
    vary_parts(vary->albedo, &at, to_lamp, count, lamp);
    vary_parts(vary->albedo, &at, to_eye, count, eye);
    vary_values(vary->again, &at, count, again);
    SIMD for (int i = 0; i < count; i++)
    {
        const REAL a = reflect_least(vary_sum(lamp + 4 * i, to_lamp[i]), K_(1));
        const REAL b = reflect_least(vary_sum(eye + 4 * i, to_eye[i]), K_(1));
        left[i] = (K_(1) - a) * (K_(1) - b) * again[i];
    }
}

ALWAYS void vary_strip(const LIGHT *light, const MATTER *matter, const VARY *vary,
                       const WrReflect model, const Form form, STRIP *strip)
{
    const bool kept = form.kept;
    const MATTER m = *matter;
    const Shone by = shone_of(light, &m);
    const bool twice = wr_reflect_again(&reflect_info[model], kept);
    const bool shares = wr_reflect_shares(&reflect_info[model], kept);
    const Form as = { kept, form.spread, form.round, shares, false, false };
    const int count = strip->count;
    REAL left[WR_SPAN];
    if (shares) vary_left(vary, strip, left);
    SIMD for (int i = 0; i < count; i++)
    {
        const MATTER own = vary_matter(&m, kept, strip->rough[i], strip->metal[i]);
        const Reflected got = reflect_at(strip, i, model, as, shares ? left[i] : K_(0), &own);
        add_reflected(by, got, twice, own.mean, strip, i);
    }
}

ALWAYS void vary_as(const LIGHT *light, const MATTER *m, const VARY *vary, const WrReflect model,
                    const bool kept, WrReflectSpread how, STRIP *strip)
{
    if (how == WR_REFLECT_AS_IT_IS)
        vary_strip(light, m, vary, model, (Form){ .kept = kept }, strip);
    else if (how == WR_REFLECT_LEAN)
        vary_strip(light, m, vary, model, (Form){ .kept = kept, .spread = true }, strip);
    else
        vary_strip(light, m, vary, model, (Form){ .kept = kept, .spread = true, .round = true },
                   strip);
}

#define VARY_ROW(name, MODEL, kept)                                                                \
    FLAT static void vary_##name##_##kept(const LIGHT *light, const MATTER *m, const VARY *vary,   \
                                          WrReflectSpread how, STRIP *strip)                       \
    {                                                                                              \
        vary_as(light, m, vary, MODEL, kept, how, strip);                                          \
    }
#define VARY_LOOPS_STAGES(ID, formula)
#define VARY_LOOPS_UNIFORM(ID, formula)
#define VARY_LOOPS_ROUGH(ID, formula)                                                              \
    VARY_ROW(formula, WR_REFLECT_##ID, 0)                                                          \
    VARY_ROW(formula, WR_REFLECT_##ID, 1)
#define VARY_LOOPS_METAL VARY_LOOPS_ROUGH
#define VARY_LOOPS(ID, formula, LOOPS, ...) VARY_LOOPS_##LOOPS(ID, formula)
WR_REFLECTION_MODELS(VARY_LOOPS)

#define VARY_CASE_STAGES(ID, formula)
#define VARY_CASE_UNIFORM(ID, formula)
#define VARY_CASE_ROUGH(ID, formula) [WR_REFLECT_##ID] = { vary_##formula##_0, vary_##formula##_1 },
#define VARY_CASE_METAL VARY_CASE_ROUGH
#define VARY_CASE(ID, formula, LOOPS, ...) VARY_CASE_##LOOPS(ID, formula)

/* Adds one lamp, by a model with roughness. */
static void kern_reflect_vary(const LIGHT *light, const MATTER *m, const VARY *vary, int model,
                              bool kept, WrReflectSpread how, STRIP *strip)
{
    static void (*const of[WR_REFLECT_COUNT][2])(const LIGHT *, const MATTER *, const VARY *,
                                                 WrReflectSpread,
                                                 STRIP *) = { WR_REFLECTION_MODELS(VARY_CASE) };
    of[model][kept](light, m, vary, how, strip);
}

ALWAYS void surround_vary(const SURROUND *how, const VARY *vary, const bool twice, STRIP *strip)
{
    const SURROUND s = *how;
    const REAL own_r = s.kd * s.colour[0], own_g = s.kd * s.colour[1], own_b = s.kd * s.colour[2];
    const REAL metals = vary->metals ? K_(1) : K_(0);
    const int count = strip->count;
    REAL x[WR_SPAN], matt[4 * WR_SPAN], more[4 * WR_SPAN], mean[WR_SPAN];
    Steps at;
    SIMD for (int i = 0; i < count; i++)
    {
        x[i] = surround_root(LOAD3(strip, b, i), LOAD3(strip, v, i));
        find_step(strip->rough[i], i, &at);
    }
    vary_parts(vary->matt, &at, x, count, matt);
    if (twice) {
        vary_parts(vary->twice, &at, x, count, more);
        vary_values(vary->mean, &at, count, mean);
    }
    SIMD for (int i = 0; i < count; i++)
    {
        const VEC n = LOAD3(strip, b, i);
        const REAL left = K_(1) - metals * between(strip->metal[i], K_(0), K_(1));
        const REAL once = s.kd * left * reflect_positive(vary_sum(matt + 4 * i, x[i]));
        REAL r = once, g = once, b = once;
        if (twice) {
            const REAL again = s.kd * reflect_positive(vary_sum(more + 4 * i, x[i]));
            r += again * reflect_kept(own_r * strip->cr[i], mean[i]);
            g += again * reflect_kept(own_g * strip->cg[i], mean[i]);
            b += again * reflect_kept(own_b * strip->cb[i], mean[i]);
        }
        strip->dr[i] += r * surround_light(s.form[0], n);
        strip->dg[i] += g * surround_light(s.form[1], n);
        strip->db[i] += b * surround_light(s.form[2], n);
    }
}

/* Adds diffuse environment light. */
FLAT static void kern_surround_vary(const SURROUND *how, const VARY *vary, STRIP *strip)
{
    if (vary->again_twice) surround_vary(how, vary, true, strip);
    else surround_vary(how, vary, false, strip);
}

/* Position of a sample's lobe among the blurred environments: by the logarithm of its width; below the narrowest
   lobe by the width.
   The position among rungs is -log2 alpha; below the narrowest lobe a logarithm would never reach the
   mirror, so the share of the mirror is 1 - alpha / least. */
typedef struct Rungs {
    int low[WR_SPAN], high[WR_SPAN];
    REAL t[WR_SPAN];
    REAL u[WR_SPAN], v[WR_SPAN]; /* fetch position, 0..1, v downwards */
} Rungs;

ALWAYS void find_rung(REAL alpha, int i, Rungs *to)
{
    const REAL least = K_(0.015625), wide = between(alpha, least, K_(1)), log = -r_log2(wide);
    const int last = WR_SVBRDF_RUNGS - 2, low = among((int)r_floor(log), last + 1);
    const bool under = alpha < least, ends = low == last;
    to->low[i] = under ? last : low;
    to->high[i] = under ? last + 1 : ends ? low : low + 1;
    const REAL between_two = ends ? K_(0) : log - (REAL)low;
    to->t[i] = under ? K_(1) - between(alpha / least, K_(0), K_(1)) : between_two;
}

/* The direction turns into the map's axes; u and v are angles in turns: u about y, v from the zenith, over
   half a turn. Slopes of covariance S widen alpha^2 by 2 tr(S) / 2. */
ALWAYS void find_rungs(const MIRROR *how, const bool spread, STRIP *strip, Steps *at, Rungs *to,
                       REAL *restrict x)
{
    const MIRROR m = *how;
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        const VEC n = LOAD3(strip, b, i), v = LOAD3(strip, v, i), r = surround_mirrored(n, v);
        const VEC d = { m.axes[0] * r.x + m.axes[1] * r.y + m.axes[2] * r.z,
                        m.axes[3] * r.x + m.axes[4] * r.y + m.axes[5] * r.z,
                        m.axes[6] * r.x + m.axes[7] * r.y + m.axes[8] * r.z };
        const REAL round = r_atan2_turns(d.x, -d.z), u = round < K_(0.5) ? round : round - K_(1);
        const REAL up = r_atan2_turns(d.y, r_sqrt(d.x * d.x + d.z * d.z));
        to->u[i] = u + K_(0.5);
        to->v[i] = K_(0.5) - K_(2) * (up < K_(0.5) ? up : up - K_(1));
        x[i] = surround_root(n, v);
    }
    SIMD for (int i = 0; i < count; i++)
    {
        const REAL rough = between(strip->rough[i], K_(0), K_(1)), a = rough * rough;
        const REAL more = spread ? reflect_positive(strip->see[i] + strip->sff[i]) : K_(0);
        const REAL alpha = spread ? r_sqrt(a * a + more) : a;
        find_rung(alpha, i, to);
        find_step(r_sqrt(between(alpha, K_(0), K_(1))), i, at);
    }
}

/* Fetches a blurred environment at u, v. The integer part of x is computed without a call, because x is above
   -1. */
ALWAYS Four vary_look(const WrKernMipLevel *rung, REAL u, REAL v)
{
    const REAL W = (REAL)rung->width, H = (REAL)rung->height;
    const REAL x = between(W * u - K_(0.5), K_(-0.5), W - K_(0.5));
    const REAL y = between(H * v - K_(0.5), K_(-0.5), H - K_(0.5));
    const int i = (int)(x + K_(1)) - 1, j = (int)(y + K_(1)) - 1;
    const REAL a = x - (REAL)i, b = y - (REAL)j;
    const float *top = rung->rgba + 4 * ((ptrdiff_t)j * rung->pitch + i);
    const float *low = top + 4 * (ptrdiff_t)rung->pitch;
    const Four t0 = load_floats(top), l0 = load_floats(low);
    const Four upper = t0 + a * (load_floats(top + 4) - t0);
    const Four lower = l0 + a * (load_floats(low + 4) - l0);
    return upper + b * (lower - upper);
}

/* Rungs differ in size: each is fetched with its own width and height. */
ALWAYS void mix_rungs(const VARY *vary, const Rungs *at, int count, REAL *restrict texel)
{
    for (int i = 0; i < count; i++) {
        const Four low = vary_look(&vary->rung[at->low[i]], at->u[i], at->v[i]);
        const Four high = vary_look(&vary->rung[at->high[i]], at->u[i], at->v[i]);
        const Four c = low + at->t[i] * (high - low);
        memcpy(texel + 4 * i, &c, sizeof c);
    }
}

/* Shares of the mirrored environment: by metalness, unless that is constant.
   of[0] for non-metal, of[1] for metal; the share is linear in metalness. */
ALWAYS void mirror_shares(const REAL (*of)[WR_SVBRDF_STEPS][WR_SVBRDF_TERMS], bool alike,
                          const Steps *at, const REAL *restrict x, const STRIP *strip,
                          REAL *restrict out)
{
    REAL plain[4 * WR_SPAN], metal[4 * WR_SPAN];
    const int count = strip->count;
    vary_parts(of[0], at, x, count, plain);
    if (alike) {
        SIMD for (int i = 0; i < count; i++)
        {
            out[i] = reflect_positive(vary_sum(plain + 4 * i, x[i]));
        }
        return;
    }
    vary_parts(of[1], at, x, count, metal);
    SIMD for (int i = 0; i < count; i++)
    {
        const REAL a = vary_sum(plain + 4 * i, x[i]), b = vary_sum(metal + 4 * i, x[i]);
        out[i] = reflect_positive(a + between(strip->metal[i], K_(0), K_(1)) * (b - a));
    }
}

/* Adds the mirrored environment, blurred by the width of the sample's microfacets and the spread of its slopes. */
FLAT static void kern_mirror_vary(const MIRROR *how, const VARY *vary, bool spread, STRIP *strip)
{
    REAL x[WR_SPAN], own[WR_SPAN], white[WR_SPAN];
    REAL *restrict const texel = strip->top;
    const REAL strength = how->strength;
    const int count = strip->count;
    Steps at;
    Rungs rungs;
    if (spread) find_rungs(how, true, strip, &at, &rungs, x);
    else find_rungs(how, false, strip, &at, &rungs, x);
    mix_rungs(vary, &rungs, count, texel);
    mirror_shares(vary->own, vary->alike, &at, x, strip, own);
    mirror_shares(vary->white, vary->alike, &at, x, strip, white);
    SIMD for (int i = 0; i < count; i++)
    {
        const REAL r = texel[4 * i], g = texel[4 * i + 1], b = texel[4 * i + 2];
        const REAL o = strength * own[i], w = strength * white[i];
        strip->dr[i] += o * r, strip->dg[i] += o * g, strip->db[i] += o * b;
        strip->sr[i] += w * r, strip->sg[i] += w * g, strip->sb[i] += w * b;
    }
}
