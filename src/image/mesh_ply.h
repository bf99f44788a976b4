/* mesh_ply.h - PLY files: written out or binary, of either order of bytes.
   Private to this module. Part of the reader process, and of reading "inside".

   They are read here and not by the library because it crashes on damaged ones by the hundred, overwrites the (u,v) of a
   point where faces have their own, drops strips and cuts coordinates to 32-bit floats. Every count is compared with
   the bytes that are left before anything is made of it, so that no file takes more steps than it has bytes. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrMeshBuild WrMeshBuild;

/* Whether the bytes begin as a PLY file does, whatever its name ends in. */
bool wr_ply_is(const char *bytes, size_t length);
/* Read a PLY file that is in memory into `build`.
 *
 * Of element `vertex`: x, y, z, nx, ny, nz, and (u,v) by any of the names in use (u, s, texture_u, texture_s, tx and their
 * partners). Of `face`: vertex_index or vertex_indices, and texcoord, the (u,v) of the face's own corners. Of `tristrips`:
 * vertex_indices, where -1 begins another strip. All else is passed over.
 * Errors   one sentence that does not name the file, but says where it is damaged and by what */
bool wr_ply_read(const char *bytes, size_t length, WrMeshBuild *build, WrError *err);
