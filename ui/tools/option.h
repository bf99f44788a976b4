/* option.h - the row of options under the menu: what the tool in hand needs. Each tool puts its own there. */
#pragma once
#include "ui/state/app_state.h"

#include <stdbool.h>

typedef struct WrBrushModeInfo WrBrushModeInfo;

typedef struct WrOption {
    const char *label; /* "" for none */
    double units;      /* width that `draw` gets */
    double extra;      /* units that it takes besides */
    void (*draw)(WrApp *app, double width);
    bool here; /* wanted by the tool as it is */
} WrOption;

/* As many as fit, in their order; the rest in a popup. */
void wr_option_row(WrApp *app, const WrOption *items, int count);
/* The brush's picture, the tool's own options, then the brush's. first: [first_count <= 12]. */
void wr_option_brush_row(WrApp *app, const WrOption *first, int first_count);

/* Values of the brush. width: pixels. */
void wr_option_mode(WrApp *app, double width);
void wr_option_fill_mode(WrApp *app, double width); /* only modes that can fill an area */
void wr_option_strength(WrApp *app, double width);
void wr_option_to_height(WrApp *app, double width);
void wr_option_opacity(WrApp *app, double width);
void wr_option_hardness(WrApp *app, double width);
void wr_option_pressure(WrApp *app, double width);
void wr_option_symmetry(WrApp *app, double width);
const WrBrushModeInfo *wr_option_mode_of(const WrApp *app); /* what the brush's mode uses */
