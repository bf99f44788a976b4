/* material_preset.h - materials by name, to begin with: each is a model of reflection (shade/reflection.h) and its numbers. */
#pragma once
#include "scene/scene.h"

typedef struct WrMaterialPreset {
    const char *name;  /* as in commands: "gold" */
    const char *title; /* in the window */
    const char *help;
    WrMaterial material;
} WrMaterialPreset;

#define WR_MATERIAL_PRESETS 12
extern const WrMaterialPreset wr_material_presets[WR_MATERIAL_PRESETS];
