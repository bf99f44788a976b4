/* Hard cases of flat tables: no detail, and detail at a level of a million. */
#include "hardcases/hardcases_look.h"
#include "field/scheme_list.h"

#include "base/error.h"
#include "field/field.h"

static bool hc47(WrHardGauge *g, WrError *err)
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
static bool hc48(WrHardGauge *g, WrError *err)
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
      .what = "a level table, whatever its level",
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
