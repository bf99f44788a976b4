/* texture_sample.h - sampling in double of pictures mapped over u and v, for the reference renderer and
   inspectors.

   The kernels intentionally have look-ups of their own. */
#pragma once
#include "scene/scene.h"

#include <stdbool.h>

/* The four texels about (u, v), borrowed from the picture, which is extended beyond its ends like a
 * table, and their bilinear weights. */
typedef struct WrTexels {
    const float *texel[4];
    double weight[4];
    bool in_u, in_v; /* false: beyond the end of a clamped axis, where the value is constant */
} WrTexels;

WrTexels wr_texture_bilinear_taps(const WrScene *scene, const WrImage *image,
                                  const WrTextureSample *laid, bool periodic_u, bool periodic_v,
                                  double u, double v);

/* Directions of a map's x, y and z at a point: x t + y b + z n; of any length. */
typedef struct WrMapAxes {
    WrVec3 t, b, n;
} WrMapAxes;

/* The frame of the scene's normal map, with AUTO resolved for the surface: GRADIENT needs no axes,
 * OBJECT uses the object's, MIKK and LECTURE those of the point. */
WrNormalFrame wr_scene_frame(const WrScene *scene);
/* The axes at a point of a parametric surface; false: undefined. */
bool wr_texture_sample_axes(WrNormalFrame frame, const WrSurfacePoint *at, WrMapAxes *axes);
/* Adds the contribution of the scene's normal map to Fu and Fv. at: n, N, Pu, Pv. axes: of the point,
 * if the frame is mikk or lecture; else NULL. Slopes of heights are added directly; a normal n_m of a
 * frame or of the object's axes corresponds to the slopes whose gradient is g = n - n_m / (n . n_m).
 * Unless slopes add, Fu and Fv, the relief's, are combined with it (wr_bump_combined). */
void wr_texture_sample_add_normals(const WrScene *scene, bool periodic_u, bool periodic_v,
                                   const WrSurfacePoint *at, const WrMapAxes *axes, double u,
                                   double v, double *fu, double *fv);
/* wr_scene_height plus the normal map's contribution at that point of a parametric surface. field:
 * NULL, for a formula: the map is periodic. */
void wr_scene_slopes(const WrScene *scene, const WrField *field, const WrSurfacePoint *at, double u,
                     double v, double *f, double *fu, double *fv);
