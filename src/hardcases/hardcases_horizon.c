/* Hard cases of self-shadowing by the relief. */
#include "hardcases/hardcases_internal.h"

#include "base/error.h"
#include "field/field.h"
#include "field/horizon.h"

#define SIDE 30

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
static bool table_of(WrHardGauge *g, int w, int h, int kind, WrError *err)
{
    WrField *field = wr_hard_rough(g, w, h, WR_WRAP_PERIODIC);
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

static void line_of(WrHardGauge *g, int n, int kind)
{
    double heights[SIDE] = { 0 }, slope[SIDE];
    int hull[2 * SIDE];
    for (int i = 0; i < n; i++)
        heights[i] = kind == 0 ? -2.7 : kind == 1 ? 0.37 * i : wr_hard_between(g, -1, 1);
    wr_horizon_line(heights, n, slope, hull);
    for (int i = 0; i < n; i++) {
        double best = 0;
        for (int t = 1; t <= n; t++) best = fmax(best, (heights[(i + t) % n] - heights[i]) / t);
        wr_hard_near(g, WR_HARD_DOUBLE, slope[i], best);
    }
}

static bool hc122(WrHardGauge *g, WrError *err)
{
    const int sizes[][2] = { { 1, 1 }, { 2, 1 }, { 1, 2 }, { 2, 2 }, { 3, 17 }, { 29, 2 } };
    bool good = true;
    for (int k = 0; k < 18 && good; k++) {
        const int *size = sizes[k / 3];
        good = table_of(g, size[0], size[1], k % 3, err);
    }
    for (int n = 1; n <= SIDE; n++)
        for (int kind = 0; kind < 3; kind++) line_of(g, n, kind);
    return good;
}

/* A lamp in the plane of flat ground, below it, and straight above any ground. */
static bool hc123(WrHardGauge *g, WrError *err)
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
static const WrHardCase rows[] = {
    ROW(122, "horizons of 1 and 2 texels, of level ground, of a ramp over the seam",
        "0 where nothing is higher; else what looking at every texel finds", "slope", 1e-7, 1e-12,
        NULL),
    ROW(123, "a lamp at an elevation of 0, below 0, and of 90 degrees",
        "level ground is lit, dark, lit; any ground dark, dark, lit", "violations", NAN, 0, NULL),
};
WR_HARD_LIST(horizon, rows);
