/* paint.h - drawing of motions and dabs on a table, once for each symmetry copy.
   Private to this module. */
#pragma once
#include "brush/coverage.h"
#include "brush/displace_modes.h"
#include "brush/mesh_dab.h"
#include "brush/footprint.h"

#include <stdbool.h>

/* ---- dabs ---- */

struct WrDraw {
    WrCoverage cover; /* its maker contains ground and brush */
    WrMover mover;
    bool moves;     /* moving dabs; else coverage */
    WrCopy *copies; /* owned */
    int copy_count;
    WrMeshPiece piece; /* on a mesh: the piece of the path that dabs are on */
};

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

/* ---- strokes ---- */

/* Positions in texels, sanitised brushes, and single dabs without a stroke.
   Texel coordinates as in capsule.h. */

/* The brush with every value limited to its range: NaN becomes 0, larger values the largest; spacing
 * and reach of 0 become the mode's defaults. */
WrBrush wr_brush_sane(const WrBrush *brush);

/* Texel coordinates of (u, v); on a periodic axis -0.5 <= x < W - 0.5, on a clamped one limited to
 * +-4e9. False, with unchanged outputs, if either is not finite. */
bool wr_paint_place(const WrField *field, double u, double v, double *x, double *y);

/* One round dab of pressure 1 of a brush that consists of motions and needs neither the initial heights
 * nor copies. */
bool wr_paint_is_plain(const WrBrush *brush);
void wr_paint_dab(WrField *field, const WrBrush *brush, double x, double y);
