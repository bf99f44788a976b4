/* Hard cases of fetching from the table: ends, wraps, repeats, odd sizes. */
#include "hardcases/hardcases_look.h"
#include "field/scheme_list.h"

#include "base/error.h"
#include "field/field.h"

#include <float.h>

static const double ends[] = { 0, 1, -0.0, 5, -3 };

/* Fetches by every scheme and kernel set, reduced in float and in double: calls `check` with each. */
typedef struct Looker {
    WrHardGauge *g;
    const WrField *field;
    const WrHardLook *look;
    WrScheme scheme;
    int set;
} Looker;
static bool each_look(WrHardGauge *g, const WrField *field, double ru, double rv,
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

static bool hc35(WrHardGauge *g, WrError *err)
{
    static const int sizes[] = { 1, 3, 64, 100 };
    for (int n = 1; n < 5000; n++) {
        wr_hard_holds(g, WR_HARD_DOUBLE, floor(n * nextafter(1, 0)) < n);
        wr_hard_holds(g, WR_HARD_FLOAT, floorf((float)n * nextafterf(1, 0)) < (float)n);
    }
    bool good = true;
    for (int s = 0; s < 4 && good; s++) {
        WrField *field = wr_hard_rough(g, sizes[s], sizes[s], WR_WRAP_PERIODIC);
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

static bool hc36(WrHardGauge *g, WrError *err)
{
    WrField *field = wr_hard_rough(g, 64, 64, WR_WRAP_PERIODIC);
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

static bool hc37(WrHardGauge *g, WrError *err)
{
    WrField *field = wr_hard_rough(g, 20, 30, WR_WRAP_PERIODIC);
    const bool good = each_look(g, field, 1, 1, check_wild, err);
    wr_field_free(field);
    return good;
}

static void check_half(const Looker *l)
{
    same_d(l, -0.5 / 64, -0.5 / 16, 1 - 0.5 / 64, 1 - 0.5 / 16);
    same_f(l, -0.5f / 64, -0.5f / 16, 1 - 0.5f / 64, 1 - 0.5f / 16);
}

static bool hc38(WrHardGauge *g, WrError *err)
{
    WrField *field = wr_hard_rough(g, 64, 16, WR_WRAP_PERIODIC);
    const bool good = each_look(g, field, 1, 1, check_half, err);
    wr_field_free(field);
    return good;
}

/* Dyadic positions around the seams, so that u + 1/2 is exact; the table rolled by half in either direction. */
static bool hc39(WrHardGauge *g, WrError *err)
{
    WrField *field = wr_hard_rough(g, 32, 64, WR_WRAP_PERIODIC);
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

static bool hc40(WrHardGauge *g, WrError *err)
{
    static const double repeats[] = { 1e3, 1e5, 1e6, 1e7, 1e7 / 3.0, -1e7, 12345.678 };
    WrField *field = wr_hard_rough(g, 64, 64, WR_WRAP_PERIODIC);
    bool good = true;
    for (int k = 0; k < 7 && good; k++) {
        WrHardLook look;
        good = wr_hard_look_init(g, &look, field, WR_SCHEME_BILINEAR, repeats[k], 1, err);
        for (int i = 0; i < 1000 && good; i++) {
            const double u = wr_hard_random(g);
            const float single = (float)u;
            wr_hard_off(g, WR_HARD_DOUBLE,
                        reduced_off(u, repeats[k], wr_field_reduce(u, repeats[k])));
            for (int set = 0; set < g->sets; set++) {
                wr_hard_look_at(g, set, &look, single, 0.5f);
                wr_hard_off(g, WR_HARD_FLOAT,
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
static void check_repeats(WrHardGauge *g, const WrField *field, const WrHardLook *plain,
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

static bool hc41(WrHardGauge *g, WrError *err)
{
    static const double repeats[] = { 0, -1, 0.5, 2.5, -2.25, 0.0078125, 77.125 };
    WrField *field = wr_hard_rough(g, 64, 64, WR_WRAP_PERIODIC);
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

static bool hc46(WrHardGauge *g, WrError *err)
{
    static const int sizes[][2] = { { 3, 3 }, { 48, 100 }, { 64, 64 }, { 16383, 1 } };
    bool good = true;
    for (int s = 0; s < 4 && good; s++) {
        WrField *field = wr_hard_rough(g, sizes[s][0], sizes[s][1], WR_WRAP_PERIODIC);
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

static bool flat_both(WrHardGauge *g, int w, int h, bool along_u, bool along_v, WrError *err)
{
    bool good = true;
    for (int wrap = 0; wrap < 2 && good; wrap++) {
        WrField *field = wr_hard_rough(g, w, h, wrap ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC);
        if (along_u) good = each_look(g, field, 1, 1, check_flat_u, err);
        if (along_v && good) good = each_look(g, field, 1, 1, check_flat_v, err);
        wr_field_free(field);
    }
    return good;
}

static bool hc42(WrHardGauge *g, WrError *err)
{
    return flat_both(g, 1, 1, true, true, err);
}

static bool hc43(WrHardGauge *g, WrError *err)
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

static bool hc44(WrHardGauge *g, WrError *err)
{
    WrField *field = wr_hard_rough(g, 2, 9, WR_WRAP_PERIODIC);
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

static bool hc45(WrHardGauge *g, WrError *err)
{
    WrField *field = wr_field_new(16, 16, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, err);
    if (!field) return false;
    for (int j = 0; j < 16; j++)
        for (int i = 0; i < 16; i++) wr_field_set(field, i, j, (float)((i + j) % 2));
    const bool good = each_look(g, field, 1, 1, check_board, err);
    wr_field_free(field);
    return good;
}

#define ROW(number, situation, rule, u, in_float, in_double, script)                               \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_TABLE, .what = situation, .holds = rule, .unit = u, \
        .bound = { in_float, in_double }, .measure = hc##number, .scene = script                   \
    }
static const WrHardCase rows[] = {
    ROW(35, "u at 0, at 1, beside them, and -0", "indices stay in the table; 1 is 0 to the bit",
        "violations", 0, 0, "table 64x64\nnoise perlin cells=8\nsurface cylinder"),
    ROW(36, "u just below 0, down to what 1 - u cannot show", "F there is F(0) to slope times u",
        "height", 1e-6, 1e-7, NULL),
    ROW(37, "u infinite or NaN", "it counts as 0, to the bit", "violations", 0, 0, NULL),
    ROW(38, "half a texel below 0", "equals half a texel below 1, to the bit", "violations", 0, 0,
        NULL),
    ROW(39, "the first and last cells", "those of the table rolled by half, to the bit",
        "violations", 0, 0, "table 32x64\nnoise perlin cells=8\nsurface cylinder"),
    ROW(40, "a thousand to ten million repeats, whole and broken",
        "the place in the table is right", "texels", 1e-3, 1e-3,
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
        "the paper's difference does not see it, to the bit; bilinear does", "violations", 0, 0,
        "table 16x16\npattern checks across=16 rows=16 bevel=0\nsurface plane\nbump "
        "scheme=bilinear"),
    ROW(46, "sizes that are no power of two, up to 16383", "true modulus, to the bit", "violations",
        0, 0,
        "table 3x100\nformula fourier terms=1,4,0.5\nsurface torus\nreplicate 5,3\nbump "
        "height=0.3"),
};
WR_HARD_LIST(table, rows);
