/* param.h - scene parameters that are numbers, vectors, colours or switches, each in one row: command,
   range, unit, default and texts.

   Commands, document files, new scenes and the window's panels use it. Choices are rows of wr_dials
   (scene/dials.h). */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrScene WrScene;

typedef enum WrSceneParamId {
    WR_SCENE_PARAM_ROTATE,
    WR_SCENE_PARAM_HEIGHT,
    WR_SCENE_PARAM_DISPLACED,
    WR_SCENE_PARAM_PARALLAX,
    WR_SCENE_PARAM_REPLICATE,
    WR_SCENE_PARAM_AMBIENT,
    WR_SCENE_PARAM_DIFFUSE,
    WR_SCENE_PARAM_SPECULAR,
    WR_SCENE_PARAM_SHININESS,
    WR_SCENE_PARAM_MATERIAL_COLOUR,
    WR_SCENE_PARAM_GATE,
    WR_SCENE_PARAM_ROUGHNESS,
    WR_SCENE_PARAM_METALNESS,
    WR_SCENE_PARAM_IOR,
    WR_SCENE_PARAM_TINT,
    WR_SCENE_PARAM_SHADOW,
    WR_SCENE_PARAM_OCCLUSION,
    WR_SCENE_PARAM_GRAIN_LIGHT,
    WR_SCENE_PARAM_GRAIN_DARK,
    WR_SCENE_PARAM_GRAIN_RINGS,
    WR_SCENE_PARAM_GRAIN_SHARE,
    WR_SCENE_PARAM_GRAIN_AMOUNT,
    WR_SCENE_PARAM_GRAIN_CELLS,
    WR_SCENE_PARAM_GRAIN_OCTAVES,
    WR_SCENE_PARAM_GRAIN_RATIO,
    WR_SCENE_PARAM_GRAIN_EDGE,
    WR_SCENE_PARAM_GRAIN_HEIGHT,
    WR_SCENE_PARAM_GRAIN_ROUGH_LIGHT,
    WR_SCENE_PARAM_GRAIN_ROUGH_DARK,
    WR_SCENE_PARAM_LIGHT_TO,
    WR_SCENE_PARAM_LIGHT_AT,
    WR_SCENE_PARAM_LIGHT_COLOUR,
    WR_SCENE_PARAM_LIGHT_STRENGTH,
    WR_SCENE_PARAM_LIGHT_SIZE,
    WR_SCENE_PARAM_LIGHT_SHADOW,
    WR_SCENE_PARAM_ENVIRONMENT_TURN,
    WR_SCENE_PARAM_ENVIRONMENT_STRENGTH,
    WR_SCENE_PARAM_EYE,
    WR_SCENE_PARAM_TARGET,
    WR_SCENE_PARAM_UP,
    WR_SCENE_PARAM_FIT,
    WR_SCENE_PARAM_FRAME,
    WR_SCENE_PARAM_FOV,
    WR_SCENE_PARAM_CAMERA_SIZE,
    WR_SCENE_PARAM_AT,
    WR_SCENE_PARAM_SIZE,
    WR_SCENE_PARAM_HIDDEN,
    WR_SCENE_PARAM_STILL,
    WR_SCENE_PARAM_BACKGROUND,
    WR_SCENE_PARAM_BACKGROUND_TOP,
    WR_SCENE_PARAM_BACKGROUND_BOTTOM,
    WR_SCENE_PARAM_EXPOSURE,
    WR_SCENE_PARAM_CELL_SIZE,
    WR_SCENE_PARAM_CELL_MM,
    WR_SCENE_PARAM_CELL_HEIGHT,
    WR_SCENE_PARAM_COUNT
} WrSceneParamId;

typedef struct WrSceneParam {
    const char *command; /* command that sets it: "material" */
    const char *form;    /* form of that command; NULL: all forms */
    const char *name;    /* of the argument; for a positional one, the word shown in help */
    bool positional, required;
    bool of_light;      /* `place` is in a WrLight, else in a WrScene */
    bool sparse;        /* printed only if it is not the default */
    bool filled;        /* the command uses the default if it is absent; else it is unchanged */
    size_t place;       /* offset in bytes of `components` doubles, or of a bool */
    int components;     /* 1..3; 0: a switch, off or on */
    double low, high;   /* of each number, inclusive */
    double fallback[3]; /* in a new scene */
    bool planned;       /* another value may change the plan of a picture */
    const char *unit;   /* "degrees"; NULL: none */
    const char *shape;  /* "r,g,b"; NULL: by its components */
    const char *label;  /* in panels; NULL: not shown there */
    const char *help;   /* a few words */
    double soft_low, soft_high; /* slider range */
    int decimals;               /* displayed decimals; -1: up to four significant digits */
    bool logarithmic;           /* logarithmic slider; soft_low > 0 */
} WrSceneParam;

extern const WrSceneParam wr_scene_params[WR_SCENE_PARAM_COUNT];

/* Row `i` of a command's form (form NULL: the rows of all forms); NULL past the last. */
const WrSceneParam *wr_scene_param(const char *command, const char *form, int i);

/* Its value in `owner`, the scene or the light: numbers, 1 or 0 for a switch. values: [3] */
void wr_scene_param_get(const WrSceneParam *param, const void *owner, double *values);
void wr_scene_param_set(const WrSceneParam *param, void *owner, const double *values);

/* Sets every parameter of a scene, or of a light, to its default. */
void wr_scene_params_reset(void *owner, bool of_light);
