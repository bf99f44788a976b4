/* param_text.h - a scene parameter's value as command lines write it; shared by the command printer and the window's rows.
   Layer 6. */
#pragma once

typedef struct WrSceneParam WrSceneParam;
typedef struct WrText WrText;

/* Appends "off" or "on" for a switch, else the numbers separated by commas.
   values: [3], as wr_scene_param_get fills them. */
void wr_param_text(const WrSceneParam *param, const double *values, WrText *text);
