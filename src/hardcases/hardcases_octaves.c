/* Hard cases of sums of noise: octaves too fine for the table, divergent sums, creases, tiling. */
#include "hardcases/hardcases_internal.h"

#include "base/error.h"
#include "noise/grid.h"
#include "noise/octaves.h"

/* Number of octaves whose cells are at least two texels, counted one by one. */
static int fitting(double cells, double step, int texels)
{
    int count = 0;
    while (count < WR_OCTAVES_MOST && cells <= texels / 2.0) {
        count++;
        cells *= step;
    }
    return count;
}

static bool hc62(WrHardGauge *g, WrError *err)
{
    static const int sizes[] = { 1, 2, 16, 64, 100, 512, 4096 };
    static const double steps[] = { 2, 3, 1.5 };
    for (int k = 0; k < 7 * 3 * 6; k++) {
        const int texels[2] = { sizes[k % 7], sizes[k % 7] };
        WrOctaves octaves = wr_octaves_default(2);
        octaves.tile = false;
        octaves.step = steps[k / 7 % 3];
        octaves.count = WR_OCTAVES_MOST;
        octaves.cells[0] = octaves.cells[1] = 1 << (k / 21);
        WrOctavesPlan plan;
        if (!wr_octaves_plan(&octaves, texels, &plan, err)) return false;
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      plan.used == fitting(octaves.cells[0], octaves.step, texels[0]));
    }
    return true;
}

/* One cell of Perlin noise per texel, texel centres on the lattice: the result is 0. */
static bool hc63(WrHardGauge *g, WrError *err)
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

static bool hc64(WrHardGauge *g, WrError *err)
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
static bool hc65(WrHardGauge *g, WrError *err)
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
static bool hc68(WrHardGauge *g, WrError *err)
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
        "refused with a message; what is taken is finite", "violations", NAN, 0, NULL),
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
