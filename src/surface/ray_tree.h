/* ray_tree.h - bounding volume hierarchy of a triangle mesh: rays and closest points in double precision.

   A binned SAH tree (Wald 2007) with boxes of floats, padded beyond the rounding of rays, and the watertight
   triangle test of Woop, Benthin and Wald (2013): no ray passes between two triangles that share an edge or a
   corner. Equal distances yield the triangle with the smallest index, so results depend neither on the
   tree nor on the processor. Triangles without area are never hit. Immutable once built: any number of
   threads. */
#pragma once
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrTriangles WrTriangles;
typedef struct WrRayTree WrRayTree;

/* Builds the tree of triangles [first, first + count), count 1 or more; shares the mesh. 0.8 s for a million.
 * Errors: no memory; cancelled. */
WrRayTree *wr_ray_tree_new(const WrTriangles *mesh, int32_t first, int32_t count, WrError *err);
WrRayTree *wr_ray_tree_share(const WrRayTree *tree);
void wr_ray_tree_free(WrRayTree *tree); /* NULL is allowed */

typedef struct WrRayHit {
    int32_t triangle;
    double t;        /* of o + t d */
    double share[3]; /* weights of its corners; the sum is 1 within rounding */
} WrRayHit;

/* The first hit of o + t d, d of any length but 0, for 0 < t < most. front: only triangles whose corners run
 * anticlockwise as seen from o. */
bool wr_ray_tree_closest(const WrRayTree *tree, WrVec3 o, WrVec3 d, double most, bool front,
                         WrRayHit *hit);
/* True if any triangle is hit for 0 < t < most, from either side. */
bool wr_ray_tree_any(const WrRayTree *tree, WrVec3 o, WrVec3 d, double most);
/* Distance of p from the nearest triangle, and its index; `most` and -1 if that is less. triangle: or NULL. */
double wr_ray_tree_nearest(const WrRayTree *tree, WrVec3 p, double most, int32_t *triangle);
/* Distance of p from the nearest triangle; `most` if that is less. */
double wr_ray_tree_distance(const WrRayTree *tree, WrVec3 p, double most);
