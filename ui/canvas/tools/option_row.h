/* option_row.h - option row below the menu, filled by the current tool. */
#pragma once
#include "ui/app/state/app_state.h"

#include <stdbool.h>

typedef struct WrBrushModeInfo WrBrushModeInfo;

typedef struct WrOption {
    const char *label; /* "##NAME": not shown, for the search; "##": none */
    double units;      /* width for `draw` */
    double extra;      /* additional width */
    void (*draw)(WrApp *app, double width);
    bool here; /* relevant in the tool's present state */
} WrOption;

/* Show as many as fit, in order; the rest in a popup. */
void wr_option_row(WrApp *app, const WrOption *items, int count);
/* The brush's picture, the tool's own options, then the brush parameters. first: [first_count <= 12]. */
void wr_option_brush_row(WrApp *app, const WrOption *first, int first_count);

/* Brush parameters. width: pixels. */
void wr_option_mode(WrApp *app, double width);
void wr_option_fill_mode(WrApp *app, double width); /* only modes that can fill an area */
void wr_option_strength(WrApp *app, double width);
void wr_option_to_height(WrApp *app, double width);
void wr_option_opacity(WrApp *app, double width);
void wr_option_hardness(WrApp *app, double width);
void wr_option_pressure(WrApp *app, double width);
void wr_option_symmetry(WrApp *app, double width);
/* parameters used by the brush's mode */
const WrBrushModeInfo *wr_current_brush_mode(const WrApp *app);
