/* kern_reflection_body.h - lamps with reflection models other than Blinn-Phong, on strips. Part of kern_body.h;
   the formulas are in shade/reflection_body.h. Runs after `light` and `view`; the colour picture's C is already
   in the strip. */

ALWAYS Facets facets_of(const STRIP *strip, int i, bool spread, bool round, REAL a2)
{
    const VEC n = LOAD3(strip, b, i), none = { K_(0), K_(0), K_(0) };
    if (!spread) return (Facets){ none, none, K_(0), K_(0), K_(0), K_(1), true };
    return reflect_facets(n, LOAD3(strip, e, i), strip->see[i], strip->sef[i], strip->sff[i], round,
                          a2);
}

/* Traits of models: constants that are known when a loop of one model is compiled. */
#define REFLECT_INFO(ID, ...) [WR_REFLECT_##ID] = WR_REFLECTION_INFO(ID, __VA_ARGS__),
static const WrReflectInfo reflect_info[] = { WR_REFLECTION_MODELS(REFLECT_INFO) };

#define REFLECT_BY_STAGES(ID, formula)
#define REFLECT_BY_UNIFORM(ID, formula)                                                            \
    if (model == WR_REFLECT_##ID) return reflect_##formula(at, form, m);
#define REFLECT_BY_ROUGH REFLECT_BY_UNIFORM
#define REFLECT_BY_METAL REFLECT_BY_UNIFORM
#define REFLECT_BY(ID, formula, LOOPS, ...) REFLECT_BY_##LOOPS(ID, formula)

/* Reflection at sample i. left: share of energy for diffuse light. */
ALWAYS Reflected reflect_at(const STRIP *strip, int i, const WrReflect model, const Form form,
                            REAL left, const MATTER *m)
{
    const Incidence at = {
        .n = LOAD3(strip, b, i),
        .l = LOAD3(strip, l, i),
        .v = LOAD3(strip, v, i),
        .facets = facets_of(strip, i, form.spread, form.round, m->alpha * m->alpha),
        .spread = form.spread ? strip->see[i] + strip->sff[i] : K_(0),
        .left = left,
    };
    WR_REFLECTION_MODELS(REFLECT_BY)
    return (Reflected){ K_(0), K_(0), K_(0) };
}

/* A lamp's colour, and that colour times the surface's own and kd. */
typedef struct Shone {
    REAL r, g, b, own_r, own_g, own_b;
} Shone;

ALWAYS Shone shone_of(const LIGHT *light, const MATTER *m)
{
    return (Shone){ light->rgb[0],        light->rgb[1],        light->rgb[2],
                    m->kd * m->colour[0], m->kd * m->colour[1], m->kd * m->colour[2] };
}

/* Adds to the sums of sample i. twice: includes interreflection of the facets, whose colour is mixed with
   `mean`. */
ALWAYS void add_reflected(Shone by, Reflected got, const bool twice, REAL mean, STRIP *strip, int i)
{
    REAL again_r = K_(0), again_g = K_(0), again_b = K_(0);
    if (twice) {
        again_r = got.again * reflect_kept(by.own_r * strip->cr[i], mean);
        again_g = got.again * reflect_kept(by.own_g * strip->cg[i], mean);
        again_b = got.again * reflect_kept(by.own_b * strip->cb[i], mean);
    }
    strip->dr[i] += by.r * (got.own + again_r);
    strip->dg[i] += by.g * (got.own + again_g);
    strip->db[i] += by.b * (got.own + again_b);
    strip->sr[i] += by.r * got.white;
    strip->sg[i] += by.g * got.white;
    strip->sb[i] += by.b * got.white;
}

ALWAYS void reflect_strip(const LIGHT *light, const MATTER *matter, const WrReflect model,
                          const Form form, STRIP *strip)
{
    const MATTER m = *matter;
    const Shone by = shone_of(light, &m);
    const bool twice = wr_reflect_again(&reflect_info[model], form.kept);
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        const Reflected got = reflect_at(strip, i, model, form, K_(0), &m);
        add_reflected(by, got, twice, m.mean, strip, i);
    }
}

/* Models without facets ignore the last two arguments. */
ALWAYS void reflect_as(const LIGHT *light, const MATTER *m, const WrReflect model, const bool kept,
                       WrReflectSpread how, STRIP *strip)
{
    const bool facets = reflect_info[model].facets;
    if (facets && how == WR_REFLECT_DULL)
        reflect_strip(light, m, model, (Form){ .kept = kept, .facing = true, .dull = true }, strip);
    else if (facets && how == WR_REFLECT_FACING)
        reflect_strip(light, m, model, (Form){ .kept = kept, .facing = true }, strip);
    else if (how == WR_REFLECT_LEAN)
        reflect_strip(light, m, model, (Form){ .kept = kept, .spread = true }, strip);
    else if (how == WR_REFLECT_ROUND)
        reflect_strip(light, m, model, (Form){ .kept = kept, .spread = true, .round = true },
                      strip);
    else reflect_strip(light, m, model, (Form){ .kept = kept }, strip);
}

/* ---- early-outs for runs (E37, E39, E40) ---- */

/* True if every n' faces the viewer. Then none is bent. */
FLAT static bool kern_faces(const STRIP *strip)
{
    const int count = strip->count;
    int turned = 0;
    SIMD_SUM(turned) for (int i = 0; i < count; i++)
    {
        turned += v_dot(LOAD3(strip, b, i), LOAD3(strip, v, i)) >= K_(WR_FACED_FROM) ? 0 : 1;
    }
    return turned == 0;
}

/* True if no sample has a spread of slopes. */
FLAT static bool kern_gathered(const STRIP *strip)
{
    const int count = strip->count;
    int wide = 0;
    SIMD_SUM(wide) for (int i = 0; i < count; i++)
    {
        wide += ((strip->suu[i] == K_(0)) & (strip->suv[i] == K_(0)) & (strip->svv[i] == K_(0)))
                    ? 0
                    : 1;
    }
    return wide == 0;
}

#ifdef WR_KERN_PLAIN
#define SIMD_SURVEY
#else
#define SIMD_SURVEY WR_PRAGMA(omp simd reduction(min : nv, vv, ll) reduction(max : na))
#endif

/* Extremes of the samples' directions: least n'.v, largest n'.axis, least v.v0 and l.l0. */
FLAT static void kern_survey(const REAL axis[3], const REAL v0[3], const REAL l0[3],
                             const STRIP *strip, REAL out[4])
{
    const VEC a = { axis[0], axis[1], axis[2] }, to = { v0[0], v0[1], v0[2] };
    const VEC from = { l0[0], l0[1], l0[2] };
    const int count = strip->count;
    REAL nv = K_(1), na = K_(-1), vv = K_(1), ll = K_(1);
    SIMD_SURVEY for (int i = 0; i < count; i++)
    {
        const VEC n = LOAD3(strip, b, i), v = LOAD3(strip, v, i);
        const REAL x = v_dot(n, v), y = v_dot(n, a), z = v_dot(v, to);
        const REAL w = v_dot(LOAD3(strip, l, i), from);
        nv = x < nv ? x : nv;
        na = y > na ? y : na;
        vv = z < vv ? z : vv;
        ll = w < ll ? w : ll;
    }
    out[0] = nv, out[1] = na, out[2] = vv, out[3] = ll;
}

/* Colours highlights by the surface's colour to the share t. */
FLAT static void kern_tint(REAL t, STRIP *strip)
{
    const int count = strip->count;
    SIMD for (int i = 0; i < count; i++)
    {
        strip->dr[i] += t * strip->sr[i], strip->sr[i] -= t * strip->sr[i];
        strip->dg[i] += t * strip->sg[i], strip->sg[i] -= t * strip->sg[i];
        strip->db[i] += t * strip->sb[i], strip->sb[i] -= t * strip->sb[i];
    }
}

#define REFLECT(name, MODEL, kept)                                                                 \
    FLAT static void kern_##name##_##kept(const LIGHT *light, const MATTER *m,                     \
                                          WrReflectSpread how, STRIP *strip)                       \
    {                                                                                              \
        reflect_as(light, m, MODEL, kept, how, strip);                                             \
    }
#define REFLECT_LOOPS_STAGES(ID, formula)
#define REFLECT_LOOPS_UNIFORM(ID, formula)                                                         \
    REFLECT(formula, WR_REFLECT_##ID, 0)                                                           \
    REFLECT(formula, WR_REFLECT_##ID, 1)
#define REFLECT_LOOPS_ROUGH REFLECT_LOOPS_UNIFORM
#define REFLECT_LOOPS_METAL REFLECT_LOOPS_UNIFORM
#define REFLECT_LOOPS(ID, formula, LOOPS, ...) REFLECT_LOOPS_##LOOPS(ID, formula)
WR_REFLECTION_MODELS(REFLECT_LOOPS)

#define REFLECT_ROW_STAGES(ID, formula) [WR_REFLECT_##ID] = { NULL, NULL },
#define REFLECT_ROW_UNIFORM(ID, formula)                                                           \
    [WR_REFLECT_##ID] = {                                                                          \
        [WR_ENERGY_KEPT] = kern_##formula##_1, [WR_ENERGY_PUBLISHED] = kern_##formula##_0          \
    },
#define REFLECT_ROW_ROUGH REFLECT_ROW_UNIFORM
#define REFLECT_ROW_METAL REFLECT_ROW_UNIFORM
#define REFLECT_ROW(ID, formula, LOOPS, ...) REFLECT_ROW_##LOOPS(ID, formula)
static REFLECT_KERNEL const kern_reflects[][WR_ENERGY_COUNT] = { WR_REFLECTION_MODELS(
    REFLECT_ROW) };
