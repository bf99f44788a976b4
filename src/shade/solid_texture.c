#include "shade/solid_texture.h"

#include "base/error.h"
#include "base/enum_rows.h"
#include "noise/octaves.h"

#include <math.h>

const char *const wr_solid_texture_axes[WR_SOLID_TEXTURE_AXES] = { "x", "y", "z" };
const char *const wr_solid_texture_drives[WR_SOLID_TEXTURE_DRIVES] = {
    [WR_SOLID_TEXTURE_COLOURS] = "colour",
    [WR_SOLID_TEXTURE_ROUGHENS] = "roughness",
    [WR_SOLID_TEXTURE_BUMPS] = "bump",
    [WR_SOLID_TEXTURE_COLOURS | WR_SOLID_TEXTURE_ROUGHENS] = "colour+roughness",
    [WR_SOLID_TEXTURE_COLOURS | WR_SOLID_TEXTURE_BUMPS] = "colour+bump",
    [WR_SOLID_TEXTURE_ROUGHENS | WR_SOLID_TEXTURE_BUMPS] = "roughness+bump",
    [WR_SOLID_TEXTURE_COLOURS | WR_SOLID_TEXTURE_ROUGHENS | WR_SOLID_TEXTURE_BUMPS] = "all",
};

/* Quintic noise in space: value noise has the variance (181/231)^3 / 3; that of |Perlin noise| was
   measured at 2e7 points.
   means and variances are those of one octave, for E45: an octave that is too fine for a pixel is replaced by
   its mean, and its variance widens the filter of the pattern's edge (NUMERICS-LIGHT c). */
const double wr_solid_texture_means[WR_SOLID_TEXTURE_NOISES] = { 0, 0.1797 };
const double wr_solid_texture_variances[WR_SOLID_TEXTURE_NOISES] = { 0.16035, 0.01629 };
const double wr_solid_texture_fadings[WR_SOLID_TEXTURE_NOISES] = { 0.154, 0.76 };

#define RGB(r, g, b)                                                                               \
    {                                                                                              \
        r, g, b                                                                                    \
    }
#define USUAL(kind_, light_, dark_, rings_, share_, amount_, cells_, octaves_, ratio_)             \
    .usual = { .kind = WR_SOLID_TEXTURE_##kind_,                                                   \
               .axis = WR_SOLID_TEXTURE_Z,                                                         \
               .drives = WR_SOLID_TEXTURE_COLOURS,                                                 \
               .light = light_,                                                                    \
               .dark = dark_,                                                                      \
               .rings = rings_,                                                                    \
               .share = share_,                                                                    \
               .amount = amount_,                                                                  \
               .cells = cells_,                                                                    \
               .octaves = octaves_,                                                                \
               .ratio = ratio_,                                                                    \
               .height = 0.01,                                                                     \
               .roughness = { 0.3, 0.5 } }

WR_ROWS(wr_grains);
const WrSolidTextureInfo wr_grains[WR_SOLID_TEXTURE_KINDS] = {
    [WR_ROW(WR_SOLID_TEXTURE_OFF)] = { "off", "None", "no solid texture",
                                       USUAL(OFF, RGB(1, 1, 1), RGB(0, 0, 0), 8, 0.5, 0.5, 2, 3,
                                             2) },
    [WR_ROW(WR_SOLID_TEXTURE_WOOD)] = { "wood", "Wood", "rings about the axis, moved by noise",
                                        .ringed = true, .shared = true, .noisy = true,
                                        .stepped = true,
                                        USUAL(WOOD, RGB(0.72, 0.4, 0.17), RGB(0.3, 0.12, 0.04), 9,
                                              0.35, 0.8, 1.7, 4, 2.2) },
    [WR_ROW(WR_SOLID_TEXTURE_MARBLE)] = { "marble", "Marble",
                                          "bands along the axis, moved by creased noise",
                                          .ringed = true, .noisy = true,
                                          .noise = WR_SOLID_TEXTURE_SOFT,
                                          USUAL(MARBLE, RGB(0.92, 0.9, 0.86), RGB(0.16, 0.18, 0.22),
                                                1.5, 0.5, 1.5, 2, 6, 2) },
    [WR_ROW(WR_SOLID_TEXTURE_CHECKER)] = { "checker", "Checker", "cubes of two colours",
                                           .ringed = true, .stepped = true,
                                           USUAL(CHECKER, RGB(0.85, 0.82, 0.75),
                                                 RGB(0.12, 0.1, 0.1), 5, 0.5, 0, 2, 3, 2) },
    [WR_ROW(WR_SOLID_TEXTURE_GRANITE)] = { "granite", "Granite", "specks of creased noise",
                                           .noisy = true, .noise = WR_SOLID_TEXTURE_SOFT,
                                           USUAL(GRANITE, RGB(0.75, 0.68, 0.64),
                                                 RGB(0.1, 0.09, 0.1), 8, 0.5, 1.4, 14, 4, 1.4) },
    [WR_ROW(WR_SOLID_TEXTURE_NOISE)] = { "noise", "Noise", "one colour goes over into the other",
                                         .noisy = true,
                                         USUAL(NOISE, RGB(0.9, 0.85, 0.7), RGB(0.2, 0.3, 0.25), 8,
                                               0.5, 1.2, 4, 4, 2) },
};
WR_ROWS_END(wr_grains, WR_SOLID_TEXTURE_KINDS);

/* A step has no slope, so a bump driven by it needs an edge of finite width. */
double wr_solid_texture_edge(const WrSolidTexture *grain)
{
    const double least =
        grain->drives & WR_SOLID_TEXTURE_BUMPS && wr_grains[grain->kind].stepped ? 1.0 / 16 : 0;
    return wr_grains[grain->kind].stepped ? fmax(grain->edge, least) : 0;
}

void wr_solid_texture_noise(const WrSolidTexture *grain, WrOctavesPlan *out)
{
    WrOctaves ask = wr_octaves_default(3);
    WrError err;
    const WrSolidTextureNoise noise = wr_grains[grain->kind].noise;
    ask.kind = noise == WR_SOLID_TEXTURE_SOFT ? WR_NOISE_PERLIN : WR_NOISE_VALUE;
    ask.mode = noise == WR_SOLID_TEXTURE_SMOOTH ? WR_OCTAVES_FBM : WR_OCTAVES_TURBULENCE;
    ask.tile = false;
    ask.count = (int)fmin(fmax(floor(grain->octaves + 0.5), 1), WR_SOLID_TEXTURE_OCTAVES);
    ask.ratio = grain->ratio;
    for (int a = 0; a < 3; a++) ask.cells[a] = grain->cells;
    if (!wr_octaves_plan(&ask, NULL, out, &err)) *out = (WrOctavesPlan){ 0 };
}
