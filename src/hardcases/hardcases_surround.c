/* Hard cases of environments. */
#include "hardcases/hardcases_internal.h"

#include "base/error.h"
#include "base/memory.h"
#include "image/image.h"
#include "render/environment/env_lookup.h"
#include "shade/environment_blur.h"

typedef double Sky(WrVec3 d);

static const WrVec3 east = { 0.48, 0.6, 0.64 }; /* unit */

static double one(WrVec3 d)
{
    (void)d;
    return 0.73;
}

/* All texels different, within 0..1. */
static double rough(WrVec3 d)
{
    const double x = sin(1234.5 * d.x + 789.1 * d.y + 456.7 * d.z) * 43758.5453;
    return x - floor(x);
}

static double sun(WrVec3 d)
{
    return v3_dot(d, east) > 0.9998 ? 1e5 : 0.1;
}

/* An environment of w x h texels; owned by the caller. */
static WrEnvironmentMap *around(int w, int h, Sky *sky, WrError *err)
{
    WrEnvironmentMapTold told;
    WrImage *image = wr_image_new(w, h, 1, err);
    if (!image) return NULL;
    image->type = WR_PIXEL_F32;
    for (int i = 0; i < w * h; i++)
        image->data[i] =
            (float)sky(wr_environment_map_direction((i % w + 0.5) / w, 1 - (i / w + 0.5) / h));
    WrEnvironmentMap *made = wr_environment_map_new(image, &told, err);
    wr_image_free(image);
    return made;
}

/* Mirror reflection in direction d by the kernels. */
static double mirrored(WrHardGauge *g, int set, const WrEnvLookup *m, WrVec3 d)
{
    WrStrip *s = g->strip;
    const WrKernMirror how = { .axes = { 1, 0, 0, 0, 1, 0, 0, 0, 1 },
                               .strength = 1,
                               .white = { 1 },
                               .rgba = m->rgba + 4 * (m->pitch + 1),
                               .pitch = m->pitch,
                               .width = m->width,
                               .height = m->height };
    s->count = 1;
    s->bx[0] = s->vx[0] = (float)d.x, s->by[0] = s->vy[0] = (float)d.y;
    s->bz[0] = s->vz[0] = (float)d.z;
    g->kernels[set]->begin(0, s);
    g->kernels[set]->mirror(&how, s);
    return (double)s->sr[0];
}

static const double straight[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };

/* Diffuse light of a normal by the kernels. */
static double lit(WrHardGauge *g, int set, const WrEnvironmentMap *from, WrVec3 n)
{
    WrStrip *s = g->strip;
    double form[3][WR_FORM_TERMS];
    WrKernSurround how = { .kd = 1 };
    wr_environment_map_form(from, straight, 1, 2, form);
    for (int i = 0; i < WR_FORM_TERMS; i++) how.form[0][i] = (float)form[0][i];
    s->count = 1;
    s->bx[0] = (float)n.x, s->by[0] = (float)n.y, s->bz[0] = (float)n.z;
    g->kernels[set]->begin(0, s);
    g->kernels[set]->surround[1][0](&how, s);
    return (double)s->dr[0];
}

static WrVec3 random_unit(WrHardGauge *g)
{
    const WrVec3 a = { wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1),
                       wr_hard_between(g, -1, 1) };
    return v3_unit(a, (WrVec3){ 0, 0, 1 });
}

/* Equal results from both sides of a point where longitudes jump. */
static void look_twice(WrHardGauge *g, const WrEnvironmentMap *from, const WrEnvLookup *m, WrVec3 a,
                       WrVec3 b)
{
    double x[3], y[3];
    wr_environment_map_at(from, a, x);
    wr_environment_map_at(from, b, y);
    wr_hard_near(g, WR_HARD_DOUBLE, x[1], y[1]);
    for (int set = 0; set < g->all; set++)
        wr_hard_near(g, WR_HARD_FLOAT, mirrored(g, set, m, a), mirrored(g, set, m, b));
}

static bool hc111(WrHardGauge *g, WrError *err)
{
    WrEnvLookup m = { 0 };
    WrEnvironmentMap *from = around(37, 18, rough, err);
    if (!from || !wr_env_lookup_update(&m, from, NULL, 0, g->pool, err)) {
        wr_environment_map_free(from);
        return false;
    }
    for (int i = 0; i < 40; i++) {
        const double t = wr_hard_between(g, -4, 4), e = 1e-9, y = i % 2 ? 1 : -1;
        const double h = wr_hard_between(g, -1, 1), r = sqrt(1 - h * h);
        look_twice(g, from, &m, (WrVec3){ 0, y, 0 }, (WrVec3){ e * cos(t), y, e * sin(t) });
        look_twice(g, from, &m, (WrVec3){ e, h, r }, (WrVec3){ -e, h, r });
    }
    wr_env_lookup_drop(&m);
    wr_environment_map_free(from);
    return true;
}

static bool hc112(WrHardGauge *g, WrError *err)
{
    static const int sizes[][2] = { { 1, 1 }, { 1, 7 }, { 9, 1 }, { 13, 5 }, { 2, 3 } };
    for (int k = 0; k < 5; k++) {
        WrEnvLookup m = { 0 };
        WrEnvironmentMap *from = around(sizes[k][0], sizes[k][1], rough, err);
        if (!from || !wr_env_lookup_update(&m, from, NULL, 0, g->pool, err)) {
            wr_environment_map_free(from);
            return false;
        }
        for (int i = 0; i < 20; i++) {
            const WrVec3 d = i ? random_unit(g) : (WrVec3){ 0, 1, 0 };
            double at[3];
            wr_environment_map_at(from, d, at);
            wr_hard_holds(g, WR_HARD_DOUBLE, at[0] >= 0 && at[0] <= 1);
            for (int set = 0; set < g->all; set++)
                wr_hard_holds(g, WR_HARD_FLOAT, fabs(mirrored(g, set, &m, d) - at[0]) <= 1e-4);
        }
        wr_env_lookup_drop(&m);
        wr_environment_map_free(from);
    }
    return true;
}

static bool hc113(WrHardGauge *g, WrError *err)
{
    WrEnvironmentMap *from = around(512, 256, sun, err);
    if (!from) return false;
    const double all = 2 * sqrt(3.14159265358979323846) * from->harmonic[0][0];
    double form[3][WR_FORM_TERMS];
    wr_environment_map_form(from, straight, 1, 2, form);
    for (int i = 0; i < 200; i++) {
        const WrVec3 n = random_unit(g);
        const double want = fmax(0, v3_dot(n, east)) * (all - 0.4 * 3.14159265358979323846) /
                                3.14159265358979323846 +
                            0.1;
        for (int set = 0; set < g->all; set++) {
            const double got = lit(g, set, from, n);
            wr_hard_holds(g, WR_HARD_FLOAT, got >= 0);
            wr_hard_holds(g, WR_HARD_DOUBLE,
                          got - want <= 3.0 / 32 * all / 3.1 && want - got <= 0.04 * all / 3.1);
        }
    }
    wr_environment_map_free(from);
    return true;
}

static bool hc114(WrHardGauge *g, WrError *err)
{
    static const float strange[] = { NAN, -NAN, INFINITY, -INFINITY, 3e38f, -1, -0.0f, 0.5f };
    WrEnvironmentMapTold told;
    WrImage *image = wr_image_new(8, 4, 3, err);
    if (!image) return false;
    image->type = WR_PIXEL_F32;
    for (int i = 0; i < 8 * 4 * 3; i++) image->data[i] = strange[i * 5 / 3 % 8];
    WrEnvLookup m = { 0 };
    const WrEnvironmentBrdf wide = { .lobe = WR_LOBE_FACETS, .alpha = 0.3, .gated = true };
    WrEnvironmentMap *from = wr_environment_map_new(image, &told, err);
    wr_image_free(image);
    const bool good = from && wr_env_lookup_update(&m, from, &wide, 16, g->pool, err);
    for (int i = 0; i < 40 && good; i++) {
        const WrVec3 d = random_unit(g);
        double at[3];
        wr_environment_map_at(from, d, at);
        wr_hard_holds(g, WR_HARD_DOUBLE, at[2] >= 0 && at[2] <= 1.001e9);
        for (int set = 0; set < g->all; set++) {
            const double mirror = mirrored(g, set, &m, d), diffuse = lit(g, set, from, d);
            wr_hard_holds(g, WR_HARD_FLOAT, mirror >= 0 && mirror <= 1.01e9);
            wr_hard_holds(g, WR_HARD_FLOAT, diffuse >= 0 && diffuse <= 1.01e9);
        }
    }
    if (good) wr_hard_holds(g, WR_HARD_DOUBLE, told.lost > 0 && told.below > 0 && told.above > 0);
    wr_env_lookup_drop(&m);
    wr_environment_map_free(from);
    return good;
}

static bool hc115(WrHardGauge *g, WrError *err)
{
    WrEnvironmentMap *from = around(37, 18, one, err);
    bool good = from != NULL;
    for (int k = 0; k < 4 && good; k++) {
        WrEnvLookup m = { 0 };
        const WrEnvironmentBrdf wide = { .lobe = k % 2 ? WR_LOBE_POWER : WR_LOBE_FACETS,
                                         .alpha = 0.07 + 0.31 * k,
                                         .power = 7.3,
                                         .gated = true };
        double order[1];
        good = wr_env_lookup_update(&m, from, &wide, 16, g->pool, err);
        wr_blur_orders(&wide, 1, order);
        wr_hard_near(g, WR_HARD_DOUBLE, order[0] * 0.73, 0.73);
        for (int i = 0; i < 20 && good; i++)
            for (int set = 0; set < g->all; set++) {
                const WrVec3 d = random_unit(g);
                wr_hard_near(g, WR_HARD_FLOAT, mirrored(g, set, &m, d), 0.73);
                wr_hard_near(g, WR_HARD_FLOAT, lit(g, set, from, d), 0.73);
            }
        wr_env_lookup_drop(&m);
    }
    wr_environment_map_free(from);
    return good;
}

/* m1 of the microfacets in the prefilter of n = v = r: the share of a linear sky's slope that remains. */
static double slope_kept(double alpha)
{
    const double a2 = alpha * alpha, a = (1 + a2) / 2, k = (1 - a2) / 2;
    const double whole = 2 * a2 / (k * k) * (a / a2 - 1 + log(a2 / a));
    return 2 * a2 * (a * a / a2 - a2 - 2 * a * log(a / a2)) / (k * k * k * whole);
}

static double linear(WrVec3 d)
{
    return 1 + 0.9 * v3_dot(d, east);
}

static WrEnvironmentBrdf facets_of(double alpha)
{
    return (WrEnvironmentBrdf){ .lobe = WR_LOBE_FACETS, .alpha = alpha, .power = 1, .gated = true };
}

static bool hc101(WrHardGauge *g, WrError *err)
{
    const double near[] = { 1, 1 - 1e-12, 1 - 1e-6, 0.9991 };
    const double flat[] = { 1, 2.0 / 3, 1.0 / 4, 0, -1.0 / 24 }; /* coefficients of max(0, c) */
    double order[5];
    for (int i = 0; i < 4; i++) {
        const WrEnvironmentBrdf gloss = facets_of(near[i]);
        wr_blur_orders(&gloss, 5, order);
        for (int l = 0; l < 5; l++) /* the slope at 1 is below 1 */
            wr_hard_off(g, WR_HARD_DOUBLE, fmax(0, fabs(order[l] - flat[l]) - (1 - near[i])));
    }
    for (int i = 0; i < 20; i++) {
        const double alpha = wr_hard_between(g, 0.2, 0.97), mu = wr_hard_between(g, 0.02, 1);
        const WrEnvironmentBrdf gloss = facets_of(alpha);
        double e[2];
        wr_blur_orders(&gloss, 2, order);
        wr_hard_off(g, WR_HARD_DOUBLE, fabs(order[1] - slope_kept(alpha)));
        wr_ggx_albedo(1, mu, e);
        wr_hard_off(g, WR_HARD_FLOAT, fabs(e[0] + e[1] - (1 - mu * log(1 + 1 / mu))));
    }
    WrEnvironmentMap *from = around(64, 32, linear, err);
    WrEnvLookup m = { 0 };
    const WrEnvironmentBrdf gloss = facets_of(1);
    bool good = from && wr_env_lookup_update(&m, from, &gloss, 16, g->pool, err);
    for (int i = 0; i < 20 && good; i++)
        for (int set = 0; set < g->all; set++) {
            const WrVec3 d = random_unit(g);
            const double want = 1 + 0.9 * 2 / 3 * v3_dot(d, east);
            wr_hard_off(g, WR_HARD_FLOAT, fabs(mirrored(g, set, &m, d) - want));
        }
    wr_env_lookup_drop(&m);
    wr_environment_map_free(from);
    return good;
}

static bool hc116(WrHardGauge *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 40; i++) {
        const double turn = floor(wr_hard_between(g, -180, 180) * 64) / 64;
        double a[9], b[9];
        wr_environment_map_turn(turn, a);
        wr_environment_map_turn(turn + 360.0 * (i - 20), b);
        for (int k = 0; k < 9; k++) {
            wr_hard_near(g, WR_HARD_DOUBLE, a[k], b[k]);
            wr_hard_near(g, WR_HARD_FLOAT, (double)(float)a[k], (double)(float)b[k]);
        }
    }
    return true;
}

#define ROW(number, situation, rule, u, float_bound, double_bound, material)                       \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_RENDER, .what = situation, .holds = rule,           \
        .unit = u, .bound = { float_bound, double_bound }, .measure = hc##number,                  \
        .scene = "table 64x64\nformula fourier terms=3,0,0.5;0,5,0.25,90,0\nsurface sphere\n"      \
                 "bump height=0.02\nlight clear\nmaterial " material                               \
    }
static const WrHardCase rows[] = {
    ROW(101, "facets of width 1, and all but: what their lobe keeps of a linear sky, their albedo",
        "that of a matt lobe; 1 - mu ln(1 + 1/mu)", "of the light", 2.5e-3, 1e-6,
        "model=ggx roughness=1 specular=1\nenvironment sky"),
    ROW(111, "surroundings straight up and down, and where longitudes jump",
        "the same from all sides", "of a texel", 1e-4, 1e-6,
        "model=ggx roughness=0\nenvironment sky"),
    ROW(112, "surroundings of 1 texel, and of odd widths", "looked up, within their texels",
        "violations", 0, 0, "model=ggx roughness=0.3\nenvironment raking"),
    ROW(113, "a sun of a few texels, 1e5 as bright as the sky",
        "diffuse light is not below 0, and within 3/32 of all", "violations", 0, 0,
        "model=ggx\nenvironment sky strength=100"),
    ROW(114, "surroundings of infinities, no numbers, numbers below 0",
        "taken as light or as none, and counted", "violations", 0, 0,
        "model=ggx\nenvironment studio strength=1000000"),
    ROW(115, "surroundings of one colour, blurred and diffuse", "that colour", "of the light", 2e-6,
        1e-14, "diffuse=1\nenvironment studio"),
    ROW(116, "surroundings turned by whole turns more", "the same", "of a direction", 0, 0,
        "model=ggx\nenvironment studio turn=720"),
};
WR_HARD_LIST(surround, rows);
