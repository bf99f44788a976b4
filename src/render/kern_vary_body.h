/* kern_vary_body.h - lamps and surroundings on strips whose samples have roughness and metalness of their own (strip->rough,
   strip->metal). A part of kern_body.h; the formulas are in shade/reflect_body.h and shade/surround_body.h. Plain loops: a
   sample's numbers are an array each. */

/* Between two sixteenths of roughness. */
typedef struct Step {
    int low, high;
    REAL t;
} Step;

ALWAYS Step vary_step(REAL rough)
{
    const REAL x = between(rough, K_(0), K_(1)) * (REAL)(WR_VARY_STEPS - 1), whole = r_floor(x);
    const int low = (int)whole;
    return (Step){ low, low + 1 < WR_VARY_STEPS ? low + 1 : low, x - whole };
}

ALWAYS void vary_terms(const REAL (*table)[WR_ALBEDO_TERMS], Step at, REAL *out)
{
    for (int k = 0; k < WR_ALBEDO_TERMS; k++)
        out[k] = table[at.low][k] + at.t * (table[at.high][k] - table[at.low][k]);
}

ALWAYS REAL vary_share(const REAL (*table)[WR_ALBEDO_TERMS], Step at, REAL x)
{
    REAL terms[WR_ALBEDO_TERMS];
    vary_terms(table, at, terms);
    return reflect_terms(terms, x);
}

/* The material as it is at a sample. */
static MATTER vary_matter(const MATTER *m, const VARY *vary, WrReflect model, bool kept,
                          REAL roughness, REAL metal)
{
    MATTER out = *m;
    const REAL rough = between(roughness, K_(0), K_(1)), s = rough, ss = s * s;
    out.alpha = larger(rough * rough, K_(WR_ALPHA_LEAST));
    out.metal = between(metal, K_(0), K_(1));
    if (model == WR_REFLECT_TORRANCE_SPARROW && !kept) out.scale = out.alpha * out.alpha;
    if (model == WR_REFLECT_OREN_NAYAR && !kept)
        out.a = K_(1) - K_(0.5) * ss / (ss + K_(0.33)), out.b = K_(0.45) * ss / (ss + K_(0.09));
    if (model == WR_REFLECT_OREN_NAYAR && kept) {
        out.a = K_(1) / (K_(1) + K_(0.28779340921080631) * s); /* 1/2 - 2/(3 pi) */
        out.b = out.a * s;
        out.mean = out.a * (K_(1) + K_(0.072488212456924341) * s); /* 2/3 - 28/(15 pi) */
        out.again = s > K_(1e-6) ? K_(1) / (K_(1) - out.mean) : K_(0);
    }
    if (model == WR_REFLECT_GGX && kept) {
        const Step at = vary_step(rough);
        vary_terms(vary->albedo, at, out.albedo);
        out.again = vary->again[at.low] + at.t * (vary->again[at.high] - vary->again[at.low]);
    }
    return out;
}

/* What one lamp adds, by a model that goes by roughness. */
static void kern_reflect_vary(const LIGHT *light, const MATTER *m, const VARY *vary,
                              WrReflect model, bool kept, WrReflectSpread how, STRIP *strip)
{
    const REAL *c = light->rgb;
    const bool spread = how != WR_REFLECT_AS_IT_IS, round = how == WR_REFLECT_ROUND;
    const bool twice = kept && model == WR_REFLECT_OREN_NAYAR;
    for (int i = 0; i < strip->count; i++) {
        const MATTER own = vary_matter(m, vary, model, kept, strip->rough[i], strip->metal[i]);
        const Reflected got = reflect_at(strip, i, model, kept, spread, round, &own);
        const REAL of[3] = { strip->cr[i], strip->cg[i], strip->cb[i] };
        REAL again[3] = { K_(0), K_(0), K_(0) };
        for (int k = 0; k < 3 && twice; k++)
            again[k] = got.again * reflect_kept(m->kd * m->colour[k] * of[k], own.mean);
        strip->dr[i] += c[0] * (got.own + again[0]);
        strip->dg[i] += c[1] * (got.own + again[1]);
        strip->db[i] += c[2] * (got.own + again[2]);
        strip->sr[i] += c[0] * got.white;
        strip->sg[i] += c[1] * got.white;
        strip->sb[i] += c[2] * got.white;
    }
}

/* Diffuse light of surroundings. */
static void kern_surround_vary(const SURROUND *how, const VARY *vary, STRIP *strip)
{
    for (int i = 0; i < strip->count; i++) {
        const VEC n = LOAD3(strip, b, i);
        const REAL x = surround_root(n, LOAD3(strip, v, i));
        const Step at = vary_step(strip->rough[i]);
        const REAL left = vary->metals ? K_(1) - between(strip->metal[i], K_(0), K_(1)) : K_(1);
        const REAL matt = how->kd * left * reflect_positive(vary_share(vary->matt, at, x));
        const REAL again = how->kd * reflect_positive(vary_share(vary->twice, at, x));
        const REAL mean = vary->mean[at.low] + at.t * (vary->mean[at.high] - vary->mean[at.low]);
        const REAL of[3] = { strip->cr[i], strip->cg[i], strip->cb[i] };
        REAL sum[3];
        for (int k = 0; k < 3; k++)
            sum[k] = surround_light(how->form[k], n) *
                     (matt + again * reflect_kept(how->kd * how->colour[k] * of[k], mean));
        strip->dr[i] += sum[0], strip->dg[i] += sum[1], strip->db[i] += sum[2];
    }
}

/* A blurred picture of the surroundings at the place u, v of 0..1, v downwards. */
ALWAYS Four vary_look(const WrKernRung *rung, REAL u, REAL v)
{
    const REAL W = (REAL)rung->width, H = (REAL)rung->height;
    const REAL x = between(W * u - K_(0.5), K_(-0.5), W - K_(0.5));
    const REAL y = between(H * v - K_(0.5), K_(-0.5), H - K_(0.5));
    const REAL i = r_floor(x), j = r_floor(y), a = x - i, b = y - j;
    const float *top = rung->rgba + 4 * ((ptrdiff_t)(int)j * rung->pitch + (int)i);
    const float *low = top + 4 * (ptrdiff_t)rung->pitch;
    const Four t0 = load_floats(top), l0 = load_floats(low);
    const Four upper = t0 + a * (load_floats(top + 4) - t0);
    const Four lower = l0 + a * (load_floats(low + 4) - l0);
    return upper + b * (lower - upper);
}

/* Between the two rungs next to a lobe's width: by its logarithm; under the last lobe by the width. */
ALWAYS Step vary_rung(REAL alpha)
{
    const REAL least = K_(0.015625);
    const REAL log = -(REAL)wr_log2_f((float)between(alpha, least, K_(1)));
    const int last = WR_VARY_RUNGS - 2, low = (int)r_floor(log);
    if (alpha < least)
        return (Step){ last, last + 1, K_(1) - between(alpha / least, K_(0), K_(1)) };
    return (Step){ low, low < last ? low + 1 : low, low < last ? log - (REAL)low : K_(0) };
}

/* What is mirrored, blurred as wide as the sample's facets and the spread of its slopes are. */
static void kern_mirror_vary(const MIRROR *how, const VARY *vary, bool spread, STRIP *strip)
{
    const MIRROR *m = how;
    for (int i = 0; i < strip->count; i++) {
        const VEC n = LOAD3(strip, b, i), v = LOAD3(strip, v, i), r = surround_mirrored(n, v);
        const VEC d = { m->axes[0] * r.x + m->axes[1] * r.y + m->axes[2] * r.z,
                        m->axes[3] * r.x + m->axes[4] * r.y + m->axes[5] * r.z,
                        m->axes[6] * r.x + m->axes[7] * r.y + m->axes[8] * r.z };
        const REAL round = r_atan2_turns(d.x, -d.z), u = round < K_(0.5) ? round : round - K_(1);
        const REAL up = r_atan2_turns(d.y, r_sqrt(d.x * d.x + d.z * d.z));
        const REAL w = up < K_(0.5) ? up : up - K_(1);
        const REAL own_rough = between(strip->rough[i], K_(0), K_(1)), a = own_rough * own_rough;
        const REAL more = spread ? strip->see[i] + strip->sff[i] : K_(0);
        const REAL alpha = more > K_(0) ? r_sqrt(a * a + more) : a;
        const Step rung = vary_rung(alpha), at = vary_step(r_sqrt(between(alpha, K_(0), K_(1))));
        const Four low = vary_look(&vary->rung[rung.low], u + K_(0.5), K_(0.5) - K_(2) * w);
        const Four high = vary_look(&vary->rung[rung.high], u + K_(0.5), K_(0.5) - K_(2) * w);
        const Four c = low + rung.t * (high - low);
        const REAL x = surround_root(n, v), metal = between(strip->metal[i], K_(0), K_(1));
        const REAL own0 = vary_share(vary->own[0], at, x), own1 = vary_share(vary->own[1], at, x);
        const REAL white0 = vary_share(vary->white[0], at, x);
        const REAL white1 = vary_share(vary->white[1], at, x);
        const REAL own = m->strength * reflect_positive(own0 + metal * (own1 - own0));
        const REAL white = m->strength * reflect_positive(white0 + metal * (white1 - white0));
        strip->dr[i] += own * c[0], strip->dg[i] += own * c[1], strip->db[i] += own * c[2];
        strip->sr[i] += white * c[0], strip->sg[i] += white * c[1], strip->sb[i] += white * c[2];
    }
}
