#include "image/mesh_decode.h"

#include "base/error.h"
#include "base/text.h"
#include "image/assimp.h"
#include "image/gltf_mesh.h"
#include "image/mesh_build.h"
#include "image/module_path.h"
#include "image/mesh_obj.h"
#include "image/mesh_ply.h"
#include "image/stl.h"

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

/* ---- reading by the library ---- */

static bool take_points(const WrAssimpTable *table, const WrAssimpMesh *mesh, WrMeshBuild *build,
                        WrError *err)
{
    const int32_t count = table->points(mesh);
    build->single = true;
    const double *points = table->point_data(mesh);
    const float *looks = table->look_data(mesh); /* a normal and (u,v) of each point */
    if (!wr_mesh_build_reserve(build, count, table->triangles(mesh), err)) return false;
    for (int32_t i = 0; i < count; i++) {
        const float *look = build->whole ? looks + 5 * (size_t)i : NULL;
        if (!wr_mesh_build_point(build, points + 3 * (size_t)i, look, look ? look + 3 : NULL, err))
            return false;
    }
    return true;
}

static bool take_triangles(const WrAssimpTable *table, const WrAssimpMesh *mesh, WrMeshBuild *build,
                           WrError *err)
{
    const int32_t count = table->triangles(mesh), parts = table->parts(mesh);
    const int32_t *corner = table->corner_data(mesh);
    for (int32_t i = 0, part = 0; i < count; i++, corner += 3) {
        const char *name;
        for (; part < parts && table->part(mesh, part, &name) <= i; part++)
            wr_mesh_build_part(build, name, strlen(name));
        if (!wr_mesh_build_triangle(build, corner[0], corner[1], corner[2], err)) return false;
    }
    return true;
}

static bool read_by_library(const void *bytes, size_t length, const char *ending,
                            WrMeshBuild *build, WrError *err)
{
    char reason[WR_ASSIMP_REASON] = "";
    const WrAssimpTable *table = library(err);
    if (!table) return false;
    WrAssimpMesh *mesh = table->read(bytes, length, ending, WR_MESH_POINTS_MAX,
                                     WR_MESH_TRIANGLES_MAX, build->whole, reason);
    if (!mesh) {
        build->memory = strcmp(reason, WR_ASSIMP_NO_MEMORY) == 0;
        return wr_fail(err, "%s", reason);
    }
    const bool good =
        take_points(table, mesh, build, err) && take_triangles(table, mesh, build, err);
    table->close(mesh);
    return good;
}

/* ---- all formats ---- */

/* The format by the bytes if they are characteristic, else by the extension; formats without an own
 * reader use the library. */
static bool read_kind(const void *bytes, size_t length, const char *ending, WrMeshBuild *build,
                      WrError *err)
{
    if (wr_ply_is(bytes, length) || strcmp(ending, "ply") == 0)
        return wr_ply_read(bytes, length, build, err);
    if (strcmp(ending, "stl") == 0) return wr_stl_read(bytes, length, build, err);
    if ((strcmp(ending, "gltf") == 0 || strcmp(ending, "glb") == 0) && wr_gltf_is(bytes, length))
        return wr_gltf_read(bytes, length, build, err);
    if (!*ending || strcmp(ending, "obj") == 0) {
        const char *wrong;
        if (wr_obj_read(bytes, length, build, &wrong)) return true;
        if (wrong) return wr_fail(err, "%s", wrong);
        const bool whole = build->whole;
        wr_mesh_build_fini(build);
        build->whole = whole;
    }
    return read_by_library(bytes, length, ending, build, err);
}

bool wr_mesh_make(const void *bytes, size_t length, const char *ending, bool whole, WrText *block,
                  bool *memory, WrError *err)
{
    WrMeshBuild build = { .whole = whole };
    const bool good =
        read_kind(bytes, length, ending, &build, err) && wr_mesh_build_finish(&build, block, err);
    if (memory) *memory = !good && build.memory;
    wr_mesh_build_fini(&build);
    return good;
}
