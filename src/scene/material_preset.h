/* material_preset.h - material presets: each is a reflection model (shade/reflection.h) with its
   numbers. */
#pragma once
#include "scene/scene.h"

typedef struct WrMaterialPreset {
    const char *name;  /* as in commands: "gold" */
    const char *title; /* in the window */
    const char *help;
    WrMaterial material;
} WrMaterialPreset;

#define WR_MATERIAL_PRESETS 18
extern const WrMaterialPreset wr_material_presets[WR_MATERIAL_PRESETS];
