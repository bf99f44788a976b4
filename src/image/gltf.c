/* glTF files: packing with their parts, and their materials. */
#include "image/gltf.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/gltf_internal.h"
#include "image/mesh.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- packing with parts in other files ---- */

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

/* Decodes a URI's percent escapes and appends the name. False if the result contains a NUL, or is
 * empty. */
static bool gltf_decode_name(const char *uri, WrText *name)
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

/* True if a path stays in its folder: no root, no "..", no scheme, no drive. A file from the net must not read files
   elsewhere, such as ../../.ssh/id: only names below its own folder are opened. */
static bool gltf_stays_within(const char *name)
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
    bool good = gltf_decode_name(uri, &name) && gltf_stays_within(wr_text_get(&name));
    if (!good)
        wr_fail(err, "%s: refers to \"%.80s\": must be in the file's folder or below", path, uri);
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
        if (!good) wr_fail(err, "%s: not enough memory for its parts", path);
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
            return wr_fail(err, "%s: refers to more than %d other files", path, WR_GLTF_PARTS_MAX);
        if (!take_in(path, uri, buffer, &left, err)) return false;
    }
    return true;
}

/* The sandboxed reader opens one descriptor and no paths, so the parts are put into the JSON as data: URIs before the file is
   passed to it. */
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

/* ---- materials: the file ---- */

typedef struct Gltf {
    const char *path;
    char *bytes; /* the whole file */
    size_t length;
    const char *bin; /* a GLB's second chunk, or NULL */
    size_t bin_length;
    json_object *root;
} Gltf;

static void close_gltf(Gltf *file)
{
    json_object_put(file->root);
    wr_free(file->bytes);
}

static bool open_gltf(const char *path, Gltf *file, WrError *err)
{
    char ending[16];
    wr_path_ending(path, ending);
    *file = (Gltf){ .path = path };
    if (strcmp(ending, "gltf") != 0 && strcmp(ending, "glb") != 0)
        return wr_fail(err, "%s: must be a .gltf or a .glb file", path);
    if (!wr_file_read(path, WR_MESH_FILE_MAX, &file->bytes, &file->length, err)) return false;
    WrGltfChunks chunks;
    const char *wrong = wr_gltf_chunks(file->bytes, file->length, &chunks);
    const size_t length = chunks.json_length;
    bool good = !wrong || wr_fail(err, "%s: %s", path, wrong);
    file->bin = chunks.bin;
    file->bin_length = chunks.bin_length;
    if (good && length > WR_GLTF_JSON_MAX)
        good = wr_fail(err, "%s: its JSON has %zu bytes: must be up to %lu", path, length,
                       WR_GLTF_JSON_MAX);
    if (good) file->root = wr_gltf_parse(chunks.json, length);
    if (good && !json_object_is_type(file->root, json_type_object))
        good = wr_fail(err, "%s: is damaged: its JSON cannot be read", path);
    if (!good) close_gltf(file);
    return good;
}

/* ---- JSON ---- */

static json_object *item_of(const Gltf *file, const char *list, int index)
{
    return wr_gltf_element(wr_gltf_member(file->root, list, json_type_array), index);
}

static bool has(json_object *of, const char *name)
{
    json_object *out;
    return json_object_is_type(of, json_type_object) && json_object_object_get_ex(of, name, &out);
}

static bool is_number(json_object *x)
{
    return json_object_is_type(x, json_type_double) || json_object_is_type(x, json_type_int);
}

/* Reads 0..1; `out` is unchanged if absent. */
static bool share_of(const Gltf *file, const char *name, json_object *x, double *out, WrError *err)
{
    if (!x) return true;
    const double value = json_object_get_double(x);
    if (is_number(x) && value >= 0 && value <= 1) {
        *out = value;
        return true;
    }
    return wr_fail(err, "%s: %s %.40s: must be a number of 0..1", file->path, name,
                   json_object_to_json_string(x));
}

static json_object *any(json_object *of, const char *name)
{
    json_object *out;
    return has(of, name) && json_object_object_get_ex(of, name, &out) ? out : NULL;
}

/* ---- a material ---- */

static void leave(WrGltfMaterial *look, const char *what)
{
    const size_t length = strlen(look->left), more = strlen(what);
    if (strstr(look->left, what) || length + more + 3 > sizeof look->left) return;
    snprintf(look->left + length, sizeof look->left - length, "%s%s", length ? ", " : "", what);
}

/* The image index of a texture reference; -1 if none, or if its mapping is not supported. */
static int image_of(const Gltf *file, json_object *material, json_object *reference,
                    const char *what, WrGltfMaterial *look)
{
    char words[96];
    if (!reference) return -1;
    const int64_t texture = wr_gltf_index(reference, "index", -1);
    json_object *of = texture < 0 ? NULL : item_of(file, "textures", (int)texture);
    const int64_t image = wr_gltf_index(of, "source", -1);
    const char *why = wr_gltf_uv_set(reference) != 0 ? "by another set of coordinates"
                      : !wr_gltf_same_transform(reference, wr_gltf_mapped(material))
                          ? "moved by another transform than the model's (u,v)"
                      : !of || !item_of(file, "images", (int)image) ? "which is not there"
                                                                    : NULL;
    if (!why) return (int)image;
    snprintf(words, sizeof words, "the picture of %s, %s", what, why);
    leave(look, words);
    return -1;
}

static void leave_others(json_object *material, WrGltfMaterial *look)
{
    static const double black[3] = { 0, 0, 0 };
    json_object *glow = wr_gltf_member(material, "emissiveFactor", json_type_array);
    bool glows = has(material, "emissiveTexture");
    for (int k = 0; k < 3 && glow; k++)
        glows |= json_object_get_double(wr_gltf_element(glow, k)) != black[k];
    if (glows) leave(look, "emissive light");
    if (has(material, "occlusionTexture")) leave(look, "its picture of occlusion");
    json_object *mode = wr_gltf_member(material, "alphaMode", json_type_string);
    if (mode && strcmp(json_object_get_string(mode), "OPAQUE") != 0) leave(look, "transparency");
    json_object *more = wr_gltf_member(material, "extensions", json_type_object);
    if (!more) return;
    json_object_object_foreach(more, name, value)
    {
        char words[80];
        (void)value;
        if (strspn(name, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_") !=
            strlen(name))
            continue;
        snprintf(words, sizeof words, "%.60s", name);
        leave(look, words);
    }
}

static bool read_factors(const Gltf *file, json_object *pbr, WrGltfMaterial *look, WrError *err)
{
    json_object *colour = wr_gltf_member(pbr, "baseColorFactor", json_type_array);
    double *const to[4] = { &look->colour[0], &look->colour[1], &look->colour[2], &look->alpha };
    if (colour && json_object_array_length(colour) != 4)
        return wr_fail(err, "%s: baseColorFactor of %zu numbers: must be 4", file->path,
                       json_object_array_length(colour));
    for (int k = 0; k < 4 && colour; k++) {
        json_object *x = wr_gltf_element(colour, k);
        if (!x)
            return wr_fail(err, "%s: baseColorFactor null: must be a number of 0..1", file->path);
        if (!share_of(file, "baseColorFactor", x, to[k], err)) return false;
    }
    return share_of(file, "metallicFactor", any(pbr, "metallicFactor"), &look->metalness, err) &&
           share_of(file, "roughnessFactor", any(pbr, "roughnessFactor"), &look->roughness, err);
}

static bool read_material(const Gltf *file, json_object *material, WrGltfMaterial *look,
                          WrError *err)
{
    json_object *pbr = wr_gltf_member(material, "pbrMetallicRoughness", json_type_object);
    json_object *normal = wr_gltf_member(material, "normalTexture", json_type_object);
    json_object *name = wr_gltf_member(material, "name", json_type_string), *scale;
    if (name) snprintf(look->name, sizeof look->name, "%s", json_object_get_string(name));
    if (!read_factors(file, pbr, look, err)) return false;
    if ((scale = any(normal, "scale"))) look->normal_scale = json_object_get_double(scale);
    if ((scale && !is_number(scale)) || !(fabs(look->normal_scale) <= 100))
        return wr_fail(err, "%s: normalTexture scale %.40s: must be a number of -100..100",
                       file->path, json_object_to_json_string(scale));
    look->base = image_of(file, material, wr_gltf_member(pbr, "baseColorTexture", json_type_object),
                          "colours", look);
    look->facets =
        image_of(file, material, wr_gltf_member(pbr, "metallicRoughnessTexture", json_type_object),
                 "metalness and roughness", look);
    look->normal = image_of(file, material, normal, "normals", look);
    leave_others(material, look);
    return true;
}

/* The material of the first triangles that have one; else 0. */
static int first_used(const Gltf *file)
{
    json_object *meshes = wr_gltf_member(file->root, "meshes", json_type_array), *mesh, *body;
    for (int i = 0; (mesh = wr_gltf_element(meshes, i)); i++) {
        json_object *bodies = wr_gltf_member(mesh, "primitives", json_type_array);
        for (int k = 0; (body = wr_gltf_element(bodies, k)); k++) {
            const int64_t material = wr_gltf_index(body, "material", -1);
            if (material >= 0) return (int)material;
        }
    }
    return 0;
}

static int find_material(json_object *materials, const char *which)
{
    char *end;
    for (int i = 0; i < (int)json_object_array_length(materials); i++) {
        json_object *name = wr_gltf_member(wr_gltf_element(materials, i), "name", json_type_string);
        if (name && strcmp(json_object_get_string(name), which) == 0) return i;
    }
    const long number = strtol(which, &end, 10);
    return *which && !*end && number >= 1 && number <= INT32_MAX ? (int)(number - 1) : -1;
}

bool wr_gltf_read_material(const char *path, const char *which, WrGltfMaterial *out, WrError *err)
{
    Gltf file;
    if (!open_gltf(path, &file, err)) return false;
    json_object *materials = wr_gltf_member(file.root, "materials", json_type_array);
    const int count = materials ? (int)json_object_array_length(materials) : 0;
    *out = (WrGltfMaterial){ .colour = { 1, 1, 1 },
                             .alpha = 1,
                             .metalness = 1,
                             .roughness = 1,
                             .normal_scale = 1,
                             .base = -1,
                             .facets = -1,
                             .normal = -1 };
    bool good = count > 0 || wr_fail(err, "%s: has no materials", path);
    const int index = !good ? -1 : which ? find_material(materials, which) : first_used(&file);
    json_object *material = good ? wr_gltf_element(materials, index) : NULL;
    if (good && !json_object_is_type(material, json_type_object))
        good = which ? wr_fail(err, "%s: has no material \"%.60s\" (it has %d)", path, which, count)
                     : wr_fail(err, "%s: its triangles use material %lld of %d", path, index + 1LL,
                               count); /* the file's index may be INT32_MAX */
    out->index = index, out->count = count;
    good = good && read_material(&file, material, out, err);
    close_gltf(&file);
    return good;
}

/* ---- an image ---- */

bool wr_gltf_names_picture(const char *name, size_t *length, int *image)
{
    const char *hash = strrchr(name, '#');
    char ending[16];
    if (!hash || strspn(hash + 1, "0123456789") != strlen(hash + 1)) return false;
    const size_t digits = strlen(hash + 1);
    if (digits < 1 || digits > 6) return false;
    char *file = wr_strdup(name);
    file[hash - name] = 0;
    wr_path_ending(file, ending);
    wr_free(file);
    *length = (size_t)(hash - name);
    *image = atoi(hash + 1);
    return strcmp(ending, "gltf") == 0 || strcmp(ending, "glb") == 0;
}

/* Reads the target of a URI: inline data, or a file beside or below. */
static bool fetch(const Gltf *file, const char *uri, WrText *out, WrError *err)
{
    const char *comma = strncmp(uri, "data:", 5) == 0 ? strchr(uri, ',') : NULL;
    if (strncmp(uri, "data:", 5) == 0) {
        const bool coded = comma && comma - uri >= 12 && memcmp(comma - 7, ";base64", 7) == 0;
        return (coded && wr_gltf_base64(comma + 1, out)) ||
               wr_fail(err, "%s: a data: URI is not base64, or damaged", file->path);
    }
    WrText name = { 0 };
    char *folder = wr_path_folder(file->path), *full = NULL, *bytes = NULL;
    size_t length = 0;
    bool good = gltf_decode_name(uri, &name) && gltf_stays_within(wr_text_get(&name));
    if (!good)
        wr_fail(err, "%s: refers to \"%.80s\": must be in the file's folder or below", file->path,
                uri);
    if (good) full = wr_path_join(folder, wr_text_get(&name));
    good = good && wr_file_read(full, WR_GLTF_PICTURE_MAX, &bytes, &length, err);
    if (good) wr_text_add_n(out, bytes, length);
    wr_free(bytes);
    wr_free(folder);
    wr_free(full);
    wr_text_fini(&name);
    return good;
}

/* The bytes of a buffer view. */
static bool view_bytes(const Gltf *file, int view, WrText *out, WrError *err)
{
    json_object *of = item_of(file, "bufferViews", view);
    const int64_t index = wr_gltf_index(of, "buffer", -1),
                  from = wr_gltf_index(of, "byteOffset", 0);
    const int64_t length = wr_gltf_index(of, "byteLength", -1);
    json_object *buffer = index < 0 ? NULL : item_of(file, "buffers", (int)index);
    json_object *uri = wr_gltf_member(buffer, "uri", json_type_string);
    WrText fetched = { 0 };
    const char *bytes = file->bin;
    size_t have = file->bin_length;
    if (!buffer || from < 0 || length < 1 || (!uri && (index != 0 || !file->bin)))
        return wr_fail(err, "%s: view %d: is missing, or has no buffer", file->path, view);
    if ((size_t)length > WR_GLTF_PICTURE_MAX)
        return wr_fail(err, "%s: view %d: a picture of %lld bytes: must be up to %zu", file->path,
                       view, (long long)length, WR_GLTF_PICTURE_MAX);
    bool good = !uri || fetch(file, json_object_get_string(uri), &fetched, err);
    if (good && uri) bytes = wr_text_get(&fetched), have = fetched.length;
    if (good && ((size_t)from > have || (size_t)length > have - (size_t)from))
        good = wr_fail(err, "%s: view %d: bytes %lld to %lld of a buffer of %zu", file->path, view,
                       (long long)from, (long long)(from + length), have);
    if (good) wr_text_add_n(out, bytes + from, (size_t)length);
    wr_text_fini(&fetched);
    return good;
}

bool wr_gltf_picture(const char *path, int image, char **bytes, size_t *length, WrError *err)
{
    Gltf file;
    WrText out = { 0 };
    if (!open_gltf(path, &file, err)) return false;
    json_object *of = item_of(&file, "images", image);
    json_object *uri = wr_gltf_member(of, "uri", json_type_string);
    const int64_t view = wr_gltf_index(of, "bufferView", -1);
    bool good = of || wr_fail(err, "%s: has no image %d", path, image);
    if (good && uri) good = fetch(&file, json_object_get_string(uri), &out, err);
    else if (good && view >= 0) good = view_bytes(&file, (int)view, &out, err);
    else if (good) good = wr_fail(err, "%s: image %d: has neither uri nor bufferView", path, image);
    if (good && out.length == 0) good = wr_fail(err, "%s: image %d: is empty", path, image);
    close_gltf(&file);
    if (!good) {
        wr_text_fini(&out);
        return false;
    }
    *bytes = out.data;
    *length = out.length;
    return true;
}
