/* Colours are linear. For metals they are the reflectance at normal incidence, from measured n and k
   (rounded as in common tables for renderers); for all others, and for bronze, a plausible albedo; steel (iron) and
   rubber are those of Filament's sheet of material properties.
   Indices of refraction are published ones: ice 1.31 (Warren, Brandt 2008), beeswax 1.44, rubber 1.52
   (CRC Handbook). Roughness is a plausible value. */
#include "scene/material_preset.h"

#include "shade/reflection_models.h"

#define MATT(r, g, b, wide)                                                                        \
    .material = { .ambient = 0.08,                                                                 \
                  .diffuse = 1,                                                                    \
                  .specular = 0.35,                                                                \
                  .shininess = 40,                                                                 \
                  .colour = { r, g, b },                                                           \
                  .gate = true,                                                                    \
                  .model = WR_REFLECT_OREN_NAYAR,                                                  \
                  .roughness = wide,                                                               \
                  .ior = 1.5 }
#define GGX(r, g, b, rough, metal, index)                                                          \
    .material = { .ambient = 0.08,                                                                 \
                  .diffuse = 1,                                                                    \
                  .specular = 1,                                                                   \
                  .shininess = 40,                                                                 \
                  .colour = { r, g, b },                                                           \
                  .gate = true,                                                                    \
                  .model = WR_REFLECT_GGX,                                                         \
                  .roughness = rough,                                                              \
                  .metalness = metal,                                                              \
                  .ior = index }
/* Stands in for light that goes under the surface, for which there is no model: more light from everywhere. */
#define SOFT(r, g, b, rough, index)                                                                \
    .material = { .ambient = 0.2,                                                                  \
                  .diffuse = 0.9,                                                                  \
                  .specular = 1,                                                                   \
                  .shininess = 40,                                                                 \
                  .colour = { r, g, b },                                                           \
                  .gate = true,                                                                    \
                  .model = WR_REFLECT_GGX,                                                         \
                  .roughness = rough,                                                              \
                  .ior = index }

const WrMaterialPreset wr_material_presets[WR_MATERIAL_PRESETS] = {
    { "usual", "Usual", "Default of a new document: matt light and a white highlight",
      .material = { .ambient = 0.08,
                    .diffuse = 0.72,
                    .specular = 0.35,
                    .shininess = 40,
                    .colour = { 0.8, 0.8, 0.8 },
                    .gate = true,
                    .roughness = 0.3,
                    .ior = 1.5 } },
    { "clay", "Clay", "Matt and grey-brown, bright up to its edge: it shows shape",
      MATT(0.46, 0.33, 0.26, 0.5) },
    { "brick", "Brick", "Burnt earth without a highlight", MATT(0.40, 0.13, 0.08, 0.6) },
    { "stone", "Stone", "Rough and grey", MATT(0.36, 0.35, 0.33, 0.8) },
    { "wood", "Wood", "Brown under a dull varnish", GGX(0.33, 0.17, 0.075, 0.42, 0, 1.5) },
    { "leather", "Leather", "Dark, with a broad highlight", GGX(0.10, 0.045, 0.025, 0.5, 0, 1.5) },
    { "skin", "Skin", "Warm, with a broad and weak highlight; light does not go under it here",
      GGX(0.72, 0.42, 0.32, 0.52, 0, 1.4) },
    { "plastic", "Plastic", "A colour below a small white highlight",
      GGX(0.55, 0.05, 0.04, 0.24, 0, 1.49) },
    { "porcelain", "Porcelain", "White, and smooth as glass",
      GGX(0.83, 0.82, 0.78, 0.14, 0, 1.52) },
    { "metal", "Metal", "Aluminium that was brushed: all light is highlight, and broad",
      GGX(0.91, 0.92, 0.92, 0.45, 1, 1.5) },
    { "gold", "Gold", "Polished: all light is highlight, in its own colour",
      GGX(1, 0.77, 0.34, 0.3, 1, 1.5) },
    { "copper", "Copper", "Worn, so that its highlight is broad",
      GGX(0.96, 0.64, 0.54, 0.4, 1, 1.5) },
    { "plaster", "Plaster", "White and matt, without a highlight", MATT(0.78, 0.76, 0.72, 0.55) },
    { "steel", "Steel", "Ground: a grey highlight, rather sharp",
      GGX(0.527, 0.509, 0.491, 0.3, 1, 1.5) },
    { "bronze", "Bronze", "Cast and waxed, brown to yellow", GGX(0.71, 0.47, 0.24, 0.34, 1, 1.5) },
    { "rubber", "Rubber", "Black, with a weak and broad highlight",
      GGX(0.036, 0.036, 0.036, 0.58, 0, 1.52) },
    { "wax", "Wax", "Yellow, its dark side bright; light does not go under it here",
      SOFT(0.78, 0.60, 0.33, 0.42, 1.44) },
    { "ice", "Ice", "Pale blue and smooth; it is not seen through here",
      SOFT(0.55, 0.74, 0.86, 0.16, 1.31) },
};
