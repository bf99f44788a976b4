/* Hard cases of solid textures. */
#include "hardcases/hardcases_internal.h"

#include "noise/octaves.h"
#include "render/textures/solid_texture_setup.h"
#include "shade/solid_texture.h"

#include <string.h>

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

static double in_float(WrHardGauge *g, int set, const WrKernGraind *of, WrVec3 p, const Pixel *px)
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

static double in_double(WrHardGauge *g, int set, const WrKernGraind *of, WrVec3 p, const Pixel *px)
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
static void near_all(WrHardGauge *g, const WrKernGraind *of, WrVec3 p, const Pixel *px, double want,
                     double by)
{
    for (int set = 0; set < g->sets; set++)
        wr_hard_near(g, WR_HARD_FLOAT, by * in_float(g, set, of, p, px), by * want);
    for (int set = 0; set < 2; set++)
        wr_hard_near(g, WR_HARD_DOUBLE, in_double(g, set, of, p, px), want);
}

static double near_float(WrHardGauge *g, double low, double high)
{
    return (double)(float)wr_hard_between(g, low, high);
}

/* ---- on the axis, below 0 (HC117) ---- */

static bool hc117(WrHardGauge *g, WrError *err)
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
static void ring(WrHardGauge *g, double t, double w, double share, double want, double by)
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

static bool hc118(WrHardGauge *g, WrError *err)
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

static bool hc119(WrHardGauge *g, WrError *err)
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

static bool hc120(WrHardGauge *g, WrError *err)
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

static bool hc121(WrHardGauge *g, WrError *err)
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

#define ROW(number, situation, rule, u, float_bound, double_bound, line)                           \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_RENDER, .what = situation, .holds = rule,           \
        .unit = u, .bound = { float_bound, double_bound }, .measure = hc##number,                  \
        .scene = "table 64x64\nformula fourier terms=3,0,0.5;0,5,0.25,90,0\n"                      \
                 "surface cylinder\nrotate 60,0,0\nbump height=0.005\n" line                       \
    }
static const WrHardCase rows[] = {
    ROW(117, "solid textures on their axis, and at places below 0",
        "within 0..1; cells of a checker alternate across 0", "of 1", 0, 0, "grain wood axis=y"),
    ROW(118, "edges of a ring a millionth wide, at the millionth ring; and wider ones",
        "the mean by closed form; in single precision times their width", "of 1", 2e-6, 1e-9,
        "grain wood rings=1000000"),
    ROW(119, "pixels that hold nothing of a ring, and 1e9 rings", "the point's; the dark's share",
        "of 1", 1e-6, 1e-9, "grain wood rings=1000\ndials aa=filter"),
    ROW(120, "one place of a solid texture, whatever the view", "the same bits", "violations", 0, 0,
        "grain marble\nrotate 10,20,30"),
    ROW(121, "solid noise that is far away", "its mean, not darker", "of 1", 0.01, 0.01,
        "grain granite\ndials aa=filter"),
};
WR_HARD_LIST(grain, rows);
