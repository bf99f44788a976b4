/* mesh_grids.h - meshes sampled from surfaces, for the renderer tests. Include after render_scenes.h. */
#pragma once
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "surface/triangles.h"

#include <math.h>

typedef void MeshPlace(double u, double v, float p[3], float n[3]);

/* A grid of nu x nv cells; with a single row or column both corners may coincide. */
static inline WrTriangles *mesh_grid(MeshPlace *place, int nu, int nv, bool mapped)
{
    const int count = (nu + 1) * (nv + 1);
    float(*points)[3] = wr_alloc((size_t)count, sizeof *points);
    float(*normals)[3] = wr_alloc((size_t)count, sizeof *normals);
    float(*uv)[2] = wr_alloc((size_t)count, sizeof *uv);
    int32_t(*corners)[3] = wr_alloc(2 * (size_t)nu * (size_t)nv, sizeof *corners);
    for (int i = 0; i < count; i++) {
        uv[i][0] = (float)(i % (nu + 1)) / (float)nu;
        uv[i][1] = (float)(i / (nu + 1)) / (float)nv;
        place((double)(i % (nu + 1)) / nu, (double)(i / (nu + 1)) / nv, points[i], normals[i]);
    }
    for (int i = 0; i < nu * nv; i++) {
        const int a = i / nu * (nu + 1) + i % nu, b = a + nu + 1;
        const int32_t both[2][3] = { { a, a + 1, b + 1 }, { a, b + 1, b } };
        memcpy(corners[2 * i], both, sizeof both);
    }
    WrError err = { "" };
    const WrTrianglesSource source = { .points = (const float(*)[3])points,
                                       .normals = (const float(*)[3])normals,
                                       .uv = mapped ? (const float(*)[2])uv : NULL,
                                       .corners = (const int32_t(*)[3])corners,
                                       .point_count = count,
                                       .triangle_count = 2 * nu * nv };
    WrTriangles *made = wr_triangles_new(&source, &err);
    if (!made) fail_msg("%s", err.text);
    wr_free(points);
    wr_free(normals);
    wr_free(uv);
    wr_free(corners);
    return made;
}

static inline void on_plane(double u, double v, float p[3], float n[3])
{
    p[0] = (float)u, p[1] = (float)v, p[2] = 0;
    n[0] = n[1] = 0, n[2] = 1;
}

static inline void on_sphere(double u, double v, float p[3], float n[3])
{
    const double a = 2 * WR_PI * (u < 1 ? u : 0), l = WR_PI * (v - 0.5);
    const double c = v > 0 && v < 1 ? cos(l) : 0;
    n[0] = (float)(cos(a) * c), n[1] = (float)(sin(a) * c), n[2] = (float)sin(l);
    for (int k = 0; k < 3; k++) p[k] = n[k];
}
