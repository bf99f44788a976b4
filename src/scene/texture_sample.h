/* texture_sample.h - a picture that is laid over u and v, looked up in double: what pictures are measured against and what
   inspectors tell. The kernels have look-ups of their own, on purpose. */
#pragma once
#include "scene/scene.h"

#include <stdbool.h>

/* The four texels about (u, v), borrowed from the picture, which goes on beyond its ends as a table does, and their bilinear
 * weights. */
typedef struct WrTexels {
    const float *texel[4];
    double weight[4];
    bool in_u, in_v; /* false: beyond the end of an axis that ends, where nothing changes */
} WrTexels;

WrTexels wr_texture_sample_texels(const WrScene *scene, const WrImage *image,
                                  const WrTextureSample *laid, bool periodic_u, bool periodic_v,
                                  double u, double v);

/* Which way a map's x, y and z run at a place: x t + y b + z n; of any length. */
typedef struct WrMapAxes {
    WrVec3 t, b, n;
} WrMapAxes;

/* Which axes the scene's normal map is of, its AUTO resolved by the surface: GRADIENT needs none of the place, OBJECT has the
 * object's, MIKK and LECTURE those of the place. */
WrNormalFrame wr_scene_frame(const WrScene *scene);
/* The axes of a place of a parametric surface; false: there are none. */
bool wr_texture_sample_axes(WrNormalFrame frame, const WrSurfacePoint *at, WrMapAxes *axes);
/* What the scene's normal map adds to Fu and Fv there. at: n, N, Pu, Pv. axes: of the place, where the frame is mikk or
 * lecture; else NULL. Slopes of heights are their own whatever the surface; a normal n_m of a frame or of the object's
 * axes is the one that slopes would give whose gradient is g = n - n_m / (n . n_m). */
void wr_texture_sample_add_normals(const WrScene *scene, bool periodic_u, bool periodic_v,
                                   const WrSurfacePoint *at, const WrMapAxes *axes, double u,
                                   double v, double *fu, double *fv);
/* wr_scene_height, with what the normal map adds at that point of a parametric surface. field: NULL, for a formula: the map
 * goes round. */
void wr_scene_slopes(const WrScene *scene, const WrField *field, const WrSurfacePoint *at, double u,
                     double v, double *f, double *fu, double *fv);
