/* symmetry.h - parameters, axes and centre of the symmetry. */
#pragma once
#include "ui/app/state/app_state.h"

#include <stdbool.h>

void wr_symmetry_apply(WrApp *app); /* copy the settings' symmetry to the brush, or none if off */
void wr_symmetry_marks(WrApp *app); /* draw axes on the canvas */
bool wr_symmetry_press(WrApp *app, const WrPointer *at); /* true if the press is on the centre */
void wr_symmetry_drag(WrApp *app, const WrPointer *at);
void wr_panel_symmetry(WrApp *app); /* over the canvas */
