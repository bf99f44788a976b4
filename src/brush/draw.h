/* draw.h - drawing of motions and dabs on a table, once for each symmetry copy.
   Private to this module. */
#pragma once
#include "brush/coverage.h"
#include "brush/displace_modes.h"

#include <stdbool.h>

typedef struct WrDraw {
    WrCoverage cover; /* its maker contains ground and brush */
    WrMover mover;
    bool moves;     /* moving dabs; else coverage */
    WrCopy *copies; /* owned */
    int copy_count;
} WrDraw;

/* brush: sane. */
void wr_draw_init(WrDraw *draw, const WrBrushGround *ground, const WrBrush *brush);
void wr_draw_fini(WrDraw *draw);

/* True if the stroke consists of motions of the round brush; else of dabs. */
bool wr_draw_by_motions(const WrBrush *brush);
void wr_draw_motion(WrDraw *draw, double x, double y, double dx, double dy, double pressure_start,
                    double pressure_end);
void wr_draw_dab(WrDraw *draw, const WrDab *dab);
double wr_draw_height(WrDraw *draw, double x, double y, double radius);
/* Computes the heights of the drawn coverage, like wr_coverage_make. */
bool wr_draw_finish(WrDraw *draw, double until);
