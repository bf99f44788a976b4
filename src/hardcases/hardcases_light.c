/* Hard cases of highlights, of means over samples, and of pictures. */
#include "hardcases/hardcases_internal.h"

#include "base/error.h"
#include "base/kernmath.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/scene.h"
#include "base/vec.h"

#include <string.h>

/* The highlight of n', l, v by the kernels. */
static double highlight(WrHardGauge *g, int set, WrVec3f perturbed, WrVec3f light, WrVec3f view,
                        double shininess, bool gate)
{
    WrStrip *s = g->strip;
    const WrKernLight kern = { .where = { light.x, light.y, light.z }, .rgb = { 1, 1, 1 } };
    s->count = 1;
    s->bx[0] = perturbed.x, s->by[0] = perturbed.y, s->bz[0] = perturbed.z;
    s->vx[0] = view.x, s->vy[0] = view.y, s->vz[0] = view.z;
    s->px[0] = s->py[0] = s->pz[0] = 0.0f;
    g->kernels[set]->begin(0.0f, s);
    g->kernels[set]->light(&kern, s);
    g->kernels[set]->specular(&kern, 1.0f, (float)shininess, gate, s);
    return (double)s->sr[0];
}

/* The highlight by the kernels in double. */
static double highlight_wide(WrHardGauge *g, int set, const WrHardLit *lit)
{
    WrStripd *s = g->wide_strip;
    const WrVec3 l = lit->light;
    const WrKernLightd kern = { .where = { l.x, l.y, l.z }, .rgb = { 1, 1, 1 } };
    s->count = 1;
    s->bx[0] = lit->perturbed.x, s->by[0] = lit->perturbed.y, s->bz[0] = lit->perturbed.z;
    s->vx[0] = lit->view.x, s->vy[0] = lit->view.y, s->vz[0] = lit->view.z;
    s->px[0] = s->py[0] = s->pz[0] = 0.0;
    g->wide[set]->begin(0.0, s);
    g->wide[set]->light(&kern, s);
    g->wide[set]->specular(&kern, 1.0, lit->shininess, lit->gate, s);
    return s->sr[0];
}

/* (n'.h)^s in 64 bits: from |n' - h|, so that no digit is lost near 1. */
static double lobe_of(WrVec3 perturbed, WrVec3 light, WrVec3 view, double s)
{
    long double n[3] = { perturbed.x, perturbed.y, perturbed.z },
                h[3] = { light.x, light.y, light.z };
    h[0] += view.x, h[1] += view.y, h[2] += view.z;
    long double nn = 0, hh = 0, off = 0;
    for (int k = 0; k < 3; k++) nn += n[k] * n[k], hh += h[k] * h[k];
    for (int k = 0; k < 3; k++) {
        const long double d = n[k] / sqrtl(nn) - h[k] / sqrtl(hh);
        off += d * d;
    }
    if (s == 0.0) return 1.0;
    return off < 2 ? (double)expl((long double)s * log1pl(-off / 2)) : 0.0;
}

/* A random unit vector in the upper half. */
static WrVec3 random_up(WrHardGauge *g)
{
    const WrVec3 a = { wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1),
                       wr_hard_between(g, 0.2, 1) };
    return v3_unit(a, a);
}

/* Rounding error of a highlight caused by n', l and v, in units of that: directions are accurate to one or two
   ulps, and the lobe's slope is sqrt(s). So one bound holds for all powers. */
static double steps(double got, double want, double s, double ulp)
{
    return fabs(got - want) / (ulp * sqrt(1.0 + s));
}

/* n' near h, both in random directions: where a high power is not 0. */
static bool generic_highlight(WrHardGauge *g, double s, WrError *err)
{
    const WrVec3 l = random_up(g), v = random_up(g), h = v3_unit(v3_add(l, v), l);
    const double wide = wr_hard_between(g, 0, 2.5) / sqrt(1.0 + s);
    const WrVec3 aside = v3_unit(v3_cross(h, random_up(g)), h);
    const WrVec3 n = v3_unit(v3_mad(h, aside, wide), h);
    const WrVec3f nf = v3f_from(n), lf = v3f_from(l), vf = v3f_from(v);
    const double want = lobe_of(wr_hard_vec(nf), wr_hard_vec(lf), wr_hard_vec(vf), s);
    for (int set = 0; set < g->all; set++)
        wr_hard_off(g, WR_HARD_FLOAT,
                    steps(highlight(g, set, nf, lf, vf, s, false), want, s, 0x1p-23));
    const WrHardLit lit = { .perturbed = n, .light = l, .view = v, .specular = 1, .shininess = s };
    for (int set = 0; set < 2; set++)
        wr_hard_off(g, WR_HARD_DOUBLE,
                    steps(highlight_wide(g, set, &lit), lobe_of(n, l, v, s), s, 0x1p-52));
    if (!(n.z > 0.05)) return true;
    double part[2];
    if (!wr_hard_shine(&lit, part, err)) return false;
    wr_hard_off(g, WR_HARD_DOUBLE, steps(part[1], lobe_of(n, l, v, s), s, 0x1p-52));
    return true;
}

/* A dented plane under a light from the eye's position, as pictures: float compared with double. */
static bool shiny_pictures(WrHardGauge *g, WrError *err)
{
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    int lit = 0;
    for (int k = 0; k < 4 && good; k++) {
        WrScene *scene = wr_scene_new();
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = 64, .height = 64
        };
        const double s = scene->material.shininess = k % 2 ? 1e6 : 1e5;
        WrHardShot shots[WR_HARD_WAYS] = { { .renderer = NULL } };
        scene->shape = wr_hard_shape(k / 2 ? WR_SURFACE_sphere : WR_SURFACE_plane);
        const WrVec3 ahead = { k / 2 ? 1 : 0, 0, k / 2 ? 0 : 1 };
        scene->posed = scene->lights_given = true;
        scene->height = 1e-4;
        scene->lights[0] = (WrLight){
            .kind = WR_LIGHT_DIRECTIONAL, .where = ahead, .colour = { 1, 1, 1 }, .strength = 1
        };
        scene->camera = (WrCamera){ .orthographic = true,
                                    .eye = v3_scale(ahead, 5.0),
                                    .up = { 0, 1, 0.5 },
                                    .size = k / 2 ? 0.02 : 0.7 };
        scene->material.specular = 1.0;
        scene->material.diffuse = scene->material.ambient = 0.0;
        for (int way = 0; way < WR_HARD_WAYS && good; way++)
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &shots[way], err);
        for (int i = 0; i < 4 * 64 * 64 && good; i++) {
            const double want = (double)shots[WR_HARD_WIDE].frame.rgba[i];
            lit += i % 4 == 0 && want > 0.3;
            for (int way = 0; way < WR_HARD_WIDE; way++) /* n' itself has an error of a few ulps */
                wr_hard_off(g, WR_HARD_FLOAT,
                            steps((double)shots[way].frame.rgba[i], want, s, 0x1p-23));
        }
        for (int way = 0; way < WR_HARD_WAYS; way++) wr_hard_put_away(&shots[way]);
        wr_scene_free(scene);
    }
    if (good)
        wr_hard_off(g, WR_HARD_FLOAT, lit > 100 ? 0.0 : 1e9); /* otherwise nothing was visible */
    wr_field_free(field);
    return good;
}

/* Random directions for each power; the power itself for floats; and every highlight must be within 0..1. */
static bool hc89(WrHardGauge *g, WrError *err)
{
    static const double powers[] = { 0, 1, 0.5, 30, 1000, 1e5, 1e6 };
    for (int k = 0; k < 7 * 300; k++) {
        const double s = powers[k % 7];
        float c = k < 14 ? (k < 7 ? 0.0f : 1.0f) : wr_hard_float(g);
        if (k % 2) c = 1.0f - c * 1e-4f; /* where a high power is not 0 */
        wr_hard_off(g, WR_HARD_FLOAT,
                    steps((double)wr_pow01_f(c, (float)s), pow((double)c, s), s, 0x1p-23));
        const WrVec3f z = { 0, 0, 1 };
        const WrVec3f light = { sqrtf(1.0f - c * c), 0, c };
        for (int set = 0; set < g->all; set++) {
            const double shine = highlight(g, set, z, light, z, s, true);
            wr_hard_off(g, WR_HARD_FLOAT, 1e9 * (fmax(0.0, shine - 1.0) + fmax(0.0, -shine)));
        }
        if (!generic_highlight(g, s, err)) return false;
    }
    return shiny_pictures(g, err);
}

/* n' and h equal, but longer than 1 by some ulps. */
static bool hc90(WrHardGauge *g, WrError *err)
{
    float c = 1.0f;
    for (int k = 0; k < 16; k++) {
        const WrVec3f n = { 0, 0, c };
        wr_hard_off(g, WR_HARD_FLOAT, fmax(0.0, (double)wr_pow01_f(c, 1e5f) - 1.0));
        for (int set = 0; set < g->sets; set++)
            wr_hard_off(g, WR_HARD_FLOAT, fmax(0.0, highlight(g, set, n, n, n, 1e5, true) - 1.0));
        c = nextafterf(c, 2.0f);
    }
    for (int k = 0; k < 200; k++) { /* n', l and v in one direction, each rounded differently */
        const double x = wr_hard_between(g, -1, 1), y = wr_hard_between(g, -1, 1);
        const WrVec3 n = v3_unit((WrVec3){ x, y, 1 }, (WrVec3){ 0, 0, 1 });
        const WrHardLit lit = { .perturbed = n,
                                .light = v3_scale(n, 1.0 + k),
                                .view = n,
                                .specular = 1,
                                .shininess = 1e5,
                                .gate = true };
        double part[2];
        if (!wr_hard_shine(&lit, part, err)) return false;
        wr_hard_off(g, WR_HARD_DOUBLE, fmax(0.0, part[1] - 1.0));
    }
    return true;
}

/* No half vector: light exactly from behind, or no light at all; with and without the gate. */
static bool hc91(WrHardGauge *g, WrError *err)
{
    static const double powers[] = { 0, 1, 30 };
    for (int k = 0; k < 12; k++) {
        const WrVec3f v = { 0.6f, 0, 0.8f }, back = { -0.6f, 0, -0.8f }, none = { 0, 0, 0 };
        for (int set = 0; set < g->sets; set++) {
            wr_hard_off(g, WR_HARD_FLOAT, highlight(g, set, v, back, v, powers[k % 3], k % 2 != 0));
            wr_hard_off(g, WR_HARD_FLOAT, highlight(g, set, v, none, v, powers[k % 3], true));
        }
        const WrHardLit lit = { .perturbed = { 0, 0, 1 },
                                .light = { 0, 0, -1 },
                                .view = { 0, 0, 1 },
                                .specular = 1,
                                .shininess = powers[k % 3],
                                .gate = k % 2 };
        double part[2];
        if (!wr_hard_shine(&lit, part, err)) return false;
        wr_hard_off(g, WR_HARD_DOUBLE, part[1]);
    }
    return true;
}

/* Deviation of a mean of n x n equal values from the value, relative to the allowed one: 0 for powers of two
   (any difference counts 2), else n^2 - 1 ulps of the precision. */
static double mean_off(double got, double want, int n, int bits)
{
    const double ulp = ldexp(1.0, ilogb(fmax(fabs(want), 1e-30)) - bits);
    const bool exact = (n & (n - 1)) == 0;
    const double off = fabs(got - want) / (exact ? ulp : ulp * (n * n - 1));
    return exact && off > 0.0 ? 2.0 : off;
}

/* A flat plane under a directional light, seen from afar: all samples of a pixel are equal. */
static bool hc92(WrHardGauge *g, WrError *err)
{
    enum { VALUES = 16 * 16 * 4 };
    static const int counts[] = { 1, 2, 3, 5, 16, 64 };
    WrField *flat = wr_field_new(8, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, err);
    if (!flat) return false;
    WrScene *scene = wr_scene_new();
    scene->posed = true;
    scene->camera =
        (WrCamera){ .orthographic = true, .eye = { 0, 0, 3 }, .up = { 0, 1, 0 }, .size = 0.5 };
    WrHardShot point = { .renderer = NULL };
    WrReference single = { 0 };
    WrFrameRequest request = { .field = flat, .scene = scene, .width = 16, .height = 16 };
    bool good =
        wr_hard_shoot(g, &request, &point, err) && wr_hard_refer(g, &request, 1, &single, err);
    scene->dials.aa = WR_AA_SUPERSAMPLE;
    for (int k = 0; k < 6 && good; k++) {
        const int n = scene->dials.samples = counts[k];
        WrHardShot many = { .renderer = NULL };
        WrReference refined = { 0 };
        const bool refers = (n & (n - 1)) == 0; /* the reference supports only powers of two */
        good = wr_hard_shoot(g, &request, &many, err) &&
               (!refers || wr_hard_refer(g, &request, n, &refined, err));
        for (int i = 0; i < VALUES && good; i++) {
            wr_hard_off(g, WR_HARD_FLOAT,
                        mean_off((double)many.frame.rgba[i], (double)point.frame.rgba[i], n, 23));
            if (refers)
                wr_hard_off(g, WR_HARD_DOUBLE, mean_off(refined.rgba[i], single.rgba[i], n, 52));
        }
        wr_hard_put_away(&many);
        wr_reference_fini(&refined);
    }
    wr_hard_put_away(&point);
    wr_reference_fini(&single);
    wr_scene_free(scene);
    wr_field_free(flat);
    return good;
}

/* Impossible covariances: slightly negative, or a mixed term larger than the others allow. */
static bool hc93(WrHardGauge *g, WrError *err)
{
    (void)err;
    static const double spreads[][3] = { { -1e-9, 0, -1e-9 },    { 0.01, 0.0100001, 0.01 },
                                         { 0, 1e-3, 0 },         { -1, 5, -2 },
                                         { 1e30, 2e30, 1e30 },   { NAN, 0, 0.1 },
                                         { INFINITY, 0, 1e-30 }, { 1e-30, -1e-20, 1e-12 } };
    const WrKernLight light = { .where = { 0.6f, 0, 0.8f }, .rgb = { 1, 1, 1 } };
    for (int k = 0; k < 8 * 4 * 2; k++)
        for (int set = 0; set < g->sets; set++) {
            static const float powers[] = { 0, 1, 30, 1e6f };
            const WrKernels *kernels = g->kernels[set];
            const WrKernShine shine = { .ks = 1, .shininess = powers[k / 8 % 4], .gate = true };
            const WrSurfacePointf at = {
                .pu = { 1, 0, 0 }, .pv = { 0.3f, 1, 0 }, .n_unit = { 0, 0, 1 }, .n_len = 1
            };
            WrStrip *s = g->strip;
            wr_hard_perturbed_f(g, set, WR_BUMP_BLINN, &at, (WrHardSlope){ 0, 0.1, -0.2 }, false);
            s->suu[0] = (float)spreads[k % 8][0];
            s->suv[0] = (float)spreads[k % 8][1];
            s->svv[0] = (float)spreads[k % 8][2];
            s->vx[0] = s->vy[0] = 0.0f, s->vz[0] = 1.0f;
            kernels->widen(k % 2, s);
            kernels->begin(0.0f, s);
            kernels->light(&light, s);
            if (k < 32) kernels->specular_lean(&light, &shine, s);
            else kernels->specular_toksvig(&light, &shine, s);
            const bool matrix = s->see[0] >= 0.0f && s->sff[0] >= 0.0f &&
                                (double)s->sef[0] * (double)s->sef[0] <=
                                    (double)s->see[0] * (double)s->sff[0] * (1 + 1e-6);
            wr_hard_holds(g, WR_HARD_FLOAT, matrix);
            wr_hard_holds(g, WR_HARD_FLOAT, s->sr[0] >= 0.0f && s->sr[0] <= 1.0f);
        }
    return true;
}

/* The full computation, including everything a plan would leave out. */
static bool hc94(WrHardGauge *g, WrError *err)
{
    static const WrSurfaceKind kinds[] = { WR_SURFACE_sphere, WR_SURFACE_plane, WR_SURFACE_torus };
    WrField *flat = wr_field_new(40, 24, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.3f, err);
    bool good = flat != NULL;
    for (int k = 0; k < 3 * 4 && good; k++) {
        WrScene *scene = wr_scene_new();
        WrFrameRequest request = {
            .field = flat, .scene = scene, .width = 40, .height = 40, .full = true
        };
        WrHardShot point = { .renderer = NULL }, moments = { .renderer = NULL };
        scene->shape = wr_hard_shape(kinds[k / 4]);
        scene->material.specular = 1.0;
        good = wr_hard_shoot(g, &request, &point, err);
        scene->dials.aa = WR_AA_MOMENTS;
        scene->dials.moments = k % 2 ? WR_MOMENTS_LEAN : WR_MOMENTS_TOKSVIG;
        scene->dials.footprint = k / 2 % 2 ? WR_FOOTPRINT_ANISOTROPIC : WR_FOOTPRINT_ISOTROPIC;
        good = good && wr_hard_shoot(g, &request, &moments, err);
        for (int i = 0; i < 40 * 40 * 4 && good; i++)
            wr_hard_near(g, WR_HARD_FLOAT, (double)moments.frame.rgba[i],
                         (double)point.frame.rgba[i]);
        wr_hard_put_away(&point);
        wr_hard_put_away(&moments);
        wr_scene_free(scene);
    }
    wr_field_free(flat);
    return good;
}

static bool hc95(WrHardGauge *g, WrError *err)
{
    static const int sizes[][2] = { { 1, 1 }, { 1, 41 }, { 41, 1 },   { 257, 3 },
                                    { 0, 0 }, { 0, 5 },  { -1, 5 },   { 16385, 1 },
                                    { 5, 0 }, { 5, -1 }, { 1, 16385 } };
    WrField *field = wr_hard_waves(16, 16);
    WrScene *scene = wr_scene_new();
    scene->shape = wr_hard_shape(WR_SURFACE_sphere);
    WrRenderer *renderer = wr_renderer_new(g->pool, g->isa, err);
    for (int k = 0; k < 11 && renderer; k++) {
        WrFrame frame;
        WrError why = { "" };
        WrFrameRequest request = {
            .field = field, .scene = scene, .width = sizes[k][0], .height = sizes[k][1]
        };
        const bool made = wr_renderer_frame(renderer, &request, &frame, &why);
        wr_hard_holds(g, WR_HARD_FLOAT, k < 4 ? made && frame.covered > 0 : !made && why.text[0]);
        WrReference reference = { 0 };
        why.text[0] = '\0';
        const bool referred = wr_hard_refer(g, &request, 1, &reference, &why);
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      k < 4 ? referred && wr_hard_wild_reference(&reference) == 0
                            : !referred && why.text[0]);
        wr_reference_fini(&reference);
    }
    const bool good = renderer != NULL;
    wr_renderer_free(renderer);
    wr_scene_free(scene);
    wr_field_free(field);
    return good;
}

static bool hc96(WrHardGauge *g, WrError *err)
{
    (void)err;
    float rgba[] = { NAN, 0.5f, 0, 1, INFINITY, 1, 2, 1, -1, 0.25f, -INFINITY, 1 };
    const WrFrame frame = { .width = 3, .height = 1, .rgba = rgba };
    const WrFrameCodes black = { 0 };
    uint8_t out[9], codes[12];
    const int64_t wild = wr_frame_to_srgb8(&frame, &black, false, out, g->pool);
    wr_hard_holds(g, WR_HARD_FLOAT, wild == 3);
    wr_hard_holds(g, WR_HARD_FLOAT, out[0] == 0 && out[3] == 0 && out[8] == 0);
    wr_hard_holds(g, WR_HARD_FLOAT, out[4] == 255 && out[5] == 255 && out[6] == 0);
    wr_hard_holds(g, WR_HARD_FLOAT, wr_image_codes(WR_PIXEL_U8, rgba, 12, codes, NULL) == 3);
    wr_hard_holds(g, WR_HARD_FLOAT, codes[0] == 0 && codes[4] == 0 && codes[10] == 0);
    wr_hard_holds(g, WR_HARD_FLOAT, codes[5] == 255 && codes[8] == 0);
    float out32[12]; /* files of floats */
    wr_hard_holds(g, WR_HARD_FLOAT, wr_image_codes(WR_PIXEL_F32, rgba, 12, out32, NULL) == 3);
    for (int k = 0; k < 12; k++)
        wr_hard_holds(g, WR_HARD_FLOAT, out32[k] == (isfinite(rgba[k]) ? rgba[k] : 0.0f));
    return true;
}

#define ROW(number, situation, rule, u, in_float, in_double, script)                               \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_RENDER, .what = situation, .holds = rule,           \
        .unit = u, .bound = { in_float, in_double }, .measure = hc##number, .scene = script        \
    }
#define WAVES "table 64x64\nformula fourier terms=3,0,0.5;0,5,0.25,90,0\n"
static const WrHardCase rows[] = {
    ROW(89, "shininess from 0 to a million, directions at random",
        "the highlight is within 0..1 and as right as its directions", "last places * sqrt(s)", 4,
        4, WAVES "surface sphere\nbump height=0.02\nmaterial specular=1 shininess=100000"),
    ROW(90, "n'.h some last places above 1", "the highlight is at most 1", "intensity", 0, 0, NULL),
    ROW(91, "a light exactly behind, and none at all", "no highlight", "intensity", 0, 0,
        WAVES "surface plane\nbump height=0.02\nmaterial specular=1 gate=off\n"
              "light directional to=0,0,-1"),
    ROW(92, "the mean of k x k equal samples",
        "that sample to the bit where k is a power of two, else k^2 - 1 last places off",
        "of what is allowed", 1, 1,
        "table 8x8\nsurface plane\ncamera orthographic eye=0,0,3 target=0,0,0 up=0,1,0 size=0.5\n"
        "dials aa=supersample samples=3"),
    { .id = "HC93",
      .subject = WR_HARD_RENDER,
      .what = "a covariance of slopes that rounding made negative",
      .holds = "it counts as one that slopes can have; the highlight stays within 0..1",
      .unit = "violations",
      .bound = { 0, NAN },
      .measure = hc93,
      .scene = "table 64x64\nformula fourier terms=1,0,0.5\nsurface plane\nrotate -80,0,0\n"
               "bump height=0.05\ndials aa=moments moments=lean" },
    { .id = "HC94",
      .subject = WR_HARD_RENDER,
      .what = "a level table under the moments of slopes",
      .holds = "the picture is that of one sample a pixel",
      .unit = "intensity",
      .bound = { 1e-6, NAN },
      .measure = hc94,
      .scene = "table 64x64\nfill 0.3\nsurface sphere\ndials aa=moments" },
    ROW(95, "pictures of one pixel, one row, and none", "they are made; none is refused",
        "violations", 0, 0, NULL),
    ROW(96, "NaN and infinity in a picture for a file", "they become 0 and are counted",
        "violations", 0, NAN, NULL),
};
WR_HARD_LIST(light, rows);
