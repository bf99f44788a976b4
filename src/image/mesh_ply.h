/* mesh_ply.h - reader of PLY files: ASCII or binary, of either byte order.
   Private to this module.
   Part of the reader process, and of reading "inside".

   The library is not used because it crashes on hundreds of damaged files, overwrites the (u,v) of a
   point where faces have their own, drops strips and truncates coordinates to 32-bit floats. Every
   count is compared with the remaining bytes before it is used, so that no file takes more steps than
   it has bytes. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrMeshBuild WrMeshBuild;

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
