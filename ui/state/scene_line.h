/* scene_line.h - command lines that change the scene. */
#pragma once
#include "ui/state/app_state.h"

typedef struct WrLight WrLight;
typedef struct WrSceneParam WrSceneParam;
typedef struct WrText WrText;

/* Run a scene command whose value was being dragged; clears the line. */
void wr_scene_run(WrApp *app, WrText *line);
/* Appends " name=value": a number, several, or a switch. values: [3] */
void wr_line_param(WrText *line, const WrSceneParam *param, const double *values);
/* Appends the whole line of a light: what a `light` line leaves out would go back to its default. index: from 0. */
void wr_line_light(WrText *line, const WrLight *light, int index);
