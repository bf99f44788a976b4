/* Documents as OpenRaster files: loading and saving. */
#include "document/ora.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "document/blend.h"
#include "document/document.h"
#include "document/variants.h"
#include "document/document_file.h"
#include "document/ora_stack.h"
#include "field/field.h"
#include "image/normal_encoding.h"
#include "image/image.h"
#include "scene/objects.h"
#include "system/fd.h"

#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

typedef struct WrError WrError;
typedef struct WrDocument WrDocument;
typedef struct WrField WrField;

typedef struct WrOraRange {
    float low, high; /* heights of black and white; low < high */
} WrOraRange;

/* Content of a layer's picture, chosen so that its composite-op, which has no heights below 0 and no scales,
   yields the greys of the layer's result. R is the range from low to high, c the coverage, m the mask. */
typedef enum WrOraShowing {
    WR_ORA_HEIGHTS, /* (h - low) / R, alpha c m */
    WR_ORA_MIXED,   /* (h - low) / R, alpha m: for a blend without coverage */
    WR_ORA_SUM,     /* alpha times grey is m h / R, so that adding adds heights */
    WR_ORA_TAKEN,   /* h / R, alpha m where the layer is not empty */
    WR_ORA_FACTOR   /* h, alpha c m */
} WrOraShowing;

/* ---- greys of heights ---- */

#define THUMBNAIL 256 /* maximum pixels along a side */

static double clamp01(double x)
{
    return x > 0.0 ? (x < 1.0 ? x : 1.0) : 0.0;
}

static double grey_of(const WrOraRange *range, float height)
{
    return clamp01(((double)height - range->low) / ((double)range->high - range->low));
}

static WrOraShowing ora_showing(WrBlend blend)
{
    switch (blend) {
    case WR_BLEND_ADD: return WR_ORA_SUM;
    case WR_BLEND_SUBTRACT: return WR_ORA_TAKEN;
    case WR_BLEND_MIX: return WR_ORA_MIXED;
    case WR_BLEND_MULTIPLY: return WR_ORA_FACTOR;
    case WR_BLEND_MAX:
    case WR_BLEND_MIN:
    case WR_BLEND_SMOOTH_MAX:
    case WR_BLEND_SMOOTH_MIN:
    case WR_BLEND_REPLACE:
    case WR_BLEND_COUNT: break;
    }
    return WR_ORA_HEIGHTS;
}

/* Grey and alpha (not premultiplied) of a texel, both 0..1. cover and mask outside 0..1 are clamped. */
static void ora_show(WrOraShowing showing, const WrOraRange *range, float height, float cover_of,
                     float mask_of, double *grey, double *alpha)
{
    double part = clamp01((double)height / ((double)range->high - range->low));
    double cover = clamp01(cover_of), mask = clamp01(mask_of);
    *grey = grey_of(range, height);
    *alpha = cover * mask;
    switch (showing) {
    case WR_ORA_HEIGHTS: break;
    case WR_ORA_MIXED: *alpha = mask; break;
    /* svg:plus adds alpha grey: with grey = part / alpha the sum gains exactly part = h / R. */
    case WR_ORA_SUM: /* alpha as large as the height needs, if the coverage is smaller */
        if (part > cover) cover = part;
        *grey = cover > 0.0 ? part / cover : 0.0;
        *alpha = cover * mask;
        break;
    case WR_ORA_TAKEN:
        *grey = part;
        *alpha = cover > 0.0 || height != 0.0f ? mask : 0.0;
        break;
    case WR_ORA_FACTOR: *grey = clamp01(height); break;
    }
}

/* Each pixel is the mean of the greys that it covers. */
static uint8_t *ora_thumbnail(const WrField *f, const WrOraRange *range, int *width, int *height,
                              WrError *err)
{
    int w = wr_field_width(f), h = wr_field_height(f), most = w > h ? w : h;
    int tw = most <= THUMBNAIL ? w : w * THUMBNAIL / most;
    int th = most <= THUMBNAIL ? h : h * THUMBNAIL / most;
    tw = tw < 1 ? 1 : tw;
    th = th < 1 ? 1 : th;
    float *row = wr_try_alloc((size_t)w, sizeof *row, "a thumbnail", err);
    if (!row) return NULL;
    uint8_t *out = wr_alloc((size_t)tw * (size_t)th, 4);
    double sums[THUMBNAIL];
    for (int y = 0; y < th; y++) {
        int top = (int)((int64_t)y * h / th), bottom = (int)((int64_t)(y + 1) * h / th);
        memset(sums, 0, sizeof sums);
        for (int j = top; j < bottom && !wr_progress_stopped(); j++) {
            wr_field_read(f, 0, j, w, 1, row, (size_t)w);
            for (int x = 0; x < tw; x++)
                for (int i = (int)((int64_t)x * w / tw); i < (int)((int64_t)(x + 1) * w / tw); i++)
                    sums[x] += grey_of(range, row[i]);
        }
        for (int x = 0; x < tw; x++) {
            int64_t columns = (int64_t)(x + 1) * w / tw - (int64_t)x * w / tw;
            double mean = sums[x] / ((double)columns * (bottom - top));
            uint8_t *pixel = out + 4 * ((size_t)y * (size_t)tw + (size_t)x);
            pixel[0] = pixel[1] = pixel[2] = (uint8_t)(255.0 * clamp01(mean) + 0.5);
            pixel[3] = 255;
        }
    }
    wr_free(row);
    *width = tw;
    *height = th;
    return out;
}

/* ---- agreement with other programs ---- */

/* Range of greys for other programs, and whether they would blend the document's layers to our composite. */

#define BAND 16 /* rows that are read at a time */

static void widen(WrOraRange *range, const WrField *field)
{
    float low, high;
    wr_field_range(field, &low, &high);
    range->low = low < range->low ? low : range->low;
    range->high = high > range->high ? high : range->high;
}

/* 0..1 as long as all heights are inside, so that imported pictures keep their codes; else wider. */
static WrOraRange ora_range(const WrDocument *document)
{
    WrOraRange range = { .low = 0.0f, .high = 1.0f };
    widen(&range, wr_document_field(document));
    for (int i = 0; i < document->layer_count; i++) widen(&range, document->layers[i].heights);
    return range;
}

/* True if all of it is <= 0, or all >= 1; NULL is 1. */
static bool is_whole(const WrField *field)
{
    if (!field) return true;
    const int width = wr_field_width(field), height = wr_field_height(field);
    const size_t row = (size_t)width;
    float *values = wr_alloc_unset(BAND * row, sizeof *values);
    bool whole = true;
    for (int y = 0; y < height && whole; y += BAND) {
        const int rows = height - y < BAND ? height - y : BAND;
        wr_field_read(field, 0, y, width, rows, values, row);
        for (size_t i = 0; i < (size_t)rows * row; i++)
            whole = whole && (values[i] <= 0.0f || values[i] >= 1.0f);
    }
    wr_free(values);
    return whole;
}

static bool is_within(const WrField *heights, float least, float most)
{
    float low, high;
    wr_field_range(heights, &low, &high);
    return low >= least && high <= most;
}

/* Programs that blend in linear light get a different mean of two greys, and a different sum. Equal on both
   scales are the maximum, the minimum, a choice of one, and, since the scale is a power, the product. A factor
   is no grey, so black must be height 0 and the factor 0..1. Example: the mean of codes a and b is (a + b) / 2, in linear
   light the code of (a^2.2 + b^2.2) / 2; max(a, b) and a b commute with the power. */
static bool layer_agrees(const WrLayer *layer, const WrOraRange *range)
{
    if (layer->opacity <= 0.0f) return true;
    if (layer->filter.op || layer->opacity < 1.0f || !is_whole(layer->mask)) return false;
    /* a factor on nothing would be a height; masks of groups are not in the file's pictures */
    if ((layer->depth > 0 || layer->is_group) && layer->blend == WR_BLEND_MULTIPLY) return false;
    if (layer->is_group && (layer->mask || !wr_blends[layer->blend].uses_cover)) return false;
    if (wr_blends[layer->blend].uses_cover && !is_whole(layer->cover)) return false;
    switch (layer->blend) {
    case WR_BLEND_MAX:
    case WR_BLEND_MIN:
    case WR_BLEND_REPLACE:
    case WR_BLEND_MIX: return true;
    case WR_BLEND_SMOOTH_MAX:
    case WR_BLEND_SMOOTH_MIN: return !(layer->radius > 0.0f);
    case WR_BLEND_MULTIPLY: return range->low == 0.0f && is_within(layer->heights, 0.0f, 1.0f);
    case WR_BLEND_ADD:
    case WR_BLEND_SUBTRACT: return is_within(layer->heights, 0.0f, 0.0f);
    case WR_BLEND_COUNT: break;
    }
    return false;
}

/* True if every program that blends the layers from `lowest` on, the lowest visible one (-1: none), gets our
   composite, on any scale of greys, as far as its operations equal ours. The layers of a group with coverage are blended by
   the same rule everywhere. */
static bool ora_agrees(const WrDocument *document, int lowest, const WrOraRange *range)
{
    if (document->solo >= 0 && document->layers[document->solo].depth > 0) return false;
    if (lowest >= 0 && document->layers[lowest].is_group) return false;
    for (int i = lowest < 0 ? document->layer_count : lowest + 1; i < document->layer_count; i++)
        if (wr_document_shows(document, i) && !layer_agrees(&document->layers[i], range))
            return false;
    return true;
}

/* ---- loading ---- */

#define STACK_MAX ((size_t)16 << 20)   /* bytes of stack.xml */
#define SCENE_MAX ((size_t)64 << 20)   /* bytes of the scene */
#define PICTURE_MAX ((size_t)2 << 30)  /* bytes of a picture */
#define PIXELS_MAX ((int64_t)16 << 28) /* total of all layers: 16 of the largest size */

/* OpenRaster: a zip archive whose first entry, "mimetype", is stored uncompressed, so that the type is found at a fixed
   offset; stack.xml with the layers, topmost first; data/NAME.png; Thumbnails/thumbnail.png; mergedimage.png. The program's own
   float tables are additional EXR entries, named by attributes of stack.xml that other programs keep or drop. */
static const char media_type[] = "image/openraster";

/* The first entry's local header, its name and content. */
bool wr_ora_recognise(const char *path)
{
    char bytes[30 + 8 + sizeof media_type - 1];
    size_t n = wr_file_peek(path, bytes, sizeof bytes);
    return n == sizeof bytes && memcmp(bytes, "PK\3\4", 4) == 0 &&
           memcmp(bytes + 30, "mimetype", 8) == 0 &&
           memcmp(bytes + 38, media_type, sizeof media_type - 1) == 0;
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
        count += !layer->is_group + (layer->cover != NULL) + (layer->mask != NULL);
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

/* Heights and coverage from a layer's PNG. The picture replaces the floats if another program has saved the file and dropped
   them: 16 bits at most remain of the heights. */
static bool read_preview(Loading *in, const WrOraLayer *from, WrLayer *layer, WrError *err)
{
    if (!from->src) return wr_fail(err, "%s: damaged: a layer has no picture", in->path);
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

/* Converts attributes to a layer's settings; the inverse of add_layer. */
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
            return wr_fail(err, "%s: damaged: unknown blend mode '%.40s' of layer '%.80s'",
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

/* Reads a hash; *hash is unchanged if there is none. */
static bool read_hash(const Loading *in, const char *name, const char *hex, const WrLayer *layer,
                      WrHash *hash, WrError *err)
{
    return !hex || wr_hash_parse(hex, hash) ||
           wr_fail(err, "%s: damaged: %s '%.40s' of layer '%.80s'", in->path, name, hex,
                   layer->name);
}

/* Reads the line of a generator layer, whose heights are read. */
static bool read_line(Loading *in, const WrOraLayer *from, WrLayer *layer, WrError *err)
{
    WrHash below = { 0, 0 };
    if (!read_hash(in, "wrinkle:below", from->below, layer, &below, err)) return false;
    wr_layer_set_line(layer, from->line, below);
    return true;
}

/* Reads the terms of a live mask, which is read. */
static bool read_mask_line(Loading *in, const WrOraLayer *from, WrLayer *layer, WrError *err)
{
    WrHash read = { 0, 0 };
    if (!read_hash(in, "wrinkle:mask-read", from->mask_read, layer, &read, err)) return false;
    wr_layer_set_mask_line(layer, from->mask_line, read);
    return true;
}

static bool read_layer(Loading *in, const WrOraLayer *from, int number, WrLayer *out, WrError *err)
{
    WrLayer layer = { .name = find_name(from, number) };
    bool good = read_settings(in, from, &layer, err);
    if (good && from->is_group) {
        layer.is_group = true;
        layer.collapsed = from->collapsed;
        good = (layer.heights = new_field(in, 0.0f, err)) != NULL;
    } else if (good && from->heights) {
        good = (layer.heights = read_field(in, from->heights, true, err)) &&
               read_line(in, from, &layer, err) &&
               (!from->cover || (layer.cover = read_field(in, from->cover, false, err)));
    } else if (good) {
        good = read_preview(in, from, &layer, err);
        if (good && (from->cover || from->blend))
            note(in, layer.name, "its float heights are gone; taken from its picture");
    }
    good = good && (!from->mask || (layer.mask = read_field(in, from->mask, false, err))) &&
           read_mask_line(in, from, &layer, err);
    layer.values = wr_strdup(from->values);
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
        document->layers[i].depth = in->stack.layers.data[count - 1 - i].depth;
        if (in->stack.layers.data[count - 1 - i].selected) document->active = i;
    }
    WrError why;
    return wr_document_check_groups(document, &why) ||
           wr_fail(err, "%s: damaged: %s", in->path, wr_error_message(&why));
}

/* ---- whole file ---- */

static bool check_type(Loading *in, WrError *err)
{
    char *bytes;
    size_t length;
    WrError ignored;
    bool good = wr_ora_zip_read(in->zip, "mimetype", 64, &bytes, &length, &ignored);
    if (good) {
        good = strncmp(bytes, media_type, sizeof media_type - 1) == 0;
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
        return wr_fail(err, "%s: damaged: its scene is not text", in->path);
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

/* Groups that are not isolated, in which a layer is not simply laid over the others: only these look different here. */
static int count_passing(const WrOraStack *stack)
{
    int count = 0;
    for (int i = 0; i < stack->layers.count; i++) {
        const WrOraLayer *group = &stack->layers.data[i];
        bool blends = false;
        for (int k = i + 1; k < stack->layers.count; k++) {
            const WrOraLayer *layer = &stack->layers.data[k];
            if (layer->depth <= group->depth) break;
            blends |= layer->operation && strcmp(layer->operation, "svg:src-over") != 0;
        }
        count += group->passes && blends;
    }
    return count;
}

static void add_notes(Loading *in)
{
    if (!in->notes) return;
    const int passing = count_passing(&in->stack);
    if (passing)
        wr_text_addf(in->notes,
                     "%s: the layers of %d groups blend with those below the group in other "
                     "programs, but only with each other here\n",
                     in->path, passing);
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
    wr_document_set_variants(document, in->stack.variants, in->stack.variant);
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

/* ---- saving ---- */

#define MERGED "mergedimage.png"
#define DOS_DATE 0x21 /* 1 January 1980: files contain no time of saving */

/* Pictures are encoded when the archive reaches them, so that only one is in memory at a time. */
typedef struct Entry {
    struct Saving *to;
    char *name; /* in the archive; owned */
    WrImageOut picture;
    const WrImage *image;                  /* a picture of the scene */
    const WrField *heights, *cover, *mask; /* source of its rows; the last two may be NULL */
    WrOraShowing showing;
    char *bytes; /* the encoded file, while it is read; owned */
    size_t length, at;
    bool known;     /* `length` is valid */
    WrHash content; /* of the file */
    bool text;      /* `bytes` are kept: they cannot be encoded again */
} Entry;

typedef struct Saving {
    const WrDocument *document;
    zip_t *archive;
    WrOraSink sink;
    WrOraRange range; /* of heights in previews */
    WR_ARRAY(Entry *) entries;
    WrText stack, scene;
    WrImage *mesh;      /* the scene's meshes, as a picture; owned; or NULL */
    bool composite;     /* there is a topmost layer with the composite for other programs */
    int lowest;         /* index of the lowest visible layer of those in no group, -1: none */
    WrField *ground;    /* that layer blended onto the empty ground, unless it is a group; owned */
    int open;           /* number of groups whose elements are open */
    int packed;         /* entries encoded so far */
    uint8_t *thumbnail; /* RGBA */
    uint8_t profile[WR_SRGB_PROFILE_SIZE];
    WrError err; /* of a picture, since the archive library cannot pass it on */
} Saving;

/* ---- pixel rows ---- */

static bool float_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)err;
    const Entry *entry = ctx;
    int width = wr_field_width(entry->heights);
    wr_field_read(entry->heights, 0, y, width, rows, out, (size_t)width);
    return true;
}

static bool image_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    const Entry *entry = ctx;
    (void)err;
    wr_image_rows_out(entry->image, entry->picture.channels, y, rows, out);
    return true;
}

/* Grey, grey, grey, alpha; not premultiplied. */
static bool preview_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    const Entry *entry = ctx;
    int width = wr_field_width(entry->heights);
    size_t pitch = (size_t)width, count = pitch * (size_t)rows;
    float *values = wr_try_alloc(3 * count, sizeof *values, "rows of a picture", err);
    if (!values) return false;
    float *cover = values + count, *mask = cover + count;
    wr_field_read(entry->heights, 0, y, width, rows, values, pitch);
    if (entry->cover) wr_field_read(entry->cover, 0, y, width, rows, cover, pitch);
    if (entry->mask) wr_field_read(entry->mask, 0, y, width, rows, mask, pitch);
    uint16_t *codes = out;
    for (size_t i = 0; i < count; i++) {
        double grey, alpha;
        ora_show(entry->showing, &entry->to->range, values[i], entry->cover ? cover[i] : 1.0f,
                 entry->mask ? mask[i] : 1.0f, &grey, &alpha);
        codes[4 * i] = codes[4 * i + 1] = codes[4 * i + 2] = (uint16_t)(65535.0 * grey + 0.5);
        codes[4 * i + 3] = (uint16_t)(65535.0 * alpha + 0.5);
    }
    wr_free(values);
    return true;
}

static bool thumbnail_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)err;
    const Entry *entry = ctx;
    size_t row = (size_t)entry->picture.width * 4;
    memcpy(out, entry->to->thumbnail + (size_t)y * row, (size_t)rows * row);
    return true;
}

/* ---- the archive ---- */

/* libzip requests an entry's size before its bytes, and may read sizes of several entries first. The encoded bytes are freed
   after each entry, so a picture may be encoded twice; holding all encoded pictures would need as much memory as the file. */
static bool render(Entry *entry)
{
    if (entry->bytes) return true;
    Saving *to = entry->to;
    WrProgressPart part;
    double all = to->entries.count, from = entry->known ? to->packed / all : to->packed++ / all;
    const WrProgress *whole = wr_progress_enter(&part, from, from + 1.0 / all);
    bool good =
        wr_image_write_bytes(entry->name, &entry->picture, &entry->bytes, &entry->length, &to->err);
    wr_progress_set(whole);
    if (!good) return false;
    entry->known = true;
    entry->content = wr_hash_bytes(entry->bytes, entry->length, (WrHash){ 0 });
    return true;
}

static zip_int64_t answer_error(void *data, zip_uint64_t length)
{
    int codes[2] = { ZIP_ER_INTERNAL, 0 };
    if (length < sizeof codes) return -1;
    memcpy(data, codes, sizeof codes);
    return sizeof codes;
}

/* Callback of the archive library for a picture. */
static zip_int64_t on_source(void *ctx, void *data, zip_uint64_t length, zip_source_cmd_t command)
{
    Entry *entry = ctx;
    if (command == ZIP_SOURCE_SUPPORTS)
        return zip_source_make_command_bitmap(ZIP_SOURCE_OPEN, ZIP_SOURCE_READ, ZIP_SOURCE_CLOSE,
                                              ZIP_SOURCE_STAT, ZIP_SOURCE_ERROR, ZIP_SOURCE_FREE,
                                              -1);
    if (command == ZIP_SOURCE_ERROR) return answer_error(data, length);
    if (command == ZIP_SOURCE_STAT) {
        if (!entry->known && !render(entry)) return -1;
        zip_stat_t *report = data;
        zip_stat_init(report);
        report->size = entry->length;
        report->valid = ZIP_STAT_SIZE;
        return sizeof *report;
    }
    if (command == ZIP_SOURCE_OPEN) {
        entry->at = 0;
        return render(entry) ? 0 : -1;
    }
    if (command == ZIP_SOURCE_READ) {
        if (wr_progress_stopped()) return -1;
        size_t left = entry->length - entry->at, take = left < length ? left : (size_t)length;
        memcpy(data, entry->bytes + entry->at, take);
        entry->at += take;
        return (zip_int64_t)take;
    }
    if (command == ZIP_SOURCE_CLOSE && !entry->text) {
        wr_free(entry->bytes);
        entry->bytes = NULL;
    }
    return 0;
}

/* All entries are stored: the pictures are already compressed, and the first entry must be stored. */
static bool add_source(Saving *to, const char *name, zip_source_t *source, WrError *err)
{
    zip_int64_t index = source ? zip_file_add(to->archive, name, source, ZIP_FL_ENC_UTF_8) : -1;
    if (index < 0 && source) zip_source_free(source);
    if (index < 0 ||
        zip_set_file_compression(to->archive, (zip_uint64_t)index, ZIP_CM_STORE, 0) != 0 ||
        zip_file_set_dostime(to->archive, (zip_uint64_t)index, 0, DOS_DATE, 0) != 0)
        return wr_fail(err, "%s", zip_strerror(to->archive));
    return true;
}

static bool add_entry(Saving *to, Entry made, WrError *err)
{
    Entry *entry = wr_alloc(1, sizeof *entry);
    *entry = made;
    entry->to = to;
    entry->picture.ctx = entry;
    wr_array_push(&to->entries, entry);
    zip_error_t trouble;
    zip_error_init(&trouble);
    zip_source_t *source = zip_source_function_create(on_source, entry, &trouble);
    zip_error_fini(&trouble);
    return add_source(to, entry->name, source, err);
}

/* Adds bytes that are already encoded; they are copied. */
static bool add_text(Saving *to, const char *name, const char *text, size_t length, WrError *err)
{
    Entry entry = { .name = wr_strdup(name),
                    .bytes = wr_strndup(text, length),
                    .length = length,
                    .known = true,
                    .text = true,
                    .content = wr_hash_bytes(text, length, (WrHash){ 0 }) };
    return add_entry(to, entry, err);
}

/* Adds a float picture; owns the name afterwards. */
static bool add_floats(Saving *to, char *name, const WrField *field, WrError *err)
{
    Entry entry = { .name = name,
                    .heights = field,
                    .picture = { .width = wr_field_width(field),
                                 .height = wr_field_height(field),
                                 .channels = 1,
                                 .type = WR_PIXEL_F32,
                                 .data = true,
                                 .rows = float_rows } };
    return add_entry(to, entry, err);
}

/* Adds a picture for other programs, of heights alone or as a layer. Some programs ask for the profile of each
   16-bit layer without one. */
static bool add_preview(Saving *to, Entry entry, WrError *err)
{
    entry.picture = (WrImageOut){ .width = wr_field_width(entry.heights),
                                  .height = wr_field_height(entry.heights),
                                  .channels = 4,
                                  .type = WR_PIXEL_U16,
                                  .profile = to->profile,
                                  .profile_size = sizeof to->profile,
                                  .rows = preview_rows };
    return add_entry(to, entry, err);
}

/* Adds the picture of a layer. The lowest visible one is opaque and already combined with the ground: other
   programs have no ground of heights 0, and some do not show a layer that adds to nothing. */
static bool add_layer_preview(Saving *to, char *name, int index, WrError *err)
{
    const WrLayer *layer = &to->document->layers[index];
    if (index == to->lowest)
        return add_preview(to, (Entry){ .name = name, .heights = to->ground }, err);
    return add_preview(
        to,
        (Entry){ .name = name,
                 .heights = layer->heights,
                 .cover = layer->filter.op ? layer->heights : layer->cover,
                 .mask = layer->mask,
                 .showing = layer->filter.op ? WR_ORA_HEIGHTS : ora_showing(layer->blend) },
        err);
}

static bool add_image(Saving *to, const WrImage *image, char *name, const char *attribute,
                      int channels, WrError *err)
{
    Entry entry = { .name = name,
                    .image = image,
                    .picture = { .width = image->width,
                                 .height = image->height,
                                 .channels = channels,
                                 .type = WR_PIXEL_F32,
                                 .rows = image_rows } };
    wr_ora_add_attribute(&to->stack, attribute, entry.name);
    return add_entry(to, entry, err);
}

/* ---- contents ---- */

static char *numbered(const char *before, int number, const char *after)
{
    WrText text = { 0 };
    wr_text_addf(&text, "%s%d%s", before, number, after);
    return text.data;
}

/* The pictures of the scene's objects, and its mesh. */
static bool add_scene_images(Saving *to, const WrScene *scene, WrError *err)
{
    if (!wr_scene_meshes_to_image(scene, &to->mesh, err)) return false;
    for (int i = 0; i < wr_scene_object_count(scene) * WR_OBJECT_PICTURES; i++) {
        const int of = i / WR_OBJECT_PICTURES, which = i % WR_OBJECT_PICTURES;
        const WrImage *picture = wr_object_picture(scene, of, which);
        char entry[WR_ORA_PICTURE_NAME], name[WR_ORA_PICTURE_NAME];
        wr_ora_picture_name("data/", of, which, ".exr", entry);
        wr_ora_picture_name("wrinkle:", of, which, "", name);
        if (picture && !add_image(to, picture, wr_strdup(entry), name, 3, err)) return false;
    }
    return !to->mesh || add_image(to, to->mesh, wr_strdup("data/mesh.exr"), "wrinkle:mesh", 1, err);
}

/* Finds the lowest visible layer, and blends it onto the ground. */
static void find_ground(Saving *to)
{
    const WrDocument *document = to->document;
    to->lowest = -1;
    for (int i = document->layer_count - 1; i >= 0; i--)
        if (document->layers[i].depth == 0 && wr_document_shows(document, i)) to->lowest = i;
    if (to->lowest < 0 || document->layers[to->lowest].is_group) return;
    WrDocument *alone = wr_document_snapshot(document);
    alone->solo = to->lowest;
    to->ground = wr_field_share(wr_document_field(alone));
    wr_document_free(alone);
}

static bool add_field(Saving *to, const char *attribute, char *name, const WrField *f, WrError *err)
{
    wr_ora_add_attribute(&to->stack, attribute, name);
    return add_floats(to, name, f, err);
}

/* True if the element itself is visible: in a hidden group it may be. */
static bool is_shown(const WrDocument *document, int index)
{
    const int solo = document->solo;
    if (solo < 0 || wr_document_is_within(document, index, solo))
        return document->layers[index].visible;
    return index == solo || wr_document_is_within(document, solo, index);
}

/* Attributes for other programs, and our own if the values differ. */
static void add_looks(Saving *to, int index)
{
    const WrLayer *layer = &to->document->layers[index];
    WrText *xml = &to->stack;
    bool lowest = index == to->lowest && !layer->is_group, shown = is_shown(to->document, index);
    wr_ora_add_float(xml, "opacity", lowest ? 1.0f : layer->opacity);
    if (lowest && layer->opacity != 1.0f) wr_ora_add_float(xml, "wrinkle:opacity", layer->opacity);
    wr_ora_add_attribute(xml, "visibility", shown ? "visible" : "hidden");
    if (shown != layer->visible)
        wr_ora_add_attribute(xml, "wrinkle:visible", layer->visible ? "on" : "off");
    wr_ora_add_attribute(xml, "composite-op",
                         lowest ? wr_ora_operation(WR_BLEND_REPLACE)
                                : wr_ora_operation(layer->blend));
}

static void add_hash(WrText *xml, const char *name, WrHash hash)
{
    char hex[WR_HASH_DIGITS + 1];
    wr_hash_print(hash, hex);
    wr_ora_add_attribute(xml, name, hex);
}

/* Converts a layer's settings to attributes; the inverse of read_settings. */
static void add_settings(Saving *to, int index)
{
    const WrLayer *layer = &to->document->layers[index];
    WrText *xml = &to->stack;
    add_looks(to, index);
    if (layer->locked) wr_ora_add_attribute(xml, "edit-locked", "true");
    if (index == to->document->active) wr_ora_add_attribute(xml, "selected", "true");
    if (layer->on_mask) wr_ora_add_attribute(xml, "wrinkle:on-mask", "on");
    wr_ora_add_attribute(xml, "wrinkle:blend", wr_blends[layer->blend].name);
    wr_ora_add_float(xml, "wrinkle:radius", layer->radius);
    wr_ora_add_filter(xml, &layer->filter);
    if (layer->line) {
        wr_ora_add_attribute(xml, "wrinkle:line", layer->line);
        add_hash(xml, "wrinkle:below", layer->below);
    }
    if (layer->mask_line) {
        wr_ora_add_attribute(xml, "wrinkle:mask-line", layer->mask_line);
        add_hash(xml, "wrinkle:mask-read", layer->mask_read);
    }
    if (layer->values) wr_ora_add_attribute(xml, "wrinkle:values", layer->values);
}

static void indent(WrText *xml, int depth)
{
    for (int i = 0; i < depth + 2; i++) wr_text_add(xml, "  ");
}

/* Closes the elements of groups down to that depth. */
static void close_groups(Saving *to, int depth)
{
    while (to->open > depth) {
        indent(&to->stack, --to->open);
        wr_text_add(&to->stack, "</stack>\n");
    }
}

static bool add_mask(Saving *to, int index, WrError *err)
{
    const WrField *mask = to->document->layers[index].mask;
    return !mask ||
           add_field(to, "wrinkle:mask", numbered("data/mask", index + 1, ".exr"), mask, err);
}

/* Opens the element of a group. */
static bool begin_group(Saving *to, int index, WrError *err)
{
    const WrLayer *group = &to->document->layers[index];
    wr_text_add(&to->stack, "<stack");
    wr_ora_add_name(&to->stack, group->name);
    wr_ora_add_attribute(&to->stack, "isolation", "isolate");
    add_settings(to, index);
    if (group->collapsed) wr_ora_add_attribute(&to->stack, "wrinkle:collapsed", "on");
    const bool good = add_mask(to, index, err);
    wr_text_add(&to->stack, ">\n");
    to->open++;
    return good;
}

static bool add_layer(Saving *to, int index, WrError *err)
{
    const WrLayer *layer = &to->document->layers[index];
    WrText *xml = &to->stack;
    int number = index + 1;
    close_groups(to, layer->depth);
    indent(xml, layer->depth);
    if (layer->is_group) return begin_group(to, index, err);
    char *png = numbered("data/layer", number, ".png");
    wr_text_add(xml, "<layer");
    wr_ora_add_name(xml, layer->name);
    wr_ora_add_attribute(xml, "src", png);
    wr_text_add(xml, " x=\"0\" y=\"0\"");
    add_settings(to, index);
    bool good =
        add_layer_preview(to, png, index, err) &&
        add_field(to, "wrinkle:heights", numbered("data/layer", number, ".exr"), layer->heights,
                  err) &&
        (!layer->cover || add_field(to, "wrinkle:cover", numbered("data/cover", number, ".exr"),
                                    layer->cover, err)) &&
        add_mask(to, index, err);
    wr_text_add(xml, "/>\n");
    return good;
}

static bool add_image_attributes(Saving *to, WrError *err)
{
    const WrDocument *document = to->document;
    const WrField *f = document->layers[0].heights;
    char low[WR_NUMBER_SIZE], high[WR_NUMBER_SIZE];
    wr_text_addf(&to->stack,
                 "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<image version=\"0.0.5\" w=\"%d\" "
                 "h=\"%d\" xmlns:wrinkle=\"" WR_ORA_NAMESPACE "\" wrinkle:version=\"%d\" "
                 "wrinkle:wrap=\"%s\" wrinkle:range=\"%s,%s\" wrinkle:active=\"%d\" "
                 "wrinkle:solo=\"%d\" wrinkle:scene=\"data/scene.wrinkle\"",
                 wr_field_width(f), wr_field_height(f), wr_ora_version(document, to->composite),
                 wr_document_wrap_word(wr_field_wrap_u(f), wr_field_wrap_v(f)),
                 wr_number_print_float(to->range.low, low),
                 wr_number_print_float(to->range.high, high), document->active + 1,
                 document->solo + 1);
    if (document->variants)
        wr_ora_add_attribute(&to->stack, "wrinkle:variants", document->variants);
    if (document->variant) wr_ora_add_attribute(&to->stack, "wrinkle:variant", document->variant);
    if (document->selection && !add_field(to, "wrinkle:selection", wr_strdup("data/selection.exr"),
                                          document->selection, err))
        return false;
    if (!add_scene_images(to, document->scene, err)) return false;
    wr_text_add(&to->stack, ">\n  <stack>\n");
    return true;
}

static bool add_pictures_of_all(Saving *to, WrError *err)
{
    const WrField *f = wr_document_field(to->document);
    Entry thumbnail = { .name = wr_strdup("Thumbnails/thumbnail.png"),
                        .picture = { .channels = 4, .type = WR_PIXEL_U8, .rows = thumbnail_rows } };
    to->thumbnail =
        ora_thumbnail(f, &to->range, &thumbnail.picture.width, &thumbnail.picture.height, err);
    if (!to->thumbnail) {
        wr_free(thumbnail.name);
        return false;
    }
    return add_preview(to, (Entry){ .name = wr_strdup(MERGED), .heights = f }, err) &&
           add_entry(to, thumbnail, err);
}

#define COMPOSITE                                                                                  \
    "    <layer name=\"Composite (hide it to edit the layers below)\" src=\"" MERGED               \
    "\" x=\"0\" y=\"0\" opacity=\"1\" visibility=\"visible\" composite-op=\"svg:src-over\" "       \
    "edit-locked=\"true\" wrinkle:composite=\"on\"/>\n"

static bool fill_archive(Saving *to, WrError *err)
{
    wr_srgb_profile(to->profile);
    wr_filters_forget();
    find_ground(to);
    to->range = ora_range(to->document);
    to->composite = !ora_agrees(to->document, to->lowest, &to->range);
    if (!wr_filters_carried(err)) return false;
    if (!add_text(to, "mimetype", media_type, sizeof media_type - 1, err) ||
        !add_image_attributes(to, err))
        return false;
    if (to->composite) wr_text_add(&to->stack, COMPOSITE);
    for (int i = to->document->layer_count - 1; i >= 0; i--)
        if (!add_layer(to, i, err)) return false;
    close_groups(to, 0);
    wr_text_add(&to->stack, "  </stack>\n</image>\n");
    return add_text(to, "stack.xml", to->stack.data, to->stack.length, err) &&
           add_text(to, "data/scene.wrinkle", wr_text_get(&to->scene), to->scene.length, err) &&
           add_pictures_of_all(to, err);
}

static bool write_archive(Saving *to, WrFileTarget *target, WrError *err)
{
    to->sink = (WrOraSink){ .to = wr_file_sink(target) };
    to->archive = wr_ora_sink_open(&to->sink, err);
    if (!to->archive) return false;
    char why[WR_FILE_WHY];
    bool good = fill_archive(to, err);
    if (good && zip_close(to->archive) != 0)
        good = wr_fail(err, "%s",
                       to->err.text[0]  ? wr_error_message(&to->err)
                       : to->sink.error ? wr_file_why(to->sink.error, why)
                                        : zip_strerror(to->archive));
    else if (good) to->archive = NULL;
    if (to->archive) zip_discard(to->archive);
    return good;
}

/* Verifies that every file in the archive has the written content; the pictures were verified when they were
   encoded. */
static bool verify_archive(const Saving *to, const char *name, int fd, WrError *err)
{
    int again = wr_fd_reopen(fd);
    if (again < 0) return wr_fail(err, "%s", strerror(errno));
    WrOraZip *zip = wr_ora_zip_take(name, again, err);
    bool good = zip != NULL;
    for (int i = 0; i < to->entries.count && good; i++) {
        const Entry *entry = to->entries.data[i];
        char *bytes;
        size_t length;
        good = wr_ora_zip_read(zip, entry->name, entry->length, &bytes, &length, err);
        if (!good) break;
        if (length != entry->length ||
            !wr_hash_equal(wr_hash_bytes(bytes, length, (WrHash){ 0 }), entry->content))
            good = wr_fail(err, "%s in it does not read back as it was written", entry->name);
        wr_free(bytes);
    }
    wr_ora_zip_close(zip);
    return good;
}

bool wr_ora_save(const WrDocument *document, const char *scene_text, const char *path, WrText *note,
                 WrError *err)
{
    WrFileTarget target;
    if (!wr_file_begin(&target, path, err)) return false;
    Saving *to = wr_alloc(1, sizeof *to);
    to->document = document;
    wr_text_add(&to->scene, scene_text);
    bool good = write_archive(to, &target, err) && verify_archive(to, path, target.fd, err);
    if (good && wr_progress_stopped()) good = wr_fail(err, "cancelled");
    if (!good) wr_error_prefix(err, "%s: cannot be written: ", path);
    for (int i = 0; i < to->entries.count; i++) {
        wr_free(to->entries.data[i]->name);
        wr_free(to->entries.data[i]->bytes);
        wr_free(to->entries.data[i]);
    }
    wr_array_free(&to->entries);
    wr_text_fini(&to->stack);
    wr_text_fini(&to->scene);
    wr_field_free(to->ground);
    wr_free(to->thumbnail);
    wr_image_free(to->mesh);
    const bool tells = to->composite && note;
    wr_free(to);
    if (good) {
        good = wr_file_commit(&target, err);
        if (good && tells)
            wr_text_addf(note,
                         "%s: other programs blend some of these layers differently: a topmost "
                         "layer shows them the composite; hide it there to edit the others",
                         path);
        return good;
    }
    wr_file_abort(&target);
    return false;
}
