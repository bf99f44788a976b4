#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/gltf_internal.h"
#include "image/mesh_build.h"
#include "image/mesh_readers.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- JSON ---- */

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
static void gltf_transform(json_object *reference, double m[6])
{
    json_object *all = wr_gltf_member(reference, "extensions", json_type_object);
    json_object *moved = wr_gltf_member(all, "KHR_texture_transform", json_type_object);
    const double angle = number_in(moved, "rotation", -1, 0), c = wr_cos(angle), s = wr_sin(angle);
    const double x = number_in(moved, "scale", 0, 1), y = number_in(moved, "scale", 1, 1);
    m[0] = c * x, m[1] = s * y, m[2] = number_in(moved, "offset", 0, 0);
    m[3] = -s * x, m[4] = c * y, m[5] = number_in(moved, "offset", 1, 0);
}

bool wr_gltf_same_transform(json_object *a, json_object *b)
{
    double m[6], n[6];
    gltf_transform(a, m);
    gltf_transform(b, n);
    for (int i = 0; i < 6; i++)
        if (!(fabs(m[i] - n[i]) <= 1e-9)) return false;
    return true;
}

int64_t wr_gltf_uv_set(json_object *reference)
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
        if (found[i] && wr_gltf_uv_set(found[i]) == 0) return found[i];
    return NULL;
}

/* ---- meshes ---- */

#define BUFFERS 1024
#define BODIES_MAX 1000000 /* primitives of all nodes together */

typedef struct Gltf {
    json_object *root;
    WrGltfChunks chunks;
    WrText *buffers; /* [BUFFERS] decoded data: URIs */
    WrMeshBuild *build;
    int bodies;
    double (
        *world)[12]; /* of each node, including its parents; owned; NULL: the file has no skins */
    int64_t nodes;
} Gltf;

/* Values of an accessor: [count][parts]. */
typedef struct Numbers {
    double *at; /* owned */
    int64_t count;
    int parts;
} Numbers;

typedef struct Bytes {
    const char *at;
    size_t length;
} Bytes;

static json_object *item_of(const Gltf *file, const char *list, int64_t index)
{
    return index < 0
               ? NULL
               : wr_gltf_element(wr_gltf_member(file->root, list, json_type_array), (int)index);
}

/* ---- bytes ---- */

static bool find_buffer(Gltf *file, int64_t index, Bytes *out, WrError *err)
{
    json_object *buffer = item_of(file, "buffers", index);
    json_object *uri = wr_gltf_member(buffer, "uri", json_type_string);
    if (!buffer || index >= BUFFERS)
        return wr_fail(err, "is damaged: it refers to buffer %lld, which does not exist",
                       (long long)index);
    if (!uri) {
        *out = (Bytes){ file->chunks.bin, file->chunks.bin_length };
        return (index == 0 && out->at) ||
               wr_fail(err, "is damaged: buffer %lld has no bytes", (long long)index);
    }
    const char *text = json_object_get_string(uri), *comma = strchr(text, ',');
    if (strncmp(text, "data:", 5) != 0)
        return wr_fail(
            err, "needs another file, \"%.80s\"; save it as one file (.glb, .obj, .ply, .stl)",
            text);
    WrText *bytes = &file->buffers[index];
    if (!bytes->length && (!comma || !wr_gltf_base64(comma + 1, bytes)))
        return wr_fail(err, "is damaged: buffer %lld is not base64", (long long)index);
    *out = (Bytes){ wr_text_get(bytes), bytes->length };
    return true;
}

static bool find_view(Gltf *file, int64_t index, Bytes *out, int64_t *stride, WrError *err)
{
    json_object *view = item_of(file, "bufferViews", index);
    json_object *all = wr_gltf_member(view, "extensions", json_type_object), *packed;
    const int64_t from = wr_gltf_index(view, "byteOffset", 0);
    const int64_t length = wr_gltf_index(view, "byteLength", -1);
    Bytes bytes = { 0 };
    if (!view || from < 0 || length < 0)
        return wr_fail(err, "is damaged: bufferView %lld does not exist, or has no length",
                       (long long)index);
    if (all && json_object_object_get_ex(all, "EXT_meshopt_compression", &packed))
        return wr_fail(err,
                       "needs the extension EXT_meshopt_compression, which is not read; save it "
                       "without compression");
    if (!find_buffer(file, wr_gltf_index(view, "buffer", -1), &bytes, err)) return false;
    if ((size_t)from > bytes.length || (size_t)length > bytes.length - (size_t)from)
        return wr_fail(
            err, "is damaged: bufferView %lld refers to bytes %lld to %lld of a buffer of %zu",
            (long long)index, (long long)from, (long long)(from + length), bytes.length);
    *out = (Bytes){ bytes.at + from, (size_t)length };
    *stride = wr_gltf_index(view, "byteStride", 0);
    return true;
}

/* ---- accessors ---- */

/* An accessor addresses numbers in three steps: accessor (type, count, offset) -> bufferView (offset, length, stride) ->
   buffer. Offsets and lengths of an untrusted file are compared with the remaining bytes before each step; sums are formed in
   64 bits. */
static const struct {
    int type, bytes;
    double most; /* code that is normalised to 1; 0: floats */
} components[] = { { 5120, 1, 127 },   { 5121, 1, 255 },        { 5122, 2, 32767 },
                   { 5123, 2, 65535 }, { 5125, 4, 4294967295 }, { 5126, 4, 0 } };

static double component_at(const char *at, int type)
{
    const unsigned char *b = (const unsigned char *)at;
    const uint32_t two = (uint32_t)b[0] | (type >= 5122 ? (uint32_t)b[1] << 8 : 0);
    if (type == 5120) return (int8_t)b[0];
    if (type == 5122) return (int16_t)two;
    if (type < 5125) return two;
    const uint32_t four = two | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
    float out;
    memcpy(&out, &four, sizeof out);
    return type == 5126 ? (double)out : (double)four;
}

/* Location of the values of an accessor, or of a part of a sparse one. */
typedef struct Source {
    int64_t view, offset, count;
    int type, parts;
    bool normalised;
} Source;

static bool read_source(Gltf *file, Source source, double *out, WrError *err)
{
    Bytes bytes = { 0 };
    int64_t stride = 0;
    int kind = 0;
    while (components[kind].type != source.type) kind++;
    if (!find_view(file, source.view, &bytes, &stride, err)) return false;
    const int64_t size = (int64_t)components[kind].bytes * source.parts;
    if (stride == 0) stride = size;
    if (stride < size || source.offset < 0 || (size_t)source.offset > bytes.length ||
        (source.count > 0 &&
         source.offset + stride * (source.count - 1) + size > (int64_t)bytes.length))
        return wr_fail(err, "is damaged: %lld numbers do not fit into bufferView %lld of %zu bytes",
                       (long long)(source.count * source.parts), (long long)source.view,
                       bytes.length);
    const double most = source.normalised ? components[kind].most : 0;
    for (int64_t i = 0; i < source.count; i++)
        for (int k = 0; k < source.parts; k++) {
            const double x = component_at(bytes.at + source.offset + stride * i +
                                              (int64_t)components[kind].bytes * k,
                                          source.type);
            /* Normalised integers (3.6.2.2): c / most, signed ones max(c / most, -1), so that -128 and -127 both mean -1. */
            *out++ = !(most > 0) ? x : x < -most ? -1 : x / most;
        }
    return true;
}

static bool is_component(int64_t type)
{
    for (size_t i = 0; i < sizeof components / sizeof *components; i++)
        if (components[i].type == type) return true;
    return false;
}

/* Applies the replaced values of a sparse accessor. */
static bool read_sparse(Gltf *file, json_object *sparse, Source source, Numbers *numbers,
                        WrError *err)
{
    json_object *where = wr_gltf_member(sparse, "indices", json_type_object);
    json_object *values = wr_gltf_member(sparse, "values", json_type_object);
    const Source index = { .view = wr_gltf_index(where, "bufferView", -1),
                           .offset = wr_gltf_index(where, "byteOffset", 0),
                           .count = wr_gltf_index(sparse, "count", -1),
                           .type = (int)wr_gltf_index(where, "componentType", -1),
                           .parts = 1 };
    source.view = wr_gltf_index(values, "bufferView", -1);
    source.offset = wr_gltf_index(values, "byteOffset", 0);
    source.count = index.count;
    if (index.count < 0 || index.count > numbers->count || !is_component(index.type))
        return wr_fail(err, "is damaged: a sparse accessor of %lld values", (long long)index.count);
    double *at = wr_try_alloc((size_t)index.count + 1, sizeof *at, "a mesh", err);
    double *to = wr_try_alloc((size_t)(index.count * source.parts) + 1, sizeof *to, "a mesh", err);
    bool good = at && to && read_source(file, index, at, err) && read_source(file, source, to, err);
    for (int64_t i = 0; good && i < index.count; i++) {
        if (!(at[i] >= 0 && at[i] < (double)numbers->count))
            good = wr_fail(err, "is damaged: a sparse accessor refers to value %g of %lld", at[i],
                           (long long)numbers->count);
        else
            memcpy(numbers->at + (int64_t)at[i] * source.parts, to + i * source.parts,
                   (size_t)source.parts * sizeof *to);
    }
    wr_free(at);
    wr_free(to);
    return good;
}

/* parts: required number of components. */
static bool read_accessor(Gltf *file, int64_t index, int parts, Numbers *out, WrError *err)
{
    static const char *const kinds[16] = { "SCALAR", "VEC2", "VEC3", "VEC4", [15] = "MAT4" };
    json_object *accessor = item_of(file, "accessors", index);
    json_object *kind = wr_gltf_member(accessor, "type", json_type_string);
    json_object *normalised = wr_gltf_member(accessor, "normalized", json_type_boolean);
    json_object *sparse = wr_gltf_member(accessor, "sparse", json_type_object);
    const Source source = { .view = wr_gltf_index(accessor, "bufferView", -1),
                            .offset = wr_gltf_index(accessor, "byteOffset", 0),
                            .count = wr_gltf_index(accessor, "count", -1),
                            .type = (int)wr_gltf_index(accessor, "componentType", -1),
                            .parts = parts,
                            .normalised = json_object_get_boolean(normalised) };
    if (!kind || strcmp(json_object_get_string(kind), kinds[parts - 1]) != 0 ||
        !is_component(source.type) || source.count < 0)
        return wr_fail(err, "is damaged: accessor %lld does not exist, or is not of type %s",
                       (long long)index, kinds[parts - 1]);
    if (source.count > 3 * (int64_t)WR_MESH_POINTS_MAX)
        return wr_fail(err, "more than %d points", WR_MESH_POINTS_MAX);
    *out = (Numbers){ .count = source.count, .parts = parts };
    out->at = wr_try_alloc((size_t)(source.count * parts) + 1, sizeof *out->at, "a mesh", err);
    file->build->memory |= !out->at;
    return out->at && (source.view < 0 || read_source(file, source, out->at, err)) &&
           (!sparse || read_sparse(file, sparse, source, out, err));
}

/* ---- matrices: rows of 3 x 4, translation last ---- */

static void multiply(const double a[12], const double b[12], double out[12])
{
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++) {
            double sum = column == 3 ? a[4 * row + 3] : 0.0;
            for (int k = 0; k < 3; k++) sum += a[4 * row + k] * b[4 * k + column];
            out[4 * row + column] = sum;
        }
}

/* The cofactors transform normals; the sign of the determinant is negative for mirroring. n' = C n with the cofactor matrix C
   = det(M) M^-T: defined for singular M, too. For a mirroring M it flips normals, which the caller undoes. */
static double cofactors(const double m[12], double c[9])
{
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            const int r1 = (row + 1) % 3, r2 = (row + 2) % 3;
            const int c1 = (column + 1) % 3, c2 = (column + 2) % 3;
            c[3 * row + column] = m[4 * r1 + c1] * m[4 * r2 + c2] - m[4 * r1 + c2] * m[4 * r2 + c1];
        }
    return m[0] * c[0] + m[1] * c[1] + m[2] * c[2];
}

/* Reads `count` numbers of an array; absent ones are unchanged. */
static void take_array(json_object *node, const char *name, int count, double *out)
{
    json_object *list = wr_gltf_member(node, name, json_type_array);
    for (int i = 0; list && i < count; i++) {
        json_object *x = wr_gltf_element(list, i);
        if (x) out[i] = json_object_get_double(x);
    }
}

/* A matrix by columns, or a translation, a rotation quaternion and a scale. The rotation matrix of the unit quaternion (x, y,
   z, w): R = I + 2 w [v]x + 2 [v]x^2. */
static void own_matrix(json_object *node, double out[12])
{
    double m[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 };
    if (wr_gltf_member(node, "matrix", json_type_array)) {
        take_array(node, "matrix", 16, m);
        for (int row = 0; row < 3; row++)
            for (int column = 0; column < 4; column++) out[4 * row + column] = m[4 * column + row];
        return;
    }
    double move[3] = { 0, 0, 0 }, q[4] = { 0, 0, 0, 1 }, scale[3] = { 1, 1, 1 };
    take_array(node, "translation", 3, move);
    take_array(node, "rotation", 4, q);
    take_array(node, "scale", 3, scale);
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const double turn[9] = { 1 - 2 * (y * y + z * z), 2 * (x * y - z * w),
                             2 * (x * z + y * w),     2 * (x * y + z * w),
                             1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                             2 * (x * z - y * w),     2 * (y * z + x * w),
                             1 - 2 * (x * x + y * y) };
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++)
            out[4 * row + column] = turn[3 * row + column] * scale[column];
        out[4 * row + 3] = move[row];
    }
}

/* ---- a primitive ---- */

#define SETS 8       /* maximum, for four weights per point */
#define JOINTS 65536 /* maximum for a skin */

typedef struct Body {
    Numbers points, normals, uv, corners;
    Numbers joints[SETS], weights[SETS]; /* of a skinned body; four per point */
    double (*pose)[12]; /* of each joint, its inverse bind matrix included; owned; NULL: no skin */
    int64_t joint_count;
} Body;

static void free_body(Body *body)
{
    wr_free(body->points.at);
    wr_free(body->normals.at);
    wr_free(body->uv.at);
    wr_free(body->corners.at);
    wr_free(body->pose);
    for (int k = 0; k < SETS; k++) {
        wr_free(body->joints[k].at);
        wr_free(body->weights[k].at);
    }
}

/* An optional attribute; its count must equal that of the points. */
static bool read_attribute(Gltf *file, json_object *attributes, const char *name, int parts,
                           int64_t count, Numbers *out, WrError *err)
{
    const int64_t index = wr_gltf_index(attributes, name, -1);
    if (index < 0) return true;
    if (!read_accessor(file, index, parts, out, err)) return false;
    return out->count == count || wr_fail(err, "is damaged: %lld values of %s for %lld points",
                                          (long long)out->count, name, (long long)count);
}

static bool is_packed(Gltf *file, json_object *primitive, json_object *attributes)
{
    json_object *all = wr_gltf_member(primitive, "extensions", json_type_object);
    json_object *points = item_of(file, "accessors", wr_gltf_index(attributes, "POSITION", -1));
    return wr_gltf_member(all, "KHR_draco_mesh_compression", json_type_object) &&
           wr_gltf_index(points, "bufferView", -1) < 0;
}

/* ---- skins ---- */

/* A point is transformed by the weighted mean of its joints' matrices (glTF 2.0, 3.7.3.3). */

static bool read_weights(Gltf *file, json_object *attributes, Body *body, WrError *err)
{
    for (int k = 0; k < SETS; k++) {
        char joints[24], weights[24];
        snprintf(joints, sizeof joints, "JOINTS_%d", k);
        snprintf(weights, sizeof weights, "WEIGHTS_%d", k);
        if (!read_attribute(file, attributes, joints, 4, body->points.count, &body->joints[k],
                            err) ||
            !read_attribute(file, attributes, weights, 4, body->points.count, &body->weights[k],
                            err))
            return false;
        if (!body->joints[k].at || !body->weights[k].at) break;
    }
    return true;
}

static bool read_pose(Gltf *file, json_object *skin, Body *body, WrError *err)
{
    json_object *list = wr_gltf_member(skin, "joints", json_type_array);
    const int64_t bind = wr_gltf_index(skin, "inverseBindMatrices", -1);
    const int64_t count = list ? (int64_t)json_object_array_length(list) : 0;
    Numbers inverse = { 0 };
    if (count < 1 || count > JOINTS)
        return wr_fail(err, "is damaged: a skin of %lld joints: must be 1..%d", (long long)count,
                       JOINTS);
    body->pose = wr_try_alloc((size_t)count, sizeof *body->pose, "a mesh", err);
    body->joint_count = count;
    bool good = body->pose && (bind < 0 || read_accessor(file, bind, 16, &inverse, err));
    if (good && inverse.at && inverse.count < count)
        good = wr_fail(err, "is damaged: %lld inverse bind matrices for %lld joints",
                       (long long)inverse.count, (long long)count);
    for (int64_t i = 0; good && i < count; i++) {
        json_object *item = wr_gltf_element(list, (int)i);
        const int64_t node =
            json_object_is_type(item, json_type_int) ? json_object_get_int64(item) : -1;
        double m[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
        /* File matrices are stored by columns, ours by rows without the last one. */
        for (int k = 0; inverse.at && k < 12; k++) m[k] = inverse.at[16 * i + k % 4 * 4 + k / 4];
        if (node < 0 || node >= file->nodes)
            good = wr_fail(err, "is damaged: a skin refers to node %lld, which does not exist",
                           (long long)node);
        else multiply(file->world[node], m, body->pose[i]);
    }
    wr_free(inverse.at);
    return good;
}

/* The matrix of point i; a point without weights is not moved. Weights of a point should sum to 1; dividing by their sum
   repairs files that were quantised or edited. */
static bool skin_point(const Body *body, int64_t i, double out[12], WrError *err)
{
    double sum = 0, m[12] = { 0 };
    for (int k = 0; k < SETS && body->joints[k].at && body->weights[k].at; k++)
        for (int64_t n = 4 * i; n < 4 * i + 4; n++) {
            const double weight = body->weights[k].at[n], joint = body->joints[k].at[n];
            if (!(weight > 0)) continue;
            if (!(joint >= 0 && joint < (double)body->joint_count))
                return wr_fail(err, "is damaged: point %lld has joint %g: must be 0..%lld",
                               (long long)i, joint, (long long)body->joint_count - 1);
            sum += weight;
            for (int c = 0; c < 12; c++) m[c] += weight * body->pose[(int64_t)joint][c];
        }
    for (int c = 0; c < 12; c++) out[c] = sum > 0 ? m[c] / sum : c % 5 == 0;
    return true;
}

static bool read_body(Gltf *file, json_object *primitive, json_object *skin, Body *body,
                      WrError *err)
{
    json_object *attributes = wr_gltf_member(primitive, "attributes", json_type_object);
    const int64_t points = wr_gltf_index(attributes, "POSITION", -1);
    const int64_t corners = wr_gltf_index(primitive, "indices", -1);
    if (is_packed(file, primitive, attributes))
        return wr_fail(err,
                       "needs the extension KHR_draco_mesh_compression, which is not read; save it "
                       "without compression");
    if (points < 0) return true; /* nothing of it is visible */
    if (!read_accessor(file, points, 3, &body->points, err)) return false;
    const int64_t count = body->points.count;
    if (skin && (!read_pose(file, skin, body, err) || !read_weights(file, attributes, body, err)))
        return false;
    if (file->build->whole &&
        (!read_attribute(file, attributes, "NORMAL", 3, count, &body->normals, err) ||
         !read_attribute(file, attributes, "TEXCOORD_0", 2, count, &body->uv, err)))
        return false;
    return corners < 0 || read_accessor(file, corners, 1, &body->corners, err);
}

static void move_uv(const double m[6], const double *uv, float out[2])
{
    /* glTF's v points down, the program's up. */
    out[0] = (float)(m[0] * uv[0] + m[1] * uv[1] + m[2]);
    out[1] = (float)(1 - (m[3] * uv[0] + m[4] * uv[1] + m[5]));
}

/* own: the matrix of the node. Sets *mirrored to true if the last point's matrix mirrors. */
static bool add_points(WrMeshBuild *build, const Body *body, const double own[12],
                       const double uv_m[6], bool *mirrored, WrError *err)
{
    /* A skinned point has a matrix of its own, which replaces the node's (glTF 2.0, 3.7.3.3: the node's transform is
       ignored). */
    double m[12], c[9];
    memcpy(m, own, sizeof m);
    if (!wr_mesh_build_reserve(build, body->points.count, 0, err)) return false;
    for (int64_t i = 0; i < body->points.count; i++) {
        const double *p = body->points.at + 3 * i,
                     *n = body->normals.at ? body->normals.at + 3 * i : NULL;
        double to[3];
        float normal[3] = { 0, 0, 0 }, uv[2];
        if (body->pose && !skin_point(body, i, m, err)) return false;
        *mirrored = cofactors(m, c) < 0;
        const double sign = *mirrored ? -1 : 1;
        for (int row = 0; row < 3; row++) {
            to[row] =
                m[4 * row] * p[0] + m[4 * row + 1] * p[1] + m[4 * row + 2] * p[2] + m[4 * row + 3];
            if (n)
                normal[row] = (float)(sign * (c[3 * row] * n[0] + c[3 * row + 1] * n[1] +
                                              c[3 * row + 2] * n[2]));
        }
        if (body->uv.at) move_uv(uv_m, body->uv.at + 2 * i, uv);
        if (!wr_mesh_build_point(build, to, n ? normal : NULL, body->uv.at ? uv : NULL, err))
            return false;
    }
    return true;
}

/* The corners of triangle i of a list, a strip or a fan, of mode 4, 5, 6. Every second triangle of a strip is listed in
   reverse, so that all have the same orientation. */
static void corners_of(int64_t mode, int64_t i, int64_t out[3])
{
    const int64_t odd = i % 2;
    const int64_t all[3][3] = { { 3 * i, 3 * i + 1, 3 * i + 2 },
                                { i, i + 1 + odd, i + 2 - odd },
                                { i + 1, i + 2, 0 } };
    memcpy(out, all[mode - 4], sizeof all[0]);
}

static bool add_triangles(Gltf *file, const Body *body, int64_t mode, int32_t first, bool mirrored,
                          WrError *err)
{
    const int64_t count = body->corners.at ? body->corners.count : body->points.count;
    const int64_t triangles = mode == 4 ? count / 3 : count - 2;
    for (int64_t i = 0; i < triangles; i++) {
        int64_t c[3];
        int32_t to[3];
        corners_of(mode, i, c);
        for (int k = 0; k < 3; k++) {
            const double point = body->corners.at ? body->corners.at[c[k]] : (double)c[k];
            if (!(point >= 0 && point < (double)body->points.count))
                return wr_fail(err, "is damaged: a triangle refers to point %g: must be 0..%lld",
                               point, (long long)body->points.count - 1);
            to[k] = first + (int32_t)point;
        }
        if (!wr_mesh_build_triangle(file->build, to[0], to[mirrored ? 2 : 1], to[mirrored ? 1 : 2],
                                    err))
            return false;
    }
    return true;
}

/* A part is named after its material, else its mesh. */
static void name_part(Gltf *file, json_object *mesh, json_object *material)
{
    json_object *name = wr_gltf_member(material, "name", json_type_string);
    if (!name || !json_object_get_string_len(name))
        name = wr_gltf_member(mesh, "name", json_type_string);
    const char *text = name ? json_object_get_string(name) : "";
    wr_mesh_build_part(file->build, text, strlen(text));
}

/* skin: NULL, or replaces m. */
static bool add_body(Gltf *file, json_object *mesh, json_object *primitive, json_object *skin,
                     const double m[12], WrError *err)
{
    json_object *material = item_of(file, "materials", wr_gltf_index(primitive, "material", -1));
    const int64_t mode = wr_gltf_index(primitive, "mode", 4);
    const int32_t first = file->build->point_count;
    double uv_m[6];
    bool mirrored = false;
    Body body = { .points = { 0 } };
    if (++file->bodies > BODIES_MAX)
        return wr_fail(err, "more than %d instances of meshes", BODIES_MAX);
    if (mode < 4 || mode > 6) return true; /* points and lines have no area */
    gltf_transform(wr_gltf_mapped(material), uv_m);
    name_part(file, mesh, material);
    bool good = read_body(file, primitive, skin, &body, err) &&
                (!body.points.at || (add_points(file->build, &body, m, uv_m, &mirrored, err) &&
                                     add_triangles(file, &body, mode, first, mirrored, err)));
    free_body(&body);
    return good;
}

/* ---- nodes ---- */

/* The scene's nodes are visited with an explicit stack: a hostile file's nesting would overflow the call stack. */
typedef struct Visit {
    int64_t node;
    double to[12];
} Visit;

typedef struct Walk {
    Visit *open; /* [count of nodes], owned: each node is visited once */
    bool *met;
    int64_t nodes, count;
} Walk;

static bool enter(Walk *walk, json_object *list, const double to[12], WrError *err)
{
    const size_t count = list ? json_object_array_length(list) : 0;
    for (size_t i = count; i-- > 0;) { /* pushed in reverse, so that the first is visited first */
        json_object *item = wr_gltf_element(list, (int)i);
        const int64_t node =
            json_object_is_type(item, json_type_int) ? json_object_get_int64(item) : -1;
        if (node < 0 || node >= walk->nodes)
            return wr_fail(err, "is damaged: it refers to node %lld, which does not exist",
                           (long long)node);
        if (walk->met[node])
            return wr_fail(err, "is damaged: node %lld has two parents", (long long)node);
        walk->met[node] = true;
        walk->open[walk->count].node = node;
        memcpy(walk->open[walk->count++].to, to, 12 * sizeof *to);
    }
    return true;
}

typedef bool At(Gltf *file, int64_t index, json_object *node, const double to[12], WrError *err);

static bool keep_world(Gltf *file, int64_t index, json_object *node, const double to[12],
                       WrError *err)
{
    (void)node;
    (void)err;
    memcpy(file->world[index], to, sizeof file->world[index]);
    return true;
}

/* A skinned mesh is positioned only by its joints; its own node's transform is ignored (glTF 2.0,
 * 3.7.3.3). */
static bool add_mesh(Gltf *file, int64_t node_index, json_object *node, const double to[12],
                     WrError *err)
{
    const int64_t index = wr_gltf_index(node, "mesh", -1);
    const int64_t skin_index = wr_gltf_index(node, "skin", -1);
    json_object *mesh = item_of(file, "meshes", index), *primitive;
    json_object *skin = item_of(file, "skins", skin_index);
    if ((index >= 0 && !mesh) || (skin_index >= 0 && !skin))
        return wr_fail(err, "is damaged: node %lld refers to %s %lld, which does not exist",
                       (long long)node_index, index >= 0 && !mesh ? "mesh" : "skin",
                       (long long)(index >= 0 && !mesh ? index : skin_index));
    json_object *list = wr_gltf_member(mesh, "primitives", json_type_array);
    for (int i = 0; (primitive = wr_gltf_element(list, i)); i++)
        if (!add_body(file, mesh, primitive, skin, to, err)) return false;
    return true;
}

static bool visit_node(Gltf *file, Walk *walk, At *at, WrError *err)
{
    const Visit visit = walk->open[--walk->count];
    json_object *node = item_of(file, "nodes", visit.node);
    double own[12], to[12];
    own_matrix(node, own);
    multiply(visit.to, own, to);
    return at(file, visit.node, node, to, err) &&
           enter(walk, wr_gltf_member(node, "children", json_type_array), to, err);
}

/* All nodes without parents. */
static json_object *all_roots(Gltf *file, int64_t nodes)
{
    json_object *out = json_object_new_array();
    bool *child = wr_alloc((size_t)nodes + 1, sizeof *child);
    for (int64_t i = 0; i < nodes; i++) {
        json_object *list = wr_gltf_member(item_of(file, "nodes", i), "children", json_type_array),
                    *item;
        for (int k = 0; (item = wr_gltf_element(list, k)); k++) {
            const int64_t at = json_object_get_int64(item);
            if (at >= 0 && at < nodes) child[at] = true;
        }
    }
    for (int64_t i = 0; i < nodes; i++)
        if (!child[i]) json_object_array_add(out, json_object_new_int64(i));
    wr_free(child);
    return out;
}

/* The default scene's nodes, else the first scene's; a file without scenes shows all. */
static json_object *shown_roots(Gltf *file, int64_t nodes)
{
    json_object *scene = item_of(file, "scenes", wr_gltf_index(file->root, "scene", 0));
    if (scene) return json_object_get(wr_gltf_member(scene, "nodes", json_type_array));
    return all_roots(file, nodes);
}

/* roots: owned. */
static bool walk_nodes(Gltf *file, json_object *roots, At *at, WrError *err)
{
    static const double nothing[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
    Walk walk = { .nodes = file->nodes };
    walk.open = wr_try_alloc((size_t)walk.nodes + 1, sizeof *walk.open, "a mesh", err);
    walk.met = wr_try_alloc((size_t)walk.nodes + 1, sizeof *walk.met, "a mesh", err);
    bool good = walk.open && walk.met && enter(&walk, roots, nothing, err);
    while (good && walk.count > 0) good = visit_node(file, &walk, at, err);
    json_object_put(roots);
    wr_free(walk.open);
    wr_free(walk.met);
    return good;
}

static bool add_nodes(Gltf *file, WrError *err)
{
    json_object *list = wr_gltf_member(file->root, "nodes", json_type_array);
    json_object *skins = wr_gltf_member(file->root, "skins", json_type_array);
    file->nodes = list ? (int64_t)json_object_array_length(list) : 0;
    bool good = true;
    if (skins) {
        file->world = wr_try_alloc((size_t)file->nodes + 1, sizeof *file->world, "a mesh", err);
        good = file->world && walk_nodes(file, all_roots(file, file->nodes), keep_world, err);
    }
    good = good && walk_nodes(file, shown_roots(file, file->nodes), add_mesh, err);
    wr_free(file->world);
    return good;
}

/* ---- the file ---- */

/* Extensions that do not affect the triangles, by the prefix of their names; or that are supported. */
static bool is_harmless(const char *name)
{
    static const char *const begins[] = {
        "KHR_materials_",         "KHR_texture_",          "EXT_texture_",
        "MSFT_texture_",          "KHR_lights_",           "KHR_xmp",
        "KHR_animation_",         "KHR_mesh_quantization", "KHR_draco_mesh_compression",
        "EXT_meshopt_compression"
    }; /* the last two are rejected where a mesh needs them */
    for (size_t i = 0; i < sizeof begins / sizeof *begins; i++)
        if (strncmp(name, begins[i], strlen(begins[i])) == 0) return true;
    return false;
}

static bool check_extensions(Gltf *file, WrError *err)
{
    json_object *list = wr_gltf_member(file->root, "extensionsRequired", json_type_array), *item;
    for (int i = 0; (item = wr_gltf_element(list, i)); i++) {
        const char *name =
            json_object_is_type(item, json_type_string) ? json_object_get_string(item) : "";
        if (!is_harmless(name))
            return wr_fail(err, "needs the extension %.60s, which is not read; save it without",
                           name);
    }
    return true;
}

bool wr_gltf_is(const char *bytes, size_t length)
{
    WrGltfChunks chunks;
    if (wr_gltf_chunks(bytes, length, &chunks)) return false;
    json_object *root = wr_gltf_parse(chunks.json, chunks.json_length);
    json_object *asset = wr_gltf_member(root, "asset", json_type_object);
    json_object *version = wr_gltf_member(asset, "version", json_type_string);
    const bool two = version && *json_object_get_string(version) == '2';
    json_object_put(root);
    return two;
}

bool wr_gltf_read(const char *bytes, size_t length, WrMeshBuild *build, WrError *err)
{
    Gltf file = { .build = build };
    const char *wrong = wr_gltf_chunks(bytes, length, &file.chunks);
    if (wrong) return wr_fail(err, "is damaged: %s", wrong);
    file.root = wr_gltf_parse(file.chunks.json, file.chunks.json_length);
    if (!json_object_is_type(file.root, json_type_object)) {
        json_object_put(file.root);
        return wr_fail(err, "is truncated or damaged: its JSON does not end");
    }
    file.buffers = wr_alloc(BUFFERS, sizeof *file.buffers);
    bool good = check_extensions(&file, err) && add_nodes(&file, err);
    for (int i = 0; i < BUFFERS; i++) wr_text_fini(&file.buffers[i]);
    wr_free(file.buffers);
    json_object_put(file.root);
    return good;
}
