/* Hard cases of fetching from the table: ends, wraps, repeats, odd sizes. */
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/vec.h"
#include "document/blend.h"
#include "field/field.h"
#include "field/ops.h"
#include "field/scheme_list.h"
#include "hardcases/hardcases_later.h"
#include "hardcases/hardcases_look.h"
#include "image/image.h"
#include "scene/scene.h"

#include <float.h>
#include <string.h>

/* ---- Hard cases of flat tables: no detail, and detail at a level of a million ---- */

static bool hc47(WrHardMeasurement *g, WrError *err)
{
    static const float levels[] = { 0, 1, 0.1f, -1e6f, 3.3e38f, 1e-40f };
    bool good = true;
    for (int k = 0; k < 12 && good; k++) {
        const WrWrap wrap = k % 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC;
        WrField *field = wr_field_new(100, 37, wrap, wrap, levels[k / 2], err);
        good = field != NULL;
        for (int scheme = 0; scheme < WR_SCHEME_COUNT && good; scheme++) {
            WrHardLook look;
            good = wr_hard_look_init(g, &look, field, (WrScheme)scheme, 1, 1, err);
            for (int i = 0; i < 30 && good; i++) {
                const float u = wr_hard_float(g), v = wr_hard_float(g);
                WrHardSlope s = wr_hard_sample(field, (WrScheme)scheme, (double)u, (double)v);
                wr_hard_holds(g, WR_HARD_DOUBLE,
                              s.f == (double)levels[k / 2] && s.fu == 0.0 && s.fv == 0.0);
                for (int set = 0; set < g->sets; set++) {
                    s = wr_hard_look_at(g, set, &look, u, v);
                    wr_hard_holds(g, WR_HARD_FLOAT,
                                  s.f == (double)levels[k / 2] && s.fu == 0.0 && s.fv == 0.0);
                }
            }
            if (good) wr_hard_look_fini(&look);
        }
        wr_field_free(field);
    }
    return good;
}

/* Slopes of a table at a level of a million, compared with those of the same stored heights minus a million
   (which is exact), heights per texel, in units of the step of stored heights, 1/16. */
static bool hc48(WrHardMeasurement *g, WrError *err)
{
    WrField *low = wr_hard_waves(64, 64), *high = wr_field_share(low);
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 64; i++) {
            wr_field_set(high, i, j, 1e6f + 4.0f * wr_field_get(low, i, j));
            wr_field_set(low, i, j, wr_field_get(high, i, j) - 1e6f);
        }
    bool good = true;
    for (int scheme = 0; scheme < WR_SCHEME_COUNT && good; scheme++) {
        WrHardLook a;
        good = wr_hard_look_init(g, &a, high, (WrScheme)scheme, 1, 1, err);
        for (int k = 0; k < 300 && good; k++) {
            const float u = wr_hard_float(g), v = wr_hard_float(g);
            const double step = 64.0 / 16.0;
            const WrHardSlope want = wr_hard_sample(low, (WrScheme)scheme, (double)u, (double)v);
            WrHardSlope got = wr_hard_sample(high, (WrScheme)scheme, (double)u, (double)v);
            wr_hard_near(g, WR_HARD_DOUBLE, got.fu / step, want.fu / step);
            wr_hard_near(g, WR_HARD_DOUBLE, got.fv / step, want.fv / step);
            for (int set = 0; set < g->sets; set++) {
                got = wr_hard_look_at(g, set, &a, u, v);
                wr_hard_near(g, WR_HARD_FLOAT, got.fu / step, want.fu / step);
                wr_hard_near(g, WR_HARD_FLOAT, got.fv / step, want.fv / step);
            }
        }
        if (good) wr_hard_look_fini(&a);
    }
    wr_field_free(low);
    wr_field_free(high);
    return good;
}

static const WrHardCase rows[] = {
    { .id = "HC47",
      .subject = WR_HARD_TABLE,
      .what = "a flat table at any level",
      .holds = "F is the level and the slopes are 0, to the bit, in every scheme",
      .unit = "violations",
      .bound = { 0, 0 },
      .measure = hc47,
      .scene = "table 100x37\nfill 1e6\nsurface sphere\nbump scheme=bspline height=0.1" },
    { .id = "HC48",
      .subject = WR_HARD_TABLE,
      .what = "fine detail on a level of a million",
      .holds = "slopes are those of the stored heights without the level",
      .unit = "steps of height",
      .bound = { 2, 1 },
      .measure = hc48,
      .scene = "table 64x64\nformula fourier terms=3,0,2;0,5,1,90,0\nadjust add amount=1e6\n"
               "surface plane\nbump height=0.01" },
};
WR_HARD_LIST(flat, rows);

/* ---- Hard cases of heights: extreme ones, integer ones, and edges of cells ---- */

/* One texel at float's maximum: outside the scheme's reach not a bit differs. */
static bool hc49(WrHardMeasurement *g, WrError *err)
{
    WrField *field = wr_hard_random_table(g, 100, 100, WR_WRAP_PERIODIC),
            *spoilt = wr_field_share(field);
    const float wild[] = { NAN, INFINITY, -INFINITY };
    wr_field_set(spoilt, 50, 50, FLT_MAX);
    bool good = true;
    for (int scheme = 0; scheme < WR_SCHEME_COUNT && good; scheme++) {
        WrHardLook a, b;
        good = wr_hard_look_init(g, &a, field, (WrScheme)scheme, 1, 1, err) &&
               wr_hard_look_init(g, &b, spoilt, (WrScheme)scheme, 1, 1, err);
        for (int k = 0; k < 64 && good; k++) {
            const double out = (wr_schemes[scheme].reach + 0.51 + k % 8) / 100;
            const float u = 0.505f + (float)(k & 8 ? out : -out), v = wr_hard_float(g);
            const float at[2] = { k & 16 ? v : u, k & 16 ? 1.0f - u : v };
            wr_hard_holds(
                g, WR_HARD_DOUBLE,
                wr_hard_same_slope(
                    wr_hard_sample(field, (WrScheme)scheme, (double)at[0], (double)at[1]),
                    wr_hard_sample(spoilt, (WrScheme)scheme, (double)at[0], (double)at[1])));
            for (int set = 0; set < g->sets; set++)
                wr_hard_holds(g, WR_HARD_FLOAT,
                              wr_hard_same_slope(wr_hard_look_at(g, set, &a, at[0], at[1]),
                                                 wr_hard_look_at(g, set, &b, at[0], at[1])));
        }
        if (!good) break;
        wr_hard_look_fini(&a);
        wr_hard_look_fini(&b);
    }
    const int64_t replaced = wr_field_write(spoilt, 3, 4, 3, 1, wild, 3);
    bool level = true;
    for (int i = 3; i < 6; i++) level = level && wr_field_get(spoilt, i, 4) == 0.0f;
    wr_hard_holds(g, WR_HARD_DOUBLE, replaced == 3 && level);
    wr_field_free(field);
    wr_field_free(spoilt);
    return good;
}

static bool hc50(WrHardMeasurement *g, WrError *err)
{
    bool good = true;
    for (int wrap = 0; wrap < 2 && good; wrap++) {
        WrField *field = wr_hard_random_table(g, 8, 8, wrap ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC);
        for (int k = 0; k < 64; k++)
            wr_field_set(field, k % 8, k / 8, (k * k / 3) % 2 ? FLT_MAX : -FLT_MAX);
        for (int scheme = 0; scheme < WR_SCHEME_COUNT && good; scheme++) {
            WrHardLook look;
            good = wr_hard_look_init(g, &look, field, (WrScheme)scheme, 1, 1, err);
            for (int k = 0; k < 200 && good; k++) {
                const float u = (float)k / 200, v = wr_hard_float(g);
                WrHardSlope s = wr_hard_sample(field, (WrScheme)scheme, (double)u, (double)v);
                wr_hard_holds(g, WR_HARD_DOUBLE, isfinite(s.f) && isfinite(s.fu) && isfinite(s.fv));
                for (int set = 0; set < g->sets; set++) {
                    s = wr_hard_look_at(g, set, &look, u, v);
                    wr_hard_holds(g, WR_HARD_FLOAT,
                                  isfinite(s.f) && isfinite(s.fu) && isfinite(s.fv));
                }
            }
            if (good) wr_hard_look_fini(&look);
        }
        wr_field_free(field);
    }
    return good;
}

/* ---- heights as integers ---- */

/* A table after saving it as a file of that type: codes of 0..1. */
static WrField *through_codes(const WrField *field, WrPixelType type, double *worst)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    const size_t count = (size_t)w * (size_t)h;
    const double last = type == WR_PIXEL_U8 ? 255.0 : 65535.0;
    float *heights = wr_alloc(count, sizeof *heights);
    void *codes = wr_alloc(count, 2);
    WrField *out = wr_field_share(field);
    wr_field_read(field, 0, 0, w, h, heights, (size_t)w);
    wr_image_codes(type, heights, count, codes, NULL);
    *worst = 0.0;
    for (size_t k = 0; k < count; k++) {
        const double code =
            type == WR_PIXEL_U8 ? ((uint8_t *)codes)[k] : (double)((uint16_t *)codes)[k];
        const double off = fabs(code / last - (double)heights[k]);
        if (off > *worst) *worst = off;
        heights[k] = (float)(code / last);
    }
    wr_field_write(out, 0, 0, w, h, heights, (size_t)w);
    wr_free(heights);
    wr_free(codes);
    return out;
}

/* Slopes of integer heights compared with those of the heights themselves, in n / (2 last code): the largest
   effect of half a code in either direction on a central difference. */
static bool quantised(WrHardMeasurement *g, WrPixelType type, WrError *err)
{
    static const int sizes[] = { 64, 256, 1024 };
    const double last = type == WR_PIXEL_U8 ? 255.0 : 65535.0;
    bool good = true;
    for (int s = 0; s < 3 && good; s++) {
        WrField *field = wr_hard_waves(sizes[s], 16);
        for (int j = 0; j < 16; j++)
            for (int i = 0; i < sizes[s]; i++)
                wr_field_set(field, i, j, 0.5f + 0.5f * wr_field_get(field, i, j));
        double worst;
        WrField *coarse = through_codes(field, type, &worst);
        const double quantum = sizes[s] / (2.0 * last);
        WrHardLook look;
        wr_hard_record_error(g, WR_HARD_DOUBLE, worst * 2.0 * last);
        good = wr_hard_look_init(g, &look, coarse, WR_SCHEME_CENTRAL, 1, 1, err);
        for (int k = 0; k < 400 && good; k++) {
            const float u = wr_hard_float(g), v = wr_hard_float(g);
            const double want = wr_hard_sample(field, WR_SCHEME_CENTRAL, (double)u, (double)v).fu;
            const double got = wr_hard_sample(coarse, WR_SCHEME_CENTRAL, (double)u, (double)v).fu;
            wr_hard_record_error(g, WR_HARD_DOUBLE, fabs(got - want) / quantum);
            for (int set = 0; set < g->sets; set++)
                wr_hard_record_error(g, WR_HARD_FLOAT,
                                     fabs(wr_hard_look_at(g, set, &look, u, v).fu - want) /
                                         quantum);
        }
        if (good) wr_hard_look_fini(&look);
        wr_field_free(field);
        wr_field_free(coarse);
    }
    return good;
}

static bool hc51(WrHardMeasurement *g, WrError *err)
{
    return quantised(g, WR_PIXEL_U8, err);
}

static bool hc52(WrHardMeasurement *g, WrError *err)
{
    return quantised(g, WR_PIXEL_U16, err);
}

enum { SIDE = 256, CODES = SIDE * SIDE };

static bool give_rows(void *ctx, int y, int count, void *out, WrError *err)
{
    (void)err;
    memcpy(out, (uint16_t *)ctx + (size_t)y * SIDE, (size_t)count * SIDE * sizeof(uint16_t));
    return true;
}

/* Converts heights to codes and to a file in memory. */
static bool write_codes(const char *name, const float *heights, uint16_t *codes, char **bytes,
                        size_t *length, WrError *err)
{
    const WrImageOut part = { .width = SIDE,
                              .height = SIDE,
                              .channels = 1,
                              .type = WR_PIXEL_U16,
                              .data = true,
                              .rows = give_rows,
                              .ctx = codes };
    wr_image_codes(WR_PIXEL_U16, heights, CODES, codes, NULL);
    return wr_image_write_bytes(name, &part, bytes, length, err);
}

/* Saved, read, and saved again: the same bytes, and heights within half a code. */
static bool save_twice(WrHardMeasurement *g, const char *name, const float *heights,
                       uint16_t *codes, WrError *err)
{
    char *first = NULL, *second = NULL;
    size_t first_length = 0, second_length = 0;
    bool good = write_codes(name, heights, codes, &first, &first_length, err);
    WrImage *image = good ? wr_image_read_bytes(name, first, first_length, err) : NULL;
    good = image != NULL;
    for (int k = 0; k < CODES && good; k++)
        wr_hard_holds(g, WR_HARD_FLOAT,
                      fabs((double)image->data[k] - (double)heights[k]) <= 0.5001 / 65535.0);
    good = good && write_codes(name, image->data, codes, &second, &second_length, err);
    if (good)
        wr_hard_holds(g, WR_HARD_FLOAT,
                      first_length == second_length && memcmp(first, second, first_length) == 0);
    wr_image_free(image);
    wr_free(first);
    wr_free(second);
    return good;
}

/* Every possible code, and random heights. */
static bool hc53(WrHardMeasurement *g, WrError *err)
{
    float *heights = wr_alloc(CODES, sizeof *heights);
    uint16_t *codes = wr_alloc(CODES, sizeof *codes);
    bool good = true;
    for (int i = 0; i < 3 && good; i++) {
        for (int k = 0; k < CODES; k++)
            heights[k] = i < 1 ? (float)(k / 65535.0) : (float)wr_hard_random(g);
        good = save_twice(g, "heights.png", heights, codes, err);
    }
    wr_free(heights);
    wr_free(codes);
    return good;
}

/* ---- edges of cells ---- */

/* The jump of Fu from one ulp before a cell's edge to one after, heights per texel. */
static bool hc54(WrHardMeasurement *g, WrError *err)
{
    static const WrScheme smooth[] = { WR_SCHEME_CENTRAL, WR_SCHEME_BSPLINE, WR_SCHEME_BSPLINE_FIT,
                                       WR_SCHEME_CATMULL };
    WrField *field = wr_hard_random_table(g, 32, 32, WR_WRAP_PERIODIC);
    bool good = true;
    for (int k = 0; k < 4 && good; k++) {
        WrHardLook look;
        good = wr_hard_look_init(g, &look, field, smooth[k], 1, 1, err);
        for (int i = 0; i < 32 * 8 && good; i++) {
            const double u = (i % 32 + 0.5) / 32;
            const float single = (float)u, v = wr_hard_float(g);
            WrHardSlope a = wr_hard_sample(field, smooth[k], nextafter(u, 0), (double)v);
            WrHardSlope b = wr_hard_sample(field, smooth[k], nextafter(u, 1), (double)v);
            wr_hard_near(g, WR_HARD_DOUBLE, a.fu / 32, b.fu / 32);
            for (int set = 0; set < g->sets; set++) {
                a = wr_hard_look_at(g, set, &look, nextafterf(single, 0), v);
                b = wr_hard_look_at(g, set, &look, nextafterf(single, 1), v);
                wr_hard_near(g, WR_HARD_FLOAT, a.fu / 32, b.fu / 32);
            }
        }
        if (good) wr_hard_look_fini(&look);
    }
    wr_field_free(field);
    return good;
}

#define ROW(number, situation, rule, u, in_float, in_double, script)                               \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_TABLE, .what = situation, .holds = rule, .unit = u, \
        .bound = { in_float, in_double }, .measure = hc##number, .scene = script                   \
    }
static const WrHardCase rows_limits[] = {
    ROW(49, "a NaN, infinite or largest height in a table",
        "NaN and infinity become 0 and are counted; the largest affects only the scheme's "
        "neighbourhood",
        "violations", 0, 0,
        "table 100x100\ngrid cells=8x8 width=2\ndab 0.5,0.5 radius=0.5 strength=3e38\nsurface "
        "plane"),
    ROW(50, "the largest height beside its negative", "F and its slopes stay finite", "violations",
        0, 0,
        "table 8x8\npattern checks across=8 rows=8 height=1e30\nsurface plane\nbump height=1e-30"),
    ROW(51, "heights of 8 bits",
        "slopes differ by up to the effect of half a code: terraces, which is why tables store "
        "floats",
        "n / 510", 1.001, 1 + 1e-6,
        "table 256x256\nformula fourier terms=1,0,0.5\nsurface plane\nbump height=0.2\n"
        "dials heights=8bit"),
    ROW(52, "heights of 16 bits", "heights to half a code, slopes within the effect of that",
        "n / 131070", 1.1, 1.01,
        "table 256x256\nformula fourier terms=1,0,0.5\nsurface plane\nbump height=0.2\n"
        "dials heights=16bit"),
    ROW(53, "16-bit heights written, read and written again", "the same bytes", "violations", 0,
        NAN, NULL),
    ROW(54, "a last place either side of a cell's edge",
        "slopes of all schemes but bilinear are continuous", "height a texel", 5e-5, 1e-13,
        "table 16x16\nnoise value cells=8\nsurface plane\nbump scheme=bilinear height=0.1"),
};
WR_HARD_LIST(limits, rows_limits);

/* ---- hardcases ends ---- */

/* Hard cases of HC156 and later: surfaces, tables and heights at the limits of their range, and light without a
   direction. */

/* ---- surfaces ---- */

/* A shallow dish; `how` selects the coincident control points: two at a corner along u, along v, three at the
   corner, two within an edge, two in the middle, four there. */
static WrShape coincident(int how)
{
    static const int pairs[6][3][2] = { { { 1, 0 } },           { { 4, 0 } },
                                        { { 1, 0 }, { 4, 0 } }, { { 2, 1 } },
                                        { { 6, 5 } },           { { 6, 5 }, { 9, 5 }, { 10, 5 } } };
    WrShape shape = wr_hard_shape(WR_SURFACE_bezier);
    for (int k = 0; k < 16; k++) {
        const double x = k % 4 / 3.0, y = k / 4 / 3.0;
        shape.value[3 * k] = x;
        shape.value[3 * k + 1] = y;
        shape.value[3 * k + 2] = 0.37 * (x * x + y * y);
    }
    for (int p = 0; p < 3; p++) {
        const int to = pairs[how][p][0], from = pairs[how][p][1];
        if (to != from) memcpy(shape.value + 3 * to, shape.value + 3 * from, 3 * sizeof(double));
    }
    return shape;
}

/* Along the diagonal n is continuous at the corner, in float and in double (the edges beside it have normals of
   their own); everywhere it has length 1 after perturbation. */
bool wr_hard_hc156(WrHardMeasurement *g, WrError *err)
{
    static const double near[] = { 0, 1e-30, 1e-7, 1e-5 };
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int how = 0; how < 6 && good; how++) {
        const WrShape shape = coincident(how);
        WrSurfacePoint beside;
        wr_surface_at(&shape, 0, 1e-4, 1e-4, &beside);
        for (int k = 0; k < 16; k++) {
            const double u = near[k % 4], v = near[k / 4];
            WrSurfacePoint at;
            wr_surface_at(&shape, 0, u, v, &at);
            const bool middle = k % 4 == k / 4;
            if (middle)
                wr_hard_holds(g, WR_HARD_DOUBLE, v3_angle_rad(at.n_unit, beside.n_unit) < 2e-3);
            wr_hard_holds(g, WR_HARD_DOUBLE, fabs(v3_len(at.n_unit) - 1.0) < 1e-14);
            for (int set = 0; set < g->all; set++) {
                const WrSurfacePointf atf =
                    wr_hard_point(g, set, &shape, 1.0, 0, (float)u, (float)v);
                if (middle)
                    wr_hard_holds(g, WR_HARD_FLOAT,
                                  v3_angle_rad(wr_hard_vec(atf.n_unit), beside.n_unit) < 2e-3);
                for (int mode = 0; mode < WR_BUMP_COUNT; mode++) {
                    const WrVec3 perturbed = wr_hard_bumped_normal_f(
                        g, set, (WrBumpMode)mode, &atf, (WrHardSlope){ 0.1, 2, -3 }, false);
                    wr_hard_holds(g, WR_HARD_FLOAT, fabs(v3_len(perturbed) - 1.0) < 1e-6);
                }
            }
        }
        WrScene *scene = wr_scene_new();
        scene->shape = shape;
        good = wr_hard_tame(g, field, scene, err);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* The hole closes to a point where Pu vanishes: beside it n points away from the tube's centre line, and
   perturbed normals have length 1 for any table. */
bool wr_hard_hc160(WrHardMeasurement *g, WrError *err)
{
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int i = 0; i < 40 && good; i++) {
        WrShape torus = wr_hard_shape(WR_SURFACE_torus);
        torus.value[0] = torus.value[1] = wr_hard_between(g, 0.2, 0.8);
        for (int k = -24; k <= 24; k++) {
            const double v = 0.5 + (k < 0 ? -ldexp(1.0, k) : k > 0 ? ldexp(1.0, -k) : 0.0) / 4;
            const float u = wr_hard_float(g), single = (float)v;
            const WrHardSlope slope = { 0, wr_hard_between(g, -4, 4), wr_hard_between(g, -4, 4) };
            double s, c, sp, cp;
            wr_sincos_turns((double)u, &s, &c);
            wr_sincos_turns((double)single, &sp, &cp);
            const WrVec3 want = { cp * c, cp * s, sp };
            for (int mode = 0; mode < WR_BUMP_COUNT; mode++) {
                WrSurfacePoint at;
                wr_surface_at(&torus, 0, (double)u, (double)single, &at);
                wr_hard_record_error(g, WR_HARD_DOUBLE, v3_angle_rad(at.n_unit, want));
                wr_hard_record_error(
                    g, WR_HARD_DOUBLE,
                    fabs(v3_len(wr_hard_bumped_normal((WrBumpMode)mode, &at, slope)) - 1.0));
                for (int set = 0; set < g->all; set++) {
                    const WrSurfacePointf atf = wr_hard_point(g, set, &torus, 1.0, 0, u, single);
                    const WrVec3 perturbed =
                        wr_hard_bumped_normal_f(g, set, (WrBumpMode)mode, &atf, slope, false);
                    wr_hard_record_error(g, WR_HARD_FLOAT,
                                         v3_angle_rad(wr_hard_vec(atf.n_unit), want));
                    wr_hard_record_error(g, WR_HARD_FLOAT, fabs(v3_len(perturbed) - 1.0));
                }
            }
        }
        if (i > 3) continue;
        WrScene *scene = wr_scene_new();
        scene->shape = torus;
        WrHardMeasurement quiet = *g; /* counts violations; here deviations are measured */
        good = wr_hard_tame(&quiet, field, scene, err);
        wr_hard_record_error(g, WR_HARD_FLOAT, good && quiet.worst[0] == g->worst[0] ? 0.0 : 1.0);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* Kernel results n and n' there: NaN light counts as none, so pictures would hide it. */
static void thin_point(WrHardMeasurement *g, int set, const WrScene *scene, WrHardSlope slope)
{
    const double unit = scalbn(1.0, -ilogb(wr_shape_radius(&scene->shape)));
    const WrSurfacePointf at =
        wr_hard_point(g, set, &scene->shape, unit, 0, wr_hard_float(g), wr_hard_float(g));
    const WrVec3 perturbed = wr_hard_bumped_normal_f(g, set, scene->bump, &at, slope, false);
    wr_hard_holds(g, WR_HARD_FLOAT, fabs(v3_len(wr_hard_vec(at.n_unit)) - 1.0) < 1e-5);
    wr_hard_holds(g, WR_HARD_FLOAT, fabs(v3_len(perturbed) - 1.0) < 1e-5);
}

/* Sides of 1e-30 beside others of 1: almost no area, and unbounded slopes per unit of length. */
bool wr_hard_hc161(WrHardMeasurement *g, WrError *err)
{
    static const struct {
        WrSurfaceKind kind;
        int side;
    } thin[] = { { WR_SURFACE_plane, 0 },    { WR_SURFACE_plane, 1 },  { WR_SURFACE_cylinder, 0 },
                 { WR_SURFACE_cylinder, 1 }, { WR_SURFACE_cone, 0 },   { WR_SURFACE_cone, 1 },
                 { WR_SURFACE_torus, 1 },    { WR_SURFACE_ribbon, 3 }, { WR_SURFACE_sphere, 0 } };
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < 9 * (WR_BUMP_COUNT - 1) && good; k++) {
        const int which = k % 9;
        WrScene *scene = wr_scene_new();
        scene->shape = wr_hard_shape(thin[which].kind);
        scene->shape.value[thin[which].side] = WR_LENGTH_MIN;
        scene->bump = (WrBumpMode)(WR_BUMP_BLINN + k / 9);
        scene->height = 0.1;
        good = wr_shape_check(&scene->shape, err) && wr_hard_tame(g, field, scene, err);
        for (int i = 0; i < 20 && good; i++) {
            WrSurfacePoint at;
            const WrHardSlope slope = { 0.1, wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1) };
            wr_surface_at(&scene->shape, 0, wr_hard_random(g), wr_hard_random(g), &at);
            const WrVec3 perturbed = wr_hard_bumped_normal(scene->bump, &at, slope);
            wr_hard_holds(g, WR_HARD_DOUBLE, fabs(v3_len(at.n_unit) - 1.0) < 1e-14);
            wr_hard_holds(g, WR_HARD_DOUBLE, fabs(v3_len(perturbed) - 1.0) < 1e-14);
            for (int set = 0; set < g->all; set++) thin_point(g, set, scene, slope);
        }
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* ---- tables ---- */

/* The table repeated to `across` and `down` times as many columns and rows: F is the same function. */
static WrField *repeated(const WrField *field, int across, int down)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    WrField *out =
        wr_field_new(w * across, h * down, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
    for (int j = 0; j < h * down; j++)
        for (int i = 0; i < w * across; i++)
            wr_field_set(out, i, j, wr_field_get(field, i % w, j % h));
    return out;
}

/* Tables of one row, one column and one texel, as pictures: equal to those of the table repeated to eight. */
bool wr_hard_hc157(WrHardMeasurement *g, WrError *err)
{
    static const int sizes[][2] = { { 1, 24 }, { 24, 1 }, { 1, 1 } };
    static const WrSurfaceKind kinds[] = { WR_SURFACE_sphere, WR_SURFACE_plane, WR_SURFACE_bent };
    bool good = true;
    for (int k = 0; k < 3 * WR_SCHEME_COUNT && good; k++) {
        const int w = sizes[k % 3][0], h = sizes[k % 3][1];
        WrField *thin = wr_hard_random_table(g, w, h, WR_WRAP_PERIODIC);
        WrField *wide = repeated(thin, w == 1 ? 8 : 1, h == 1 ? 8 : 1);
        WrScene *scene = wr_scene_new();
        scene->shape = wr_hard_shape(kinds[k / 3 % 3]);
        scene->scheme = (WrScheme)(k / 3);
        scene->height = 0.05;
        WrFrameRequest request = { .field = thin, .scene = scene, .width = 40, .height = 40 };
        WrReference thin_truth = { 0 }, wide_truth = { 0 };
        good = wr_hard_refer(g, &request, 1, &thin_truth, err);
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrHardShot a = { .renderer = NULL }, b = { .renderer = NULL };
            request.field = thin;
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &a, err);
            request.field = wide;
            good = good && wr_hard_shoot_by(g, &request, (WrHardWay)way, &b, err);
            if (good) wr_hard_holds(g, wr_hard_precision(way), wr_hard_differ(&a, &b, 2e-4) == 0);
            wr_hard_put_away(&a);
            wr_hard_put_away(&b);
        }
        good = good && wr_hard_refer(g, &request, 1, &wide_truth, err);
        for (int i = 0; i < 4 * 40 * 40 && good; i++)
            wr_hard_holds(g, WR_HARD_DOUBLE, fabs(thin_truth.rgba[i] - wide_truth.rgba[i]) < 1e-9);
        wr_reference_fini(&thin_truth);
        wr_reference_fini(&wide_truth);
        wr_scene_free(scene);
        wr_field_free(thin);
        wr_field_free(wide);
    }
    return good;
}

/* A layer added and an almost equal one subtracted: the result is the difference of two stored heights, which is
   exact at any level; in either order, above any layers. */
bool wr_hard_hc162(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    enum { COUNT = 512 };
    static const float levels[] = { 1, 1e3f, 1e6f, 1e30f, 3e38f };
    for (int k = 0; k < 5; k++) {
        float up[COUNT], down[COUNT], below[COUNT];
        for (int i = 0; i < COUNT; i++) {
            up[i] = levels[k] * (0.75f + 0.25f * wr_hard_float(g));
            down[i] = up[i] * (1.0f + 0x1p-20f * wr_hard_float(g));
            below[i] = 0.0f;
        }
        const WrBlendTile first = { .heights = up, .cover_level = 1, .mask_level = 1 };
        const WrBlendTile second = { .heights = down, .cover_level = 1, .mask_level = 1 };
        const bool added_first = k % 2 == 0;
        wr_blend_tile(added_first ? WR_BLEND_ADD : WR_BLEND_SUBTRACT, 1, 0,
                      added_first ? &first : &second, COUNT, below);
        wr_blend_tile(added_first ? WR_BLEND_SUBTRACT : WR_BLEND_ADD, 1, 0,
                      added_first ? &second : &first, COUNT, below);
        for (int i = 0; i < COUNT; i++)
            wr_hard_holds(g, WR_HARD_FLOAT, (double)below[i] == (double)up[i] - (double)down[i]);
    }
    return true;
}

/* Every operation on tables at both limits of float: heights stay finite, and a flat table of the largest height
   is unchanged by operations that do not affect flat areas. */
bool wr_hard_hc165(WrHardMeasurement *g, WrError *err)
{
    enum { WIDE = 80, HIGH = 70 }; /* crop limits itself to 64 */
    static const float ends[] = { FLT_MAX, -FLT_MAX, 1e-45f, -1e-45f, 0x1p-126f, -0.0f, 1e37f };
    bool good = true;
    for (int k = 0; k < wr_op_count * 3 && good; k++) {
        const WrOpInfo *op = &wr_ops[k / 3];
        const WrWrap wrap = k % 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC;
        WrField *field = wr_field_new(WIDE, HIGH, wrap, wrap, 0.0f, err);
        good = field != NULL;
        for (int i = 0; i < WIDE * HIGH && good; i++)
            wr_field_set(field, i % WIDE, i / WIDE, ends[(int)(7 * wr_hard_random(g))]);
        WrField *out = good ? wr_op_run(op, field, NULL, NULL, err) : NULL;
        good = out != NULL;
        for (int j = 0; good && j < wr_field_height(out); j++)
            for (int i = 0; i < wr_field_width(out); i++)
                wr_hard_holds(g, WR_HARD_FLOAT, isfinite(wr_field_get(out, i, j)));
        wr_field_free(out);
        wr_field_free(field);
    }
    return good;
}

/* +0 and -0 in one table: the picture of a flat table, to the bit. */
bool wr_hard_hc173(WrHardMeasurement *g, WrError *err)
{
    WrField *mixed = wr_field_new(24, 24, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, err);
    WrField *plain = wr_field_new(24, 24, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, err);
    bool good = mixed && plain;
    for (int i = 0; i < 24 * 24 && good; i++)
        wr_field_set(mixed, i % 24, i / 24, wr_hard_random(g) < 0.5 ? -0.0f : 0.0f);
    for (int k = 0; k < WR_SCHEME_COUNT * (WR_BUMP_COUNT - 1) && good; k++) {
        WrScene *scene = wr_scene_new();
        WrFrameRequest request = { .scene = scene, .width = 32, .height = 32, .full = true };
        scene->shape = wr_hard_shape(k % 2 ? WR_SURFACE_sphere : WR_SURFACE_torus);
        scene->scheme = (WrScheme)(k % WR_SCHEME_COUNT);
        scene->bump = (WrBumpMode)(WR_BUMP_BLINN + k / WR_SCHEME_COUNT);
        scene->height = k % 3 ? 1 : -1e30;
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrHardShot a = { .renderer = NULL }, b = { .renderer = NULL };
            request.field = mixed;
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &a, err);
            request.field = plain;
            good = good && wr_hard_shoot_by(g, &request, (WrHardWay)way, &b, err);
            if (good) wr_hard_holds(g, wr_hard_precision(way), wr_hard_differ(&a, &b, 0.0) == 0);
            wr_hard_put_away(&a);
            wr_hard_put_away(&b);
        }
        wr_scene_free(scene);
    }
    wr_field_free(mixed);
    wr_field_free(plain);
    return good;
}

/* Kernel fetches from it, scaled to float's maximum, are finite: an infinite slope has no direction. */
static bool look_stays_finite(WrHardMeasurement *g, const WrField *field, const WrScene *scene,
                              WrError *err)
{
    WrHardLook look;
    if (!wr_hard_look_init(g, &look, field, scene->scheme, 1, 1, err)) return false;
    look.look.scale_f = look.look.scale_u = (float)fmin(fabs(scene->height), (double)FLT_MAX);
    look.look.scale_v = -look.look.scale_u;
    for (int i = 0; i < 20 * g->all; i++) {
        const WrHardSlope s =
            wr_hard_look_at(g, i % g->all, &look, wr_hard_float(g), wr_hard_float(g));
        wr_hard_holds(g, WR_HARD_FLOAT, isfinite(s.f) && isfinite(s.fu) && isfinite(s.fv));
    }
    wr_hard_look_fini(&look);
    return true;
}

/* Heights of 1e30 in a table, with a height of 1e30 in the scene. */
bool wr_hard_hc175(WrHardMeasurement *g, WrError *err)
{
    static const double heights[] = { 1e30, -1e300, 1e-300 };
    WrField *field = wr_hard_waves(24, 24);
    for (int i = 0; i < 24 * 24; i++)
        wr_field_set(field, i % 24, i / 24, 1e30f * wr_field_get(field, i % 24, i / 24));
    bool good = true;
    for (int k = 0; k < WR_SCHEME_COUNT * (WR_BUMP_COUNT - 1) * 3 && good; k++) {
        WrScene *scene = wr_scene_new();
        scene->shape = wr_hard_shape((WrSurfaceKind)(k % WR_SURFACE_COUNT));
        scene->scheme = (WrScheme)(k % WR_SCHEME_COUNT);
        scene->bump = (WrBumpMode)(WR_BUMP_BLINN + k / WR_SCHEME_COUNT % (WR_BUMP_COUNT - 1));
        scene->height = heights[k / WR_SCHEME_COUNT / (WR_BUMP_COUNT - 1)];
        good = look_stays_finite(g, field, scene, err) && wr_hard_tame(g, field, scene, err);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* ---- light ---- */

/* Kernels with the lamp, and the eye, exactly at the lit point. */
static void touching(WrHardMeasurement *g)
{
    for (int k = 0; k < 40; k++) {
        const float hair = k % 4 ? ldexpf(1.0f, -20 * (k % 4) - k) : 0.0f;
        const float p[3] = { wr_hard_float(g), wr_hard_float(g), wr_hard_float(g) };
        const WrKernLight lamp = { .point = true,
                                   .where = { p[0], p[1], p[2] + hair },
                                   .rgb = { 1, 1, 1 } };
        const WrRays rays = { .perspective = true, .eye = { p[0], p[1], p[2] + hair } };
        for (int set = 0; set < g->all; set++) {
            WrStrip *s = g->strip;
            s->count = 1;
            s->px[0] = p[0], s->py[0] = p[1], s->pz[0] = p[2];
            s->bx[0] = s->by[0] = 0.0f, s->bz[0] = 1.0f;
            g->kernels[set]->view(&rays, s);
            g->kernels[set]->begin(0.0f, s);
            g->kernels[set]->light(&lamp, s);
            g->kernels[set]->diffuse(&lamp, 1.0f, s);
            g->kernels[set]->specular(&lamp, 1.0f, 20.0f, k % 2, s);
            wr_hard_holds(g, WR_HARD_FLOAT, s->dr[0] >= 0.0f && s->dr[0] <= 1.00001f);
            wr_hard_holds(g, WR_HARD_FLOAT, s->sr[0] >= 0.0f && s->sr[0] <= 1.00001f);
            wr_hard_holds(g, WR_HARD_FLOAT, isfinite(s->lx[0]) && isfinite(s->vz[0]));
        }
        const WrKernLightd wide = { .point = true,
                                    .where = { (double)p[0], (double)p[1],
                                               (double)p[2] + (double)hair },
                                    .rgb = { 1, 1, 1 } };
        for (int set = 0; set < 2; set++) {
            WrStripd *s = g->wide_strip;
            s->count = 1;
            s->px[0] = (double)p[0], s->py[0] = (double)p[1], s->pz[0] = (double)p[2];
            s->bx[0] = s->by[0] = 0.0, s->bz[0] = 1.0;
            g->wide[set]->begin(0.0, s);
            g->wide[set]->light(&wide, s);
            g->wide[set]->diffuse(&wide, 1.0, s);
            wr_hard_holds(g, WR_HARD_DOUBLE, s->dr[0] >= 0.0 && s->dr[0] <= 1.00001);
            wr_hard_holds(g, WR_HARD_DOUBLE, isfinite(s->lx[0]) && isfinite(s->lz[0]));
        }
    }
}

/* A lamp at a point of the surface, and one inside: the direction is undefined there, but every value is finite
   and within the light's range. */
bool wr_hard_hc159(WrHardMeasurement *g, WrError *err)
{
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    touching(g);
    for (int k = 0; k < 2 * WR_SURFACE_COUNT && good; k++) {
        WrScene *scene = wr_scene_new();
        WrSurfacePoint at;
        scene->shape = wr_hard_shape((WrSurfaceKind)(k / 2));
        scene->posed = scene->lights_given = true;
        scene->height = k % 2 ? 0.0 : 0.05;
        wr_surface_at(&scene->shape, 0, 0.5, 0.5, &at);
        const WrVec3 where = v3_sub(at.p, wr_shape_centre(&scene->shape));
        const double radius = wr_shape_radius(&scene->shape);
        scene->lights[0] = (WrLight){
            .kind = WR_LIGHT_POINT, .where = where, .colour = { 1, 1, 1 }, .strength = 1
        };
        scene->material = (WrMaterial){
            .diffuse = 1, .specular = 1, .shininess = 20, .colour = { 1, 1, 1 }, .gate = k % 2
        };
        /* straight towards it, so that the middle sample is at the lamp */
        scene->camera = (WrCamera){ .orthographic = true,
                                    .eye = v3_mad(where, at.n_unit, 3 * radius),
                                    .target = where,
                                    .up = { 0.3, 0.2, 0.9 },
                                    .size = k % 4 < 2 ? radius : 0.1 * radius };
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = 41, .height = 41
        };
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrHardShot shot = { .renderer = NULL };
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &shot, err);
            for (int i = 0; i < 41 * 41 * 4 && good; i++)
                wr_hard_holds(g, wr_hard_precision(way),
                              shot.frame.rgba[i] >= 0.0f && shot.frame.rgba[i] <= 2.00001f);
            wr_hard_put_away(&shot);
        }
        WrReference reference = { 0 };
        good = good && wr_hard_refer(g, &request, 1, &reference, err);
        for (int i = 0; i < 41 * 41 * 4 && good; i++)
            wr_hard_holds(g, WR_HARD_DOUBLE,
                          reference.rgba[i] >= 0.0 && reference.rgba[i] <= 2.00001);
        wr_reference_fini(&reference);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

static const double ends[] = { 0, 1, -0.0, 5, -3 };

/* Fetches by every scheme and kernel set, reduced in float and in double: calls `check` with each. */
typedef struct Looker {
    WrHardMeasurement *g;
    const WrField *field;
    const WrHardLook *look;
    WrScheme scheme;
    int set;
} Looker;
static bool each_look(WrHardMeasurement *g, const WrField *field, double ru, double rv,
                      void (*check)(const Looker *), WrError *err)
{
    for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++) {
        WrHardLook look;
        if (!wr_hard_look_init(g, &look, field, (WrScheme)scheme, ru, rv, err)) return false;
        for (int k = 0; k < 2 * g->sets; k++) {
            const Looker looker = { g, field, &look, (WrScheme)scheme, k / 2 };
            look.look.wide = k % 2 == 0;
            check(&looker);
        }
        wr_hard_look_fini(&look);
    }
    return true;
}
static WrHardSlope by_kernel(const Looker *l, float u, float v)
{
    return wr_hard_look_at(l->g, l->set, l->look, u, v);
}
static void same_f(const Looker *l, float u, float v, float other_u, float other_v)
{
    wr_hard_holds(l->g, WR_HARD_FLOAT,
                  wr_hard_same_slope(by_kernel(l, u, v), by_kernel(l, other_u, other_v)));
}
static void same_d(const Looker *l, double u, double v, double other_u, double other_v)
{
    if (l->set > 0) return;
    wr_hard_holds(l->g, WR_HARD_DOUBLE,
                  wr_hard_same_slope(wr_hard_sample(l->field, l->scheme, u, v),
                                     wr_hard_sample(l->field, l->scheme, other_u, other_v)));
}

static void check_ends(const Looker *l)
{
    const WrHardSlope zero = wr_hard_sample(l->field, l->scheme, 0, 0);
    for (int k = 0; k < 5; k++) {
        same_d(l, ends[k], ends[4 - k], 0, 0);
        same_f(l, (float)ends[k], (float)ends[4 - k], 0, 0);
        const WrHardSlope s = by_kernel(l, (float)ends[k], 0);
        const double off = fabs(s.fu - zero.fu) + fabs(s.fv - zero.fv);
        wr_hard_holds(l->g, WR_HARD_FLOAT, fabs(s.f - zero.f) < 1e-6 && off < 1e-3);
    }
    const float below = nextafterf(1, 0), above = nextafterf(1, 2);
    const WrHardSlope s = by_kernel(l, below, above);
    wr_hard_holds(l->g, WR_HARD_FLOAT, fabs(s.f) < 3.0 && isfinite(s.fu) && isfinite(s.fv));
    const int at = l->g->strip->at[0] - WR_APRON * l->look->look.pitch - WR_APRON;
    const int last = (wr_field_height(l->field) + 1) * l->look->look.pitch;
    wr_hard_holds(l->g, WR_HARD_FLOAT, at >= -l->look->look.pitch - 1 && at < last);
}

static bool hc35(WrHardMeasurement *g, WrError *err)
{
    static const int sizes[] = { 1, 3, 64, 100 };
    for (int n = 1; n < 5000; n++) {
        wr_hard_holds(g, WR_HARD_DOUBLE, floor(n * nextafter(1, 0)) < n);
        wr_hard_holds(g, WR_HARD_FLOAT, floorf((float)n * nextafterf(1, 0)) < (float)n);
    }
    bool good = true;
    for (int s = 0; s < 4 && good; s++) {
        WrField *field = wr_hard_random_table(g, sizes[s], sizes[s], WR_WRAP_PERIODIC);
        good = each_look(g, field, 1, 1, check_ends, err);
        wr_field_free(field);
    }
    return good;
}

/* |F(-e) - F(0)|, which may be as large as the largest slope times e; and if 1 - e differs from 1, |F(-e) - F(1
   - e)|. */
static void check_tiny(const Looker *l)
{
    static const double tiny[] = { -1e-9, -1e-17, -1e-300 };
    if (l->scheme == WR_SCHEME_NEAREST) return; /* its cells end at 0 */
    for (int k = 0; k < 3; k++) {
        const float t = (float)tiny[k];
        wr_hard_near(l->g, WR_HARD_FLOAT, by_kernel(l, t, 0.25f).f, by_kernel(l, 0, 0.25f).f);
        if (l->set > 0) continue;
        wr_hard_near(l->g, WR_HARD_DOUBLE, wr_hard_sample(l->field, l->scheme, tiny[k], 0.25).f,
                     wr_hard_sample(l->field, l->scheme, 0, 0.25).f);
    }
    for (int k = 1; k <= 20; k++) {
        const double e = ldexp(1.0, -k);
        const float t = (float)e;
        wr_hard_near(l->g, WR_HARD_FLOAT, by_kernel(l, -t, 0.25f).f,
                     by_kernel(l, 1.0f - t, 0.25f).f);
        wr_hard_near(l->g, WR_HARD_DOUBLE, wr_hard_sample(l->field, l->scheme, -e, 0.25).f,
                     wr_hard_sample(l->field, l->scheme, 1.0 - e, 0.25).f);
    }
}

static bool hc36(WrHardMeasurement *g, WrError *err)
{
    WrField *field = wr_hard_random_table(g, 64, 64, WR_WRAP_PERIODIC);
    const bool good = each_look(g, field, 1, 1, check_tiny, err);
    wr_field_free(field);
    return good;
}

static void check_wild(const Looker *l)
{
    static const double bad[] = { NAN, INFINITY, -INFINITY };
    for (int k = 0; k < 3; k++) {
        same_d(l, bad[k], 0.375, 0, 0.375);
        same_d(l, 0.375, bad[k], 0.375, 0);
        same_f(l, (float)bad[k], 0.375f, 0, 0.375f);
        same_f(l, 0.375f, (float)bad[k], 0.375f, 0);
    }
}

static bool hc37(WrHardMeasurement *g, WrError *err)
{
    WrField *field = wr_hard_random_table(g, 20, 30, WR_WRAP_PERIODIC);
    const bool good = each_look(g, field, 1, 1, check_wild, err);
    wr_field_free(field);
    return good;
}

static void check_half(const Looker *l)
{
    same_d(l, -0.5 / 64, -0.5 / 16, 1 - 0.5 / 64, 1 - 0.5 / 16);
    same_f(l, -0.5f / 64, -0.5f / 16, 1 - 0.5f / 64, 1 - 0.5f / 16);
}

static bool hc38(WrHardMeasurement *g, WrError *err)
{
    WrField *field = wr_hard_random_table(g, 64, 16, WR_WRAP_PERIODIC);
    const bool good = each_look(g, field, 1, 1, check_half, err);
    wr_field_free(field);
    return good;
}

/* Dyadic positions around the seams, so that u + 1/2 is exact; the table rolled by half in either direction. */
static bool hc39(WrHardMeasurement *g, WrError *err)
{
    WrField *field = wr_hard_random_table(g, 32, 64, WR_WRAP_PERIODIC);
    WrField *rolled = wr_hard_rolled(field, 16, 32);
    bool good = true;
    for (int scheme = 0; scheme < WR_SCHEME_COUNT && good; scheme++) {
        WrHardLook a, b;
        good = wr_hard_look_init(g, &a, field, (WrScheme)scheme, 1, 1, err);
        if (!good) break;
        good = wr_hard_look_init(g, &b, rolled, (WrScheme)scheme, 1, 1, err);
        for (int k = 0; k < 300 && good; k++) {
            const double u = floor(4096 * wr_hard_random(g)) / 65536 - 1.0 / 32;
            const double v = floor(4096 * wr_hard_random(g)) / 65536 - 1.0 / 32;
            wr_hard_holds(
                g, WR_HARD_DOUBLE,
                wr_hard_same_slope(wr_hard_sample(field, (WrScheme)scheme, u, v),
                                   wr_hard_sample(rolled, (WrScheme)scheme, u + 0.5, v + 0.5)));
            for (int set = 0; set < g->sets; set++) {
                const WrHardSlope here = wr_hard_look_at(g, set, &a, (float)u, (float)v);
                const WrHardSlope there =
                    wr_hard_look_at(g, set, &b, (float)u + 0.5f, (float)v + 0.5f);
                wr_hard_holds(g, WR_HARD_FLOAT, wr_hard_same_slope(here, there));
            }
        }
        wr_hard_look_fini(&a);
        if (good) wr_hard_look_fini(&b);
    }
    wr_field_free(field);
    wr_field_free(rolled);
    return good;
}

/* Deviation of the reduced position from r u mod 1, in texels of 64. r u is p + rest exactly. */
static double reduced_off(double u, double r, double got)
{
    const double p = r * u, rest = fma(r, u, -p);
    const double d = got - ((p - floor(p)) + rest);
    return fabs(64.0 * (d - rint(d)));
}

static bool hc40(WrHardMeasurement *g, WrError *err)
{
    static const double repeats[] = { 1e3, 1e5, 1e6, 1e7, 1e7 / 3.0, -1e7, 12345.678 };
    WrField *field = wr_hard_random_table(g, 64, 64, WR_WRAP_PERIODIC);
    bool good = true;
    for (int k = 0; k < 7 && good; k++) {
        WrHardLook look;
        good = wr_hard_look_init(g, &look, field, WR_SCHEME_BILINEAR, repeats[k], 1, err);
        for (int i = 0; i < 1000 && good; i++) {
            const double u = wr_hard_random(g);
            const float single = (float)u;
            wr_hard_record_error(g, WR_HARD_DOUBLE,
                                 reduced_off(u, repeats[k], wr_field_reduce(u, repeats[k])));
            for (int set = 0; set < g->sets; set++) {
                wr_hard_look_at(g, set, &look, single, 0.5f);
                wr_hard_record_error(
                    g, WR_HARD_FLOAT,
                    reduced_off((double)single, repeats[k], (double)g->strip->tu[0]));
            }
        }
        if (good) wr_hard_look_fini(&look);
    }
    wr_field_free(field);
    return good;
}

/* At k/128 with 0 repeats F is constant, with -1 it is mirrored, with a fractional r it is F at the fractional
   part of r u, r times as steep. Dyadic u, so that 1 - u and r u are exact. */
static void check_repeats(WrHardMeasurement *g, const WrField *field, const WrHardLook *plain,
                          const WrHardLook *turned, double r)
{
    for (int k = 1; k < 100; k++) {
        const float u = (float)k / 128;
        const double want = r * (double)u - floor(r * (double)u);
        wr_hard_holds(g, WR_HARD_DOUBLE, wr_field_reduce((double)u, r) == want);
        for (int set = 0; set < g->sets; set++) {
            const WrHardSlope a = wr_hard_look_at(g, set, turned, u, u);
            const WrHardSlope b = wr_hard_look_at(g, set, plain, (float)want, (float)want);
            const WrHardSlope c = wr_hard_sample(field, plain->scheme, want, want);
            wr_hard_holds(g, WR_HARD_FLOAT, a.f == b.f && fabs(a.f - c.f) < 1e-6);
            wr_hard_holds(g, WR_HARD_FLOAT, fabs(a.fu - r * b.fu) <= 1e-6 * fabs(r * b.fu));
            wr_hard_holds(g, WR_HARD_FLOAT, fabs(a.fv - r * b.fv) <= 1e-6 * fabs(r * b.fv));
            if (r == 0.0) wr_hard_holds(g, WR_HARD_FLOAT, a.fu == 0.0 && a.fv == 0.0);
        }
    }
}

static bool hc41(WrHardMeasurement *g, WrError *err)
{
    static const double repeats[] = { 0, -1, 0.5, 2.5, -2.25, 0.0078125, 77.125 };
    WrField *field = wr_hard_random_table(g, 64, 64, WR_WRAP_PERIODIC);
    bool good = true;
    for (int k = 0; k < WR_SCHEME_COUNT * 7 && good; k++) {
        const WrScheme scheme = (WrScheme)(k / 7);
        const double r = repeats[k % 7];
        WrHardLook turned, plain;
        good = wr_hard_look_init(g, &plain, field, scheme, 1, 1, err);
        if (!good) break;
        good = wr_hard_look_init(g, &turned, field, scheme, r, r, err);
        for (int wide = 0; wide < 2 && good; wide++) {
            turned.look.wide = wide;
            check_repeats(g, field, &plain, &turned, r);
        }
        if (good) wr_hard_look_fini(&turned);
        wr_hard_look_fini(&plain);
    }
    wr_field_free(field);
    return good;
}

/* On the centres of the first and last columns and rows, several periods away, the paper's slopes are the
   differences of the two neighbours, one of them at the table's other end. */
static void check_ends_of_rows(const Looker *l)
{
    const int w = wr_field_width(l->field), h = wr_field_height(l->field);
    if (l->scheme != WR_SCHEME_CENTRAL) return;
    for (int k = 0; k < 16; k++) {
        const int i = k % 2 ? w - 1 : 0, j = k / 2 % 2 ? h - 1 : 0, away = k / 4 - 2;
        const double u = (i + 0.5) / w + away, v = 1 - (j + 0.5) / h - away;
        const double right = (double)wr_field_get(l->field, (i + 1) % w, j);
        const double left = (double)wr_field_get(l->field, (i + w - 1) % w, j);
        const double up = (double)wr_field_get(l->field, i, (j + h - 1) % h);
        const double down = (double)wr_field_get(l->field, i, (j + 1) % h);
        const double fu = w / 2.0 * (right - left), fv = h / 2.0 * (up - down);
        const WrHardSlope d = wr_hard_sample(l->field, l->scheme, u, v);
        const WrHardSlope f = by_kernel(l, (float)u, (float)v);
        wr_hard_holds(l->g, WR_HARD_DOUBLE,
                      fabs(d.fu - fu) < 1e-8 * w && fabs(d.fv - fv) < 1e-8 * h);
        if (w < 1000) /* else float cannot resolve the texel */
            wr_hard_holds(l->g, WR_HARD_FLOAT,
                          fabs(f.fu - fu) < 1e-3 * w && fabs(f.fv - fv) < 1e-3 * h);
    }
}

/* Positions that are multiples of 2^-15, so that u + 7 is exact in float as well. */
static void check_modulus(const Looker *l)
{
    for (int k = 0; k < 60; k++) {
        const double u = floor(0x1p15 * wr_hard_random(l->g)) * 0x1p-15, v = k / 64.0;
        same_d(l, u + 7, v - 1000, u, v);
        same_d(l, u - 41, v + 1, u, v);
        same_f(l, (float)u + 7, (float)v - 100, (float)u, (float)v);
        same_f(l, (float)u - 41, (float)v + 1, (float)u, (float)v);
    }
}

static bool hc46(WrHardMeasurement *g, WrError *err)
{
    static const int sizes[][2] = { { 3, 3 }, { 48, 100 }, { 64, 64 }, { 16383, 1 } };
    bool good = true;
    for (int s = 0; s < 4 && good; s++) {
        WrField *field = wr_hard_random_table(g, sizes[s][0], sizes[s][1], WR_WRAP_PERIODIC);
        good = each_look(g, field, 1, 1, check_modulus, err) &&
               each_look(g, field, 1, 1, check_ends_of_rows, err);
        wr_field_free(field);
    }
    return good;
}

/* Flat along u (and v): exactly 0 at any level. */
static void check_flat_u(const Looker *l)
{
    for (int k = 0; k < 40; k++) {
        const float u = wr_hard_float(l->g), v = wr_hard_float(l->g);
        wr_hard_holds(l->g, WR_HARD_FLOAT, by_kernel(l, u, v).fu == 0.0);
        wr_hard_holds(l->g, WR_HARD_DOUBLE,
                      wr_hard_sample(l->field, l->scheme, (double)u, (double)v).fu == 0.0);
    }
}
static void check_flat_v(const Looker *l)
{
    for (int k = 0; k < 40; k++) {
        const float u = wr_hard_float(l->g), v = wr_hard_float(l->g);
        wr_hard_holds(l->g, WR_HARD_FLOAT, by_kernel(l, u, v).fv == 0.0);
        wr_hard_holds(l->g, WR_HARD_DOUBLE,
                      wr_hard_sample(l->field, l->scheme, (double)u, (double)v).fv == 0.0);
    }
}

static bool flat_both(WrHardMeasurement *g, int w, int h, bool along_u, bool along_v, WrError *err)
{
    bool good = true;
    for (int wrap = 0; wrap < 2 && good; wrap++) {
        WrField *field = wr_hard_random_table(g, w, h, wrap ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC);
        if (along_u) good = each_look(g, field, 1, 1, check_flat_u, err);
        if (along_v && good) good = each_look(g, field, 1, 1, check_flat_v, err);
        wr_field_free(field);
    }
    return good;
}

static bool hc42(WrHardMeasurement *g, WrError *err)
{
    return flat_both(g, 1, 1, true, true, err);
}

static bool hc43(WrHardMeasurement *g, WrError *err)
{
    return flat_both(g, 1, 9, true, false, err) && flat_both(g, 9, 1, false, true, err);
}

static void check_two(const Looker *l)
{
    if (l->scheme == WR_SCHEME_CENTRAL || l->scheme == WR_SCHEME_NEAREST) check_flat_u(l);
    if (l->scheme != WR_SCHEME_BILINEAR) return;
    const float u = 0.3f, v = wr_hard_float(l->g);
    wr_hard_holds(l->g, WR_HARD_FLOAT, by_kernel(l, u, v).fu != 0.0);
    wr_hard_holds(l->g, WR_HARD_DOUBLE,
                  wr_hard_sample(l->field, l->scheme, (double)u, (double)v).fu != 0.0);
}

static bool hc44(WrHardMeasurement *g, WrError *err)
{
    WrField *field = wr_hard_random_table(g, 2, 9, WR_WRAP_PERIODIC);
    const bool good = each_look(g, field, 1, 1, check_two, err);
    wr_field_free(field);
    return good;
}

static void check_board(const Looker *l)
{
    if (l->scheme == WR_SCHEME_CENTRAL) {
        check_flat_u(l);
        check_flat_v(l);
    }
    if (l->scheme != WR_SCHEME_BILINEAR) return;
    /* halfway between two rows' centres the effect is 0; on a row's centre it is full */
    const float u = 0.03125f * 3, v = 1 - 0.5f / 16;
    wr_hard_holds(l->g, WR_HARD_FLOAT, fabs(fabs(by_kernel(l, u, v).fu) - 16) < 1e-4);
    wr_hard_holds(l->g, WR_HARD_DOUBLE,
                  fabs(fabs(wr_hard_sample(l->field, l->scheme, (double)u, (double)v).fu) - 16) <
                      1e-12);
}

static bool hc45(WrHardMeasurement *g, WrError *err)
{
    WrField *field = wr_field_new(16, 16, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, err);
    if (!field) return false;
    for (int j = 0; j < 16; j++)
        for (int i = 0; i < 16; i++) wr_field_set(field, i, j, (float)((i + j) % 2));
    const bool good = each_look(g, field, 1, 1, check_board, err);
    wr_field_free(field);
    return good;
}

static const WrHardCase rows_table[] = {
    ROW(35, "u at 0, at 1, next to them, and -0", "indices stay in the table; 1 is 0 to the bit",
        "violations", 0, 0, "table 64x64\nnoise perlin cells=8\nsurface cylinder"),
    ROW(36, "u just below 0, down to values that 1 - u cannot represent",
        "F there is F(0) to slope times u", "height", 1e-6, 1e-7, NULL),
    ROW(37, "u infinite or NaN", "it counts as 0, to the bit", "violations", 0, 0, NULL),
    ROW(38, "half a texel below 0", "equals half a texel below 1, to the bit", "violations", 0, 0,
        NULL),
    ROW(39, "the first and last cells", "those of the table rolled by half, to the bit",
        "violations", 0, 0, "table 32x64\nnoise perlin cells=8\nsurface cylinder"),
    ROW(40, "a thousand to ten million repeats, whole and broken",
        "the position in the table is right", "texels", 1e-3, 1e-3,
        "table 64x64\ngrid cells=8x8 width=2\nsurface plane\nreplicate 1e6,1e6\nbump height=1e-8"),
    ROW(41, "repeats of 0, of -1, and broken ones",
        "0 is level, -1 the mirror image, r broken ones r times as steep at the broken part of r u",
        "violations", 0, 0, "table 64x64\nnoise perlin cells=4\nsurface plane\nreplicate -1,0"),
    ROW(42, "a table of one texel", "no slope, to the bit", "violations", 0, 0,
        "table 1x1\nfill 1\nsurface sphere"),
    ROW(43, "a table of one row or column", "no slope across it, to the bit", "violations", 0, 0,
        "table 1x16\ndab 0.5,0.5 radius=3 strength=1\nsurface sphere\nbump height=0.5"),
    ROW(44, "a table two texels wide",
        "the paper's difference across it is 0 to the bit; bilinear has its slope", "violations", 0,
        0, "table 2x16\ndab 0.25,0.5 radius=1 strength=1\nsurface plane\nbump scheme=bilinear"),
    ROW(45, "a checkerboard of single texels",
        "the paper's difference is 0, to the bit; bilinear has its slopes", "violations", 0, 0,
        "table 16x16\npattern checks across=16 rows=16 bevel=0\nsurface plane\nbump "
        "scheme=bilinear"),
    ROW(46, "sizes that are no power of two, up to 16383", "true modulus, to the bit", "violations",
        0, 0,
        "table 3x100\nformula fourier terms=1,4,0.5\nsurface torus\nreplicate 5,3\nbump "
        "height=0.3"),
};
WR_HARD_LIST(table, rows_table);
