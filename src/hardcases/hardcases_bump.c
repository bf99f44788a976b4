/* Hard cases of the bump formulas: beyond focal distances, extreme slopes, zero vectors. */
#include "base/error.h"
#include "base/exactmath.h"
#include "field/field.h"
#include "field/scheme_list.h"
#include "hardcases/hardcases_internal.h"
#include "hardcases/hardcases_look.h"
#include "image/image.h"
#include "render/frame/frame.h"
#include "render/textures/slope_pyramid.h"
#include "scene/normal_map.h"
#include "scene/scene.h"
#include "shade/bump.h"

#include <float.h>
#include <string.h>

/* ---- hardcases side ---- */

/* Hard cases of perturbed normals that turn away from the eye or the light, or are seen edge on. */

static WrVec3 direction(WrHardMeasurement *g)
{
    for (;;) {
        const WrVec3 a = { wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1),
                           wr_hard_between(g, -1, 1) };
        if (v3_len(a) > 0.1 && v3_len(a) < 1.0) return v3_unit(a, a);
    }
}

/* Diffuse and specular parts by the kernels; ambient 0. */
static void shine(WrHardMeasurement *g, int set, const WrHardLit *lit, double out[2])
{
    const WrKernels *k = g->kernels[set];
    WrStrip *s = g->strip;
    const WrVec3f l = v3f_from(lit->light);
    const WrKernLight light = { .where = { l.x, l.y, l.z }, .rgb = { 1, 1, 1 } };
    s->count = 1;
    s->bx[0] = (float)lit->perturbed.x, s->by[0] = (float)lit->perturbed.y,
    s->bz[0] = (float)lit->perturbed.z;
    s->vx[0] = (float)lit->view.x, s->vy[0] = (float)lit->view.y, s->vz[0] = (float)lit->view.z;
    s->px[0] = s->py[0] = s->pz[0] = 0.0f;
    k->begin(0.0f, s);
    k->light(&light, s);
    k->diffuse(&light, (float)lit->diffuse, s);
    k->specular(&light, (float)lit->specular, (float)lit->shininess, lit->gate, s);
    out[0] = (double)s->dr[0];
    out[1] = (double)s->sr[0];
}

/* True if the reference supports this position: it needs a plane seen from the front, with n not perturbed to
   its edge. */
static bool forwards(const WrHardLit *lit)
{
    return lit->perturbed.z > 0.05 && lit->view.z > 0.05;
}

static bool hc24(WrHardMeasurement *g, WrError *err)
{
    for (int i = 0; i < 2000; i++) {
        const WrHardLit lit = { .perturbed = direction(g),
                                .light = direction(g),
                                .view = direction(g),
                                .diffuse = 1,
                                .specular = 1,
                                .shininess = i % 3 ? 30 : 0.5,
                                .gate = i % 2 };
        for (int set = 0; set < g->sets; set++) {
            double part[2];
            shine(g, set, &lit, part);
            wr_hard_holds(g, WR_HARD_FLOAT, part[0] >= 0.0 && part[0] <= 1.0 + 1e-6);
            wr_hard_holds(g, WR_HARD_FLOAT, part[1] >= 0.0 && part[1] <= 1.0);
        }
        if (i % 4 || !forwards(&lit)) continue;
        double part[2];
        if (!wr_hard_shine(&lit, part, err)) return false;
        wr_hard_holds(g, WR_HARD_DOUBLE, part[0] >= -1e-15 && part[0] <= 1.0 + 1e-15);
        wr_hard_holds(g, WR_HARD_DOUBLE, part[1] >= 0.0 && part[1] <= 1.0);
    }
    return true;
}

/* As in the paper, the surface's own n has no influence: only n'.l counts. */
static bool hc25(WrHardMeasurement *g, WrError *err)
{
    for (int i = 0; i < 2000; i++) {
        const WrHardLit lit = { .perturbed = direction(g),
                                .light = direction(g),
                                .view = direction(g),
                                .diffuse = 1,
                                .specular = 1,
                                .shininess = 30,
                                .gate = true };
        const double facing = v3_dot(lit.perturbed, lit.light);
        for (int set = 0; set < g->sets; set++) {
            double part[2];
            shine(g, set, &lit, part);
            wr_hard_near(g, WR_HARD_FLOAT, part[0], fmax(0.0, facing));
            if (facing < -1e-6) wr_hard_record_error(g, WR_HARD_FLOAT, part[1]);
        }
        if (i % 4 || !forwards(&lit)) continue;
        double part[2];
        if (!wr_hard_shine(&lit, part, err)) return false;
        wr_hard_near(g, WR_HARD_DOUBLE, part[0], fmax(0.0, facing));
        if (facing < -1e-12) wr_hard_record_error(g, WR_HARD_DOUBLE, part[1]);
    }
    return true;
}

/* Across n'.l = 0 the gated highlight may jump by at most ks (n'.h)^s; without the gate it is continuous. */
static bool hc26(WrHardMeasurement *g, WrError *err)
{
    for (int i = 0; i < 400; i++) {
        const double s = i % 2 ? 5 : 200, angle = wr_hard_between(g, 0.2, 1.5);
        for (int gate = 0; gate < 2; gate++) {
            WrHardLit lit = { .perturbed = { 0, 0, 1 },
                              .view = { sin(angle), 0, cos(angle) },
                              .diffuse = 1,
                              .specular = 1,
                              .shininess = s,
                              .gate = gate };
            const WrVec3 half = v3_unit(v3_add((WrVec3){ 1, 0, 0 }, lit.view), lit.perturbed);
            const double allowed = gate ? pow(fmax(0.0, half.z), s) : 0.0;
            for (int set = 0; set < g->sets; set++) {
                double above[2], below[2];
                lit.light = (WrVec3){ 1, 0, (double)FLT_EPSILON };
                shine(g, set, &lit, above);
                lit.light = (WrVec3){ 1, 0, -(double)FLT_EPSILON };
                shine(g, set, &lit, below);
                const double jump = fabs(above[0] + above[1] - below[0] - below[1]);
                wr_hard_record_error(g, WR_HARD_FLOAT, fmax(0.0, jump - allowed));
            }
            double above[2], below[2];
            lit.light = (WrVec3){ 1, 0, DBL_EPSILON };
            if (!wr_hard_shine(&lit, above, err)) return false;
            lit.light = (WrVec3){ 1, 0, -DBL_EPSILON };
            if (!wr_hard_shine(&lit, below, err)) return false;
            const double jump = fabs(above[0] + above[1] - below[0] - below[1]);
            wr_hard_record_error(g, WR_HARD_DOUBLE, fmax(0.0, jump - allowed));
        }
    }
    return true;
}

/* The unit plane seen with n.v = c is c high: rows of samples that it covers in the middle column. */
static bool hc27(WrHardMeasurement *g, WrError *err)
{
    enum { SIZE = 64, K = 4 };
    static const double cosines[] = { 0.3, 0.1, 0.03, 1e-2, 1e-3, 1e-6 };
    WrScene *scene = wr_scene_new();
    WrField *field = wr_hard_waves(64, 64);
    bool good = true;
    scene->posed = true;
    scene->dials.aa = WR_AA_SUPERSAMPLE;
    scene->dials.samples = K;
    for (int i = 0; i < 12 && good; i++) {
        const double c = cosines[i % 6];
        const bool curved = i >= 6; /* the same square by mesh and Newton's method */
        WrShape shape = wr_hard_shape(curved ? WR_SURFACE_bent : WR_SURFACE_plane);
        if (curved) shape.value[2] = shape.value[3] = shape.value[4] = 0.0;
        scene->shape = shape;
        scene->camera = (WrCamera){ .orthographic = true,
                                    .eye = { 0, -5.0 * sqrt(1.0 - c * c), 5.0 * c },
                                    .up = { 0, 0, 1 },
                                    .fov_deg = 30,
                                    .size = 1.25 };
        WrFrameRequest request = { .field = field, .scene = scene, .width = SIZE, .height = SIZE };
        WrHardShot shot;
        good = wr_hard_shoot(g, &request, &shot, err);
        if (!good) break;
        double rows = 0.0;
        for (int y = 0; y < SIZE; y++)
            rows += K * (double)shot.frame.rgba[4 * (y * SIZE + SIZE / 2) + 3];
        wr_hard_near(g, WR_HARD_FLOAT, rows, c / 1.25 * SIZE * K);
        /* a NaN counts as a large deviation */
        wr_hard_record_error(g, WR_HARD_FLOAT, 1e3 * (double)wr_hard_wild(&shot));
        wr_hard_put_away(&shot);
        WrReference reference = { 0 };
        good = wr_hard_refer(g, &request, K, &reference, err);
        rows = 0.0;
        for (int y = 0; y < SIZE && good; y++)
            rows += K * reference.rgba[4 * (y * SIZE + SIZE / 2) + 3];
        if (good) wr_hard_near(g, WR_HARD_DOUBLE, rows, c / 1.25 * SIZE * K);
        wr_reference_fini(&reference);
    }
    wr_field_free(field);
    wr_scene_free(scene);
    return good;
}

#define SIDE(number, situation, rule, u, in_float, in_double, lacks, script)                       \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_GEOMETRY, .what = situation, .holds = rule,         \
        .unit = u, .bound = { in_float, in_double }, .measure = hc##number, .waits = lacks,        \
        .scene = script                                                                            \
    }
#define WAVES "table 64x64\nformula fourier terms=3,0,0.5;0,5,0.25,90,0\n"
static const WrHardCase rows[] = {
    SIDE(24, "a perturbed normal that faces away from the eye",
         "it is not changed; diffuse and highlight stay between 0 and their strength", "violations",
         0, 0, NULL, WAVES "surface plane\nrotate -80,0,0\nbump height=0.2\nmaterial specular=1"),
    SIDE(
        25, "a wrinkle that faces a light behind the surface",
        "it is lit by n'.l only, as in the paper; where that is not above 0, by ambient light only",
        "intensity", 1e-6, 1e-12, "a gate by the unbent normal, with the materials",
        WAVES "surface sphere\nbump height=0.2\nlight directional to=1,0,-0.2"),
    SIDE(26, "n'.l within a last place of 0",
         "the gated highlight jumps by no more than ks (n'.h)^s, the plain sum not at all",
         "intensity", 1e-6, 1e-12, NULL,
         WAVES "surface sphere\nbump height=0.05\nmaterial specular=1 shininess=5\n"
               "light directional to=1,0,0"),
    SIDE(27, "a patch seen edge on, n.v down to 1e-6",
         "no NaN, and its height in the picture is right to one row of samples", "rows", 1, 1, NULL,
         WAVES "surface plane\nrotate -89,0,0\nbump height=0.05"),
};
WR_HARD_LIST(side, rows);

/* ---- hardcases pyramid ---- */

/* Hard cases of filtered tables, seams of closed surfaces, and the spline through the samples. */

/* F of texel (i, j) of a stored level. */
static double pyramid_height(const WrPyramid *pyramid, const WrPyramidLevel *level, int i, int j)
{
    const size_t texel = (size_t)(j + 1) * (size_t)level->pitch + (size_t)(i + 1);
    return (double)level->data[texel * (size_t)pyramid->floats + 2];
}

/* Mean of cos 2 pi u over from..to. */
static double wave_mean(double from, double to)
{
    double s[2], c;
    wr_sincos_turns(from, &s[0], &c);
    wr_sincos_turns(to, &s[1], &c);
    return (s[1] - s[0]) / (2.0 * WR_PI * (to - from));
}

/* Every level's mean compared with the table's, to 1e-6; and its texels compared with the means of one wave
   along u over their own shares. The sampling error of the wave, with partial texels, is at most a third of the
   steepest texel's rise, 2 pi / w; a shift of half a texel along a level would exceed that. */
static void check_levels(WrHardMeasurement *g, const WrPyramid *pyramid, const WrField *field)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    double mean = 0.0;
    for (int k = 0; k < w * h; k++) mean += (double)wr_field_get(field, k % w, k / w);
    mean /= w * h;
    for (int l = 1; l < pyramid->levels; l++) {
        const WrPyramidLevel *level = &pyramid->level[l];
        double sum = 0.0;
        for (int j = 0; j < level->height; j++)
            for (int i = 0; i < level->width; i++) {
                const double f = pyramid_height(pyramid, level, i, j);
                const double want = wave_mean((double)i / level->width, (i + 1.0) / level->width);
                sum += f;
                if (w > 1)
                    wr_hard_record_error(g, WR_HARD_FLOAT,
                                         fabs(f - 1.0 - want) * w / (WR_PI / 1.5));
            }
        wr_hard_record_error(g, WR_HARD_FLOAT,
                             fabs(sum / (level->width * level->height) - mean) / 1e-6);
    }
    const WrPyramidLevel *last = &pyramid->level[pyramid->levels - 1];
    wr_hard_record_error(g, WR_HARD_FLOAT, last->width == 1 && last->height == 1 ? 0.0 : 2.0);
}

static bool hc55(WrHardMeasurement *g, WrError *err)
{
    static const int sizes[][2] = { { 64, 16 }, { 5, 3 },   { 1, 37 },   { 37, 1 },
                                    { 3, 2 },   { 100, 7 }, { 129, 65 }, { 2, 1 } };
    bool good = true;
    for (int k = 0; k < 16 && good; k++) {
        const int w = sizes[k / 2][0], h = sizes[k / 2][1];
        const WrWrap wrap = k % 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC;
        WrField *field = wr_field_new(w, h, wrap, wrap, 0.0f, err);
        WrPyramid pyramid = { 0 };
        if (!field) return false;
        for (int i = 0; i < w * h; i++) {
            double s, c;
            wr_sincos_turns((i % w + 0.5) / w, &s, &c);
            wr_field_set(field, i % w, i / w, (float)(1.0 + c));
        }
        good = wr_pyramid_update(&pyramid, WR_PYRAMID_MOMENTS, field, g->pool, err);
        if (good) check_levels(g, &pyramid, field);
        wr_pyramid_drop(&pyramid);
        wr_field_free(field);
    }
    return good;
}

/* Footprints of rays: along the surface, from beside it, with equal or zero tangents; all must be finite, and at
   most as long as allowed. */
static void check_footprints(WrHardMeasurement *g, const WrLook *look)
{
    static const float lengths[] = { 0, 1e-30f, 1e-3f, 1, 1e18f, INFINITY };
    enum { LENGTHS = sizeof lengths / sizeof *lengths };
    for (int k = 0; k < LENGTHS * LENGTHS * 4 * 3; k++) {
        const float pu = lengths[k % LENGTHS], pv = lengths[k / LENGTHS % LENGTHS];
        const float lean = (float[]){ 0, 1e-20f, 1e-3f, 1 }[k / (LENGTHS * LENGTHS) % 4];
        const float spread = (float[]){ 1e-3f, 1e10f, 3e38f }[k / (LENGTHS * LENGTHS * 4)];
        const WrRays rays = { .q0 = { 0.3f, -5, 0.1f },
                              .d0 = { 0.2f, 1, -lean },
                              .qx = { spread },
                              .qy = { 0, 0, spread },
                              .dx = { 1e-3f },
                              .dy = { 0, 0, 1e-3f } };
        for (int set = 0; set < g->all; set++) {
            WrStrip *s = g->strip;
            s->count = 1;
            s->x[0] = s->y[0] = 0.0f;
            s->px[0] = 0.1f, s->py[0] = 0.2f, s->pz[0] = 0.0f;
            s->nx[0] = s->ny[0] = 0.0f, s->nz[0] = 1.0f;
            s->pux[0] = pu, s->puy[0] = s->puz[0] = 0.0f;
            s->pvx[0] = k % 2 ? pv : 0.0f, s->pvy[0] = k % 2 ? 0.0f : pv, s->pvz[0] = 0.0f;
            g->kernels[set]->footprint(&rays, look, 1.0f, s);
            const float side[] = { s->rx[0], s->ry[0], s->wx[0], s->wy[0] };
            for (int i = 0; i < 4; i++) wr_hard_holds(g, WR_HARD_FLOAT, fabsf(side[i]) <= 1e9f);
        }
    }
}

/* Footprints passed directly to the kernels: level, number of fetches and the fetched values must be in range. */
static bool hc56(WrHardMeasurement *g, WrError *err)
{
    static const float sides[] = { 0, 1e-30f, 0.5f, 1, 1e3f, 1e6f, 1e9f, INFINITY, NAN };
    enum { SIDES = sizeof sides / sizeof *sides };
    WrField *field = wr_hard_random_table(g, 64, 48, WR_WRAP_PERIODIC);
    WrPyramid pyramid = { 0 };
    WrHardLook look;
    bool good = wr_pyramid_update(&pyramid, WR_PYRAMID_MOMENTS, field, g->pool, err);
    if (good) good = wr_hard_look_init(g, &look, field, WR_SCHEME_CENTRAL, 1, 1, err);
    if (good) check_footprints(g, &look.look);
    for (int k = 0; k < SIDES * SIDES * 2 && good; k++)
        for (int set = 0; set < g->sets; set++) {
            WrStrip *s = g->strip;
            look.look.pyramid = &pyramid;
            wr_hard_look_at(g, set, &look, 0.3f, 0.7f);
            s->rx[0] = sides[k % SIDES];
            s->wy[0] = sides[k / SIDES % SIDES];
            s->ry[0] = s->wx[0] = k % 3 ? 0.0f : 1e-3f * s->rx[0];
            g->kernels[set]->spread(&look.look, k >= SIDES * SIDES, s);
            const float level = s->level[0];
            wr_hard_holds(g, WR_HARD_FLOAT, level >= 0.0f && level <= (float)(pyramid.levels - 1));
            wr_hard_holds(g, WR_HARD_FLOAT, s->taps[0] >= 1 && s->taps[0] <= WR_TAPS_MAX);
            g->kernels[set]->look_pyramid(&look.look, true, s);
            wr_hard_holds(g, WR_HARD_FLOAT, isfinite(s->fu[0]) && isfinite(s->fv[0]));
            wr_hard_holds(g, WR_HARD_FLOAT, s->suu[0] >= 0.0f && s->svv[0] >= 0.0f);
        }
    if (good) wr_hard_look_fini(&look);
    wr_pyramid_drop(&pyramid);
    wr_field_free(field);
    return good;
}

/* One ulp before the seam F and its slopes are nearly those on it, by every scheme that is continuous there: a
   table that repeats its own last column instead of the first would show a crease. */
static void check_seam(WrHardMeasurement *g, const WrHardLook *look, const WrField *field)
{
    if (look->scheme == WR_SCHEME_NEAREST) return;
    const double single = 1.0 - 0x1p-24, wide = 1.0 - 0x1p-53;
    for (int k = 0; k < 40; k++) {
        const float t = wr_hard_float(g);
        const double u = k % 2 ? wide : (double)t, v = k % 2 ? (double)t : wide;
        const WrHardSlope on = wr_hard_sample(field, look->scheme, k % 2 ? 0 : u, k % 2 ? v : 0);
        const WrHardSlope off = wr_hard_sample(field, look->scheme, u, v);
        wr_hard_holds(g, WR_HARD_DOUBLE, fabs(on.f - off.f) < 1e-12);
        wr_hard_holds(g, WR_HARD_DOUBLE, fabs(on.fu - off.fu) + fabs(on.fv - off.fv) < 1e-9);
        for (int set = 0; set < g->sets; set++) {
            const float x = k % 2 ? (float)single : t, y = k % 2 ? t : (float)single;
            const WrHardSlope at = wr_hard_look_at(g, set, look, x, y);
            wr_hard_holds(g, WR_HARD_FLOAT, fabs(on.f - at.f) < 1e-5);
            wr_hard_holds(g, WR_HARD_FLOAT, fabs(on.fu - at.fu) + fabs(on.fv - at.fv) < 1e-2);
        }
    }
}

/* The seam at u = 0 and 1 (v as well on the torus): the same frame and the same n', to the bit. */
static bool hc57(WrHardMeasurement *g, WrError *err)
{
    static const WrSurfaceKind kinds[] = { WR_SURFACE_cylinder, WR_SURFACE_sphere,
                                           WR_SURFACE_torus };
    WrField *field = wr_hard_random_table(g, 48, 31, WR_WRAP_PERIODIC);
    bool good = true;
    for (int scheme = 0; scheme < WR_SCHEME_COUNT && good; scheme++) {
        WrHardLook look;
        good = wr_hard_look_init(g, &look, field, (WrScheme)scheme, 1, 1, err);
        for (int k = 0; k < 60 && good; k++) {
            const WrShape shape = wr_hard_shape(kinds[k % 3]);
            const float t = wr_hard_float(g);
            const bool along_v = k % 3 == 2 && k % 2;
            WrVec3 perturbed[2], single[WR_HARD_SETS][2];
            for (int end = 0; end < 2; end++) {
                const float u = along_v ? t : (float)end, v = along_v ? (float)end : t;
                WrSurfacePoint at;
                wr_surface_at(&shape, 0, (double)u, (double)v, &at);
                WrHardSlope slope = wr_hard_sample(field, (WrScheme)scheme, (double)u, (double)v);
                perturbed[end] = wr_hard_bumped_normal(WR_BUMP_BLINN, &at, slope);
                for (int set = 0; set < g->sets; set++) {
                    WrSurfacePointf atf = wr_hard_point(g, set, &shape, 1.0, 0, u, v);
                    slope = wr_hard_look_at(g, set, &look, u, v);
                    single[set][end] =
                        wr_hard_bumped_normal_f(g, set, WR_BUMP_BLINN, &atf, slope, false);
                }
            }
            wr_hard_holds(g, WR_HARD_DOUBLE, wr_hard_same(perturbed[0], perturbed[1]));
            for (int set = 0; set < g->sets; set++)
                wr_hard_holds(g, WR_HARD_FLOAT, wr_hard_same(single[set][0], single[set][1]));
        }
        if (good) check_seam(g, &look, field);
        if (good) wr_hard_look_fini(&look);
    }
    wr_field_free(field);
    return good;
}

static bool hc58(WrHardMeasurement *g, WrError *err)
{
    static const int sizes[][2] = { { 1, 1 }, { 2, 2 }, { 3, 3 }, { 1, 5 }, { 3, 2 }, { 29, 64 } };
    bool good = true;
    for (int s = 0; s < 12 && good; s++) {
        const int w = sizes[s / 2][0], h = sizes[s / 2][1];
        WrField *field = wr_hard_random_table(g, w, h, s % 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC);
        WrHardLook look;
        good = wr_hard_look_init(g, &look, field, WR_SCHEME_BSPLINE_FIT, 1, 1, err);
        for (int k = 0; k < w * h && good; k++) {
            const double u = (k % w + 0.5) / w, v = 1.0 - (k / w + 0.5) / h;
            const double want = (double)wr_field_get(field, k % w, k / w);
            wr_hard_near(g, WR_HARD_DOUBLE, wr_hard_sample(field, WR_SCHEME_BSPLINE_FIT, u, v).f,
                         want);
            for (int set = 0; set < g->sets; set++)
                wr_hard_near(g, WR_HARD_FLOAT, wr_hard_look_at(g, set, &look, (float)u, (float)v).f,
                             want);
        }
        if (good) wr_hard_look_fini(&look);
        wr_field_free(field);
    }
    return good;
}

static const WrHardCase rows_pyramid[] = {
    { .id = "HC55",
      .subject = WR_HARD_TABLE,
      .what = "pyramids of tables that are not square, odd, or one row",
      .holds = "every level keeps the mean to 1e-6, the last is one texel, no level is shifted",
      .unit = "of the bound",
      .bound = { 1, NAN },
      .measure = hc55,
      .scene = "table 64x16\nnoise perlin cells=8\nsurface plane\nreplicate 8,8\nbump "
               "height=0.02\ndials aa=filter" },
    { .id = "HC56",
      .subject = WR_HARD_TABLE,
      .what = "footprints of 0, of NaN, and a million times as long as wide",
      .holds = "the level stays between the first and the last, and slopes are finite",
      .unit = "violations",
      .bound = { 0, NAN },
      .measure = hc56,
      .scene = "table 64x64\ngrid cells=8x8 width=2\nsurface plane\nrotate -89,0,0\n"
               "dials aa=filter footprint=anisotropic" },
    { .id = "HC57",
      .subject = WR_HARD_TABLE,
      .what = "the seam of cylinder, sphere and torus",
      .holds = "n' is the same on both sides, to the bit, and F is continuous there",
      .unit = "violations",
      .bound = { 0, 0 },
      .measure = hc57,
      .scene = "table 48x31\nnoise perlin cells=6\nsurface cylinder\nrotate -90,0,0\n"
               "bump height=0.1" },
    { .id = "HC58",
      .subject = WR_HARD_TABLE,
      .what = "the spline through the samples of tables from one texel up",
      .holds = "it passes through every sample, in float to the rounding of its coefficients",
      .unit = "height",
      .bound = { 2e-6, 1e-13 },
      .measure = hc58,
      .scene = "table 3x2\ndab 0.2,0.2 radius=0.5 strength=1\nsurface torus\nbump "
               "scheme=bspline-fit height=0.9" },
};
WR_HARD_LIST(pyramid, rows_pyramid);

/* ---- Hard cases of normal maps: codes, signs, and extreme slopes ---- */

#define SIDE_MAPS 12
#define TEXELS (SIDE_MAPS * SIDE_MAPS)

/* ---- maps ---------------------------------------------------------------------------------------- */

static WrImage *blank(WrPixelType type, int channels)
{
    WrImage *image = wr_image_new(SIDE_MAPS, SIDE_MAPS, channels, NULL);
    image->type = type;
    return image;
}

/* True if it is unit and finite, and its slopes are finite and have the signs of the input. */
static bool tame(const float n[3])
{
    double p, q;
    wr_normal_map_slopes(n, &p, &q);
    const double square =
        (double)n[0] * (double)n[0] + (double)n[1] * (double)n[1] + (double)n[2] * (double)n[2];
    return isfinite(p) && isfinite(q) && fabs(square - 1) < 1e-6 && n[2] > 0 &&
           p * (double)n[0] <= 0 && q * (double)n[1] <= 0;
}

/* Pictures of the map on a plane or a sphere, in each arithmetic, without the table's bump; takes ownership of
   the map. */
static bool shoot_map(WrHardMeasurement *g, WrImage *map, double strength, double repeat,
                      WrAntialias aa, bool wanted_flat, WrError *err)
{
    WrField *field = wr_field_new(8, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    WrScene *scene = wr_scene_new();
    bool good = true;
    scene->shape = wr_hard_shape(wanted_flat ? WR_SURFACE_plane : WR_SURFACE_sphere);
    scene->dials.aa = aa;
    scene->normals = (WrNormalMap){ .image = map, .strength = strength };
    if (repeat != 1)
        scene->normals.laid = (WrTextureSample){ .own = true, .ru = repeat, .rv = repeat };
    for (int way = 0; way < WR_HARD_WAYS && good; way++) {
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = 40, .height = 40
        };
        const WrHardPrecision precision = way == WR_HARD_WIDE ? WR_HARD_DOUBLE : WR_HARD_FLOAT;
        WrHardShot with = { .renderer = NULL }, without = { .renderer = NULL };
        good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &with, err);
        if (good) wr_hard_holds(g, precision, wr_hard_wild(&with) == 0);
        if (good && wanted_flat) {
            scene->normals.strength = 0;
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &without, err);
            scene->normals.strength = strength;
            if (good) wr_hard_holds(g, precision, wr_hard_differ(&with, &without, 0) == 0);
        }
        wr_hard_put_away(&with);
        wr_hard_put_away(&without);
    }
    wr_scene_free(scene);
    wr_field_free(field);
    return good;
}

/* ---- codes --------------------------------------------------------------------------------------- */

/* All 128: it stands for 0, and pictures are those without a map. Half of them 127: neither stands for 0, and
   both lean equally. Floats: 0. */
static bool hc137(WrHardMeasurement *g, WrError *err)
{
    WrNormalMapReport report;
    WrImage *file = blank(WR_PIXEL_U8, 3);
    for (int i = 0; i < 3 * TEXELS; i++) file->data[i] = (float)((i % 3 < 2 ? 128 : 255) / 255.0);
    WrImage *map = wr_normal_map_decode(file, WR_GREEN_UP, 0, WR_CODING_AUTO, &report, err);
    wr_hard_holds(g, WR_HARD_DOUBLE, report.centred && map->data[0] == 0 && map->data[1] == 0);
    bool good = shoot_map(g, map, 1, 1, WR_AA_POINT, true, err);
    for (int i = 0; i < 3 * TEXELS; i += 6)
        file->data[i] = file->data[i + 1] = (float)(127 / 255.0);
    map = wr_normal_map_decode(file, WR_GREEN_UP, 0, WR_CODING_AUTO, &report, err);
    wr_hard_holds(g, WR_HARD_DOUBLE, !report.centred);
    for (int i = 0; i < 3 * TEXELS; i += 3) {
        const double lean = hypot((double)map->data[i], (double)map->data[i + 1]);
        wr_hard_holds(g, WR_HARD_DOUBLE, fabs(lean - sqrt(2.0) / 255) < 1e-6);
    }
    wr_image_free(map);
    wr_image_free(file);
    return good;
}

/* Two channels, random: also outside the unit circle. */
static bool hc138(WrHardMeasurement *g, WrError *err)
{
    WrNormalMapReport report;
    WrImage *file = blank(WR_PIXEL_U16, 3);
    int64_t beyond = 0;
    for (int i = 0; i < 3 * TEXELS; i++)
        file->data[i] = (float)(floor(65535 * wr_hard_random(g)) / 65535);
    for (int i = 0; i < 3 * TEXELS; i += 3) {
        const double x = 2 * (double)file->data[i] - 1, y = 2 * (double)file->data[i + 1] - 1;
        beyond += x * x + y * y >= 1 - WR_NORMAL_MIN * WR_NORMAL_MIN;
    }
    WrImage *map = wr_normal_map_decode(file, WR_GREEN_UP, 2, WR_CODING_AUTO, &report, err);
    for (int i = 0; i < 3 * TEXELS; i += 3) wr_hard_holds(g, WR_HARD_DOUBLE, tame(map->data + i));
    wr_hard_holds(g, WR_HARD_DOUBLE, report.away == beyond && beyond > 0);
    wr_image_free(file);
    return shoot_map(g, map, 1, 3, WR_AA_POINT, false, err);
}

/* Three channels, every direction; some texels (0,0,0), which is (-1,-1,-1). */
static bool hc139(WrHardMeasurement *g, WrError *err)
{
    WrNormalMapReport report;
    WrImage *file = blank(WR_PIXEL_U8, 3);
    int64_t away = 0;
    for (int i = 0; i < TEXELS; i++) {
        float *t = file->data + 3 * i;
        for (int c = 0; c < 3 && i % 5; c++) t[c] = (float)(floor(256 * wr_hard_random(g)) / 255);
        const double x = 2 * (double)t[0] - 1, y = 2 * (double)t[1] - 1, z = 2 * (double)t[2] - 1;
        away += z / sqrt(x * x + y * y + z * z) < WR_NORMAL_MIN;
    }
    WrImage *map = wr_normal_map_decode(file, WR_GREEN_UP, 0, WR_CODING_AUTO, &report, err);
    for (int i = 0; i < TEXELS; i++) {
        const float *t = file->data + 3 * i, *n = map->data + 3 * i;
        const double x = 2 * (double)t[0] - 1, y = 2 * (double)t[1] - 1;
        wr_hard_holds(g, WR_HARD_DOUBLE, tame(n) && x * (double)n[0] >= 0 && y * (double)n[1] >= 0);
    }
    wr_hard_holds(g, WR_HARD_DOUBLE, report.away == away && away >= TEXELS / 5);
    wr_image_free(file);
    return shoot_map(g, map, 1, 3, WR_AA_FILTER, false, err);
}

/* ---- ambiguous or invisible cases ---------------------------------------------------------------- */

/* f(u) + g(v), or f(u + v): green down, 8 bits. */
static WrImage *waves(bool apart, double power)
{
    WrImage *file = blank(WR_PIXEL_U8, 3);
    for (int i = 0; i < TEXELS; i++) {
        const double a = 6.283185307179586, u = (i % SIDE_MAPS + 0.5) / SIDE_MAPS,
                     v = 1 - (i / SIDE_MAPS + 0.5) / SIDE_MAPS;
        const double p = 0.3 * cos(a * (apart ? u : u + v)), q = 0.3 * cos(a * (apart ? v : u + v));
        const double length = sqrt(1 + p * p + q * q);
        const double n[3] = { -p / length, q / length, 1 / length };
        for (int c = 0; c < 3; c++)
            file->data[3 * i + c] = (float)(floor(255 * pow(n[c] / 2 + 0.5, power) + 0.5) / 255);
    }
    return file;
}

static bool hc140(WrHardMeasurement *g, WrError *err)
{
    for (int apart = 0; apart < 2; apart++) {
        WrNormalMapReport report;
        WrImage *file = waves(apart, 1);
        WrImage *map = wr_normal_map_decode(file, WR_GREEN_AUTO, 0, WR_CODING_AUTO, &report, err);
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      apart ? report.undecided && !report.green_down
                            : !report.undecided && report.green_down);
        wr_image_free(map);
        wr_image_free(file);
    }
    return true;
}

static bool hc141(WrHardMeasurement *g, WrError *err)
{
    static const double powers[] = { 1, 2.2, 1 / 2.2 };
    for (int k = 0; k < 3; k++) {
        WrNormalMapReport report;
        WrImage *file = waves(false, powers[k]);
        WrImage *map = wr_normal_map_decode(file, WR_GREEN_UP, 0, WR_CODING_AUTO, &report, err);
        wr_hard_holds(g, WR_HARD_DOUBLE, report.converted == (k > 0));
        wr_image_free(map);
        wr_image_free(file);
    }
    return true;
}

/* The steepest slopes that a map can hold, of either sign side by side, with strength 100, repeated a billion
   times: their moments. */
static bool hc142(WrHardMeasurement *g, WrError *err)
{
    bool good = true;
    for (int k = 0; k < 4 && good; k++) {
        WrNormalMapReport report;
        WrImage *file = blank(WR_PIXEL_F32, 3);
        for (int i = 0; i < TEXELS; i++) {
            file->data[3 * i] = wr_hard_random(g) < 0.5 ? -1 : 1;
            file->data[3 * i + 1] = wr_hard_random(g) < 0.5 ? -1 : 1;
            file->data[3 * i + 2] = 0;
        }
        WrImage *map = wr_normal_map_decode(file, WR_GREEN_UP, 0, WR_CODING_AUTO, &report, err);
        for (int i = 0; i < 3 * TEXELS; i += 3)
            wr_hard_holds(g, WR_HARD_DOUBLE, tame(map->data + i));
        good = shoot_map(g, map, 100, k % 2 ? 1e9 : 3, k / 2 ? WR_AA_MOMENTS : WR_AA_FILTER, false,
                         err);
        wr_image_free(file);
    }
    return good;
}

#define MAP(number, situation, rule, floats)                                                       \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_GEOMETRY, .what = situation, .holds = rule,         \
        .unit = "violations", .bound = { floats, 0 }, .measure = hc##number                        \
    }
static const WrHardCase rows_maps[] = {
    MAP(137, "a normal map whose flat texels are 128,128",
        "that code is 0, which is reported, and the picture is the one without; float numbers are "
        "exact",
        0),
    MAP(138, "two channels with x^2 + y^2 above 1", "on the rim, finite, counted", 0),
    MAP(139, "texels 0,0,0: vectors that point below the surface",
        "slopes keep their signs and stay finite; counted", 0),
    MAP(140, "green down, of f(u) + g(v)", "undecided, which is reported; of f(u + v) it is found",
        NAN),
    MAP(141, "a normal map that went through a colour conversion", "it is reported", NAN),
    MAP(142, "slopes of a thousand, times a hundred, repeated a billion times",
        "means and moments are finite", 0),
};
WR_HARD_LIST(maps, rows_maps);

static const WrVec3 zero = { 0, 0, 0 };

/* A regular point of a curved surface, in both precisions: the kernel's own numbers, converted to double. */
typedef struct Sample {
    WrSurfacePointf single;
    WrSurfacePoint at; /* n in double from the same tangents */
} Sample;

static Sample sample_of(WrHardMeasurement *g, int i)
{
    static const WrSurfaceKind kinds[] = { WR_SURFACE_bent,   WR_SURFACE_bezier,
                                           WR_SURFACE_sphere, WR_SURFACE_cylinder,
                                           WR_SURFACE_torus,  WR_SURFACE_ribbon };
    const WrShape shape = wr_hard_shape(kinds[i % 6]);
    const double u = wr_hard_between(g, 0.1, 0.9), v = wr_hard_between(g, 0.1, 0.9);
    Sample s;
    wr_surface_at(&shape, 0, u, v, &s.at);
    s.single = wr_hard_narrow(&s.at);
    return s;
}

static Sample plane_point(void)
{
    const WrShape plane = wr_hard_shape(WR_SURFACE_plane);
    Sample s;
    wr_surface_at(&plane, 0, 0.25, 0.75, &s.at);
    s.single = wr_hard_narrow(&s.at);
    return s;
}

static void angles(WrHardMeasurement *g, const Sample *s, WrBumpMode mode, WrHardSlope slope,
                   WrVec3 want)
{
    wr_hard_record_error(g, WR_HARD_DOUBLE,
                         v3_angle_rad(wr_hard_bumped_normal(mode, &s->at, slope), want));
    for (int set = 0; set < g->sets; set++)
        wr_hard_record_error(
            g, WR_HARD_FLOAT,
            v3_angle_rad(wr_hard_bumped_normal_f(g, set, mode, &s->single, slope, false), want));
}

static bool hc13(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 64; i++) {
        const bool ball = i % 2;
        const WrShape shape = wr_hard_shape(ball ? WR_SURFACE_sphere : WR_SURFACE_cylinder);
        const float u = wr_hard_float(g), v = 0.25f + 0.5f * wr_hard_float(g);
        Sample s;
        wr_surface_at(&shape, 0, (double)u, (double)v, &s.at);
        s.single = wr_hard_narrow(&s.at);
        const WrVec3 want = ball ? s.at.n_unit : v3_neg(s.at.n_unit);
        angles(g, &s, WR_BUMP_EXACT, (WrHardSlope){ -1.5 - 0.25 * i, 0, 0 }, want);
    }
    return true;
}

static bool hc14(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    const Sample s = plane_point();
    const WrHardSlope slope = { 1e30, 0, 0 };
    for (int mode = 0; mode < WR_BUMP_COUNT; mode++) {
        WrVec3 perturbed = wr_hard_bumped_normal((WrBumpMode)mode, &s.at, slope);
        wr_hard_holds(g, WR_HARD_DOUBLE, wr_hard_same(perturbed, s.at.n_unit));
        for (int set = 0; set < g->sets; set++) {
            perturbed = wr_hard_bumped_normal_f(g, set, (WrBumpMode)mode, &s.single, slope, false);
            wr_hard_holds(g, WR_HARD_FLOAT, wr_hard_same(perturbed, s.at.n_unit));
        }
    }
    return true;
}

/* On any surface, slopes of any direction up to the precision's largest number: N' consists of D only. The
   tangents are those of the float point; in double they are up to 1e30 long, so that D overflows for all slopes. */
static void check_steep(WrHardMeasurement *g, int i)
{
    static const double most[] = { 1e30, 1e38, (double)FLT_MAX };
    const WrBumpMode mode = (WrBumpMode)(WR_BUMP_BLINN + i % 3);
    const double a = wr_hard_between(g, -1, 1), b = wr_hard_between(g, -1, 1);
    const double size = most[i / 3 % 3];
    Sample s = sample_of(g, i);
    s.single.n_u = s.single.n_v = (WrVec3f){ 0, 0, 0 }; /* F = 0 */
    s.at = wr_hard_point_to_double(&s.single);
    s.at.n_u = s.at.n_v = zero;
    const WrVec3 d = wr_bump_d(s.at.n_unit, s.at.pu, s.at.pv, a, b);
    for (int set = 0; set < g->sets; set++) {
        const WrHardSlope slope = { 0, size * a, size * b };
        const WrVec3 perturbed = wr_hard_bumped_normal_f(g, set, mode, &s.single, slope, false);
        wr_hard_record_error(g, WR_HARD_FLOAT, v3_angle_rad(perturbed, d));
    }
    s.at.pu = v3_scale(s.at.pu, 1e30), s.at.pv = v3_scale(s.at.pv, 1e30);
    s.at.n = v3_scale(s.at.n, 1e60), s.at.n_len *= 1e60;
    const WrHardSlope slope = { 0, DBL_MAX * a, DBL_MAX * b };
    wr_hard_record_error(g, WR_HARD_DOUBLE,
                         v3_angle_rad(wr_hard_bumped_normal(mode, &s.at, slope), d));
}

/* On the unit plane the downhill direction is -(Fu, Fv). */
static bool hc15(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const double steep[] = { 1e30, 1e38, 3e38, 1e154, DBL_MAX };
    const Sample s = plane_point();
    const WrVec3 down = v3_unit((WrVec3){ -1, 0.5, 0 }, zero);
    for (int i = 0; i < 5; i++)
        for (int mode = WR_BUMP_BLINN; mode < WR_BUMP_COUNT; mode++) {
            const WrHardSlope slope = { 0.1, steep[i], -steep[i] / 2 };
            WrVec3 perturbed = wr_hard_bumped_normal((WrBumpMode)mode, &s.at, slope);
            wr_hard_record_error(g, WR_HARD_DOUBLE, v3_angle_rad(perturbed, down));
            for (int set = 0; set < g->sets && i < 3; set++) {
                perturbed =
                    wr_hard_bumped_normal_f(g, set, (WrBumpMode)mode, &s.single, slope, false);
                wr_hard_record_error(g, WR_HARD_FLOAT, v3_angle_rad(perturbed, down));
            }
        }
    for (int i = 0; i < 600; i++) check_steep(g, i);
    return true;
}

/* The largest difference of a component, in ulps of numbers near 1. */
static double places(WrVec3 a, WrVec3 b, double ulp)
{
    const WrVec3 d = v3_sub(a, b);
    return fmax(fmax(fabs(d.x), fabs(d.y)), fabs(d.z)) / ulp;
}

static bool hc16(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 120; i++) {
        const Sample s = sample_of(g, i);
        for (int mode = WR_BUMP_BLINN; mode < WR_BUMP_COUNT; mode++) {
            const WrHardSlope slope = { 0, 1e-30, -1e-30 };
            WrVec3 perturbed = wr_hard_bumped_normal((WrBumpMode)mode, &s.at, slope);
            wr_hard_record_error(g, WR_HARD_DOUBLE, places(perturbed, s.at.n_unit, 0x1p-52));
            for (int set = 0; set < g->sets; set++) {
                perturbed =
                    wr_hard_bumped_normal_f(g, set, (WrBumpMode)mode, &s.single, slope, false);
                wr_hard_record_error(g, WR_HARD_FLOAT,
                                     places(perturbed, wr_hard_vec(s.single.n_unit), 0x1p-23));
            }
        }
    }
    return true;
}

static bool hc17(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 120; i++) {
        const Sample s = sample_of(g, i);
        for (int mode = 0; mode < WR_BUMP_COUNT; mode++) {
            const double none = i % 2 ? -0.0 : 0.0, f = mode == WR_BUMP_EXACT ? 0.0 : 0.25;
            const WrHardSlope slope = { f, none, 0 };
            const WrVec3 perturbed = wr_hard_bumped_normal((WrBumpMode)mode, &s.at, slope);
            const WrVec3 n = wr_bump_normal((WrBumpMode)mode, s.at.n, s.at.n_unit, s.at.pu, s.at.pv,
                                            s.at.n_u, s.at.n_v, f, none, 0);
            wr_hard_holds(g, WR_HARD_DOUBLE,
                          memcmp(&perturbed, &s.at.n_unit, sizeof perturbed) == 0);
            wr_hard_holds(g, WR_HARD_DOUBLE, memcmp(&n, &s.at.n, sizeof n) == 0);
            for (int set = 0; set < g->sets; set++) {
                WrVec3 got =
                    wr_hard_bumped_normal_f(g, set, (WrBumpMode)mode, &s.single, slope, false);
                wr_hard_holds(g, WR_HARD_FLOAT, wr_hard_same(got, wr_hard_vec(s.single.n_unit)));
            }
        }
    }
    return true;
}

/* tan(theta') / a - 1, on the unit plane: n' = (-Fu, -Fv, 1) up to length. */
static bool hc18(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const double slopes[] = { 1e-25, 1e-12, 1e-170, 1e-300 };
    const Sample s = plane_point();
    for (int i = 0; i < 4; i++) {
        const double a = slopes[i];
        const WrHardSlope slope = { 0, 0.6 * a, 0.8 * a };
        WrVec3 perturbed = wr_hard_bumped_normal(WR_BUMP_INVARIANT, &s.at, slope);
        wr_hard_record_error(g, WR_HARD_DOUBLE,
                             fabs(hypot(perturbed.x / a, perturbed.y / a) / perturbed.z - 1.0));
        for (int set = 0; set < g->sets && i < 2; set++) {
            perturbed = wr_hard_bumped_normal_f(g, set, WR_BUMP_INVARIANT, &s.single, slope, false);
            wr_hard_record_error(g, WR_HARD_FLOAT,
                                 fabs(hypot(perturbed.x / a, perturbed.y / a) / perturbed.z - 1.0));
        }
    }
    return true;
}

static double tangent(WrVec3 a, WrVec3 b)
{
    return v3_len(v3_cross(a, b)) / v3_dot(a, b);
}

/* In float up to the last number before the pole. */
static bool hc19(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const double slopes[][2] = { { 0.5, 0 }, { 0, 0.5 }, { 0.3, -0.4 } };
    for (int i = 0; i < 3; i++)
        for (int k = 4; k <= 54; k++)
            for (int j = 0; j < 16; j++) {
                const WrShape shape = wr_hard_shape(j % 2 ? WR_SURFACE_cone : WR_SURFACE_sphere);
                const double v = k == 54 ? 1.0 : 1.0 - ldexp(1.0, -k), u = j / 16.0;
                const WrHardSlope slope = { 0, slopes[i][0], slopes[i][1] };
                const double a = hypot(slope.fu, slope.fv);
                WrSurfacePoint at;
                wr_surface_at(&shape, 0, u, v, &at);
                WrVec3 perturbed = wr_hard_bumped_normal(WR_BUMP_INVARIANT, &at, slope);
                wr_hard_record_error(g, WR_HARD_DOUBLE,
                                     fabs(tangent(at.n_unit, perturbed) / a - 1.0));
                for (int set = 0; set < g->sets && k <= 24; set++) {
                    WrSurfacePointf atf = wr_hard_point(g, set, &shape, 1.0, 0, (float)u, (float)v);
                    perturbed =
                        wr_hard_bumped_normal_f(g, set, WR_BUMP_INVARIANT, &atf, slope, false);
                    wr_hard_record_error(
                        g, WR_HARD_FLOAT,
                        fabs(tangent(wr_hard_vec(atf.n_unit), perturbed) / a - 1.0));
                }
            }
    return true;
}

/* Equal directions have the angle 0, in whatever precision they were computed; small angles are preserved. */
static bool hc20(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 200; i++) {
        const Sample s = sample_of(g, i);
        const WrVec3 single = wr_hard_vec(s.single.n_unit);
        wr_hard_record_error(g, WR_HARD_DOUBLE, v3_angle_rad(s.at.n_unit, s.at.n_unit));
        wr_hard_record_error(g, WR_HARD_FLOAT, v3_angle_rad(single, single));
        const double little = ldexp(1.0, -1 - i % 60);
        const WrVec3 a = { 0, 0, 1 }, b = { sin(little), 0, cos(little) };
        wr_hard_near(g, WR_HARD_DOUBLE, v3_angle_rad(a, b), little);
    }
    return true;
}

/* Kernels: without tangents, and with infinite ones, the result is n; tangents at right angles of length 1e-40
   to 1e37, slope 1: the formulas' result. */
static void kernels_make_unit(WrHardMeasurement *g)
{
    static const double sizes[] = { 0, 1e-40, 1e-30, 1e-20, 1, 1e10, INFINITY };
    const WrVec3 z = { 0, 0, 1 }, halfway = { -1, 0, 1 }, across = { -1, 0, 0 };
    for (int i = 0; i < 7 * (WR_BUMP_COUNT - 1); i++) {
        const float t = (float)sizes[i % 7];
        const WrBumpMode mode = (WrBumpMode)(WR_BUMP_BLINN + i / 7);
        const WrSurfacePointf at = {
            .pu = { t, 0, 0 }, .pv = { 0, t, 0 }, .n_unit = { 0, 0, 1 }, .n_len = t
        };
        /* |N| is set to t, so that D has it too; exact computes it from the tangents: t^2 instead of t */
        const double flat = (double)t * (double)t;
        const bool none = !(t > 0.0f && isfinite(t));
        WrVec3 want = none ? z : halfway;
        if (mode == WR_BUMP_EXACT && !none) want = (WrVec3){ -1, 0, flat > 1e-12 ? (double)t : 0 };
        if (mode == WR_BUMP_EXACT && !none && flat <= 1e-12) want = across;
        /* fast arithmetic estimates reciprocals, which denormal numbers do not have */
        const int sets = t > 0.0f && t < FLT_MIN ? g->sets : g->all;
        for (int set = 0; set < sets; set++) {
            WrVec3 perturbed =
                wr_hard_bumped_normal_f(g, set, mode, &at, (WrHardSlope){ 0, 1, 0 }, false);
            wr_hard_holds(g, WR_HARD_FLOAT, fabs(v3_len(perturbed) - 1.0) < 1e-6);
            wr_hard_holds(g, WR_HARD_FLOAT, v3_angle_rad(perturbed, want) < 1e-4);
        }
    }
}

/* Normalisation by the formulas: tangents of any size and of different lengths, compared with the vector's
   direction. */
static void formulas_make_unit(WrHardMeasurement *g, WrVec3 n)
{
    for (int i = 0; i < 600; i++) {
        const WrVec3 a = { wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1),
                           wr_hard_between(g, -1, 1) };
        const WrVec3 far = v3_scale(a, ldexp(1.0, i - 300));
        wr_hard_holds(g, WR_HARD_DOUBLE, v3_angle_rad(wr_bump_unit(far, n), a) < 1e-15 * 4);
    }
}

static bool hc21(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const WrVec3 useless[] = {
        { 0, 0, 0 }, { INFINITY, 0, 0 }, { NAN, 1, 2 }, { 0, -INFINITY, NAN }
    };
    const WrVec3 n = { 0.6, 0, 0.8 };
    for (int i = 0; i < 4; i++)
        wr_hard_holds(g, WR_HARD_DOUBLE, wr_hard_same(wr_bump_unit(useless[i], n), n));
    const WrVec3 tiny = wr_bump_unit((WrVec3){ 3e-310, 0, -4e-310 }, n);
    wr_hard_holds(g, WR_HARD_DOUBLE, v3_angle_rad(tiny, (WrVec3){ 0.6, 0, -0.8 }) < 1e-12);
    const WrVec3 huge = wr_bump_unit((WrVec3){ DBL_MAX, DBL_MAX, 0 }, n);
    wr_hard_holds(g, WR_HARD_DOUBLE, v3_angle_rad(huge, (WrVec3){ 1, 1, 0 }) < 1e-15);
    formulas_make_unit(g, n);
    kernels_make_unit(g);
    return true;
}

static bool hc22(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 300; i++) {
        const Sample s = sample_of(g, i);
        const double fu = (double)(2.0f * wr_hard_float(g) - 1.0f);
        const double fv = (double)(2.0f * wr_hard_float(g) - 1.0f);
        const WrVec3 d = wr_bump_d(s.at.n_unit, s.at.pu, s.at.pv, fu, fv);
        const WrVec3 swapped = wr_bump_normal(WR_BUMP_BLINN, v3_neg(s.at.n), v3_neg(s.at.n_unit),
                                              s.at.pv, s.at.pu, zero, zero, 0, fv, fu);
        wr_hard_record_error(g, WR_HARD_DOUBLE, v3_len(v3_sub(swapped, v3_sub(d, s.at.n))));
        WrSurfacePointf turned = s.single;
        turned.pu = s.single.pv;
        turned.pv = s.single.pu;
        turned.n_unit = v3f_neg(s.single.n_unit);
        const WrSurfacePoint wide = wr_hard_point_to_double(&s.single);
        const WrVec3 n = v3_scale(wide.n_unit, wide.n_len);
        const WrVec3 want =
            v3_unit(v3_sub(wr_bump_d(wide.n_unit, wide.pu, wide.pv, fu, fv), n), zero);
        for (int set = 0; set < g->sets; set++) {
            WrVec3 got = wr_hard_bumped_normal_f(g, set, WR_BUMP_BLINN, &turned,
                                                 (WrHardSlope){ 0, fv, fu }, false);
            wr_hard_record_error(g, WR_HARD_FLOAT, v3_angle_rad(got, want));
        }
    }
    return true;
}

static WrVec3 displaced(const WrShape *shape, double u, double v, double *f, double *fu, double *fv)
{
    double s, c, sv, cv;
    WrSurfacePoint at;
    wr_surface_at(shape, 0, u, v, &at);
    wr_sincos_turns(3.0 * u, &s, &c);
    wr_sincos_turns(2.0 * v, &sv, &cv);
    const double f_here = 0.03 * s * cv;
    if (f) {
        *f = f_here;
        *fu = 0.18 * WR_PI * c * cv;
        *fv = -0.12 * WR_PI * s * sv;
    }
    return v3_mad(at.p, at.n_unit, f_here);
}

/* The reference is the displaced surface's own cross product, by central differences of order four: steps of
   1e-3 have an error of (2 pi 3 1e-3)^4 / 30 = 4e-9 of a slope, and 1e-13 of rounding. */
static bool hc23(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const WrSurfaceKind kinds[] = { WR_SURFACE_sphere, WR_SURFACE_torus, WR_SURFACE_cylinder,
                                           WR_SURFACE_bent };
    for (int i = 0; i < 200; i++) {
        const WrShape shape = wr_hard_shape(kinds[i % 4]);
        const double u = wr_hard_between(g, 0.1, 0.9), v = wr_hard_between(g, 0.2, 0.8), h = 1e-3;
        double f, fu, fv;
        WrVec3 slope[2];
        for (int axis = 0; axis < 2; axis++) {
            const double du = axis ? 0 : h, dv = axis ? h : 0;
            WrVec3 near = v3_sub(displaced(&shape, u + du, v + dv, NULL, NULL, NULL),
                                 displaced(&shape, u - du, v - dv, NULL, NULL, NULL));
            WrVec3 far = v3_sub(displaced(&shape, u + 2 * du, v + 2 * dv, NULL, NULL, NULL),
                                displaced(&shape, u - 2 * du, v - 2 * dv, NULL, NULL, NULL));
            slope[axis] = v3_sub(v3_scale(near, 8.0), far);
        }
        const WrVec3 front = v3_unit(v3_cross(slope[0], slope[1]), zero);
        displaced(&shape, u, v, &f, &fu, &fv);
        Sample s;
        wr_surface_at(&shape, 0, u, v, &s.at);
        s.single = wr_hard_narrow(&s.at);
        const WrHardSlope here = { f, fu, fv };
        angles(g, &s, WR_BUMP_EXACT, here, front);
        for (int set = 0; set < g->sets; set++) {
            WrVec3 back = wr_hard_bumped_normal_f(g, set, WR_BUMP_EXACT, &s.single, here, true);
            wr_hard_record_error(g, WR_HARD_FLOAT, v3_angle_rad(back, v3_neg(front)));
        }
    }
    return true;
}

#define BUMP(number, situation, rule, u, in_float, in_double, script)                              \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_GEOMETRY, .what = situation, .holds = rule,         \
        .unit = u, .bound = { in_float, in_double }, .measure = hc##number, .scene = script        \
    }
static const WrHardCase rows_bump[] = {
    BUMP(13, "exact normals beyond the focal distance",
         "n flips with the sign of the determinant: not on the sphere, but on the cylinder", "rad",
         2e-6, 1e-13,
         "table 64x64\nfill 1\nsurface cylinder\nbump mode=exact scheme=bspline height=-1.5"),
    BUMP(14, "a height of 1e30 without a slope, on a plane", "n to the bit in every mode",
         "violations", 0, 0, "table 64x64\nfill 1\nsurface plane\nbump mode=exact height=1e30"),
    BUMP(15, "slopes whose square overflows", "n' points straight downhill", "rad", 1e-6, 1e-14,
         "table 64x64\nformula fourier terms=3,0,1e18;0,5,5e17,90,0\nsurface plane\nbump "
         "height=1e19"),
    BUMP(16, "slopes whose square underflows", "n' is n", "last places", 1, 1,
         WAVES "surface torus\nbump height=1e-31"),
    BUMP(17, "no slope at all", "N' is N to the bit in every mode", "violations", 0, 0,
         "table 64x64\nfill 0.5\nsurface torus\nbump mode=invariant"),
    BUMP(18, "scale-invariant normals of slopes whose square underflows",
         "the tangent of the tilt is still the slope", "relative", 1e-6, 1e-14,
         WAVES "surface plane\nbump mode=invariant height=1e-25"),
    BUMP(19, "scale-invariant normals at poles and tips",
         "the tangent of the tilt is the slope on every approach", "relative", 4e-6, 1e-12,
         WAVES "surface sphere\nrotate 15,0,0\nbump mode=invariant height=0.1"),
    BUMP(20, "the angle between equal normals", "0, and small angles are kept", "rad", 0, 1e-15,
         NULL),
    BUMP(21, "a normal of length 0, denormal, infinite or NaN made unit",
         "a unit vector, and n where there is no direction", "violations", 0, 0, NULL),
    BUMP(22, "u and v exchanged", "N' is -N + D: dents become bumps", "rad", 1e-6, 0,
         WAVES "surface bent\nbump height=0.03"),
    BUMP(23, "the exact normal from the front and from behind",
         "that of the displaced surface, turned towards the eye", "rad", 2e-6, 1e-6,
         WAVES "surface bent\nrotate 0,180,0\nbump mode=exact scheme=bspline height=0.03"),
};
WR_HARD_LIST(bump, rows_bump);
