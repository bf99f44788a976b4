/* param_row.h - panel row of a scene number or colour, by its row in scene/param.h. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/toolkit/gui.h"

typedef struct WrSceneParam WrSceneParam;
typedef struct WrText WrText;

/* Slider range and steps of the parameter. */
WrNumber wr_param_slider(const WrSceneParam *param);
/* Label with slider or colour field, bound to the scene. A drag changes the preview; one command is run at the end.
 * Not for parameters of a light, pairs or vectors. */
void wr_param_row(WrApp *app, const WrSceneParam *param);
/* Three number fields in a row, for any value. */
WrEdit wr_param_vector(const char *label, const char *const id[3], const WrNumber *spec,
                       double v[3]);
/* Row of a vector parameter; one command at the end of a drag. */
void wr_param_vector_row(WrApp *app, const WrSceneParam *param, const char *label,
                         const char *const id[3], const WrNumber *spec);
