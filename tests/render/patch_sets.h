/* patch_sets.h - sets of bicubic patches for tests, and an independent computation of their edges. Include after
   test.h. */
#pragma once
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "surface/patches.h"
#include "surface/surface.h"

#include <string.h>

/* A bent and twisted patch without equal rows. */
static const float wavy_patch[48] = {
    0, 0,    0, 1,    0.1f,  0.5f, 2,    -0.1f, -0.4f, 3,    0,    0.2f, 0.1f,  1,    -0.3f, 1.1f,
    1, 0.2f, 2, 1.1f, -0.6f, 3.1f, 0.9f, -0.3f, 0,     2.2f, 0.4f, 0.9f, 2,     0.7f, 2.1f,  1.9f,
    0, 3,    2, 0.3f, -0.1f, 3,    0,    1,     3.1f,  0.5f, 2,    2.9f, -0.2f, 3,    3,     0.1f,
};

static inline float (*teapot_points(int32_t *count))[48]
{
    WrError err = { "" };
    char *text;
    size_t length;
    float(*points)[48] = NULL;
    if (!wr_file_read(WR_SOURCE_DIR "/samples/teapot.bpt", 1 << 20, &text, &length, &err) ||
        !wr_patches_parse(text, length, &points, count, &err))
        fail_msg("%s", err.text);
    wr_free(text);
    return points;
}

static inline WrSurfacePoint patch_at(const float *points, double u, double v)
{
    WrShape shape;
    WrSurfacePoint at;
    wr_shape_default(WR_SURFACE_bezier, &shape);
    for (int i = 0; i < 48; i++) shape.value[i] = (double)points[i];
    wr_surface_at(&shape, 0, u, v, &at);
    return at;
}

static inline void edge_uv(int edge, double t, double uv[2])
{
    uv[0] = edge < 2 ? t : edge - 2;
    uv[1] = edge < 2 ? edge : t;
}

static inline WrVec3 patch_on_edge(const float *points, int edge, double t)
{
    double uv[2];
    edge_uv(edge, t, uv);
    return patch_at(points, uv[0], uv[1]).p;
}

/* True if edges a and b, 4 * patch + edge, have the same points. */
static inline bool same_edge(const WrPatches *set, int32_t a, int32_t b, bool *turned)
{
    const float *p = set->patch[a / 4].point, *q = set->patch[b / 4].point;
    for (int way = 0; way < 2; way++) {
        bool same = true;
        for (int k = 0; k <= 4; k++) {
            const WrVec3 x = patch_on_edge(p, a % 4, k / 4.0);
            const WrVec3 y = patch_on_edge(q, b % 4, way ? 1 - k / 4.0 : k / 4.0);
            same = same && v3_len(v3_sub(x, y)) < 1e-9;
        }
        *turned = way == 1;
        if (same) return true;
    }
    return false;
}

static inline bool patch_edge_is_open(const WrPatches *set, int32_t patch, int edge)
{
    bool turned;
    for (int32_t i = 0; i < 4 * set->count; i++)
        if (i != 4 * patch + edge && same_edge(set, 4 * patch + edge, i, &turned)) return false;
    return v3_len(v3_sub(patch_on_edge(set->patch[patch].point, edge, 0),
                         patch_on_edge(set->patch[patch].point, edge, 0.5))) > 1e-9;
}

/* Control points of the lower and the upper half of a curve. */
static inline void halve_curve(double p[4][3], double low[4][3], double high[4][3])
{
    for (int k = 0; k < 3; k++) {
        const double ab = (p[0][k] + p[1][k]) / 2, bc = (p[1][k] + p[2][k]) / 2;
        const double cd = (p[2][k] + p[3][k]) / 2, abc = (ab + bc) / 2, bcd = (bc + cd) / 2;
        low[0][k] = p[0][k], low[1][k] = ab, low[2][k] = abc;
        low[3][k] = high[0][k] = (abc + bcd) / 2;
        high[1][k] = bcd, high[2][k] = cd, high[3][k] = p[3][k];
    }
}

/* Quarters of a patch: lower left, lower right, upper left, upper right. */
static inline void quarter(const float whole[48], float out[4][48])
{
    double half[2][4][4][3], part[2][4][3];
    for (int j = 0; j < 4; j++) {
        double row[4][3];
        for (int i = 0; i < 12; i++) row[i / 3][i % 3] = (double)whole[12 * j + i];
        halve_curve(row, half[0][j], half[1][j]);
    }
    for (int side = 0; side < 2; side++)
        for (int i = 0; i < 4; i++) {
            double column[4][3];
            for (int j = 0; j < 4; j++) memcpy(column[j], half[side][j][i], sizeof column[j]);
            halve_curve(column, part[0], part[1]);
            for (int up = 0; up < 2; up++)
                for (int j = 0; j < 4; j++)
                    for (int k = 0; k < 3; k++)
                        out[2 * up + side][12 * j + 3 * i + k] = (float)part[up][j][k];
        }
}

/* The same patch with other u and v: rotated by that many quarter turns, then mirrored. */
static inline void turn_points(float points[48], int quarters, bool mirror)
{
    for (int k = 0; k < quarters + mirror; k++) {
        float old[48];
        memcpy(old, points, sizeof old);
        for (int j = 0; j < 4; j++)
            for (int i = 0; i < 4; i++) {
                const int from = k < quarters ? 4 * (3 - i) + j : 4 * j + 3 - i;
                memcpy(points + 3 * (4 * j + i), old + 3 * from, 3 * sizeof *old);
            }
    }
}
