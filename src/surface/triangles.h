/* triangles.h - a triangle mesh: corners with normals and texture coordinates, in parts with the names
   of their materials.

   Object space, the file's own unit and axes. Independent of files: image/mesh.h reads those. Immutable
   once created: any number of threads may read it. Processing of a file's data:

   - corners of equal position, normal and (u,v) are merged;
   - a missing normal, or one that is 0 or NaN, becomes the mean of the face normals about the position,
     weighted by the corners' angles (of all faces that share the position), or, if that is 0, the
     face's own (HC136);
   - missing texture coordinates are 0: u and v are constant on such a triangle, so that its slopes are
     0;
   - triangles with two equal positions have no area and are removed;
   - a closed body that is inside out is reversed;
   - triangles are sorted along a space-filling curve, part by part, and each begins at the corner
     between its two shortest edges, whose cross product is the most exact normal (HC133). */
#pragma once
#include "base/vec.h"
#include "surface/surface.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrPatches WrPatches;
typedef struct WrReliefWeights WrReliefWeights;

#define WR_TRIANGLES_MAX 9000000 /* indices of triangles are exact as floats */
#define WR_TRIANGLE_PARTS_MAX 4096
#define WR_TRIANGLE_NAME 64

typedef struct WrTrianglePart {
    char name[WR_TRIANGLE_NAME]; /* its material's, truncated; may be empty */
    int32_t first, count;        /* triangles */
    bool mapped;                 /* has texture coordinates */
    int32_t patch;               /* index of its source patch; 0 if there are none */
    int32_t number; /* of its material if a tile divided the parts, from 1; 0: 1 + its index */
} WrTrianglePart;

/* Statistics and repairs, for reports. */
typedef struct WrTrianglesReport {
    int32_t no_area;     /* removed triangles ... */
    int32_t no_normal;   /* corners whose normal was missing ... */
    int32_t bad_normal;  /* ... 0 or NaN ... */
    int32_t face_normal; /* ... of which this many became the face's */
    int32_t bad_uv;      /* corners whose u or v was NaN, or beyond 1e6: treated as missing */
    int32_t no_map;      /* triangles without texture coordinates */
    int32_t
        collinear; /* mapped triangles whose (u,v) have no area: no tangent frame, slopes are exact */
    int32_t mirrored;    /* mapped triangles whose (u,v) are mirrored */
    bool inside_out;     /* the body was reversed */
    float no_area_at[3]; /* ... and the middle of the first of them, */
    bool no_area_known;  /* unless the mesh comes from a document */
    int32_t near_uv; /* corners distinguished from another only by a rounding of (u,v) (HC129) */
} WrTrianglesReport;

typedef struct WrTriangle {
    int32_t corner[3];
} WrTriangle;

/* One corner. Eight numbers, which kernels load at once. */
typedef struct WrTriangleCorner {
    float p[3], n[3]; /* position; unit normal */
    float u, v;
} WrTriangleCorner;

typedef struct WrTriangles {
    int refs;                        /* atomic; private to triangles.c */
    const WrTriangleCorner *corners; /* [corner_count], owned */
    const WrTriangle *triangles;     /* [triangle_count], owned */
    const WrTrianglePart *parts;     /* [part_count], owned; covering all triangles in order */
    int32_t corner_count, triangle_count, part_count;
    bool closed;              /* each directed edge is matched once by its reverse: a body */
    bool faceted;             /* the three normals of each triangle are bit-identical */
    bool mapped;              /* some triangle has texture coordinates */
    double centre[3], radius; /* bounding sphere; radius > 0 */
    uint64_t key;             /* hash of its content */
    WrTrianglesReport report;
    WrPatches *
        patches; /* source patches (patches.h), whose (u,v) the corners have; owned; NULL: a mesh */
    WrReliefWeights *
        weights; /* of a projected mesh (relief_weights.h); owned; NULL: F is the table's at (u,v) */
    const float (*mask_uv)[2]; /* [3 triangle_count] of the source; owned; NULL: none */
} WrTriangles;

/* Arrays of a file; borrowed for the call. */
typedef struct WrTrianglesSource {
    const float (*points)[3];    /* [point_count]; finite, within 1e30 of 0 */
    const float (*normals)[3];   /* [point_count]; any length; or NULL */
    const float (*uv)[2];        /* [point_count]; NaN: missing; or NULL */
    const float (*mask_uv)[2];   /* [point_count] the file's (u,v) of a projected mesh; or NULL */
    const int32_t (*corners)[3]; /* [triangle_count], indices of points */
    int32_t point_count, triangle_count;
    const WrTrianglePart
        *parts; /* in order, covering all triangles (`mapped` is ignored); NULL: one without name */
    int32_t part_count;
} WrTrianglesSource;

/* Errors: no triangle has an area; too many; an index, a part or a point out of range; out of memory. */
WrTriangles *wr_triangles_new(const WrTrianglesSource *source, WrError *err);
WrTriangles *wr_triangles_share(const WrTriangles *triangles); /* constant time */
void wr_triangles_free(WrTriangles *triangles);                /* NULL is allowed */
/* The unit square of two triangles with (u,v) = (x,y): shown for a scene whose mesh is missing. */
WrTriangles *wr_triangles_square(void);

/* Serialises a mesh as floats for documents; wr_triangles_deserialize restores it bit for bit. The block is
 * allocated by wr_alloc, `count` floats, all finite. */
float *wr_triangles_serialize(const WrTriangles *triangles, size_t *count);
WrTriangles *wr_triangles_deserialize(const float *block, size_t count, WrError *err);

/* Gradients of u and v on a triangle with positions p and (u,v): du/dP, dv/dP, in its plane, and its
 * unit normal.
 *
 *   grad u = n x (u0 e0 + u1 e1 + u2 e2) / 2A,  ei the edge opposite corner i     Mikkelsen 2010
 *
 * Uses no tangents: sheared, mirrored and collinear (u,v) are exact. false: no area, or numbers beyond
 * double. */
bool wr_triangle_gradients(const WrVec3 p[3], const double uv[3][2], WrVec3 *normal, WrVec3 *grad_u,
                           WrVec3 *grad_v);

static inline const WrTriangleCorner *wr_triangle_corner(const WrTriangles *t, int32_t triangle,
                                                         int k)
{
    return &t->corners[t->triangles[triangle].corner[k]];
}

#define WR_UV_OVERLAP_CELLS 512   /* of the grid of wr_triangles_overlap, for reports */
#define WR_UV_OVERLAP_NOTED 0.005 /* a smaller share is not reported */

/* Overlap of the triangles' (u,v), modulo 1: painting there affects several places at once. */
typedef struct WrUvOverlap {
    double share;    /* 0..1 of the covered area that is covered by two or more */
    double at[2];    /* u, v of the first such place, lowest v first; only if share > 0 */
    int32_t outside; /* triangles that extend beyond 0..1, where the table repeats */
} WrUvOverlap;
/* Measured on a grid of `cells` x `cells`, 1..4096. */
WrUvOverlap wr_triangles_overlap(const WrTriangles *triangles, int cells);

/* Rows of `size` bytes, a multiple of 4, with equal bits get the same index, 0 .. kinds - 1 in the
 * order of their first occurrence. */
bool wr_weld(const void *rows, size_t size, int32_t count, int32_t *to, int32_t *kinds,
             WrError *err);

/* ---- points ---- */

/* Search for the points of a mesh or patch set with given texture coordinates.

   Texture coordinates are compared modulo 1, as the table repeats; where they overlap there are several
   points, and none where the mesh leaves a gap. */

/* One such point: a triangle of a mesh with its weights of corners 1 and 2; or a patch with its own u
 * and v. */
typedef struct WrTrianglesPlace {
    int32_t index;
    double share[2]; /* 0..1 */
} WrTrianglesPlace;

/* Finds them, in the order of the triangles or patches; an edge shared by two of them counts once.
 *
 * out      [most] the first ones
 * Returns  their total number */
int64_t wr_triangles_find(const WrTriangles *triangles, double u, double v, int most,
                          WrTrianglesPlace *out);
/* The surface point there, as used in shading. n is the shading normal; Pu and Pv are perpendicular to
 * it, so that slopes of the table tilt it by their gradient over the surface:
 *
 *   Pu = |N| grad v x n,  Pv = |N| n x grad u,  |N| = 1 / |grad u x grad v|
 *
 * Blinn's formula then yields unit(n - grad F). Where (u,v) are mirrored, Pu and Pv have the opposite
 * sign. Second derivatives and those of n are 0. Where (u,v) have no area, |N| is 1. */
void wr_triangles_at(const WrTriangles *triangles, const WrTrianglesPlace *place,
                     WrSurfacePoint *out);
