/* gltf_inner.h - what the files about glTF share: names in it, and its bytes.
   Layer 1, private to src/image. */
#pragma once
#include <json-c/json.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

/* A glTF's JSON, or NULL if that is none. */
json_object *wr_gltf_parse(const char *text, size_t length);
/* A URI's %20 and its like, appended. False where that leaves a NUL, or nothing. */
bool wr_gltf_decode_name(const char *uri, WrText *name);
/* Does a path stay in its folder: no root, no "..", no scheme, no drive? */
bool wr_gltf_stays_within(const char *name);
