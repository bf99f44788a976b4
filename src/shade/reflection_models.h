/* reflection_models.h - table of reflection models, one row each.

   Apart from its formulas, everything about a model is in its columns; no other file lists models by
   name.

       X(ID, formula, LOOPS, HIGHLIGHT, DIFFUSE, energies, name, title, help)

   ID         enumerator WR_REFLECT_ID
   formula    reflect_FORMULA in shade/reflection_body.h, and FORMULA in
              render/reference/reference_shade.c
   LOOPS      WrReflectLoops without its prefix
   HIGHLIGHT  WrReflectHighlight without its prefix
   DIFFUSE    WrReflectDiffuse without its prefix
   energies   true if the published formula differs from the energy-conserving one (WrEnergy)
   name       in commands; never changed, because documents contain it
   title      in lists of the window
   help       one line: the tip, and the plan's reason

   The order is that of lists. A new row is added at the end: hard cases draw models in this order. */
#pragma once
#include "shade/reflection.h"

/* clang-format off */
#define WR_REFLECTION_MODELS(X)                                                                    \
    X(BLINN_PHONG, blinn_phong, STAGES, HALF, LAMBERT, false,                                      \
      "blinn-phong", "Blinn-Phong", "diffuse light and a power of n.h")                            \
    X(PHONG, phong, UNIFORM, POWER, LAMBERT, true,                                                 \
      "phong", "Phong", "diffuse light and a power of the mirrored direction's cosine")            \
    X(TORRANCE_SPARROW, torrance_sparrow, ROUGH, CAVITIES, LAMBERT, true,                          \
      "torrance-sparrow", "Torrance-Sparrow, Blinn 1977",                                          \
      "diffuse light and small mirrors in V-shaped cavities")                                      \
    X(OREN_NAYAR, oren_nayar, ROUGH, NONE, ROUGH, true,                                            \
      "oren-nayar", "Oren-Nayar", "small matt facets, no highlight: clay, the moon")               \
    X(GGX, ggx, METAL, SMITH, REMAINDER, true,                                                     \
      "ggx", "GGX", "small mirrors over diffuse light, or of metal: as in glTF")
/* clang-format on */

#define WR_REFLECTION_ID(ID, ...) WR_REFLECT_##ID,
typedef enum WrReflect { WR_REFLECTION_MODELS(WR_REFLECTION_ID) WR_REFLECT_COUNT } WrReflect;
#undef WR_REFLECTION_ID

/* A row of WrReflectInfo. Several columns follow from others, so that they cannot contradict. */
#define WR_REFLECTION_INFO(ID, FORMULA, LOOPS, HIGHLIGHT, DIFFUSE, ENERGIES, NAME, TITLE, HELP)    \
    {                                                                                              \
        .name = NAME, .title = TITLE, .help = HELP, .energies = ENERGIES,                          \
        .loops = WR_REFLECT_LOOPS_##LOOPS, .highlight = WR_HIGHLIGHT_##HIGHLIGHT,                  \
        .diffuse = WR_DIFFUSE_##DIFFUSE, .shines = WR_HIGHLIGHT_##HIGHLIGHT != WR_HIGHLIGHT_NONE,  \
        .facets = WR_HIGHLIGHT_IS_OF_FACETS(WR_HIGHLIGHT_##HIGHLIGHT),                             \
        .ior = WR_HIGHLIGHT_IS_OF_FACETS(WR_HIGHLIGHT_##HIGHLIGHT),                                \
        .shininess = WR_HIGHLIGHT_##HIGHLIGHT == WR_HIGHLIGHT_HALF ||                              \
                     WR_HIGHLIGHT_##HIGHLIGHT == WR_HIGHLIGHT_POWER,                               \
        .roughness = WR_REFLECT_LOOPS_##LOOPS >= WR_REFLECT_LOOPS_ROUGH,                           \
        .metalness = WR_REFLECT_LOOPS_##LOOPS == WR_REFLECT_LOOPS_METAL                            \
    }
