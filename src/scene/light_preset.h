/* light_preset.h - light presets: lamps and surroundings that are set together. */
#pragma once
#include "scene/scene.h"

#define WR_LIGHT_PRESET_LAMPS 3

typedef struct WrLightPreset {
    const char *name;  /* as in commands: "studio" */
    const char *title; /* in the window, English */
    const char *help;
    WrEnvironmentMapKind surroundings;    /* a built-in set, or off */
    double strength;                      /* of the surroundings */
    WrLight lamps[WR_LIGHT_PRESET_LAMPS]; /* those of strength 0 are unused */
} WrLightPreset;

#define WR_LIGHT_PRESETS 6
extern const WrLightPreset wr_light_presets[WR_LIGHT_PRESETS];

/* Replaces the scene's lights and surroundings. Errors: out of memory; then the scene is unchanged. */
bool wr_light_preset_apply(const WrLightPreset *preset, WrScene *scene, WrError *err);
/* Index of the preset whose lights and surroundings the scene has, or -1. */
int wr_light_preset_now(const WrScene *scene);
