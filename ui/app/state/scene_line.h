/* scene_line.h - command lines that change the scene. */
#pragma once
#include "ui/app/state/app_state.h"

typedef struct WrLight WrLight;
typedef struct WrSceneParam WrSceneParam;
typedef struct WrText WrText;

/* Run a scene command at the end of a drag; clears the line. */
void wr_scene_run(WrApp *app, WrText *line);
/* Another surface was chosen: a camera that was placed by hand goes to where the whole is visible. */
void wr_scene_refit(WrApp *app);
/* Appends " name=value": a number, several, or a switch. values: [3] */
void wr_line_param(WrText *line, const WrSceneParam *param, const double *values);
/* Appends the whole line of a light, since omitted values would be reset to their defaults. index: from 0. */
void wr_line_light(WrText *line, const WrLight *light, int index);
