/* Serialisation of a mesh as numbers, for documents. */
#include "surface/triangles_internal.h"

#include "base/error.h"
#include "base/memory.h"
#include "surface/patches.h"

#include <math.h>
#include <string.h>

#define PACK_VERSION 1

/* version, corners, triangles, parts, closed, then the statistics; the bounding sphere as twice three
 * floats and so on */
enum { HEAD = 5, TOLD_COUNT = 9, BALL = 12, PART = 3 + WR_TRIANGLE_NAME };

static void told_to_floats(const WrTrianglesTold *told, float *out)
{
    const int32_t numbers[TOLD_COUNT] = { told->no_area,     told->no_normal, told->bad_normal,
                                          told->face_normal, told->bad_uv,    told->no_map,
                                          told->collinear,   told->mirrored,  told->inside_out };
    for (int i = 0; i < TOLD_COUNT; i++) out[i] = (float)numbers[i];
}

static void told_from_floats(const float *in, WrTrianglesTold *told)
{
    int32_t n[TOLD_COUNT];
    for (int i = 0; i < TOLD_COUNT; i++) n[i] = (int32_t)in[i];
    *told = (WrTrianglesTold){ n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8] != 0, 0 };
}

/* A double as three floats whose sum it is. */
static void split(double x, float out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = (float)x;
        x -= (double)out[i];
    }
}

static double join(const float in[3])
{
    return ((double)in[2] + (double)in[1]) + (double)in[0];
}

static size_t packed(int32_t corners, int32_t triangles, int32_t parts)
{
    return HEAD + TOLD_COUNT + BALL + (size_t)parts * PART + (size_t)corners * 8 +
           (size_t)triangles * 3;
}

float *wr_triangles_pack(const WrTriangles *t, size_t *count)
{
    if (t->patches) return wr_patches_pack(t->patches, count);
    *count = packed(t->corner_count, t->triangle_count, t->part_count);
    float *block = wr_alloc(*count, sizeof *block), *at = block;
    const float head[HEAD] = { PACK_VERSION, (float)t->corner_count, (float)t->triangle_count,
                               (float)t->part_count, t->closed };
    memcpy(at, head, sizeof head), at += HEAD;
    told_to_floats(&t->told, at), at += TOLD_COUNT;
    for (int k = 0; k < 3; k++) split(t->centre[k], at + 3 * k);
    split(t->radius, at + 9), at += BALL;
    for (int i = 0; i < t->part_count; i++, at += PART) {
        const WrTrianglePart *part = &t->parts[i];
        at[0] = (float)part->first, at[1] = (float)part->count, at[2] = part->mapped;
        for (int k = 0; k < WR_TRIANGLE_NAME; k++) at[3 + k] = (float)(unsigned char)part->name[k];
    }
    memcpy(at, t->corners, (size_t)t->corner_count * sizeof *t->corners);
    at += 8 * (size_t)t->corner_count;
    for (size_t i = 0; i < 3 * (size_t)t->triangle_count; i++)
        at[i] = (float)t->triangles[i / 3].corner[i % 3];
    return block;
}

/* True for an integer of low .. high. */
static bool whole(float x, double low, double high)
{
    return (double)x >= low && (double)x <= high && (double)x == floor((double)x);
}

static bool check_head(const float *block, size_t count)
{
    return count >= HEAD + TOLD_COUNT + BALL && whole(block[0], PACK_VERSION, PACK_VERSION) &&
           whole(block[1], 3, 1 << 24) && whole(block[2], 1, WR_TRIANGLES_MAX) &&
           whole(block[3], 1, WR_TRIANGLE_PARTS_MAX) && whole(block[4], 0, 1) &&
           count >= packed((int32_t)block[1], (int32_t)block[2], (int32_t)block[3]);
}

static bool check_numbers(const WrTriangles *t, const float *told)
{
    for (int i = 0; i < TOLD_COUNT; i++)
        if (!whole(told[i], 0, 0x1p30)) return false;
    for (int32_t i = 0; i < t->corner_count; i++) {
        const WrTriangleCorner *c = &t->corners[i];
        for (int k = 0; k < 3; k++)
            if (!(fabsf(c->p[k]) <= 1e30f) || !(fabsf(c->n[k]) <= 1.001f)) return false;
        if (!(fabsf(c->u) <= 1e6f) || !(fabsf(c->v) <= 1e6f)) return false;
    }
    return t->radius > 0 && t->radius <= 1e31 && fabs(t->centre[0]) <= 1e30 &&
           fabs(t->centre[1]) <= 1e30 && fabs(t->centre[2]) <= 1e30;
}

static bool take_parts(const float *at, int count, int32_t triangles, WrTrianglePart *parts)
{
    int32_t sum = 0;
    for (int i = 0; i < count; i++, at += PART) {
        if (!whole(at[0], sum, sum) || !whole(at[1], 1, triangles - sum) || !whole(at[2], 0, 1))
            return false;
        parts[i] = (WrTrianglePart){ .first = sum, .count = (int32_t)at[1], .mapped = at[2] != 0 };
        for (int k = 0; k + 1 < WR_TRIANGLE_NAME; k++) {
            if (!whole(at[3 + k], 0, 255)) return false;
            parts[i].name[k] = (char)(unsigned char)at[3 + k];
        }
        sum += parts[i].count;
    }
    return sum == triangles;
}

static bool take_triangles(const float *at, int32_t corners, int32_t count, WrTriangle *out)
{
    for (size_t i = 0; i < 3 * (size_t)count; i++) {
        if (!whole(at[i], 0, corners - 1)) return false;
        out[i / 3].corner[i % 3] = (int32_t)at[i];
    }
    return true;
}

WrTriangles *wr_triangles_unpack(const float *block, size_t count, WrError *err)
{
    if (count > 0 && block[0] == (float)WR_PATCHES_PACKED)
        return wr_patches_unpack(block, count, err);
    if (!check_head(block, count)) {
        wr_fail(err, "the mesh that is kept here makes no sense");
        return NULL;
    }
    WrTriangles *t = wr_alloc(1, sizeof *t);
    t->refs = 1;
    t->corner_count = (int32_t)block[1];
    t->triangle_count = (int32_t)block[2];
    t->part_count = (int32_t)block[3];
    t->closed = block[4] != 0;
    WrTriangleCorner *corners =
        wr_try_alloc((size_t)t->corner_count, sizeof *corners, "a mesh", err);
    WrTriangle *triangles =
        corners ? wr_try_alloc((size_t)t->triangle_count, sizeof *triangles, "a mesh", err) : NULL;
    WrTrianglePart *parts = wr_alloc((size_t)t->part_count, sizeof *parts);
    t->corners = corners, t->triangles = triangles, t->parts = parts;
    if (triangles) {
        const float *at = block + HEAD + TOLD_COUNT;
        for (int k = 0; k < 3; k++) t->centre[k] = join(at + 3 * k);
        t->radius = join(at + 9), at += BALL;
        const float *rows = at + (size_t)t->part_count * PART;
        memcpy(corners, rows, (size_t)t->corner_count * sizeof *corners);
        if (check_numbers(t, block + HEAD) &&
            take_parts(at, t->part_count, t->triangle_count, parts) &&
            take_triangles(rows + 8 * (size_t)t->corner_count, t->corner_count, t->triangle_count,
                           triangles)) {
            told_from_floats(block + HEAD, &t->told);
            wr_triangles_measure(t);
            return t;
        }
        wr_fail(err, "the mesh that is kept here is damaged");
    }
    wr_triangles_free(t);
    return NULL;
}
