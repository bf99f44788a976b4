/* Memory cost of keeping two states of a document: tiles of fields that are in one but not in the other. */
#include "document/document.h"

#include "base/array.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/objects.h"

#define TILE_BYTES (WR_TILE * WR_TILE * sizeof(float) + WR_ALIGN)

typedef struct Fields {
    const WrField **of; /* [count], owned; NULL for those with an equal counterpart */
    int count;
} Fields;

static void add(Fields *fields, const WrField *field)
{
    if (field) fields->of[fields->count++] = field;
}

static Fields fields_of(const WrDocument *document)
{
    Fields fields = { wr_alloc(3 * (size_t)document->layer_count + 1, sizeof *fields.of), 0 };
    for (int i = 0; i < document->layer_count; i++) {
        add(&fields, document->layers[i].heights);
        add(&fields, document->layers[i].cover);
        add(&fields, document->layers[i].mask);
    }
    add(&fields, document->selection);
    return fields;
}

typedef struct Count {
    const WrField *a, *b;
    size_t tiles;
} Count;

static void count_tile(int tx, int ty, void *ctx)
{
    Count *count = ctx;
    count->tiles += wr_field_tile(count->a, tx, ty) || wr_field_tile(count->b, tx, ty);
}

static size_t between(const WrField *a, const WrField *b)
{
    Count count = { a, b, 0 };
    wr_field_changes(a, b, count_tile, &count);
    return count.tiles * TILE_BYTES;
}

static bool same_size(const WrField *a, const WrField *b)
{
    return wr_field_width(a) == wr_field_width(b) && wr_field_height(a) == wr_field_height(b);
}

/* Removes the pairs of equal fields. Both lists have the same order, so a search continues where the last one
   ended: an edit costs one pass. */
static void drop_equal(Fields *before, Fields *after)
{
    int from = 0;
    for (int i = 0; i < before->count; i++)
        for (int n = 0; n < after->count; n++) {
            int k = (from + n) % after->count;
            if (!after->of[k] || wr_field_key(after->of[k]) != wr_field_key(before->of[i]))
                continue;
            before->of[i] = after->of[k] = NULL;
            from = (k + 1) % after->count;
            break;
        }
}

static size_t bytes_of(const WrField *field)
{
    return field ? wr_field_bytes(field) : 0;
}

/* Pictures and the mesh of one object. */
#define OWN (3 + WR_FACET_KINDS)
typedef struct Own {
    const void *of[OWN];
    size_t bytes[OWN];
} Own;

static size_t image_bytes(const WrImage *image)
{
    if (!image) return 0;
    return (size_t)image->width * (size_t)image->height * (size_t)image->channels * sizeof(float);
}

static Own own_of(const WrScene *object)
{
    const WrTriangles *mesh = object->triangles;
    const WrImage *const rough = object->facets[WR_FACET_ROUGHNESS].image;
    const WrImage *const metal = object->facets[WR_FACET_METALNESS].image;
    return (Own){ .of = { object->colour, object->normals.image, rough, metal, mesh },
                  .bytes = { image_bytes(object->colour), image_bytes(object->normals.image),
                             image_bytes(rough), image_bytes(metal),
                             mesh ? wr_scene_mesh_bytes(mesh) : 0 } };
}

static bool has(const WrScene *scene, const void *thing)
{
    for (int i = 0; i < wr_scene_object_count(scene); i++) {
        const Own own = own_of(wr_scene_object(scene, i));
        for (int k = 0; k < OWN; k++)
            if (own.of[k] == thing) return true;
    }
    return false;
}

/* Bytes owned by the objects of one scene and by none of the other. */
static size_t own_bytes(const WrScene *scene, const WrScene *other)
{
    size_t bytes = 0;
    for (int i = 0; i < wr_scene_object_count(scene); i++) {
        const Own own = own_of(wr_scene_object(scene, i));
        for (int k = 0; k < OWN; k++)
            if (own.of[k] && !has(other, own.of[k])) bytes += own.bytes[k];
    }
    return bytes;
}

size_t wr_document_difference(const WrDocument *before, const WrDocument *after)
{
    Fields a = fields_of(before), b = fields_of(after);
    size_t bytes = sizeof *before + own_bytes(before->scene, after->scene) +
                   own_bytes(after->scene, before->scene) +
                   (size_t)before->layer_count * (sizeof(WrLayer) + 4 * WR_ALIGN);
    drop_equal(&a, &b);
    int k = 0;
    for (int i = 0; i < a.count; i++) { /* the remaining fields are compared in order */
        if (!a.of[i]) continue;
        while (k < b.count && !b.of[k]) k++;
        bool pair = k < b.count && same_size(a.of[i], b.of[k]);
        bytes += pair ? between(a.of[i], b.of[k]) : bytes_of(a.of[i]);
        if (pair) b.of[k] = NULL;
    }
    for (k = 0; k < b.count; k++) bytes += bytes_of(b.of[k]);
    wr_free(a.of);
    wr_free(b.of);
    return bytes;
}
