/* mesh_relief.h - the relief P + F n of a mesh as triangles, within an error.

   For pictures, shadows, the reference and solids. Points are shared by number: the result is closed where the mesh
   is, and open where it is open. */
#pragma once
#include "base/array.h"
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;
typedef struct WrScene WrScene;
typedef struct WrTriangles WrTriangles;

/* A point of the result is (stretch (P + F n) - middle) scale. */
typedef struct WrMeshReliefRequest {
    const WrScene *scene;
    const WrField *field; /* not read with a formula */
    WrPool *pool;         /* may be NULL */
    const WrTriangles *mesh;
    WrVec3 stretch, middle;
    double scale;
    bool rounded; /* hard edges move along the mean normal, else each face along its own */
    double error; /* largest distance of the exact surface, in units of the result */
    /* The error allowed within a radius about a place of the mesh, if it is larger than `error`; INFINITY: the place
       is not seen. NULL: `error` everywhere. Any thread. */
    double (*error_at)(const void *ctx, WrVec3 centre, double radius);
    const void *ctx;
    bool fine; /* nine samples in each texel and all kinks along sides, else centres and middles */
    int32_t most;               /* triangles */
    const volatile int *cancel; /* may be NULL: only the thread's progress stops it */
} WrMeshReliefRequest;

/* Side k runs from corner k to the next one. Sides of all triangles on the same two points form a ring. */
typedef struct WrMeshReliefTriangle {
    int32_t point[3], face; /* face: the mesh's triangle */
    float b[3][2];          /* of its corners: weights of the face's corners 1 and 2 */
    int32_t ring[3]; /* the next side, 3 triangle + k, of side k's ring; itself on an open edge */
    float error, allowed; /* largest distance of its samples, in units of the result */
    int32_t longest;      /* side */
} WrMeshReliefTriangle;

typedef struct WrMeshReliefPoint {
    WrVec3 base, d; /* on the mesh; displacement: object units */
    double part;    /* of d that is applied: 1; for callers that lower the relief */
    bool crease;    /* faces of different normals or heights meet here */
} WrMeshReliefPoint;

typedef struct WrMeshRelief {
    WR_ARRAY(WrMeshReliefTriangle) triangles;
    WR_ARRAY(WrMeshReliefPoint) points;
    WR_ARRAY(float) at; /* [points][3]: their positions in the result */
    double low, high;   /* of F at points */
    WrMeshReliefRequest request;
    /* private: */
    double texels[2]; /* of the table per unit of u and v */
    double fine;      /* samples per texel along u and v */
    bool full;        /* more triangles were needed than there may be */
} WrMeshRelief;

/* The place on a face with weights b1, b2 of its corners 1 and 2: P, unit n, u and v. */
typedef struct WrMeshReliefPlace {
    WrVec3 p, n;
    double u, v;
    int32_t face;
    double b1, b2;
} WrMeshReliefPlace;

/* relief: zero-initialised; call fini even after a failure. Errors: no memory, cancelled. With more than `most`
   triangles it stops, `full` is set, and errors remain; with so many texels that `fine` sampling is hopeless it stops at once, without any. */
bool wr_mesh_relief_make(WrMeshRelief *relief, const WrMeshReliefRequest *request, WrError *err);
void wr_mesh_relief_fini(WrMeshRelief *relief);

/* Bisection divides an error by about the number of triangles. So from errors of a refinement that stopped at too many triangles
   follows one that needs fewer than `most`, of which `base` are there before: errors of every step-th triangle, their sum
   times step. INFINITY: the base alone has too many. */
int32_t wr_fitting_error_step(int32_t count);
double wr_fitting_error(double sum, int32_t base, int32_t most);

/* Of a relief that is `full`: such an error. */
double wr_mesh_relief_fitting_error(const WrMeshRelief *relief);

/* The triangles for rays and rasters, in the order of the mesh's faces, so that consecutive ones are near each other.
   Corners have no normals and are not shared; their u and v are weights of the face's corners 1 and 2.
   base_of: [triangles] the face of each; owned by the caller. NULL: no memory. */
WrTriangles *wr_mesh_relief_triangles(const WrMeshRelief *relief, int32_t **base_of, WrError *err);

WrMeshReliefPlace wr_mesh_relief_place(const WrTriangles *mesh, int32_t face, double b1, double b2);
/* The result's position of an object's point. */
WrVec3 wr_mesh_relief_position(const WrMeshRelief *relief, WrVec3 p);
/* Updates a point's position, after `part` was changed. */
void wr_mesh_relief_move(WrMeshRelief *relief, int32_t point);
/* True if the triangle has a point where faces of different normals or heights meet. */
bool wr_mesh_relief_at_crease(const WrMeshRelief *relief, const WrMeshReliefTriangle *triangle);
