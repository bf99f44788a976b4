/* Document files: saving and loading of one OpenEXR file, and import of pictures. */
#include "document/document_file.h"

#include "base/array.h"
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "document/blend.h"
#include "document/document.h"
#include "document/variants.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/dials.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "scene/tone_mapping.h"

#include <math.h>
#include <string.h>

/* ---- oldest version that can hold a scene ---- */

/* True if the scene has an area lamp, or one that objects can hide. */
static bool any_new_lamp(const WrScene *scene)
{
    bool any = false;
    for (int i = 0; i < scene->light_count; i++)
        any |= scene->lights[i].size_deg != 0 || scene->lights[i].shadow;
    return any;
}

static WrSceneAge age_of_object(const WrScene *object)
{
    const bool pictured =
        object->facets[WR_FACET_ROUGHNESS].image || object->facets[WR_FACET_METALNESS].image;
    const bool driving = object->grain.kind != WR_SOLID_TEXTURE_OFF &&
                         object->grain.drives != WR_SOLID_TEXTURE_COLOURS;
    if (wr_scene_projected(object) || object->normals.combine != WR_COMBINE_SLOPES)
        return WR_SCENE_OF_PROJECTION;
    if (pictured || driving || object->material.occlusion || object->parallax ||
        (object->colouring.count > 0 && object->colouring.hollow))
        return WR_SCENE_OF_FACETS;
    if (object->grain.kind != WR_SOLID_TEXTURE_OFF || object->material.shadow || object->displaced)
        return WR_SCENE_OF_CELL;
    return WR_SCENE_OLD;
}

/* Files carry the oldest version that can hold them, so that older programs read whatever they can; this function and
   version_of must grow with each new feature. */
WrSceneAge wr_scene_age(const WrScene *scene)
{
    WrSceneAge age = WR_SCENE_OLD;
    if (scene->tone.view) return WR_SCENE_OF_VIEW;
    for (int i = 0; i < wr_scene_object_count(scene); i++) {
        const WrSceneAge own = age_of_object(wr_scene_object(scene, i));
        age = own > age ? own : age;
    }
    if (age == WR_SCENE_OF_PROJECTION) return age;
    if (any_new_lamp(scene) || scene->dials.horizons != wr_dials_default().horizons ||
        scene->dials.rays != wr_dials_default().rays ||
        scene->dials.steps != wr_dials_default().steps || scene->camera.frame != 0 ||
        *scene->sheet.as)
        return WR_SCENE_OF_FACETS;
    if (wr_cell_size_given(&scene->cell) || !wr_tone_curve_params(&scene->tone).plain)
        return age > WR_SCENE_OF_CELL ? age : WR_SCENE_OF_CELL;
    return age;
}

/* ---- rows of pictures ---- */

void wr_image_rows_out(const WrImage *image, int channels, int y, int rows, float *out)
{
    const size_t first = (size_t)y * (size_t)image->width;
    const size_t count = (size_t)rows * (size_t)image->width;
    const size_t step = (size_t)image->channels, wide = (size_t)channels;
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < wide; c++)
            out[wide * i + c] = image->data[(first + i) * step + (step < wide ? 0 : c)];
}

/* ---- saving ---- */

#ifndef WR_VERSION
#define WR_VERSION "0"
#endif

/* A document is an OpenEXR file of float32 parts: "F", the composite, first, for programs that read one picture, with the
   attributes of the document; then for each layer from the bottom "layer:NAME", "cover:N", "mask:N"; "selection"; pictures of
   objects, 3 channels; the mesh, packed as a picture of one channel. Absent tables have no part: cover and mask NULL mean 1. */
#define FILE_ATTRIBUTES 10
#define LAYER_ATTRIBUTES 16
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
    int of_file_count; /* of the document */
    WrImageAttribute of_layers[WR_LAYERS_MAX][LAYER_ATTRIBUTES];
    WR_ARRAY(char *) texts; /* names and values created for the file; owned */
} Saving;

/* Keeps a text until saving ends; owns it from then on. */
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
    if (age == WR_SCENE_OF_VIEW) return WR_DOCUMENT_VERSION;
    if (wr_document_groups(to->document) || to->document->variants)
        return WR_DOCUMENT_VERSION_GROUPS;
    if (wr_document_generates(to->document)) return WR_DOCUMENT_VERSION_GENERATORS;
    if (age == WR_SCENE_OF_PROJECTION) return WR_DOCUMENT_VERSION_PROJECTION;
    if (wr_document_filters(to->document)) return WR_DOCUMENT_VERSION_FILTERS;
    if (age == WR_SCENE_OF_FACETS) return WR_DOCUMENT_VERSION_FACETS;
    if (age == WR_SCENE_OF_CELL) return WR_DOCUMENT_VERSION_CELL;
    if (scene->environment.kind != WR_ENVIRONMENT_MAP_OFF) return WR_DOCUMENT_VERSION_SURROUND;
    if (wr_object_any_picture(scene, WR_OBJECT_NORMALS) || wr_scene_several_meshes(scene))
        return WR_DOCUMENT_VERSION_OBJECTS;
    if (to->mesh) return WR_DOCUMENT_VERSION_MESH;
    return to->single ? WR_DOCUMENT_VERSION_ALONE : WR_DOCUMENT_VERSION_PARTS;
}

/* Fills the document's attributes; returns their number. */
static int describe_document(Saving *to, const char *scene_text, WrImageAttribute *out)
{
    const WrDocument *document = to->document;
    const WrField *f = wr_document_field(document);
    const WrImageAttribute attributes[] = {
        { "wrinkle:version", keep_whole(to, "", version_of(to)) },
        { "wrinkle:program", "Wrinkle " WR_VERSION },
        { "wrinkle:scene", scene_text },
        { "wrinkle:wrap", wr_document_wrap_word(wr_field_wrap_u(f), wr_field_wrap_v(f)) },
        { "wrinkle:zero", "0" },
        { "wrinkle:range", range_of(to, f) },
        { "wrinkle:active", keep_whole(to, "", document->active + 1) },
        { "wrinkle:solo", keep_whole(to, "", document->solo + 1) },
    };
    int count = WR_LENGTH(attributes);
    memcpy(out, attributes, sizeof attributes);
    if (document->variants)
        out[count++] = (WrImageAttribute){ "wrinkle:variants", document->variants };
    if (document->variant)
        out[count++] = (WrImageAttribute){ "wrinkle:variant", document->variant };
    return count;
}

static void add_composite(Saving *to, const char *scene_text)
{
    to->of_file_count = describe_document(to, scene_text, to->of_file);
    WrImageOut *part = add_field(to, wr_document_field(to->document), "F");
    part->attributes = to->of_file;
    part->attribute_count = to->of_file_count;
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

static const char *keep_hash(Saving *to, WrHash hash)
{
    char hex[WR_HASH_DIGITS + 1];
    WrText text = { 0 };
    wr_hash_print(hash, hex);
    wr_text_add(&text, hex);
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
    int count = 7;
    memcpy(out, attributes, sizeof attributes);
    if (layer->filter.op)
        out[count++] = (WrImageAttribute){ "wrinkle:filter", keep_filter(to, &layer->filter) };
    if (layer->line) {
        out[count++] = (WrImageAttribute){ "wrinkle:line", layer->line };
        out[count++] = (WrImageAttribute){ "wrinkle:below", keep_hash(to, layer->below) };
    }
    if (layer->mask_line) {
        out[count++] = (WrImageAttribute){ "wrinkle:mask-line", layer->mask_line };
        out[count++] = (WrImageAttribute){ "wrinkle:mask-read", keep_hash(to, layer->mask_read) };
    }
    if (layer->depth)
        out[count++] = (WrImageAttribute){ "wrinkle:depth", keep_whole(to, "", layer->depth) };
    if (layer->is_group) out[count++] = (WrImageAttribute){ "wrinkle:group", "on" };
    if (layer->collapsed) out[count++] = (WrImageAttribute){ "wrinkle:collapsed", "on" };
    if (layer->values) out[count++] = (WrImageAttribute){ "wrinkle:values", layer->values };
    return count;
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
        to->of_file_count + describe_layer(to, 0, to->of_file + to->of_file_count);
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
    return document->layer_count == 1 && wr_layer_holds(layer) && !layer->cover && !layer->mask &&
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
                      WrPool *pool, WrError *err)
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
    to->parts[0].pool = pool;
    bool ok = wr_image_write(path, to->parts, to->count, err);
    for (int i = 0; i < to->texts.count; i++) wr_free(to->texts.data[i]);
    wr_array_free(&to->texts);
    wr_image_free(mesh);
    wr_free(to);
    return ok;
}

/* ---- loading ---- */

/* Never waits on a pipe, and does not start the picture library for a file that is no EXR. */
static bool has_exr_magic(const char *path)
{
    static const unsigned char magic[4] = { 0x76, 0x2f, 0x31, 0x01 };
    unsigned char bytes[4];
    return wr_file_peek(path, bytes, sizeof bytes) == sizeof bytes &&
           memcmp(bytes, magic, sizeof magic) == 0;
}

bool wr_document_recognise(const char *path)
{
    WrError err;
    if (!has_exr_magic(path)) return false;
    WrImageFile *image = wr_image_file_open(path, &err);
    if (!image) return false;
    bool ours = wr_image_file_attribute(image, 0, "wrinkle:version") != NULL;
    wr_image_file_close(image);
    return ours;
}

/* The parts of one layer; 0: none. */
typedef struct Slot {
    int heights, cover, mask;
} Slot;

typedef struct Loading {
    const char *path;
    WrImageFile *file;
    double version;
    bool newer; /* unknown settings are ignored */
    int width, height;
    WrWrap wrap_u, wrap_v;
    Slot slots[WR_LAYERS_MAX];
    int layers, selection, mesh;                     /* number of layers; parts, 0: none */
    int picture[WR_OBJECTS_MAX][WR_OBJECT_PICTURES]; /* parts of the objects, 0: none */
    bool pictured;                                   /* there is at least one */
    int64_t replaced;
} Loading;

static bool check_version(Loading *in, WrError *err)
{
    const char *text = wr_image_file_attribute(in->file, 0, "wrinkle:version");
    if (!text) return wr_fail(err, "%s: is not a Wrinkle document", in->path);
    if (!wr_number_parse(text, strlen(text), &in->version) || in->version < 1 ||
        floor(in->version) != in->version)
        return wr_fail(err, "%s: damaged: document version '%.40s'", in->path, text);
    in->newer = in->version > WR_DOCUMENT_VERSION;
    return true;
}

static bool read_wrap(Loading *in, WrError *err)
{
    const char *word = wr_image_file_attribute(in->file, 0, "wrinkle:wrap");
    if (word && wr_document_wrap_find(word, &in->wrap_u, &in->wrap_v)) return true;
    return wr_fail(err, "%s: damaged: wrap '%.40s' must be periodic, clamp-u, clamp-v or clamp",
                   in->path, word ? word : "");
}

/* ---- finding the parts ---- */

static bool begins_with(const char *text, const char *start)
{
    return strncmp(text, start, strlen(start)) == 0;
}

/* True if the name is PREFIX and the number of the last listed layer, as "cover:3". */
static bool belongs(const Loading *in, const char *name, const char *prefix)
{
    char want[32];
    snprintf(want, sizeof want, "%s%d", prefix, in->layers);
    return in->layers > 0 && strcmp(name, want) == 0;
}

/* True once a part has come that follows all layers. */
static bool ends(const Loading *in)
{
    return in->selection || in->pictured || in->mesh;
}

/* Object index of a picture: "colour", "colour:3"; -1: not a picture. */
static int object_of(const char *name, int *which)
{
    char want[32];
    for (*which = 0; *which < WR_OBJECT_PICTURES; ++*which) {
        const char *part = wr_object_pictures[*which].part;
        if (strcmp(name, part) == 0) return 0;
        for (int i = 0; i < WR_OBJECTS_MAX; i++) {
            snprintf(want, sizeof want, "%s:%d", part, i + 1);
            if (strcmp(name, want) == 0) return i;
        }
    }
    return -1;
}

/* Assigns a part to its place. False if it has none, or the place is taken or out of order. */
static bool place_part(Loading *in, const char *name, int part)
{
    int object, which;
    Slot *last = in->layers > 0 ? &in->slots[in->layers - 1] : NULL;
    if (begins_with(name, WR_DOCUMENT_LAYER)) {
        if (ends(in) || in->layers == WR_LAYERS_MAX) return false;
        in->slots[in->layers++] = (Slot){ .heights = part };
    } else if (belongs(in, name, WR_DOCUMENT_COVER)) {
        if (last->cover || last->mask || ends(in)) return false;
        last->cover = part;
    } else if (belongs(in, name, WR_DOCUMENT_MASK)) {
        if (last->mask || ends(in)) return false;
        last->mask = part;
    } else if (strcmp(name, WR_DOCUMENT_SELECTION) == 0) {
        if (ends(in)) return false;
        in->selection = part;
    } else if ((object = object_of(name, &which)) >= 0) {
        if (in->picture[object][which] || in->mesh) return false;
        in->picture[object][which] = part;
        in->pictured = true;
    } else if (strcmp(name, WR_DOCUMENT_MESH) == 0) {
        if (in->mesh) return false;
        in->mesh = part;
    } else {
        return false;
    }
    return true;
}

static bool check_part(const Loading *in, int index, WrError *err)
{
    WrImagePart part = wr_image_file_part(in->file, index);
    int which;
    const bool picture = object_of(part.name, &which) >= 0;
    if (picture && part.channels != 3)
        return wr_fail(err, "%s: damaged: the %s has %d channels; must be 3", in->path,
                       wr_object_pictures[which].what, part.channels);
    const bool mesh = index == in->mesh;
    if (mesh && part.channels != 1)
        return wr_fail(err, "%s: damaged: the mesh has %d channels; must be 1", in->path,
                       part.channels);
    if (!picture && !mesh &&
        (part.width != in->width || part.height != in->height || part.channels != 1))
        return wr_fail(
            err, "%s: damaged: part '%.60s' is %dx%d with %d channels; F is %dx%d with 1", in->path,
            part.name, part.width, part.height, part.channels, in->width, in->height);
    return true;
}

/* F, which may be the only layer; else for each layer its heights, cover and mask; selection; pictures; mesh: in
   this order, and nothing else. The fixed order makes damage visible: a part out of order is an error, not a guess. */
static bool find_parts(Loading *in, WrError *err)
{
    int count = wr_image_file_parts(in->file);
    WrImagePart f = wr_image_file_part(in->file, 0);
    in->width = f.width;
    in->height = f.height;
    if (count == 1 && wr_image_file_attribute(in->file, 0, "wrinkle:layer")) {
        in->slots[in->layers++] = (Slot){ .heights = 0 }; /* F is the layer */
        if (f.channels != 1)
            return wr_fail(err, "%s: damaged: F has %d channels; must be 1", in->path, f.channels);
    }
    for (int i = 1; i < count; i++) {
        WrImagePart part = wr_image_file_part(in->file, i);
        if (begins_with(part.name, WR_DOCUMENT_LAYER) && in->layers == WR_LAYERS_MAX)
            return wr_fail(err, "%s: more than %d layers", in->path, WR_LAYERS_MAX);
        if (place_part(in, part.name, i)) {
            if (!check_part(in, i, err)) return false;
        } else if (!in->newer) {
            return wr_fail(err, "%s: damaged: part '%.60s' does not belong in a document", in->path,
                           part.name);
        }
    }
    if (in->layers == 0) return wr_fail(err, "%s: damaged: has no layer", in->path);
    return true;
}

/* ---- fields ---- */

bool wr_document_all_at(const float *texels, size_t pitch, int columns, int rows, float level)
{
    uint32_t want;
    memcpy(&want, &level, sizeof want);
    for (int y = 0; y < rows; y++, texels += pitch) {
        uint32_t different = 0;
#pragma omp simd reduction(| : different)
        for (int x = 0; x < columns; x++) {
            uint32_t bits;
            memcpy(&bits, &texels[x], sizeof bits);
            different |= bits ^ want;
        }
        if (different) return false;
    }
    return true;
}

/* Stores a strip of one row of tiles. Tiles at the table's level are not allocated, so that an almost empty
   table is as small as it was when saved. Strips are as high as tiles, so that each tile is compared and written once. */
static void store_strip(Loading *in, WrField *field, int y, int rows, const float *strip)
{
    for (int x = 0; x < in->width; x += WR_TILE) {
        int columns = in->width - x < WR_TILE ? in->width - x : WR_TILE;
        if (wr_document_all_at(strip + x, (size_t)in->width, columns, rows, wr_field_level(field)))
            continue;
        in->replaced += wr_field_write(field, x, y, columns, rows, strip + x, (size_t)in->width);
    }
}

/* Clamps coverage, masks and selections to 0..1. */
static void clamp_strip(float *strip, size_t count)
{
#pragma omp simd
    for (size_t i = 0; i < count; i++) {
        const float value = strip[i], above = value < 0.0f ? 0.0f : value;
        strip[i] = above > 1.0f && above <= 3.4e38f ? 1.0f : above;
    }
}

/* The first texel becomes the table's level: in an almost empty table most tiles equal it and are not allocated. */
static WrField *read_field(Loading *in, int part, bool heights, WrError *err)
{
    WrField *field = NULL;
    float *strip = wr_try_alloc((size_t)in->width * WR_TILE, sizeof *strip, "rows of a layer", err);
    for (int y = 0; strip && y < in->height; y += WR_TILE) {
        int rows = in->height - y < WR_TILE ? in->height - y : WR_TILE;
        double done = part + (double)y / in->height;
        if (!wr_progress_report(done / wr_image_file_parts(in->file))) {
            wr_fail(err, "%s: cancelled", in->path);
            goto fail;
        }
        if (!wr_image_file_read_rows(in->file, part, y, rows, strip, err)) goto fail;
        if (!heights) clamp_strip(strip, (size_t)in->width * (size_t)rows);
        if (!field) {
            float level = isfinite(strip[0]) ? strip[0] : 0.0f;
            field = wr_field_new(in->width, in->height, in->wrap_u, in->wrap_v, level, err);
            if (!field) goto fail;
        }
        store_strip(in, field, y, rows, strip);
    }
    wr_free(strip);
    return field;
fail:
    wr_free(strip);
    wr_field_free(field);
    return NULL;
}

/* Reads a picture of the scene, unchanged. */
static WrImage *read_image(Loading *in, int part, WrError *err)
{
    WrImagePart is = wr_image_file_part(in->file, part);
    WrImage *image = wr_image_new(is.width, is.height, is.channels, err);
    if (!image) return NULL;
    if (!wr_image_file_read(in->file, part, image->data, err)) {
        wr_image_free(image);
        return NULL;
    }
    size_t count = (size_t)is.width * (size_t)is.height * (size_t)is.channels;
    image->replaced = wr_image_codes(WR_PIXEL_F32, image->data, count, image->data, NULL);
    return image;
}

/* ---- settings ---- */

/* Error for an invalid attribute of a layer; a newer version may use it in another way. */
static bool fail_setting(const Loading *in, const char *name, const char *value, WrError *err)
{
    if (in->newer) return true;
    return wr_fail(err, "%s: damaged: %s '%.40s' of a layer", in->path, name, value);
}

static bool read_number(Loading *in, int part, const char *name, double high, float *out,
                        WrError *err)
{
    const char *text = wr_image_file_attribute(in->file, part, name);
    double value;
    if (!text) return true;
    if (!wr_number_parse(text, strlen(text), &value) || !(value >= 0 && value <= high))
        return fail_setting(in, name, text, err);
    *out = (float)value;
    return true;
}

static bool read_switch(Loading *in, int part, const char *name, bool *out, WrError *err)
{
    const char *text = wr_image_file_attribute(in->file, part, name);
    if (!text) return true;
    bool on = strcmp(text, "on") == 0;
    if (!on && strcmp(text, "off") != 0) return fail_setting(in, name, text, err);
    *out = on;
    return true;
}

/* Reads a filter of a known format version; an unknown filter of a newer one leaves an empty layer. */
static bool read_filter(Loading *in, int part, WrFilter *out, WrError *err)
{
    const char *text = wr_image_file_attribute(in->file, part, "wrinkle:filter");
    WrError why = { "" };
    WrFilter filter;
    if (!text) return true;
    if (wr_filter_parse(text, &filter, &why)) *out = filter;
    else if (!in->newer)
        return wr_fail(err, "%s: damaged: filter '%.40s' of a layer: %s", in->path, text,
                       wr_error_message(&why));
    return true;
}

static bool read_blend(Loading *in, int part, WrBlend *out, WrError *err)
{
    const char *text = wr_image_file_attribute(in->file, part, "wrinkle:blend");
    if (!text) return true; /* version 1 had no modes: all layers were added */
    int blend = wr_blend_find(text);
    if (blend < 0) return fail_setting(in, "wrinkle:blend", text, err);
    *out = (WrBlend)blend;
    return true;
}

/* Restricts a name to valid ones: limited length, whole characters, no control characters. */
static char *clean_name(const char *name)
{
    size_t length = strlen(name);
    if (length > WR_LAYER_NAME_MAX) {
        length = WR_LAYER_NAME_MAX;
        while (length > 0 && ((unsigned char)name[length] & 0xC0) == 0x80) length--;
    }
    char *clean = wr_strndup(name, length);
    for (char *p = clean; *p; p++)
        if ((unsigned char)*p < 0x20 || *p == 0x7F) *p = '?';
    return clean;
}

/* Reads a hash; *hash is unchanged if there is none. */
static bool read_hash(Loading *in, int part, const char *name, WrHash *hash, WrError *err)
{
    const char *hex = wr_image_file_attribute(in->file, part, name);
    return !hex || wr_hash_parse(hex, hash) || fail_setting(in, name, hex, err);
}

/* Reads the line of a generator layer, whose heights are read. */
static bool read_line(Loading *in, int part, WrLayer *layer, WrError *err)
{
    WrHash below = { 0, 0 };
    if (!read_hash(in, part, "wrinkle:below", &below, err)) return false;
    wr_layer_set_line(layer, wr_image_file_attribute(in->file, part, "wrinkle:line"), below);
    return true;
}

/* Reads the terms of a live mask, which is read. */
static bool read_mask_line(Loading *in, int part, WrLayer *layer, WrError *err)
{
    WrHash read = { 0, 0 };
    if (!read_hash(in, part, "wrinkle:mask-read", &read, err)) return false;
    wr_layer_set_mask_line(layer, wr_image_file_attribute(in->file, part, "wrinkle:mask-line"),
                           read);
    return true;
}

/* Reads the place of a layer in groups; whether they exist is checked when all are read. */
static bool read_place(Loading *in, int part, WrLayer *layer, WrError *err)
{
    float depth = 0.0f;
    if (!read_number(in, part, "wrinkle:depth", WR_DEPTH_MAX, &depth, err) ||
        !read_switch(in, part, "wrinkle:group", &layer->is_group, err) ||
        !read_switch(in, part, "wrinkle:collapsed", &layer->collapsed, err))
        return false;
    layer->depth = (int)depth;
    return true;
}

static bool read_layer(Loading *in, int index, WrLayer *out, WrError *err)
{
    Slot slot = in->slots[index];
    const char *name = wr_image_file_attribute(in->file, slot.heights, "wrinkle:layer");
    if (!name) name = wr_image_file_part(in->file, slot.heights).name + strlen(WR_DOCUMENT_LAYER);
    WrLayer layer = { .name = clean_name(name), .opacity = 1.0f, .visible = true };
    bool good = read_blend(in, slot.heights, &layer.blend, err) &&
                read_number(in, slot.heights, "wrinkle:opacity", 1.0, &layer.opacity, err) &&
                read_number(in, slot.heights, "wrinkle:radius", 3.4028234663852886e38,
                            &layer.radius, err) &&
                read_filter(in, slot.heights, &layer.filter, err) &&
                read_place(in, slot.heights, &layer, err) &&
                read_switch(in, slot.heights, "wrinkle:visible", &layer.visible, err) &&
                read_switch(in, slot.heights, "wrinkle:locked", &layer.locked, err) &&
                read_switch(in, slot.heights, "wrinkle:on-mask", &layer.on_mask, err) &&
                (layer.heights = read_field(in, slot.heights, true, err)) &&
                read_line(in, slot.heights, &layer, err) &&
                (!slot.cover || (layer.cover = read_field(in, slot.cover, false, err))) &&
                (!slot.mask || (layer.mask = read_field(in, slot.mask, false, err))) &&
                read_mask_line(in, slot.heights, &layer, err);
    layer.values = wr_strdup(wr_image_file_attribute(in->file, slot.heights, "wrinkle:values"));
    layer.on_mask = layer.on_mask && layer.mask;
    if (good) *out = layer;
    else wr_layer_fini(&layer);
    return good;
}

/* Reads the number of a layer, from `low` on, as the index *out. */
static bool read_index(Loading *in, const char *name, int low, int *out, WrError *err)
{
    const char *text = wr_image_file_attribute(in->file, 0, name);
    double value;
    if (!text) return true;
    if (!wr_number_parse(text, strlen(text), &value) || value != floor(value) || value < low ||
        value > in->layers)
        return in->newer || wr_fail(err, "%s: damaged: %s '%.40s': must be %d..%d", in->path, name,
                                    text, low, in->layers);
    *out = (int)value - 1;
    return true;
}

/* Reads the layers, which replace those of the new document. */
static bool read_document(Loading *in, WrDocument *document, WrError *err)
{
    for (int i = 0; i < in->layers; i++) {
        WrLayer layer;
        if (!read_layer(in, i, &layer, err)) return false;
        wr_document_insert(document, document->layer_count, layer);
        if (i == 0) wr_document_remove(document, 0);
        document->layers[i].depth = layer.depth; /* of a group that is yet to come */
    }
    WrError why;
    if (!wr_document_check_groups(document, &why))
        return wr_fail(err, "%s: damaged: %s", in->path, wr_error_message(&why));
    if (in->selection && !(document->selection = read_field(in, in->selection, false, err)))
        return false;
    wr_document_set_variants(document, wr_image_file_attribute(in->file, 0, "wrinkle:variants"),
                             wr_image_file_attribute(in->file, 0, "wrinkle:variant"));
    return read_index(in, "wrinkle:active", 1, &document->active, err) &&
           read_index(in, "wrinkle:solo", 0, &document->solo, err);
}

static bool load(Loading *in, WrLoaded *loaded, WrError *err)
{
    if (!check_version(in, err) || !read_wrap(in, err) || !find_parts(in, err)) return false;
    loaded->document = wr_document_new();
    if (!read_document(in, loaded->document, err)) return false;
    for (int i = 0; i < WR_OBJECTS_MAX; i++)
        for (int k = 0; k < WR_OBJECT_PICTURES; k++) {
            const int part = in->picture[i][k];
            if (part && !(loaded->pictures[i][k] = read_image(in, part, err))) return false;
        }
    if (in->mesh && !(loaded->mesh = read_image(in, in->mesh, err))) return false;
    const char *scene = wr_image_file_attribute(in->file, 0, "wrinkle:scene");
    loaded->scene_text = wr_strdup(scene ? scene : "");
    loaded->newer_version = in->newer ? in->version : 0;
    return true;
}

void wr_loaded_free_images(WrLoaded *loaded)
{
    for (int i = 0; i < WR_OBJECTS_MAX; i++)
        for (int k = 0; k < WR_OBJECT_PICTURES; k++) {
            wr_image_free(loaded->pictures[i][k]);
            loaded->pictures[i][k] = NULL;
        }
    wr_image_free(loaded->mesh);
    loaded->mesh = NULL;
}

bool wr_document_load(const char *path, WrLoaded *out, int64_t *replaced, WrError *err)
{
    Loading *in = wr_alloc(1, sizeof *in);
    WrLoaded loaded = { 0 };
    in->path = path;
    in->file = wr_image_file_open(path, err);
    bool good = in->file && load(in, &loaded, err);
    if (good) {
        *out = loaded;
        *replaced = in->replaced;
    } else {
        wr_document_free(loaded.document);
        wr_loaded_free_images(&loaded);
    }
    wr_image_file_close(in->file);
    wr_free(in);
    return good;
}

/* ---- import of pictures ---- */

/* Conversion of pictures to heights, one output row at a time: the weighted sum of input rows, then the weighted
   sum of its columns, both in double and in the order of the taps, so that the bits are the same everywhere. No
   buffer is larger than a row. */

/* The filter taps of one output texel on one axis. */
typedef struct Taps {
    int first, count; /* input indices first .. first + count - 1, not yet wrapped */
    double *weight;   /* [count], sum 1 */
} Taps;

typedef struct Axis {
    int from, to; /* number of texels of input and output */
    WrWrap wrap;
    int most; /* maximum number of taps */
} Axis;

static Axis make_axis(int from, int to, WrWrap wrap)
{
    int most = to < from ? (int)ceil((double)from / to) + 2 : 4;
    return (Axis){ from, to, wrap, most };
}

/* Box filter: the part of each input texel that lies under the output texel, [i s, (i+1) s), s = from/to. In
   integers, so that whole ratios give exactly equal weights. */
static void box_taps(const Axis *axis, int i, Taps *taps)
{
    int64_t from = axis->from, to = axis->to;
    int64_t begin = i * from, end = begin + from; /* in units of 1/to input texels */
    taps->first = (int)(begin / to);
    taps->count = 0;
    for (int64_t k = taps->first; k * to < end; k++) {
        int64_t left = k * to > begin ? k * to : begin;
        int64_t right = (k + 1) * to < end ? (k + 1) * to : end;
        taps->weight[taps->count++] = (double)(right - left) / (double)from;
    }
}

/* Catmull-Rom through the input's texel centres: x = (i + 1/2) s - 1/2, reduced in integers. */
static void cubic_taps(const Axis *axis, int i, Taps *taps)
{
    int64_t from = axis->from, to = axis->to;
    int64_t twice = (2 * i + 1) * from - to; /* x = twice / (2 to), above -1 */
    int64_t cell = (twice + 2 * to) / (2 * to) - 1;
    double t = (double)(twice - cell * 2 * to) / (double)(2 * to);
    taps->first = (int)cell - 1;
    taps->count = 4;
    taps->weight[0] = 0.5 * t * (t * (2.0 - t) - 1.0);
    taps->weight[1] = 0.5 * (t * t * (3.0 * t - 5.0) + 2.0);
    taps->weight[2] = 0.5 * t * (t * (4.0 - 3.0 * t) + 1.0);
    taps->weight[3] = 0.5 * t * t * (t - 1.0);
}

static void find_taps(const Axis *axis, int i, Taps *taps)
{
    if (axis->to == axis->from) {
        taps->first = i;
        taps->count = 1;
        taps->weight[0] = 1.0;
    } else if (axis->to < axis->from) {
        box_taps(axis, i, taps);
    } else {
        cubic_taps(axis, i, taps);
    }
}

static int wrap_index(const Axis *axis, int i)
{
    int n = axis->from;
    if (axis->wrap == WR_WRAP_CLAMP) return i < 0 ? 0 : i >= n ? n - 1 : i;
    i %= n;
    return i < 0 ? i + n : i;
}

/* Grey value of one pixel; pictures of one or two channels are already grey. */
static inline float grey(const float *pixel, int channels)
{
    float f = channels < 3 ? pixel[0] : wr_image_luma(pixel, channels);
    return isfinite(f) ? f : 0.0f;
}

typedef struct Resampling {
    const WrImage *image; /* the whole picture; or only its header, with `rows` */
    WrImageRows *rows;
    Axis u, v;
    Taps *columns;   /* [u.to] */
    double *weights; /* those of the columns, u.most each, then v.most for the current row */
    double *row;     /* [image width] */
} Resampling;

static const float *input_row(const Resampling *r, int y, WrError *err)
{
    const WrImage *image = r->image;
    if (r->rows) return wr_image_rows_get(r->rows, y, err);
    return image->data + (size_t)y * (size_t)image->width * (size_t)image->channels;
}

/* Without resampling: equals the sums below, including -0 as 0. */
static bool copy_row(const Resampling *r, int j, float *out, WrError *err)
{
    const float *in = input_row(r, j, err);
    int channels = r->image->channels;
    for (int x = 0; in && x < r->u.to; x++) out[x] = grey(in + x * channels, channels) + 0.0f;
    return in != NULL;
}

static bool resample_row(const Resampling *r, int j, float *out, WrError *err)
{
    Taps taps = { 0, 0, r->weights + (size_t)r->u.to * (size_t)r->u.most };
    int channels = r->image->channels;
    find_taps(&r->v, j, &taps);
    for (int x = 0; x < r->u.from; x++) r->row[x] = 0.0;
    for (int k = 0; k < taps.count; k++) {
        const float *in = input_row(r, wrap_index(&r->v, taps.first + k), err);
        if (!in) return false;
        for (int x = 0; x < r->u.from; x++)
            r->row[x] += taps.weight[k] * (double)grey(in + x * channels, channels);
    }
    for (int i = 0; i < r->u.to; i++) {
        const Taps *column = &r->columns[i];
        double sum = 0.0;
        for (int k = 0; k < column->count; k++)
            sum += column->weight[k] * r->row[wrap_index(&r->u, column->first + k)];
        out[i] = (float)sum;
    }
    return true;
}

/* Computes rows [j, j + count) of the table. */
static bool make_rows(const Resampling *r, int j, int count, float *out, WrError *err)
{
    bool same = r->u.from == r->u.to && r->v.from == r->v.to;
    for (int k = 0; k < count; k++, out += r->u.to) {
        if (!wr_progress_report((double)(j + k) / r->v.to)) return wr_fail(err, "cancelled");
        if (!(same ? copy_row : resample_row)(r, j + k, out, err)) return false;
    }
    return true;
}

/* Fills one row of tiles at a time, so that tiles of one height are not allocated; that height is the first
   texel's. */
static WrField *fill_field(const Resampling *r, float *strip, WrError *err)
{
    WrField *field = NULL;
    for (int j = 0; j < r->v.to; j += WR_TILE) {
        int count = r->v.to - j < WR_TILE ? r->v.to - j : WR_TILE;
        bool ok = make_rows(r, j, count, strip, err);
        if (ok && !field)
            ok = (field = wr_field_new(r->u.to, r->v.to, r->u.wrap, r->v.wrap, strip[0], err));
        if (!ok) {
            wr_field_free(field);
            return NULL;
        }
        wr_field_write(field, 0, j, r->u.to, count, strip, (size_t)r->u.to);
    }
    return field;
}

static WrField *resample(Resampling *r, WrError *err)
{
    size_t columns = (size_t)r->u.to;
    WrField *field = NULL;
    r->columns = wr_try_alloc(columns, sizeof *r->columns, "filter taps", err);
    if (!r->columns) return NULL;
    r->weights = wr_try_alloc(columns * (size_t)r->u.most + (size_t)r->v.most, sizeof *r->weights,
                              "filter weights", err);
    r->row = wr_try_alloc((size_t)r->u.from, sizeof *r->row, "a row", err);
    float *strip = wr_try_alloc(columns * WR_TILE, sizeof *strip, "rows of a table", err);
    bool ok = r->weights && r->row && strip;
    for (int i = 0; ok && i < r->u.to && !wr_progress_stopped(); i++) {
        r->columns[i].weight = r->weights + (size_t)i * (size_t)r->u.most;
        find_taps(&r->u, i, &r->columns[i]);
    }
    if (ok) field = fill_field(r, strip, err);
    wr_free(strip);
    wr_free(r->row);
    wr_free(r->weights);
    wr_free(r->columns);
    return field;
}

static WrField *import(const WrImage *image, WrImageRows *rows, int width, int height,
                       WrWrap wrap_u, WrWrap wrap_v, WrError *err)
{
    if (width == 0 && height == 0) {
        width = image->width;
        height = image->height;
    }
    if (width < 1 || width > WR_FIELD_MAX || height < 1 || height > WR_FIELD_MAX) {
        wr_field_new(width, height, wrap_u, wrap_v, 0.0f, err); /* err is set */
        return NULL;
    }
    Resampling r = { .image = image,
                     .rows = rows,
                     .u = make_axis(image->width, width, wrap_u),
                     .v = make_axis(image->height, height, wrap_v) };
    return resample(&r, err);
}

WrField *wr_import_heights(const WrImage *image, int width, int height, WrWrap wrap_u,
                           WrWrap wrap_v, WrError *err)
{
    return import(image, NULL, width, height, wrap_u, wrap_v, err);
}

WrField *wr_import_rows(WrImageRows *rows, int width, int height, WrWrap wrap_u, WrWrap wrap_v,
                        WrError *err)
{
    const WrImage *head = wr_image_rows_head(rows);
    if (height <= head->height) return import(head, rows, width, height, wrap_u, wrap_v, err);
    /* Growing starts with rows from the other end; such a picture is smaller than the table. */
    WrImage *image = wr_image_rows_whole(rows, err);
    if (!image) return NULL;
    WrField *field = import(image, NULL, width, height, wrap_u, wrap_v, err);
    wr_image_free(image);
    return field;
}
