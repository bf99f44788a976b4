/* Hard cases of reflection models. */
#include "hardcases/hardcases_internal.h"

#include "base/error.h"
#include "field/field.h"
#include "scene/scene.h"
#include "shade/reflection_models.h"

/* One lamp of strength 1 on one point. */
typedef struct Place {
    WrVec3 n, l, v;
} Place;

static const WrReflectance ordinary = { WR_REFLECT_GGX, WR_ENERGY_KEPT, 20, 0.5, 0.3, 1.5 };

/* Reflected light by the kernels. */
static double in_float(WrHardGauge *g, int set, const WrReflectance *of, Place at)
{
    WrStrip *s = g->strip;
    WrMatter m;
    wr_matter_init(&m, of);
    WrKernMatter k = { .kd = 0.5f, .ks = 0.5f, .colour = { 1, 1, 1 } };
    k.shininess = (float)m.shininess, k.scale = (float)m.scale, k.alpha = (float)m.alpha;
    k.ior = (float)m.ior, k.f0 = (float)m.f0, k.metal = (float)m.metal;
    k.a = (float)m.a, k.b = (float)m.b, k.mean = (float)m.mean, k.again = (float)m.again;
    for (int i = 0; i < WR_ALBEDO_TERMS; i++) k.albedo[i] = (float)m.albedo[i];
    const WrKernLight light = { .rgb = { 1, 1, 1 } };
    s->count = 1;
    s->bx[0] = (float)at.n.x, s->by[0] = (float)at.n.y, s->bz[0] = (float)at.n.z;
    s->lx[0] = (float)at.l.x, s->ly[0] = (float)at.l.y, s->lz[0] = (float)at.l.z;
    s->vx[0] = (float)at.v.x, s->vy[0] = (float)at.v.y, s->vz[0] = (float)at.v.z;
    g->kernels[set]->begin(0, s);
    g->kernels[set]->reflect[of->model][of->energy](&light, &k, WR_REFLECT_AS_IT_IS, s);
    return (double)s->dr[0] + (double)s->sr[0];
}

static double in_double(WrHardGauge *g, int set, const WrReflectance *of, Place at)
{
    WrStripd *s = g->wide_strip;
    WrMatter m;
    wr_matter_init(&m, of);
    WrKernMatterd k = { .kd = 0.5, .ks = 0.5, .colour = { 1, 1, 1 }, .shininess = m.shininess };
    k.scale = m.scale, k.alpha = m.alpha, k.ior = m.ior, k.f0 = m.f0, k.metal = m.metal;
    k.a = m.a, k.b = m.b, k.mean = m.mean, k.again = m.again;
    for (int i = 0; i < WR_ALBEDO_TERMS; i++) k.albedo[i] = m.albedo[i];
    const WrKernLightd light = { .rgb = { 1, 1, 1 } };
    s->count = 1;
    s->bx[0] = at.n.x, s->by[0] = at.n.y, s->bz[0] = at.n.z;
    s->lx[0] = at.l.x, s->ly[0] = at.l.y, s->lz[0] = at.l.z;
    s->vx[0] = at.v.x, s->vy[0] = at.v.y, s->vz[0] = at.v.z;
    g->wide[set]->begin(0, s);
    g->wide[set]->reflect[of->model][of->energy](&light, &k, WR_REFLECT_AS_IT_IS, s);
    return s->dr[0] + s->sr[0];
}

/* Checks that it is 0 or more, and at most `most`, for every set and every model except Blinn-Phong. */
static void within(WrHardGauge *g, const WrReflectance *numbers, Place at, double most)
{
    for (int k = 0; k < 2 * (WR_REFLECT_COUNT - 1); k++) {
        WrReflectance of = *numbers;
        of.model = 1 + k / 2, of.energy = (WrEnergy)(k % 2);
        for (int set = 0; set < g->all; set++) {
            const double got = in_float(g, set, &of, at);
            wr_hard_holds(g, WR_HARD_FLOAT, got >= 0 && got <= most);
        }
        const double got = in_double(g, k & 1, &of, at);
        wr_hard_holds(g, WR_HARD_DOUBLE, got >= 0 && got <= most);
    }
}

static WrVec3 random_unit(WrHardGauge *g, double low)
{
    const WrVec3 a = { wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1),
                       wr_hard_between(g, low, 1) };
    return v3_unit(a, (WrVec3){ 0, 0, 1 });
}

static const WrVec3 up = { 0, 0, 1 };

static bool hc97(WrHardGauge *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 40; i++) {
        const WrVec3 l = random_unit(g, 0.05), v = v3_scale(l, -1);
        within(g, &ordinary, (Place){ up, l, v }, 1);
    }
    return true;
}

static bool hc98(WrHardGauge *g, WrError *err)
{
    const double least[] = { 0, 1e-20, 1e-30, 1e-7 };
    (void)err;
    for (int i = 0; i < 16; i++) {
        const Place at = { up, { 1, 0, least[i / 4] }, { -1, 0, least[i % 4] } };
        within(g, &ordinary, at, 1e4);
        within(g, &ordinary, (Place){ up, at.l, { 0, 1, least[i % 4] } }, 1e4);
    }
    return true;
}

/* GGX in long double, for metal: f0 = 1 in its colour. */
static double narrow(Place at, double alpha)
{
    long double n[3] = { at.n.x, at.n.y, at.n.z }, l[3] = { at.l.x, at.l.y, at.l.z };
    long double v[3] = { at.v.x, at.v.y, at.v.z }, h[3], hh = 0, nh = 0, nl = 0, nv = 0;
    for (int k = 0; k < 3; k++) {
        h[k] = l[k] + v[k];
        hh += h[k] * h[k], nh += n[k] * h[k], nl += n[k] * l[k], nv += n[k] * v[k];
    }
    long double across = 0;
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        const long double c = n[i] * h[j] - n[j] * h[i];
        across += c * c;
    }
    const long double a2 = (long double)alpha * alpha, w = (a2 * nh * nh + across) / hh;
    const long double lv = sqrtl(nv * nv * (1 - a2) + a2), ll = sqrtl(nl * nl * (1 - a2) + a2);
    return (double)(0.5L * a2 / (w * w) * 0.5L * nl / (nl * lv + nv * ll));
}

static bool hc99(WrHardGauge *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 200; i++) {
        const double rough = i % 2 ? 0 : 0.1, alpha = fmax(rough * rough, 1e-3);
        const WrReflectance of = { WR_REFLECT_GGX, WR_ENERGY_PUBLISHED, 0, rough, 1, 1.5 };
        Place at = { up, random_unit(g, 0.3), up };
        at.v = random_unit(g, 0.3);
        const WrVec3 h = v3_unit(v3_add(at.l, at.v), up);
        at.n = v3_unit(v3_mad(h, random_unit(g, -1), alpha * wr_hard_between(g, 0.5, 2)), h);
        if (v3_dot(at.n, at.l) < 0.1 || v3_dot(at.n, at.v) < 0.1) continue;
        const Place f = { wr_hard_vec(v3f_from(at.n)), wr_hard_vec(v3f_from(at.l)),
                          wr_hard_vec(v3f_from(at.v)) };
        const double peak = 0.25 / (alpha * alpha), exact = narrow(f, (double)(float)alpha);
        for (int set = 0; set < g->all; set++)
            wr_hard_off(g, WR_HARD_FLOAT, alpha * fabs(in_float(g, set, &of, f) - exact) / peak);
        wr_hard_off(g, WR_HARD_DOUBLE,
                    alpha * fabs(in_double(g, i & 1, &of, at) - narrow(at, alpha)) / peak);
    }
    return true;
}

static bool hc100(WrHardGauge *g, WrError *err)
{
    const double odd[] = { NAN, INFINITY, -INFINITY, -1, 2, 0, 1, 1e300 };
    (void)err;
    for (int i = 0; i < 64; i++) {
        const WrReflectance of = { .shininess = odd[i % 8],
                                   .roughness = odd[i / 8],
                                   .metalness = odd[(i + i / 8) % 8],
                                   .ior = odd[(3 * i) % 8] };
        const WrVec3 l = random_unit(g, 0.1), v = random_unit(g, 0.1);
        within(g, &of, (Place){ up, l, v }, 1e12);
        within(g, &of, (Place){ v3_unit(v3_add(l, v), up), l, v }, 1e12);
    }
    return true;
}

/* Fresnel's formula with angles, for an index above 1. */
static double by_angles(double c, double ior)
{
    const double i = acos(c), t = asin(sin(i) / ior);
    const double s = sin(i - t) / sin(i + t), p = tan(i - t) / tan(i + t);
    return 0.5 * (s * s + p * p);
}

/* Ratio of the reflection by Torrance and Sparrow's facets of some index to that of mirror facets, with n' equal
   to h. */
static double share(WrHardGauge *g, int set, bool wide, double ior, Place at)
{
    const WrReflectance of = { WR_REFLECT_TORRANCE_SPARROW, WR_ENERGY_KEPT, 0, 0.5, 0, ior };
    WrReflectance none = of, all = of;
    none.ior = 1, all.ior = 0.01;
    double got[3];
    const WrReflectance *three[] = { &of, &none, &all };
    for (int k = 0; k < 3; k++)
        got[k] = wide ? in_double(g, set, three[k], at) : in_float(g, set, three[k], at);
    return (got[0] - got[1]) / (got[2] - got[1]);
}

static bool hc102(WrHardGauge *g, WrError *err)
{
    const double index[] = { 1.5, 3.7, 1.01, 20 };
    (void)err;
    for (int i = 0; i < 60; i++) {
        const double c = wr_hard_between(g, 0.05, 0.7), s = sqrt(1 - c * c);
        const Place at = { up, { s, 0, c }, { -s, 0, c } };
        const double ior = index[i % 4], want = by_angles(c, ior);
        for (int set = 0; set < g->all; set++)
            wr_hard_near(g, WR_HARD_FLOAT, share(g, set, false, ior, at), want);
        wr_hard_near(g, WR_HARD_DOUBLE, share(g, i & 1, true, ior, at), want);
        /* beyond the critical angle: total reflection */
        wr_hard_near(g, WR_HARD_DOUBLE, share(g, i & 1, true, 0.67, at), 1);
    }
    return true;
}

static bool hc104(WrHardGauge *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 120; i++) {
        WrReflectance of = ordinary;
        of.model = 1 + i % (WR_REFLECT_COUNT - 1), of.roughness = wr_hard_between(g, 0.2, 1);
        const Place at = { up, random_unit(g, 0.1), random_unit(g, 0.1) };
        const Place back = { up, at.v, at.l };
        for (int set = 0; set < g->all; set++) {
            const double a = in_float(g, set, &of, at) / at.l.z;
            wr_hard_off(g, WR_HARD_FLOAT, fabs(in_float(g, set, &of, back) / at.v.z - a) / (1 + a));
        }
        const double a = in_double(g, i / 4 % 2, &of, at) / at.l.z;
        wr_hard_off(g, WR_HARD_DOUBLE,
                    fabs(in_double(g, i / 4 % 2, &of, back) / at.v.z - a) / (1 + a));
    }
    return true;
}

/* n.v from just above 0 to below by steps of 1e-4. */
static bool hc105(WrHardGauge *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 4 * 40; i++) {
        WrReflectance of = ordinary;
        of.model = 1 + i % (WR_REFLECT_COUNT - 1);
        const double a = 2e-3 - 1e-4 * (i / 4), b = a - 1e-4;
        const WrVec3 l = { 0.6, 0.64, 0.48 };
        const Place first = { up, l, { sqrt(1 - a * a), 0, a } };
        const Place next = { up, l, { sqrt(1 - b * b), 0, b } };
        for (int set = 0; set < g->all; set++)
            wr_hard_near(g, WR_HARD_FLOAT, in_float(g, set, &of, next),
                         in_float(g, set, &of, first));
        wr_hard_near(g, WR_HARD_DOUBLE, in_double(g, 0, &of, next), in_double(g, 0, &of, first));
    }
    return true;
}

static bool hc107(WrHardGauge *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 40; i++) {
        const WrVec3 a = i == 0 ? (WrVec3){ 1, 0, 0 } : random_unit(g, 0);
        within(g, &ordinary, (Place){ up, up, a }, 12);
        within(g, &ordinary, (Place){ up, a, up }, 12);
        within(g, &ordinary, (Place){ up, up, up }, 40);
    }
    return true;
}

static bool hc108(WrHardGauge *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 40; i++) {
        const WrReflectance of = { WR_REFLECT_OREN_NAYAR, (WrEnergy)(i % 2), 0, 0, 0, 1.5 };
        const Place at = { up, random_unit(g, 0), random_unit(g, 0) };
        for (int set = 0; set < g->all; set++)
            wr_hard_near(g, WR_HARD_FLOAT, in_float(g, set, &of, at), 0.5 * at.l.z);
        wr_hard_near(g, WR_HARD_DOUBLE, in_double(g, i / 2 % 2, &of, at), 0.5 * at.l.z);
    }
    return true;
}

/* A picture of partial or full metal, in that colour. */
static bool of_metal(WrHardGauge *g, double metal, double colour, bool in_double, WrHardShot *shot,
                     WrError *err)
{
    WrScene *scene = wr_scene_new();
    WrShape shape;
    wr_shape_default(WR_SURFACE_sphere, &shape);
    wr_scene_set_shape(scene, &shape);
    scene->bump = WR_BUMP_NONE;
    scene->material.model = WR_REFLECT_GGX, scene->material.metalness = metal;
    scene->material.roughness = 0.37, scene->material.specular = 1;
    scene->material.colour = (WrVec3){ colour, colour, colour };
    if (in_double) scene->dials.shading = WR_SHADING_DOUBLE;
    WrField *field = wr_field_new(4, 3, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, err);
    const WrFrameRequest request = { .field = field, .scene = scene, .width = 13, .height = 11 };
    const bool good = field && wr_hard_shoot(g, &request, shot, err);
    wr_field_free(field);
    wr_scene_free(scene);
    return good;
}

static bool hc110(WrHardGauge *g, WrError *err)
{
    const double metals[] = { 0.5, 0.83, 1 }, colours[] = { 1 + 1e-6, 3.7, 1e6 };
    bool good = true;
    for (int i = 0; i < 18 && good; i++) {
        WrHardShot white, more;
        const bool wide = i / 9 > 0;
        good = of_metal(g, metals[i % 3], 1, wide, &white, err);
        if (!good) break;
        good = of_metal(g, metals[i % 3], colours[i / 3 % 3], wide, &more, err);
        for (int k = 0; good && k < 13 * 11 * 4; k++)
            wr_hard_holds(g, wide ? WR_HARD_DOUBLE : WR_HARD_FLOAT,
                          white.frame.rgba[k] == more.frame.rgba[k]);
        if (good) wr_hard_put_away(&more);
        wr_hard_put_away(&white);
    }
    return good;
}

#define ROW(number, situation, rule, u, float_bound, double_bound, material)                       \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_RENDER, .what = situation, .holds = rule,           \
        .unit = u, .bound = { float_bound, double_bound }, .measure = hc##number,                  \
        .scene = "table 64x64\nformula fourier terms=3,0,0.5;0,5,0.25,90,0\nsurface sphere\n"      \
                 "bump height=0.02\nmaterial " material                                            \
    }
static const WrHardCase rows[] = {
    ROW(97, "light from exactly behind, by every model", "no highlight: within 0..1", "violations",
        0, 0, "model=ggx\nlight directional to=0,0,-1"),
    ROW(98, "lamp and eye along the surface, down to 1e-30 above it", "finite and not below 0",
        "violations", 0, 0, "model=torrance-sparrow"),
    ROW(99, "highlights as narrow as there are", "as right as the directions",
        "of the peak, by width", 1e-6, 1e-14, "model=ggx roughness=0 specular=1"),
    ROW(100, "roughness, metalness, index, exponent: none, infinite, out of range",
        "taken as the ends of their ranges: finite", "violations", 0, 0, "model=ggx roughness=1"),
    ROW(102, "Fresnel's reflectance at any angle, and beyond the critical one",
        "as the formula with angles has it, and 1", "of 1", 1e-4, 1e-9,
        "model=torrance-sparrow ior=1.01 specular=100"),
    ROW(104, "lamp and eye change places", "the same is reflected", "relative", 2e-5, 1e-12,
        "model=torrance-sparrow"),
    ROW(105, "n' turned past the viewer, step by step of 1e-4", "no jump", "intensity", 2e-2, 2e-2,
        "model=ggx\nbump height=0.2"),
    ROW(107, "lamp or eye along n'", "a number, within what is reflected", "violations", 0, 0,
        "model=oren-nayar roughness=1"),
    ROW(108, "Oren and Nayar's facets of roughness 0", "Lambert's law", "intensity", 1e-6, 1e-7,
        "model=oren-nayar roughness=0"),
    ROW(110, "metal, half or whole, of a colour above 1", "taken as 1: no more light than comes",
        "violations", 0, 0, "model=ggx metalness=0.5 colour=3,2,1"),
};
WR_HARD_LIST(reflect, rows);
