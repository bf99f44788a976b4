/* brush_outline.h - what lies over the canvas while the brush is in hand. */
#pragma once
#include "ui/state/app_state.h"

#include <stdbool.h>

void wr_brush_overlay(WrApp *app);
typedef struct WrBrushMark { /* the shape of the next dab */
    double radius;           /* texels; follows the pressure of a stroke under way */
    double aspect, turn;     /* length over breadth; radians, anticlockwise as seen */
    bool square;             /* a stamp */
    bool erases;
} WrBrushMark;
#define WR_BRUSH_MARK_POINTS 48
WrBrushMark wr_brush_mark(const WrApp *app);
/* Its outline about (0,0): texels to the right and DOWN, [WR_BRUSH_MARK_POINTS]; returns how many. */
int wr_brush_mark_points(const WrBrushMark *mark, double points[][2]);
void wr_brush_show_string(const WrApp *app); /* from what is drawn to the pointer */
