/* Hard cases of filtered tables, seams of closed surfaces, and the spline through the samples. */
#include "hardcases/hardcases_look.h"
#include "field/scheme_list.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "field/field.h"
#include "render/textures/slope_pyramid.h"

#include <string.h>

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
static void check_levels(WrHardGauge *g, const WrPyramid *pyramid, const WrField *field)
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
                if (w > 1) wr_hard_off(g, WR_HARD_FLOAT, fabs(f - 1.0 - want) * w / (WR_PI / 1.5));
            }
        wr_hard_off(g, WR_HARD_FLOAT, fabs(sum / (level->width * level->height) - mean) / 1e-6);
    }
    const WrPyramidLevel *last = &pyramid->level[pyramid->levels - 1];
    wr_hard_off(g, WR_HARD_FLOAT, last->width == 1 && last->height == 1 ? 0.0 : 2.0);
}

static bool hc55(WrHardGauge *g, WrError *err)
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
static void check_footprints(WrHardGauge *g, const WrLook *look)
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
static bool hc56(WrHardGauge *g, WrError *err)
{
    static const float sides[] = { 0, 1e-30f, 0.5f, 1, 1e3f, 1e6f, 1e9f, INFINITY, NAN };
    enum { SIDES = sizeof sides / sizeof *sides };
    WrField *field = wr_hard_rough(g, 64, 48, WR_WRAP_PERIODIC);
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
            wr_hard_holds(g, WR_HARD_FLOAT, s->taps[0] >= 1 && s->taps[0] <= WR_TAPS_MOST);
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
static void check_seam(WrHardGauge *g, const WrHardLook *look, const WrField *field)
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
static bool hc57(WrHardGauge *g, WrError *err)
{
    static const WrSurfaceKind kinds[] = { WR_SURFACE_cylinder, WR_SURFACE_sphere,
                                           WR_SURFACE_torus };
    WrField *field = wr_hard_rough(g, 48, 31, WR_WRAP_PERIODIC);
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
                perturbed[end] = wr_hard_perturbed(WR_BUMP_BLINN, &at, slope);
                for (int set = 0; set < g->sets; set++) {
                    WrSurfacePointf atf = wr_hard_point(g, set, &shape, 1.0, 0, u, v);
                    slope = wr_hard_look_at(g, set, &look, u, v);
                    single[set][end] =
                        wr_hard_perturbed_f(g, set, WR_BUMP_BLINN, &atf, slope, false);
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

static bool hc58(WrHardGauge *g, WrError *err)
{
    static const int sizes[][2] = { { 1, 1 }, { 2, 2 }, { 3, 3 }, { 1, 5 }, { 3, 2 }, { 29, 64 } };
    bool good = true;
    for (int s = 0; s < 12 && good; s++) {
        const int w = sizes[s / 2][0], h = sizes[s / 2][1];
        WrField *field = wr_hard_rough(g, w, h, s % 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC);
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

static const WrHardCase rows[] = {
    { .id = "HC55",
      .subject = WR_HARD_TABLE,
      .what = "pyramids of tables that are not square, odd, or one row",
      .holds = "every level keeps the mean to 1e-6, the last is one texel, no level is shifted",
      .unit = "of what is allowed",
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
      .holds = "n' is the same on both of its sides, to the bit, and F goes on beside it",
      .unit = "violations",
      .bound = { 0, 0 },
      .measure = hc57,
      .scene = "table 48x31\nnoise perlin cells=6\nsurface cylinder\nrotate -90,0,0\n"
               "bump height=0.1" },
    { .id = "HC58",
      .subject = WR_HARD_TABLE,
      .what = "the spline through the samples of tables from one texel up",
      .holds = "it meets every sample, in float to the rounding of its coefficients",
      .unit = "height",
      .bound = { 2e-6, 1e-13 },
      .measure = hc58,
      .scene = "table 3x2\ndab 0.2,0.2 radius=0.5 strength=1\nsurface torus\nbump "
               "scheme=bspline-fit height=0.9" },
};
WR_HARD_LIST(pyramid, rows);
