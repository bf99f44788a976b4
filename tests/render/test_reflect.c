/* test_reflect.c - reflection models: kernels against independent values, white furnaces by quadrature, reciprocity,
   limits, and pictures against the reference. The values of the first test are from quadrature of the published
   formulas with 320 x 320 nodes, and from closed forms. */
#include "test.h"
#include "render_scenes.h"

#include "base/error.h"
#include "base/memory.h"
#include "render/kernels/kern.h"
#include "shade/reflection_models.h"
#include "render/reference/reference.h"
#include "render/reference/reference_shade.h"
#include "scene/scene.h"

static const WrKernelsd *kernels;

static WrKernMatterd matter_of(const WrReflectance *of, double kd, double ks)
{
    WrMatter m;
    wr_matter_init(&m, of);
    WrKernMatterd matter = { .kd = kd, .ks = ks, .colour = { 1, 1, 1 }, .scale = m.scale };
    matter.shininess = m.shininess, matter.alpha = m.alpha, matter.ior = m.ior, matter.f0 = m.f0;
    matter.metal = m.metal, matter.a = m.a, matter.b = m.b;
    matter.mean = m.mean, matter.again = m.again;
    memcpy(matter.albedo, m.albedo, sizeof m.albedo);
    return matter;
}

/* pi f (n.l) for one strip's directions in the red channel: the part in the surface's colour and the white part. */
static void reflect(const WrReflectance *of, double kd, double ks, WrStripd *s)
{
    const WrKernMatterd matter = matter_of(of, kd, ks);
    const WrKernLightd light = { .rgb = { 1, 1, 1 } };
    kernels->begin(0, s);
    kernels->reflect[of->model][of->energy](&light, &matter, WR_REFLECT_AS_IT_IS, s);
}

static void put(WrStripd *s, int i, WrVec3 l, WrVec3 v)
{
    s->bx[i] = s->by[i] = 0, s->bz[i] = 1;
    s->lx[i] = l.x, s->ly[i] = l.y, s->lz[i] = l.z;
    s->vx[i] = v.x, s->vy[i] = v.y, s->vz[i] = v.z;
}

static WrVec3 tilted(double mu, double turn)
{
    const double s = sqrt(fmax(0, 1 - mu * mu));
    return (WrVec3){ s * cos(turn), s * sin(turn), mu };
}

static double at_once(const WrReflectance *of, double kd, double ks, WrVec3 l, WrVec3 v)
{
    WrStripd *s = wr_alloc(1, sizeof *s);
    s->count = 1;
    put(s, 0, l, v);
    reflect(of, kd, ks, s);
    const double sum = s->dr[0] + s->sr[0];
    wr_free(s);
    return sum;
}

/* The integral of f (n.l): diffuse light over directions; facets over half vectors h, where a highlight of width
   alpha is even. */
static double albedo(const WrReflectance *of, double kd, double ks, double nv, bool facets, int n)
{
    const double a = fmax(of->roughness * of->roughness, 1e-3);
    const WrVec3 v = tilted(nv, 0);
    WrStripd *s = wr_alloc(1, sizeof *s);
    double sum = 0;
    for (int i = 0; i < n; i++) {
        double weight[WR_SPAN];
        s->count = n;
        for (int j = 0; j < n; j++) {
            const double t = (i + 0.5) / n, turn = WR_PI * (j + 0.5) / n;
            if (!facets) { /* t = (n.l)^2: f (n.l) dw is pi f d(t) */
                put(s, j, tilted(sqrt(t), turn), v);
                weight[j] = 1 / sqrt(t);
                continue;
            }
            const double x = t * t * (3 - 2 * t), dx = 6 * t * (1 - t); /* dense at both ends */
            const double c = sqrt((1 - x) / (1 - x + a * a * x)), w = c * c * (a * a - 1) + 1;
            const WrVec3 h = tilted(c, turn);
            const double vh = v3_dot(v, h);
            const WrVec3 l = v3_sub(v3_scale(h, 2 * vh), v);
            const bool up = l.z > 0 && vh > 0;
            put(s, j, up ? l : v, v);
            weight[j] = up ? 4 * vh * w * w / (a * a * c) * dx : 0;
        }
        reflect(of, kd, ks, s);
        for (int j = 0; j < n; j++) sum += (s->dr[j] + s->sr[j]) * weight[j];
    }
    wr_free(s);
    return sum / (n * n);
}

static void albedos_are_those_of_the_published_formulas(void **state)
{
    const WrReflectance metal = { WR_REFLECT_GGX, WR_ENERGY_PUBLISHED, 0, 1, 1, 1.5 };
    static const struct {
        double alpha, nv, albedo;
    } ggx[] = { { 1, 1, .306853 },    { 1, .3, .560099 },   { .5, .7, .682954 },
                { .25, .1, .891622 }, { .1, .7, .981419 },  { .1, .3, .936252 },
                { .04, 1, .998298 },  { .04, .1, .928993 }, { .5, .1, .860105 } };
    (void)state;
    for (size_t i = 0; i < sizeof ggx / sizeof *ggx; i++) {
        WrReflectance of = metal;
        of.roughness = sqrt(ggx[i].alpha);
        assert_near(albedo(&of, 0, 1, ggx[i].nv, true, 200), ggx[i].albedo, 5e-4);
        assert_near(1 - ggx[0].nv * log(2), ggx[0].albedo, 1e-6);
    }
    const WrReflectance fujii = { WR_REFLECT_OREN_NAYAR, WR_ENERGY_KEPT, 0, .5, 0, 1.5 };
    WrReflectance facets = { WR_REFLECT_TORRANCE_SPARROW, WR_ENERGY_KEPT, 0, sqrt(.3), 0, 1e4 };
    assert_near(albedo(&facets, 0, 1, 1, true, 200), .86401, 1e-3);
    assert_near(albedo(&facets, 0, 1, .3, true, 200), .91012, 1e-3);
    facets.energy = WR_ENERGY_PUBLISHED; /* 4 c^2 times the energy term */
    assert_near(albedo(&facets, 0, 1, .3, true, 200), .91012 * 4 * .09, 1e-3);
    const WrReflectance qualitative = {
        WR_REFLECT_OREN_NAYAR, WR_ENERGY_PUBLISHED, 0, WR_PI / 18, 0, 1.5
    };
    assert_near(albedo(&qualitative, 1, 0, .02, false, 200), 1.0139, 1e-3);
    const WrReflectance gltf = { WR_REFLECT_GGX, WR_ENERGY_PUBLISHED, 0, .2, 0, 1.5 };
    const double sum = albedo(&gltf, 1, 0, .1, false, 200) + albedo(&gltf, 0, 1, .1, true, 200);
    assert_near(sum, 1.4279, 2e-3);
    assert_near(albedo(&fujii, 1, 0, .3, false, 200), 1, 1e-3); /* includes multiple reflections */
}

/* HC103 */
static void a_white_furnace_never_shows_more_than_white(void **state)
{
    (void)state;
    for (int model = WR_REFLECT_PHONG; model < WR_REFLECT_COUNT; model++)
        for (int r = 0; r <= 3; r++)
            for (int k = 0; k < 12; k++) {
                const double nv = .02 + .98 * k / 11, rough = .15 + .85 * r / 3;
                const WrReflectInfo *info = &wr_reflects[model];
                const bool own = info->diffuse != WR_DIFFUSE_LAMBERT || !info->shines;
                const bool power = info->highlight == WR_HIGHLIGHT_POWER;
                WrReflectance of = { (WrReflect)model, WR_ENERGY_KEPT, 20 * r, rough, 0, 1.5 };
                double e = albedo(&of, own, power, nv, false, 120);
                if (!power) e += albedo(&of, 0, 1, nv, true, 120);
                if (!(e <= 1 + 1e-3 && e > 0)) fail_msg("model %d %g %g: %g", model, rough, nv, e);
                if (own && !(e > .96)) fail_msg("model %d %g %g loses: %g", model, rough, nv, e);
                if (info->highlight != WR_HIGHLIGHT_CAVITIES) continue;
                of.ior = 1e4;
                e = albedo(&of, 0, 1, nv, true, 120);
                if (!(e <= 1 + 1e-3 && e > .3)) fail_msg("mirrors %g %g: %g", rough, nv, e);
            }
}

static void light_and_eye_can_change_places(void **state)
{
    (void)state;
    const WrVec3 a = tilted(.731, .3), b = tilted(.217, 2.9);
    for (int model = WR_REFLECT_PHONG; model < WR_REFLECT_COUNT; model++)
        for (int energy = 0; energy < WR_ENERGY_COUNT; energy++) {
            const WrReflectance of = { (WrReflect)model, (WrEnergy)energy, 3.7, .63, .41, 1.7 };
            const double there = at_once(&of, 0.8, 0.6, b, a) / b.z;
            const double back = at_once(&of, 0.8, 0.6, a, b) / a.z;
            const bool is =
                wr_reflects[model].highlight != WR_HIGHLIGHT_POWER || energy == WR_ENERGY_KEPT;
            if ((fabs(there - back) <= 1e-12 * there) != is)
                fail_msg("%s %s: %.17g, %.17g", wr_reflects[model].name, wr_energies[energy], there,
                         back);
        }
}

static void limits_are_finite(void **state)
{
    static const double ends[][4] = { { 0, 0, 0, 1.5 },       { 1e6, 1, 1, 1.5 }, { 0, 0, 1, 1e4 },
                                      { NAN, NAN, NAN, NAN }, { -1, -1, -1, 0 },  { 1e9, 2, 7, 1 },
                                      { 5, .5, .5, .67 } };
    const WrVec3 places[] = { { 0, 0, 1 },     { 0, 0, -1 },     { 1, 0, 0 },    { -1, 0, 0 },
                              { 1, 0, 1e-20 }, { -1, 0, 1e-20 }, { .6, 0, -.8 }, { .6, 0, .8 } };
    (void)state;
    for (int model = WR_REFLECT_PHONG; model < WR_REFLECT_COUNT; model++)
        for (int energy = 0; energy < WR_ENERGY_COUNT; energy++)
            for (int e = 0; e < 7; e++)
                for (int k = 0; k < 64; k++) {
                    const double *x = ends[e];
                    const WrReflectance of = {
                        (WrReflect)model, (WrEnergy)energy, x[0], x[1], x[2], x[3]
                    };
                    const WrVec3 l = places[k / 8], v = places[k % 8];
                    const double got = at_once(&of, 1, 1, l, v);
                    if (!(got >= 0 && got < 1e13) || (l.z <= 0 && got != 0))
                        fail_msg("model %d, ends %d, places %d: %g", model, e, k, got);
                }
}

/* HC106: an n' facing away from the eye is bent to the eye's direction; the result is finite near that. */
static void a_normal_away_from_the_eye_is_the_eyes(void **state)
{
    (void)state;
    for (int model = 0; model < 2; model++) {
        const WrReflect kind = model ? WR_REFLECT_GGX : WR_REFLECT_TORRANCE_SPARROW;
        const WrReflectance of = { kind, WR_ENERGY_PUBLISHED, 0, .37, 1, 1.5 };
        WrStripd *s = wr_alloc(1, sizeof *s);
        s->count = 200;
        for (int i = 0; i < s->count; i++) { /* n' rotates through -v; the light is in front */
            const double turn = (i - 100) * 1e-4;
            put(s, i, (WrVec3){ 0, 0, 1 }, (WrVec3){ sin(turn), 0, -cos(turn) });
        }
        reflect(&of, 0, 1, s);
        for (int i = 0; i < s->count; i++) {
            const double got = s->dr[i] + s->sr[i];
            if (!(got >= 0 && got < 1e-9)) fail_msg("model %d, %d: %g", kind, i, got);
        }
        wr_free(s);
    }
}

/* HC109: facets widened by covariances of rank 1, by huge ones, and by ones slightly below 0 from rounding. D is that
   of M = alpha^2 + 2 C, by independent formulas, so that D (n.h) integrates to 1; negative ones widen nothing. Viewed
   along the light, where V and F are known; at slopes sqrt(M) r (cos, sin), where D (n.h)^4 sqrt(det M) is (1 / pi) /
   (1 + r^2)^2. */
static void widened_facets_are_a_distribution(void **state)
{
    static const double covariances[][3] = {
        { .0371, 0, 0 },      { .02, .02, .02 },  { 1e6, 0, 0 }, { 3.1e5, -3.1e5, 3.1e5 },
        { .013, .004, .091 }, { 1e-9, 0, 1e-12 }, { 0, 0, 0 },
    };
    const WrReflectance of = { WR_REFLECT_GGX, WR_ENERGY_PUBLISHED, 0, .41, 1, 1.5 };
    (void)state;
    WrMatter m;
    wr_matter_init(&m, &of);
    const WrKernMatterd matter = { .ks = 1, .alpha = m.alpha, .f0 = m.f0, .metal = 1 };
    const WrKernLightd light = { .rgb = { 1, 1, 1 } };
    WrStripd *s = wr_alloc(1, sizeof *s);
    for (size_t k = 0; k < sizeof covariances / sizeof *covariances; k++) {
        const double *c = covariances[k], a2 = m.alpha * m.alpha;
        const double step = c[0] > 1 ? .004 : .11; /* n.h stays above 1e-3: no bend */
        const double ee = a2 + 2 * c[0], ef = 2 * c[1], ff = a2 + 2 * c[2];
        const double low = sqrt(ee), cross = ef / low, high = sqrt(ff - cross * cross);
        s->count = 12;
        for (int i = 0; i < s->count; i++) { /* M = L L^T */
            const double r = step * i * i, x = r * cos(i * 2.4), y = r * sin(i * 2.4);
            const WrVec3 slope = { low * x, cross * x + high * y, 1 };
            const WrVec3 h = v3_unit(slope, slope);
            put(s, i, h, h);
            s->ex[i] = 1, s->ey[i] = s->ez[i] = 0;
            s->see[i] = c[0], s->sef[i] = c[1], s->sff[i] = c[2];
        }
        kernels->begin(0, s);
        kernels->reflect[WR_REFLECT_GGX][WR_ENERGY_PUBLISHED](&light, &matter, WR_REFLECT_LEAN, s);
        for (int i = 0; i < s->count; i++) {
            const double r = step * i * i, z = s->lz[i], hx = s->lx[i], hy = s->ly[i];
            const double span = sqrt(z * z + ee * hx * hx + 2 * ef * hx * hy + ff * hy * hy);
            const double d = 4 * span * (s->dr[i] + s->sr[i]); /* pi D */
            const double got = d * z * z * z * z * low * high,
                         want = 1 / ((1 + r * r) * (1 + r * r));
            if (!(fabs(got - want) <= 1e-6 * want))
                fail_msg("covariance %zu, %d: %.12g, not %.12g", k, i, got, want);
        }
    }
    s->count = 1; /* negative by rounding */
    put(s, 0, tilted(.9, .3), tilted(.8, 2.1));
    s->ex[0] = 1, s->ey[0] = s->ez[0] = 0, s->see[0] = -1e-12, s->sef[0] = 1e-12,
    s->sff[0] = -1e-12;
    kernels->begin(0, s);
    kernels->reflect[WR_REFLECT_GGX][WR_ENERGY_PUBLISHED](&light, &matter, WR_REFLECT_LEAN, s);
    const double widened = s->dr[0] + s->sr[0];
    assert_near(widened, at_once(&of, 0, 1, tilted(.9, .3), tilted(.8, 2.1)), 1e-9);
    wr_free(s);
}

static void a_normal_turned_past_the_eye_makes_no_jump(void **state)
{
    (void)state;
    for (int model = WR_REFLECT_PHONG; model < WR_REFLECT_COUNT; model++) {
        const WrReflectance of = { (WrReflect)model, WR_ENERGY_KEPT, 7, .45, .3, 1.5 };
        const WrVec3 l = tilted(.4, .9);
        double before = at_once(&of, 1, 1, l, tilted(2e-3, 0));
        for (int i = 1; i <= 40; i++) {
            const double mu = 2e-3 - 1e-4 * i, s = sqrt(1 - mu * mu);
            const double now = at_once(&of, 1, 1, l, (WrVec3){ s, 0, mu });
            if (!(fabs(now - before) < .02 * (1 + before))) fail_msg("%d at %g", model, mu);
            before = now;
        }
    }
}

/* Samples with individual roughness use loops that list each model; a model missing there would be black. With
   constant roughness the published forms equal those without it. */
static void every_model_with_roughness_takes_it_from_each_sample(void **state)
{
    (void)state;
    const WrVec3 l = tilted(.6, .4), v = tilted(.7, .2);
    WrStripd *s = wr_alloc(1, sizeof *s);
    WrKernVaryd *vary = wr_alloc(1, sizeof *vary);
    for (int model = 0; model < WR_REFLECT_COUNT; model++) {
        if (!wr_reflects[model].roughness) continue;
        for (int energy = 0; energy < WR_ENERGY_COUNT; energy++) {
            const WrReflectance of = { (WrReflect)model, (WrEnergy)energy, 7, .45, .3, 1.5 };
            const WrKernMatterd matter = matter_of(&of, .8, .7);
            const WrKernLightd light = { .rgb = { 1, 1, 1 } };
            const bool kept = energy == WR_ENERGY_KEPT;
            s->count = 1;
            put(s, 0, l, v);
            s->rough[0] = .45, s->metal[0] = .3;
            s->cr[0] = s->cg[0] = s->cb[0] = 1;
            kernels->begin(0, s);
            kernels->reflect_vary(&light, &matter, vary, (WrReflect)model, kept,
                                  WR_REFLECT_AS_IT_IS, s);
            const double got = s->dr[0] + s->sr[0], want = at_once(&of, .8, .7, l, v);
            if (!(got > 0)) fail_msg("%s %d: no light", wr_reflects[model].name, energy);
            if (!kept && fabs(got - want) > 1e-9 * want)
                fail_msg("%s: %.12g, not %.12g", wr_reflects[model].name, got, want);
        }
    }
    wr_free(vary);
    wr_free(s);
}

/* ---- pictures ---- */

static WrScene *lit_scene(const char *surface, int model, int energy)
{
    WrScene *scene = scene_of(surface);
    WrMaterial *m = &scene->material;
    m->model = (WrReflect)model, m->energy = (WrEnergy)energy;
    m->roughness = .37, m->metalness = .23, m->ior = 1.61, m->tint = .31;
    m->diffuse = .77, m->specular = .83, m->shininess = 13.7;
    m->colour = (WrVec3){ .91, .53, .17 };
    scene->height = 0;
    scene->dials.aa = WR_AA_POINT;
    return scene;
}

static double apart(const WrScene *scene, const WrField *field)
{
    enum { W = 41, H = 33 };
    WrError err = { "" };
    WrReference r = { 0 };
    WrPool *pool = wr_pool_new(2);
    const WrReferenceRequest request = {
        .field = field, .scene = scene, .width = W, .height = H, .first = 1, .most = 1
    };
    if (!wr_reference_render(&request, pool, &r, &err)) fail_msg("%s", err.text);
    wr_pool_free(pool);
    Shot shot = shoot(scene, field, W, H, 2, "auto", false);
    double worst = 0;
    for (int i = 0; i < W * H * 4; i++)
        if (r.rgba[i / 4 * 4 + 3] == 1 && shot.frame.rgba[i / 4 * 4 + 3] == 1)
            worst = fmax(worst, fabs(r.rgba[i] - (double)shot.frame.rgba[i]));
    put_away(&shot);
    wr_reference_fini(&r);
    return worst;
}

/* Sums of the reference's formulas over directions around n = (0,0,1), some below the light's horizon: diffuse light
   in the surface's colour, highlight, and deviation of diffuse light from Lambert's. */
typedef struct Probe {
    double own, white, below, from_lambert;
} Probe;

static Probe probe(const WrMaterial *m)
{
    static const double colour[3] = { 0.8, 0.5, 0.3 };
    const WrVec3 n = { 0, 0, 1 };
    WrMatter matter;
    Probe sum = { 0 };
    wr_scene_matter(m, &matter);
    for (int i = 0; i < 64; i++) {
        const WrVec3 l = tilted(-0.3 + 1.3 * (i % 8 + 0.5) / 8, 0.7 * i);
        const WrVec3 v = tilted((i / 8 + 0.5) / 8, 0.2);
        double own[3], white;
        wr_reference_lamp(m, &matter, n, l, v, colour, own, &white);
        sum.own += own[0], sum.white += white;
        sum.below += l.z < 0 ? white : 0;
        sum.from_lambert += fabs(own[0] - m->diffuse * fmax(0, l.z));
    }
    return sum;
}

static bool same_probe(Probe a, Probe b)
{
    return a.own == b.own && a.white == b.white;
}

static bool changes(WrMaterial m, double *number, double to, WrMaterial *at)
{
    const Probe before = probe(&m);
    *number = to;
    return !same_probe(before, probe(at));
}

/* Every column of the table matches the formulas. */
static void traits_are_what_the_formulas_show(void **state)
{
    (void)state;
    int stages = 0;
    for (int model = 0; model < wr_reflect_count; model++) {
        const WrReflectInfo *is = &wr_reflects[model];
        const WrMaterial base = { .diffuse = 0.9,
                                  .specular = 0.6,
                                  .shininess = 20,
                                  .model = model,
                                  .roughness = 0.4,
                                  .metalness = 0.2,
                                  .ior = 1.5 };
        WrMaterial m = base;
        assert_int_equal(is->shininess, changes(base, &m.shininess, 30, &m));
        m = base;
        assert_int_equal(is->roughness, changes(base, &m.roughness, 0.6, &m));
        m = base;
        assert_int_equal(is->metalness, changes(base, &m.metalness, 0.7, &m));
        m = base;
        assert_int_equal(is->ior, changes(base, &m.ior, 1.8, &m));
        m = base, m.energy = WR_ENERGY_PUBLISHED;
        assert_int_equal(is->energies, !same_probe(probe(&base), probe(&m)));
        const Probe lit = probe(&base);
        assert_int_equal(is->shines, lit.white > 0);
        assert_int_equal(is->highlight == WR_HIGHLIGHT_HALF, lit.below > 0);
        m = base, m.ior = 1;
        assert_int_equal(is->highlight == WR_HIGHLIGHT_CAVITIES,
                         lit.white > 0 && probe(&m).white == 0);
        m = base, m.specular = 0;
        assert_int_equal(is->diffuse == WR_DIFFUSE_LAMBERT, probe(&m).from_lambert < 1e-12);
        m.roughness = 0;
        assert_int_equal(is->diffuse == WR_DIFFUSE_REMAINDER, probe(&m).from_lambert > 1e-6);
        assert_true(!is->facets || is->roughness);
        stages += is->loops == WR_REFLECT_LOOPS_STAGES;
    }
    assert_int_equal(wr_reflects[WR_REFLECT_DEFAULT].loops, WR_REFLECT_LOOPS_STAGES);
    assert_int_equal(stages, 1);
}

/* The plan may skip a model only if the picture is unchanged: without a highlight, for every model. */
static void models_without_a_highlight_are_the_references(void **state)
{
    (void)state;
    WrField *field = bumpy_field(16, 16);
    for (int model = 0; model < WR_REFLECT_COUNT; model++)
        for (int energy = 0; energy < WR_ENERGY_COUNT; energy++) {
            WrScene *scene = lit_scene("sphere", model, energy);
            scene->material.specular = 0;
            const double off = apart(scene, field);
            if (!(off < 2e-4))
                fail_msg("%s %s: %g apart", wr_reflects[model].name, wr_energies[energy], off);
            wr_scene_free(scene);
        }
    wr_field_free(field);
}

static void pictures_are_the_references(void **state)
{
    (void)state;
    WrField *field = bumpy_field(16, 16);
    for (int model = 0; model < WR_REFLECT_COUNT; model++)
        for (int energy = 0; energy < WR_ENERGY_COUNT; energy++)
            for (int in_double = 0; in_double < 2; in_double++) {
                WrScene *scene = lit_scene("sphere", model, energy);
                if (in_double) scene->dials.shading = WR_SHADING_DOUBLE;
                const double off = apart(scene, field);
                if (!(off < (in_double ? 3e-7 : 2e-4)))
                    fail_msg("%s %s %d: %g apart", wr_reflects[model].name, wr_energies[energy],
                             in_double, off);
                wr_scene_free(scene);
            }
    wr_field_free(field);
}

int main(void)
{
    WrError err;
    kernels = wr_kernels_double("auto", &err);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(albedos_are_those_of_the_published_formulas),
        cmocka_unit_test(a_white_furnace_never_shows_more_than_white),
        cmocka_unit_test(light_and_eye_can_change_places),
        cmocka_unit_test(limits_are_finite),
        cmocka_unit_test(a_normal_turned_past_the_eye_makes_no_jump),
        cmocka_unit_test(a_normal_away_from_the_eye_is_the_eyes),
        cmocka_unit_test(widened_facets_are_a_distribution),
        cmocka_unit_test(every_model_with_roughness_takes_it_from_each_sample),
        cmocka_unit_test(traits_are_what_the_formulas_show),
        cmocka_unit_test(models_without_a_highlight_are_the_references),
        cmocka_unit_test(pictures_are_the_references),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
