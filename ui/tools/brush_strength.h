/* brush_strength.h - strength of brushes, fills, stamps and shapes: a height while heights are painted, a fraction
   while a mask is painted. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/toolkit/gui.h"

#include "brush/brush.h"

/* True if edits go to the active layer's mask. */
bool wr_paints_mask(const WrApp *app);
/* The setting changed by strength sliders and keys; valid as long as the settings. */
double *wr_strength_setting(WrApp *app);
/* Its slider. */
WrNumber wr_strength_slider(const WrApp *app);
/* The brush with its present strength. */
WrBrush wr_brush_now(const WrApp *app);
