/* symmetry.h - the symmetry's values, axes and centre. */
#pragma once
#include "ui/state/app_state.h"

#include <stdbool.h>

void wr_symmetry_apply(WrApp *app); /* the settings' symmetry becomes the brush's, or none */
void wr_symmetry_marks(WrApp *app); /* axes, on the canvas */
bool wr_symmetry_press(WrApp *app, const WrPointer *at); /* took the centre */
void wr_symmetry_drag(WrApp *app, const WrPointer *at);
void wr_panel_symmetry(WrApp *app); /* on the canvas */
