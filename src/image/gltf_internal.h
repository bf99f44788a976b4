/* gltf_internal.h - JSON, chunks, names and texture transforms of glTF files.
   Private to src/image. */
#pragma once
#include <json-c/json.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

/* Parses a glTF's JSON; NULL if invalid. */
json_object *wr_gltf_parse(const char *text, size_t length);
/* The member of that kind, or NULL; an item of an array, or NULL. of: any value, or NULL. */
json_object *wr_gltf_member(json_object *of, const char *name, json_type kind);
json_object *wr_gltf_element(json_object *of, int index);
/* An integer of 0 .. 2^31 - 1; `missing` if absent, -1 if invalid. */
int64_t wr_gltf_index(json_object *of, const char *name, int64_t missing);
/* RFC 4648, 4: decodes and appends the bytes. False if invalid. */
bool wr_gltf_base64(const char *text, WrText *out);

/* The two chunks of a .glb; a .gltf is all JSON. bin: NULL: absent. Borrowed. */
typedef struct WrGltfChunks {
    const char *json, *bin;
    size_t json_length, bin_length;
} WrGltfChunks;

/* NULL, or a description of the file's error. */
const char *wr_gltf_chunks(const char *bytes, size_t length, WrGltfChunks *out);

/* KHR_texture_transform of a texture reference, in glTF's own (u,v) with v downwards. rotation is
 * counter-clockwise as seen, from (1, 0) to (0, -1), according to the extension's prose and example.
 * The GLSL lines beside them rotate in the other direction; other programs do not follow those.
 *
 *   u' = m[0] u + m[1] v + m[2]      v' = m[3] u + m[4] v + m[5] */
bool wr_gltf_same_transform(json_object *a, json_object *b);
/* The coordinate set of a reference, which the transform may override. */
int64_t wr_gltf_uv_set(json_object *reference);
/* The reference whose transform applies to the (u,v) of a model: that of its normals, else of its
   colours, else of its metalness; NULL: none uses coordinate set 0. */
json_object *wr_gltf_mapped(json_object *material);
