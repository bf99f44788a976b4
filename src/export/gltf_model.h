/* gltf_model.h - model and pictures of a .gltf file, as the .glb files have them.
   Private to this module. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrImage WrImage;
typedef struct WrScene WrScene;
typedef struct WrText WrText;

/* Appends the members bufferViews, accessors, meshes (with material 0), nodes, scenes and scene to `json`, without a
 * comma at either end, and the bytes of buffer 0 to `bin`.
 *
 * size     of a rectangle towards +z; NULL: the scene's surface, in scene units
 * repeat   factors of (u,v) in TEXCOORD_0
 * Errors   no memory, cancelled, a surface without area */
bool wr_gltf_add_model(const WrScene *scene, const double size[2], const double repeat[2],
                       WrText *json, WrText *bin, WrError *err);

/* A picture of linear light as an sRGB PNG of 8 bits. bytes: owned by the caller (wr_free). */
bool wr_gltf_colour_png(const WrImage *colour, char **bytes, size_t *length, WrError *err);
