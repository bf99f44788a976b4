/* param_row.h - a row of a panel for a number or a colour of the scene, by its row in scene/param.h. */
#pragma once
#include "ui/desk/desk.h"
#include "ui/gui/gui.h"

typedef struct WrSceneParam WrSceneParam;
typedef struct WrText WrText;

/* How a slider goes over it. */
WrNumber wr_param_slider(const WrSceneParam *param);
/* Its label and slider, or colour, in the scene itself: what is dragged shows at once, and one command is run at the
 * end. Not of a light's, a pair's or a vector's. */
void wr_param_row(WrApp *app, const WrSceneParam *param);
/* " name=value" of a number or a vector. */
void wr_param_line(WrText *line, const WrSceneParam *param, const double *values);
