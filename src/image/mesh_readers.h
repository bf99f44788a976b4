/* mesh_readers.h - readers of mesh files: OBJ, PLY, STL, the triangles of glTF, the container of 3MF.
   Private to this module. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrMeshBuild WrMeshBuild;

/* ---- reader of polygonal OBJ files in double precision, several times as fast as the library ---- */

/* Part of the reader process, and of reading "inside". */

/* Reads an OBJ file in memory into `build`: v (with a weight, colours or both after it), vt of one to
 * three numbers, vn, f, o, g and usemtl; numbers always have a decimal point. A byte order mark,
 * comments (also after other words), points, lines, smoothing groups and material libraries are
 * ignored. Corners of one position, (u,v) and normal are one point, in the order of their first use by
 * faces.
 *
 * Returns  false for all other content: curves, rational weights other than 1, continued lines, forward
 *          indices, invalid numbers, damage, lack of memory. wrong is then an error that the library
 *          would not notice or not place, or unchanged: the library reads the file, or reports the error. */
bool wr_obj_read(const char *bytes, size_t length, WrMeshBuild *build, WrError *wrong);

/* ---- reader of PLY files ---- */

/* ASCII or binary, of either byte order. Part of the reader process, and of reading "inside". The library is not
   used because it crashes on hundreds of damaged files, overwrites the (u,v) of a point where faces have their
   own, drops strips and truncates coordinates to 32-bit floats. Every count is compared with the remaining bytes
   before it is used, so that no file needs more steps than it has bytes. */

/* True if the bytes begin like a PLY file, whatever the extension of its name. */
bool wr_ply_is(const char *bytes, size_t length);
/* Reads a PLY file in memory into `build`.
 *
 * Of element `vertex`: x, y, z, nx, ny, nz, and (u,v) by any of the common names (u, s, texture_u,
 * texture_s, tx and their partners). Of `face`: vertex_index or vertex_indices, and texcoord, the (u,v)
 * of the face's own corners. Of `tristrips`: vertex_indices, where -1 begins another strip. Everything
 * else is skipped.
 * Errors   one sentence that does not name the file, with the position and kind of the damage */
bool wr_ply_read(const char *bytes, size_t length, WrMeshBuild *build, WrError *err);

/* ---- reader of STL files ---- */

/* Binary, or ASCII in letters of either case. Part of the reader process, and of reading "inside". The library is
   not used because it rejects capitals and truncates ASCII coordinates to 32-bit floats. */

/* Reads an STL file in memory into `build`: three points per triangle, with the facet's normal; each
 * solid is a part.
 * Errors   one sentence that does not name the file, with the position and kind of the damage */
bool wr_stl_read(const char *bytes, size_t length, WrMeshBuild *build, WrError *err);
/* True if the length is that of a binary STL file of the count that the bytes state. */
bool wr_stl_is_binary(const char *bytes, size_t length);

/* ---- container of 3MF files ---- */

/* Checks the archive and sets the build's unit; the library reads the triangles.
 * Errors   one sentence that does not name the file: damage, no model, unpacks to too many bytes */
bool wr_3mf_open(const void *bytes, size_t length, WrMeshBuild *build, WrError *err);

/* ---- reader of the triangles of a glTF 2.0 file ---- */

/* Nodes, meshes, accessors. Part of the reader process, and of reading "inside". glTF 2.0: 3.5 (nodes), 3.6
   (accessors), 3.7 (meshes, skins); KHR_mesh_quantization, KHR_texture_transform. The library is not used because
   it supports no normalised integers, requires texture coordinate sets in order, transforms skinned meshes by
   their nodes, and truncates node positions to 32-bit floats. */

/* True if the bytes are a glTF file, text or GLB, of version 2. */
bool wr_gltf_is(const char *bytes, size_t length);
/* Reads the default scene into `build`: each mesh with its node's transform; a skinned mesh posed by
 * its joints, without animation. Texture coordinates are TEXCOORD_0, with v upwards, transformed by the
 * material's texture transform (wr_gltf_mapped).
 * Errors   one sentence that does not name the file: damage; an unsupported extension that the geometry
 *          needs; a part in another file */
bool wr_gltf_read(const char *bytes, size_t length, WrMeshBuild *build, WrError *err);
