/* assimp.h - interface of the module that contains Assimp (wrinkle_assimp.so).

   The module exports one symbol, wr_assimp_table; all calls use it, and no exception crosses it.
   Private to this module. C and C++. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WR_ASSIMP_VERSION 3
#define WR_ASSIMP_REASON 320
#define WR_ASSIMP_SYMBOL "wr_assimp_table"
#define WR_ASSIMP_NO_MEMORY "not enough memory" /* a reason that callers test for */

typedef struct WrAssimpMesh WrAssimpMesh;

typedef struct WrAssimpTable {
    int version; /* WR_ASSIMP_VERSION */
    /* Reads a file in memory and no other file. ending: extension of its name, lower case. More points
       or triangles than the limits are an error. whole: also normals, (u,v) and parts. On failure NULL
       and one line in reason[WR_ASSIMP_REASON]. */
    WrAssimpMesh *(*read)(const void *bytes, size_t length, const char *ending, int64_t most_points,
                          int64_t most_triangles, bool whole, char *reason);
    int32_t (*points)(const WrAssimpMesh *mesh);
    int32_t (*triangles)(const WrAssimpMesh *mesh);
    const double *(*point_data)(const WrAssimpMesh *mesh);   /* [points][3] */
    const int32_t *(*corner_data)(const WrAssimpMesh *mesh); /* [triangles][3], point indices */
    /* For whole meshes: [points][5], a normal (0: none) and u, v (NaN: none). */
    const float *(*look_data)(const WrAssimpMesh *mesh);
    /* Parts: the first triangle of each, and its material's name; in order. */
    int32_t (*parts)(const WrAssimpMesh *mesh);
    int32_t (*part)(const WrAssimpMesh *mesh, int32_t i, const char **name);
    void (*close)(WrAssimpMesh *mesh);
} WrAssimpTable;
