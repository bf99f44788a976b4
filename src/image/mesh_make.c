#include "image/mesh_make.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/assimp.h"
#include "image/module.h"
#include "image/obj.h"
#include "image/ply.h"

#include <math.h>
#include <string.h>

static const WrAssimpTable *library(WrError *err)
{
    static WrModule module = { .file = "wrinkle_assimp.so",
                               .serves = "mesh files",
                               .symbol = WR_ASSIMP_SYMBOL,
                               .version = WR_ASSIMP_VERSION,
                               .loading = { .work = wr_module_load, .ctx = &module } };
    return wr_module_table(&module, err);
}

bool wr_mesh_load(WrError *err)
{
    return library(err) != NULL;
}

static bool check_points(const float *points, int32_t count, WrError *err)
{
    for (int32_t i = 0; i < count; i++) {
        const float *p = points + 3 * (size_t)i;
        if (fabsf(p[0]) <= 1e30f && fabsf(p[1]) <= 1e30f && fabsf(p[2]) <= 1e30f) continue;
        return wr_fail(err, "point %d is %g,%g,%g: must be finite, within 1e30 of 0", (int)i + 1,
                       (double)p[0], (double)p[1], (double)p[2]);
    }
    return true;
}

static void add(WrText *block, const void *from, size_t bytes)
{
    wr_text_add_n(block, from, bytes);
}

/* Normals, then (u,v), which the library's border has side by side. */
static void add_looks(WrText *block, const float *looks, size_t points)
{
    for (size_t i = 0; i < points; i++) add(block, looks + 5 * i, 3 * sizeof *looks);
    for (size_t i = 0; i < points; i++) add(block, looks + 5 * i + 3, 2 * sizeof *looks);
}

/* Neighbours of one name are one part; past the most that are told apart, all that follow. */
static int32_t make_parts(const WrAssimpTable *table, const WrAssimpMesh *mesh, WrMeshPart *parts)
{
    const int32_t most = table->parts(mesh), end = table->triangles(mesh);
    int32_t count = 0;
    for (int32_t i = 0; i < most; i++) {
        const char *name, *next;
        WrMeshPart part = { .first = table->part(mesh, i, &name) };
        part.count = (i + 1 < most ? table->part(mesh, i + 1, &next) : end) - part.first;
        snprintf(part.name, sizeof part.name, "%s", name);
        const bool same = count > 0 && strcmp(parts[count - 1].name, part.name) == 0;
        if (part.count == 0) continue;
        if (same || count == WR_MESH_PARTS_MAX) parts[count - 1].count += part.count;
        else parts[count++] = part;
    }
    return count;
}

static void add_whole(const WrAssimpTable *table, const WrAssimpMesh *mesh, WrMeshHead head,
                      WrText *block)
{
    WrMeshPart *parts = NULL;
    const size_t points = (size_t)head.points, triangles = (size_t)head.triangles;
    if (head.whole) {
        parts = wr_alloc(WR_MESH_PARTS_MAX, sizeof *parts);
        head.parts = make_parts(table, mesh, parts);
    }
    add(block, &head, sizeof head);
    add(block, table->point_data(mesh), 12 * points);
    add(block, table->corner_data(mesh), 12 * triangles);
    if (head.whole) {
        add_looks(block, table->look_data(mesh), points);
        add(block, parts, (size_t)head.parts * sizeof *parts);
    }
    wr_free(parts);
}

bool wr_mesh_make(const void *bytes, size_t length, const char *ending, bool whole, WrText *block,
                  bool *memory, WrError *err)
{
    char reason[WR_ASSIMP_REASON] = "";
    if (!wr_ply_check(bytes, length, err)) return false;
    const bool obj = !*ending || strcmp(ending, "obj") == 0;
    if (obj && wr_obj_make(bytes, length, whole, block)) return true;
    const WrAssimpTable *table = library(err);
    if (!table) return false;
    WrAssimpMesh *mesh = table->read(bytes, length, ending, WR_MESH_POINTS_MAX,
                                     WR_MESH_TRIANGLES_MAX, whole, reason);
    if (!mesh) {
        if (memory) *memory = strcmp(reason, WR_ASSIMP_NO_MEMORY) == 0;
        return wr_fail(err, "%s", reason);
    }
    const WrMeshHead head = { table->points(mesh), table->triangles(mesh), whole, 0 };
    bool good = check_points(table->point_data(mesh), head.points, err);
    if (good && head.triangles == 0) good = wr_fail(err, "holds no triangle");
    if (good) add_whole(table, mesh, head, block);
    table->close(mesh);
    return good;
}
