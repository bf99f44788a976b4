#include "shade/grain.h"

#include "base/error.h"
#include "base/rows.h"
#include "noise/octaves.h"

#include <math.h>

const char *const wr_grain_axes[WR_GRAIN_AXES] = { "x", "y", "z" };

WR_ROWS(wr_grains);
const WrGrainInfo wr_grains[WR_GRAIN_KINDS] = {
    [WR_ROW(WR_GRAIN_OFF)] = { "off", "None", "no solid texture",
                               .usual = { WR_GRAIN_OFF,
                                          WR_GRAIN_Z,
                                          { 1, 1, 1 },
                                          { 0, 0, 0 },
                                          8,
                                          0.5,
                                          0.5,
                                          2,
                                          3,
                                          2 } },
    [WR_ROW(WR_GRAIN_WOOD)] = { "wood", "Wood", "rings about the axis, moved by noise",
                                .ringed = true, .shared = true, .noisy = true,
                                .usual = { WR_GRAIN_WOOD,
                                           WR_GRAIN_Z,
                                           { 0.72, 0.4, 0.17 },
                                           { 0.3, 0.12, 0.04 },
                                           9,
                                           0.35,
                                           0.8,
                                           1.7,
                                           4,
                                           2.2 } },
    [WR_ROW(WR_GRAIN_MARBLE)] = { "marble", "Marble",
                                  "bands along the axis, moved by creased noise", .ringed = true,
                                  .noisy = true, .creased = true,
                                  .usual = { WR_GRAIN_MARBLE,
                                             WR_GRAIN_Z,
                                             { 0.92, 0.9, 0.86 },
                                             { 0.16, 0.18, 0.22 },
                                             1.5,
                                             0.5,
                                             1.6,
                                             2.5,
                                             6,
                                             2 } },
    [WR_ROW(WR_GRAIN_CHECKER)] = { "checker", "Checker", "cubes of two colours", .ringed = true,
                                   .usual = { WR_GRAIN_CHECKER,
                                              WR_GRAIN_Z,
                                              { 0.85, 0.82, 0.75 },
                                              { 0.12, 0.1, 0.1 },
                                              5,
                                              0.5,
                                              0,
                                              2,
                                              3,
                                              2 } },
    [WR_ROW(WR_GRAIN_GRANITE)] = { "granite", "Granite", "specks of creased noise", .noisy = true,
                                   .creased = true,
                                   .usual = { WR_GRAIN_GRANITE,
                                              WR_GRAIN_Z,
                                              { 0.75, 0.68, 0.64 },
                                              { 0.1, 0.09, 0.1 },
                                              8,
                                              0.5,
                                              0.8,
                                              14,
                                              4,
                                              1.4 } },
    [WR_ROW(WR_GRAIN_NOISE)] = { "noise", "Noise", "one colour goes over into the other",
                                 .noisy = true,
                                 .usual = { WR_GRAIN_NOISE,
                                            WR_GRAIN_Z,
                                            { 0.9, 0.85, 0.7 },
                                            { 0.2, 0.3, 0.25 },
                                            8,
                                            0.5,
                                            1.2,
                                            4,
                                            4,
                                            2 } },
};
WR_ROWS_END(wr_grains, WR_GRAIN_KINDS);

void wr_grain_noise(const WrGrain *grain, WrOctavesPlan *out)
{
    WrOctaves ask = wr_octaves_default(3);
    WrError err;
    ask.kind = WR_NOISE_VALUE;
    ask.mode = wr_grains[grain->kind].creased ? WR_OCTAVES_TURBULENCE : WR_OCTAVES_FBM;
    ask.tile = false;
    ask.count = (int)fmin(fmax(floor(grain->octaves + 0.5), 1), WR_GRAIN_OCTAVES);
    ask.ratio = grain->ratio;
    for (int a = 0; a < 3; a++) ask.cells[a] = grain->cells;
    if (!wr_octaves_plan(&ask, NULL, out, &err)) *out = (WrOctavesPlan){ 0 };
}
