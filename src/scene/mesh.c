/* The triangles of a scene, and their storage in documents. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "surface/relief_weights.h"
#include "surface/triangles.h"
#include "surface/uv_tiles.h"

#include <math.h>
#include <string.h>

/* The shape carries centre, radius and key as numbers, so that two shapes compare by their values without the
   mesh. The 64-bit key is two whole doubles below 2^32. */
static void hold(WrScene *scene, WrTriangles *triangles)
{
    wr_triangles_free(scene->triangles);
    scene->triangles = triangles;
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

/* glTF 2.0, 3.4: "The units for all linear distances are meters." */
static WrLengthUnit unit_of(const char *path)
{
    char ending[16];
    wr_path_ending(path, ending);
    return strcmp(ending, "gltf") == 0 || strcmp(ending, "glb") == 0 ? WR_UNIT_M : WR_UNIT_UNKNOWN;
}

void wr_scene_set_triangles(WrScene *scene, WrTriangles *triangles, const char *path,
                            const char *sha256)
{
    wr_triangles_free(scene->mesh_source);
    scene->mesh_source = NULL;
    wr_free(scene->triangles_path);
    scene->triangles_path = triangles ? wr_strdup(path ? path : "") : NULL;
    memset(scene->triangles_sha256, 0, sizeof scene->triangles_sha256);
    if (triangles && sha256 && strlen(sha256) == 64) memcpy(scene->triangles_sha256, sha256, 64);
    scene->projection = wr_projection_default;
    if (triangles) scene->projection.unit = unit_of(scene->triangles_path);
    hold(scene, triangles);
}

/* ---- projection ---- */

const WrTriangles *wr_scene_mesh_source(const WrScene *scene)
{
    return scene->mesh_source ? scene->mesh_source : scene->triangles;
}

void wr_scene_set_mask(WrScene *scene, const char *layer, const WrField *mask, uint64_t key)
{
    char *own = wr_strdup(layer);
    WrField *shared = mask ? wr_field_share(mask) : NULL;
    wr_free(scene->mask_layer);
    wr_field_free(scene->mask);
    scene->mask_layer = own, scene->mask = shared, scene->mask_key = key;
}

/* The tile comes first, so that masks and creases are those of the mesh that is shown. */
static WrTriangles *project(const WrTriangles *source, const WrProjection *projection,
                            const WrField *mask, WrError *err)
{
    WrTriangles *tile = projection->udim ? wr_triangles_of_tile(source, projection->udim, err)
                                         : wr_triangles_share(source);
    WrTriangles *made = tile ? wr_triangles_project(tile, projection, mask, err) : NULL;
    wr_triangles_free(tile);
    return made;
}

WrTriangles *wr_scene_whole_mesh(const WrScene *scene, WrError *err)
{
    if (scene->projection.udim == 0) return wr_triangles_share(scene->triangles);
    return wr_triangles_project(wr_scene_mesh_source(scene), &scene->projection, scene->mask, err);
}

bool wr_scene_project(WrScene *scene, const WrProjection *projection, WrError *err)
{
    WrTriangles *made = project(wr_scene_mesh_source(scene), projection, scene->mask, err);
    if (!made) return false;
    if (!scene->mesh_source) scene->mesh_source = wr_triangles_share(scene->triangles);
    hold(scene, made);
    if (made == scene->mesh_source) { /* nothing was changed */
        wr_triangles_free(scene->mesh_source);
        scene->mesh_source = NULL;
    }
    scene->projection = *projection;
    return true;
}

bool wr_scene_projected(const WrScene *scene)
{
    const WrProjection *p = &scene->projection;
    return scene->triangles && (p->kind != WR_PROJECTION_UV || p->crease_deg < WR_CREASE_NONE ||
                                wr_relief_is_weighted(p) || scene->mask_layer || p->udim != 0 ||
                                p->unit != unit_of(scene->triangles_path) || p->origin[0] != 0 ||
                                p->origin[1] != 0 || p->origin[2] != 0);
}

size_t wr_scene_mesh_bytes(const WrTriangles *triangles)
{
    return (size_t)triangles->corner_count * sizeof *triangles->corners +
           (size_t)triangles->triangle_count * sizeof *triangles->triangles;
}

/* Documents store numbers as a float picture: rows of `width` values, the last one padded with 0. */
#define NARROW 4096 /* width in pixels for meshes of up to this many rows */

/* ---- storage in documents ------------------------------------------------------------------------- */

/* Format of several different meshes in one picture: SEVERAL, the number of objects, for each the index
   of its mesh (from 1; 0: none), the number of meshes, the length of each as high * UNIT + low; then
   the meshes. A single mesh is stored alone, and never begins with SEVERAL.
   floats hold whole numbers up to 2^24, so a length is two digits of base 65536. */
#define SEVERAL (-1.0F)
#define UNIT 65536

typedef struct Kept {
    const WrTriangles *mesh[WR_OBJECTS_MAX]; /* the different ones; borrowed */
    int meshes, objects;
    int of[WR_OBJECTS_MAX]; /* from 1; 0: none */
} Kept;

/* Meshes are compared by key: copies of an object store their mesh once. */
static Kept kept_of(const WrScene *scene)
{
    Kept kept = { .objects = wr_scene_object_count(scene) };
    for (int i = 0; i < kept.objects; i++) {
        const WrTriangles *own = wr_scene_mesh_source(wr_scene_object(scene, i));
        int k = 0;
        if (!own) continue;
        while (k < kept.meshes && kept.mesh[k]->key != own->key) k++;
        if (k == kept.meshes) kept.mesh[kept.meshes++] = own;
        kept.of[i] = k + 1;
    }
    return kept;
}

bool wr_scene_several_meshes(const WrScene *scene)
{
    return kept_of(scene).meshes > 1;
}

static WrImage *picture_of(const float *block, size_t count, WrError *err)
{
    const size_t width = count <= (size_t)NARROW * NARROW ? NARROW : WR_IMAGE_MAX;
    const size_t height = (count + width - 1) / width;
    WrImage *image = NULL;
    if (height > WR_IMAGE_MAX) wr_fail(err, "the meshes are too large to be stored in a document");
    else image = wr_image_new((int)width, (int)height, 1, err);
    if (!image) return NULL;
    image->type = WR_PIXEL_F32;
    memcpy(image->data, block, count * sizeof *block);
    return image;
}

static WrImage *pack_several(const Kept *kept, WrError *err)
{
    const size_t head = 3 + (size_t)kept->objects + 2 * (size_t)kept->meshes;
    float *blocks[WR_OBJECTS_MAX], *all;
    size_t counts[WR_OBJECTS_MAX], sum = head;
    for (int k = 0; k < kept->meshes; k++) {
        blocks[k] = wr_triangles_serialize(kept->mesh[k], &counts[k]);
        sum += counts[k];
    }
    all = wr_try_alloc(sum, sizeof *all, "meshes", err);
    float *at = all;
    if (all) {
        *at++ = SEVERAL, *at++ = (float)kept->objects;
        for (int i = 0; i < kept->objects; i++) *at++ = (float)kept->of[i];
        *at++ = (float)kept->meshes;
        for (int k = 0; k < kept->meshes; k++)
            *at++ = (float)(counts[k] / UNIT), *at++ = (float)(counts[k] % UNIT);
    }
    for (int k = 0; k < kept->meshes; k++) {
        if (all) memcpy(at, blocks[k], counts[k] * sizeof *at), at += counts[k];
        wr_free(blocks[k]);
    }
    WrImage *image = all ? picture_of(all, sum, err) : NULL;
    wr_free(all);
    return image;
}

bool wr_scene_meshes_to_image(const WrScene *scene, WrImage **out, WrError *err)
{
    const Kept kept = kept_of(scene);
    *out = NULL;
    if (kept.meshes == 0) return true;
    if (kept.meshes > 1) {
        *out = pack_several(&kept, err);
        return *out != NULL;
    }
    size_t count;
    float *block = wr_triangles_serialize(kept.mesh[0], &count);
    *out = picture_of(block, count, err);
    wr_free(block);
    return *out != NULL;
}

/* An integer of low .. high, or -1. */
static int whole(float x, int low, int high)
{
    return (double)x >= low && (double)x <= high && x == floorf(x) ? (int)x : -1;
}

/* Position of an object's mesh in a picture of several; false: none, or the picture is damaged.
   Each number is checked before it is used as an index: the file may be damaged on purpose. */
static bool find_block(const float *block, size_t count, int object, size_t *from, size_t *length)
{
    const int objects = count > 2 ? whole(block[1], 1, WR_OBJECTS_MAX) : -1;
    if (objects < 0 || object >= objects || count < 3 + (size_t)objects) return false;
    const int meshes = whole(block[2 + objects], 2, objects);
    const int own = whole(block[2 + object], 1, meshes);
    const size_t head = 3 + (size_t)objects + 2 * (size_t)(meshes > 0 ? meshes : 0);
    if (meshes < 0 || own < 0 || count < head) return false;
    *from = head;
    for (int k = 0; k < own; k++) {
        const float *at = block + 3 + objects + 2 * k;
        const int high = whole(at[0], 0, UNIT), low = whole(at[1], 0, UNIT - 1);
        if (high < 0 || low < 0) return false;
        *length = (size_t)high * UNIT + (size_t)low;
        if (*length > count - *from) return false;
        if (k + 1 < own) *from += *length;
    }
    return true;
}

WrTriangles *wr_scene_mesh_from_image(const WrImage *image, int object, WrError *err)
{
    const size_t count = (size_t)image->width * (size_t)image->height;
    size_t from = 0, length = count;
    if (image->channels != 1) {
        wr_fail(err, "the stored mesh has %d channels; must be 1", image->channels);
        return NULL;
    }
    if (image->data[0] == SEVERAL && !find_block(image->data, count, object, &from, &length)) {
        wr_fail(err, "damaged: no mesh is stored for object %d", object + 1);
        return NULL;
    }
    return wr_triangles_deserialize(image->data + from, length, err);
}
