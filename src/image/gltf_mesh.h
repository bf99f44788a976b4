/* gltf_mesh.h - the triangles of a glTF 2.0 file: nodes, meshes, accessors.
   Private to this module. Part of the reader process, and of reading "inside". glTF 2.0: 3.5 (nodes), 3.6 (accessors),
   3.7 (meshes, skins); KHR_mesh_quantization, KHR_texture_transform.

   It is read here because the library takes no normalised integers, wants texture coordinates in the order of their
   sets, moves skinned meshes by their nodes and cuts nodes' places to 32-bit floats. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrMeshBuild WrMeshBuild;

/* Whether the bytes are a glTF file, text or GLB, of version 2. */
bool wr_gltf_is(const char *bytes, size_t length);
/* Read it into `build`: the default scene, each mesh where its node puts it; a skinned mesh where its joints put it, without
 * animation. Texture coordinates are TEXCOORD_0, with v upwards, moved by the transform of the material's textures (wr_gltf_mapped).
 * Errors   one sentence that does not name the file: damage; an extension that the geometry needs, by its name; a part in
 *          another file */
bool wr_gltf_read(const char *bytes, size_t length, WrMeshBuild *build, WrError *err);
