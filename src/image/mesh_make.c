#include "image/mesh_make.h"

#include "base/memory.h"
#include "image/assimp.h"
#include "image/module.h"

#include <dlfcn.h>
#include <math.h>
#include <pthread.h>
#include <string.h>
#include <unistd.h>

#define MODULE_FILE "wrinkle_assimp.so"

static const WrAssimpTable *load(WrError *err)
{
    const WrAssimpTable *table = NULL;
    WrText path = { 0 }, looked = { 0 };
    for (int place = 0; place < WR_MODULE_PLACES && !table; place++) {
        if (!wr_module_path(place, MODULE_FILE, &path)) continue;
        wr_text_addf(&looked, "%s%s", looked.length ? ", " : "", wr_text_get(&path));
        if (access(wr_text_get(&path), F_OK) != 0) continue;
        void *module = dlopen(wr_text_get(&path), RTLD_NOW | RTLD_LOCAL);
        if (!module) {
            wr_text_addf(&looked, " (%s)", dlerror());
            continue;
        }
        const WrAssimpTable *found = dlsym(module, WR_ASSIMP_SYMBOL);
        if (found && found->version == WR_ASSIMP_VERSION) {
            table = found; /* stays loaded */
        } else {
            wr_text_addf(&looked, " (of another version of the program)");
            dlclose(module);
        }
    }
    if (!table)
        wr_fail(err, "mesh files need the module " MODULE_FILE ", looked for at: %s",
                wr_text_get(&looked));
    wr_text_fini(&path);
    wr_text_fini(&looked);
    return table;
}

/* Which module is loaded is a fact of the process, as in module.c. A failure is not kept. */
static const WrAssimpTable *library(WrError *err)
{
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    static const WrAssimpTable *loaded;
    pthread_mutex_lock(&lock);
    if (!loaded) loaded = load(err);
    const WrAssimpTable *table = loaded;
    pthread_mutex_unlock(&lock);
    return table;
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
    if (!table) return false;
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
