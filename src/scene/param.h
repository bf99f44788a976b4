/* param.h - what of a scene is a number, a vector, a colour or a switch, each in one row: the command that sets it, its
   range, unit, default and words. Commands, the lines that a document keeps, a new scene and the window's panels go by
   it. What is a choice is a row of wr_dials (scene/dials.h). */
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
    const char *command; /* that sets it: "material" */
    const char *form;    /* the form of that command which has it; NULL: all of them */
    const char *name;    /* of the argument; of a positional, how help shows it */
    bool positional, required;
    bool of_light; /* `place` is in a WrLight, else in a WrScene */
    bool sparse;   /* printed only where it is not the default */
    bool filled;  /* the command takes the default where it is not given; else it stays as it was */
    size_t place; /* bytes from there to `components` doubles, or to a bool */
    int components;             /* 1..3; 0: a switch, off or on */
    double low, high;           /* of each number, inclusive */
    double fallback[3];         /* in a new scene */
    bool planned;               /* may another value lead to another plan of a picture? */
    const char *unit;           /* "degrees"; NULL: none */
    const char *shape;          /* "r,g,b"; NULL: by its components */
    const char *label;          /* in panels; NULL: it has no row there */
    const char *help;           /* a few words */
    double soft_low, soft_high; /* what a slider reaches */
    int decimals;               /* that it shows; -1: up to four significant digits */
    bool logarithmic;           /* it moves by equal ratios; soft_low > 0 */
} WrSceneParam;

extern const WrSceneParam wr_scene_params[WR_SCENE_PARAM_COUNT];

/* Row `i` of those that a command's form has (form NULL: the rows of all forms); NULL past the last. */
const WrSceneParam *wr_scene_param(const char *command, const char *form, int i);

/* Its value within `owner`, the scene or the light: numbers, 1 or 0 of a switch. values: [3] */
void wr_scene_param_get(const WrSceneParam *param, const void *owner, double *values);
void wr_scene_param_set(const WrSceneParam *param, void *owner, const double *values);

/* Give every parameter of a scene, or of a light, its default. */
void wr_scene_params_reset(void *owner, bool of_light);
