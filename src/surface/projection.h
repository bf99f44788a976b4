/* projection.h - texture coordinates of a mesh by projection, crease normals, and texture seams.

   A projection derives a new mesh from the one of a file, which stays as it is. All results are the same
   bits on every machine, so that documents store the file's mesh and the parameters only.

   The axes x, y, z here are those of the projection: the mesh's, turned, from the origin `at`; lengths are
   in millimetres. Seen from outside, u goes to the right and v up:

       planar       u = x / w                        v = y / h
       box          each triangle by the largest component of its face normal (of equal ones the first of
                    x, y, z): on the sides u is horizontal and v = z / h, on top v = y / h
       cylindrical  u = n angle / (2 pi)             v = z / h
       spherical    u = n longitude / (2 pi)         v = R latitude / h

   n, the number of cells round, is the whole number nearest to 2 pi R / w, so that the table runs on across
   the seam; R is the mean distance of the surface from the axis (centre), weighted by the area that faces it.
   The corners of a triangle have angles within half a turn of each other. On the axis the angle is the
   mean of the triangle's other corners. */
#pragma once
#include "base/length_unit.h"
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrTriangles WrTriangles;

typedef enum WrProjectionKind {
    WR_PROJECTION_UV, /* the file's own */
    WR_PROJECTION_PLANAR,
    WR_PROJECTION_BOX,
    WR_PROJECTION_CYLINDRICAL,
    WR_PROJECTION_SPHERICAL,
    WR_PROJECTIONS
} WrProjectionKind;
extern const char *const wr_projection_names[WR_PROJECTIONS + 1]; /* NULL-terminated */

/* Direction of a mask: along the projection's axes, or from and to its z axis, of a spherical one its centre. */
typedef enum WrFacing {
    WR_FACING_ANY, /* no mask */
    WR_FACING_X,
    WR_FACING_Y,
    WR_FACING_Z,
    WR_FACING_MINUS_X,
    WR_FACING_MINUS_Y,
    WR_FACING_MINUS_Z,
    WR_FACING_OUT,
    WR_FACING_IN,
    WR_FACINGS
} WrFacing;
extern const char *const wr_facing_names[WR_FACINGS + 1]; /* NULL-terminated */

#define WR_CREASE_NONE 180.0
#define WR_PROJECTION_MATERIALS 2048 /* bytes */
#define WR_PROJECTION_CELLS 65536    /* largest |u| and |v| */

typedef struct WrProjection {
    WrProjectionKind kind;
    WrLengthUnit unit;  /* of the mesh's coordinates */
    double cell[2];     /* w, h: size of a table cell, mm, above 0 */
    double turn_deg[3]; /* of the projection about the mesh's x, then y, then z */
    bool placed;
    double
        at[3]; /* if placed: its origin, in the mesh's coordinates; else the centre of the mesh */
    int udim; /* kind uv: tile of the file's (u,v) that shows the table, by wr_triangles_of_tile; 0: all */
    double origin[3]; /* that was subtracted from the file's points; not used by the projection */
    double
        crease_deg; /* 0..180; below 180 normals are computed from the faces: edges of a larger angle are
                          sharp, others smooth. 180: the mesh's own normals */
    /* Masks and blending (relief_weights.h): */
    WrFacing facing;
    double facing_deg, facing_soft_deg;      /* 0..180 each */
    char materials[WR_PROJECTION_MATERIALS]; /* names or numbers, separated by commas; empty: all */
    double blend; /* 0..1, of the box's planes; 0: each triangle has one plane */
} WrProjection;

extern const WrProjection wr_projection_default;

/* Derives the mesh with these texture coordinates, normals and weights of the relief; a reference to `mesh`
 * itself if there is nothing to change. For cylinders and spheres, triangles over more than 5 degrees are divided; neighbours
 * divide a shared edge alike. mask: a table over the mesh's own (u,v), by which the relief is multiplied
 * (relief_weights.h); it is shared; NULL: none.
 * Errors: too many triangles or cells, a material that the mesh has not, out of memory. */
WrTriangles *wr_triangles_project(const WrTriangles *mesh, const WrProjection *projection,
                                  const WrField *mask, WrError *err);

/* n and R of the formulas above, for reports; n is 0 for projections without an axis. */
int wr_projection_round(const WrTriangles *mesh, const WrProjection *projection, double *radius_mm);

#define WR_TEXTURE_SEAMS 8 /* runs that are listed */

/* A connected run of seam edges. */
typedef struct WrTextureSeam {
    double length;
    WrVec3 at, n; /* the middle of its longest edge; the mean normal of the faces there, unit */
} WrTextureSeam;

/* Edges of a mesh at which the (u,v) of the two faces differ by more than whole numbers; none if the relief is
 * blended there, or masks leave none on either face. */
typedef struct WrTextureSeams {
    int32_t edges, runs;
    double length;                       /* of the longest run */
    WrVec3 at;                           /* the middle of that run's longest edge */
    WrTextureSeam run[WR_TEXTURE_SEAMS]; /* the longest runs, in the order of their lengths */
} WrTextureSeams;

bool wr_triangles_seams(const WrTriangles *mesh, WrTextureSeams *out, WrError *err);
