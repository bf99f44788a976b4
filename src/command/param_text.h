/* param_text.h - text form of a scene parameter's value in command lines; shared by the command printer and the
   window's rows. */
#pragma once

typedef struct WrSceneParam WrSceneParam;
typedef struct WrText WrText;

/* Appends "off" or "on" for a switch, else the numbers separated by commas.
   values: [3], as wr_scene_param_get fills them. */
void wr_param_text(const WrSceneParam *param, const double *values, WrText *text);
