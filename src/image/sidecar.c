#include "image/sidecar.h"

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/image.h"
#include "image/read_internal.h"
#include "system/path.h"

#include <json-c/json.h>
#include <math.h>
#include <string.h>

#define MOST_BYTES (1 << 20) /* of a sidecar */
#define DEPTH 8

bool wr_is_raw_path(const char *path)
{
    static const char *const endings[] = { "raw", "r16", "r32" };
    char buffer[16];
    const char *ending = wr_path_ending(path, buffer);
    for (int k = 0; k < 3; k++)
        if (strcmp(ending, endings[k]) == 0) return true;
    return false;
}

void wr_sidecar_name(const char *path, WrText *name)
{
    wr_text_clear(name);
    wr_text_addf(name, "%s.json", path);
}

bool wr_sidecar_is_there(const char *path)
{
    WrText name = { 0 };
    wr_sidecar_name(path, &name);
    const bool is = wr_path_is_there(wr_text_get(&name));
    wr_text_fini(&name);
    return is;
}

/* ---- header of a sidecar ---- */

typedef enum Type { U8, U16, F16, F32, TYPES } Type;

static const struct {
    const char *name;
    int bytes;
    WrPixelType pixel;
} types[TYPES] = { { "u8", 1, WR_PIXEL_U8 },
                   { "u16", 2, WR_PIXEL_U16 },
                   { "f16", 2, WR_PIXEL_F32 },
                   { "f32", 4, WR_PIXEL_F32 } };

typedef struct Sidecar {
    const char *name; /* of the sidecar */
    json_object *root;
    int width, height, channels;
    Type type;
    bool big;
} Sidecar;

static bool parse(Sidecar *sidecar, const char *text, size_t length, WrError *err)
{
    json_tokener *tokener = json_tokener_new_ex(DEPTH);
    if (!tokener) return wr_fail(err, "%s: not enough memory", sidecar->name);
    sidecar->root = json_tokener_parse_ex(tokener, text, (int)length);
    const bool good = json_tokener_get_error(tokener) == json_tokener_success &&
                      json_object_is_type(sidecar->root, json_type_object);
    json_tokener_free(tokener);
    return good || wr_fail(err, "%s: is not the JSON of a sidecar file", sidecar->name);
}

static bool take_count(const Sidecar *sidecar, const char *name, int most, int fallback, int *out,
                       WrError *err)
{
    json_object *found;
    *out = fallback;
    const bool is = json_object_object_get_ex(sidecar->root, name, &found);
    if (!is && fallback > 0) return true;
    const int64_t value =
        is && json_object_is_type(found, json_type_int) ? json_object_get_int64(found) : 0;
    if (value < 1 || value > most)
        return wr_fail(err, "%s: %s must be a whole number, 1..%d", sidecar->name, name, most);
    *out = (int)value;
    return true;
}

/* NULL if absent. */
static const char *text_of(json_object *root, const char *name)
{
    json_object *found;
    if (!json_object_object_get_ex(root, name, &found) ||
        !json_object_is_type(found, json_type_string))
        return NULL;
    return json_object_get_string(found);
}

static bool take_type(Sidecar *sidecar, WrError *err)
{
    const char *type = text_of(sidecar->root, "type"), *endian = text_of(sidecar->root, "endian");
    int k = 0;
    while (k < TYPES && type && strcmp(type, types[k].name) != 0) k++;
    if (!type || k == TYPES)
        return wr_fail(err, "%s: type '%.40s': must be u8, u16, f16 or f32", sidecar->name,
                       type ? type : "");
    sidecar->type = (Type)k;
    sidecar->big = endian && strcmp(endian, "big") == 0;
    if (endian && !sidecar->big && strcmp(endian, "little") != 0)
        return wr_fail(err, "%s: endian '%.40s': must be little or big", sidecar->name, endian);
    return true;
}

static bool read_sidecar(Sidecar *sidecar, WrError *err)
{
    char *text;
    size_t length;
    if (!wr_file_read(sidecar->name, MOST_BYTES, &text, &length, err)) return false;
    const bool good = parse(sidecar, text, length, err) &&
                      take_count(sidecar, "width", WR_IMAGE_MAX, 0, &sidecar->width, err) &&
                      take_count(sidecar, "height", WR_IMAGE_MAX, 0, &sidecar->height, err) &&
                      take_count(sidecar, "channels", 4, 1, &sidecar->channels, err) &&
                      take_type(sidecar, err);
    wr_free(text);
    return good;
}

/* ---- the numbers ---- */

static float half_of(uint16_t code)
{
    const int power = code >> 10 & 31, rest = code & 1023;
    const double size = power == 31  ? (rest ? NAN : INFINITY)
                        : power == 0 ? ldexp(rest, -24)
                                     : ldexp(1024 + rest, power - 25);
    return (float)(code >> 15 ? -size : size);
}

static float number_of(const Sidecar *sidecar, const unsigned char *at)
{
    const int bytes = types[sidecar->type].bytes;
    uint32_t word = 0;
    for (int k = 0; k < bytes; k++) word |= (uint32_t)at[sidecar->big ? bytes - 1 - k : k] << 8 * k;
    float value;
    switch (sidecar->type) {
    case U8: return (float)word / 255.0f;
    case U16: return (float)word / 65535.0f;
    case F16: return half_of((uint16_t)word);
    default: memcpy(&value, &word, sizeof value); return value;
    }
}

static bool check_hash(const Sidecar *sidecar, const char *path, const char *bytes, size_t length,
                       WrError *err)
{
    const char *want = text_of(sidecar->root, "sha256");
    char have[65];
    if (!want) return true;
    wr_sha256_bytes(bytes, length, have);
    return strcmp(want, have) == 0 ||
           wr_fail(
               err,
               "%s: file has changed since %s was written (its sha256 differs); export both again",
               path, sidecar->name);
}

static WrImage *read_numbers(const Sidecar *sidecar, const char *path, WrError *err)
{
    const size_t count =
        (size_t)sidecar->width * (size_t)sidecar->height * (size_t)sidecar->channels;
    const size_t step = (size_t)types[sidecar->type].bytes;
    char *bytes;
    size_t length;
    if (!wr_file_read(path, count * step + 1, &bytes, &length, err)) return NULL;
    WrImage *image = NULL;
    if (length != count * step)
        wr_fail(err, "%s: has %zu bytes; %dx%d of %d channels of %s are %zu", path, length,
                sidecar->width, sidecar->height, sidecar->channels, types[sidecar->type].name,
                count * step);
    else if (check_hash(sidecar, path, bytes, length, err))
        image = wr_image_new(sidecar->width, sidecar->height, sidecar->channels, err);
    for (size_t k = 0; image && k < count; k++)
        image->data[k] = number_of(sidecar, (const unsigned char *)bytes + k * step);
    wr_free(bytes);
    if (image) image->type = types[sidecar->type].pixel;
    return image;
}

/* ---- the image ---- */

static const char *label_text(const void *from, const char *name)
{
    json_object *labels;
    const Sidecar *sidecar = from;
    if (!json_object_object_get_ex(sidecar->root, "labels", &labels) ||
        !json_object_is_type(labels, json_type_object))
        return NULL;
    return text_of(labels, name);
}

WrImageRows *wr_sidecar_rows(const char *path, const WrImageRequest *wish, WrError *err)
{
    WrText name = { 0 };
    WrImageRows *rows = NULL;
    wr_sidecar_name(path, &name);
    Sidecar sidecar = { .name = wr_text_get(&name) };
    if (!wr_path_is_there(sidecar.name)) {
        wr_fail(err,
                "%s: is a raw file, and %s with its size is missing; use `terrain elevation` with "
                "size=WxH",
                path, sidecar.name);
    } else if (read_sidecar(&sidecar, err)) {
        WrImage *image = read_numbers(&sidecar, path, err);
        if (image) wr_image_label_read(label_text, &sidecar, image->type, &image->label);
        if (image) rows = wr_image_rows_of(image, wish->keep_lost);
    }
    json_object_put(sidecar.root);
    wr_text_fini(&name);
    return rows;
}
