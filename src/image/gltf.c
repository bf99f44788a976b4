#include "image/gltf.h"
#include "image/gltf_internal.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/mesh.h"

#include <string.h>

/* Buffer i's uri, or NULL if it has none or contains its own bytes. */
static const char *part_of(json_object *buffers, size_t i, json_object **buffer)
{
    json_object *uri;
    *buffer = json_object_array_get_idx(buffers, i);
    if (!json_object_is_type(*buffer, json_type_object) ||
        !json_object_object_get_ex(*buffer, "uri", &uri) ||
        !json_object_is_type(uri, json_type_string))
        return NULL;
    const char *text = json_object_get_string(uri);
    return strncmp(text, "data:", 5) == 0 ? NULL : text;
}

/* ---- names ---- */

static int hex_digit(char c)
{
    static const char digits[] = "0123456789abcdef";
    const char *at = c ? strchr(digits, c >= 'A' && c <= 'F' ? c + ('a' - 'A') : c) : NULL;
    return at ? (int)(at - digits) : -1;
}

bool wr_gltf_decode_name(const char *uri, WrText *name)
{
    for (const char *c = uri; *c; c++) {
        const int high = *c == '%' ? hex_digit(c[1]) : -1;
        const int low = high < 0 ? -1 : hex_digit(c[2]);
        const char byte = low < 0 ? *c : (char)(16 * high + low);
        if (!byte) return false;
        wr_text_add_n(name, &byte, 1);
        if (low >= 0) c += 2;
    }
    return name->length > 0;
}

bool wr_gltf_stays_within(const char *name)
{
    if (*name == '/' || strpbrk(name, "\\:")) return false;
    for (const char *at = name; at;) {
        const char *slash = strchr(at, '/');
        const size_t length = slash ? (size_t)(slash - at) : strlen(at);
        if (length == 0 || (length == 2 && memcmp(at, "..", 2) == 0)) return false;
        at = slash ? slash + 1 : NULL;
    }
    return true;
}

/* ---- bytes ---- */

static void add_base64(WrText *out, const char *bytes, size_t length)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *from = (const unsigned char *)bytes;
    for (size_t i = 0; i < length; i += 3) {
        const unsigned b = i + 1 < length ? from[i + 1] : 0, c = i + 2 < length ? from[i + 2] : 0;
        const unsigned all = (unsigned)from[i] << 16 | b << 8 | c;
        const char four[4] = { digits[all >> 18], digits[all >> 12 & 63],
                               i + 1 < length ? digits[all >> 6 & 63] : '=',
                               i + 2 < length ? digits[all & 63] : '=' };
        wr_text_add_n(out, four, 4);
    }
}

/* Replaces a buffer's uri by the file's bytes. *left: remaining limit of bytes. */
static bool take_in(const char *path, const char *uri, json_object *buffer, size_t *left,
                    WrError *err)
{
    WrText name = { 0 }, data = { 0 };
    char *bytes = NULL, *folder = wr_path_folder(path), *full = NULL;
    size_t length = 0;
    bool good = wr_gltf_decode_name(uri, &name) && wr_gltf_stays_within(wr_text_get(&name));
    if (!good)
        wr_fail(err, "%s: names the part \"%.80s\": must lie beside the file or below", path, uri);
    if (good) full = wr_path_join(folder, wr_text_get(&name));
    if (good && !wr_file_read(full, *left, &bytes, &length, err)) {
        wr_error_prefix(err, "%s: of its parts, ", path);
        good = false;
    }
    if (good) {
        wr_text_add(&data, "data:application/octet-stream;base64,");
        add_base64(&data, bytes, length);
        *left -= length;
        json_object *text = json_object_new_string_len(wr_text_get(&data), (int)data.length);
        good = text && json_object_object_add(buffer, "uri", text) == 0;
        if (!good) wr_fail(err, "%s: no memory for its parts", path);
    }
    wr_free(bytes);
    wr_free(folder);
    wr_free(full);
    wr_text_fini(&name);
    wr_text_fini(&data);
    return good;
}

static bool take_all(const char *path, json_object *buffers, int *parts, WrError *err)
{
    /* All buffers together, as base64, must fit the limit of a readable file. */
    size_t left = (WR_MESH_FILE_MAX - WR_GLTF_JSON_MAX) / 4 * 3;
    for (size_t i = 0; i < json_object_array_length(buffers); i++) {
        json_object *buffer;
        const char *uri = part_of(buffers, i, &buffer);
        if (!uri) continue;
        if (++*parts > WR_GLTF_PARTS_MAX)
            return wr_fail(err, "%s: keeps its parts in more than %d other files", path,
                           WR_GLTF_PARTS_MAX);
        if (!take_in(path, uri, buffer, &left, err)) return false;
    }
    return true;
}

bool wr_gltf_pack(const char *path, WrText *out, bool *packed, WrError *err)
{
    char ending[16], *text;
    size_t length;
    int parts = 0;
    *packed = false;
    if (strcmp(wr_path_ending(path, ending), "gltf") != 0) return true;
    if (!wr_file_read(path, WR_GLTF_JSON_MAX, &text, &length, NULL)) return true;
    json_object *root = wr_gltf_parse(text, length), *buffers;
    wr_free(text);
    bool good = true;
    if (json_object_is_type(root, json_type_object) &&
        json_object_object_get_ex(root, "buffers", &buffers) &&
        json_object_is_type(buffers, json_type_array))
        good = take_all(path, buffers, &parts, err);
    *packed = good && parts > 0;
    if (*packed)
        wr_text_add(out, json_object_to_json_string_ext(root, JSON_C_TO_STRING_PLAIN |
                                                                  JSON_C_TO_STRING_NOSLASHESCAPE));
    json_object_put(root);
    return good;
}
