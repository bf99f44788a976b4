/* Hard cases of heights: extreme ones, integer ones, and edges of cells. */
#include "hardcases/hardcases_look.h"
#include "field/scheme_list.h"

#include "base/error.h"
#include "base/memory.h"
#include "field/field.h"
#include "image/image.h"

#include <float.h>
#include <string.h>

/* One texel at float's maximum: outside the scheme's reach not a bit differs. */
static bool hc49(WrHardGauge *g, WrError *err)
{
    WrField *field = wr_hard_rough(g, 100, 100, WR_WRAP_PERIODIC), *spoilt = wr_field_share(field);
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

static bool hc50(WrHardGauge *g, WrError *err)
{
    bool good = true;
    for (int wrap = 0; wrap < 2 && good; wrap++) {
        WrField *field = wr_hard_rough(g, 8, 8, wrap ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC);
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
static bool quantised(WrHardGauge *g, WrPixelType type, WrError *err)
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
        wr_hard_off(g, WR_HARD_DOUBLE, worst * 2.0 * last);
        good = wr_hard_look_init(g, &look, coarse, WR_SCHEME_CENTRAL, 1, 1, err);
        for (int k = 0; k < 400 && good; k++) {
            const float u = wr_hard_float(g), v = wr_hard_float(g);
            const double want = wr_hard_sample(field, WR_SCHEME_CENTRAL, (double)u, (double)v).fu;
            const double got = wr_hard_sample(coarse, WR_SCHEME_CENTRAL, (double)u, (double)v).fu;
            wr_hard_off(g, WR_HARD_DOUBLE, fabs(got - want) / quantum);
            for (int set = 0; set < g->sets; set++)
                wr_hard_off(g, WR_HARD_FLOAT,
                            fabs(wr_hard_look_at(g, set, &look, u, v).fu - want) / quantum);
        }
        if (good) wr_hard_look_fini(&look);
        wr_field_free(field);
        wr_field_free(coarse);
    }
    return good;
}

static bool hc51(WrHardGauge *g, WrError *err)
{
    return quantised(g, WR_PIXEL_U8, err);
}

static bool hc52(WrHardGauge *g, WrError *err)
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
static bool save_twice(WrHardGauge *g, const char *name, const float *heights, uint16_t *codes,
                       WrError *err)
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
static bool hc53(WrHardGauge *g, WrError *err)
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
static bool hc54(WrHardGauge *g, WrError *err)
{
    static const WrScheme smooth[] = { WR_SCHEME_CENTRAL, WR_SCHEME_BSPLINE, WR_SCHEME_BSPLINE_FIT,
                                       WR_SCHEME_CATMULL };
    WrField *field = wr_hard_rough(g, 32, 32, WR_WRAP_PERIODIC);
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
static const WrHardCase rows[] = {
    ROW(49, "a NaN, infinite or largest height in a table",
        "NaN and infinity become 0 and are counted; the largest spoils the scheme's reach alone",
        "violations", 0, 0,
        "table 100x100\ngrid cells=8x8 width=2\ndab 0.5,0.5 radius=0.5 strength=3e38\nsurface "
        "plane"),
    ROW(50, "the largest height beside its negative", "F and its slopes stay finite", "violations",
        0, 0,
        "table 8x8\npattern checks across=8 rows=8 height=1e30\nsurface plane\nbump height=1e-30"),
    ROW(51, "heights of 8 bits",
        "slopes are off by as much as half a code can do: terraces, so tables hold floats",
        "n / 510", 1.001, 1 + 1e-6,
        "table 256x256\nformula fourier terms=1,0,0.5\nsurface plane\nbump height=0.2\n"
        "dials heights=8bit"),
    ROW(52, "heights of 16 bits", "heights to half a code, slopes by what that can do",
        "n / 131070", 1.1, 1.01,
        "table 256x256\nformula fourier terms=1,0,0.5\nsurface plane\nbump height=0.2\n"
        "dials heights=16bit"),
    ROW(53, "16-bit heights written, read and written again", "the same bytes", "violations", 0,
        NAN, NULL),
    ROW(54, "a last place either side of a cell's edge",
        "slopes of all schemes but bilinear are continuous", "height a texel", 5e-5, 1e-13,
        "table 16x16\nnoise value cells=8\nsurface plane\nbump scheme=bilinear height=0.1"),
};
WR_HARD_LIST(limits, rows);
