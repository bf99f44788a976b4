#include "image/gltf_internal.h"

#include "base/text.h"

#include <math.h>
#include <string.h>

#define DEPTH 64

json_object *wr_gltf_parse(const char *text, size_t length)
{
    json_tokener *tokener = json_tokener_new_ex(DEPTH);
    if (!tokener) return NULL;
    json_object *root = json_tokener_parse_ex(tokener, text, (int)length);
    if (json_tokener_get_error(tokener) != json_tokener_success) {
        json_object_put(root);
        root = NULL;
    }
    json_tokener_free(tokener);
    return root;
}

json_object *wr_gltf_member(json_object *of, const char *name, json_type kind)
{
    json_object *out;
    if (!json_object_is_type(of, json_type_object) || !json_object_object_get_ex(of, name, &out))
        return NULL;
    return json_object_is_type(out, kind) ? out : NULL;
}

json_object *wr_gltf_element(json_object *of, int index)
{
    if (!json_object_is_type(of, json_type_array) || index < 0 ||
        (size_t)index >= json_object_array_length(of))
        return NULL;
    return json_object_array_get_idx(of, (size_t)index);
}

int64_t wr_gltf_index(json_object *of, const char *name, int64_t missing)
{
    json_object *x = wr_gltf_member(of, name, json_type_int);
    const int64_t value = x ? json_object_get_int64(x) : missing;
    return value >= 0 && value <= INT32_MAX ? value : x ? -1 : missing;
}

static int digit_of(char c)
{
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

bool wr_gltf_base64(const char *text, WrText *out)
{
    unsigned word = 0;
    int bits = 0;
    const size_t digits = strcspn(text, "=");
    if (strspn(text + digits, "=") != strlen(text + digits)) return false;
    for (size_t i = 0; i < digits; i++) {
        const int digit = digit_of(text[i]);
        if (digit < 0) return false;
        word = (word << 6 | (unsigned)digit) & 0xffffffU;
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        const char byte = (char)(word >> bits & 0xff);
        wr_text_add_n(out, &byte, 1);
    }
    return true;
}

/* ---- chunks ---- */

static size_t number_at(const char *at)
{
    const unsigned char *b = (const unsigned char *)at;
    return (size_t)b[0] | (size_t)b[1] << 8 | (size_t)b[2] << 16 | (size_t)b[3] << 24;
}

/* GLB: a header of 12 bytes, then chunks of length, kind and bytes: the JSON first, the buffer second. */
const char *wr_gltf_chunks(const char *bytes, size_t length, WrGltfChunks *out)
{
    *out = (WrGltfChunks){ .json = bytes, .json_length = length };
    if (length < 4 || memcmp(bytes, "glTF", 4) != 0) return NULL;
    if (length < 20 || number_at(bytes + 4) != 2)
        return "a GLB of a version that is not 2, or cut off";
    const char *end = bytes + length, *at = bytes + 12;
    out->json_length = number_at(at);
    if (memcmp(at + 4, "JSON", 4) != 0 || out->json_length > (size_t)(end - at - 8))
        return "its first chunk is no JSON, or longer than the file";
    out->json = at + 8;
    at += 8 + out->json_length;
    if (end - at < 8 || memcmp(at + 4, "BIN\0", 4) != 0) return NULL;
    out->bin_length = number_at(at);
    if (out->bin_length > (size_t)(end - at - 8)) return "its buffer is longer than the file";
    out->bin = at + 8;
    return NULL;
}

/* ---- texture transforms ---- */

static double number_in(json_object *of, const char *name, int index, double missing)
{
    json_object *x = of, *list;
    if (!json_object_is_type(of, json_type_object) || !json_object_object_get_ex(of, name, &list))
        return missing;
    x = index < 0 ? list : wr_gltf_element(list, index);
    return json_object_is_type(x, json_type_double) || json_object_is_type(x, json_type_int)
               ? json_object_get_double(x)
               : missing;
}

/* Translation by rotation by scale, in the order of the extension's specification. */
void wr_gltf_transform(json_object *reference, double m[6])
{
    json_object *all = wr_gltf_member(reference, "extensions", json_type_object);
    json_object *moved = wr_gltf_member(all, "KHR_texture_transform", json_type_object);
    const double angle = number_in(moved, "rotation", -1, 0), c = cos(angle), s = sin(angle);
    const double x = number_in(moved, "scale", 0, 1), y = number_in(moved, "scale", 1, 1);
    m[0] = c * x, m[1] = s * y, m[2] = number_in(moved, "offset", 0, 0);
    m[3] = -s * x, m[4] = c * y, m[5] = number_in(moved, "offset", 1, 0);
}

bool wr_gltf_same_transform(json_object *a, json_object *b)
{
    double m[6], n[6];
    wr_gltf_transform(a, m);
    wr_gltf_transform(b, n);
    for (int i = 0; i < 6; i++)
        if (!(fabs(m[i] - n[i]) <= 1e-9)) return false;
    return true;
}

int64_t wr_gltf_set(json_object *reference)
{
    json_object *all = wr_gltf_member(reference, "extensions", json_type_object);
    json_object *moved = wr_gltf_member(all, "KHR_texture_transform", json_type_object);
    return wr_gltf_index(moved, "texCoord", wr_gltf_index(reference, "texCoord", 0));
}

json_object *wr_gltf_mapped(json_object *material)
{
    json_object *pbr = wr_gltf_member(material, "pbrMetallicRoughness", json_type_object);
    json_object *const found[] = {
        wr_gltf_member(material, "normalTexture", json_type_object),
        wr_gltf_member(pbr, "baseColorTexture", json_type_object),
        wr_gltf_member(pbr, "metallicRoughnessTexture", json_type_object),
    };
    for (size_t i = 0; i < sizeof found / sizeof *found; i++)
        if (found[i] && wr_gltf_set(found[i]) == 0) return found[i];
    return NULL;
}
