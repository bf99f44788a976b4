/* The triangles of a scene, and how documents keep them. */
#include "base/error.h"
#include "base/memory.h"
#include "image/image.h"
#include "scene/kept_mesh.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "surface/triangles.h"

#include <string.h>

void wr_scene_set_triangles(WrScene *scene, WrTriangles *triangles, const char *path,
                            const char *sha256)
{
    wr_triangles_free(scene->triangles);
    wr_free(scene->triangles_path);
    scene->triangles = triangles;
    scene->triangles_path = triangles ? wr_strdup(path ? path : "") : NULL;
    memset(scene->triangles_sha256, 0, sizeof scene->triangles_sha256);
    if (triangles && sha256 && strlen(sha256) == 64) memcpy(scene->triangles_sha256, sha256, 64);
    if (!triangles) return;
    WrShape shape = scene->shape;
    if (!wr_surfaces[shape.kind]->held) wr_shape_default(WR_SURFACE_mesh, &shape);
    double *value = shape.value;
    memcpy(value + WR_MESH_CENTRE, triangles->centre, sizeof triangles->centre);
    value[WR_MESH_RADIUS] = triangles->radius;
    value[WR_MESH_KEY] = (double)(triangles->key >> 32);
    value[WR_MESH_KEY + 1] = (double)(triangles->key & 0xffffffffU);
    wr_scene_set_shape(scene, &shape);
}

size_t wr_scene_mesh_bytes(const WrTriangles *triangles)
{
    return (size_t)triangles->corner_count * sizeof *triangles->corners +
           (size_t)triangles->triangle_count * sizeof *triangles->triangles;
}

#define NARROW 4096 /* pixels: of meshes of up to so many rows of them */

WrImage *wr_scene_mesh_to_image(const WrTriangles *triangles, WrError *err)
{
    size_t count;
    float *block = wr_triangles_pack(triangles, &count);
    const size_t width = count <= (size_t)NARROW * NARROW ? NARROW : WR_IMAGE_MAX;
    const size_t height = (count + width - 1) / width;
    WrImage *image = NULL;
    if (height > WR_IMAGE_MAX) wr_fail(err, "the mesh is too large to be kept in a document");
    else image = wr_image_new((int)width, (int)height, 1, err);
    if (image) {
        image->type = WR_PIXEL_F32;
        memcpy(image->data, block, count * sizeof *block);
    }
    wr_free(block);
    return image;
}

WrTriangles *wr_scene_mesh_from_image(const WrImage *image, WrError *err)
{
    if (image->channels != 1) {
        wr_fail(err, "the mesh that is kept here has %d channels; must be 1", image->channels);
        return NULL;
    }
    return wr_triangles_unpack(image->data, (size_t)image->width * (size_t)image->height, err);
}

bool wr_scene_kept_mesh(const WrScene *scene, const WrTriangles **out, WrError *err)
{
    const WrTriangles *found = NULL;
    for (int i = 0; i < wr_scene_object_count(scene); i++) {
        const WrTriangles *own = wr_scene_object(scene, i)->triangles;
        if (own && found && own->key != found->key)
            return wr_fail(err, "several objects have different meshes: a document keeps one");
        if (own) found = own;
    }
    *out = found;
    return true;
}
