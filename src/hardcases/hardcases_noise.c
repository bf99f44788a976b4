/* Hard cases of single noises: lattice points, far and negative positions, hashes, faces of simplices. */
#include "base/error.h"
#include "hardcases/hardcases_internal.h"
#include "noise/texel_grid.h"
#include "noise/noise.h"
#include "noise/octaves.h"
#include "render/textures/solid_texture_setup.h"
#include "shade/solid_texture.h"

#include <string.h>

/* ---- hardcases octaves ---- */

/* Hard cases of sums of noise: octaves too fine for the table, divergent sums, creases, tiling. */

/* Number of octaves whose cells are at least two texels, counted one by one. */
static int fitting(double cells, double step, int texels)
{
    int count = 0;
    while (count < WR_OCTAVES_MAX && cells <= texels / 2.0) {
        count++;
        cells *= step;
    }
    return count;
}

static bool hc62(WrHardMeasurement *g, WrError *err)
{
    static const int sizes[] = { 1, 2, 16, 64, 100, 512, 4096 };
    static const double steps[] = { 2, 3, 1.5 };
    for (int k = 0; k < 7 * 3 * 6; k++) {
        const int texels[2] = { sizes[k % 7], sizes[k % 7] };
        WrOctaves octaves = wr_octaves_default(2);
        octaves.tile = false;
        octaves.step = steps[k / 7 % 3];
        octaves.count = WR_OCTAVES_MAX;
        octaves.cells[0] = octaves.cells[1] = 1 << (k / 21);
        WrOctavesPlan plan;
        if (!wr_octaves_plan(&octaves, texels, &plan, err)) return false;
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      plan.used == fitting(octaves.cells[0], octaves.step, texels[0]));
    }
    return true;
}

/* One cell of Perlin noise per texel, texel centres on the lattice: the result is 0. */
static bool hc63(WrHardMeasurement *g, WrError *err)
{
    const double offset[2] = { 0.5, 0.5 };
    WrOctaves octaves = wr_octaves_default(2);
    WrOctavesPlan plan;
    octaves.count = 1;
    octaves.cells[0] = octaves.cells[1] = 64;
    octaves.offsets = offset;
    if (!wr_octaves_plan(&octaves, NULL, &plan, err)) return false;
    static float f[64 * 64];
    const WrNoiseGrid grid = { 64, 64, 0, 0, 64, 64 };
    wr_octaves_grid(&plan, &grid, f, NULL, NULL, 64);
    for (int k = 0; k < 64 * 64; k++) {
        const double p[2] = { (k % 64 + 0.5) / 64, 1 - (k / 64 + 0.5) / 64 };
        wr_hard_near(g, WR_HARD_FLOAT, (double)f[k], 0.0);
        wr_hard_near(g, WR_HARD_DOUBLE, wr_octaves_at(&plan, p, NULL), 0.0);
    }
    return true;
}

static bool hc64(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const struct {
        int count;
        double ratio, step;
        bool good;
    } sums[] = { { 1, 2, 2, true },    { 32, 2, 2, true },       { 0, 2, 2, false },
                 { 64, 2, 2, false },  { 1000000, 2, 2, false }, { 4, 1, 2, false },
                 { 4, 0.5, 2, false }, { 4, 2, 1, false },       { 4, 2, -3, false },
                 { 4, NAN, 2, false }, { 4, 2, INFINITY, false } };
    for (size_t k = 0; k < sizeof sums / sizeof *sums; k++) {
        WrOctaves octaves = wr_octaves_default(2);
        octaves.count = sums[k].count;
        octaves.ratio = sums[k].ratio;
        octaves.step = sums[k].step;
        WrOctavesPlan plan;
        WrError why = { "" };
        const bool done = wr_octaves_plan(&octaves, NULL, &plan, &why);
        wr_hard_holds(g, WR_HARD_DOUBLE, done == sums[k].good && (done || why.text[0] != '\0'));
        const double p[2] = { wr_hard_random(g), wr_hard_random(g) };
        if (done) wr_hard_holds(g, WR_HARD_DOUBLE, isfinite(wr_octaves_at(&plan, p, NULL)));
    }
    return true;
}

/* At lattice points Perlin noise is 0 with a slope: |f| has a crease there, whose slope counts as 0. */
static bool hc65(WrHardMeasurement *g, WrError *err)
{
    WrOctaves octaves = wr_octaves_default(2);
    octaves.mode = WR_OCTAVES_TURBULENCE;
    octaves.count = 1;
    octaves.scatter = false;
    octaves.cells[0] = octaves.cells[1] = 8;
    WrOctavesPlan plan;
    if (!wr_octaves_plan(&octaves, NULL, &plan, err)) return false;
    for (int k = 0; k < 64; k++) {
        const double p[2] = { k % 8 / 8.0, k / 8 / 8.0 };
        double slope[2];
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      wr_octaves_at(&plan, p, slope) == 0.0 && slope[0] == 0.0 && slope[1] == 0.0);
        const double beside[2] = { p[0] + 1e-9, p[1] + 1e-9 };
        const double f = wr_octaves_at(&plan, beside, slope);
        wr_hard_holds(g, WR_HARD_DOUBLE, f >= 0.0 && isfinite(slope[0]) && isfinite(slope[1]));
    }
    return true;
}

/* Any step tiles: one period further the value is equal to the bit, at positions where u + 1 is exact; and one
   ulp before its end the noise is continuous. */
static bool hc68(WrHardMeasurement *g, WrError *err)
{
    static const double steps[] = { 2, 1.99, 1.5, 3 };
    for (int k = 0; k < 4; k++) {
        WrOctaves octaves = wr_octaves_default(2);
        octaves.step = steps[k];
        WrOctavesPlan plan;
        if (!wr_octaves_plan(&octaves, NULL, &plan, err)) return false;
        for (int i = 0; i < 200; i++) {
            const double u = wr_hard_float(g), v = wr_hard_float(g);
            const double here[2] = { u, v }, on[2] = { u + 1, v - 3 };
            wr_hard_holds(g, WR_HARD_DOUBLE,
                          wr_octaves_at(&plan, here, NULL) == wr_octaves_at(&plan, on, NULL));
            const double end[2] = { i % 2 ? 0 : u, i % 2 ? v : 0 };
            const double near[2] = { i % 2 ? 1 - 1e-12 : u, i % 2 ? v : 1 - 1e-12 };
            wr_hard_holds(g, WR_HARD_DOUBLE,
                          fabs(wr_octaves_at(&plan, near, NULL) - wr_octaves_at(&plan, end, NULL)) <
                              1e-8);
        }
    }
    return true;
}

#define ROW(number, situation, rule, u, in_float, in_double, script)                               \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_NOISE, .what = situation, .holds = rule, .unit = u, \
        .bound = { in_float, in_double }, .measure = hc##number, .scene = script                   \
    }
static const WrHardCase sums[] = {
    ROW(62, "octaves with cells smaller than two texels", "they are dropped, and no others",
        "violations", NAN, 0,
        "table 32x32\nnoise perlin cells=4 octaves=12\nsurface plane\nbump height=0.1"),
    ROW(63, "a cell of noise for each texel", "Perlin noise adds nothing there", "height", 1e-6, 0,
        NULL),
    ROW(64, "no octaves, a million octaves, sums that do not converge",
        "refused with a message; accepted input is finite", "violations", NAN, 0, NULL),
    ROW(65, "turbulence where the noise is 0", "its slope counts as 0 there and is finite",
        "violations", NAN, 0,
        "table 128x128\nnoise perlin cells=4 mode=turbulence\nsurface plane\nbump height=0.1"),
};
WR_HARD_LIST(octaves, sums);

static const WrHardCase tiled[] = {
    ROW(68, "sums whose step is whole, and 1.99", "they tile, to the bit", "violations", NAN, 0,
        "table 128x128\nnoise perlin cells=4 step=1.99\nsurface plane\nreplicate 2,2\n"
        "bump height=0.05"),
};
WR_HARD_LIST(tiling, tiled);

/* ---- Hard cases of solid textures ---- */

/* A pattern in each precision, with colours 0 and 1: its value at p. */
static WrSolidTexture bare(WrSolidTextureKind kind)
{
    WrSolidTexture grain = wr_grains[kind].usual;
    for (int c = 0; c < 3; c++) grain.light[c] = 0, grain.dark[c] = 1;
    return grain;
}

/* A pixel: its steps to the right and down, with parallel rays along z. */
typedef struct Pixel {
    double right[3], down[3];
} Pixel;

static double in_float(WrHardMeasurement *g, int set, const WrKernGraind *of, WrVec3 p,
                       const Pixel *px)
{
    WrStrip *s = g->strip;
    WrKernGrain grain;
    WrRays rays = { .d0 = { 0, 0, -1 }, .toward = { 0, 0, 1 } };
    wr_solid_texture_kern_narrow(of, &grain);
    for (int c = 0; c < 3 && px; c++)
        rays.qx[c] = (float)px->right[c], rays.qy[c] = (float)px->down[c];
    s->count = 1;
    s->x[0] = s->y[0] = 0, s->nx[0] = s->ny[0] = 0, s->nz[0] = 1;
    s->px[0] = (float)p.x, s->py[0] = (float)p.y, s->pz[0] = (float)p.z;
    g->kernels[set]->grain(&rays, &grain, false, s);
    return (double)s->cr[0];
}

static double in_double(WrHardMeasurement *g, int set, const WrKernGraind *of, WrVec3 p,
                        const Pixel *px)
{
    WrStripd *s = g->wide_strip;
    WrRaysd rays = { .d0 = { 0, 0, -1 }, .toward = { 0, 0, 1 } };
    for (int c = 0; c < 3 && px; c++) rays.qx[c] = px->right[c], rays.qy[c] = px->down[c];
    s->count = 1;
    s->x[0] = s->y[0] = 0, s->nx[0] = s->ny[0] = 0, s->nz[0] = 1;
    s->px[0] = p.x, s->py[0] = p.y, s->pz[0] = p.z;
    g->wide[set]->grain(&rays, of, false, s);
    return s->cr[0];
}

/* Both precisions with every set: `want`, each deviation times `by`. */
static void near_all(WrHardMeasurement *g, const WrKernGraind *of, WrVec3 p, const Pixel *px,
                     double want, double by)
{
    for (int set = 0; set < g->sets; set++)
        wr_hard_near(g, WR_HARD_FLOAT, by * in_float(g, set, of, p, px), by * want);
    for (int set = 0; set < 2; set++)
        wr_hard_near(g, WR_HARD_DOUBLE, in_double(g, set, of, p, px), want);
}

static double near_float(WrHardMeasurement *g, double low, double high)
{
    return (double)(float)wr_hard_between(g, low, high);
}

/* ---- on the axis, below 0 (HC117) ---- */

static bool hc117(WrHardMeasurement *g, WrError *err)
{
    WrKernGraind board, wood;
    WrSolidTexture grain = bare(WR_SOLID_TEXTURE_CHECKER);
    (void)err;
    grain.rings = 1;
    wr_solid_texture_kern_fill(&grain, grain.kind, false, false, 1, &board);
    for (int i = 0; i < 64; i++) {
        const WrVec3 p = { near_float(g, -9, 9), near_float(g, -9, 9), near_float(g, -9, 9) };
        const int cells = (int)(floor(p.x) + floor(p.y) + floor(p.z));
        near_all(g, &board, p, NULL, cells % 2 != 0 ? 1 : 0, 1);
    }
    grain = bare(WR_SOLID_TEXTURE_WOOD);
    grain.drives = WR_SOLID_TEXTURE_BUMPS | WR_SOLID_TEXTURE_COLOURS;
    for (int i = 0; i < 24; i++) {
        const Pixel px = { { i & 1 ? 0 : 1e-3, 0, 0 }, { 0, 1e-3, 0 } };
        const WrVec3 p = { 0, i & 2 ? 0 : -1e-30, near_float(g, -3, 3) };
        wr_solid_texture_kern_fill(&grain, grain.kind, true, i & 4, 1, &wood);
        for (int set = 0; set < g->all; set++) {
            const double got = in_float(g, set, &wood, p, &px);
            wr_hard_holds(g, WR_HARD_FLOAT, got >= 0 && got <= 1);
        }
        const double got = in_double(g, i & 1, &wood, p, &px);
        wr_hard_holds(g, WR_HARD_DOUBLE, got >= 0 && got <= 1);
    }
    return true;
}

/* ---- boxes much smaller and larger than rings (HC118, HC119) ---- */

/* Total length of the pulses 1 - d .. 1 of all turns from 0 to t, in long double. */
static long double pulses(long double t, long double d)
{
    const long double whole = floorl(t), rest = t - whole - (1 - d);
    return whole * d + (rest > 0 ? rest : 0);
}

/* Rings with edges of width w, at the distance t. */
static void ring(WrHardMeasurement *g, double t, double w, double share, double want, double by)
{
    WrSolidTexture grain = bare(WR_SOLID_TEXTURE_WOOD);
    WrKernGraind of;
    grain.rings = 1, grain.share = share, grain.amount = 0;
    wr_solid_texture_kern_fill(&grain, grain.kind, false, false, 1, &of);
    of.edge = (double)(float)w;
    near_all(g, &of, (WrVec3){ t, 0, 0.3 }, NULL, want, by);
    const double wide = in_double(g, 0, &of, (WrVec3){ t, 0, 0 }, NULL);
    const double narrow = in_float(g, 0, &of, (WrVec3){ t, 0, 0 }, NULL);
    wr_hard_holds(g, WR_HARD_DOUBLE, wide >= 0 && wide <= 1);
    wr_hard_holds(g, WR_HARD_FLOAT, narrow >= 0 && narrow <= 1);
}

static bool hc118(WrHardMeasurement *g, WrError *err)
{
    static const double widths[] = { 1e-6, 1e-3, 0.3, 0.99, 1.01, 7.7, 1e4 };
    (void)err;
    for (int i = 0; i < 140; i++) {
        const double share = near_float(g, 0.05, 0.95), w = (double)(float)widths[i % 7];
        const double whole = i % 3 == 0 ? 1e6 : i % 3 == 1 ? 37 : 0;
        /* half of them near the edge of a ring */
        const double at = i & 1 ? near_float(g, 0, 1) : 1 - share + w * near_float(g, -0.6, 0.6);
        const double t = (double)(float)(whole + fabs(at));
        const long double f = (long double)t - floorl(t), half = (long double)w / 2;
        const long double want = (pulses(f + half, share) - pulses(f - half, share)) / w;
        ring(g, t, w, share, (double)want, fmin(w, 1));
    }
    return true;
}

static bool hc119(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 60; i++) {
        const double share = near_float(g, 0.05, 0.95), t = near_float(g, 0, 40);
        const double f = t - floor(t);
        ring(g, t, 0, share, f >= 1 - share ? 1 : 0, 1);
        ring(g, t, 1e9, share, share, 1);
    }
    return true;
}

/* ---- one place in different views (HC120) ---- */

static bool hc120(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    for (int i = 0; i < 100; i++) {
        WrSolidTexture grain = bare((WrSolidTextureKind)(1 + i % (WR_SOLID_TEXTURE_KINDS - 1)));
        WrKernGraind of;
        grain.axis = (WrSolidTextureAxis)(i % WR_SOLID_TEXTURE_AXES);
        wr_solid_texture_kern_fill(&grain, grain.kind, true, false, 1, &of);
        const WrVec3 p = { near_float(g, -2, 2), near_float(g, -2, 2), near_float(g, -2, 2) };
        const Pixel other = { { near_float(g, -1, 1), 0.1, 0 }, { 0, near_float(g, -1, 1), 0.2 } };
        const double first = in_float(g, 0, &of, p, NULL), wide = in_double(g, 0, &of, p, NULL);
        for (int set = 0; set < g->sets; set++)
            wr_hard_holds(g, WR_HARD_FLOAT, in_float(g, set, &of, p, &other) == first);
        for (int set = 0; set < 2; set++)
            wr_hard_holds(g, WR_HARD_DOUBLE, in_double(g, set, &of, p, &other) == wide);
    }
    return true;
}

/* ---- far away (HC121) ---- */

static bool hc121(WrHardMeasurement *g, WrError *err)
{
    static const WrSolidTextureKind kinds[] = { WR_SOLID_TEXTURE_GRANITE, WR_SOLID_TEXTURE_NOISE };
    const Pixel far = { { 1e3, 0, 0 }, { 0, 1e3, 0 } };
    (void)err;
    for (int k = 0; k < 2; k++) {
        WrSolidTexture grain = bare(kinds[k]);
        WrOctavesPlan noise;
        WrKernGraind of;
        enum { PLACES = 20000 };
        double sum = 0;
        grain.octaves = 6 - k;
        wr_solid_texture_noise(&grain, &noise);
        for (int i = 0; i < PLACES; i++) {
            const double p[3] = { wr_hard_between(g, -50, 50), wr_hard_between(g, -50, 50),
                                  wr_hard_between(g, -50, 50) };
            const double moved = grain.amount * wr_octaves_at(&noise, p, NULL);
            sum += fmin(fmax(k == 0 ? moved : 0.5 + 0.5 * moved, 0), 1) / PLACES;
        }
        wr_solid_texture_kern_fill(&grain, grain.kind, true, true, 1, &of);
        near_all(g, &of, (WrVec3){ 0.3, 0.4, 0.5 }, &far, sum, 1);
    }
    return true;
}

#define ROW_GRAIN(number, situation, rule, u, float_bound, double_bound, line)                     \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_RENDER, .what = situation, .holds = rule,           \
        .unit = u, .bound = { float_bound, double_bound }, .measure = hc##number,                  \
        .scene = "table 64x64\nformula fourier terms=3,0,0.5;0,5,0.25,90,0\n"                      \
                 "surface cylinder\nrotate 60,0,0\nbump height=0.005\n" line                       \
    }
static const WrHardCase rows[] = {
    ROW_GRAIN(117, "solid textures on their axis, and at places below 0",
              "within 0..1; cells of a checker alternate across 0", "of 1", 0, 0,
              "grain wood axis=y"),
    ROW_GRAIN(118, "edges of a ring a millionth wide, at the millionth ring; and wider ones",
              "the mean by closed form; in single precision times their width", "of 1", 2e-6, 1e-9,
              "grain wood rings=1000000"),
    ROW_GRAIN(119, "pixels that hold nothing of a ring, and 1e9 rings",
              "the point's; the dark's share", "of 1", 1e-6, 1e-9,
              "grain wood rings=1000\ndials aa=filter"),
    ROW_GRAIN(120, "one place of a solid texture, whatever the view", "the same bits", "violations",
              0, 0, "grain marble\nrotate 10,20,30"),
    ROW_GRAIN(121, "solid noise that is far away", "its mean, not darker", "of 1", 0.01, 0.01,
              "grain granite\ndials aa=filter"),
};
WR_HARD_LIST(grain, rows);

static WrNoise noise_of(WrNoiseKind kind, int dim, int period)
{
    return (WrNoise){
        .kind = kind,
        .fade = WR_FADE_QUINTIC,
        .dim = dim,
        .lattice = { .source = WR_LATTICE_HASH, .seed = 7, .period = { period, period, period } }
    };
}

/* In double at the lattice points themselves; in float on a grid in which one texel in four is a lattice point. */
static bool hc59(WrHardMeasurement *g, WrError *err)
{
    static const WrNoiseKind kinds[] = { WR_NOISE_VALUE, WR_NOISE_GRADIENT, WR_NOISE_PERLIN };
    for (int k = 0; k < 3 * 200; k++) {
        const WrNoise noise = noise_of(kinds[k % 3], 1 + k % 2, 16);
        double t[3], slope[3], want_slope[3];
        uint32_t c[3];
        for (int a = 0; a < 3; a++) t[a] = c[a] = (uint32_t)(16 * wr_hard_random(g));
        const double want = wr_noise_lattice_value(&noise, c, want_slope);
        wr_hard_near(g, WR_HARD_DOUBLE, wr_noise_at(&noise, t, slope), want);
        for (int a = 0; a < noise.dim; a++)
            wr_hard_near(g, WR_HARD_DOUBLE, slope[a], want_slope[a]);
    }
    const double offset[2] = { -0.125, 0.125 }; /* puts texel centres on the lattice; v points up */
    WrOctaves octaves = wr_octaves_default(2);
    octaves.count = 1;
    octaves.cells[0] = octaves.cells[1] = 16;
    octaves.offsets = offset;
    WrOctavesPlan plan;
    if (!wr_octaves_plan(&octaves, NULL, &plan, err)) return false;
    static float f[64 * 64];
    const WrNoiseGrid grid = { 64, 64, 0, 0, 64, 64 };
    wr_octaves_grid(&plan, &grid, f, NULL, NULL, 64);
    for (int k = 0; k < 256; k++) {
        const int i = 4 * (k % 16), j = 4 * (k / 16);
        wr_hard_near(g, WR_HARD_FLOAT, (double)f[64 * j + i], 0.0);
    }
    return true;
}

/* Across 0 noise changes at most by its slope, and x - n equals x. */
static bool hc60(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const double little[] = { -1e-9, -1e-17, -0.0 };
    for (int k = 0; k < WR_NOISE_KIND_COUNT * 30; k++) {
        const WrNoiseKind kind = (WrNoiseKind)(k % WR_NOISE_KIND_COUNT);
        const int dim = kind == WR_NOISE_SIMPLEX ? 3 : 2;
        const WrNoise noise = noise_of(kind, dim, 12);
        double at[3] = { 0, wr_hard_float(g) * 11.0, wr_hard_float(g) * 11.0 }, below[3], back[3];
        memcpy(below, at, sizeof at);
        memcpy(back, at, sizeof at);
        below[0] = little[k % 3];
        back[0] = at[0] - 12 * (1 + k % 5);
        back[1] = at[1] + 12;
        const double here = wr_noise_at(&noise, at, NULL);
        wr_hard_near(g, WR_HARD_DOUBLE, wr_noise_at(&noise, below, NULL), here);
        wr_hard_near(g, WR_HARD_DOUBLE, wr_noise_at(&noise, back, NULL), here);
    }
    return true;
}

/* Positions beyond every exact integer: reduced to the period exactly, and finite without one. */
static bool hc61(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const double far[] = { 1e7, 3e9, 1e16, 7.3e299, INFINITY, NAN };
    for (int k = 0; k < WR_NOISE_KIND_COUNT * 24; k++) {
        const WrNoiseKind kind = (WrNoiseKind)(k % WR_NOISE_KIND_COUNT);
        const int dim = kind == WR_NOISE_SIMPLEX ? 3 : 2;
        const WrNoise noise = noise_of(kind, dim, 12);
        const double x = far[k / WR_NOISE_KIND_COUNT % 6];
        double out[3] = { x, -x, x }, in[3], slope[3];
        for (int a = 0; a < 3; a++) in[a] = isfinite(x) ? fmod(out[a], 12.0) : 0.0;
        for (int a = 0; a < 3; a++) in[a] += in[a] < 0.0 ? 12.0 : 0.0;
        const double f = wr_noise_at(&noise, out, slope);
        wr_hard_holds(g, WR_HARD_DOUBLE, f == wr_noise_at(&noise, in, NULL));
        WrNoise endless = noise_of(kind, dim, wr_noises[kind].repeat[dim - 1].always ? 12 : 0);
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      isfinite(wr_noise_at(&endless, out, slope)) && isfinite(slope[0]));
    }
    return true;
}

/* The integer mixing written out, and its numbers in float. */
static uint32_t mixed(uint32_t x)
{
    x = (x ^ (x >> 16)) * 2146121005u;
    x = (x ^ (x >> 15)) * 2221713035u;
    return x ^ (x >> 16);
}

static bool hc66(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    for (int k = 0; k < 3000; k++) {
        const uint32_t seed = (uint32_t)(wr_hard_random(g) * 4294967296.0);
        uint32_t c[3], h = mixed(seed + 0x9e3779b9u);
        for (int a = 0; a < 3; a++) {
            c[a] = (uint32_t)(wr_hard_random(g) * 4294967296.0);
            h = mixed(h ^ mixed(c[a] + 0x85ebca6bu * ((uint32_t)a + 1u)));
        }
        const uint32_t got = wr_lattice_hash(seed, c, 3);
        const double number = wr_lattice_number(got);
        const uint32_t linked = wr_lattice_hash_link(
            wr_lattice_hash_link(wr_lattice_hash_start(seed), wr_lattice_hash_part(c[0], 0)),
            wr_lattice_hash_part(c[1], 1)); /* in the order of a lattice's rows */
        wr_hard_holds(g, WR_HARD_DOUBLE, got == h && number > -1.0 && number < 1.0);
        wr_hard_holds(g, WR_HARD_DOUBLE, linked == wr_lattice_hash(seed, c, 2));
        wr_hard_holds(g, WR_HARD_DOUBLE, wr_lattice_number(~got) == -number);
        wr_hard_holds(g, WR_HARD_FLOAT, (double)(float)number == number);
    }
    return true;
}

/* On a face two simplices meet: values one ulp to either side must agree, apart from the noise's own slope. */
static bool hc67(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    const WrNoise flat = noise_of(WR_NOISE_SIMPLEX, 2, 0), solid = noise_of(WR_NOISE_SIMPLEX, 3, 0);
    const WrNoise sheared = noise_of(WR_NOISE_SHEARED, 2, 0);
    for (int k = 0; k < 1000; k++) {
        const double a = wr_hard_between(g, 0, 9), b = wr_hard_between(g, 0, 9), e = 1e-15 * a;
        /* x + y/2 a whole number; y one; and between them the diagonals of a square */
        const double y = k % 3 == 1 ? floor(b) : b;
        const double x = k % 3 == 0   ? floor(a) - y / 2
                         : k % 3 == 1 ? a
                                      : floor(a) + (y - floor(y)) - y / 2;
        const double up = k % 3 == 1 ? 1e-14 : 0, across = k % 3 == 1 ? 0 : 1e-14;
        const double over[2] = { x + across, y + up }, under[2] = { x - across, y - up };
        wr_hard_near(g, WR_HARD_DOUBLE, wr_noise_at(&sheared, over, NULL),
                     wr_noise_at(&sheared, under, NULL));
        const double two[2][2] = { { a, a + e }, { a, a - e } };
        wr_hard_near(g, WR_HARD_DOUBLE, wr_noise_at(&flat, two[0], NULL),
                     wr_noise_at(&flat, two[1], NULL));
        const double three[2][3] = { { a, a + e, b }, { a, a - e, b } };
        wr_hard_near(g, WR_HARD_DOUBLE, wr_noise_at(&solid, three[0], NULL),
                     wr_noise_at(&solid, three[1], NULL));
        const double edge[2][3] = { { a + e, a, a }, { a - e, a, a } };
        wr_hard_near(g, WR_HARD_DOUBLE, wr_noise_at(&solid, edge[0], NULL),
                     wr_noise_at(&solid, edge[1], NULL));
    }
    return true;
}

static const WrHardCase single[] = {
    ROW(59, "noise at its lattice points",
        "the prescribed value, and with a smooth fade the prescribed slope; Perlin noise 0",
        "height", 1e-6, 0,
        "table 64x64\nnoise perlin cells=16 octaves=1\nsurface plane\nbump height=0.05"),
    ROW(60, "places below 0", "noise goes on through 0, and repeats", "height", NAN, 1e-7,
        "table 128x128\nnoise gradient cells=6\nsurface plane\nreplicate 3,3\nbump height=0.05"),
    ROW(61, "places from 1e7 to infinity", "brought into the period exactly; finite without one",
        "violations", NAN, 0, NULL),
};
WR_HARD_LIST(noise, single);

static const WrHardCase hashed[] = {
    ROW(66, "the hash behind all noise",
        "whole numbers alone, its formula to the bit; results are exact in float", "violations", 0,
        0, "table 64x64\nnoise value cells=32 octaves=1\nsurface plane"),
    ROW(67, "places on the face between two simplices", "both choices have the same height",
        "height", NAN, 1e-12,
        "table 128x128\nnoise sheared cells=8 octaves=1\nsurface plane\nbump height=0.05"),
};
WR_HARD_LIST(faces, hashed);
