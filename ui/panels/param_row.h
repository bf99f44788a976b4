/* param_row.h - a row of a panel for a number or a colour of the scene, by its row in scene/param.h. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/toolkit/gui.h"

typedef struct WrSceneParam WrSceneParam;
typedef struct WrText WrText;

/* How a slider goes over it. */
WrNumber wr_param_slider(const WrSceneParam *param);
/* Its label and slider, or colour, in the scene itself: what is dragged shows at once, and one command is run at the
 * end. Not of a light's, a pair's or a vector's. */
void wr_param_row(WrApp *app, const WrSceneParam *param);
/* Three numbers in a row, whatever they are of. */
WrEdit wr_param_vector(const char *label, const char *const id[3], const WrNumber *spec,
                       double v[3]);
/* Its vector so, and one command at the end. */
void wr_param_vector_row(WrApp *app, const WrSceneParam *param, const char *label,
                         const char *const id[3], const WrNumber *spec);
