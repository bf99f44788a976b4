/* model.h - the scene's object as arrays of triangles for a model file: places, unit normals, (u,v).
   Layer 6. Private to src/export.

   A mesh, a patch set or a terrain has the triangles that the scene holds. A surface by a formula is cut into squares of
   equal steps of u and v, and its corners lie on it. The relief is not in it: normal maps show that. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrScene WrScene;

typedef struct WrModel {
    float (*points)[3],
        (*normals)[3];        /* [point_count], scene units, stretched as the object is; owned */
    float (*uv)[2];           /* [point_count], v upwards; owned */
    uint32_t (*triangles)[3]; /* [triangle_count], counter-clockwise from outside; owned */
    int32_t point_count, triangle_count;
    bool mapped; /* has (u,v) */
    double per_u,
        per_v; /* mean lengths of Pu and Pv over the surface, scene units; 1 for held triangles */
} WrModel;

/* Errors: cancelled, no memory. On failure `model` is empty. */
bool wr_model_make(const WrScene *scene, WrModel *model, WrError *err);
void wr_model_fini(WrModel *model);
