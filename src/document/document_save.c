#include "document/document_file.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "document/format_version.h"
#include "document/blend.h"
#include "document/document.h"
#include "document/image_rows.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/objects.h"

#include <string.h>

#ifndef WR_VERSION
#define WR_VERSION "0"
#endif

#define FILE_ATTRIBUTES 8
#define LAYER_ATTRIBUTES 8
#define PARTS_MAX                                                                                  \
    (3 + WR_OBJECT_PICTURES * WR_OBJECTS_MAX +                                                     \
     3 * WR_LAYERS_MAX) /* F, selection, mesh, pictures; heights, cover, mask of a layer */
_Static_assert(PARTS_MAX <= WR_IMAGE_PARTS_MAX, "a document must fit into one file");

static const struct {
    const char *word;
    WrWrap u, v;
} wraps[] = { { "periodic", WR_WRAP_PERIODIC, WR_WRAP_PERIODIC },
              { "clamp-u", WR_WRAP_CLAMP, WR_WRAP_PERIODIC },
              { "clamp-v", WR_WRAP_PERIODIC, WR_WRAP_CLAMP },
              { "clamp", WR_WRAP_CLAMP, WR_WRAP_CLAMP } };
_Static_assert(WR_LENGTH(wraps) == WR_DOCUMENT_WRAPS, "document_file.h counts them");

const char *wr_document_wrap_name(int i)
{
    return i >= 0 && i < WR_DOCUMENT_WRAPS ? wraps[i].word : NULL;
}

const char *wr_document_wrap_word(WrWrap wrap_u, WrWrap wrap_v)
{
    int i = 0;
    while (wraps[i].u != wrap_u || wraps[i].v != wrap_v) i++;
    return wraps[i].word;
}

bool wr_document_wrap_find(const char *word, WrWrap *wrap_u, WrWrap *wrap_v)
{
    for (int i = 0; i < WR_DOCUMENT_WRAPS; i++) {
        if (strcmp(word, wraps[i].word) != 0) continue;
        *wrap_u = wraps[i].u;
        *wrap_v = wraps[i].v;
        return true;
    }
    return false;
}

/* ---- pixel rows of parts ---- */

static bool field_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)err;
    const WrField *field = ctx;
    int width = wr_field_width(field);
    wr_field_read(field, 0, y, width, rows, out, (size_t)width);
    return true;
}

static bool picture_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)err;
    wr_image_rows_out(ctx, 3, y, rows, out);
    return true;
}

static bool mesh_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)err;
    wr_image_rows_out(ctx, 1, y, rows, out);
    return true;
}

/* ---- file structure ---- */

typedef struct Saving {
    const WrDocument *document;
    WrImageOut parts[PARTS_MAX];
    int count;
    WrImage *mesh; /* the scene's meshes, as a picture; owned; or NULL */
    bool single;   /* the only layer is F itself */
    WrImageAttribute of_file[FILE_ATTRIBUTES + LAYER_ATTRIBUTES];
    WrImageAttribute of_layers[WR_LAYERS_MAX][LAYER_ATTRIBUTES];
    WR_ARRAY(char *) texts; /* names and values created for the file; owned */
} Saving;

/* Keeps a text until saving ends; takes ownership. */
static const char *keep(Saving *to, WrText text)
{
    char *kept = text.data ? text.data : wr_strdup("");
    wr_array_push(&to->texts, kept);
    return kept;
}

static const char *keep_number(Saving *to, float value)
{
    char buffer[WR_NUMBER_SIZE];
    WrText text = { 0 };
    wr_text_add(&text, wr_number_print_float(value, buffer));
    return keep(to, text);
}

static const char *keep_whole(Saving *to, const char *before, int value)
{
    WrText text = { 0 };
    wr_text_addf(&text, "%s%d", before, value);
    return keep(to, text);
}

static WrImageOut *add_field(Saving *to, const WrField *field, const char *name)
{
    WrImageOut *part = &to->parts[to->count++];
    *part = (WrImageOut){ .width = wr_field_width(field),
                          .height = wr_field_height(field),
                          .channels = 1,
                          .type = WR_PIXEL_F32,
                          .part_name = name,
                          .data = true,
                          .rows = field_rows,
                          .ctx = (void *)field };
    return part;
}

static const char *range_of(Saving *to, const WrField *field)
{
    float low, high;
    wr_field_range(field, &low, &high);
    char buffer[WR_NUMBER_SIZE];
    WrText text = { 0 };
    wr_text_addf(&text, "%s,", wr_number_print_float(low, buffer));
    wr_text_add(&text, wr_number_print_float(high, buffer));
    return keep(to, text);
}

/* The oldest format version that has all features in use. */
static int version_of(const Saving *to)
{
    const WrScene *scene = to->document->scene;
    const WrSceneAge age = wr_scene_age(scene);
    if (wr_document_filters(to->document)) return WR_DOCUMENT_VERSION;
    if (age == WR_SCENE_OF_FACETS) return WR_DOCUMENT_VERSION_FACETS;
    if (age == WR_SCENE_OF_CELL) return WR_DOCUMENT_VERSION_CELL;
    if (scene->environment.kind != WR_ENVIRONMENT_MAP_OFF) return WR_DOCUMENT_VERSION_SURROUND;
    if (wr_object_any_picture(scene, WR_OBJECT_NORMALS) || wr_scene_several_meshes(scene))
        return WR_DOCUMENT_VERSION_OBJECTS;
    if (to->mesh) return WR_DOCUMENT_VERSION_MESH;
    return to->single ? WR_DOCUMENT_VERSION_ALONE : WR_DOCUMENT_VERSION_PARTS;
}

static void add_composite(Saving *to, const char *scene_text)
{
    const WrDocument *document = to->document;
    const WrField *f = wr_document_field(document);
    const WrImageAttribute attributes[FILE_ATTRIBUTES] = {
        { "wrinkle:version", keep_whole(to, "", version_of(to)) },
        { "wrinkle:program", "Wrinkle " WR_VERSION },
        { "wrinkle:scene", scene_text },
        { "wrinkle:wrap", wr_document_wrap_word(wr_field_wrap_u(f), wr_field_wrap_v(f)) },
        { "wrinkle:zero", "0" },
        { "wrinkle:range", range_of(to, f) },
        { "wrinkle:active", keep_whole(to, "", document->active + 1) },
        { "wrinkle:solo", keep_whole(to, "", document->solo + 1) },
    };
    memcpy(to->of_file, attributes, sizeof attributes);
    WrImageOut *part = add_field(to, f, "F");
    part->attributes = to->of_file;
    part->attribute_count = FILE_ATTRIBUTES;
}

/* Part names must be unique, layers' names need not be: "layer:NAME", then "layer:NAME (2)" and so on. The
   attribute wrinkle:layer has the exact name. */
static const char *part_name(Saving *to, int layer)
{
    const WrLayer *layers = to->document->layers;
    int same = 1;
    for (int i = 0; i < layer; i++) same += strcmp(layers[i].name, layers[layer].name) == 0;
    WrText text = { 0 };
    wr_text_addf(&text, WR_DOCUMENT_LAYER "%s", layers[layer].name);
    if (same > 1) wr_text_addf(&text, " (%d)", same);
    return keep(to, text);
}

static const char *keep_filter(Saving *to, const WrFilter *filter)
{
    WrText text = { 0 };
    wr_filter_print(filter, &text);
    return keep(to, text);
}

/* Fills the layer's attributes; returns their number. */
static int describe_layer(Saving *to, int index, WrImageAttribute out[LAYER_ATTRIBUTES])
{
    const WrLayer *layer = &to->document->layers[index];
    const WrImageAttribute attributes[LAYER_ATTRIBUTES] = {
        { "wrinkle:layer", layer->name },
        { "wrinkle:blend", wr_blends[layer->blend].name },
        { "wrinkle:opacity", keep_number(to, layer->opacity) },
        { "wrinkle:radius", keep_number(to, layer->radius) },
        { "wrinkle:visible", layer->visible ? "on" : "off" },
        { "wrinkle:locked", layer->locked ? "on" : "off" },
        { "wrinkle:on-mask", layer->on_mask ? "on" : "off" },
    };
    memcpy(out, attributes, sizeof attributes);
    if (!layer->filter.op) return LAYER_ATTRIBUTES - 1;
    out[LAYER_ATTRIBUTES - 1] =
        (WrImageAttribute){ "wrinkle:filter", keep_filter(to, &layer->filter) };
    return LAYER_ATTRIBUTES;
}

static void add_layer(Saving *to, int index)
{
    const WrLayer *layer = &to->document->layers[index];
    int count = describe_layer(to, index, to->of_layers[index]);
    WrImageOut *part = add_field(to, layer->heights, part_name(to, index));
    part->attributes = to->of_layers[index];
    part->attribute_count = count;
    if (layer->cover) add_field(to, layer->cover, keep_whole(to, WR_DOCUMENT_COVER, index + 1));
    if (layer->mask) add_field(to, layer->mask, keep_whole(to, WR_DOCUMENT_MASK, index + 1));
}

/* A single layer's settings are stored beside the file's. */
static void add_layer_to_composite(Saving *to)
{
    to->parts[0].attribute_count =
        FILE_ATTRIBUTES + describe_layer(to, 0, to->of_file + FILE_ATTRIBUTES);
}

static bool same_bits(const WrField *a, const WrField *b)
{
    int width = wr_field_width(a), height = wr_field_height(a);
    size_t row = (size_t)width;
    if (a == b) return true;
    float *rows = wr_alloc(2 * row, sizeof *rows);
    bool same = true;
    for (int y = 0; y < height && same; y++) {
        wr_field_read(a, 0, y, width, 1, rows, row);
        wr_field_read(b, 0, y, width, 1, rows + row, row);
        same = memcmp(rows, rows + row, row * sizeof *rows) == 0;
    }
    wr_free(rows);
    return same;
}

const WrObjectPictureInfo wr_object_pictures[WR_OBJECT_PICTURES] = {
    [WR_OBJECT_COLOUR] = { "colour", "colour picture", false },
    [WR_OBJECT_NORMALS] = { "normals", "normal map", true },
    [WR_OBJECT_ROUGHNESS] = { "roughness", "roughness picture", true },
    [WR_OBJECT_METALNESS] = { "metalness", "metalness picture", true },
    [WR_OBJECT_SURROUND] = { "environment", "picture of the surroundings", false },
};

/* The environment's picture; NULL for a built-in one, which is generated again. */
static WrImage *surroundings(const WrScene *scene)
{
    return scene->environment.kind == WR_ENVIRONMENT_MAP_FILE ? scene->environment.light->image
                                                              : NULL;
}

WrImage *wr_object_picture(const WrScene *scene, int object, int which)
{
    const WrScene *own = wr_scene_object(scene, object);
    if (which == WR_OBJECT_SURROUND) return object == 0 ? surroundings(scene) : NULL;
    if (which == WR_OBJECT_ROUGHNESS) return own->facets[WR_FACET_ROUGHNESS].image;
    if (which == WR_OBJECT_METALNESS) return own->facets[WR_FACET_METALNESS].image;
    if (which == WR_OBJECT_NORMALS) return own->normals.image;
    /* a height colouring is computed again from the heights */
    return own->colouring.count > 0 ? NULL : own->colour;
}

bool wr_object_any_picture(const WrScene *scene, int which)
{
    bool any = false;
    for (int i = 0; i < wr_scene_object_count(scene); i++)
        any |= wr_object_picture(scene, i, which) != NULL;
    return any;
}

static bool has_pictures(const WrScene *scene)
{
    bool any = false;
    for (int k = 0; k < WR_OBJECT_PICTURES; k++) any |= wr_object_any_picture(scene, k);
    return any;
}

/* True if F is the whole document. Many programs support only files of one part. */
static bool fits_one_part(const WrDocument *document)
{
    const WrLayer *layer = &document->layers[0];
    return document->layer_count == 1 && !layer->filter.op && !layer->cover && !layer->mask &&
           !document->selection && !has_pictures(document->scene) && !document->scene->triangles &&
           same_bits(wr_document_field(document), layer->heights);
}

static void add_picture(Saving *to, int object, int which)
{
    const WrScene *scene = to->document->scene;
    WrImage *picture = wr_object_picture(scene, object, which);
    WrText name = { 0 };
    if (!picture) return;
    wr_text_add(&name, wr_object_pictures[which].part);
    if (wr_scene_object_count(scene) > 1) wr_text_addf(&name, ":%d", object + 1);
    to->parts[to->count++] = (WrImageOut){ .width = picture->width,
                                           .height = picture->height,
                                           .channels = 3,
                                           .type = WR_PIXEL_F32,
                                           .part_name = keep(to, name),
                                           .data = wr_object_pictures[which].data,
                                           .rows = picture_rows,
                                           .ctx = picture };
}

static void add_mesh(Saving *to)
{
    to->parts[to->count++] = (WrImageOut){ .width = to->mesh->width,
                                           .height = to->mesh->height,
                                           .channels = 1,
                                           .type = WR_PIXEL_F32,
                                           .part_name = WR_DOCUMENT_MESH,
                                           .data = true,
                                           .rows = mesh_rows,
                                           .ctx = to->mesh };
}

static bool check_pictures(const WrScene *scene, const char *path, WrError *err)
{
    for (int i = 0; i < wr_scene_object_count(scene); i++)
        for (int k = 0; k < WR_OBJECT_PICTURES; k++) {
            const WrImage *picture = wr_object_picture(scene, i, k);
            if (picture && (picture->width > WR_IMAGE_MAX || picture->height > WR_IMAGE_MAX))
                return wr_fail(err, "%s: the %s is %dx%d: each side must be 1..%d", path,
                               wr_object_pictures[k].what, picture->width, picture->height,
                               WR_IMAGE_MAX);
        }
    return true;
}

bool wr_document_save(const WrDocument *document, const char *scene_text, const char *path,
                      WrError *err)
{
    const int objects = wr_scene_object_count(document->scene);
    if (!wr_document_whole(document, NULL, err) || !check_pictures(document->scene, path, err))
        return false;
    WrImage *mesh;
    if (!wr_scene_meshes_to_image(document->scene, &mesh, err)) {
        wr_error_prefix(err, "%s: ", path);
        return false;
    }
    Saving *to = wr_alloc(1, sizeof *to);
    to->mesh = mesh;
    to->document = document;
    to->single = !mesh && fits_one_part(document);
    add_composite(to, scene_text);
    if (to->single) add_layer_to_composite(to);
    for (int i = 0; i < document->layer_count && !to->single; i++) add_layer(to, i);
    if (document->selection) add_field(to, document->selection, WR_DOCUMENT_SELECTION);
    for (int k = 0; k < WR_OBJECT_PICTURES; k++)
        for (int i = 0; i < objects; i++) add_picture(to, i, k);
    if (mesh) add_mesh(to);
    bool ok = wr_image_write(path, to->parts, to->count, err);
    for (int i = 0; i < to->texts.count; i++) wr_free(to->texts.data[i]);
    wr_array_free(&to->texts);
    wr_image_free(mesh);
    wr_free(to);
    return ok;
}
