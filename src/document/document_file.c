#include "document/document_file.h"

#include "base/memory.h"

#include <fcntl.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

#ifndef WR_VERSION
#define WR_VERSION "0"
#endif

#define LAYER_PREFIX "layer:"
#define LAYERS_MAX (WR_IMAGE_PARTS_MAX - 2)

static const struct {
    const char *word;
    WrWrap u, v;
} wraps[] = { { "periodic", WR_WRAP_PERIODIC, WR_WRAP_PERIODIC },
              { "clamp-u", WR_WRAP_CLAMP, WR_WRAP_PERIODIC },
              { "clamp-v", WR_WRAP_PERIODIC, WR_WRAP_CLAMP },
              { "clamp", WR_WRAP_CLAMP, WR_WRAP_CLAMP } };
#define WRAP_COUNT (int)(sizeof wraps / sizeof *wraps)

const char *wr_document_wrap_word(WrWrap wrap_u, WrWrap wrap_v)
{
    int i = 0;
    while (wraps[i].u != wrap_u || wraps[i].v != wrap_v) i++;
    return wraps[i].word;
}

/* ---- saving ---- */

static bool field_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)err;
    const WrField *field = ctx;
    int width = wr_field_width(field);
    wr_field_read(field, 0, y, width, rows, out, (size_t)width);
    return true;
}

static bool colour_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)err;
    const WrImage *image = ctx;
    size_t first = (size_t)y * (size_t)image->width, count = (size_t)rows * (size_t)image->width;
    int step = image->channels;
    float *rgb = out;
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++)
            rgb[3 * i + (size_t)c] =
                image->data[(first + i) * (size_t)step + (size_t)(step < 3 ? 0 : c)];
    return true;
}

static WrImageOut field_part(const WrField *field, const char *name)
{
    return (WrImageOut){ .width = wr_field_width(field),
                         .height = wr_field_height(field),
                         .channels = 1,
                         .type = WR_PIXEL_F32,
                         .part_name = name,
                         .data = true,
                         .rows = field_rows,
                         .ctx = (void *)field };
}

/* Part names must differ, layers' names need not: "layer:NAME", then "layer:NAME (2)" and so on. The
 * attribute wrinkle:layer holds the name itself. Caller frees. */
static char *part_name(const WrDocument *document, int layer)
{
    const char *name = document->layers[layer].name;
    int same = 1;
    for (int i = 0; i < layer; i++) same += strcmp(document->layers[i].name, name) == 0;
    WrText text = { 0 };
    wr_text_addf(&text, LAYER_PREFIX "%s", name);
    if (same > 1) wr_text_addf(&text, " (%d)", same);
    return text.data;
}

static bool check_document(const WrDocument *document, const char *path, WrError *err)
{
    int count = document->layer_count;
    if (count > LAYERS_MAX)
        return wr_fail(err, "%s: %d layers: a document file holds up to %d", path, count,
                       LAYERS_MAX);
    WrImage *colour = document->scene->colour;
    if (colour && (colour->width > WR_IMAGE_MAX || colour->height > WR_IMAGE_MAX))
        return wr_fail(err, "%s: the colour picture is %dx%d: each side must be 1..%d", path,
                       colour->width, colour->height, WR_IMAGE_MAX);
    return true;
}

static void print_range(const WrField *field, WrText *text)
{
    float low, high;
    wr_field_range(field, &low, &high);
    char buffer[WR_NUMBER_SIZE];
    wr_text_addf(text, "%s,", wr_number_print_float(low, buffer));
    wr_text_add(text, wr_number_print_float(high, buffer));
}

bool wr_document_save(const WrDocument *document, const char *scene_text, const char *path,
                      WrError *err)
{
    if (!check_document(document, path, err)) return false;
    int layers = document->layer_count, count = 1 + layers;
    const WrField *f = wr_document_field(document);
    WrImageOut *parts = wr_alloc((size_t)count + 1, sizeof *parts);
    WrImageAttribute *names = wr_alloc((size_t)layers, sizeof *names);
    char **part_names = wr_alloc((size_t)layers, sizeof *part_names);
    WrText range = { 0 }, version = { 0 };
    print_range(f, &range);
    wr_text_addf(&version, "%d", WR_DOCUMENT_VERSION);
    WrImageAttribute attributes[] = {
        { "wrinkle:version", version.data },
        { "wrinkle:program", "Wrinkle " WR_VERSION },
        { "wrinkle:scene", scene_text },
        { "wrinkle:wrap", wr_document_wrap_word(wr_field_wrap_u(f), wr_field_wrap_v(f)) },
        { "wrinkle:zero", "0" },
        { "wrinkle:range", range.data },
    };
    parts[0] = field_part(f, "F");
    parts[0].attributes = attributes;
    parts[0].attribute_count = sizeof attributes / sizeof *attributes;
    for (int i = 0; i < layers; i++) {
        part_names[i] = part_name(document, i);
        names[i] = (WrImageAttribute){ "wrinkle:layer", document->layers[i].name };
        parts[1 + i] = field_part(document->layers[i].field, part_names[i]);
        parts[1 + i].attributes = &names[i];
        parts[1 + i].attribute_count = 1;
    }
    WrImage *colour = document->scene->colour;
    if (colour)
        parts[count++] = (WrImageOut){ .width = colour->width,
                                       .height = colour->height,
                                       .channels = 3,
                                       .type = WR_PIXEL_F32,
                                       .part_name = "colour",
                                       .rows = colour_rows,
                                       .ctx = colour };
    bool ok = wr_image_write(path, parts, count, err);
    for (int i = 0; i < layers; i++) wr_free(part_names[i]);
    wr_free(part_names);
    wr_free(names);
    wr_free(parts);
    wr_text_fini(&range);
    wr_text_fini(&version);
    return ok;
}

/* ---- loading ---- */

/* Never waits on a pipe, and does not wake the picture library for what is no EXR file. */
static bool has_exr_magic(const char *path)
{
    static const unsigned char magic[4] = { 0x76, 0x2f, 0x31, 0x01 };
    unsigned char bytes[4] = { 0 };
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0) return false;
    bool exr = read(fd, bytes, sizeof bytes) == (ssize_t)sizeof bytes &&
               memcmp(bytes, magic, sizeof magic) == 0;
    close(fd);
    return exr;
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

typedef struct Loading {
    const char *path;
    WrImageFile *file;
    int width, height;
    WrWrap wrap_u, wrap_v;
    int64_t replaced;
} Loading;

static bool check_version(const Loading *in, WrError *err)
{
    const char *text = wr_image_file_attribute(in->file, 0, "wrinkle:version");
    if (!text) return wr_fail(err, "%s: is not a Wrinkle document", in->path);
    double version;
    if (!wr_number_parse(text, strlen(text), &version) || version < 1 || floor(version) != version)
        return wr_fail(err, "%s: damaged: document version '%.40s'", in->path, text);
    if (version > WR_DOCUMENT_VERSION)
        return wr_fail(err,
                       "%s: was saved by a newer version of the program (document version %.40s; "
                       "this one reads up to %d)",
                       in->path, text, WR_DOCUMENT_VERSION);
    return true;
}

static bool read_wrap(Loading *in, WrError *err)
{
    const char *word = wr_image_file_attribute(in->file, 0, "wrinkle:wrap");
    for (int i = 0; word && i < WRAP_COUNT; i++) {
        if (strcmp(word, wraps[i].word) != 0) continue;
        in->wrap_u = wraps[i].u;
        in->wrap_v = wraps[i].v;
        return true;
    }
    return wr_fail(err, "%s: damaged: wrap '%.40s' must be periodic, clamp-u, clamp-v or clamp",
                   in->path, word ? word : "");
}

static bool begins_with(const char *text, const char *start)
{
    return strncmp(text, start, strlen(start)) == 0;
}

/* One layer at least, all of F's size, then perhaps a colour picture, and nothing else. */
static bool check_parts(Loading *in, int *layers, bool *colour, WrError *err)
{
    int count = wr_image_file_parts(in->file);
    WrImagePart f = wr_image_file_part(in->file, 0);
    in->width = f.width;
    in->height = f.height;
    *layers = 0;
    *colour = false;
    for (int i = 1; i < count; i++) {
        WrImagePart part = wr_image_file_part(in->file, i);
        bool layer = begins_with(part.name, LAYER_PREFIX);
        if (!layer && (strcmp(part.name, "colour") != 0 || i != count - 1))
            return wr_fail(err, "%s: damaged: part '%.60s' has no place in a document", in->path,
                           part.name);
        if (layer && (part.width != f.width || part.height != f.height || part.channels != 1))
            return wr_fail(
                err, "%s: damaged: part '%.60s' is %dx%d with %d channels; F is %dx%d with 1",
                in->path, part.name, part.width, part.height, part.channels, f.width, f.height);
        if (!layer && part.channels != 3)
            return wr_fail(err, "%s: damaged: the colour picture has %d channels; must be 3",
                           in->path, part.channels);
        *layers += layer;
        *colour |= !layer;
    }
    if (*layers == 0) return wr_fail(err, "%s: damaged: has no layer", in->path);
    return true;
}

static bool all_equal(const float *texels, size_t pitch, int columns, int rows, float level)
{
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < columns; x++)
            if (memcmp(&texels[(size_t)y * pitch + (size_t)x], &level, sizeof level) != 0)
                return false;
    return true;
}

/* A strip of one row of tiles. Tiles that are all at the table's level stay unallocated, so that an
 * almost empty table is as small as it was when it was saved. */
static void store_strip(Loading *in, WrField *field, int y, int rows, const float *strip)
{
    for (int x = 0; x < in->width; x += WR_TILE) {
        int columns = in->width - x < WR_TILE ? in->width - x : WR_TILE;
        if (all_equal(strip + x, (size_t)in->width, columns, rows, wr_field_level(field))) continue;
        in->replaced += wr_field_write(field, x, y, columns, rows, strip + x, (size_t)in->width);
    }
}

static WrField *read_layer(Loading *in, int part, WrError *err)
{
    WrField *field = NULL;
    float *strip = wr_try_alloc((size_t)in->width * WR_TILE, sizeof *strip, "rows of a layer", err);
    for (int y = 0; strip && y < in->height; y += WR_TILE) {
        int rows = in->height - y < WR_TILE ? in->height - y : WR_TILE;
        if (!wr_image_file_read_rows(in->file, part, y, rows, strip, err)) goto fail;
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

static WrImage *read_colour(Loading *in, int part, WrError *err)
{
    WrImagePart is = wr_image_file_part(in->file, part);
    WrImage *image = wr_image_new(is.width, is.height, 3, err);
    if (!image) return NULL;
    if (!wr_image_file_read(in->file, part, image->data, err)) {
        wr_image_free(image);
        return NULL;
    }
    size_t count = (size_t)is.width * (size_t)is.height * 3;
    image->replaced = wr_image_codes(WR_PIXEL_F32, image->data, count, image->data, NULL);
    return image;
}

/* The layers replace the new document's one. */
static bool read_layers(Loading *in, WrDocument *document, int layers, WrError *err)
{
    wr_free(document->layers[0].name);
    wr_field_free(document->layers[0].field);
    wr_free(document->layers);
    document->layers = wr_alloc((size_t)layers, sizeof *document->layers);
    document->layer_count = 0;
    for (int i = 0; i < layers; i++) {
        const char *name = wr_image_file_attribute(in->file, 1 + i, "wrinkle:layer");
        if (!name) name = wr_image_file_part(in->file, 1 + i).name + strlen(LAYER_PREFIX);
        WrField *field = read_layer(in, 1 + i, err);
        if (!field) return false;
        document->layers[i] = (WrLayer){ wr_strdup(name), field };
        document->layer_count++;
    }
    return true;
}

bool wr_document_load(const char *path, WrLoaded *out, int64_t *replaced, WrError *err)
{
    Loading in = { .path = path, .file = wr_image_file_open(path, err) };
    if (!in.file) return false;
    WrLoaded loaded = { 0 };
    int layers;
    bool colour;
    if (!check_version(&in, err) || !read_wrap(&in, err) ||
        !check_parts(&in, &layers, &colour, err))
        goto fail;
    loaded.document = wr_document_new();
    if (!read_layers(&in, loaded.document, layers, err)) goto fail;
    if (colour && !(loaded.colour = read_colour(&in, 1 + layers, err))) goto fail;
    const char *scene = wr_image_file_attribute(in.file, 0, "wrinkle:scene");
    loaded.scene_text = wr_strdup(scene ? scene : "");
    wr_image_file_close(in.file);
    *out = loaded;
    *replaced = in.replaced;
    return true;
fail:
    wr_document_free(loaded.document);
    wr_image_file_close(in.file);
    return false;
}
