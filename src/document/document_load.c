#include "document/document_file.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "document/blend.h"
#include "document/document.h"
#include "field/field.h"
#include "image/image.h"

#include <math.h>
#include <string.h>

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
   this order, and nothing else. */
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
            return wr_fail(err, "%s: damaged: part '%.60s' has no place in a document", in->path,
                           part.name);
        }
    }
    if (in->layers == 0) return wr_fail(err, "%s: damaged: has no layer", in->path);
    return true;
}

/* ---- fields ---- */

bool wr_document_all_at(const float *texels, size_t pitch, int columns, int rows, float level)
{
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < columns; x++)
            if (memcmp(&texels[(size_t)y * pitch + (size_t)x], &level, sizeof level) != 0)
                return false;
    return true;
}

/* Stores a strip of one row of tiles. Tiles at the table's level are not allocated, so that an almost empty
   table is as small as it was when saved. */
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
    for (size_t i = 0; i < count; i++) {
        if (strip[i] < 0.0f) strip[i] = 0.0f;
        if (strip[i] > 1.0f && strip[i] <= 3.4e38f) strip[i] = 1.0f;
    }
}

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
                read_switch(in, slot.heights, "wrinkle:visible", &layer.visible, err) &&
                read_switch(in, slot.heights, "wrinkle:locked", &layer.locked, err) &&
                read_switch(in, slot.heights, "wrinkle:on-mask", &layer.on_mask, err) &&
                (layer.heights = read_field(in, slot.heights, true, err)) &&
                (!slot.cover || (layer.cover = read_field(in, slot.cover, false, err))) &&
                (!slot.mask || (layer.mask = read_field(in, slot.mask, false, err)));
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
    }
    if (in->selection && !(document->selection = read_field(in, in->selection, false, err)))
        return false;
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
