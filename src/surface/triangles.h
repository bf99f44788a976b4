/* triangles.h - a surface of triangles: corners with normals and texture coordinates, in parts with the names of
   their materials.
   Object space, the file's own unit and axes. Knows no files: image/mesh.h reads those. Immutable once made:
   any number of threads may read it.

   What is made of what a file says:
   - corners of equal position, normal and (u,v) become one;
   - a missing normal, or one that is 0 or no number, is the mean of the face normals about the place, weighted by the
     corners' angles (of all faces that share the place), or, where that is 0, the face's own (HC136);
   - missing texture coordinates are 0: u and v do not change over such a triangle, so that its slopes are 0;
   - triangles with two equal places have no area and are left out;
   - a body that is closed but inside out is turned outside in;
   - triangles are sorted along a space-filling curve, part by part, and each begins at the corner between its two
     shortest edges, whose cross product is the most exact normal (HC133). */
#pragma once
#include "base/vec.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrPatches WrPatches;

#define WR_TRIANGLES_MAX 9000000 /* numbers of triangles are exact as floats */
#define WR_TRIANGLE_PARTS_MAX 4096
#define WR_TRIANGLE_NAME 64

typedef struct WrTrianglePart {
    char name[WR_TRIANGLE_NAME]; /* its material's, cut; may be empty */
    int32_t first, count;        /* triangles */
    bool mapped;                 /* has texture coordinates */
    int32_t patch;               /* that it was cut from; 0 where there are none */
} WrTrianglePart;

/* What was found and mended, for whoever is told. */
typedef struct WrTrianglesTold {
    int32_t no_area;     /* triangles that were left out */
    int32_t no_normal;   /* corners whose normal was missing ... */
    int32_t bad_normal;  /* ... 0 or no number ... */
    int32_t face_normal; /* ... of which so many took their face's */
    int32_t bad_uv;      /* corners whose u or v was no number, or beyond 1e6: taken as missing */
    int32_t no_map;      /* triangles without texture coordinates */
    int32_t
        collinear; /* mapped triangles whose (u,v) have no area: no tangent frame, slopes are exact */
    int32_t mirrored; /* mapped triangles whose (u,v) run the other way round */
    bool inside_out;  /* the body was turned */
    int32_t near_uv;  /* corners that only a rounding of (u,v) parts from another (HC129) */
} WrTrianglesTold;

typedef struct WrTriangle {
    int32_t corner[3];
} WrTriangle;

/* One corner. Eight numbers, which kernels load at once. */
typedef struct WrTriangleCorner {
    float p[3], n[3]; /* place; unit normal */
    float u, v;
} WrTriangleCorner;

typedef struct WrTriangles {
    int refs;                        /* atomic; private to triangles.c */
    const WrTriangleCorner *corners; /* [corner_count], owned */
    const WrTriangle *triangles;     /* [triangle_count], owned */
    const WrTrianglePart *parts;     /* [part_count], owned; together all triangles, in order */
    int32_t corner_count, triangle_count, part_count;
    bool closed;              /* each directed edge is met once by its reverse: a body */
    bool faceted;             /* the three normals of each triangle have the same bits */
    bool mapped;              /* some triangle has texture coordinates */
    double centre[3], radius; /* of a ball that holds it; radius > 0 */
    uint64_t key;             /* of its content: equal for equal ones */
    WrTrianglesTold told;
    WrPatches *
        patches; /* cut from these (patches.h), whose (u,v) the corners have; owned; NULL: a mesh */
} WrTriangles;

/* Arrays as a file has them; borrowed for the call. */
typedef struct WrTrianglesSource {
    const float (*points)[3];    /* [point_count]; finite, within 1e30 of 0 */
    const float (*normals)[3];   /* [point_count]; any length; or NULL */
    const float (*uv)[2];        /* [point_count]; not a number: missing; or NULL */
    const int32_t (*corners)[3]; /* [triangle_count], indices of points */
    int32_t point_count, triangle_count;
    const WrTrianglePart *
        parts; /* in order, together all triangles (mapped is not looked at); NULL: one without name */
    int32_t part_count;
} WrTrianglesSource;

/* Errors: no triangle has an area; too many; an index, a part or a point that is out of range; no memory. */
WrTriangles *wr_triangles_new(const WrTrianglesSource *source, WrError *err);
WrTriangles *wr_triangles_share(const WrTriangles *triangles); /* constant time */
void wr_triangles_free(WrTriangles *triangles);                /* fine on NULL */
/* The unit square of two triangles with (u,v) = (x,y): what a scene shows whose mesh is not there. */
WrTriangles *wr_triangles_square(void);

/* As one run of floats, which wr_triangles_unpack brings back bit for bit: how a document keeps it. The block is
 * wr_alloc's, `count` floats, all finite. */
float *wr_triangles_pack(const WrTriangles *triangles, size_t *count);
WrTriangles *wr_triangles_unpack(const float *block, size_t count, WrError *err);

/* The part that triangle i is of. */
int wr_triangles_part(const WrTriangles *triangles, int32_t i);

/* How u and v change over a triangle of places p and (u,v): du/dP, dv/dP, in its plane, and its normal, unit.
 *
 *   grad u = n x (u0 e0 + u1 e1 + u2 e2) / 2A,  ei the edge opposite corner i     Mikkelsen 2010
 *
 * No tangents: sheared, mirrored and collinear (u,v) are exact. false: no area, or numbers beyond double. */
bool wr_triangle_gradients(const WrVec3 p[3], const double uv[3][2], WrVec3 *normal, WrVec3 *grad_u,
                           WrVec3 *grad_v);

/* Of the area that the (u,v) of the triangles cover, modulo 1: the share that two or more cover, 0..1. Painting there
 * wrinkles several places at once. Measured on a grid of `cells` x `cells`, 1..4096. outside: triangles that reach
 * beyond 0..1, whose table repeats; or NULL. */
double wr_triangles_overlap(const WrTriangles *triangles, int cells, int32_t *outside);
