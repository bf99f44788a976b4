/* gltf_mesh.h - reader of the triangles of a glTF 2.0 file: nodes, meshes, accessors.
   Private to this module.
   Part of the reader process, and of reading "inside". glTF 2.0: 3.5 (nodes), 3.6 (accessors), 3.7
   (meshes, skins); KHR_mesh_quantization, KHR_texture_transform.

   The library is not used because it supports no normalised integers, requires texture coordinate sets
   in order, transforms skinned meshes by their nodes, and truncates node positions to 32-bit floats. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrMeshBuild WrMeshBuild;

/* True if the bytes are a glTF file, text or GLB, of version 2. */
bool wr_gltf_is(const char *bytes, size_t length);
/* Reads the default scene into `build`: each mesh with its node's transform; a skinned mesh posed by
 * its joints, without animation. Texture coordinates are TEXCOORD_0, with v upwards, transformed by the
 * material's texture transform (wr_gltf_mapped).
 * Errors   one sentence that does not name the file: damage; an unsupported extension that the geometry
 *          needs; a part in another file */
bool wr_gltf_read(const char *bytes, size_t length, WrMeshBuild *build, WrError *err);
