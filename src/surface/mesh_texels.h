/* mesh_texels.h - texels of a table within a surface distance of a point on a mesh, for brushes.

   The mesh's (u,v), times the replication and taken modulo 1 on periodic axes, place the table on it. A disc is
   flooded from triangle to triangle over edges of equal positions, so it continues on the other side of a seam
   of (u,v). The distance of a surface point p from the centre c is

       d = |p - c| + max(0, g - 1.6 |p - c|)

   with g the length of the unfolded way over the flooded triangles: where a surface bends smoothly, or at a
   right angle, d is the straight distance, without creases between facets; where it folds back, as at the rim
   of a wall, the way round counts, so the wall's other side is far off. Texels up to two beyond an island's
   edge, which no triangle covers, belong to its continued plane: interpolation near the edge reads them. */
#pragma once
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrTriangles WrTriangles;
typedef struct WrRayTree WrRayTree;
typedef struct WrMeshTexels WrMeshTexels;

typedef struct WrMeshTexelsTable {
    int width, height;
    bool periodic_u, periodic_v; /* else nothing lies beyond 0..1 */
    double ru, rv;               /* replication */
} WrMeshTexelsTable;

/* Shares the mesh. Its discs use scratch memory: one thread at a time. About 24 bytes per triangle and one per
 * texel, besides a ray tree. 1.1 s for a million triangles. before: of another table, whose ray tree is shared if the
 * mesh is the same; or NULL. Errors: no (u,v), no memory, cancelled. */
WrMeshTexels *wr_mesh_texels_new(const WrTriangles *mesh, const WrMeshTexelsTable *table,
                                 const WrMeshTexels *before, WrError *err);
void wr_mesh_texels_free(WrMeshTexels *texels); /* NULL is allowed */
/* True if it was made for that mesh and table. */
bool wr_mesh_texels_fit(const WrMeshTexels *texels, const WrTriangles *mesh,
                        const WrMeshTexelsTable *table);
/* The ray tree of all its triangles; NULL for another mesh. Borrowed. */
const WrRayTree *wr_mesh_texels_tree(const WrMeshTexels *texels, const WrTriangles *mesh);
/* The mean side of a texel on the surface: the square root of area by area; object units. 0: no (u,v). */
double wr_mesh_texel_side(const WrMeshTexels *texels);
double wr_mesh_texel_side_of(const WrTriangles *mesh, const WrMeshTexelsTable *table);

/* Where mirrors of strokes cross unless they are placed: the origin if the mesh is about it, else its centre. */
WrVec3 wr_mesh_mirrors_at(const WrTriangles *mesh);

/* A point of the surface. */
typedef struct WrMeshSpot {
    WrVec3 p, n; /* n: of the triangle, unit */
    int32_t triangle;
} WrMeshSpot;

/* The nearest one to p. */
WrMeshSpot wr_mesh_texels_nearest(const WrMeshTexels *texels, WrVec3 p);
/* Its position in the table: texels, y down, centres at whole numbers, not wrapped. */
void wr_mesh_texels_place(const WrMeshTexels *texels, const WrMeshSpot *spot, double *x, double *y);
/* Unit vector in the triangle's plane in which u grows. */
WrVec3 wr_mesh_texels_along(const WrMeshTexels *texels, const WrMeshSpot *spot);

typedef struct WrMeshDisc {
    WrMeshSpot centre;
    double radius; /* object units */
    WrVec3 along;  /* direction of the local x axis; made tangent */
    bool clips;    /* leaves out faces turned away from `eye`, fading within 10 degrees */
    WrVec3 eye;
    bool mirrored; /* the local y axis is turned round, as in a mirror */
} WrMeshDisc;

typedef struct WrMeshTexel {
    int32_t x, y; /* in the table */
    double dx,
        dy; /* from the centre in the disc's own plane, in texels of the mean side, y down; their length is
                      the distance d above */
    double weight; /* 0..1: 1 unless it is clipped */
} WrMeshTexel;

/* Number of shared texels in all discs so far. */
int64_t wr_mesh_texels_shared(const WrMeshTexels *texels);

/* The texels of a disc, each once, in the table's order; of a texel's several places in it the nearest counts.
 * Borrowed until the next call. */
const WrMeshTexel *wr_mesh_texels_disc(WrMeshTexels *texels, const WrMeshDisc *disc, int *count);

/* True if the last disc reaches over a seam of (u,v): neighbours on the surface are none in the table. */
bool wr_mesh_texels_crossed(const WrMeshTexels *texels);

/* A picture that is projected onto the mesh, as by a slide projector at the eye. */
typedef struct WrMeshSlide {
    WrVec3 eye, middle; /* of the picture; it stands across the line between them */
    WrVec3 right, up;   /* from the middle to those of its sides */
    bool parallel;      /* the rays are parallel to that line; else they leave the eye */
    double (*value)(const void *ctx, double s, double t); /* 0..1, at 0..1 to the right and up */
    const void *ctx;
} WrMeshSlide;

/* Sets cover, [height][width] and 0 before, to the picture's values where faces turn to the eye and no face is in
 * the way, fading as for discs; of a texel's several places the largest value counts. False: cancelled. */
bool wr_mesh_texels_slide(WrMeshTexels *texels, const WrMeshSlide *slide, float *cover);
