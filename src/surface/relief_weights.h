/* relief_weights.h - weights of the table's heights on a mesh: masks, and the blended planes of a box projection.

   At a place of a face the relief is

       F = m sum of w[k] T(u[k], v[k])

   T the table's heights. Without blending there is one term, at the face's own (u,v).

   m = 0 on faces of other materials than the listed ones, and beyond the angle to a direction d:

       hard   m = 1 on whole triangles whose normal is within `facing_deg` of d, else 0
       soft   m = S((n.d - cos(angle + soft)) / (cos(angle) - cos(angle + soft))),  S(t) = 3 t^2 - 2 t^3

   A mask table M multiplies m by M at the mesh's own (u,v), whatever the projection: its B-spline, limited to 0..1.
   It is 0 on triangles without (u,v) of their own.

   n is the interpolated normal; `out` and `in` are the directions from and to the projection's z axis, of a
   spherical one its centre.

   Blending: s is the interpolated mean normal of all faces about a point, weighted by their angles: it has no
   steps, whatever the creases. With t[k] the ratio of |s[k]| to the largest of the three,

       w[k] = S((t[k] - 1 + blend) / blend), divided by the sum of the three

   so F runs on across all edges. u[k] and v[k] are those of the box's plane across axis k, on the side of s[k]. */
#pragma once
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrProjection WrProjection;
typedef struct WrTriangles WrTriangles;

/* The projection's axes and origin, in the mesh's coordinates. */
typedef struct WrProjectionFrame {
    WrVec3 axis[3], at;
    double scale; /* millimetres per unit of the mesh */
} WrProjectionFrame;

/* Numbers with derivatives are followed by those by the weights b1, b2 of the face's corners 1 and 2. */
#define WR_RELIEF_TAPS 3
typedef struct WrReliefTap {
    double u, v, weight; /* weight: m w[k] */
    double u_b[2], v_b[2], weight_b[2];
} WrReliefTap;

typedef struct WrReliefWeights WrReliefWeights;

bool wr_relief_is_weighted(const WrProjection *projection);
/* Weights of the projected mesh; NULL on errors: no such material; no memory. mask: shared; NULL: none; else the mesh
 * has mask_uv. */
WrReliefWeights *wr_relief_weights_new(const WrTriangles *mesh, const WrProjection *projection,
                                       const WrProjectionFrame *frame, const WrField *mask,
                                       WrError *err);
void wr_relief_weights_free(WrReliefWeights *weights);
/* The number of a part's material, from 1; parts that a tile divided share one, and follow each other. */
int wr_relief_number(const WrTriangles *mesh, int32_t part);
/* True if the part is in a list of materials, by its name or that number. */
bool wr_relief_lists(const char *list, const WrTriangles *mesh, int32_t part);
/* True if F runs on across edges where (u,v) does not. */
bool wr_relief_is_blended(const WrTriangles *mesh);
/* False if m is 0 on the whole face. */
bool wr_relief_covers(const WrTriangles *mesh, int32_t face);

/* The mask table; NULL: none. */
const WrField *wr_relief_mask(const WrTriangles *mesh);
/* The mesh's own (u,v) there, at which a mask table is read. */
void wr_relief_mask_uv(const WrTriangles *mesh, int32_t face, double b1, double b2, double uv[2]);

/* The terms of F; mesh: with weights. Returns their number, 0 where m is 0. Blended: one for each plane, some of
 * weight 0. */
int wr_relief_taps(const WrTriangles *mesh, int32_t face, double b1, double b2,
                   WrReliefTap taps[WR_RELIEF_TAPS]);

/* Sum of terms, and its derivatives by b1 and b2. Zero-initialise. */
typedef struct WrReliefSum {
    double f, f_b[2];
    double fu, fv; /* weighted slopes, each by its own u and v */
} WrReliefSum;
/* f, fu, fv: of T at (u, v). */
void wr_relief_add(WrReliefSum *sum, const WrReliefTap *tap, double f, double fu, double fv);
/* The sum's derivatives by the face's own u and v. Where these have no area: the weighted slopes. */
void wr_relief_slopes(const WrTriangles *mesh, int32_t face, const WrReliefSum *sum, double *fu,
                      double *fv);
