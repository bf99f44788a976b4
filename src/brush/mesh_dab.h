/* mesh_dab.h - dabs on a mesh: a dab's shape is laid onto the texels within a surface distance.
   Private to this module.
   A stroke's path is developed into a plane, in texels of the mesh's mean size, y down: its lengths and turns
   are kept, so that spacing, jitter, presets and directions are those of strokes on a table. */
#pragma once
#include "brush/dab.h"
#include "brush/displace_modes.h"
#include "surface/mesh_texels.h"

typedef struct WrDraw WrDraw;

/* A point of the path. */
typedef struct WrMeshStep {
    double x, y; /* developed */
    WrMeshSpot spot;
    WrVec3 right; /* tangent: the developed x axis there */
} WrMeshStep;

/* The piece of the path that dabs are on. */
typedef struct WrMeshPiece {
    WrMeshStep from, to;
} WrMeshPiece;

/* The path's first point, and the one after `last`: the nearest of the surface to p. */
WrMeshStep wr_mesh_step_first(const WrMeshTexels *mesh, WrVec3 p);
WrMeshStep wr_mesh_step_next(const WrMeshTexels *mesh, const WrMeshStep *last, WrVec3 p);

/* wr_draw_dab, and the mean height under a round dab, on the mesh of the draw's ground. */
void wr_mesh_dab(WrDraw *draw, const WrDab *dab);
double wr_mesh_height(WrDraw *draw, double x, double y, double radius);
