#include "image/mesh_make.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/assimp.h"
#include "image/module.h"
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

bool wr_mesh_make(const void *bytes, size_t length, const char *ending, WrText *block, bool *memory,
                  WrError *err)
{
    char reason[WR_ASSIMP_REASON] = "";
    const WrAssimpTable *table = library(err);
    if (!table || !wr_ply_check(bytes, length, err)) return false;
    WrAssimpMesh *mesh =
        table->read(bytes, length, ending, WR_MESH_POINTS_MAX, WR_MESH_TRIANGLES_MAX, reason);
    if (!mesh) {
        if (memory) *memory = strcmp(reason, WR_ASSIMP_NO_MEMORY) == 0;
        return wr_fail(err, "%s", reason);
    }
    WrMeshHead head = { table->points(mesh), table->triangles(mesh) };
    bool good = check_points(table->point_data(mesh), head.points, err);
    if (good && head.triangles == 0) good = wr_fail(err, "holds no triangle");
    if (good) {
        wr_text_add_n(block, (const char *)&head, sizeof head);
        wr_text_add_n(block, (const char *)table->point_data(mesh), 12 * (size_t)head.points);
        wr_text_add_n(block, (const char *)table->corner_data(mesh), 12 * (size_t)head.triangles);
    }
    table->close(mesh);
    return good;
}
