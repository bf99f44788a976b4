/* gltf_internal.h - JSON, chunks, names and texture transforms of glTF files.
   Private to src/image. */
#pragma once
#include <json-c/json.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

/* A glTF's JSON, or NULL if that is none. */
json_object *wr_gltf_parse(const char *text, size_t length);
/* The member of that kind, or NULL; an item of an array, or NULL. of: anything, or NULL. */
json_object *wr_gltf_member(json_object *of, const char *name, json_type kind);
json_object *wr_gltf_element(json_object *of, int index);
/* A whole number of 0 .. 2^31 - 1; `missing` where there is none, -1 where it is another. */
int64_t wr_gltf_index(json_object *of, const char *name, int64_t missing);
/* RFC 4648, 4: the bytes, appended. False where it is none. */
bool wr_gltf_base64(const char *text, WrText *out);

/* The two chunks of a .glb; of a .gltf all is JSON. bin: NULL: there is none. Borrowed. */
typedef struct WrGltfChunks {
    const char *json, *bin;
    size_t json_length, bin_length;
} WrGltfChunks;

/* NULL, or what is wrong with the file. */
const char *wr_gltf_chunks(const char *bytes, size_t length, WrGltfChunks *out);

/* KHR_texture_transform of a reference to a texture, on glTF's own (u,v) with v downwards. rotation is counter-clockwise as
 * the picture is seen, from (1, 0) to (0, -1): so say the extension's prose and its example. The GLSL lines beside them turn
 * the other way; other programs do not follow those.
 *   u' = m[0] u + m[1] v + m[2]      v' = m[3] u + m[4] v + m[5] */
void wr_gltf_transform(json_object *reference, double m[6]);
bool wr_gltf_same_transform(json_object *a, json_object *b);
/* The coordinate set of a reference, which the transform may name anew. */
int64_t wr_gltf_set(json_object *reference);
/* The reference whose transform the (u,v) of a model take: that of its normals, else of its colours, else of its
   metalness; NULL: there is none of coordinate set 0. */
json_object *wr_gltf_mapped(json_object *material);

/* A URI's %20 and its like, appended. False where that leaves a NUL, or nothing. */
bool wr_gltf_decode_name(const char *uri, WrText *name);
/* Does a path stay in its folder: no root, no "..", no scheme, no drive? */
bool wr_gltf_stays_within(const char *name);
