/* brush_strength.h - the strength of brushes, fills, stamps and shapes: a height while heights are painted, a share of the
   mask while a mask is. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/toolkit/gui.h"

#include "brush/brush.h"

/* Edits go to the active layer's mask. */
bool wr_paints_mask(const WrApp *app);
/* The setting that strength sliders and keys change now; valid until the settings go. */
double *wr_strength_setting(WrApp *app);
/* Its slider. */
WrNumber wr_strength_slider(const WrApp *app);
/* The brush as it paints now. */
WrBrush wr_brush_now(const WrApp *app);
