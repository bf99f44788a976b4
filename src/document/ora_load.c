#include "document/ora.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "document/document.h"
#include "document/ora_stack.h"
#include "document/ora_zip.h"
#include "field/field.h"
#include "image/image.h"

#include <math.h>
#include <string.h>

#define STACK_MAX ((size_t)16 << 20)   /* bytes of stack.xml */
#define SCENE_MAX ((size_t)64 << 20)   /* bytes of the scene */
#define PICTURE_MAX ((size_t)2 << 30)  /* bytes of a picture */
#define PIXELS_MAX ((int64_t)16 << 28) /* total of all layers: 16 of the largest size */

static const char type[] = "image/openraster";

/* The first entry's local header, its name and content. */
bool wr_ora_recognise(const char *path)
{
    char bytes[30 + 8 + sizeof type - 1];
    size_t n = wr_file_peek(path, bytes, sizeof bytes);
    return n == sizeof bytes && memcmp(bytes, "PK\3\4", 4) == 0 &&
           memcmp(bytes + 30, "mimetype", 8) == 0 && memcmp(bytes + 38, type, sizeof type - 1) == 0;
}

typedef struct Loading {
    const char *path;
    WrOraZip *zip;
    WrOraStack stack;
    WrWrap wrap_u, wrap_v;
    bool newer; /* than this program: unknown attributes are ignored */
    int64_t replaced;
    int64_t pixels;     /* total of the pictures read so far */
    int read, pictures; /* pictures read, and their total number */
    WrText *notes;
} Loading;

static int count_pictures(const WrOraStack *stack)
{
    int count = (stack->selection != NULL) + (stack->mesh != NULL);
    for (int i = 0; i < WR_OBJECTS_MAX; i++)
        for (int k = 0; k < WR_OBJECT_PICTURES; k++) count += stack->pictures[i][k] != NULL;
    for (int i = 0; i < stack->layers.count; i++) {
        const WrOraLayer *layer = &stack->layers.data[i];
        count += 1 + (layer->cover != NULL) + (layer->mask != NULL);
    }
    return count;
}

static WrImage *read_picture(Loading *in, const char *entry, WrError *err)
{
    char *bytes;
    size_t length;
    if (!wr_ora_zip_read(in->zip, entry, PICTURE_MAX, &bytes, &length, err)) return NULL;
    WrProgressPart part;
    double all = in->pictures, from = in->read++ / all;
    const WrProgress *whole = wr_progress_enter(&part, from, from + 1.0 / all);
    WrImage *image = wr_image_read_bytes(entry, bytes, length, err);
    wr_progress_set(whole);
    wr_free(bytes);
    if (!image) {
        wr_error_prefix(err, "%s: in it, ", in->path);
        return NULL;
    }
    in->pixels += (int64_t)image->width * image->height;
    if (in->pixels <= PIXELS_MAX) return image;
    wr_image_free(image);
    wr_fail(err, "%s: its pictures have more than %lld million pixels in all", in->path,
            (long long)(PIXELS_MAX / 1000000));
    return NULL;
}

/* ---- fields ---- */

/* Stores rows from y on; y and all rows but the last are those of tiles. Tiles at the field's level are not
   allocated. */
static void store_rows(WrField *field, int y, int rows, const float *texels)
{
    int width = wr_field_width(field);
    for (int top = 0; top < rows; top += WR_TILE)
        for (int x = 0; x < width; x += WR_TILE) {
            int columns = width - x < WR_TILE ? width - x : WR_TILE;
            int count = rows - top < WR_TILE ? rows - top : WR_TILE;
            const float *from = texels + (size_t)top * (size_t)width + x;
            if (wr_document_all_at(from, (size_t)width, columns, count, wr_field_level(field)))
                continue;
            wr_field_write(field, x, y + top, columns, count, from, (size_t)width);
        }
}

static WrField *new_field(const Loading *in, float level, WrError *err)
{
    return wr_field_new(in->stack.width, in->stack.height, in->wrap_u, in->wrap_v, level, err);
}

/* Reads one of our float files: of the canvas' size, one channel. */
static WrField *read_field(Loading *in, const char *entry, bool heights, WrError *err)
{
    WrImage *image = read_picture(in, entry, err);
    WrField *field = NULL;
    if (!image) return NULL;
    if (image->width != in->stack.width || image->height != in->stack.height ||
        image->channels != 1 || image->type != WR_PIXEL_F32) {
        wr_fail(err, "%s: damaged: %.80s is %dx%d with %d channels; must be floats, %dx%d with 1",
                in->path, entry, image->width, image->height, image->channels, in->stack.width,
                in->stack.height);
    } else {
        if (heights) in->replaced += image->replaced;
        size_t count = (size_t)image->width * (size_t)image->height;
        for (size_t i = 0; !heights && i < count; i++) {
            float x = image->data[i];
            image->data[i] = x > 0.0f ? (x < 1.0f ? x : 1.0f) : 0.0f;
        }
        field = new_field(in, image->data[0], err);
        if (field) store_rows(field, 0, image->height, image->data);
    }
    wr_image_free(image);
    return field;
}

/* Copies row `row` of a band of the canvas from a picture at (x, y). Returns whether every texel has full
   coverage. */
static bool place_row(const Loading *in, const WrOraLayer *layer, const WrImage *image, int row,
                      float *heights, float *cover)
{
    int64_t j = (int64_t)row - layer->y;
    bool whole = true;
    for (int i = 0; i < in->stack.width; i++) {
        int64_t k = (int64_t)i - layer->x;
        heights[i] = cover[i] = 0.0f;
        if (j >= 0 && j < image->height && k >= 0 && k < image->width) {
            const float *pixel = image->data + ((size_t)j * (size_t)image->width + (size_t)k) *
                                                   (size_t)image->channels;
            cover[i] = image->channels % 2 == 0 ? pixel[image->channels - 1] : 1.0f;
            if (cover[i] > 0.0f) heights[i] = wr_image_luma(pixel, image->channels);
        }
        whole = whole && cover[i] >= 1.0f;
    }
    return whole;
}

/* Heights and coverage from a layer's PNG. */
static bool read_preview(Loading *in, const WrOraLayer *from, WrLayer *layer, WrError *err)
{
    if (!from->src) return wr_fail(err, "%s: damaged: a layer of it names no picture", in->path);
    WrImage *image = read_picture(in, from->src, err);
    if (!image) return false;
    size_t width = (size_t)in->stack.width, count = width * WR_TILE;
    float *band = wr_try_alloc(2 * count, sizeof *band, "rows of a layer", err);
    layer->heights = new_field(in, 0.0f, err);
    layer->cover = new_field(in, 0.0f, err);
    bool good = band && layer->heights && layer->cover, whole = true;
    in->replaced += image->replaced;
    for (int y = 0; good && y < in->stack.height; y += WR_TILE) {
        int rows = in->stack.height - y < WR_TILE ? in->stack.height - y : WR_TILE;
        for (int r = 0; r < rows; r++)
            whole = place_row(in, from, image, y + r, band + (size_t)r * width,
                              band + count + (size_t)r * width) &&
                    whole;
        store_rows(layer->heights, y, rows, band);
        store_rows(layer->cover, y, rows, band + count);
    }
    wr_free(band);
    wr_image_free(image);
    if (good && whole) {
        wr_field_free(layer->cover);
        layer->cover = NULL;
    }
    return good;
}

/* ---- layers ---- */

static void note(Loading *in, const char *name, const char *what)
{
    if (in->notes) wr_text_addf(in->notes, "%s: layer '%s': %s\n", in->path, name, what);
}

static int hex_digit(char c)
{
    return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/* The layer's name: from hex digits if XML cannot represent it; truncated to the documents' limit. */
static char *find_name(const WrOraLayer *from, int number)
{
    WrText text = { 0 };
    const char *hex = from->name_bytes;
    for (; hex && hex_digit(hex[0]) >= 0 && hex_digit(hex[1]) >= 0; hex += 2) {
        char byte = (char)(hex_digit(hex[0]) * 16 + hex_digit(hex[1]));
        if (byte) wr_text_add_n(&text, &byte, 1);
    }
    if (text.length == 0 && from->name) wr_text_add(&text, from->name);
    if (text.length == 0) wr_text_addf(&text, "layer %d", number);
    size_t length = text.length;
    if (length > WR_LAYER_NAME_MAX) {
        length = WR_LAYER_NAME_MAX;
        while (length > 0 && ((unsigned char)text.data[length] & 0xC0) == 0x80) length--;
    }
    char *name = wr_strndup(text.data, length);
    wr_text_fini(&text);
    return name;
}

static bool read_filter(Loading *in, const WrOraLayer *from, WrLayer *layer, WrError *err)
{
    WrError why = { "" };
    WrFilter filter;
    if (!from->filter) return true;
    if (wr_filter_parse(from->filter, &filter, &why)) layer->filter = filter;
    else if (in->newer) note(in, layer->name, "its filter is not known here: it does nothing");
    else
        return wr_fail(err, "%s: damaged: filter '%.40s' of layer '%.80s': %s", in->path,
                       from->filter, layer->name, wr_error_message(&why));
    return true;
}

/* Converts attributes to a layer's settings; the inverse of add_layer in ora_save.c. */
static bool read_settings(Loading *in, const WrOraLayer *from, WrLayer *layer, WrError *err)
{
    bool exact;
    double radius = 0.0, opacity = from->opacity;
    /* Our own attributes apply as long as the standard ones have the values that we wrote. */
    if (from->own_opacity && opacity == 1.0 &&
        (!wr_number_parse(from->own_opacity, strlen(from->own_opacity), &opacity) ||
         !(opacity >= 0.0 && opacity <= 1.0)))
        return wr_fail(err, "%s: damaged: opacity '%.40s' of layer '%.80s' must be 0..1", in->path,
                       from->own_opacity, layer->name);
    layer->opacity = (float)opacity;
    layer->visible = from->own_visible ? strcmp(from->own_visible, "on") == 0 : from->visible;
    layer->locked = from->locked;
    layer->blend = wr_ora_blend(from->operation, &exact);
    if (!exact && !from->blend)
        note(in, layer->name,
             layer->blend == WR_BLEND_SUBTRACT
                 ? "difference is read as subtract: the same where it is not above what lies below"
                 : "its blend mode is not known here: replace");
    if (from->blend) {
        int blend = wr_blend_find(from->blend);
        if (blend < 0 && in->newer)
            note(in, layer->name, "its blend mode is not known here: replace");
        else if (blend < 0)
            return wr_fail(err, "%s: damaged: blend mode '%.40s' of layer '%.80s' is not known",
                           in->path, from->blend, layer->name);
        else layer->blend = (WrBlend)blend;
    }
    if (from->radius && (!wr_number_parse(from->radius, strlen(from->radius), &radius) ||
                         radius < 0.0 || radius > 3.4028234663852886e38))
        return wr_fail(err, "%s: damaged: radius '%.40s' of layer '%.80s' must be 0 or more",
                       in->path, from->radius, layer->name);
    layer->radius = (float)radius;
    return read_filter(in, from, layer, err);
}

static bool read_layer(Loading *in, const WrOraLayer *from, int number, WrLayer *out, WrError *err)
{
    WrLayer layer = { .name = find_name(from, number) };
    bool good = read_settings(in, from, &layer, err);
    if (good && from->heights) {
        good = (layer.heights = read_field(in, from->heights, true, err)) &&
               (!from->cover || (layer.cover = read_field(in, from->cover, false, err)));
    } else if (good) {
        good = read_preview(in, from, &layer, err);
        if (good && (from->cover || from->blend))
            note(in, layer.name, "its float heights are gone; taken from its picture");
    }
    good = good && (!from->mask || (layer.mask = read_field(in, from->mask, false, err)));
    layer.on_mask = from->on_mask && layer.mask;
    if (good) *out = layer;
    else wr_layer_fini(&layer);
    return good;
}

static bool read_layers(Loading *in, WrDocument *document, WrError *err)
{
    int count = in->stack.layers.count;
    for (int i = 0; i < count; i++) { /* topmost first in the file, bottom first in the document */
        WrLayer layer;
        if (!read_layer(in, &in->stack.layers.data[count - 1 - i], i + 1, &layer, err))
            return false;
        if (i == 0) {
            wr_layer_fini(&document->layers[0]);
            document->layers[0] = layer;
        } else {
            wr_document_insert(document, i, layer);
        }
        if (in->stack.layers.data[count - 1 - i].selected) document->active = i;
    }
    return true;
}

/* ---- whole file ---- */

static bool check_type(Loading *in, WrError *err)
{
    char *bytes;
    size_t length;
    WrError ignored;
    bool good = wr_ora_zip_read(in->zip, "mimetype", 64, &bytes, &length, &ignored);
    if (good) {
        good = strncmp(bytes, type, sizeof type - 1) == 0;
        wr_free(bytes);
    }
    return good || wr_fail(err, "%s: is a zip archive, but not an OpenRaster file", in->path);
}

static bool check_stack(Loading *in, WrLoaded *loaded, WrError *err)
{
    const WrOraStack *stack = &in->stack;
    double version;
    if (stack->width < 1 || stack->width > WR_FIELD_MAX || stack->height < 1 ||
        stack->height > WR_FIELD_MAX)
        return wr_fail(err, "%s: canvas of %dx%d: each side must be 1..%d", in->path, stack->width,
                       stack->height, WR_FIELD_MAX);
    if (stack->layers.count < 1) return wr_fail(err, "%s: has no layer", in->path);
    if (stack->wrap && !wr_document_wrap_find(stack->wrap, &in->wrap_u, &in->wrap_v))
        return wr_fail(err, "%s: damaged: wrap '%.40s' must be periodic, clamp-u, clamp-v or clamp",
                       in->path, stack->wrap);
    if (!stack->version) return true;
    if (!wr_number_parse(stack->version, strlen(stack->version), &version) || version < 1.0)
        return wr_fail(err, "%s: damaged: version '%.40s'", in->path, stack->version);
    in->newer = version > WR_ORA_VERSION;
    if (in->newer) loaded->newer_version = version;
    return true;
}

static bool read_stack(Loading *in, WrError *err)
{
    char *xml;
    size_t length;
    if (!wr_ora_zip_read(in->zip, "stack.xml", STACK_MAX, &xml, &length, err)) return false;
    bool good = wr_ora_stack_read(xml, length, &in->stack, err);
    wr_free(xml);
    if (!good) wr_error_prefix(err, "%s: ", in->path);
    return good;
}

static WrImage *read_object_picture(Loading *in, const char *entry, int which, WrError *err)
{
    WrImage *image = read_picture(in, entry, err);
    if (!image || image->channels == 3) return image;
    wr_fail(err, "%s: damaged: the %s has %d channels; must be 3", in->path,
            wr_object_pictures[which].what, image->channels);
    wr_image_free(image);
    return NULL;
}

static bool read_scene(Loading *in, WrLoaded *loaded, WrError *err)
{
    size_t length;
    if (!in->stack.scene) loaded->scene_text = wr_strdup("");
    else if (!wr_ora_zip_read(in->zip, in->stack.scene, SCENE_MAX, &loaded->scene_text, &length,
                              err))
        return false;
    else if (strlen(loaded->scene_text) != length)
        return wr_fail(err, "%s: damaged: its scene is no text", in->path);
    if (in->stack.mesh && !(loaded->mesh = read_picture(in, in->stack.mesh, err))) return false;
    for (int i = 0; i < WR_OBJECTS_MAX; i++)
        for (int k = 0; k < WR_OBJECT_PICTURES; k++)
            if (in->stack.pictures[i][k] && !(loaded->pictures[i][k] = read_object_picture(
                                                  in, in->stack.pictures[i][k], k, err)))
                return false;
    return true;
}

/* The number of a layer, counted from 1; `otherwise` if there is none. */
static int layer_number(const char *text, int count, int otherwise)
{
    double value;
    if (!text || !wr_number_parse(text, strlen(text), &value) || value < 1.0 || value > count)
        return otherwise;
    return (int)value - 1;
}

static void add_notes(Loading *in)
{
    if (!in->notes) return;
    if (in->stack.groups)
        wr_text_addf(in->notes, "%s: %d groups of layers were dissolved\n", in->path,
                     in->stack.groups);
    if (in->stack.unknown)
        wr_text_addf(in->notes, "%s: %d elements that are no layers were passed over\n", in->path,
                     in->stack.unknown);
}

static bool load(Loading *in, WrLoaded *loaded, WrError *err)
{
    if (!check_type(in, err) || !read_stack(in, err) || !check_stack(in, loaded, err)) return false;
    in->pictures = count_pictures(&in->stack);
    loaded->document = wr_document_new();
    WrDocument *document = loaded->document;
    document->active = -1;
    if (!read_layers(in, document, err)) return false;
    int count = document->layer_count, chosen = document->active < 0 ? count - 1 : document->active;
    document->active = layer_number(in->stack.active, count, chosen);
    document->solo = layer_number(in->stack.solo, count, -1);
    if (in->stack.selection &&
        !(document->selection = read_field(in, in->stack.selection, false, err)))
        return false;
    if (!read_scene(in, loaded, err)) return false;
    add_notes(in);
    return true;
}

bool wr_ora_load(const char *path, WrLoaded *out, int64_t *replaced, WrText *notes, WrError *err)
{
    WrText said = { 0 };
    Loading in = { .path = path,
                   .zip = wr_ora_zip_open(path, err),
                   .wrap_u = WR_WRAP_PERIODIC,
                   .wrap_v = WR_WRAP_PERIODIC,
                   .notes = &said };
    WrLoaded loaded = { 0 };
    bool good = in.zip && load(&in, &loaded, err);
    if (good) {
        *out = loaded;
        *replaced = in.replaced;
        if (notes) wr_text_add(notes, wr_text_get(&said));
    } else {
        wr_document_free(loaded.document);
        wr_loaded_free_images(&loaded);
        wr_free(loaded.scene_text);
    }
    wr_text_fini(&said);
    wr_ora_stack_fini(&in.stack);
    wr_ora_zip_close(in.zip);
    return good;
}
