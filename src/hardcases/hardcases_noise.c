/* Hard cases of single noises: lattice points, far and negative positions, hashes, faces of simplices. */
#include "hardcases/hardcases_internal.h"

#include "base/error.h"
#include "noise/grid.h"
#include "noise/noise.h"

#include <string.h>

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
static bool hc59(WrHardGauge *g, WrError *err)
{
    static const WrNoiseKind kinds[] = { WR_NOISE_VALUE, WR_NOISE_GRADIENT, WR_NOISE_PERLIN };
    for (int k = 0; k < 3 * 200; k++) {
        const WrNoise noise = noise_of(kinds[k % 3], 1 + k % 2, 16);
        double t[3], slope[3], want_slope[3];
        uint32_t c[3];
        for (int a = 0; a < 3; a++) t[a] = c[a] = (uint32_t)(16 * wr_hard_random(g));
        const double want = wr_noise_prescribed(&noise, c, want_slope);
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
static bool hc60(WrHardGauge *g, WrError *err)
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
static bool hc61(WrHardGauge *g, WrError *err)
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

static bool hc66(WrHardGauge *g, WrError *err)
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
static bool hc67(WrHardGauge *g, WrError *err)
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

#define ROW(number, situation, rule, u, in_float, in_double, script)                               \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_NOISE, .what = situation, .holds = rule, .unit = u, \
        .bound = { in_float, in_double }, .measure = hc##number, .scene = script                   \
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
        "whole numbers alone, its formula to the bit; what it gives is exact in float",
        "violations", 0, 0, "table 64x64\nnoise value cells=32 octaves=1\nsurface plane"),
    ROW(67, "places on the face between two simplices", "either choice gives the same height",
        "height", NAN, 1e-12,
        "table 128x128\nnoise sheared cells=8 octaves=1\nsurface plane\nbump height=0.05"),
};
WR_HARD_LIST(faces, hashed);
