/* Hard cases of highlights, of means over samples, and of pictures. */
#include "base/error.h"
#include "base/kernmath.h"
#include "base/memory.h"
#include "base/vec.h"
#include "field/field.h"
#include "field/horizon.h"
#include "hardcases/hardcases_internal.h"
#include "image/image.h"
#include "render/environment/env_setup.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "shade/environment_blur.h"
#include "shade/reflection_models.h"
#include "surface/triangles.h"

#include <string.h>

/* ---- Hard cases of shadows between objects ---- */

#define SIDE 16

static WrScene *alone(const char *surface)
{
    WrScene *scene = wr_scene_new();
    WrShape shape;
    wr_shape_default((WrSurfaceKind)wr_surface_find(surface), &shape);
    wr_scene_set_shape(scene, &shape);
    scene->bump = WR_BUMP_NONE;
    scene->material.specular = 0;
    return scene;
}

/* Number of pixels of a convex body that change if its own shadow is computed although the plan leaves it out. */
static bool changes(WrHardMeasurement *g, WrScene *scene, WrHardPrecision precision, WrError *err)
{
    WrForce force[WR_EFFECT_COUNT] = { WR_FORCE_NONE };
    WrHardShot with, without;
    WrField *field = wr_field_new(4, 3, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, err);
    WrFrameRequest request = { .field = field, .scene = scene, .width = 41, .height = 37 };
    force[WR_EFFECT_CAST] = WR_FORCE_ON;
    scene->lights[0].shadow = false;
    bool good = field && wr_hard_shoot(g, &request, &without, err);
    scene->lights[0].shadow = true;
    request.force = force;
    if (good && wr_hard_shoot(g, &request, &with, err)) {
        wr_hard_record_error(g, precision, (double)wr_hard_differ(&with, &without, 0));
        wr_hard_put_away(&with);
        wr_hard_put_away(&without);
    } else {
        good = false;
    }
    wr_field_free(field);
    return good;
}

static bool hc190(WrHardMeasurement *g, WrError *err)
{
    static const char *const surfaces[] = { "sphere", "capsule", "cube", "plane" };
    bool good = true;
    for (int i = 0; i < 12 && good; i++) {
        if (i % 4 == 1 && i != 5) continue; /* facets are slow */
        WrScene *scene = alone(surfaces[i % 4]);
        scene->size = i / 4 == 0 ? 1e-4 : i / 4 == 1 ? 0.87 : 3e4;
        scene->posed = true;
        scene->rotate_deg = (WrVec3){ wr_hard_between(g, -180, 180), 10, 20 };
        scene->lights[0].where = (WrVec3){ wr_hard_between(g, -1, 1), 0.3, 0.15 };
        if (i == 5) scene->sizes = (WrVec3){ 1, 0.4, 2.3 };
        if (i % 3 == 0) scene->dials.shading = WR_SHADING_DOUBLE;
        good = changes(g, scene, i % 3 == 0 ? WR_HARD_DOUBLE : WR_HARD_FLOAT, err);
        wr_scene_free(scene);
    }
    return good;
}

/* A square of two triangles above the ground, with the camera between: rays to a lamp straight above pass
   through the common edge, and through the corners. */
static WrScene *roofed(WrHardMeasurement *g, double shift)
{
    WrScene *ground = alone("plane");
    ground->shape.value[0] = ground->shape.value[1] = 4;
    ground->posed = true;
    ground->camera.fit = false, ground->camera.orthographic = true;
    ground->camera.eye = (WrVec3){ 0, 0, 0.3 }, ground->camera.target = (WrVec3){ 0, 0, 0 };
    /* pixel centres are at multiples of 1/16, except for the shift */
    ground->camera.size = 1 - 1.0 / SIDE;
    ground->lights[0].where = (WrVec3){ 0, 0, 1 };
    ground->lights[0].shadow = true;
    ground->material.ambient = 0;
    WrScene *both = wr_scene_add_object(ground, false);
    wr_scene_set_triangles(both, wr_triangles_square(), NULL, NULL);
    both->posed = true;
    both->at = (WrVec3){ shift, shift, wr_hard_between(g, 0.5, 2) };
    wr_scene_free(ground);
    return both;
}

static bool hc191(WrHardMeasurement *g, WrError *err)
{
    bool good = true;
    for (int i = 0; i < 6 && good; i++) {
        WrScene *scene = roofed(g, i < 3 ? 0 : wr_hard_between(g, -1e-3, 1e-3));
        WrField *field = wr_field_new(4, 3, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, err);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = SIDE - 1, .height = SIDE - 1
        };
        WrHardShot shot;
        good = field && wr_hard_shoot_by(g, &request, (WrHardWay)(i % 3), &shot, err);
        for (int k = 0; good && k < (SIDE - 1) * (SIDE - 1); k++) {
            const WrHardPrecision precision =
                i % 3 == WR_HARD_WIDE ? WR_HARD_DOUBLE : WR_HARD_FLOAT;
            wr_hard_holds(g, precision, shot.frame.rgba[4 * k + 3] == 1);
            wr_hard_holds(g, precision, shot.frame.rgba[4 * k] == 0);
        }
        if (good) wr_hard_put_away(&shot);
        wr_field_free(field);
        wr_scene_free(scene);
    }
    return good;
}

static const WrHardCase rows[] = {
    { .id = "HC190",
      .subject = WR_HARD_RENDER,
      .what = "lamps along convex bodies of any size, in closed form and of facets",
      .holds =
          "they cast no shadow on themselves: the picture equals that without shadows, to the bit",
      .unit = "values",
      .bound = { 0, 0 },
      .measure = hc190,
      .scene = "surface capsule\nlight directional to=1,0.3,0.02 shadow=on" },
    { .id = "HC191",
      .subject = WR_HARD_RENDER,
      .what = "a lamp whose rays go along the edge that two triangles share",
      .holds = "no light between them",
      .unit = "violations",
      .bound = { 0, 0 },
      .measure = hc191,
      .scene = "surface plane\nlight directional to=0,0,1 shadow=on" },
};
WR_HARD_LIST(cast, rows);

/* ---- Hard cases of self-shadowing by the relief ---- */

#define SIDE_HORIZON 30

/* The horizon by comparing each texel of a period along an axis: directions 0 and 2 along i, 1 and 3 along j. */
static double looked_at(const WrField *field, int i, int j, int direction)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    const int n = direction % 2 ? h : w, sign = direction < 2 ? 1 : n - 1;
    const double from = (double)wr_field_get(field, i, j);
    double best = 0;
    for (int t = 1; t <= n; t++) {
        const int go = t * sign, x = direction % 2 ? i : (i + go) % w;
        const int y = direction % 2 ? (j + go) % h : j;
        best = fmax(best, ((double)wr_field_get(field, x, y) - from) / t);
    }
    return best;
}

/* A table of w x h texels: flat, a ramp that falls at its seam, or rough. */
static bool table_of(WrHardMeasurement *g, int w, int h, int kind, WrError *err)
{
    WrField *field = wr_hard_random_table(g, w, h, WR_WRAP_PERIODIC);
    WrHorizon made = { 0 };
    for (int k = 0; k < w * h && kind < 2; k++)
        wr_field_set(field, k % w, k / w, kind ? 0.37f * (float)(k % w) : -2.7f);
    const bool good = wr_horizon_make(&made, field, 4, 1, g->pool, err);
    for (int k = 0; k < 4 * w * h && good; k++)
        wr_hard_near(g, WR_HARD_FLOAT, (double)wr_horizon_at(&made, k / 4 % w, k / 4 / w, k % 4),
                     looked_at(field, k / 4 % w, k / 4 / w, k % 4));
    wr_horizon_drop(&made);
    wr_field_free(field);
    return good;
}

static void line_of(WrHardMeasurement *g, int n, int kind)
{
    double heights[SIDE_HORIZON] = { 0 }, slope[SIDE_HORIZON];
    int hull[2 * SIDE_HORIZON];
    for (int i = 0; i < n; i++)
        heights[i] = kind == 0 ? -2.7 : kind == 1 ? 0.37 * i : wr_hard_between(g, -1, 1);
    wr_horizon_line(heights, n, slope, hull);
    for (int i = 0; i < n; i++) {
        double best = 0;
        for (int t = 1; t <= n; t++) best = fmax(best, (heights[(i + t) % n] - heights[i]) / t);
        wr_hard_near(g, WR_HARD_DOUBLE, slope[i], best);
    }
}

static bool hc122(WrHardMeasurement *g, WrError *err)
{
    const int sizes[][2] = { { 1, 1 }, { 2, 1 }, { 1, 2 }, { 2, 2 }, { 3, 17 }, { 29, 2 } };
    bool good = true;
    for (int k = 0; k < 18 && good; k++) {
        const int *size = sizes[k / 3];
        good = table_of(g, size[0], size[1], k % 3, err);
    }
    for (int n = 1; n <= SIDE_HORIZON; n++)
        for (int kind = 0; kind < 3; kind++) line_of(g, n, kind);
    return good;
}

/* A lamp in the plane of flat ground, below it, and straight above any ground. */
static bool hc123(WrHardMeasurement *g, WrError *err)
{
    const double quarter = atan2(1, 0);
    (void)err;
    wr_hard_holds(g, WR_HARD_DOUBLE, wr_horizon_lamp(0, 0, 0) == 1);
    for (int k = 0; k < 200; k++) {
        const double a = k % 2 ? wr_hard_between(g, 0, 0.2) : 0, slope = exp(k);
        const double below = wr_hard_between(g, -quarter, -0.21);
        wr_hard_holds(g, WR_HARD_DOUBLE, wr_horizon_lamp(0, atan(slope), a) == 0);
        wr_hard_holds(g, WR_HARD_DOUBLE, wr_horizon_lamp(below, 0, a) == 0);
        wr_hard_holds(g, WR_HARD_DOUBLE, wr_horizon_lamp(quarter, 0, a) == 1);
        wr_hard_holds(g, WR_HARD_DOUBLE, wr_horizon_lamp(quarter, atan(slope), 0) == 1);
        wr_hard_holds(g, WR_HARD_DOUBLE, fabs(wr_horizon_lamp(below, below, a) - 0.5) <= 0.5);
    }
    return true;
}

#define ROW(number, situation, rule, u, in_float, in_double, script)                               \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_TABLE, .what = situation, .holds = rule, .unit = u, \
        .bound = { in_float, in_double }, .measure = hc##number, .scene = script                   \
    }
static const WrHardCase rows_horizon[] = {
    ROW(122, "horizons of 1 and 2 texels, of level ground, of a ramp over the seam",
        "0 where nothing is higher; else the result of a search of every texel", "slope", 1e-7,
        1e-12, NULL),
    ROW(123, "a lamp at an elevation of 0, below 0, and of 90 degrees",
        "level ground is lit, dark, lit; any ground dark, dark, lit", "violations", NAN, 0, NULL),
};
WR_HARD_LIST(horizon, rows_horizon);

/* ---- Hard cases of reflection models ---- */

/* One lamp of strength 1 on one point. */
typedef struct Place {
    WrVec3 n, l, v;
} Place;

static const WrReflectance ordinary = { WR_REFLECT_GGX, WR_ENERGY_KEPT, 20, 0.5, 0.3, 1.5 };

/* Reflected light by the kernels. */
static double in_float(WrHardMeasurement *g, int set, const WrReflectance *of, Place at)
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

static double in_double(WrHardMeasurement *g, int set, const WrReflectance *of, Place at)
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

/* Models with loops of their own, in the order of the table; returns how many. */
static int models_with_loops(WrReflect models[static WR_REFLECT_COUNT])
{
    int count = 0;
    for (int i = 0; i < WR_REFLECT_COUNT; i++)
        if (wr_reflects[i].loops != WR_REFLECT_LOOPS_STAGES) models[count++] = (WrReflect)i;
    return count;
}

/* Checks that it is 0 or more, and at most `most`, for every set and every model with loops of its own. */
static void within(WrHardMeasurement *g, const WrReflectance *numbers, Place at, double most)
{
    WrReflect models[WR_REFLECT_COUNT];
    const int count = models_with_loops(models);
    for (int k = 0; k < 2 * count; k++) {
        WrReflectance of = *numbers;
        of.model = models[k / 2], of.energy = (WrEnergy)(k % 2);
        for (int set = 0; set < g->all; set++) {
            const double got = in_float(g, set, &of, at);
            wr_hard_holds(g, WR_HARD_FLOAT, got >= 0 && got <= most);
        }
        const double got = in_double(g, k & 1, &of, at);
        wr_hard_holds(g, WR_HARD_DOUBLE, got >= 0 && got <= most);
    }
}

static WrVec3 random_unit(WrHardMeasurement *g, double low)
{
    const WrVec3 a = { wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1),
                       wr_hard_between(g, low, 1) };
    return v3_unit(a, (WrVec3){ 0, 0, 1 });
}

static const WrVec3 up = { 0, 0, 1 };

static bool hc97(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 40; i++) {
        const WrVec3 l = random_unit(g, 0.05), v = v3_scale(l, -1);
        within(g, &ordinary, (Place){ up, l, v }, 1);
    }
    return true;
}

static bool hc98(WrHardMeasurement *g, WrError *err)
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

static bool hc99(WrHardMeasurement *g, WrError *err)
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
            wr_hard_record_error(g, WR_HARD_FLOAT,
                                 alpha * fabs(in_float(g, set, &of, f) - exact) / peak);
        wr_hard_record_error(g, WR_HARD_DOUBLE,
                             alpha * fabs(in_double(g, i & 1, &of, at) - narrow(at, alpha)) / peak);
    }
    return true;
}

static bool hc100(WrHardMeasurement *g, WrError *err)
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
    /* the smoothest metal shows a lamp straight above at its peak, about 1 / (8 alpha^2) */
    for (int energy = 0; energy < 2; energy++) {
        const WrReflectance of = { WR_REFLECT_GGX, (WrEnergy)energy, 0, 0, 1, 1.5 };
        const Place at = { up, up, up };
        for (int set = 0; set < g->all; set++)
            wr_hard_holds(g, WR_HARD_FLOAT, in_float(g, set, &of, at) > 1e4);
        wr_hard_holds(g, WR_HARD_DOUBLE, in_double(g, energy, &of, at) > 1e4);
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
static double share(WrHardMeasurement *g, int set, bool wide, double ior, Place at)
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

static bool hc102(WrHardMeasurement *g, WrError *err)
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

static bool hc104(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    WrReflect models[WR_REFLECT_COUNT];
    const int count = models_with_loops(models);
    for (int i = 0; i < 30 * count; i++) {
        WrReflectance of = ordinary;
        of.model = models[i % count], of.roughness = wr_hard_between(g, 0.2, 1);
        const Place at = { up, random_unit(g, 0.1), random_unit(g, 0.1) };
        const Place back = { up, at.v, at.l };
        for (int set = 0; set < g->all; set++) {
            const double a = in_float(g, set, &of, at) / at.l.z;
            wr_hard_record_error(g, WR_HARD_FLOAT,
                                 fabs(in_float(g, set, &of, back) / at.v.z - a) / (1 + a));
        }
        const double a = in_double(g, i / count % 2, &of, at) / at.l.z;
        wr_hard_record_error(g, WR_HARD_DOUBLE,
                             fabs(in_double(g, i / count % 2, &of, back) / at.v.z - a) / (1 + a));
    }
    return true;
}

/* n.v from just above 0 to below by steps of 1e-4. */
static bool hc105(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    WrReflect models[WR_REFLECT_COUNT];
    const int count = models_with_loops(models);
    for (int i = 0; i < count * 80; i++) {
        WrReflectance of = ordinary;
        of.model = models[i % count];
        const double a = 2e-3 - 1e-4 * (i / count / 2), b = a - 1e-4;
        /* beside the viewer, and opposite, where the highlight is bright */
        const WrVec3 l =
            i / count % 2 ? (WrVec3){ -0.768, 0.224, 0.6 } : (WrVec3){ 0.6, 0.64, 0.48 };
        const Place first = { up, l, { sqrt(1 - a * a), 0, a } };
        const Place next = { up, l, { sqrt(1 - b * b), 0, b } };
        for (int set = 0; set < g->all; set++)
            wr_hard_near(g, WR_HARD_FLOAT, in_float(g, set, &of, next),
                         in_float(g, set, &of, first));
        wr_hard_near(g, WR_HARD_DOUBLE, in_double(g, 0, &of, next), in_double(g, 0, &of, first));
    }
    return true;
}

static bool hc107(WrHardMeasurement *g, WrError *err)
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

static bool hc108(WrHardMeasurement *g, WrError *err)
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
static bool of_metal(WrHardMeasurement *g, double metal, double colour, bool in_double,
                     WrHardShot *shot, WrError *err)
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

static bool hc110(WrHardMeasurement *g, WrError *err)
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

#define ROW_REFLECT(number, situation, rule, u, float_bound, double_bound, material)               \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_RENDER, .what = situation, .holds = rule,           \
        .unit = u, .bound = { float_bound, double_bound }, .measure = hc##number,                  \
        .scene = "table 64x64\nformula fourier terms=3,0,0.5;0,5,0.25,90,0\nsurface sphere\n"      \
                 "bump height=0.02\nmaterial " material                                            \
    }
static const WrHardCase rows_reflect[] = {
    ROW_REFLECT(97, "light from exactly behind, by every model", "no highlight: within 0..1",
                "violations", 0, 0, "model=ggx\nlight directional to=0,0,-1"),
    ROW_REFLECT(98, "lamp and eye along the surface, down to 1e-30 above it",
                "finite and not below 0", "violations", 0, 0, "model=torrance-sparrow"),
    ROW_REFLECT(99, "the narrowest highlights", "as right as the directions",
                "of the peak, by width", 1e-6, 1e-14, "model=ggx roughness=0 specular=1"),
    ROW_REFLECT(100, "roughness, metalness, index, exponent: none, infinite, out of range",
                "clamped to their ranges: finite", "violations", 0, 0, "model=ggx roughness=1"),
    ROW_REFLECT(102, "Fresnel's reflectance at any angle, and beyond the critical one",
                "as the formula with angles has it, and 1", "of 1", 1e-4, 1e-9,
                "model=torrance-sparrow ior=1.01 specular=100"),
    ROW_REFLECT(104, "lamp and eye exchanged", "the same reflection", "relative", 2e-5, 1e-12,
                "model=torrance-sparrow"),
    ROW_REFLECT(105, "n' rotated past the viewer in steps of 1e-4", "no jump", "intensity", 2e-2,
                2e-2, "model=ggx\nbump height=0.2"),
    ROW_REFLECT(107, "lamp or eye along n'", "finite, at most the reflected light", "violations", 0,
                0, "model=oren-nayar roughness=1"),
    ROW_REFLECT(108, "Oren and Nayar's facets of roughness 0", "Lambert's law", "intensity", 1e-6,
                1e-7, "model=oren-nayar roughness=0"),
    ROW_REFLECT(110, "metal, half or whole, of a colour above 1",
                "clamped to 1: no more light than arrives", "violations", 0, 0,
                "model=ggx metalness=0.5 colour=3,2,1"),
};
WR_HARD_LIST(reflect, rows_reflect);

/* ---- Hard cases of environments ---- */

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
    WrEnvironmentMapChanges replaced;
    WrImage *image = wr_image_new(w, h, 1, err);
    if (!image) return NULL;
    image->type = WR_PIXEL_F32;
    for (int i = 0; i < w * h; i++)
        image->data[i] =
            (float)sky(wr_environment_map_direction((i % w + 0.5) / w, 1 - (i / w + 0.5) / h));
    WrEnvironmentMap *made = wr_environment_map_new(image, &replaced, err);
    wr_image_free(image);
    return made;
}

/* Mirror reflection in direction d by the kernels. */
static double mirrored(WrHardMeasurement *g, int set, const WrEnvLookup *m, WrVec3 d)
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
static double lit(WrHardMeasurement *g, int set, const WrEnvironmentMap *from, WrVec3 n)
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

static WrVec3 random_direction(WrHardMeasurement *g)
{
    const WrVec3 a = { wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1),
                       wr_hard_between(g, -1, 1) };
    return v3_unit(a, (WrVec3){ 0, 0, 1 });
}

/* Equal results from both sides of a point where longitudes jump. */
static void look_twice(WrHardMeasurement *g, const WrEnvironmentMap *from, const WrEnvLookup *m,
                       WrVec3 a, WrVec3 b)
{
    double x[3], y[3];
    wr_environment_map_at(from, a, x);
    wr_environment_map_at(from, b, y);
    wr_hard_near(g, WR_HARD_DOUBLE, x[1], y[1]);
    for (int set = 0; set < g->all; set++)
        wr_hard_near(g, WR_HARD_FLOAT, mirrored(g, set, m, a), mirrored(g, set, m, b));
}

static bool hc111(WrHardMeasurement *g, WrError *err)
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

static bool hc112(WrHardMeasurement *g, WrError *err)
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
            const WrVec3 d = i ? random_direction(g) : (WrVec3){ 0, 1, 0 };
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

static bool hc113(WrHardMeasurement *g, WrError *err)
{
    WrEnvironmentMap *from = around(512, 256, sun, err);
    if (!from) return false;
    const double all = 2 * sqrt(3.14159265358979323846) * from->harmonic[0][0];
    double form[3][WR_FORM_TERMS];
    wr_environment_map_form(from, straight, 1, 2, form);
    for (int i = 0; i < 200; i++) {
        const WrVec3 n = random_direction(g);
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

static bool hc114(WrHardMeasurement *g, WrError *err)
{
    static const float strange[] = { NAN, -NAN, INFINITY, -INFINITY, 3e38f, -1, -0.0f, 0.5f };
    WrEnvironmentMapChanges replaced;
    WrImage *image = wr_image_new(8, 4, 3, err);
    if (!image) return false;
    image->type = WR_PIXEL_F32;
    for (int i = 0; i < 8 * 4 * 3; i++) image->data[i] = strange[i * 5 / 3 % 8];
    WrEnvLookup m = { 0 };
    const WrEnvironmentBrdf wide = { .lobe = WR_LOBE_FACETS, .alpha = 0.3, .gated = true };
    WrEnvironmentMap *from = wr_environment_map_new(image, &replaced, err);
    wr_image_free(image);
    const bool good = from && wr_env_lookup_update(&m, from, &wide, 16, g->pool, err);
    for (int i = 0; i < 40 && good; i++) {
        const WrVec3 d = random_direction(g);
        double at[3];
        wr_environment_map_at(from, d, at);
        wr_hard_holds(g, WR_HARD_DOUBLE, at[2] >= 0 && at[2] <= 1.001e9);
        for (int set = 0; set < g->all; set++) {
            const double mirror = mirrored(g, set, &m, d), diffuse = lit(g, set, from, d);
            wr_hard_holds(g, WR_HARD_FLOAT, mirror >= 0 && mirror <= 1.01e9);
            wr_hard_holds(g, WR_HARD_FLOAT, diffuse >= 0 && diffuse <= 1.01e9);
        }
    }
    if (good)
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      replaced.not_numbers > 0 && replaced.negative > 0 && replaced.too_large > 0);
    wr_env_lookup_drop(&m);
    wr_environment_map_free(from);
    return good;
}

static bool hc115(WrHardMeasurement *g, WrError *err)
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
                const WrVec3 d = random_direction(g);
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

static bool hc101(WrHardMeasurement *g, WrError *err)
{
    const double near[] = { 1, 1 - 1e-12, 1 - 1e-6, 0.9991 };
    const double flat[] = { 1, 2.0 / 3, 1.0 / 4, 0, -1.0 / 24 }; /* coefficients of max(0, c) */
    double order[5];
    for (int i = 0; i < 4; i++) {
        const WrEnvironmentBrdf gloss = facets_of(near[i]);
        wr_blur_orders(&gloss, 5, order);
        for (int l = 0; l < 5; l++) /* the slope at 1 is below 1 */
            wr_hard_record_error(g, WR_HARD_DOUBLE,
                                 fmax(0, fabs(order[l] - flat[l]) - (1 - near[i])));
    }
    for (int i = 0; i < 20; i++) {
        const double alpha = wr_hard_between(g, 0.2, 0.97), mu = wr_hard_between(g, 0.02, 1);
        const WrEnvironmentBrdf gloss = facets_of(alpha);
        double e[2];
        wr_blur_orders(&gloss, 2, order);
        wr_hard_record_error(g, WR_HARD_DOUBLE, fabs(order[1] - slope_kept(alpha)));
        wr_ggx_albedo(1, mu, e);
        wr_hard_record_error(g, WR_HARD_FLOAT, fabs(e[0] + e[1] - (1 - mu * log(1 + 1 / mu))));
    }
    WrEnvironmentMap *from = around(64, 32, linear, err);
    WrEnvLookup m = { 0 };
    const WrEnvironmentBrdf gloss = facets_of(1);
    bool good = from && wr_env_lookup_update(&m, from, &gloss, 16, g->pool, err);
    for (int i = 0; i < 20 && good; i++)
        for (int set = 0; set < g->all; set++) {
            const WrVec3 d = random_direction(g);
            const double want = 1 + 0.9 * 2 / 3 * v3_dot(d, east);
            wr_hard_record_error(g, WR_HARD_FLOAT, fabs(mirrored(g, set, &m, d) - want));
        }
    wr_env_lookup_drop(&m);
    wr_environment_map_free(from);
    return good;
}

static bool hc116(WrHardMeasurement *g, WrError *err)
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

#define ROW_SURROUND(number, situation, rule, u, float_bound, double_bound, material)              \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_RENDER, .what = situation, .holds = rule,           \
        .unit = u, .bound = { float_bound, double_bound }, .measure = hc##number,                  \
        .scene = "table 64x64\nformula fourier terms=3,0,0.5;0,5,0.25,90,0\nsurface sphere\n"      \
                 "bump height=0.02\nlight clear\nmaterial " material                               \
    }
static const WrHardCase rows_surround[] = {
    ROW_SURROUND(
        101,
        "facets of width 1, and almost 1: the fraction of a linear sky that their lobe keeps, "
        "their albedo",
        "that of a matt lobe; 1 - mu ln(1 + 1/mu)", "of the light", 2.5e-3, 1e-6,
        "model=ggx roughness=1 specular=1\nenvironment sky"),
    ROW_SURROUND(111, "an environment looked up straight up and down, and at the longitude seam",
                 "the same from all sides", "of a texel", 1e-4, 1e-6,
                 "model=ggx roughness=0\nenvironment sky"),
    ROW_SURROUND(112, "environments of 1 texel, and of odd widths",
                 "looked up, within their texels", "violations", 0, 0,
                 "model=ggx roughness=0.3\nenvironment raking"),
    ROW_SURROUND(113, "a sun of a few texels, 1e5 as bright as the sky",
                 "diffuse light is not below 0, and within 3/32 of all", "violations", 0, 0,
                 "model=ggx\nenvironment sky strength=100"),
    ROW_SURROUND(114, "an environment with infinities, NaN, and values below 0",
                 "used as light or as 0, and counted", "violations", 0, 0,
                 "model=ggx\nenvironment studio strength=1000000"),
    ROW_SURROUND(115, "an environment of one colour, blurred and diffuse", "that colour",
                 "of the light", 2e-6, 1e-14, "diffuse=1\nenvironment studio"),
    ROW_SURROUND(116, "an environment rotated by additional full turns", "the same",
                 "of a direction", 0, 0, "model=ggx\nenvironment studio turn=720"),
};
WR_HARD_LIST(surround, rows_surround);

/* The highlight of n', l, v by the kernels. */
static double highlight(WrHardMeasurement *g, int set, WrVec3f perturbed, WrVec3f light,
                        WrVec3f view, double shininess, bool gate)
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
static double highlight_wide(WrHardMeasurement *g, int set, const WrHardLit *lit)
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
static WrVec3 random_up(WrHardMeasurement *g)
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
static bool generic_highlight(WrHardMeasurement *g, double s, WrError *err)
{
    const WrVec3 l = random_up(g), v = random_up(g), h = v3_unit(v3_add(l, v), l);
    const double wide = wr_hard_between(g, 0, 2.5) / sqrt(1.0 + s);
    const WrVec3 aside = v3_unit(v3_cross(h, random_up(g)), h);
    const WrVec3 n = v3_unit(v3_mad(h, aside, wide), h);
    const WrVec3f nf = v3f_from(n), lf = v3f_from(l), vf = v3f_from(v);
    const double want = lobe_of(wr_hard_vec(nf), wr_hard_vec(lf), wr_hard_vec(vf), s);
    for (int set = 0; set < g->all; set++)
        wr_hard_record_error(g, WR_HARD_FLOAT,
                             steps(highlight(g, set, nf, lf, vf, s, false), want, s, 0x1p-23));
    const WrHardLit lit = { .perturbed = n, .light = l, .view = v, .specular = 1, .shininess = s };
    for (int set = 0; set < 2; set++)
        wr_hard_record_error(g, WR_HARD_DOUBLE,
                             steps(highlight_wide(g, set, &lit), lobe_of(n, l, v, s), s, 0x1p-52));
    if (!(n.z > 0.05)) return true;
    double part[2];
    if (!wr_hard_shine(&lit, part, err)) return false;
    wr_hard_record_error(g, WR_HARD_DOUBLE, steps(part[1], lobe_of(n, l, v, s), s, 0x1p-52));
    return true;
}

/* A dented plane under a light from the eye's position, as pictures: float compared with double. */
static bool shiny_pictures(WrHardMeasurement *g, WrError *err)
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
                wr_hard_record_error(g, WR_HARD_FLOAT,
                                     steps((double)shots[way].frame.rgba[i], want, s, 0x1p-23));
        }
        for (int way = 0; way < WR_HARD_WAYS; way++) wr_hard_put_away(&shots[way]);
        wr_scene_free(scene);
    }
    if (good)
        wr_hard_record_error(g, WR_HARD_FLOAT,
                             lit > 100 ? 0.0 : 1e9); /* otherwise nothing was visible */
    wr_field_free(field);
    return good;
}

/* Random directions for each power; the power itself for floats; and every highlight must be within 0..1. */
static bool hc89(WrHardMeasurement *g, WrError *err)
{
    static const double powers[] = { 0, 1, 0.5, 30, 1000, 1e5, 1e6 };
    for (int k = 0; k < 7 * 300; k++) {
        const double s = powers[k % 7];
        float c = k < 14 ? (k < 7 ? 0.0f : 1.0f) : wr_hard_float(g);
        if (k % 2) c = 1.0f - c * 1e-4f; /* where a high power is not 0 */
        wr_hard_record_error(g, WR_HARD_FLOAT,
                             steps((double)wr_pow01_f(c, (float)s), pow((double)c, s), s, 0x1p-23));
        const WrVec3f z = { 0, 0, 1 };
        const WrVec3f light = { sqrtf(1.0f - c * c), 0, c };
        for (int set = 0; set < g->all; set++) {
            const double shine = highlight(g, set, z, light, z, s, true);
            wr_hard_record_error(g, WR_HARD_FLOAT,
                                 1e9 * (fmax(0.0, shine - 1.0) + fmax(0.0, -shine)));
        }
        if (!generic_highlight(g, s, err)) return false;
    }
    return shiny_pictures(g, err);
}

/* n' and h equal, but longer than 1 by some ulps. */
static bool hc90(WrHardMeasurement *g, WrError *err)
{
    float c = 1.0f;
    for (int k = 0; k < 16; k++) {
        const WrVec3f n = { 0, 0, c };
        wr_hard_record_error(g, WR_HARD_FLOAT, fmax(0.0, (double)wr_pow01_f(c, 1e5f) - 1.0));
        for (int set = 0; set < g->sets; set++)
            wr_hard_record_error(g, WR_HARD_FLOAT,
                                 fmax(0.0, highlight(g, set, n, n, n, 1e5, true) - 1.0));
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
        wr_hard_record_error(g, WR_HARD_DOUBLE, fmax(0.0, part[1] - 1.0));
    }
    return true;
}

/* No half vector: light exactly from behind, or no light at all; with and without the gate. */
static bool hc91(WrHardMeasurement *g, WrError *err)
{
    static const double powers[] = { 0, 1, 30 };
    for (int k = 0; k < 12; k++) {
        const WrVec3f v = { 0.6f, 0, 0.8f }, back = { -0.6f, 0, -0.8f }, none = { 0, 0, 0 };
        for (int set = 0; set < g->sets; set++) {
            wr_hard_record_error(g, WR_HARD_FLOAT,
                                 highlight(g, set, v, back, v, powers[k % 3], k % 2 != 0));
            wr_hard_record_error(g, WR_HARD_FLOAT,
                                 highlight(g, set, v, none, v, powers[k % 3], true));
        }
        const WrHardLit lit = { .perturbed = { 0, 0, 1 },
                                .light = { 0, 0, -1 },
                                .view = { 0, 0, 1 },
                                .specular = 1,
                                .shininess = powers[k % 3],
                                .gate = k % 2 };
        double part[2];
        if (!wr_hard_shine(&lit, part, err)) return false;
        wr_hard_record_error(g, WR_HARD_DOUBLE, part[1]);
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
static bool hc92(WrHardMeasurement *g, WrError *err)
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
            wr_hard_record_error(
                g, WR_HARD_FLOAT,
                mean_off((double)many.frame.rgba[i], (double)point.frame.rgba[i], n, 23));
            if (refers)
                wr_hard_record_error(g, WR_HARD_DOUBLE,
                                     mean_off(refined.rgba[i], single.rgba[i], n, 52));
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
static bool hc93(WrHardMeasurement *g, WrError *err)
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
            wr_hard_bumped_normal_f(g, set, WR_BUMP_BLINN, &at, (WrHardSlope){ 0, 0.1, -0.2 },
                                    false);
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
static bool hc94(WrHardMeasurement *g, WrError *err)
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

static bool hc95(WrHardMeasurement *g, WrError *err)
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

static bool hc96(WrHardMeasurement *g, WrError *err)
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

#define ROW_LIGHT(number, situation, rule, u, in_float, in_double, script)                         \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_RENDER, .what = situation, .holds = rule,           \
        .unit = u, .bound = { in_float, in_double }, .measure = hc##number, .scene = script        \
    }
#define WAVES "table 64x64\nformula fourier terms=3,0,0.5;0,5,0.25,90,0\n"
static const WrHardCase rows_light[] = {
    ROW_LIGHT(89, "shininess from 0 to a million, directions at random",
              "the highlight is within 0..1 and as accurate as its directions",
              "last places * sqrt(s)", 4, 4,
              WAVES "surface sphere\nbump height=0.02\nmaterial specular=1 shininess=100000"),
    ROW_LIGHT(90, "n'.h some last places above 1", "the highlight is at most 1", "intensity", 0, 0,
              NULL),
    ROW_LIGHT(91, "a light exactly behind, and none at all", "no highlight", "intensity", 0, 0,
              WAVES "surface plane\nbump height=0.02\nmaterial specular=1 gate=off\n"
                    "light directional to=0,0,-1"),
    ROW_LIGHT(
        92, "the mean of k x k equal samples",
        "that sample to the bit where k is a power of two, else k^2 - 1 last places off",
        "of the bound", 1, 1,
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
    ROW_LIGHT(95, "pictures of one pixel, one row, and none", "they are rendered; none is refused",
              "violations", 0, 0, NULL),
    ROW_LIGHT(96, "NaN and infinity in a picture for a file", "they become 0 and are counted",
              "violations", 0, NAN, NULL),
};
WR_HARD_LIST(light, rows_light);
