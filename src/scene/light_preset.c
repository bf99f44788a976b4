#include "scene/light_preset.h"

#include "base/memory.h"

#include <string.h>

/* round: angular radius of the lamp, degrees; objects hide lamps that have one */
#define LAMP(x, y, z, r, g, b, power, round)                                                       \
    {                                                                                              \
        .kind = WR_LIGHT_DIRECTIONAL, .where = { x, y, z }, .colour = { r, g, b },                 \
        .strength = power, .size_deg = round, .shadow = (round) > 0                                \
    }

/* Surroundings are the fill: they keep the dark side readable. Lamps come from the same side as the brightest part of
   their surroundings, which reflections show. */
const WrLightPreset wr_light_presets[WR_LIGHT_PRESETS] = {
    { "studio",
      "Studio",
      "A soft box at the upper left, a cool rim light and a dim room",
      WR_ENVIRONMENT_MAP_STUDIO,
      0.5,
      { LAMP(-0.72, 0.66, 0.5, 1, 0.96, 0.9, 1, 4), LAMP(0.85, 0.3, -0.55, 0.8, 0.9, 1, 0.5, 0) } },
    { "raking",
      "Raking",
      "Grazing light from the left: every dent shows",
      WR_ENVIRONMENT_MAP_RAKING,
      0.35,
      { LAMP(-0.92, 0.32, 0.3, 1, 0.95, 0.87, 1.35, 2),
        LAMP(0.5, 0.2, 0.85, 0.75, 0.87, 1, 0.1, 0) } },
    { "overcast",
      "Overcast",
      "A bright grey sky, without a sun: soft and even",
      WR_ENVIRONMENT_MAP_OVERCAST,
      1,
      { LAMP(-0.25, 0.9, 0.35, 1, 1, 1, 0.12, 20) } },
    { "window",
      "Window",
      "Daylight through a tall window at the left, in a warm room",
      WR_ENVIRONMENT_MAP_WINDOW,
      0.8,
      { LAMP(-0.9, 0.3, 0.42, 0.92, 0.97, 1, 0.85, 12) } },
    { "sunset",
      "Sunset",
      "A low warm sun before a blue sky",
      WR_ENVIRONMENT_MAP_SUNSET,
      0.8,
      { LAMP(-0.85, 0.3, 0.5, 1, 0.62, 0.32, 1.35, 1) } },
    { "paper",
      "The paper's",
      "One lamp at the upper left and a faint one at the eye, as in 1978",
      WR_ENVIRONMENT_MAP_OFF,
      1,
      { LAMP(-0.4, 0.5, 0.8, 1, 1, 1, 1, 0), LAMP(0, 0, 1, 1, 1, 1, 0.08, 0) } },
};

bool wr_light_preset_apply(const WrLightPreset *preset, WrScene *scene, WrError *err)
{
    WrEnvironmentMap *light = NULL;
    if (preset->surroundings != WR_ENVIRONMENT_MAP_OFF) {
        light = wr_environment_map_built(preset->surroundings, err);
        if (!light) return false;
    }
    wr_environment_set(&scene->environment, preset->surroundings, light, NULL, NULL);
    scene->environment.turn_deg = 0;
    scene->environment.strength = preset->strength;
    wr_free(scene->lights);
    scene->lights = wr_alloc(WR_LIGHT_PRESET_LAMPS, sizeof *scene->lights);
    scene->light_count = 0;
    scene->lights_given = true;
    for (int i = 0; i < WR_LIGHT_PRESET_LAMPS; i++)
        if (preset->lamps[i].strength > 0) scene->lights[scene->light_count++] = preset->lamps[i];
    return true;
}

static bool same_lamp(const WrLight *a, const WrLight *b)
{
    return a->kind == b->kind && memcmp(&a->where, &b->where, sizeof a->where) == 0 &&
           memcmp(&a->colour, &b->colour, sizeof a->colour) == 0 && a->strength == b->strength &&
           a->size_deg == b->size_deg && a->shadow == b->shadow;
}

int wr_light_preset_now(const WrScene *scene)
{
    for (int i = 0; scene->lights_given && i < WR_LIGHT_PRESETS; i++) {
        const WrLightPreset *preset = &wr_light_presets[i];
        int count = 0;
        bool same = scene->environment.kind == preset->surroundings &&
                    scene->environment.strength == preset->strength &&
                    scene->environment.turn_deg == 0;
        for (; count < WR_LIGHT_PRESET_LAMPS && preset->lamps[count].strength > 0; count++)
            same = same && count < scene->light_count &&
                   same_lamp(&scene->lights[count], &preset->lamps[count]);
        if (same && count == scene->light_count) return i;
    }
    return -1;
}
