/* brush_outline.h - overlays of the brush on the canvas. */
#pragma once
#include "ui/app/state/app_state.h"

#include <stdbool.h>

void wr_brush_overlay(WrApp *app);
typedef struct WrBrushMark { /* shape of the next dab */
    double radius;           /* texels; depends on the pressure of the present stroke */
    double aspect, turn;     /* length divided by width; radians, anticlockwise on the screen */
    bool square;             /* a stamp */
    bool erases;
} WrBrushMark;
#define WR_BRUSH_MARK_POINTS 48
WrBrushMark wr_brush_mark(const WrApp *app);
/* Its outline about (0,0): texels to the right and DOWN, [WR_BRUSH_MARK_POINTS]; returns the number of points. */
int wr_brush_mark_points(const WrBrushMark *mark, double points[][2]);
void wr_brush_show_string(const WrApp *app); /* from the drawn position to the pointer */
