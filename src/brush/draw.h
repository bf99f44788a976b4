/* draw.h - motions and dabs put onto a table, once for each copy that symmetry makes.
   Private to this module. */
#pragma once
#include "brush/coverage.h"
#include "brush/displace_modes.h"

#include <stdbool.h>

typedef struct WrDraw {
    WrCoverage cover; /* its maker knows ground and brush */
    WrMover mover;
    bool moves;     /* dabs change what they find; else they cover */
    WrCopy *copies; /* owned */
    int copy_count;
} WrDraw;

/* brush: sane. */
void wr_draw_init(WrDraw *draw, const WrBrushGround *ground, const WrBrush *brush);
void wr_draw_fini(WrDraw *draw);

/* Is the stroke drawn by motions of the round brush, or else by dabs? */
bool wr_draw_by_motions(const WrBrush *brush);
void wr_draw_motion(WrDraw *draw, double x, double y, double dx, double dy, double pressure_start,
                    double pressure_end);
void wr_draw_dab(WrDraw *draw, const WrDab *dab);
double wr_draw_height(WrDraw *draw, double x, double y, double radius);
/* Make the heights of what was drawn, as wr_coverage_make does. */
bool wr_draw_finish(WrDraw *draw, double until);
